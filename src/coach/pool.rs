//! Candidates of a search and how they stand: ranked by the share of the same errors under which each makes the point.

use super::{
    Kind, Source, Suggestion,
    candidates::{MAX_ELEVATION, MAX_SPEED, towards},
    draws::{QuasiRandomDraws, Worlds},
    next::{NextValue, next_value},
    trial::{Course, Task},
};
use crate::{physics::CueInputs, player::errors::Errors};

/// One in four of the errors is this many times as large. Of shots that hardly ever miss, these tell apart the one that
/// forgives more.
const WIDE: f64 = 1.8;

/// What a point under the larger errors is worth against one under the player's own.
const WORTH_OF_WIDE: f64 = 0.3;

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

/// The errors that shots are compared on, the same for all of them. Of every four attempts the last is at a larger one.
#[derive(Debug)]
pub struct Race {
    own: QuasiRandomDraws,
    larger: QuasiRandomDraws,
}

impl Race {
    /// With so many errors at most, a multiple of four.
    pub fn new(most: usize, seed: u64) -> Self {
        Self {
            own: QuasiRandomDraws::new(most / 4 * 3, 1.0, seed),
            larger: QuasiRandomDraws::new(most / 4, WIDE, !seed),
        }
    }

    /// Makes sure that candidates can be tried at so many errors, a multiple of four, each in one of the worlds.
    pub fn extend_to(&mut self, worlds: &Worlds, count: usize) {
        self.own.extend_to(worlds, count / 4 * 3);
        self.larger.extend_to(worlds, count / 4);
    }

    /// Finds out how easy the next point is after a candidate; `None` where time ran out.
    pub fn look_ahead(&self, task: &Task, candidate: &Candidate) -> Option<Candidate> {
        let next = NextValue::Known(next_value(task, &candidate.shot.cue, self.own.drawn())?);
        Some(Candidate { next, ..*candidate })
    }

    /// Tries a candidate at the errors up to the `count`th, a multiple of four, as far as they are drawn; `None` where time ran out.
    pub fn go_on(&self, task: &Task, candidate: &Candidate, count: usize) -> Option<Candidate> {
        let mut after = *candidate;
        while after.tried < count {
            let block = after.tried / 4;
            if block >= self.larger.drawn().len() {
                break;
            }
            let own = task.all_attempts(&after.shot.cue, self.own.drawn().range(3 * block, 3 * block + 3), 3)?;
            let larger = task.all_attempts(&after.shot.cue, self.larger.drawn().range(block, block + 1), 1)?;
            after.made += own.made;
            after.wide += larger.made;
            for (input, sum) in after.drift.iter_mut().enumerate() {
                *sum += own.drift[input] + larger.drift[input];
            }
            after.tried += 4;
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
    /// Errors that it was tried at.
    pub tried: usize,
    /// Points under the player's errors, three quarters of those tried.
    pub made: usize,
    /// Points under the larger errors.
    pub wide: usize,
    /// Sum of the errors of the attempts that made the point, in the player's standard errors.
    pub drift: Errors,
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
        let course = task.play(&cue)?;
        task.clock.count(1);
        let is_good = task.point().is_made(&course.tally) && task.allows(&cue);
        is_good.then(|| Self::of(Suggestion { cue, source }, &course, weight))
    }

    /// A shot that makes the point in this course.
    pub fn of(shot: Suggestion, course: &Course, weight: f64) -> Self {
        let cue = &shot.cue;
        Self {
            shot,
            kind: Kind::of(course, cue),
            tried: 0,
            made: 0,
            wide: 0,
            drift: Errors::default(),
            next: NextValue::Supposed(1.0),
            effort_penalty: weight * effort(cue) + if course.tally.met_again { AGAIN } else { 0.0 },
        }
    }

    /// Share of points under the player's errors; it flatters whoever was chosen by it.
    pub fn rate(&self) -> f64 {
        self.made as f64 / self.narrow().max(1) as f64
    }

    /// Attempts under the player's errors.
    pub const fn narrow(&self) -> usize {
        self.tried - self.tried / 4
    }

    /// The stroke in the middle of those that made the point: a step to where more of them do, without another simulation. It
    /// is the step of expectation maximization for the probability of the point under normal errors (Dayan and Hinton 1997);
    /// `stretch` times as far.
    pub fn middle(&self, task: &Task, stretch: f64) -> CueInputs {
        let made = (self.made + self.wide).max(1) as f64;
        towards(task.table, task.skill, &self.shot.cue, &self.drift.map(|sum| stretch * sum / made))
    }

    /// Whether it has made the point every time.
    pub const fn is_flawless(&self) -> bool {
        self.tried > 0 && self.made + self.wide == self.tried
    }

    /// What candidates are ranked by.
    pub fn score(&self) -> f64 {
        let wide = self.tried / 4;
        let share = if wide == 0 { self.rate() } else { self.wide as f64 / wide as f64 };
        (self.rate() + WORTH_OF_WIDE * share) * self.next.value() - self.effort_penalty
    }
}

/// How hard a stroke is to play, whatever its errors: a share of the steepest cue, one of the hardest stroke, and more for a
/// stroke beyond the usual.
fn effort(cue: &CueInputs) -> f64 {
    cue.theta / MAX_ELEVATION + cue.speed / MAX_SPEED + HARDER * (cue.speed - HARDEST_USUAL).max(0.0)
}

/// Those that nobody has looked at for the next point count as the worst of those that somebody has: time must not make a
/// shot better.
pub fn suppose_the_worst(candidates: &mut [Candidate]) {
    let worst = candidates.iter().filter_map(|candidate| candidate.next.known()).fold(1.0, f64::min);
    for candidate in candidates.iter_mut().filter(|candidate| candidate.next.known().is_none()) {
        candidate.next = NextValue::Supposed(worst);
    }
}

/// Leaders that may be nearly alike. The neighbours of one would crowd out all other ways to play the shot, some of which get better
/// in the end. On two hard layouts the mean over eight seeds rose from 83.7 to 85.4 and from 75.0 to 76.7 %; elsewhere a club player's
/// shots are made as often (600 layouts).
const ALIKE: usize = 4;

/// Steps of the tip, rad and m/s within which strokes are nearly alike: those to a neighbour, or little less.
const NEARLY: [f64; 3] = [0.15, 0.01, 0.4];

/// The same as [`keep`] for those whose neighbours are tried: of strokes that are nearly alike, the best [`ALIKE`] alone.
pub fn keep_leaders(candidates: &mut Vec<Candidate>, best: usize, of_each: usize) {
    sort(candidates);
    let mut kept: Vec<CueInputs> = Vec::new();
    candidates.retain(|Candidate { shot: Suggestion { cue, .. }, .. }| {
        let [tip, direction, speed] = NEARLY;
        let is_near = |other: &&CueInputs| {
            (other.a - cue.a).abs().max((other.b - cue.b).abs()) < tip
                && (other.phi - cue.phi).abs() < direction
                && (other.speed - cue.speed).abs() < speed
        };
        let is_one_of_few = kept.iter().filter(is_near).count() < ALIKE;
        kept.extend(is_one_of_few.then_some(*cue));
        is_one_of_few
    });
    keep(candidates, best, of_each);
}

fn sort(candidates: &mut [Candidate]) {
    candidates.sort_by(|a, b| b.score().total_cmp(&a.score()));
}

/// Share of the best one's score that a jump or a massé needs to be kept for its kind's sake: usual shots of all kinds are followed,
/// for they may still get better; these cost as much, and hardly ever lead.
const NEAR: f64 = 0.8;

/// Sorts the best first, and keeps the first `best` and the first `of_each` of every kind. Equals stay in their order.
pub fn keep(candidates: &mut Vec<Candidate>, best: usize, of_each: usize) {
    sort(candidates);
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
        place <= best || rank <= of_each && (!candidate.kind.raised || candidate.score() >= bar)
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coach::{Pace, Way};

    fn candidate(cue: CueInputs, made: usize, next: NextValue) -> Candidate {
        Candidate {
            shot: Suggestion { cue, source: Source::Search },
            kind: Kind { first_ball: 1, cushion_first: false, way: Way::Direct, pace: Pace::Soft, raised: false },
            tried: 32,
            made,
            wide: 8,
            drift: Errors::default(),
            next,
            effort_penalty: 0.0,
        }
    }

    #[test]
    fn neighbours_of_one_leader_do_not_crowd_out_the_others() {
        let cue = |phi: f64| CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi, speed: 2.0 };
        let near = (0..9).map(|n| candidate(cue(1e-3 * f64::from(n)), 24, NextValue::Supposed(1.0)));
        let mut pool: Vec<_> = near.chain([candidate(cue(0.5), 20, NextValue::Supposed(1.0))]).collect();
        keep_leaders(&mut pool, 8, 1);
        assert_eq!(pool.iter().map(|shot| shot.made).collect::<Vec<_>>(), [24, 24, 24, 24, 20]);
    }

    #[test]
    fn a_shot_that_nobody_has_looked_at_ranks_behind_those_that_leave_a_good_next_one() {
        let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: 2.0 };
        let candidate = |made, next| candidate(cue, made, next);
        let (good, bad, unseen) = (NextValue::Known(0.9), NextValue::Known(0.6), NextValue::Supposed(1.0));
        let mut pool = vec![candidate(24, unseen), candidate(24, bad), candidate(22, good)];
        suppose_the_worst(&mut pool);
        keep(&mut pool, 3, 1);
        assert_eq!(pool.iter().map(|shot| shot.next.known()).collect::<Vec<_>>(), [Some(0.9), None, Some(0.6)]);
        // Where nobody was looked at, none is worse for it.
        let mut pool = [candidate(24, unseen)];
        suppose_the_worst(&mut pool);
        assert_eq!(pool[0].next, unseen);
    }
}
