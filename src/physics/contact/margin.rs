//! Forces that are not unique: a ball that stands in a corner and is pushed there is held by cushions and cloth together, and
//! any share of the two obeys all laws.
//!
//! A solver may come upon the edge of what is possible: a friction at its limit that has nothing to hold, or a contact that pushes
//! next to nothing, which the friction of another takes up. Forces that are followed from there leave the laws at once. So
//! such a friction is allowed only part of its limit, and such a contact does not push, if the others can do the rest: the forces
//! then last for a while.

use super::{
    Effort,
    problem::{Limit, Place, Problem},
    solve::{Side, Solution, solve_near},
};

/// Shares of their limits that frictions are allowed, the first with which all laws hold.
const SHARES: [f64; 3] = [0.5, 0.9, 0.99];

/// Pushes below this share of the largest force are next to nothing.
const NEXT_TO_NOTHING: f64 = 1e-6;

/// What may be left of such a push as a share of it, if the others take it up.
const LEFT: f64 = 1e-3;

/// Rounds in which further forces come to their edges, since others do less.
const ROUNDS: usize = 6;

/// The rates that an unknown resists, m/s².
pub fn rates(problem: &Problem, solution: &Solution, index: usize) -> [f64; 2] {
    let accelerations = problem.accelerations(&solution.sizes);
    let unknown = &problem.unknowns[index];
    std::array::from_fn(|axis| {
        let row = unknown.first + axis;
        if axis < unknown.count { problem.rates[row].dot(&accelerations) + problem.bias[row] } else { 0.0 }
    })
}

/// Whether there are several contacts; their normal forces come first. A single one's push nothing else takes up.
fn are_several(problem: &Problem) -> bool {
    problem.unknowns.get(1).is_some_and(|unknown| matches!(unknown.place, Place::Normal(_)))
}

/// Whether an unknown is at an edge of what it may be though no rate is above `none`, m/s².
fn is_at_edge(problem: &Problem, solution: &Solution, index: usize, none: f64) -> bool {
    let unknown = &problem.unknowns[index];
    match (solution.sides[index], unknown.place) {
        (Side::Holds, Place::Normal(_)) if are_several(problem) => {
            let largest = solution.sizes.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            solution.sizes[unknown.first] < NEXT_TO_NOTHING * largest
        }
        (Side::Limited(_), _) => rates(problem, solution, index).iter().all(|rate| rate.abs() <= none),
        _ => false,
    }
}

/// Forces away from the edges, where nothing slips faster than at the rate `none`, m/s²; `None` if none are at
/// an edge, or no others obey all laws.
pub fn with_margin(problem: &Problem, solution: &Solution, none: f64, effort: &Effort) -> Option<Solution> {
    let at_edge = |index: &usize| is_at_edge(problem, solution, *index, none);
    // The normal forces come first: if the last is one, no friction's share matters.
    let last = (0..problem.unknowns.len()).rev().find(at_edge)?;
    let shares = if matches!(problem.unknowns[last].place, Place::Normal(_)) { &SHARES[..1] } else { &SHARES };
    shares.iter().find_map(|share| with_share(problem, solution, none, *share, effort))
}

fn with_share(problem: &Problem, solution: &Solution, none: f64, share: f64, effort: &Effort) -> Option<Solution> {
    let (mut eased, mut found) = (problem.clone(), solution.clone());
    let mut spared = vec![false; problem.unknowns.len()];
    for _ in 0..ROUNDS {
        let mut more = false;
        for (index, spared) in spared.iter_mut().enumerate().filter(|(_, spared)| !**spared) {
            if is_at_edge(&eased, &found, index, none) {
                (*spared, more) = (true, true);
                let unknown = &mut eased.unknowns[index];
                match &mut unknown.limit {
                    limit if matches!(unknown.place, Place::Normal(_)) => *limit = Limit::Fixed(0.0),
                    Limit::Fixed(limit) | Limit::Coulomb(limit, _) => *limit *= share,
                }
            }
        }
        if !more {
            for (side, _) in
                found.sides.iter_mut().zip(&spared).filter(|(side, spared)| **spared && **side != Side::Absent)
            {
                *side = Side::Holds;
            }
            return Some(found);
        }
        found = solve_near(&eased, &found.sizes, effort);
        let holds = |index: usize| match problem.unknowns[index].place {
            Place::Normal(_) => {
                rates(&eased, &found, index)[0] >= -LEFT * solution.sizes[problem.unknowns[index].first].abs()
            }
            _ => rates(&eased, &found, index).iter().all(|rate| rate.abs() <= none),
        };
        if !found.converged || !(0..spared.len()).all(|index| !spared[index] || holds(index)) {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use crate::{
        physics::{ActiveSet, BallState, Contact, Effort, Scene},
        table::Table,
    };

    /// A ball stands in a corner, and another one, which slips on it, pushes it there: cloth and cushions share the push.
    #[test]
    fn a_ball_that_is_pushed_into_a_corner_is_held_with_something_to_spare() {
        let table = Table::preset("textbook").unwrap();
        let corner = DVec2::new(table.half_length(), -table.half_width());
        let apart = 2.0 * table.radius * DVec2::new(-0.034_822, 0.999_394).normalize();
        let mut balls = [corner + apart, corner, DVec2::ZERO].map(BallState::at_rest);
        balls[0].velocity = DVec2::new(-0.0313, -0.001_09);
        balls[0].spin = DVec3::new(29.64, -0.28, 13.58);
        balls[1].spin.z = -0.7;
        let cushions = [DVec2::NEG_X, DVec2::Y].map(|normal| Contact::with_cushion(1, normal));
        let contacts = [cushions[0], cushions[1], Contact::of_balls(0, 1)];
        let set = ActiveSet::of(&table, &balls, &contacts, 1e-10);
        let scene = Scene { table: &table, balls: &balls, contacts: &contacts, set: &set };
        let resolved = scene.resolve(1e-11, None, &Effort::default()).unwrap();
        assert!(resolved.forces.converged && !resolved.shared);
        assert!(resolved.forces.slack > 1e-3 * table.gravity, "{}", resolved.forces.slack);
        assert!(resolved.forces.linear[1].length() < 1e-10);
    }
}
