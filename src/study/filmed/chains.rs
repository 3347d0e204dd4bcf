//! From rail to rail: the motion of a filmed ball on leaving a rail is fitted to its course up to the second rail after,
//! and the rails behind that are predicted.
//!
//! Seven numbers are fitted: place, velocity, slip and side spin. The course to the next rail shows all but the side spin,
//! which shows in how the ball leaves that rail.

use glam::DVec2;

use super::{
    film::{FilmedShot, Sample},
    motion::Motion,
    rail_hits::{RailHit, chains, stretches},
};
use crate::{
    simulation::{Follower, alone},
    statistics::fit,
    table::Table,
};

/// A filmed ball from one rail to some others, with no other ball near.
#[derive(Clone, Debug)]
pub struct Chain {
    /// The samples between the rails.
    pub samples: Vec<Sample>,
    /// The rails, that which it leaves first.
    pub hits: Vec<RailHit>,
}

/// How a chain came out.
#[derive(Clone, Debug)]
pub struct Played {
    /// Distances from where the ball met the rails, m, for those of `hits[1..]`.
    pub places: Vec<f64>,
    /// By how much it was late there, s.
    pub late: Vec<f64>,
}

/// Samples nearer in time to a rail hit than this may lie in the rail, s.
const IN_RAIL: f64 = 0.011;

/// Residuals far above this count less and less, m.
const ROBUST: f64 = 0.02;

/// All stretches of `count` rails in a row.
pub fn all(table: &Table, film: &[FilmedShot], count: usize) -> Vec<Chain> {
    film.iter().flat_map(|shot| readable(shot, chains(table, shot, count))).collect()
}

/// The film's stretches of three to five rails that do not overlap: what constants are fitted with.
pub fn apart(table: &Table, film: &[FilmedShot]) -> Vec<Chain> {
    film.iter().flat_map(|shot| readable(shot, stretches(table, shot, 3, 5))).collect()
}

/// Those whose first two legs show something.
fn readable(shot: &FilmedShot, found: Vec<(usize, Vec<RailHit>)>) -> Vec<Chain> {
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

/// A residual that grows ever more slowly beyond [`ROBUST`].
pub fn soften(miss: f64) -> f64 {
    ROBUST * (miss / ROBUST).asinh()
}

impl Chain {
    /// The motion at the first sample that fits the course up to the rail `last` best, from several beginnings or from
    /// one that is known.
    pub fn fit(&self, table: &Table, last: usize, known: Option<Motion>) -> (Motion, f64) {
        let begin = self.samples[0].time;
        let until = self.hits[last].time;
        let used: Vec<Sample> = self.samples.iter().copied().filter(|sample| sample.time < until).collect();
        let times: Vec<f64> = used.iter().map(|sample| sample.time - begin).collect();
        let mut residuals = |numbers: &[f64; 7], out: &mut Vec<f64>| {
            out.clear();
            let motion = Motion::of(*numbers);
            let followed = Follower::new(&times, 0).of(table, &alone(motion.place), &motion.impulse(table.radius));
            for (sample, place) in used.iter().zip(&followed.places) {
                let miss = *place - sample.place;
                out.extend([soften(miss.x), soften(miss.y)]);
            }
            // No ball slips or spins much faster than it moves: where the film says nothing, less is likelier.
            out.extend([1e-4 * numbers[4], 1e-4 * numbers[5], 1e-4 * numbers[6]]);
        };
        let (first, second) = (self.samples[0], self.samples[1]);
        let velocity = (second.place - first.place) / (second.time - first.time);
        let n = self.hits[0].rail.normal();
        let mut best: Option<(Motion, f64)> = None;
        let sides: &[f64] = if known.is_some() { &[0.0] } else { &[-1.2, -0.6, -0.2, 0.2, 0.6, 1.2] };
        for share in sides {
            let start = known.unwrap_or(Motion {
                place: first.place,
                velocity,
                slip: 1.2 * velocity.dot(n) * n,
                side: share * velocity.length(),
            });
            let found = fit(start.numbers(), [1e-5, 1e-5, 1e-4, 1e-4, 1e-4, 1e-4, 1e-3], 30, &mut residuals);
            if best.as_ref().is_none_or(|(_, squares)| found.squares < *squares) {
                best = Some((Motion::of(found.parameters), found.squares));
            }
        }
        best.unwrap_or((Motion { place: first.place, velocity, slip: DVec2::ZERO, side: 0.0 }, f64::INFINITY))
    }

    /// Fits the first two legs and predicts the rest.
    pub fn play(&self, table: &Table) -> Played {
        let (motion, _) = self.fit(table, 2, None);
        let begin = self.samples[0].time;
        let followed =
            Follower::new(&[], self.hits.len() - 1).of(table, &alone(motion.place), &motion.impulse(table.radius));
        let (mut places, mut late) = (Vec::new(), Vec::new());
        for (index, hit) in self.hits[1..].iter().enumerate() {
            let met = followed.hits.get(index);
            places.push(met.map_or(9.0, |(_, _, place)| place.distance(hit.place)));
            late.push(met.map_or(9.0, |(time, ..)| begin + time - hit.time));
        }
        Played { places, late }
    }
}
