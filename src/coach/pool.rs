//! The candidates of a search and their ranking: by the share of the same random errors under which each makes the point.

use std::{collections::BTreeMap, ops::Range};

use super::{
    Kind, Source, Suggestion,
    candidates::{MAX_ELEVATION, MAX_SPEED},
    draws::{Draw, ErrorSize, QuasiRandomDraws, Worlds},
    evidence::{Rate, Trial},
    next::{NextValue, next_value},
    trial::Task,
};
use crate::{game::Tally, physics::CueInputs, player::errors::Errors};

/// Weight of a point under the larger errors, relative to one under the player's own errors.
const LARGER_ERROR_WEIGHT: f64 = 0.3;

/// Maximum speed of usual strokes, m/s. The ball leaves such a stroke at 5.6 m/s; one of 91 filmed shots is faster.
pub const MAX_USUAL_SPEED: f64 = 4.0;

/// Effort of every m/s beyond [`MAX_USUAL_SPEED`]. A harder stroke is not worth one or two percent: effects that are not
/// simulated, such as how high a ball rises from a cushion nose that pressed it down, make it less certain than it
/// looks.
/// With this penalty a club player strikes 2.5 % of the three-cushion shots harder than 5 m/s, without it 5.8 %; the
/// make rate stays the same within 0.2 % (120 layouts).
const EXTRA_SPEED_EFFORT: f64 = 2.0;

/// Penalty for a shot that hits the first ball twice before the second: nobody intends this, and the model is least
/// reliable after a kiss. A club player makes as many points with it: 33.8 instead of 33.9 % at three cushions and 60.2
/// instead of 60.2 % at straight rail (300 layouts each).
pub const DOUBLE_HIT_PENALTY: f64 = 0.05;

/// Attempts in a block; the last one has larger errors.
pub const ATTEMPTS_PER_BLOCK: usize = 4;

/// The random errors on which shots are compared, in blocks: common random numbers for all shots.
#[derive(Debug)]
pub struct Race {
    own_errors: QuasiRandomDraws,
    larger_errors: QuasiRandomDraws,
}

impl Race {
    /// Creates the race for the errors that `seed` draws.
    pub fn new(seed: u64) -> Self {
        Self {
            own_errors: QuasiRandomDraws::new(ErrorSize::Own, seed),
            larger_errors: QuasiRandomDraws::new(ErrorSize::Larger, !seed),
        }
    }

    /// Draws errors for at least this number of blocks, each attempt in one of the worlds.
    pub fn extend_to(&mut self, worlds: &Worlds, blocks: usize) {
        self.own_errors.extend_to(worlds, (ATTEMPTS_PER_BLOCK - 1) * blocks);
        self.larger_errors.extend_to(worlds, blocks);
    }

    /// Returns the errors and the world of one attempt; `None` if they are not drawn yet.
    fn draw(&self, attempt: usize) -> Option<(Draw<'_>, ErrorSize)> {
        let (block, n) = (attempt / ATTEMPTS_PER_BLOCK, attempt % ATTEMPTS_PER_BLOCK);
        let (draws, index, size) = if n < ATTEMPTS_PER_BLOCK - 1 {
            (&self.own_errors, (ATTEMPTS_PER_BLOCK - 1) * block + n, ErrorSize::Own)
        } else {
            (&self.larger_errors, block, ErrorSize::Larger)
        };
        Some((draws.drawn().get(index)?, size))
    }

    /// Returns the errors of each attempt in these blocks, as far as they are drawn.
    pub fn errors(&self, blocks: Range<usize>) -> impl Iterator<Item = (Errors, ErrorSize)> + Clone {
        let attempts = ATTEMPTS_PER_BLOCK * blocks.start..ATTEMPTS_PER_BLOCK * blocks.end;
        attempts.filter_map(|attempt| self.draw(attempt).map(|(draw, size)| (*draw.errors, size)))
    }

    /// Estimates the probability of the next point after a candidate, from up to `points` successful attempts. `None`
    /// if no attempt makes the point, or time ran out.
    pub fn estimate_next_point(&self, task: &Task, candidate: &Candidate, points: usize) -> Option<Candidate> {
        let next = NextValue::Known(next_value(task, &candidate.shot.cue, self.own_errors.drawn().iter(), points)?);
        Some(Candidate { next, ..*candidate })
    }

    /// Tries a stroke at the errors of these blocks; `None` if time ran out, or they are not drawn.
    pub fn attempts(&self, task: &Task, cue: &CueInputs, blocks: Range<usize>) -> Option<Vec<Trial>> {
        let all = ATTEMPTS_PER_BLOCK * blocks.start..ATTEMPTS_PER_BLOCK * blocks.end;
        let wanted = all.len();
        let tried = all.map_while(|attempt| {
            let (draw, size) = self.draw(attempt).filter(|_| !task.clock.is_past(task.deadline))?;
            Some((*draw.errors, size, task.makes(cue, draw)?))
        });
        let trials: Vec<Trial> = tried.collect();
        task.clock.count(trials.len() as u64);
        (trials.len() == wanted).then_some(trials)
    }

    /// Tries a candidate at the errors up to this block; `None` if time ran out.
    pub fn advance(&self, task: &Task, candidate: &Candidate, blocks: usize) -> Option<Candidate> {
        let mut after = *candidate;
        for (_, size, made) in self.attempts(task, &after.shot.cue, after.tried / ATTEMPTS_PER_BLOCK..blocks)? {
            after.points |= u32::from(made) << after.tried;
            after.tried += 1;
            let rate = if size == ErrorSize::Own { &mut after.own_rate } else { &mut after.larger_error_rate };
            rate.attempts += 1.0;
            rate.share += (f64::from(u8::from(made)) - rate.share) / rate.attempts;
        }
        Some(after)
    }
}

/// A shot that makes the point when it is played as intended, and its results in the race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The shot.
    pub shot: Suggestion,
    /// The kind of the shot.
    pub kind: Kind,
    /// Attempts of the race that this shot itself was tried at, at most the number of bits of `points`.
    pub tried: usize,
    /// Which of these attempts made the point: one bit each, the first attempt in the lowest bit.
    pub points: u32,
    /// Estimated make rate under the player's errors. It flatters a shot that was chosen by it.
    pub own_rate: Rate,
    /// Estimated make rate under the larger errors.
    pub larger_error_rate: Rate,
    /// Probability of the next point; assumed to be 1 until it is estimated.
    pub next: NextValue,
    /// Penalty for a stroke that is hard to play or that hits the first ball twice, independent of its errors.
    pub effort_penalty: f64,
}

impl Candidate {
    /// Makes a candidate of `cue`, raised if it must be, if it makes the point. `weight` is the cost of effort: it
    /// prefers the softer and more level of two equally successful strokes.
    pub fn new(task: &Task, cue: CueInputs, source: Source, weight: f64) -> Option<Self> {
        let cue = task.playable(&cue)?;
        let tally = task.play(&cue)?;
        task.clock.count(1);
        task.is_solution(&cue, &tally).then(|| Self::of(Suggestion { cue, source }, &tally, weight))
    }

    /// Creates the candidate for a shot with this tally, which must make the point.
    pub fn of(shot: Suggestion, tally: &Tally, weight: f64) -> Self {
        let cue = &shot.cue;
        Self {
            shot,
            kind: Kind::of(tally, cue),
            tried: 0,
            points: 0,
            own_rate: Rate::default(),
            larger_error_rate: Rate::default(),
            next: NextValue::Assumed(1.0),
            effort_penalty: weight * effort(cue) + if tally.hit_again { DOUBLE_HIT_PENALTY } else { 0.0 },
        }
    }

    /// Returns the ranking criterion.
    pub fn score(&self) -> f64 {
        let larger = if self.larger_error_rate.attempts > 0.0 { self.larger_error_rate } else { self.own_rate };
        (self.own_rate.share + LARGER_ERROR_WEIGHT * larger.share) * self.next.value() - self.effort_penalty
    }
}

/// Rates how hard a stroke is to play, independent of its errors: its share of the steepest cue plus its share of the hardest
/// stroke, plus an extra for speeds beyond the usual.
fn effort(cue: &CueInputs) -> f64 {
    cue.theta / MAX_ELEVATION + cue.speed / MAX_SPEED + EXTRA_SPEED_EFFORT * (cue.speed - MAX_USUAL_SPEED).max(0.0)
}

/// Assigns the worst known next value to all candidates without one, so that a lack of time cannot make a shot better.
pub fn assign_worst_next_value<'c>(candidates: impl Iterator<Item = &'c mut Candidate>) {
    let candidates: Vec<_> = candidates.collect();
    let worst = candidates.iter().filter_map(|candidate| candidate.next.known()).fold(1.0, f64::min);
    for candidate in candidates.into_iter().filter(|candidate| candidate.next.known().is_none()) {
        candidate.next = NextValue::Assumed(worst);
    }
}

/// Minimum share of the best score for a jump or massé to be kept as one of its kind. Usual shots of all kinds are kept
/// because they may still improve; jumps and massés cost as much and hardly ever lead.
const MIN_ELEVATED_SCORE: f64 = 0.8;

/// Sorts the candidates, best first (stable), and keeps the first `best`, the first `of_each` of every kind, and the
/// former recommendation, which a few unlucky attempts must not drop.
pub fn retain_best(candidates: &mut Vec<Candidate>, best: usize, of_each: usize) {
    candidates.sort_by(|a, b| b.score().total_cmp(&a.score()));
    let mut seen: BTreeMap<Kind, usize> = BTreeMap::new();
    let mut place = 0;
    let bar = candidates.first().map_or(0.0, |best| MIN_ELEVATED_SCORE * best.score());
    candidates.retain(|candidate| {
        let rank = seen.entry(candidate.kind).or_default();
        *rank += 1;
        place += 1;
        let is_former = candidate.shot.source == Source::Former;
        place <= best || is_former || *rank <= of_each && (!candidate.kind.raised || candidate.score() >= bar)
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(cue: CueInputs, share: f64, next: NextValue) -> Candidate {
        Candidate {
            tried: 32,
            own_rate: Rate { share, attempts: 24.0 },
            larger_error_rate: Rate { share: 1.0, attempts: 8.0 },
            next,
            ..Candidate::of(Suggestion { cue, source: Source::Search }, &Tally::default(), 0.0)
        }
    }

    #[test]
    fn candidates_without_next_value_rank_behind_good_ones() {
        let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: 2.0 };
        let candidate = |share, next| candidate(cue, share, next);
        let (good, bad, unseen) = (NextValue::Known(0.9), NextValue::Known(0.6), NextValue::Assumed(1.0));
        let mut pool = vec![candidate(1.0, unseen), candidate(1.0, bad), candidate(0.9, good)];
        assign_worst_next_value(pool.iter_mut());
        retain_best(&mut pool, 3, 1);
        assert_eq!(pool.iter().map(|shot| shot.next.known()).collect::<Vec<_>>(), [Some(0.9), None, Some(0.6)]);
        // If no candidate has a known value, none gets worse.
        let mut pool = [candidate(1.0, unseen)];
        assign_worst_next_value(pool.iter_mut());
        assert_eq!(pool[0].next, unseen);
    }
}
