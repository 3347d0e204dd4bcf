//! The parallel shift: if no system has numbers for a line, a player counts from a neighbouring line that leads to a diamond.
//!
//! If the third cushion is parallel to the first, a ball that is aimed further along the first arrives as much further
//! along the third. The shift changes its sign if the second cushion lies across.

use glam::DVec2;
use serde::Serialize;

use super::{
    leg::Leg,
    lines::{SIZE, diamonds, edge, metres},
    natural::hits,
};
use crate::{simulation::Rail, table::Table};

/// Maximum difference between the shift's prediction and the actual arrival, diamonds.
const MAX_ARRIVAL_ERROR: f64 = 0.3;

/// Smaller shifts do not matter to a player, diamonds: the line itself leads to the diamond.
const MIN_SHIFT: f64 = 0.05;

/// A line that leads to a diamond, and the shot's parallel line next to it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "name", rename = "parallel-shift")]
pub struct ParallelShift {
    /// The first cushion and the third.
    pub rails: [Rail; 2],
    /// The diamond of the first cushion to which the neighbouring line leads.
    pub diamond: f64,
    /// The arrival of a ball on the neighbouring line, in diamonds along the third cushion's nose.
    pub arrival: f64,
    /// Signed distance of the shot's line from it on the first cushion, diamonds.
    pub by: f64,
    /// The arrival that the shift predicts for the shot, in diamonds along the third cushion.
    pub third: f64,
    /// The actual arrival of the shot on this table.
    pub table_third: f64,
    /// The path of a ball on the neighbouring line with the motion of the shot's ball: its start and its centre at the
    /// three cushions, in diamonds.
    #[serde(skip)]
    pub path: [DVec2; 4],
}

impl ParallelShift {
    /// Returns the rule of the shift, as a sentence.
    pub fn rule(&self) -> &'static str {
        if self.by * (self.third - self.arrival) < 0.0 {
            "Aimed further along the first cushion, the ball comes as much less far along the third."
        } else {
            "Aimed further along the first cushion, the ball comes as much further along the third."
        }
    }

    /// Returns where the shot itself is aimed on the first cushion, in its diamonds.
    pub fn shot_aim(&self) -> f64 {
        self.diamond + self.by
    }

    /// Returns the diamonds of the first and the third cushion between which the neighbouring line runs, as positions on the
    /// table's edge.
    pub fn ends(&self) -> [DVec2; 2] {
        let [first, third] = self.rails;
        [edge(first, self.diamond), edge(third, self.arrival)]
    }

    /// Finds the shift from the nearest line that leads to a diamond and takes the same cushions. `None` if there is no such
    /// line, its prediction is too far off, the shot's own line leads to a diamond, or the third cushion is not
    /// parallel to the first.
    pub(super) fn of(table: &Table, leg: &Leg) -> Option<Self> {
        let [first, second, third] = leg.rails();
        if is_long(first) != is_long(third) {
            return None;
        }
        let aimed = leg.line().at_rail(first)?;
        if (aimed - aimed.round()).abs() < MIN_SHIFT {
            return None;
        }
        let (lower, last) = (aimed.floor(), if is_long(first) { SIZE.x } else { SIZE.y });
        // Beyond the corner there is nothing to aim at.
        if !(0.0..=last).contains(&aimed) {
            return None;
        }
        let mut beside = [lower, lower + 1.0];
        beside.sort_by(|one, other| (one - aimed).abs().total_cmp(&(other - aimed).abs()));
        let turned = if is_long(first) == is_long(second) { 1.0 } else { -1.0 };
        let table_third = along(leg.hits[2].1, third);
        beside.into_iter().filter(|diamond| (0.0..=last).contains(diamond)).find_map(|diamond| {
            let by = aimed - diamond;
            let path = parallel_path(table, leg, -by)?;
            let arrival = along(path[3], third);
            let third = arrival + turned * by;
            // Nor can a ball arrive beyond a corner.
            let is_there = (0.0..=last).contains(&third) && (third - table_third).abs() <= MAX_ARRIVAL_ERROR;
            is_there.then_some(Self { rails: [first, leg.hits[2].0], diamond, arrival, by, third, table_third, path })
        })
    }
}

/// Simulates the path of the shot's ball, from its start to the third cushion, if it reached the first one `by`
/// diamonds further along. `None` if it takes other cushions.
fn parallel_path(table: &Table, leg: &Leg, by: f64) -> Option<[DVec2; 4]> {
    let (place, motion) = &leg.motion;
    let first = leg.hits[0].0;
    let further = if is_long(first) { DVec2::X } else { DVec2::Y } * by;
    let place = diamonds(table, *place) + further;
    // Slightly before the cushion, so that the cushion is hit.
    let back = 0.01 * motion.velocity.normalize_or_zero();
    let place = metres(table, place) - back;
    let reach = table.reach();
    if place.abs().cmpgt(reach).any() {
        return None;
    }
    let hits = hits(table, place, motion);
    let same = hits.get(..3)?.iter().zip(leg.rails()).all(|((rail, _), other)| *rail == other);
    same.then(|| [entry(leg.from + further, hits[0].1), hits[0].1, hits[1].1, hits[2].1])
}

/// Returns the point at which the line between two positions enters the table; the second one is on the table.
fn entry(from: DVec2, to: DVec2) -> DVec2 {
    let share = (from.clamp(DVec2::ZERO, SIZE) - to) / (from - to);
    // Along an axis one share is NaN, which `min` ignores.
    to + (from - to) * 1_f64.min(share.x).min(share.y)
}

const fn is_long(rail: Rail) -> bool {
    matches!(rail, Rail::Top | Rail::Bottom)
}

/// Returns the position along a cushion, in diamonds.
const fn along(place: DVec2, rail: Rail) -> f64 {
    if is_long(rail) { place.x } else { place.y }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::{
        coach::{
            candidates::random_stroke,
            systems::{Guide, guide},
        },
        simulation::Recording,
        table::Layout,
    };

    #[test]
    fn shift_uses_existing_diamonds_and_describes_the_arrival() {
        let (table, mut rng) = (Table::default(), Xoshiro256PlusPlus::seed_from_u64(3));
        let shots = (0..4000).filter_map(|_| {
            let layout = Layout::random(&table, &mut rng);
            let cue = random_stroke(&table, &layout, &mut rng);
            match guide(&table, &Recording::new(&table, &layout, &cue).ok()?)? {
                Guide::Shift(shift) => Some(shift),
                Guide::System(_) => None,
            }
        });
        let shifts: Vec<ParallelShift> = shots.collect();
        assert!(shifts.len() > 20, "{}", shifts.len());
        for shift in &shifts {
            let last = if is_long(shift.rails[0]) { 8.0 } else { 4.0 };
            let places = [shift.diamond, shift.third, shift.shot_aim()];
            assert!(places.iter().all(|place| (0.0..=last).contains(place)), "{shift:?}");
        }
        let shift = ParallelShift {
            rails: [Rail::Top, Rail::Bottom],
            diamond: 3.0,
            arrival: 5.1,
            by: 0.4,
            third: 4.7,
            table_third: 4.6,
            path: [DVec2::ZERO; 4],
        };
        assert_eq!(
            shift.to_string(),
            "Parallel shift: aimed at diamond 3 of the top rail, the ball comes to 5.1 of the bottom rail; aimed at 3.4, as here, to \
             4.7; on this table to 4.6"
        );
        let brief =
            "diamond 3 of the top rail leads to 5.1 of the bottom rail; 3.4, as here, to 4.7; on this table to 4.6";
        assert_eq!(shift.brief(), brief);
        assert!(ParallelShift { table_third: 4.7, ..shift }.brief().ends_with("as here, to 4.7"));
    }

    #[test]
    fn line_entry_point_is_on_the_table() {
        let to = DVec2::new(2.0, 4.0);
        assert_eq!(entry(DVec2::new(1.0, 1.0), to), DVec2::new(1.0, 1.0));
        assert_eq!(entry(DVec2::new(-1.0, 1.0), to), DVec2::new(0.0, 2.0));
        assert_eq!(entry(DVec2::new(2.0, -1.0), to), DVec2::new(2.0, 0.0));
    }
}
