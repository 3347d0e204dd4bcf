//! Detects the rail impacts of filmed balls, and chains of consecutive impacts without another ball between.

use glam::DVec2;

use super::film::{FilmedShot, Sample};
use crate::table::{BALLS, Rail, Table};

/// A filmed impact of a ball on a rail.
#[derive(Clone, Copy, Debug)]
pub struct RailHit {
    /// Time, s.
    pub time: f64,
    /// The rail.
    pub rail: Rail,
    /// Centre of the ball, m.
    pub position: DVec2,
}

/// Number of samples on each side of an impact for its straight line.
const SAMPLES_PER_SIDE: usize = 2;

/// Greatest time between the intersections of both lines with the rail, s: covers dwell time and noise.
const MAX_DISAGREEMENT: f64 = 0.03;

/// Balls closer than their diameter plus this may have touched, m.
const CLEARANCE: f64 = 0.006;

/// Returns all clearly visible rail impacts of one ball, in order of time.
pub fn rail_hits(table: &Table, track: &[Sample]) -> Vec<RailHit> {
    let mut hits = Vec::new();
    for rail in Rail::ALL {
        let gap = |sample: &Sample| rail.gap(table.reach(), sample.position);
        for i in 1..track.len().saturating_sub(1) {
            let nearest = gap(&track[i]) <= gap(&track[i - 1]) && gap(&track[i]) < gap(&track[i + 1]);
            if !nearest || gap(&track[i]) > 0.15 {
                continue;
            }
            hits.extend(hit_at(table, track, i, rail));
        }
    }
    hits.sort_by(|a, b| a.time.total_cmp(&b.time));
    hits
}

/// Returns the impact near sample `i`, where the straight lines through the samples before and after it intersect the rail.
fn hit_at(table: &Table, track: &[Sample], i: usize, rail: Rail) -> Option<RailHit> {
    let (n, reach) = (rail.normal(), table.reach());
    let gap = |sample: &Sample| rail.gap(reach, sample.position);
    // A sample on the rail belongs to neither side.
    let on_rail = gap(&track[i]) < 0.002;
    let meets = |samples: &[Sample]| -> Option<(f64, DVec2)> {
        let (first, last) = (samples.first()?, samples.last()?);
        let duration = last.time - first.time;
        let velocity = (last.position - first.position) / duration;
        let closing = velocity.dot(n);
        let time = first.time - gap(first) / closing;
        (duration > 0.0 && duration < 0.13 && closing.abs() > 0.03)
            .then(|| (time, first.position + (time - first.time) * velocity))
    };
    // A sample off the rail belongs before or after the impact: to the side for which the lines agree better.
    let sides: &[[usize; 2]] = if on_rail { &[[i, i + 1]] } else { &[[i + 1, i + 1], [i, i]] };
    let found = sides.iter().filter_map(|&[end, begin]| {
        let before = &track[end.saturating_sub(SAMPLES_PER_SIDE)..end];
        let after = track.get(begin..(begin + SAMPLES_PER_SIDE).min(track.len()))?;
        if before.len() < 2 || after.len() < 2 {
            return None;
        }
        let ((t1, p1), (t2, p2)) = (meets(before)?, meets(after)?);
        let middle = 0.5 * (p1 + p2);
        let position = middle - rail.gap(reach, middle) * n;
        Some(((t1 - t2).abs(), p1.distance(p2), RailHit { time: 0.5 * (t1 + t2), rail, position }))
    });
    let (time_difference, distance, hit) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (time_difference < MAX_DISAGREEMENT && distance < 0.05).then_some(hit)
}

/// Whether no other ball came near this one between two times.
pub fn is_undisturbed(table: &Table, shot: &FilmedShot, ball: usize, from: f64, to: f64) -> bool {
    let steps = ((to - from) / 0.005).ceil().max(1.0);
    let near = 2.0 * table.radius + CLEARANCE;
    (0..=steps as usize).all(|step| {
        let time = from + (to - from) * step as f64 / steps;
        let position = shot.position(ball, time);
        (0..BALLS).filter(|&other| other != ball).all(|other| shot.position(other, time).distance(position) > near)
    })
}

/// Returns all stretches of `count` consecutive rail impacts with no other ball near, as ball index and impacts.
pub fn chains(table: &Table, shot: &FilmedShot, count: usize) -> Vec<(usize, Vec<RailHit>)> {
    let mut chains = Vec::new();
    for ball in 0..BALLS {
        let hits = rail_hits(table, &shot.balls[ball]);
        chains.extend(
            hits.windows(count).filter(|hits| is_chain(table, shot, ball, hits)).map(|hits| (ball, hits.to_vec())),
        );
    }
    chains
}

/// Returns disjoint stretches of `least` to `most` rail impacts, each as long as possible with no other ball near.
pub fn stretches(table: &Table, shot: &FilmedShot, least: usize, most: usize) -> Vec<(usize, Vec<RailHit>)> {
    let mut found = Vec::new();
    for ball in 0..BALLS {
        let hits = rail_hits(table, &shot.balls[ball]);
        let mut from = 0;
        while from + least <= hits.len() {
            let longest = (least..=most)
                .rev()
                .find(|&n| from + n <= hits.len() && is_chain(table, shot, ball, &hits[from..from + n]));
            if let Some(count) = longest {
                found.push((ball, hits[from..from + count].to_vec()));
                from += count - 1;
            } else {
                from += 1;
            }
        }
    }
    found
}

fn is_chain(table: &Table, shot: &FilmedShot, ball: usize, hits: &[RailHit]) -> bool {
    let different = hits.windows(2).all(|pair| pair[0].rail != pair[1].rail && pair[1].time > pair[0].time);
    different && is_undisturbed(table, shot, ball, hits[0].time, hits[hits.len() - 1].time)
}
