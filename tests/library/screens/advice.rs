//! Requests to the coach and the display of its advice: better shots while it thinks, chances, margins, maps and the plan.

use std::{
    path::Path,
    sync::{Arc, atomic::Ordering},
};

use super::{
    player::{NEXT_SHOT, OTHER_SHOTS, Player, SHOT, SIZES, TRUE_COLOUR, advice, check, cue, proposal, worker_answers},
    runs::{RUN, RUNS, config},
};
use carom::{
    coach::{FirstContact, Skill},
    game::Rule,
    learning::{Policy, run::follow::Update},
    statistics::SuccessRate,
    table::Table,
    terminal::{CoachAnswer, CoachEvent, CoachJob, CoachWorker, FollowSlot, InfoPanel, Settings, TrainingReport},
};
use ratatui::{buffer::Buffer, style::Color};

#[test]
fn better_shots_are_shown_until_the_answer_arrives() {
    let player = Player::new().press("Enter").report_better(OTHER_SHOTS[1], 612).wait(0.35);
    assert!(player.text(80, 24).contains("so far a shot of about 61 %, not judged yet; Esc takes it"));
    let player = player.report_better(OTHER_SHOTS[0], 893);
    check("so_far", &player);
    assert_eq!(player.shown_cue(), Some(cue(OTHER_SHOTS[0])));
    assert!(player.analysis_job.is_none(), "nothing is studied as long as there may be a better shot");
    let player = player.press("Space");
    assert!(player.text(80, 24).contains("so far") || !player.app.coach.playback.playing);
    let player = player.answer();
    assert_eq!(player.shown_cue(), Some(cue(SHOT)));
    assert!(player.analysis_job.is_some());
}

#[test]
fn escape_accepts_the_best_shot_and_ignores_late_answers() {
    let player = Player::new().press("Enter").report_better(OTHER_SHOTS[0], 893);
    let late = player.advice_job.clone();
    let mut player = player.press("Esc");
    assert!(late.as_ref().unwrap().cancel.load(Ordering::Relaxed));
    player.shows(&["the coach has stopped thinking; this is the best shot so far", "Space play"]);
    assert_eq!(player.analysis_job.as_ref().unwrap().shot, Some(cue(OTHER_SHOTS[0])));
    player.advice_job = late;
    let player = player.report_better(SHOT, 940).answer();
    assert_eq!(player.shown_cue(), Some(cue(OTHER_SHOTS[0])));
    assert_eq!(player.app.frame_interval(), None);
    // The estimate is biased by the errors used to choose the shot, so no interval is displayed.
    let player = player.press("v");
    let text = player.text(120, 40);
    assert!(text.contains("expert so far 89 %") && !text.contains("89 % ("), "{text}");
    // Earlier, this estimate stayed. Attempts of their own judge the shot before it is analysed.
    let job = player.analysis_job.clone().unwrap();
    let judged = job.stroke.clone().map(|(stroke, attempts)| (stroke, attempts.len()));
    assert_eq!(judged, Some((cue(OTHER_SHOTS[0]), 500)));
    let text = player.tell(job.id, CoachEvent::StrokeRated(SuccessRate::new(385, 500))).text(120, 40);
    assert!(text.contains("expert 77 % (73-80)") && !text.contains("so far"), "{text}");
    // The player may have gone on to another shot; the same job analyses this one then.
    let mut parts = Vec::new();
    let job = CoachJob { cancel: Arc::default(), ..*job };
    CoachWorker::with_simulation_limit(1).answer(&job, |answer| parts.push(answer.event));
    assert!(matches!(parts[..], [CoachEvent::StrokeRated(_), CoachEvent::Analysis(_), ..]), "{parts:?}");
}

#[test]
fn an_answer_belongs_to_the_player_it_was_requested_for() {
    let mut player = Player::new().press("Enter");
    let job = player.advice_job.take().expect("the coach is asked");
    let so_far = proposal(&job.table, &job.layout, OTHER_SHOTS[0], 893);
    player.app.receive(CoachAnswer { id: job.id, event: CoachEvent::Better(so_far) });
    assert!(player.app.coach.shot().is_some());
    let player = player.press("d p Esc");
    assert_eq!(job.query.skill, Skill::EXPERT);
    assert_ne!(player.app.coach.query.skill, Skill::EXPERT);
    assert!(player.app.coach.shot().is_none(), "the best shot so far is an expert's");
    let player = player.tell(job.id, CoachEvent::Advice(advice(&job)));
    assert!(player.analysis_job.is_none() && player.app.coach.shot().is_none());
    player.says("this answer is for expert; Enter asks for");
    // The shot is kept for the player for whom it was found.
    let mut player = player.press("S");
    for _ in 1..Skill::NAMED.len() {
        if player.analysis_job.is_none() {
            player = player.press("S");
        }
    }
    assert!(player.analysis_job.is_some());
    assert_eq!(player.app.coach.query.skill, Skill::EXPERT);
    player.says("the player: expert (average above 2.5); its shot is shown");
}

#[test]
fn changing_rule_player_or_plan_hides_the_shot() {
    for (keys, words, header) in [
        ("R", "what counts: one-cushion; Enter asks the coach", "R 1-cushion S expert P plan on"),
        ("R R", "what counts: three-cushion; Enter asks the coach", "R 3-cushion S expert P plan on"),
        ("S", "the player: world-class (average 2); Enter asks the coach", "R straight S world-class P plan on"),
        ("R S S S S S", "the player: perfect; Enter asks the coach", "R 1-cushion S perfect P plan on"),
        ("P", "only this point counts; Enter asks the coach", "R straight S expert P plan off"),
        ("B B", "hit first: red; Enter asks the coach", "R straight S expert P plan on B red first"),
        ("x B", "hit first: white; Enter asks the coach", "R straight S expert P plan on B white first"),
    ] {
        let player = Player::new().press("Enter").answer().press(keys);
        let text = player.text(80, 24);
        assert!(text.contains(words) && text.contains(header), "{keys}\n{text}");
        assert!(player.app.coach.shot().is_none(), "{keys}");
        let query = &player.press("Enter").advice_job.unwrap().query;
        assert_eq!(query.plan, keys != "P");
        assert_eq!(query.first == FirstContact::Red, keys == "B B");
        assert_eq!(query.skill == Skill::PERFECT, keys.contains("S S S S S"));
    }
    let player = Player::new().press("Enter").answer();
    let player = player.press("R S S");
    player.shows(&[
        "R 1-cushion S national P plan",
        "placing balls",
        "the player: national (average 1); Enter asks the coach",
    ]);
    let cancelled = player.analysis_job.clone().unwrap().cancel;
    assert!(cancelled.load(Ordering::Relaxed), "nobody looks at that shot any more");
    let player = player.press("R R S S S S");
    assert_eq!(player.shown_cue(), Some(cue(SHOT)), "the first request again");
    let again = player.press("Enter").advice_job.unwrap();
    assert_eq!(again.former, [SHOT, OTHER_SHOTS[0], OTHER_SHOTS[1]].map(cue), "they take part again");
    let asked = Player::new().press("Enter").answer().press("R R Enter").advice_job.unwrap();
    assert!(asked.query.rule == Rule::ThreeCushion && asked.former.is_empty());
}

#[test]
fn an_analysis_is_stored_with_the_shot_it_belongs_to() {
    let known = Player::new().press("Enter").answer();
    let set = |player: &Player| Settings { skill: player.app.coach.query.skill, ..Settings::default() };
    let before = set(&known);
    let mut other = known.press("S Enter").answer();
    let study = other.analysis_job.clone().unwrap();
    let now = set(&other);
    other.app.coach.apply_changed_settings(&now, &before).unwrap();
    let player = other.tell(study.id, CoachEvent::Next(None));
    let is_analysed = |player: &Player| player.app.coach.current_advice().map(|advised| advised.choice().is_analysed);
    assert_eq!(is_analysed(&player), Some(false), "the analysis belongs to another answer");
    let mut player = player;
    player.app.coach.apply_changed_settings(&before, &now).unwrap();
    assert_eq!(is_analysed(&player), Some(true));
}

#[test]
fn each_listed_shot_has_its_own_paths_and_analysis() {
    let player = Player::new().press("Enter").answer().press("v");
    check("chances", &player);
    let first = player.analysis_job.clone().unwrap();
    let player = player.press("]");
    player.shows(&["Chances · expert 89 % (87-91)", "▸2   89 % yellow, ", "shot 2 of 3: 89 % (87-91)"]);
    assert_eq!(player.shown_cue(), Some(cue(OTHER_SHOTS[0])));
    assert!(first.cancel.load(Ordering::Relaxed));
    let second = player.analysis_job.clone().unwrap();
    assert_eq!(second.shot, Some(cue(OTHER_SHOTS[0])));
    // A late answer about the first shot is not used for the second one.
    let mut player = player;
    player.analysis_job = Some(first);
    let mut late = player.finish_analysis().press("v");
    assert!(late.text(80, 24).contains("being computed"));
    late.analysis_job = Some(second);
    let player = late.finish_analysis();
    assert!(!player.text(80, 24).contains("being computed"));
    // Back at the first shot, the analysis is already available.
    let player = player.press("[ [");
    assert_eq!(player.shown_cue(), Some(cue(OTHER_SHOTS[1])), "after the first comes the last");
    let mut player = player.press("[");
    player.analysis_job = None;
    let player = player.press("Space Esc");
    assert!(player.analysis_job.is_none() && player.text(80, 24).contains("Margins R right, L left"));
}

#[test]
fn margins_and_maps() {
    let player = Player::new().press("Enter").answer().press("v v");
    assert!(player.text(80, 24).contains("being computed"));
    let player = player.finish_analysis();
    check("margins", &player);
    player.shows_at((200, 60), &["Margins", "Map: aim, speed", "tightest: errors leave it first"]);
    // The direction of each margin is displayed at both sizes.
    player.shows_at((120, 40), &["right", "left", "lower", "higher", "softer", "harder"]);
    player.shows_at((80, 24), &["side", "hght", "cue", "aim", "spd", "R"]);
    let picture = player.picture(120, 40);
    let (point, tip) = (Color::Rgb(0x5c, 0xbd, 0x72), Color::Rgb(0x1f, 0x63, 0xc8));
    // The map of direction and speed is in columns 45 to 70: the stroke in its middle, surrounded by points made.
    for middle in [(57, 33), (58, 33)] {
        assert!([picture[middle].fg, picture[middle].bg].contains(&tip), "{middle:?} {:?}", picture[middle]);
    }
    for around in [(55, 33), (60, 33), (57, 32), (57, 34)] {
        assert!([picture[around].fg, picture[around].bg].contains(&point), "{around:?} {:?}", picture[around]);
    }
    // The tip is left of the middle of its own map, at column 84, as the shooter sees it.
    let tips: Vec<u16> = (77..91).filter(|&x| (30..38).any(|y| picture[(x, y)].fg == tip)).collect();
    assert!(!tips.is_empty() && tips.iter().all(|&x| x <= 83), "{tips:?}");
}

#[test]
fn margins_maps_and_speeds_use_the_units_of_the_settings() {
    let player = Player::with_settings(TRUE_COLOUR, "length_unit = \"feet\"\n")
        .press("Enter")
        .answer()
        .press("v v")
        .finish_analysis();
    player.shows(&["Tip ±0.7 in"]);
    assert!(player.text(80, 24).contains("R right, L left: in ° ft/s"));
    for size in SIZES {
        player.hides_at(size, &[" mm", "m/s"]);
    }
    player.press("v v Space Right").shows(&[" ft/s "]);
}

#[test]
fn the_plan_shows_the_next_shot() {
    let player = Player::new().press("Enter").answer();
    let before = player.picture(120, 40);
    let player = player.press("v v v").finish_analysis();
    check("plan", &player);
    player.shows_at((200, 60), &["Plan · next point on average 97 %", "next 100 % very hard"]);
    assert_eq!(player.app.coach.info, InfoPanel::Plan);
    // The end positions of the balls are drawn around their intended places.
    let yellow = Color::Rgb(0xf6, 0xc3, 0x24);
    let count = |picture: &Buffer| picture.content().iter().filter(|cell| cell.fg == yellow).count();
    assert!(count(&player.picture(120, 40)) > count(&before) + 5);
    let end = player.app.coach.shot().unwrap().recording.final_layout();
    let player = player.press("n");
    assert_eq!(*player.app.coach.layout(), end);
    assert_eq!(player.shown_cue(), Some(cue(NEXT_SHOT)), "the next shot is there at once");
    player.shows(&[
        "Plan · next point on average 97 %",
        "now  100 % very hard",
        "stop being tried",
        "next being looked for",
    ]);
    assert!(player.advice_job.is_none(), "nothing more was asked");
}

#[test]
fn a_failed_analysis_is_reported() {
    let mut player = Player::new().press("Enter").answer().press("v v");
    player.shows(&["being computed"]);
    let id = player.analysis_job.take().unwrap().id;
    let failed = player.tell(id, CoachEvent::Next(None));
    failed.shows(&["could not be computed"]).does_not_show("being computed");
    failed.press("v").shows(&["stop could not be computed", "next could not be computed"]);
}

#[test]
fn the_real_coach_reports_progress_then_advice_then_next_shot() {
    let mut worker = CoachWorker::with_simulation_limit(30_000);
    let mut player = Player::new().press("Enter");
    let job = player.advice_job.clone().unwrap();
    let answers = worker_answers(&mut worker, &job);
    assert!(
        answers.len() > 1 && answers[..answers.len() - 1].iter().all(|one| matches!(one.event, CoachEvent::Better(_)))
    );
    for CoachAnswer { id, event } in answers {
        player = player.tell(id, event);
    }
    let best = player.app.coach.proposal().unwrap().clone();
    assert!(best.shot.solved && best.made.is_some_and(|made| made.rate > 0.5) && best.next.is_some());
    let job = player.analysis_job.clone().unwrap();
    let answers = worker_answers(&mut worker, &job);
    assert_eq!(answers.len(), 3, "why it leads, the closer look, and the next shot");
    for CoachAnswer { id, event } in answers {
        player = player.tell(id, event);
    }
    assert!(player.text(120, 40).contains("Why: the next best is shot 2 ("), "{}", player.text(120, 40));
    let player = player.press("n");
    assert!(player.app.coach.shot().is_some_and(|shot| shot.solved), "{}", player.text(120, 40));
    // The coach was cancelled: it reports only the end, at once.
    job.cancel.store(true, Ordering::Relaxed);
    assert!(matches!(&worker_answers(&mut worker, &job)[..], [CoachAnswer { event: CoachEvent::Next(None), .. }]));
}

#[test]
fn a_perfect_player_gets_the_first_point_found() {
    let player = Player::new().press("S S S S S Enter");
    let job = player.advice_job.clone().unwrap();
    let answers = worker_answers(&mut CoachWorker::with_simulation_limit(30_000), &job);
    let [CoachAnswer { event: CoachEvent::Advice(advice), .. }] = &answers[..] else { panic!("{answers:?}") };
    assert!(advice.effort.unwrap().simulations < 1000 && advice.proposals[0].shot.solved);
    let player = answers.into_iter().fold(player, |player, CoachAnswer { id, event }| player.tell(id, event));
    assert!(player.text(80, 24).contains("makes the point (networks"), "{}", player.text(80, 24));
}

#[test]
fn the_coach_returns_to_the_bundled_weights() {
    let take = |player: Player, rule: Rule| {
        let policy = Policy::bundled(&Table::default(), rule).unwrap().unwrap();
        let update = Update { config: Some(Box::new(config(rule.name()))), ..Update::default() };
        let player = player.update(FollowSlot::Main, RUN, update);
        player.report(TrainingReport::Policy(Path::new(RUNS).join(RUN), Ok(Arc::new(policy))))
    };
    let bundled = "the bundled networks".to_owned();
    let asked = |player: &Player| (player.app.coach.query.name().to_owned(), player.app.coach.query.rule);
    let player = take(Player::watching(TRUE_COLOUR), Rule::ThreeCushion);
    assert_eq!(asked(&player), (RUN.to_owned(), Rule::ThreeCushion));
    player.says("b bundled");
    let player = player.press("b");
    assert_eq!(asked(&player), (bundled.clone(), Rule::StraightRail), "the rule of before");
    player.says("the rule is now straight");
    assert!(!player.text(120, 40).contains("b bundled"));
    player.press("b").says("the bundled networks are asked already");
    // Other networks in between change nothing, and a rule that was chosen since stays.
    let other = take(take(Player::watching(TRUE_COLOUR), Rule::ThreeCushion).press("F4"), Rule::OneCushion);
    assert_eq!(asked(&other.press("b")), (bundled.clone(), Rule::StraightRail));
    let chosen = take(Player::watching(TRUE_COLOUR), Rule::ThreeCushion).press("R R b");
    assert_eq!(asked(&chosen), (bundled, Rule::OneCushion));
    // Networks are used on the table on which they were trained. Earlier the bundled ones stayed there.
    let mut run = config("r1");
    run.table = Table::preset("thesis").unwrap();
    let update = Update { config: Some(Box::new(run)), ..Update::default() };
    let policy = Policy::bundled(&Table::default(), Rule::StraightRail).unwrap().unwrap();
    let player = Player::watching(TRUE_COLOUR).update(FollowSlot::Main, RUN, update);
    let player = player.report(TrainingReport::Policy(Path::new(RUNS).join(RUN), Ok(Arc::new(policy))));
    player.says("the table is now thesis");
    assert_eq!(player.app.coach.table().name, "thesis");
    let player = player.press("b");
    player.says("the table is now match");
    assert_eq!(*player.app.coach.table(), Table::default());
}
