//! What the player sees: keys go through the real app, and its pictures are compared at both sizes.

mod keys;

use std::{
    sync::{Arc, atomic::Ordering},
    time::Duration,
};

use carom::{
    coach::{Kind, Pace, Skill, Way},
    game::Rule,
    learning::evaluation::SuccessRate,
    physics::CueInputs,
    table::{Layout, Table},
    terminal::{Advice, Answer, App, Depth, Effect, Effort, Glyphs, Job, Look, Office, Proposal, Shot, Tidings, View},
};
use keys::key;
use proptest::prelude::*;
use ratatui::{Terminal, backend::TestBackend, buffer::Buffer, style::Color};

const TRUE_COLOUR: Look = Look { depth: Depth::True, glyphs: Glyphs::Sextant, unicode: true };
const NO_COLOUR: Look = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
const ASCII: Look = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: false };

/// A shot that makes the point from the opening position, so that the pictures do not change with the coach, two others,
/// and one that makes the point from where the first leaves the balls.
const SHOT: &str = "-0.2,0.2,6,82.6,2.5";
const OTHERS: [&str; 2] = ["0.362,-0.11,0.467,107.632,5.525", "0.295,0.308,3.879,107.102,2.182"];
const NEXT: &str = "-0.051,0.323,7.533,-146.013,6";

struct Player {
    app: App,
    asked: Option<Box<Job>>,
    study: Option<Box<Job>>,
}

/// A shot with `made` of 1000 attempts.
fn proposal(table: &Table, layout: &Layout, cue: &str, way: Way, made: usize) -> Proposal {
    let shot = Shot::new(table, layout, CueInputs::parse(cue).unwrap(), true, "policy").unwrap();
    let pace = if shot.cue.speed < 2.5 { Pace::Soft } else { Pace::Hard };
    Proposal {
        shot: Arc::new(shot),
        kind: Some(Kind { first_ball: 1, cushion_first: false, way, pace }),
        made: Some(SuccessRate::new(made, 1000)),
        next: Some(0.97),
        is_early: false,
    }
}

/// The coach's advice on the opening position.
fn advice(job: &Job) -> Advice {
    let proposal = |cue, way, made| proposal(&job.table, &job.layout, cue, way, made);
    let best = proposal(SHOT, Way::OffCushion, 940);
    let others = OTHERS.into_iter().zip([893, 620]).map(|(cue, made)| proposal(cue, Way::AroundTheTable, made));
    Advice { proposals: std::iter::once(best).chain(others).collect(), effort: None }
}

impl Player {
    fn with(look: Look) -> Self {
        let table = Table::default();
        let app = App::new(table.clone(), Layout::opening(&table), look, 7).unwrap();
        Self { app, asked: None, study: None }
    }

    fn new() -> Self {
        Self::with(TRUE_COLOUR)
    }

    /// Presses keys: letters as they are, names like `Left`, `S-Left`, `C-Left`, `Enter` between blanks.
    fn press(mut self, keys: &str) -> Self {
        for word in keys.split_whitespace() {
            let effect = self.app.handle(&key(word));
            self.take(effect);
        }
        self
    }

    fn take(&mut self, effect: Option<Effect>) {
        match effect {
            Some(Effect::Recommend(job)) => self.asked = Some(job),
            Some(Effect::Study(job)) => self.study = Some(job),
            Some(other) => panic!("{other:?}"),
            None => {}
        }
    }

    fn tell(mut self, id: u64, news: Tidings) -> Self {
        let effect = self.app.receive(Answer { id, news });
        self.take(effect);
        self
    }

    /// The coach answers with [`SHOT`] and [`OTHERS`].
    fn answer(mut self) -> Self {
        let job = self.asked.take().expect("the coach was asked");
        let advice = advice(&job);
        self.tell(job.id, Tidings::Advice(advice))
    }

    /// The coach says that the shot with this cue is the best so far, with `made` of 1000 attempts.
    fn better(self, cue: &str, made: usize) -> Self {
        let job = self.asked.clone().expect("the coach was asked");
        let so_far = proposal(&job.table, &job.layout, cue, Way::OffCushion, made);
        self.tell(job.id, Tidings::Better(Proposal { is_early: true, ..so_far }))
    }

    /// The closer look at the shot that is shown, by the real coach, but for the next shot, which is [`NEXT`].
    fn studied(mut self) -> Self {
        // Even if nobody waits for it any more.
        let job = Job { cancel: Arc::default(), ..*self.study.take().expect("a closer look is wanted") };
        let mut study = None;
        Office::unhurried(1).answer(&job, |answer| {
            if let Tidings::Study(found) = answer.news {
                study = Some(found);
            }
        });
        let end = self.app.shot().unwrap().recording.final_layout();
        let next = proposal(&job.table, &end, NEXT, Way::Direct, 1000);
        self.tell(job.id, Tidings::Study(study.unwrap()))
            .tell(job.id, Tidings::Next(Some(Advice { proposals: vec![next], effort: None })))
    }

    fn wait(mut self, seconds: f64) -> Self {
        self.app.tick(seconds);
        self
    }

    fn draw(&self, width: u16, height: u16) -> Terminal<TestBackend> {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| self.app.draw(frame)).unwrap();
        terminal
    }

    fn picture(&self, width: u16, height: u16) -> Buffer {
        self.draw(width, height).backend().buffer().clone()
    }

    fn text(&self, width: u16, height: u16) -> String {
        self.draw(width, height).backend().to_string()
    }
}

/// Compares the picture at both sizes.
fn check(name: &str, player: &Player) {
    check_at(&[(80, 24), (120, 40)], name, player);
}

fn check_at(sizes: &[(u16, u16)], name: &str, player: &Player) {
    for &(width, height) in sizes {
        insta::assert_snapshot!(format!("{name}_{width}x{height}"), player.text(width, height));
    }
}

#[test]
fn the_start() {
    check("start", &Player::new());
}

#[test]
fn a_ball_moved_by_plain_coarse_and_fine_steps() {
    let player = Player::new().press("2 Right S-Right C-Up l L");
    check("moved", &player);
    let text = player.text(80, 24);
    assert!(text.contains("yellow at x -490.0 mm, y 183.5 mm"), "{text}");
}

#[test]
fn an_overlap_is_refused_at_contact_with_the_same_sentence_as_everywhere() {
    let player = Player::new().press("S-Up S-Up");
    check("overlap_refused", &player);
    let text = player.text(80, 24);
    assert!(text.contains("white stops in contact with yellow: beyond, balls 0 and 1 are"), "{text}");
    assert!(text.contains("121.0"), "the white ball touches the yellow one: 182.5 - 61.5\n{text}");
}

#[test]
fn the_rail_stops_a_ball_and_the_sentence_takes_a_second_line() {
    let player = Player::new().press("+ + S-Left");
    check("rail_refused", &player);
    assert!(player.text(80, 24).contains("|x| <= 1.3892 and |y| <= 0.6792"));
}

#[test]
fn the_coach_thinks_and_can_be_stopped() {
    let player = Player::new().press("Enter").wait(0.35);
    check("thinking", &player);
    let player = player.press("Left");
    assert!(player.text(80, 24).contains("the coach is thinking; Esc stops it"));
    let late = player.asked.clone().unwrap();
    let mut player = player.press("Esc");
    assert!(late.cancel.load(Ordering::Relaxed));
    player.asked = Some(late);
    assert!(player.answer().app.shot().is_none(), "a late answer is dropped");
}

#[test]
fn every_better_shot_is_shown_while_the_coach_thinks_until_its_answer_replaces_it() {
    let player = Player::new().press("Enter").better(OTHERS[1], 612).wait(0.35);
    assert!(player.text(80, 24).contains("so far a shot that makes the point 61 % of the time; Esc takes it"));
    let player = player.better(OTHERS[0], 893);
    check("so_far", &player);
    assert_eq!(player.app.shot().unwrap().cue, CueInputs::parse(OTHERS[0]).unwrap());
    assert!(player.study.is_none(), "nothing is studied as long as there may be a better shot");
    let player = player.press("Space");
    assert!(player.text(80, 24).contains("so far") || !player.app.playback().playing);
    let player = player.answer();
    assert_eq!(player.app.shot().unwrap().cue, CueInputs::parse(SHOT).unwrap());
    assert!(player.study.is_some());
}

#[test]
fn escape_takes_the_best_shot_so_far_and_a_late_answer_changes_nothing() {
    let player = Player::new().press("Enter").better(OTHERS[0], 893);
    let late = player.asked.clone();
    let mut player = player.press("Esc");
    assert!(late.as_ref().unwrap().cancel.load(Ordering::Relaxed));
    check("so_far_taken", &player);
    assert_eq!(player.study.as_ref().unwrap().shot, Some(CueInputs::parse(OTHERS[0]).unwrap()));
    player.asked = late;
    let player = player.better(SHOT, 940).answer();
    assert_eq!(player.app.shot().unwrap().cue, CueInputs::parse(OTHERS[0]).unwrap());
    assert_eq!(player.app.frame_interval(), None);
}

#[test]
fn a_shot_is_recommended() {
    let player = Player::new().press("Enter").answer();
    check("recommended", &player);
    let text = player.text(120, 40);
    for part in ["makes the point 94 % (92-95) of the time (expert)", "-0.200 R, 6.2 mm right", "82.60°", "V0", "ω0"]
    {
        assert!(text.contains(part), "{part}\n{text}");
    }
    // The line of aim in diamonds beside the degrees.
    assert!(text.contains("82.60° bottom 1.7→top 2.3") && text.contains("hits yellow"), "{text}");
}

#[test]
fn rule_player_and_plan_are_asked_for_and_a_shot_for_something_else_is_not_shown() {
    for (keys, words, header) in [
        ("R", "what counts: one-cushion; Enter asks the coach", "R 1-cushion S expert P plan"),
        ("R R", "what counts: three-cushion; Enter asks the coach", "R 3-cushion S expert P plan"),
        ("S", "the player: club; Enter asks the coach", "R straight S club P plan"),
        ("R S S S", "the player: perfect; Enter asks the coach", "R 1-cushion S perfect P plan"),
        ("P", "only this point counts; Enter asks the coach", "R straight S expert P off"),
    ] {
        let player = Player::new().press("Enter").answer().press(keys);
        let text = player.text(80, 24);
        assert!(text.contains(words) && text.contains(header), "{keys}\n{text}");
        assert!(player.app.shot().is_none(), "{keys}");
        let tutor = &player.press("Enter").asked.unwrap().tutor;
        assert_eq!(tutor.plan, keys != "P");
        assert_eq!(tutor.skill == Skill::PERFECT, keys.contains("S S S"));
    }
    let player = Player::new().press("Enter").answer();
    let player = player.press("R S");
    check("other_question", &player);
    let cancelled = player.study.clone().unwrap().cancel;
    assert!(cancelled.load(Ordering::Relaxed), "nobody looks at that shot any more");
    let player = player.press("R R S S S");
    assert_eq!(player.app.shot().unwrap().cue, CueInputs::parse(SHOT).unwrap(), "the first question again");
    let asked = player.press("R R Enter").asked.unwrap();
    assert_eq!(asked.tutor.rule, Rule::ThreeCushion);
}

#[test]
fn the_shots_that_are_listed_are_stepped_through_each_with_its_own_paths_and_its_own_closer_look() {
    let player = Player::new().press("Enter").answer().press("v");
    check("chances", &player);
    let first = player.study.clone().unwrap();
    let player = player.press("]");
    check("chances_second", &player);
    assert_eq!(player.app.shot().unwrap().cue, CueInputs::parse(OTHERS[0]).unwrap());
    assert!(first.cancel.load(Ordering::Relaxed));
    let second = player.study.clone().unwrap();
    assert_eq!(second.shot, Some(CueInputs::parse(OTHERS[0]).unwrap()));
    // What comes late about the first shot is not taken for the second.
    let mut late = Player { study: Some(first), ..player }.studied().press("v");
    assert!(late.text(80, 24).contains("being worked out"));
    late.study = Some(second);
    let player = late.studied();
    assert!(!player.text(80, 24).contains("being worked out"));
    // Back at it, it is known already.
    let player = player.press("[ [");
    assert_eq!(player.app.shot().unwrap().cue, CueInputs::parse(OTHERS[1]).unwrap(), "after the first comes the last");
    let mut player = player.press("[");
    player.study = None;
    let player = player.press("Space Esc");
    assert!(player.study.is_none() && player.text(80, 24).contains("yours"));
}

#[test]
fn margins_and_maps() {
    let player = Player::new().press("Enter").answer().press("v v");
    assert!(player.text(80, 24).contains("being worked out"));
    let player = player.studied();
    check_at(&[(80, 24), (120, 40), (200, 60)], "margins", &player);
    let picture = player.picture(120, 40);
    let (point, tip) = (Color::Rgb(0x5c, 0xbd, 0x72), Color::Rgb(0x1f, 0x63, 0xc8));
    // The map of direction and speed from column 46 to 72: the stroke in its middle, and a point all around it.
    assert_eq!(picture[(59, 33)].fg, tip);
    for around in [(57, 33), (61, 33), (59, 32), (59, 34)] {
        assert!([picture[around].fg, picture[around].bg].contains(&point), "{around:?} {:?}", picture[around]);
    }
    // The tip is right of the middle of its own map, at column 82, as the shooter sees it.
    let tips: Vec<u16> = (74..90).filter(|&x| (30..38).any(|y| picture[(x, y)].fg == tip)).collect();
    assert!(!tips.is_empty() && tips.iter().all(|&x| x >= 82), "{tips:?}");
}

#[test]
fn the_plan_and_where_it_goes_on() {
    let player = Player::new().press("Enter").answer();
    let before = player.picture(120, 40);
    let player = player.press("v v v").studied();
    check_at(&[(80, 24), (120, 40), (200, 60)], "plan", &player);
    assert_eq!(player.app.coach().view, View::Plan);
    // Ends of the balls are drawn around the places where they are meant to stop.
    let yellow = Color::Rgb(0xf6, 0xc3, 0x24);
    let count = |picture: &Buffer| picture.content().iter().filter(|cell| cell.fg == yellow).count();
    assert!(count(&player.picture(120, 40)) > count(&before) + 5);
    let end = player.app.shot().unwrap().recording.final_layout();
    let player = player.press("n");
    assert_eq!(*player.app.layout(), end);
    assert_eq!(player.app.shot().unwrap().cue, CueInputs::parse(NEXT).unwrap(), "the next shot is there at once");
    check("went_on", &player);
    assert!(player.asked.is_none(), "nothing more was asked");
}

#[test]
fn a_shot_without_a_point_is_said_to_be_one() {
    let mut player = Player::new().press("Enter");
    let job = player.asked.take().unwrap();
    let shot = Shot::new(&job.table, &job.layout, CueInputs::parse(SHOT).unwrap(), false, "policy").unwrap();
    let attempt = Proposal { shot: Arc::new(shot), kind: None, made: None, next: None, is_early: false };
    let effort = Some(Effort { simulations: 4321, elapsed: Duration::from_secs(2) });
    let player = player.tell(job.id, Tidings::Advice(Advice { proposals: vec![attempt], effort }));
    check("no_point", &player);
    assert!(player.text(80, 24).contains("no point found in 4321 simulations; this is the best attempt"));
}

#[test]
fn what_the_coach_refuses_is_said_in_its_words() {
    let mut player = Player::new().press("Enter");
    let job = player.asked.take().unwrap();
    let player = player.tell(job.id, Tidings::Refused("the weights file is corrupt".to_owned()));
    assert!(player.text(80, 24).contains("the weights file is corrupt"));
}

#[test]
fn the_shot_plays() {
    check("playing", &Player::new().press("Enter").answer().press("+ Space").wait(0.5));
}

#[test]
fn stepping_stops_at_events() {
    let player = Player::new().press("Enter").answer().press(". . Right Left .");
    check("at_event", &player);
    let shot = player.app.shot().unwrap();
    assert_eq!(player.app.playback().time, shot.recording.events()[2].time);
}

#[test]
fn the_end_of_a_shot_is_a_new_beginning() {
    let player = Player::new().press("Enter").answer().press("End");
    check("at_the_end", &player);
    let end = player.app.shot().unwrap().recording.final_layout();
    let player = player.press("n");
    assert_eq!(*player.app.layout(), end);
    assert!(player.app.shot().is_none());
    assert_eq!(player.asked.as_ref().unwrap().layout, end, "the next shot is not known yet, so the coach is asked");
    let player = player.press("Esc u");
    assert!(player.app.shot().is_some(), "undo brings the shot back as well");
}

#[test]
fn undo_and_redo_walk_through_all_changes() {
    let start = *Player::new().app.layout();
    let moved = Player::new().press("Left 3 Up r");
    let end = *moved.app.layout();
    let back = moved.press("u u u");
    assert_eq!(*back.app.layout(), start);
    let refused = back.press("u");
    assert!(refused.text(80, 24).contains("there is nothing to take back"));
    assert_eq!(*refused.press("U U C-r").app.layout(), end);
}

#[test]
fn a_key_that_does_nothing_now_says_why() {
    for (keys, reason) in [
        ("Space", "there is no shot yet; Enter asks the coach"),
        ("Esc", "there is no shot yet; Enter asks the coach"),
        ("U", "nothing was taken back"),
    ] {
        let text = Player::new().press(keys).text(80, 24);
        assert!(text.contains(reason), "{keys}\n{text}");
    }
    let watching = Player::new().press("Enter").answer().press("h");
    assert!(watching.text(80, 24).contains("a shot is being watched; Esc goes back to the balls"));
}

#[test]
fn the_help_lists_every_key() {
    check("help", &Player::new().press("?"));
    let closed = Player::new().press("? Left Esc");
    assert_eq!(closed.picture(80, 24), Player::new().picture(80, 24));
}

#[test]
fn without_colours_letters_tell_everything() {
    for (name, look) in [("no_colour", NO_COLOUR), ("ascii", ASCII)] {
        let player = Player::with(look).press("Enter").answer().press(". .");
        check(name, &player);
        let player = player.press("2");
        check(&format!("{name}_placing"), &player);
        let player = player.press("v v").studied();
        check(&format!("{name}_margins"), &player);
        check(&format!("{name}_plan"), &player.press("v"));
    }
    for views in ["v", "v v", "v v v"] {
        let player = Player::with(ASCII).press("Enter").answer().studied().press(views);
        assert!(player.text(200, 60).is_ascii(), "{views}");
    }
}

#[test]
fn monochrome_pictures_hold_no_colour_at_all() {
    let mut player = Player::with(NO_COLOUR).press("Enter").answer().studied();
    for _ in 0..4 {
        for cell in player.picture(200, 60).content() {
            assert_eq!((cell.fg, cell.bg), (Color::Reset, Color::Reset), "{cell:?}");
        }
        player = player.press("v");
    }
}

#[test]
fn half_blocks_draw_the_same_scene() {
    check("half_blocks", &Player::new().press("Enter").answer().press("g ."));
}

#[test]
fn too_small_a_terminal_names_both_sizes() {
    let player = Player::new();
    insta::assert_snapshot!("too_small_79x24", player.text(79, 24));
    for (width, height) in [(80, 23), (20, 5), (1, 1), (0, 0)] {
        player.picture(width, height);
    }
    let text = player.text(40, 10);
    assert!(text.contains("40×10") && text.contains("80×24"), "{text}");
}

#[test]
fn every_size_can_be_drawn() {
    let mut player = Player::new().press("Enter").answer().studied().press(".");
    for _ in 0..4 {
        for width in (1..=240).step_by(7) {
            for height in (1..=90).step_by(5) {
                player.picture(width, height);
            }
        }
        player = player.press("v");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn no_series_of_keys_breaks_the_program(keys in prop::collection::vec(0..KEYS.len(), 1..60), width in 60_u16..200) {
        let mut player = Player::new();
        for key in keys {
            player = player.press(KEYS[key]).wait(0.2);
            if player.asked.is_some() && key % 3 > 0 {
                player = player.answer();
            }
            if let Some(job) = player.study.take_if(|_| key % 5 == 0) {
                player = player.tell(job.id, Tidings::Next(Some(advice(&job))));
            }
        }
        prop_assert!(player.app.layout().validate(player.app.table()).is_ok());
        player.picture(width, 40);
    }
}

/// What a player may press at any time, but for leaving.
const KEYS: &[&str] = &[
    "Left", "S-Left", "C-Left", "Up", "S-Up", "Right", "S-Right", "Down", "S-Down", "h", "J", "+", "-", "Tab", "1",
    "2", "3", "Enter", "Enter", "Enter", "Esc", "Space", ",", ".", "0", "End", "n", "u", "U", "o", "r", "g", "?", "x",
    "R", "S", "P", "v", "[", "]",
];

#[test]
fn the_balls_have_their_colours_where_they_lie() {
    let picture = Player::new().picture(120, 40);
    // Bed of 108 by 27 cells from (6, 2): white at a quarter, red at three quarters, half way down.
    assert_eq!(picture[(33, 15)].fg, Color::Rgb(0xf7, 0xf3, 0xe8));
    assert_eq!(picture[(87, 15)].fg, Color::Rgb(0xd9, 0x36, 0x36));
    assert_eq!(picture[(60, 15)].bg, Color::Rgb(0x1b, 0x6d, 0x83));
}

#[test]
fn the_tip_is_drawn_on_the_side_that_the_shooter_sees() {
    // Positive a is left of the centre, and the recommended shot has a negative one.
    let picture = Player::new().press("Enter").answer().picture(120, 40);
    let blue = Color::Rgb(0x1f, 0x63, 0xc8);
    let columns: Vec<u16> =
        (74..90).filter(|&x| (30..40).any(|y| picture[(x, y)].fg == blue || picture[(x, y)].bg == blue)).collect();
    assert!(!columns.is_empty() && columns.iter().all(|&x| x >= 82), "{columns:?}");
}

#[test]
fn the_real_coach_tells_better_shots_then_its_advice_and_then_what_comes_next() {
    let mut office = Office::unhurried(30_000);
    let mut player = Player::new().press("Enter");
    let job = player.asked.clone().unwrap();
    let mut told = Vec::new();
    office.answer(&job, |answer| told.push(answer));
    assert!(told.len() > 1 && told[..told.len() - 1].iter().all(|one| matches!(one.news, Tidings::Better(_))));
    for Answer { id, news } in told {
        player = player.tell(id, news);
    }
    let best = player.app.coach().proposal().unwrap().clone();
    assert!(best.shot.solved && best.made.is_some_and(|made| made.rate > 0.9) && best.next.is_some());
    let job = player.study.clone().unwrap();
    let mut told = Vec::new();
    office.answer(&job, |answer| told.push(answer));
    assert_eq!(told.len(), 2);
    for Answer { id, news } in told {
        player = player.tell(id, news);
    }
    let player = player.press("n");
    assert!(player.app.shot().is_some_and(|shot| shot.solved), "{}", player.text(120, 40));
    // Nobody waits any more: nothing but the end is told, at once.
    let mut told = Vec::new();
    job.cancel.store(true, Ordering::Relaxed);
    office.answer(&job, |answer| told.push(answer));
    assert!(matches!(&told[..], [Answer { news: Tidings::Next(None), .. }]));
}

#[test]
fn a_perfect_player_gets_the_first_point() {
    let player = Player::new().press("S S S Enter");
    let mut told = Vec::new();
    Office::unhurried(30_000).answer(&player.asked.clone().unwrap(), |answer| told.push(answer));
    let [Answer { news: Tidings::Advice(advice), .. }] = &told[..] else { panic!("{told:?}") };
    assert!(advice.effort.unwrap().simulations < 1000 && advice.proposals[0].shot.solved);
    let player = told.into_iter().fold(player, |player, Answer { id, news }| player.tell(id, news));
    assert!(player.text(80, 24).contains("makes the point (policy"), "{}", player.text(80, 24));
}

#[test]
fn nothing_moves_by_itself_while_nothing_plays() {
    let player = Player::new();
    assert_eq!(player.app.frame_interval(), None);
    let player = player.press("Enter");
    assert!(player.app.frame_interval().is_some());
    let player = player.answer();
    assert_eq!(player.app.frame_interval(), None);
    let player = player.press("Space");
    assert!(player.app.frame_interval().is_some());
    assert_eq!(player.wait(1e3).app.frame_interval(), None, "playback ends at the end");
}

#[test]
fn a_shot_that_is_left_does_not_play_on_unseen() {
    for leave in ["Esc", "Tab", "2"] {
        let player = Player::new().press("Enter").answer().press("Space").wait(0.5).press(leave);
        assert_eq!(player.app.frame_interval(), None, "{leave}");
        assert!(!player.app.playback().playing);
    }
}
