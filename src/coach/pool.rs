//! Candidates of a search and how they stand: ranked by the share of the same errors under which each makes the point.

use std::ops::Range;

use super::{
    Kind, Source, Suggestion,
    candidates::{MAX_ELEVATION, MAX_SPEED},
    draws::{Draw, ErrorSize, QuasiRandomDraws, Worlds},
    evidence::{Rate, Trial},
    next::{NextValue, next_value},
    trial::Task,
};
use crate::{game::Tally, physics::CueInputs, player::errors::Errors};

/// What a point under the larger errors is worth against one under the player's own.
const WORTH_OF_LARGER: f64 = 0.3;

/// Speed up to which strokes are usual, m/s. The ball leaves such a stroke at 5.6 m/s, and one of 91 filmed shots is faster.
const HARDEST_USUAL: f64 = 4.0;

/// Effort of every m/s beyond. A harder stroke is not worth a point or two in a hundred: what is not simulated, such as how high
/// a ball comes off a nose that pressed it down, makes it less certain than it looks. With it 2.5 % of the three-cushion
/// shots for a club player are struck harder than 5 m/s, without 5.8 %, and as many of all are made within 0.2 in a hundred
/// (120 layouts).
const HARDER: f64 = 2.0;

/// What is taken off for a shot that meets the first ball twice before the second: nobody means it so, and after a kiss a model
/// knows least where balls go. A club player makes as many points with it, 33.8 of 33.9 % at three cushions and 60.2 of
/// 60.2 at straight rail (300 layouts each).
const AGAIN: f64 = 0.05;

/// Attempts of a block: the last of them is at larger errors.
pub const BLOCK: usize = 4;

/// The errors that shots are compared on, in blocks: each shot has the same ones, as far as it is tried.
#[derive(Debug)]
pub struct Race {
    own: QuasiRandomDraws,
    larger: QuasiRandomDraws,
}

impl Race {
    /// With the errors that `seed` draws.
    pub fn new(seed: u64) -> Self {
        Self {
            own: QuasiRandomDraws::new(ErrorSize::Own, seed),
            larger: QuasiRandomDraws::new(ErrorSize::Larger, !seed),
        }
    }

    /// Makes sure that shots can be tried at so many blocks of errors, each in one of the worlds.
    pub fn extend_to(&mut self, worlds: &Worlds, blocks: usize) {
        self.own.extend_to(worlds, (BLOCK - 1) * blocks);
        self.larger.extend_to(worlds, blocks);
    }

    /// The errors of one attempt, and in which world.
    fn draw(&self, attempt: usize) -> Option<(Draw<'_>, ErrorSize)> {
        let (block, n) = (attempt / BLOCK, attempt % BLOCK);
        let (draws, index, size) = if n < BLOCK - 1 {
            (&self.own, (BLOCK - 1) * block + n, ErrorSize::Own)
        } else {
            (&self.larger, block, ErrorSize::Larger)
        };
        Some((draws.drawn().range(index, index + 1).next()?, size))
    }

    /// What its errors make of each attempt in these blocks, as far as they are drawn.
    pub fn errors(&self, blocks: Range<usize>) -> impl Iterator<Item = (Errors, ErrorSize)> + Clone {
        let attempts = BLOCK * blocks.start..BLOCK * blocks.end;
        attempts.filter_map(|attempt| self.draw(attempt).map(|(draw, size)| (*draw.errors, size)))
    }

    /// Finds out how easy the next point is after a candidate, by so many `points` if it makes them; `None` where none of its attempts
    /// makes the point, or time ran out.
    pub fn look_ahead(&self, task: &Task, candidate: &Candidate, points: usize) -> Option<Candidate> {
        let next = NextValue::Known(next_value(task, &candidate.shot.cue, self.own.drawn(), points)?);
        Some(Candidate { next, ..*candidate })
    }

    /// Tries a stroke at the errors of these blocks; `None` where time ran out, or they are not drawn.
    pub fn attempts(&self, task: &Task, cue: &CueInputs, blocks: Range<usize>) -> Option<Vec<Trial>> {
        let all = BLOCK * blocks.start..BLOCK * blocks.end;
        let wanted = all.len();
        let tried = all.map_while(|attempt| {
            let (draw, size) = self.draw(attempt).filter(|_| !task.clock.is_past(task.until))?;
            Some((*draw.errors, size, task.makes(cue, draw)?))
        });
        let trials: Vec<Trial> = tried.collect();
        task.clock.count(trials.len() as u64);
        (trials.len() == wanted).then_some(trials)
    }

    /// Tries a candidate at the errors up to this block; `None` where time ran out.
    pub fn go_on(&self, task: &Task, candidate: &Candidate, blocks: usize) -> Option<Candidate> {
        let mut after = *candidate;
        for (_, size, made) in self.attempts(task, &after.shot.cue, after.tried / BLOCK..blocks)? {
            after.points |= u32::from(made) << after.tried;
            after.tried += 1;
            let rate = if size == ErrorSize::Own { &mut after.own } else { &mut after.larger };
            rate.attempts += 1.0;
            rate.share += (f64::from(u8::from(made)) - rate.share) / rate.attempts;
        }
        Some(after)
    }
}

/// A shot that makes the point when it is played as meant, and how it does in the race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The shot.
    pub shot: Suggestion,
    /// What sort of shot.
    pub kind: Kind,
    /// Attempts of the race that it was tried at by itself, at most as many as `points` has bits.
    pub tried: usize,
    /// Which of them made the point: one bit each, the first is the lowest.
    pub points: u32,
    /// How often it is made under the player's errors, as far as is known; it flatters whoever was chosen by it.
    pub own: Rate,
    /// The same under the larger errors.
    pub larger: Rate,
    /// Probability of the next point; supposed to be 1 until candidates are looked at for it.
    pub next: NextValue,
    /// What is taken off for a stroke that is hard to play or meets the first ball twice, whatever its errors.
    pub effort_penalty: f64,
}

impl Candidate {
    /// `cue` as a candidate, raised where it must be, if it makes the point; of two that make it as often, the softer and more
    /// level one is better, by `weight`.
    pub fn new(task: &Task, cue: CueInputs, source: Source, weight: f64) -> Option<Self> {
        let cue = task.playable(&cue)?;
        let tally = task.play(&cue)?;
        task.clock.count(1);
        task.suits(&cue, &tally).then(|| Self::of(Suggestion { cue, source }, &tally, weight))
    }

    /// A shot with this tally, which makes the point.
    pub fn of(shot: Suggestion, tally: &Tally, weight: f64) -> Self {
        let cue = &shot.cue;
        Self {
            shot,
            kind: Kind::of(tally, cue),
            tried: 0,
            points: 0,
            own: Rate::default(),
            larger: Rate::default(),
            next: NextValue::Supposed(1.0),
            effort_penalty: weight * effort(cue) + if tally.met_again { AGAIN } else { 0.0 },
        }
    }

    /// What candidates are ranked by.
    pub fn score(&self) -> f64 {
        let larger = if self.larger.attempts > 0.0 { self.larger } else { self.own };
        (self.own.share + WORTH_OF_LARGER * larger.share) * self.next.value() - self.effort_penalty
    }
}

/// How hard a stroke is to play, whatever its errors: a share of the steepest cue, one of the hardest stroke, and more for a
/// stroke beyond the usual.
fn effort(cue: &CueInputs) -> f64 {
    cue.theta / MAX_ELEVATION + cue.speed / MAX_SPEED + HARDER * (cue.speed - HARDEST_USUAL).max(0.0)
}

/// Those that nobody has looked at for the next point count as the worst of those that somebody has: time must not make a
/// shot better.
pub fn suppose_the_worst<'c>(candidates: impl Iterator<Item = &'c mut Candidate>) {
    let candidates: Vec<_> = candidates.collect();
    let worst = candidates.iter().filter_map(|candidate| candidate.next.known()).fold(1.0, f64::min);
    for candidate in candidates.into_iter().filter(|candidate| candidate.next.known().is_none()) {
        candidate.next = NextValue::Supposed(worst);
    }
}

/// Share of the best one's score that a jump or a massé needs to be kept for its kind's sake: usual shots of all kinds are followed,
/// for they may still get better; these cost as much, and hardly ever lead.
const NEAR: f64 = 0.8;

/// Sorts the best first, and keeps the first `best`, the first `of_each` of every kind, and what was advised before, which a few
/// unlucky attempts must not drop. Equals stay in their order.
pub fn keep(candidates: &mut Vec<Candidate>, best: usize, of_each: usize) {
    candidates.sort_by(|a, b| b.score().total_cmp(&a.score()));
    let mut seen: Vec<(Kind, usize)> = Vec::new();
    let mut place = 0;
    let bar = candidates.first().map_or(0.0, |best| NEAR * best.score());
    candidates.retain(|candidate| {
        let rank = if let Some((_, count)) = seen.iter_mut().find(|(kind, _)| *kind == candidate.kind) {
            *count += 1;
            *count
        } else {
            seen.push((candidate.kind, 1));
            1
        };
        place += 1;
        let is_former = candidate.shot.source == Source::Former;
        place <= best || is_former || rank <= of_each && (!candidate.kind.raised || candidate.score() >= bar)
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coach::{Pace, Way};

    fn candidate(cue: CueInputs, share: f64, next: NextValue) -> Candidate {
        Candidate {
            shot: Suggestion { cue, source: Source::Search },
            kind: Kind { first_ball: 1, cushion_first: false, way: Way::Direct, pace: Pace::Soft, raised: false },
            tried: 32,
            points: 0,
            own: Rate { share, attempts: 24.0 },
            larger: Rate { share: 1.0, attempts: 8.0 },
            next,
            effort_penalty: 0.0,
        }
    }

    #[test]
    fn a_shot_that_nobody_has_looked_at_ranks_behind_those_that_leave_a_good_next_one() {
        let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: 2.0 };
        let candidate = |share, next| candidate(cue, share, next);
        let (good, bad, unseen) = (NextValue::Known(0.9), NextValue::Known(0.6), NextValue::Supposed(1.0));
        let mut pool = vec![candidate(1.0, unseen), candidate(1.0, bad), candidate(0.9, good)];
        suppose_the_worst(pool.iter_mut());
        keep(&mut pool, 3, 1);
        assert_eq!(pool.iter().map(|shot| shot.next.known()).collect::<Vec<_>>(), [Some(0.9), None, Some(0.6)]);
        // Where nobody was looked at, none is worse for it.
        let mut pool = [candidate(1.0, unseen)];
        suppose_the_worst(pool.iter_mut());
        assert_eq!(pool[0].next, unseen);
    }
}
