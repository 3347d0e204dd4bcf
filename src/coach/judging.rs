//! Judges the candidates of a search by attempts that took no part in it: which one is the answer, how often each is made,
//! and why the answer would be missed.

use std::{
    ops::Range,
    sync::{OnceLock, atomic::AtomicBool},
};

use super::{
    Alternative, Cause, LayoutDifficulty, Recommendation, Request, Risk, Shooter, Skill, Source,
    draws::{Draws, Worlds},
    first::{FirstShots, MAX_ALTERNATIVES},
    next::{MAX_POINTS, next_value},
    pool::Candidate,
    refinement::MIN_IMPROVEMENT,
    trial::{Attempts, Task, UNLIMITED_STEPS, with_unlimited_task},
};
use crate::{
    game::Rule,
    physics::{CueInputs, signed_angle},
    platform::parallel::Team,
    statistics::SuccessRate,
    table::{Layout, Table},
};

/// Independent attempts from which the make probability is estimated. Its standard error is at most 1.6 %, and 0.3 %
/// for a shot that is made 99 times in 100.
const ATTEMPTS: usize = 1000;

/// Attempts for the make probability of each alternative. The first shot is compared with the others by as many.
const ATTEMPTS_PER_ALTERNATIVE: usize = 400;

/// Attempts for each cause of a miss.
const ATTEMPTS_PER_CAUSE: usize = 300;

/// Attempts in one work item of a thread.
const CHUNK_SIZE: usize = 25;

/// Alternatives below this share of the best shot's make probability are not listed: a shot that is made less than half
/// as often is a gamble for a player who wants the point.
const MIN_LISTED_SHARE: f64 = 0.5;

/// Returns the answer for a player who makes errors. Judges the first shot of the (non-empty) pool and the first shots of the
/// other kinds by errors that took no part in the search.
/// A search with few attempts may choose wrongly: if another shot seems to be made more often, both are judged by as
/// many attempts, and the better one is the answer. If there is time, the rates of both and the next point come from attempts
/// that took no part in this choice either, because those that chose a shot flatter it.
pub fn robust_answer(
    found: &FirstShots,
    pool: Vec<Candidate>,
    task: &Task,
    request: &Request,
    team: &Team,
) -> Recommendation {
    let mut pool = one_of_each_kind(pool, task.skill, task.table.radius);
    pool.truncate(1 + MAX_ALTERNATIVES);
    let plan = request.plan;
    // Each piece is drawn by the first thread that needs it, so that no time is spent on pieces that are never used.
    let most = ATTEMPTS_PER_ALTERNATIVE + 2 * ATTEMPTS;
    let attempts: Vec<OnceLock<Draws>> = (0..most).step_by(CHUNK_SIZE).map(|_| OnceLock::new()).collect();
    let draws = |piece: usize| attempts[piece].get_or_init(|| judging_draws(task.worlds, request.seed, piece));
    let pieces_of = |candidates: &[usize], attempts: Range<usize>| -> Vec<(usize, usize)> {
        let pieces = attempts.step_by(CHUNK_SIZE).map(|attempt| attempt / CHUNK_SIZE);
        candidates.iter().flat_map(|candidate| pieces.clone().map(|piece| (*candidate, piece))).collect()
    };
    let judged = |pieces: &[(usize, usize)]| {
        team.map(pieces, |&(index, piece)| (index, piece, task.attempts(&pool[index].shot.cue, draws(piece))))
    };
    let all: Vec<usize> = (0..pool.len()).collect();
    let compared = if pool.len() > 1 { ATTEMPTS_PER_ALTERNATIVE } else { 0 };
    let (mut best, mut fresh) = (0, compared..compared + ATTEMPTS);
    // If time runs out, the comparison is made first.
    let mut made = judged(&[pieces_of(&all, 0..compared), pieces_of(&[best], fresh.clone())].concat());
    let better = made_more_often(&pool, &complete_rates(&made, pool.len(), compared), plan);
    if !better.is_empty() {
        made.extend(judged(&pieces_of(&better, compared..ATTEMPTS)));
        let complete = complete_rates(&made, pool.len(), ATTEMPTS);
        best = made_more_often(&pool, &complete, plan).first().copied().unwrap_or_default();
        fresh = fresh.end..fresh.end + ATTEMPTS;
        // If time runs out, the best one is judged first.
        let rivals = [0].into_iter().chain(better).filter(|index| *index != best);
        let judged_again: Vec<usize> = [best].into_iter().chain(rivals).collect();
        made.extend(judged(&pieces_of(&judged_again, fresh.clone())));
    }
    let rate_of = |index: usize| {
        let unbiased = rate_within(&made, index, fresh.clone()).filter(|rate| rate.trials == ATTEMPTS);
        unbiased.map_or_else(|| (rate_within(&made, index, 0..ATTEMPTS), 0), |rate| (Some(rate), fresh.start))
    };
    let mut rated: Vec<_> = pool.iter().copied().enumerate().map(|(index, shot)| (shot, rate_of(index))).collect();
    rated[..=best].rotate_right(1);
    if let Some(best) = clearly_better(&rated, plan) {
        rated[..=best].rotate_right(1);
    }
    let (pool, rates): (Vec<Candidate>, Vec<_>) = rated.into_iter().unzip();
    let risk = risk(&pool[0].shot.cue, task, request, team);
    let next = team.map(&pool, |candidate| {
        let known = candidate.next.known().filter(|_| plan && LayoutDifficulty::is_known_on(task.table))?;
        // The search's own value flatters a shot that was chosen by it.
        let unused = (fresh.start / CHUNK_SIZE..attempts.len()).flat_map(|piece| draws(piece).iter());
        Some(next_value(task, &candidate.shot.cue, unused, MAX_POINTS).unwrap_or(known))
    });
    let best_rate = rates[0].0.map_or(0.0, |rate| rate.rate);
    let is_worth =
        |shot: &Alternative| shot.make_probability.is_none_or(|rate| rate.rate >= MIN_LISTED_SHARE * best_rate);
    let mut alternatives: Vec<_> = (1..pool.len())
        .map(|index| Alternative {
            cue: pool[index].shot.cue,
            source: pool[index].shot.source,
            kind: pool[index].kind,
            make_probability: rates[index].0,
            judged_from: rates[index].1,
            effort_penalty: pool[index].effort_penalty,
            next_probability: next[index],
        })
        .filter(is_worth)
        .collect();
    // If the next point counts too, the others keep the order of the search.
    if !plan {
        let chance = |shot: &Alternative| shot.make_probability.map_or(0.0, |rate| rate.rate);
        alternatives.sort_by(|one, other| chance(other).total_cmp(&chance(one)));
    }
    Recommendation {
        cue: pool[0].shot.cue,
        solved: true,
        source: pool[0].shot.source,
        kind: Some(pool[0].kind),
        make_probability: rates[0].0,
        judged_from: rates[0].1,
        effort_penalty: pool[0].effort_penalty,
        risk,
        next_probability: next[0],
        alternatives,
        ..found.answer()
    }
}

/// Index of a candidate, index of a piece of the judging attempts, and the candidate's results in this piece.
type JudgedPiece = (usize, usize, Attempts);

/// Returns the rate of a candidate in those of its judged attempts that are among `attempts`; `None` if there are none.
fn rate_within(judged: &[JudgedPiece], candidate: usize, attempts: Range<usize>) -> Option<SuccessRate> {
    let is_own = |(index, piece, _): &&JudgedPiece| *index == candidate && attempts.contains(&(piece * CHUNK_SIZE));
    judged.iter().filter(is_own).map(|(.., part)| *part).sum::<Attempts>().rate()
}

/// Returns the rates of the candidates in the first `count` attempts; `None` if time ran out before all of these were made, because only
/// rates in the same attempts are comparable.
fn complete_rates(judged: &[JudgedPiece], candidates: usize, count: usize) -> Vec<Option<SuccessRate>> {
    let rates = (0..candidates).map(|candidate| rate_within(judged, candidate, 0..count));
    rates.map(|rate| rate.filter(|rate| rate.trials == count)).collect()
}

/// Returns the indices of the shots that are made more often than the first one, less their effort penalties, best
/// first. If the first one is a former answer, another shot must be better by [`MIN_IMPROVEMENT`]. In a `plan`, both points must also be made
/// at least as often, as far as the next one is known, unless nothing is known of either.
fn made_more_often(pool: &[Candidate], rates: &[Option<SuccessRate>], plan: bool) -> Vec<usize> {
    let worth = |index: usize| rates[index].map(|rate| rate.rate - pool[index].effort_penalty);
    let was_advised = pool.first().is_some_and(|first| first.shot.source == Source::Former);
    let least = if was_advised { MIN_IMPROVEMENT } else { 0.0 };
    let is_better = |index: &usize| worth(0).zip(worth(*index)).is_some_and(|(bar, own)| own > bar + least * own.abs());
    let next = |index: usize| pool[index].next.known();
    let leaves_enough = |index: &usize| match (next(0), next(*index)) {
        _ if !plan => true,
        (Some(bar), Some(own)) => {
            rates[0].zip(rates[*index]).is_some_and(|(first, other)| other.rate * own >= first.rate * bar)
        }
        // If neither is known, this point decides alone.
        (bar, own) => bar.is_none() && own.is_none(),
    };
    let mut better: Vec<usize> = (1..pool.len()).filter(is_better).filter(leaves_enough).collect();
    better.sort_by(|one, other| f64::total_cmp(&worth(*other).unwrap_or_default(), &worth(*one).unwrap_or_default()));
    better
}

/// Returns the index of the best shot whose rate contradicts the choice of the first one, also if chance is allowed for; `None` if there is
/// none. The rates may be from other attempts than those that chose it.
fn clearly_better(rated: &[(Candidate, (Option<SuccessRate>, usize))], plan: bool) -> Option<usize> {
    let (pool, rates): (Vec<_>, Vec<_>) = rated.iter().map(|(shot, (rate, _))| (*shot, *rate)).unzip();
    let is_significant = |index: &usize| {
        let both = rates[*index].zip(rates[0]);
        both.is_some_and(|(own, first)| own.is_significantly_above(&first))
    };
    made_more_often(&pool, &rates, plan).into_iter().find(is_significant)
}

/// Estimates how often each cause alone misses a shot; `None` if nothing is in doubt, or time runs out.
fn risk(cue: &CueInputs, task: &Task, request: &Request, team: &Team) -> Option<Risk> {
    if task.worlds.is_certain() || task.clock.is_past(task.deadline) {
        return None;
    }
    let missed = team.map(&Cause::ALL, |cause| {
        let (doubt, errs) = cause.isolated(request.doubt);
        let worlds = Worlds::new(task.table, task.layout, doubt);
        let skill = if errs { task.skill } else { Skill::PERFECT };
        let draws = Draws::independent(ATTEMPTS_PER_CAUSE, &worlds, judging_seed(request.seed));
        let task = Task { worlds: &worlds, skill, ..*task };
        let Attempts { tried, made } = task.attempts(cue, &draws);
        (tried == ATTEMPTS_PER_CAUSE).then(|| 1.0 - made as f64 / ATTEMPTS_PER_CAUSE as f64)
    });
    let [hand, table, placing] = missed[..] else { return None };
    Some(Risk { hand: hand?, table: table?, placing: placing? })
}

/// Keeps the first shot and, in the given order, the first of each other kind. Drops a shot if every input is within
/// one standard error of a kept one:
/// a stroke that makes the point in two ways, depending on its errors, is one stroke.
fn one_of_each_kind(pool: Vec<Candidate>, skill: Skill, radius: f64) -> Vec<Candidate> {
    let mut kept: Vec<Candidate> = Vec::new();
    for candidate in pool {
        let is_new = |other: &Candidate| {
            let (one, cue) = (&other.shot.cue, &candidate.shot.cue);
            let Skill { a, b, theta, phi, speed, .. } = skill.at(one);
            let is_the_same = (one.a - cue.a).abs() <= a / radius
                && (one.b - cue.b).abs() <= b / radius
                && (one.theta - cue.theta).abs() <= theta
                && signed_angle(one.phi, cue.phi).abs() <= phi
                && (one.speed - cue.speed).abs() <= speed;
            other.kind != candidate.kind && !is_the_same
        };
        if kept.iter().all(is_new) {
            kept.push(candidate);
        }
    }
    kept
}

/// Estimates how often a stroke is made in these `attempts` (widened to whole pieces of 25), with the errors by which
/// the answer to a request with `seed` is judged.
/// The result equals the make probability in the answer, if there was time for all of its attempts, for the range that
/// the answer used: from [`Recommendation::judged_from`] or [`Alternative::judged_from`].
pub fn judge(
    shooter: Shooter,
    rule: Rule,
    table: &Table,
    layout: &Layout,
    cue: &CueInputs,
    attempts: Range<usize>,
    seed: u64,
) -> SuccessRate {
    with_unlimited_task(table, layout, rule, shooter, UNLIMITED_STEPS, &AtomicBool::new(false), |task| {
        let pieces = attempts.start / CHUNK_SIZE..attempts.end.div_ceil(CHUNK_SIZE);
        let pieces = pieces.map(|piece| task.attempts(cue, &judging_draws(task.worlds, seed, piece)));
        let Attempts { made, tried } = pieces.sum();
        SuccessRate::new(made, tried)
    })
}

/// Draws one piece of the errors by which the answer to a request with `seed` is judged. Its random stream differs from that
/// of the search.
fn judging_draws(worlds: &Worlds, seed: u64, piece: usize) -> Draws {
    Draws::independent(CHUNK_SIZE, worlds, judging_seed(seed).wrapping_add(piece as u64))
}

/// The streams of neighbouring seeds are far apart, so that the pieces of one request are not those of the next. The factor (Steele and Vigna
/// 2022) is not the increment of the generator that spreads a seed, with which neighbours would share most of their states.
const fn judging_seed(seed: u64) -> u64 {
    (seed ^ 0x6a75_6467_6521).wrapping_mul(0xd134_2543_de82_ef95)
}

#[cfg(test)]
mod tests {
    use std::{f64::consts::PI, time::Duration};

    use super::*;
    use crate::{
        coach::{Coach, Kind, Route, Suggestion, next::NextValue},
        game::Tally,
        learning::evaluation::held_out_layouts,
    };

    /// The search picks a shot whose own attempts left easy next points: its estimate was 1.3 (± 0.4) points above that from 400 other
    /// points (150 layouts at straight rail, a club player, 3,000 simulations).
    #[test]
    fn next_point_is_estimated_by_attempts_that_did_not_choose_the_shot() {
        let coach = Coach::new(Table::default());
        let request = Request {
            skill: Skill::CLUB,
            plan: true,
            simulations: 3_000,
            budget: Duration::from_secs(60),
            seed: 5,
            ..Request::default()
        };
        let cancel = AtomicBool::new(false);
        for layout in held_out_layouts(coach.table(), 3, 31) {
            let advice = coach.recommend(&layout, &request).unwrap();
            let (table, shooter) = (coach.table(), request.shooter());
            let next = with_unlimited_task(table, &layout, request.rule, shooter, UNLIMITED_STEPS, &cancel, |task| {
                let pieces = advice.judged_from / CHUNK_SIZE..(advice.judged_from + ATTEMPTS) / CHUNK_SIZE;
                let draws: Vec<Draws> = pieces.map(|piece| judging_draws(task.worlds, request.seed, piece)).collect();
                next_value(task, &advice.cue, draws.iter().flat_map(Draws::iter), MAX_POINTS)
            });
            assert!(
                advice.judged_from >= ATTEMPTS_PER_ALTERNATIVE && next.is_some() && advice.next_probability == next
            );
        }
    }

    fn candidate(cue: CueInputs, way: Route, effort_penalty: f64) -> Candidate {
        let candidate = Candidate::of(Suggestion { cue, source: Source::Search }, &Tally::default(), 0.0);
        Candidate { kind: Kind { route: way, ..candidate.kind }, effort_penalty, ..candidate }
    }

    #[test]
    fn requests_with_neighbouring_seeds_are_judged_by_different_errors() {
        let pieces = |seed| (0..100).map(move |piece| judging_seed(seed).wrapping_add(piece));
        let all: std::collections::HashSet<u64> = (0..1000).flat_map(pieces).collect();
        assert_eq!(all.len(), 100_000);
    }

    #[test]
    fn shots_are_compared_by_the_same_attempts_only() {
        let pieces = |candidate, tried: usize, made| {
            let whole =
                (0..tried / CHUNK_SIZE).map(move |piece| (candidate, piece, Attempts { tried: CHUNK_SIZE, made }));
            whole.chain([(candidate, tried / CHUNK_SIZE, Attempts { tried: tried % CHUNK_SIZE, made: 0 })])
        };
        // Time ran out after 13 attempts of the third shot, all of them made.
        let cut = (2, 0, Attempts { tried: 13, made: 13 });
        let judged: Vec<_> = pieces(0, 1000, 10).chain(pieces(1, 400, 15)).chain([cut]).collect();
        let trials =
            |count| complete_rates(&judged, 3, count).iter().map(|rate| rate.map(|rate| rate.trials)).collect();
        let [some, all]: [Vec<_>; 2] = [trials(400), trials(1000)];
        assert_eq!((some, all), (vec![Some(400), Some(400), None], vec![Some(1000), None, None]));
    }

    #[test]
    fn made_more_often_returns_better_shots_best_first() {
        let cue = CueInputs { a: 0.0, b: 0.3, theta: 0.01, phi: 1.0, speed: 3.0 };
        // The first is made 220 times in 1000. Each of the others has a count of made attempts in 400 and an effort penalty.
        let better = |others: &[(usize, f64)]| {
            let mut pool = vec![candidate(cue, Route::Direct, 0.0)];
            pool.extend(others.iter().map(|(_, penalty)| candidate(cue, Route::OffCushion, *penalty)));
            let mut rates = vec![Some(SuccessRate::new(220, 1000))];
            rates.extend(others.iter().map(|(made, _)| (*made > 0).then(|| SuccessRate::new(*made, 400))));
            made_more_often(&pool, &rates, false)
        };
        assert!(better(&[]).is_empty());
        assert!(better(&[(0, 0.0), (85, 0.0)]).is_empty());
        assert!(better(&[(133, 0.15)]).is_empty());
        assert_eq!(better(&[(90, 0.0), (0, 0.0), (133, 0.0)]), [3, 1]);
        let next = [NextValue::Known(0.5), NextValue::Known(0.6), NextValue::Known(0.3), NextValue::Assumed(0.9)];
        let pool = next.map(|next| Candidate { next, ..candidate(cue, Route::Direct, 0.0) });
        let rates = [200, 300, 300, 300].map(|made| Some(SuccessRate::new(made, 1000)));
        assert_eq!(made_more_often(&pool, &rates, true), [1], "both points are made less often, or that is not known");
        let harder = [pool[0], Candidate { next: NextValue::Known(0.4), ..pool[2] }];
        assert_eq!(made_more_often(&harder, &rates[..2], true), [1], "0.3 times 0.4 is more than 0.2 times 0.5");
        let unknown = [pool[3], pool[2], pool[3]];
        assert_eq!(made_more_often(&unknown, &rates[..3], true), [2], "of neither is the next shot known");
    }

    #[test]
    fn similar_strokes_are_not_listed_as_alternatives() {
        let meant = CueInputs { a: 0.0, b: 0.3, theta: 0.01, phi: 1.0, speed: 3.0 };
        let candidate = |way, phi: f64| {
            let cue = CueInputs { phi: meant.phi + phi * Skill::EXPERT.at(&meant).phi, ..meant };
            candidate(cue, way, 0.0)
        };
        let kept = |ways: &[(Route, f64)]| {
            let pool = ways.iter().map(|&(way, phi)| candidate(way, phi)).collect();
            let kept = one_of_each_kind(pool, Skill::EXPERT, Table::default().radius);
            kept.iter().map(|candidate| candidate.kind.route).collect::<Vec<_>>()
        };
        assert_eq!(kept(&[(Route::OffCushion, 0.0), (Route::AroundTheTable, 0.5)]), [Route::OffCushion]);
        assert_eq!(
            kept(&[
                (Route::OffCushion, 0.0),
                (Route::AroundTheTable, 2.0),
                (Route::Direct, 1.5),
                (Route::OffCushion, 9.0)
            ]),
            [Route::OffCushion, Route::AroundTheTable]
        );
        let turned = |phi: f64| Candidate {
            shot: Suggestion { cue: CueInputs { phi, ..meant }, source: Source::Search },
            ..candidate(if phi > 0.0 { Route::Direct } else { Route::OffCushion }, 0.0)
        };
        let pool = vec![turned(PI - 1e-5), turned(1e-5 - PI)];
        let kept = one_of_each_kind(pool, Skill::EXPERT, Table::default().radius);
        assert_eq!(kept.len(), 1, "the same direction");
    }
}
