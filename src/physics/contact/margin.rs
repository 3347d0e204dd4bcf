//! Non-unique forces: for example, a ball in a corner that is pushed there is held by cushions and cloth together, and every division
//! between them obeys all laws.
//!
//! A solver may find a solution at the edge of the admissible set: a friction at its limit without any slip rate to resist, or a contact
//! with a tiny normal force that the friction of another contact could replace. Following such a solution would violate a law at once. Such
//! a friction is therefore restricted to a part of its limit, and such a contact to no force, if the other forces can compensate. The
//! resulting forces remain valid for some time.

use super::{
    Effort,
    problem::{ForceKind, Limit, Problem},
    solve::{Branch, Solution, solve},
};

/// Shares of their limits to which frictions are restricted; the first share with which all laws hold is used.
const SHARES: [f64; 3] = [0.5, 0.9, 0.99];

/// Normal forces below this share of the largest force are tiny.
const TINY_PUSH: f64 = 1e-6;

/// Largest remaining opening acceleration, as a share of a tiny normal force that the others replace.
const MAX_OPENING: f64 = 1e-3;

/// Largest number of rounds; each round restricts the forces that have newly reached an edge.
const ROUNDS: usize = 6;

/// Returns the rates that an unknown resists, m/s².
pub fn rates(problem: &Problem, solution: &Solution, index: usize) -> [f64; 2] {
    let accelerations = problem.accelerations(&solution.values);
    let unknown = &problem.unknowns[index];
    std::array::from_fn(|axis| {
        let row = unknown.first + axis;
        if axis < unknown.count { problem.rates[row].dot(&accelerations) + problem.bias[row] } else { 0.0 }
    })
}

/// Whether there are several contacts, whose normal forces come first. Nothing else can replace the normal force of a single contact.
fn are_several(problem: &Problem) -> bool {
    problem.unknowns.get(1).is_some_and(|unknown| matches!(unknown.kind, ForceKind::Normal(_)))
}

/// Whether an unknown is at the edge of its admissible set although no rate is above `none`, m/s².
fn is_at_edge(problem: &Problem, solution: &Solution, index: usize, none: f64) -> bool {
    let unknown = &problem.unknowns[index];
    match (solution.branches[index], unknown.kind) {
        (Branch::Holds, ForceKind::Normal(_)) if are_several(problem) => {
            let largest = solution.values.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
            solution.values[unknown.first] < TINY_PUSH * largest
        }
        (Branch::Limited(_), _) => rates(problem, solution, index).iter().all(|rate| rate.abs() <= none),
        _ => false,
    }
}

/// Returns forces away from the edges, in which no friction that was moved from an edge slips faster than at the rate `none`, m/s². `None`
/// if no force is at an edge, or no other forces obey all laws.
pub fn with_margin(problem: &Problem, solution: &Solution, none: f64, effort: &Effort) -> Option<Solution> {
    let at_edge = |index: &usize| is_at_edge(problem, solution, *index, none);
    // Normal forces come first: if the last unknown at an edge is one, the share of frictions has no effect.
    let last = (0..problem.unknowns.len()).rev().find(at_edge)?;
    let shares = if matches!(problem.unknowns[last].kind, ForceKind::Normal(_)) { &SHARES[..1] } else { &SHARES };
    shares.iter().find_map(|share| with_share(problem, solution, none, *share, effort))
}

fn with_share(problem: &Problem, solution: &Solution, none: f64, share: f64, effort: &Effort) -> Option<Solution> {
    let (mut relaxed, mut found) = (problem.clone(), solution.clone());
    let mut spared = vec![false; problem.unknowns.len()];
    for _ in 0..ROUNDS {
        let mut more = false;
        for (index, spared) in spared.iter_mut().enumerate().filter(|(_, spared)| !**spared) {
            if is_at_edge(&relaxed, &found, index, none) {
                (*spared, more) = (true, true);
                let unknown = &mut relaxed.unknowns[index];
                match &mut unknown.limit {
                    limit if matches!(unknown.kind, ForceKind::Normal(_)) => *limit = Limit::Fixed(0.0),
                    Limit::Fixed(limit) | Limit::Coulomb(limit, _) => *limit *= share,
                }
            }
        }
        if !more {
            for (branch, _) in
                found.branches.iter_mut().zip(&spared).filter(|(branch, spared)| **spared && **branch != Branch::Absent)
            {
                *branch = Branch::Holds;
            }
            return Some(found);
        }
        found = solve(&relaxed, &found.values, 1, effort);
        let holds = |index: usize| match problem.unknowns[index].kind {
            ForceKind::Normal(_) => {
                rates(&relaxed, &found, index)[0] >= -MAX_OPENING * solution.values[problem.unknowns[index].first].abs()
            }
            _ => rates(&relaxed, &found, index).iter().all(|rate| rate.abs() <= none),
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
        table::{Rail, Table},
    };

    /// A ball in a corner is pushed there by another ball that slips on it: cloth and cushions share the force.
    #[test]
    fn forces_on_a_ball_in_a_corner_have_margin() {
        let table = Table::preset("textbook").unwrap();
        let corner = DVec2::new(table.half_length(), -table.half_width());
        let apart = 2.0 * table.radius * DVec2::new(-0.034_822, 0.999_394).normalize();
        let mut balls = [corner + apart, corner, DVec2::ZERO].map(BallState::at_rest);
        balls[0].velocity = DVec2::new(-0.0313, -0.001_09);
        balls[0].spin = DVec3::new(29.64, -0.28, 13.58);
        balls[1].spin.z = -0.7;
        let cushions = [Rail::Right, Rail::Bottom].map(|rail| Contact::with_cushion(1, rail));
        let contacts = [cushions[0], cushions[1], Contact::of_balls(0, 1)];
        let set = ActiveSet::of(&table, &balls, &contacts, 1e-10);
        let scene = Scene { table: &table, balls: &balls, contacts: &contacts, set: &set };
        let resolved = scene.resolve(1e-11, None, &Effort::default()).unwrap();
        assert!(resolved.forces.converged && !resolved.shared);
        assert!(resolved.forces.slack > 1e-3 * table.gravity, "{}", resolved.forces.slack);
        assert!(resolved.forces.linear[1].length() < 1e-10);
    }
}
