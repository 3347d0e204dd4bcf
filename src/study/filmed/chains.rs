//! Predictions from rail to rail: the motion of a filmed ball leaving a rail is fitted to its course up to the second rail
//! after, and the impacts on the rails after that are predicted.
//!
//! The fit has seven parameters: position, velocity, slip and side spin. The course to the next rail determines all but the
//! side spin, which follows from the rebound there.

use super::{
    film::{FilmedShot, Sample},
    motion::{Motion, best_fit, extend_with_misses},
    rail_hits::{RailHit, chains, stretches},
};
use crate::{
    simulation::{Follower, lone_ball_layout},
    table::Table,
};

/// The course of a filmed ball over several rails, with no other ball near.
#[derive(Clone, Debug)]
pub struct Chain {
    /// The samples between the rails.
    pub samples: Vec<Sample>,
    /// The rail impacts; the course starts at the first.
    pub hits: Vec<RailHit>,
}

/// The prediction of a chain's last impact, compared with the film.
#[derive(Clone, Copy, Debug)]
pub struct ChainPrediction {
    /// Distance between the predicted and the filmed impact, m.
    pub distance: f64,
    /// Delay of the predicted impact, s.
    pub delay: f64,
}

/// Samples closer than this to a rail impact may show the ball in contact with the rail, s.
const IN_RAIL: f64 = 0.011;

/// Returns all stretches of `count` consecutive rails.
pub fn all(table: &Table, film: &[FilmedShot], count: usize) -> Vec<Chain> {
    film.iter().flat_map(|shot| with_samples(shot, chains(table, shot, count))).collect()
}

/// Returns disjoint stretches of three to five rails, for fitting constants.
pub fn disjoint(table: &Table, film: &[FilmedShot]) -> Vec<Chain> {
    film.iter().flat_map(|shot| with_samples(shot, stretches(table, shot, 3, 5))).collect()
}

/// Returns the stretches with at least four samples on each of the first two legs.
fn with_samples(shot: &FilmedShot, found: Vec<(usize, Vec<RailHit>)>) -> Vec<Chain> {
    let chain = |(ball, hits): (usize, Vec<RailHit>)| {
        let (from, to) = (hits[0].time + IN_RAIL, hits[hits.len() - 1].time);
        let free = |time: f64| hits.iter().all(|hit| (time - hit.time).abs() > IN_RAIL);
        let samples = shot.balls[ball].iter().filter(|s| s.time > from && s.time < to && free(s.time)).copied();
        Chain { samples: samples.collect(), hits }
    };
    let shows = |chain: &Chain, leg: usize| {
        let [from, to] = [leg, leg + 1].map(|hit| chain.hits[hit].time);
        chain.samples.iter().filter(|sample| sample.time > from && sample.time < to).count() >= 4
    };
    found.into_iter().map(chain).filter(|chain| shows(chain, 0) && shows(chain, 1)).collect()
}

/// Follows a ball that meets no other.
fn follow_alone<'a>(follower: Follower<'a>, table: &Table, motion: &Motion) -> Follower<'a> {
    follower.follow(table, &lone_ball_layout(motion.position), &motion.impulse(table.radius))
}

impl Chain {
    /// Fits the motion at the first sample to the course up to the rail `last`. The search starts from `known`, or from several
    /// values of the side spin. Returns the motion and the sum of squared residuals.
    pub fn fit(&self, table: &Table, last: usize, known: Option<Motion>) -> (Motion, f64) {
        let begin = self.samples[0].time;
        let until = self.hits[last].time;
        let used: Vec<Sample> = self.samples.iter().copied().filter(|sample| sample.time < until).collect();
        let times: Vec<f64> = used.iter().map(|sample| sample.time - begin).collect();
        let residuals = |numbers: &[f64; 7], out: &mut Vec<f64>| {
            out.clear();
            let followed = follow_alone(Follower::new(&times, 0), table, &Motion::of(*numbers));
            extend_with_misses(out, &followed.positions, &used);
            // A weak prior: slip and spin are not much faster than the motion, so less is likelier if the film does not
            // determine them.
            out.extend([1e-4 * numbers[4], 1e-4 * numbers[5], 1e-4 * numbers[6]]);
        };
        let (first, second) = (self.samples[0], self.samples[1]);
        let velocity = (second.position - first.position) / (second.time - first.time);
        let n = self.hits[0].rail.normal();
        let with_side = |share: f64| Motion {
            position: first.position,
            velocity,
            slip: 1.2 * velocity.dot(n) * n,
            side: share * velocity.length(),
        };
        let sides: &[f64] = if known.is_some() { &[0.0] } else { &[-1.2, -0.6, -0.2, 0.2, 0.6, 1.2] };
        let starts = sides.iter().map(|share| known.unwrap_or(with_side(*share)).numbers());
        let found = best_fit(starts, [1e-5, 1e-5, 1e-4, 1e-4, 1e-4, 1e-4, 1e-3], 30, residuals);
        found.map_or((with_side(0.0), f64::INFINITY), |found| (Motion::of(found.parameters), found.squares))
    }

    /// Fits the motion to the first two legs and predicts the last impact.
    pub fn predict(&self, table: &Table) -> ChainPrediction {
        let (motion, _) = self.fit(table, 2, None);
        let last = self.hits.len() - 1;
        let followed = follow_alone(Follower::new(&[], last), table, &motion);
        let (met, hit) = (followed.hits.get(last - 1), &self.hits[last]);
        ChainPrediction {
            distance: met.map_or(9.0, |(_, _, position)| position.distance(hit.position)),
            delay: met.map_or(9.0, |(time, ..)| self.samples[0].time + time - hit.time),
        }
    }
}
