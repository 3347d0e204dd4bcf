//! Tests of the coach through its public interface.

use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{clock::Clock, draws::Worlds, pool::Candidate, trial::Task, *};
use crate::{
    game::{Rule, pushes_touching_ball, scores},
    learning::evaluation::held_out_layouts,
    physics::{CueInputs, collides, has_room},
    table::{Layout, LayoutError, Opening, Room, Side, Table},
};

fn coach() -> Coach {
    Coach::new(Table::default())
}

/// A request that is limited by simulations, not by time.
fn request(rule: Rule, simulations: u64) -> Request {
    Request { rule, skill: Skill::EXPERT, simulations, budget: Duration::from_secs(60), ..Request::default() }
}

#[test]
fn solved_recommendation_makes_the_point_under_every_rule() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(21);
    for name in ["match", "thesis"] {
        let coach = Coach::new(Table::preset(name).unwrap());
        for rule in Rule::ALL {
            let layout = Layout::random(coach.table(), &mut rng);
            for skill in [Skill::PERFECT, Skill::CLUB] {
                let advice = coach.recommend(&layout, &Request { skill, ..request(rule, 5_000) }).unwrap();
                assert!(advice.solved, "{name} {rule}");
                for cue in advice.alternatives.iter().map(|shot| &shot.cue).chain([&advice.cue]) {
                    assert!(scores(rule, coach.table(), &layout, cue));
                    cue.validate().unwrap();
                    cue.validate_tip(coach.table().miscue_limit).unwrap();
                }
            }
        }
    }
}

#[test]
fn judge_agrees_with_the_coachs_own_estimate() {
    let coach = coach();
    let layout = held_out_layouts(coach.table(), 1, 5)[0];
    let shooter = Shooter { skill: Skill::CLUB, doubt: Doubt::FULL };
    let asked = Request { skill: Skill::CLUB, doubt: Doubt::FULL, seed: 7, ..request(Rule::ThreeCushion, 3_000) };
    let advice = coach.recommend(&layout, &asked).unwrap();
    let others = advice.alternatives.iter().map(|other| (other.cue, other.make_probability, other.judged_from));
    for (cue, said, from) in others.chain([(advice.cue, advice.make_probability, advice.judged_from)]) {
        let said = said.unwrap();
        let attempts = from..from + said.trials;
        assert_eq!(judge(shooter, asked.rule, coach.table(), &layout, &cue, attempts, asked.seed), said);
    }
}

/// A shot that was compared with others is rated by other attempts than those that chose it, also if another one has taken the lead at the
/// end; an attempt range that starts at 0 would give the rate that chose it.
#[test]
fn leader_is_rated_by_attempts_that_did_not_choose_it() {
    let coach = coach();
    let layout = held_out_layouts(coach.table(), 1, 5)[0];
    let asked = |seed| Request { skill: Skill::CLUB, seed, ..request(Rule::ThreeCushion, 1_000) };
    let mut starts = std::collections::BTreeSet::new();
    for seed in 0..60 {
        let advice = coach.recommend(&layout, &asked(seed)).unwrap();
        let said = advice.make_probability.unwrap();
        let attempts = advice.judged_from..advice.judged_from + said.trials;
        let shooter = asked(seed).shooter();
        if starts.insert(advice.judged_from) {
            assert_eq!(judge(shooter, Rule::ThreeCushion, coach.table(), &layout, &advice.cue, attempts, seed), said);
        }
    }
    // The first shot stays, or another one takes the lead; with nothing to compare, all attempts are unused.
    assert!(starts.iter().filter(|start| **start > 0).count() == 2, "{starts:?}");
}

/// The estimate uses errors that took no part in the choice, so it must agree with a plain Monte Carlo estimate of a
/// hundred thousand attempts. Four standard errors are exceeded once in 16,000 such comparisons.
#[test]
fn make_probability_agrees_with_100000_simulations() {
    let coach = coach();
    let (mut within, mut layouts) = (0, 0);
    for rule in [Rule::StraightRail, Rule::ThreeCushion] {
        for layout in held_out_layouts(coach.table(), 4, 5) {
            // Few simulations choose among noisy estimates: an estimate from the same errors would be too high.
            let advice = coach.recommend(&layout, &Request { seed: layouts, ..request(rule, 3_000) }).unwrap();
            let said = advice.make_probability.unwrap();
            let plain = make_probability(Skill::EXPERT, rule, coach.table(), &layout, &advice.cue, 100_000, 99);
            let deviation = (plain.rate * (1.0 - plain.rate) / said.trials as f64).sqrt();
            assert!((said.rate - plain.rate).abs() < 4.0 * deviation + 2e-3, "{rule}: {said:?} {plain:?}");
            within += u32::from(said.low <= plain.rate && plain.rate <= said.high);
            layouts += 1;
        }
    }
    // Of eight 95 % intervals, two or more miss in one case of seventeen.
    assert!(within >= 6, "{within} of {layouts} intervals hold the plain estimate");
}

#[test]
fn search_improves_on_the_first_successful_shot() {
    let (coach, rule) = (coach(), Rule::ThreeCushion);
    let (mut first, mut best) = (0.0, 0.0);
    for layout in held_out_layouts(coach.table(), 6, 8) {
        let chance = |cue: &CueInputs| make_probability(Skill::EXPERT, rule, coach.table(), &layout, cue, 500, 1).rate;
        let shot = |request: &Request| coach.recommend(&layout, request).unwrap().cue;
        first += chance(&shot(&Request { rule, ..Request::default() }));
        best += chance(&shot(&request(rule, 40_000)));
    }
    assert!(best > first + 0.5 && best > 0.8 * 6.0, "{first} {best}");
}

#[test]
fn answer_does_not_depend_on_the_number_of_threads() {
    let coach = coach();
    let layout = Layout::opening(coach.table());
    for skill in [Skill::PERFECT, Skill::EXPERT] {
        let request = Request { skill, plan: true, ..request(Rule::ThreeCushion, 8_000) };
        let answers = [1, 1, 3].map(|threads| {
            let advice = coach.recommend(&layout, &Request { threads, ..request.clone() }).unwrap();
            (advice.cue, advice.make_probability, advice.alternatives, advice.simulations)
        });
        assert_eq!(answers[0], answers[1]);
        assert_eq!(answers[0], answers[2]);
    }
}

#[test]
fn alternatives_differ_in_kind_and_improvements_are_reported() {
    let coach = coach();
    let mut told = Vec::new();
    let layout = Layout::opening(coach.table());
    let advice =
        coach.recommend_with_progress(&layout, &request(Rule::StraightRail, 30_000), |news| told.push(*news)).unwrap();
    let best = advice.make_probability.unwrap().rate;
    for shot in &advice.alternatives {
        assert!(shot.make_probability.is_none_or(|rate| rate.rate >= 0.5 * best), "{shot:?} beside {best}");
        assert_eq!(shot.next_probability, None, "it was not asked for");
    }
    let mut kinds: Vec<Kind> = advice.alternatives.iter().map(|shot| shot.kind).chain(advice.kind).collect();
    let count = kinds.len();
    kinds.sort();
    kinds.dedup();
    assert!(kinds.len() == count && count >= 3, "{kinds:?}");
    assert!(told.windows(2).all(|news| news[0].cue != news[1].cue) && !told.is_empty(), "each is another shot");
}

#[test]
fn repeated_request_never_worsens_the_advice() {
    let coach = coach();
    let (rule, skill) = (Rule::ThreeCushion, Skill::CLUB);
    let [mut before, mut again, mut anew] = [0.0; 3];
    for layout in held_out_layouts(coach.table(), 4, 11) {
        let asked = |simulations, seed, former: &[CueInputs]| {
            let request = Request { skill, seed, former: former.to_vec(), ..request(rule, simulations) };
            let cue = coach.recommend(&layout, &request).unwrap().cue;
            (cue, make_probability(skill, rule, coach.table(), &layout, &cue, 4000, 1).rate)
        };
        let (good, chance) = asked(60_000, 1, &[]);
        // These searches are too short to find the shot by themselves.
        for seed in [2, 3] {
            let (_, after) = asked(12_000, seed, &[good]);
            assert!(after > chance - 0.03, "{after} after {chance}");
            before += chance;
            again += after;
            anew += asked(12_000, seed, &[]).1;
        }
    }
    assert!(again > before - 0.04 && again > anew + 0.08, "{before} {again} {anew}");
    // For a perfect player the former shot that makes the point is the answer again.
    let layout = Layout::opening(coach.table());
    let [first, second] = ["0.2,0.3,6,-72,2.5", "0,0,0,10,3"].map(|cue| CueInputs::parse(cue).unwrap());
    let bare = Coach::without_policy(Table { opening: Opening::Thesis, ..coach.table().clone() });
    let request = Request { skill: Skill::PERFECT, former: vec![second, first], ..request(Rule::StraightRail, 5_000) };
    assert_eq!(bare.recommend(&layout, &request).unwrap().cue, first);
}

#[test]
fn zero_budget_gives_an_unsolved_attempt() {
    let coach = Coach::without_policy(Table::preset("thesis").unwrap());
    for skill in [Skill::PERFECT, Skill::EXPERT] {
        let request = Request { rule: Rule::ThreeCushion, skill, budget: Duration::ZERO, ..Request::default() };
        let advice = coach.recommend(&Layout::opening(coach.table()), &request).unwrap();
        advice.cue.validate().unwrap();
        assert!(!advice.solved && advice.alternatives.is_empty() && advice.make_probability.is_none());
        assert_eq!(advice.simulations, 0);
    }
}

/// The policy's own shots are tried even without time.
#[test]
fn zero_budget_judges_policy_shot_and_omits_unknown_values() {
    let coach = coach();
    let layout = Layout::opening(coach.table());
    let advice = |seed| {
        let request = Request { skill: Skill::EXPERT, plan: true, budget: Duration::ZERO, seed, ..Request::default() };
        coach.recommend(&layout, &request).unwrap()
    };
    let first: Vec<_> = (0..5).map(advice).collect();
    assert!(first.iter().all(|advice| advice.solved && advice.next_probability.is_none()));
    // Other load on the machine may delay the threads for these few milliseconds, but not every time.
    let is_judged = |advice: &Recommendation| advice.make_probability.is_some();
    assert!(first.iter().any(is_judged) || (5..200).any(|seed| is_judged(&advice(seed))), "{first:?}");
}

#[test]
fn cancelled_search_returns_the_best_shot_so_far() {
    let coach = coach();
    let request = Request { budget: Duration::from_secs(3600), skill: Skill::EXPERT, ..Request::default() };
    let cancel = Arc::clone(&request.cancel);
    let advice = thread::scope(|scope| {
        let search = scope.spawn(|| coach.recommend(&Layout::opening(coach.table()), &request).unwrap());
        thread::sleep(Duration::from_millis(100));
        cancel.store(true, Ordering::Relaxed);
        search.join().unwrap()
    });
    assert!(advice.elapsed < Duration::from_secs(5), "{:?}", advice.elapsed);
    assert!(advice.solved && advice.simulations > 0);
}

#[test]
fn stiff_contacts_do_not_exceed_the_time_budget() {
    let coach = Coach::new(Table::preset("thesis").unwrap());
    for layout in held_out_layouts(coach.table(), 5, 2) {
        let budget = Duration::from_millis(60);
        let request = Request { skill: Skill::EXPERT, rule: Rule::StraightRail, budget, ..Request::default() };
        // Other load on the machine may delay a thread, but not every time.
        let elapsed = (0..20).map(|_| coach.recommend(&layout, &request).unwrap().elapsed);
        assert!(elapsed.take(20).any(|elapsed| elapsed < budget + Duration::from_millis(150)));
    }
}

/// Nearly every stroke at these balls ends in a slow contact, and hardly one in a thousand makes the point.
#[test]
fn rare_shot_is_found_despite_stiff_contacts() {
    let coach = Coach::new(Table::preset("thesis").unwrap());
    let layout = Layout::parse("-0.9,0.1 0.3,0.3 0.6,-0.5", coach.table()).unwrap();
    for seed in 1..=5 {
        // Two seconds are enough on an idle machine.
        let finds = |seconds| {
            let request =
                Request { rule: Rule::ThreeCushion, budget: Duration::from_secs(seconds), seed, ..Request::default() };
            coach.recommend(&layout, &request).unwrap().solved
        };
        assert!([2, 60].into_iter().any(finds), "seed {seed}");
    }
}

#[test]
fn perfect_player_never_misses() {
    let coach = coach();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let request = Request { skill: Skill::PERFECT, ..request(Rule::OneCushion, u64::MAX) };
    let until = std::time::Instant::now() + Duration::from_secs(60);
    let layout = Layout::opening(coach.table());
    let played = inning(&coach, &layout, &request, 20, until, &mut rng, &mut |_, _| {}).unwrap();
    assert_eq!((played.points, played.missed), (20, false));
}

#[test]
fn opening_advice_must_hit_red_first() {
    let table = Table { opening: Opening::Umb, ..Table::default() };
    let coach = Coach::new(table.clone());
    for side in [Side::Left, Side::Right] {
        let layout = Layout::opening_on(&table, side);
        for (rule, skill) in [
            (Rule::ThreeCushion, Skill::EXPERT),
            (Rule::ThreeCushion, Skill::PERFECT),
            (Rule::StraightRail, Skill::EXPERT),
        ] {
            let advice = coach.recommend(&layout, &Request { skill, ..request(rule, 10_000) }).unwrap();
            assert!(advice.solved && scores(rule, &table, &layout, &advice.cue));
            let kinds = advice.alternatives.iter().map(|shot| shot.kind).chain(advice.kind);
            assert!(kinds.into_iter().all(|kind| kind.first_ball == 2), "{advice:?}");
        }
        let elsewhere = Layout::new(layout.balls.map(|ball| ball + DVec2::new(0.0, 0.1)));
        let free = coach.recommend(&elsewhere, &request(Rule::StraightRail, 10_000)).unwrap();
        assert!(free.alternatives.iter().map(|shot| shot.kind).chain(free.kind).any(|kind| kind.first_ball == 1));
    }
}

/// Random layouts; in every third one the balls are at the rails.
fn many_layouts(table: &Table, count: usize) -> Vec<Layout> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(16);
    let reach = table.reach();
    let mut at_rails = |layout: Layout| loop {
        let moved = Layout::new(layout.balls.map(|ball| {
            // About half of them touch the rail.
            let gap = 0.03 * rng.random_range(-1.0..1.0_f64).max(0.0);
            match rng.random_range(0..5) {
                0 => DVec2::new(reach.x - gap, ball.y),
                1 => DVec2::new(gap - reach.x, ball.y),
                2 => DVec2::new(ball.x, reach.y - gap),
                3 => DVec2::new(ball.x, gap - reach.y),
                _ => DVec2::new((reach.x - gap) * ball.x.signum(), (reach.y - gap) * ball.y.signum()),
            }
        }));
        if moved.validate(table).is_ok() {
            return moved;
        }
    };
    let layouts = held_out_layouts(table, count, 16).into_iter().enumerate();
    layouts.map(|(number, layout)| if number % 3 == 0 { at_rails(layout) } else { layout }).collect()
}

/// Number of strokes reported by the coach that need more room than there is, and the number of all its strokes. Covers
/// the coach with and without networks, experts, perfect players and club players, all rules, and searches without
/// time.
fn strokes_without_room(layouts: usize) -> (usize, usize) {
    let table = Table { room: Some(Room::default()), ..Table::default() };
    let (with, without) = (Coach::new(table.clone()), Coach::without_policy(table.clone()));
    let (mut bad, mut all) = (0, 0);
    for (number, layout) in many_layouts(&table, layouts).iter().enumerate() {
        let coach = if number % 4 == 3 { &without } else { &with };
        let request = Request {
            skill: [Skill::EXPERT, Skill::PERFECT, Skill::CLUB][number / 3 % 3],
            plan: number % 2 == 0,
            seed: number as u64,
            ..request(Rule::ALL[number / 9 % 3], if number % 10 == 9 { 0 } else { 1_500 })
        };
        let mut named: Vec<CueInputs> = coach.policy_shot(layout, request.rule, &request.skill).into_iter().collect();
        let advice = coach.recommend_with_progress(layout, &request, |news| named.push(news.cue)).unwrap();
        named.push(advice.cue);
        named.extend(advice.alternatives.iter().map(|shot| shot.cue));
        all += named.len();
        bad += named.iter().filter(|cue| !has_room(&table, layout, cue) || collides(&table, layout, cue)).count();
    }
    (bad, all)
}

#[test]
fn recommended_strokes_have_room_for_the_cue() {
    let (bad, all) = strokes_without_room(60);
    assert!(bad == 0 && all > 200, "{bad} of {all}");
}

#[test]
#[ignore = "takes minutes: cargo test --profile quick --lib room_on_ten_thousand -- --ignored --nocapture"]
fn recommended_strokes_have_room_on_ten_thousand_layouts() {
    let (bad, all) = strokes_without_room(10_000);
    println!("{bad} of {all} strokes on 10,000 layouts have no room");
    assert_eq!(bad, 0, "of {all}");
}

#[test]
fn touching_ball_is_never_aimed_at() {
    let coach = coach();
    let table = coach.table();
    let touching = DVec2::new(2.0 * table.radius, 0.0);
    for second in [DVec2::new(0.5, 0.1), DVec2::new(-0.6, 0.2)] {
        let layout = Layout::new([DVec2::ZERO, touching, second]);
        for skill in [Skill::PERFECT, Skill::CLUB] {
            let request = Request { skill, ..request(Rule::StraightRail, 20_000) };
            let advice = coach.recommend(&layout, &request).unwrap();
            let mut all = advice.alternatives.iter().map(|shot| shot.cue).chain([advice.cue]);
            assert!(advice.solved && all.all(|cue| !pushes_touching_ball(table, &layout, &cue)));
        }
    }
}

#[test]
fn frozen_cue_ball_gets_strokes_within_the_cue_limits() {
    let free = Coach::without_policy(Table { room: None, ..Table::default() });
    let table = Table { room: Some(Room::default()), ..free.table().clone() };
    let coach = Coach::without_policy(table.clone());
    let layout = Layout::new([DVec2::new(0.1, -table.half_width()), DVec2::new(-0.2, 0.3), DVec2::new(0.6, 0.1)]);
    let request = request(Rule::StraightRail, 20_000);
    let advice = coach.recommend(&layout, &request).unwrap();
    assert!(advice.solved && has_room(&table, &layout, &advice.cue), "{advice:?}");
    let level = free.recommend(&layout, &request).unwrap();
    // The best stroke may be high enough by itself, such as one at the top of the ball.
    let mut named = std::iter::once(level.cue).chain(level.alternatives.iter().map(|other| other.cue));
    assert!(named.any(|cue| !has_room(&table, &layout, &cue)), "something kept these cues up: {level:?}");
}

#[test]
fn invalid_layout_is_refused() {
    let layout = Layout::new([DVec2::ZERO; 3]);
    assert!(matches!(coach().recommend(&layout, &Request::default()), Err(LayoutError::Overlap { .. })));
}

#[test]
fn jumps_are_searched_only_if_allowed_and_simulated() {
    // The exercise "jump-from-near": over red, to yellow.
    let (table, cancel) = (Table::default(), AtomicBool::new(false));
    let layout = Layout::parse("-0.3,0 0.19,-0.08 -0.17,-0.09", &table).unwrap();
    let model = CueInputs::parse("0.05,0.5,22,-13.5,2.4").unwrap();
    let steep = CueInputs::parse("0,0.9,60,90,2").unwrap();
    let frozen = Table { flight: None, ..table.clone() };
    let clock = Clock::start(Duration::from_secs(60), u64::MAX, &cancel);
    let worlds = Worlds::new(&table, &layout, Doubt::NONE);
    let task =
        |table, jumps| Task { jumps, ..Task::new(table, &layout, Rule::StraightRail, Skill::EXPERT, &worlds, &clock) };
    let is_candidate = |jumps| Candidate::new(&task(&table, jumps), model, Source::Search, 0.0).is_some();
    assert!(is_candidate(true) && !is_candidate(false));
    // A steep cue that neither jumps nor bends the path is no candidate; nor is any on a table whose balls stay on the cloth.
    assert!(
        !task(&table, true).allows(&steep) && !task(&frozen, true).allows(&steep) && !task(&frozen, true).seeks_jumps()
    );
    // The search's own jumps make the point here and fly over red.
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let allowed = task(&table, true);
    let found = (0..40_000).filter_map(|_| elevated::random_elevated_stroke(&table, &layout, &mut rng));
    let found = found.filter_map(|cue| Candidate::new(&allowed, cue, Source::Search, 0.0));
    let over = found.filter(|found| Technique::of(&table, &layout, &found.shot.cue).unwrap().over.is_some()).count();
    assert!(over > 0);
}

#[test]
fn forbidden_jumps_and_masses_are_never_recommended() {
    let coach = Coach::without_policy(Table::default());
    let line = "-0.432457,-0.088436 -0.336216,-0.080449 -0.145764,-0.073855";
    let layout = Layout::parse(line, coach.table()).unwrap();
    for rule in Rule::ALL {
        let advice = coach.recommend(&layout, &Request { jumps: false, ..request(rule, 20_000) }).unwrap();
        for cue in std::iter::once(advice.cue).chain(advice.alternatives.iter().map(|shot| shot.cue)) {
            let technique = Technique::of(coach.table(), &layout, &cue).unwrap();
            assert!(!technique.is_jump_or_masse() && cue.theta <= candidates::MAX_ELEVATION, "{rule}: {cue:?}");
        }
    }
}

#[test]
fn recommended_shot_begins_as_requested() {
    let coach = Coach::without_policy(Table::default());
    let layout = Layout::parse("-0.9,-0.3 0.2,0.4 0.9,-0.2", coach.table()).unwrap();
    for skill in [Skill::PERFECT, Skill::CLUB] {
        for (first, begins) in [
            (FirstContact::OtherCueBall, (1, false)),
            (FirstContact::Red, (2, false)),
            (FirstContact::Cushion, (0, true)),
        ] {
            let advice =
                coach.recommend(&layout, &Request { skill, first, ..request(Rule::OneCushion, 20_000) }).unwrap();
            let kinds = advice.kind.into_iter().chain(advice.alternatives.iter().map(|shot| shot.kind));
            let begun: Vec<_> = kinds.map(|kind| (kind.first_ball, kind.cushion_first)).collect();
            let is_wanted = |&(ball, cushion): &(usize, bool)| cushion == begins.1 && (cushion || ball == begins.0);
            assert!(advice.solved && begun.iter().all(is_wanted), "{first:?}, {skill}: {begun:?}");
        }
    }
    // The opening must hit red first, so a request for yellow first has no solution.
    let request = Request { first: FirstContact::OtherCueBall, ..request(Rule::ThreeCushion, 2000) };
    assert!(!coach.recommend(&Layout::opening(coach.table()), &request).unwrap().solved);
}
