//! Projected Gauss-Seidel: every law in turn is satisfied with the others held, until none changes.
//!
//! It converges from anywhere, which the active-set method does not, but only geometrically.

use super::{
    problem::Problem,
    regime::{NEGLIGIBLE, Regime, Solution, limit_of},
};

/// A bound on the sweeps; a ball that sticks to cloth, cushion and another ball at once needs some hundreds.
const MAX_SWEEPS: usize = 1000;

/// Forces that obey the laws, and the regime that they show.
#[cold]
pub fn sweep(problem: &Problem, guess: &Solution) -> (Regime, Solution) {
    let twist = problem.twist;
    let mut solution = *guess;
    solution.accelerations = problem.known;
    let accelerations = &mut solution.accelerations;
    for (index, contact) in problem.contacts.iter().enumerate() {
        solution.normal[index] = solution.normal[index].max(0.0);
        contact.normal.with_friction(&contact.tangents, contact.rub).push(solution.normal[index], twist, accelerations);
    }
    for (grip, force) in problem.grips.iter().zip(&solution.grip) {
        for axis in 0..grip.axes {
            grip.directions[axis].push(force[axis], twist, accelerations);
        }
    }
    for _ in 0..MAX_SWEEPS {
        let mut change = 0.0_f64;
        for (index, contact) in problem.contacts.iter().enumerate() {
            let opening = contact.normal.rate(&solution.accelerations) + contact.centripetal;
            let own = contact.normal.response(&contact.normal, twist);
            let wanted = (solution.normal[index] - opening / own).max(0.0);
            let more = wanted - solution.normal[index];
            let force = contact.normal.with_friction(&contact.tangents, contact.rub);
            force.push(more, twist, &mut solution.accelerations);
            solution.normal[index] = wanted;
            change = change.max(more.abs());
        }
        for (index, grip) in problem.grips.iter().enumerate() {
            let rate = grip.rate(&solution.accelerations);
            let own = grip.directions[0].response(&grip.directions[0], twist);
            let held = solution.grip[index] - rate / own;
            let wanted = limit_of(grip.limit, &solution).map_or(held, |limit| held.clamp_length_max(limit));
            let more = wanted - solution.grip[index];
            for axis in 0..grip.axes {
                grip.directions[axis].push(more[axis], twist, &mut solution.accelerations);
            }
            solution.grip[index] = wanted;
            change = change.max(more.length());
        }
        if change < NEGLIGIBLE {
            break;
        }
    }
    let mut regime = Regime::HOLDING;
    for index in 0..problem.contacts.len() {
        regime.pushing[index] = solution.normal[index] > 0.0;
    }
    for (index, grip) in problem.grips.iter().enumerate() {
        let force = solution.grip[index];
        let at_limit = limit_of(grip.limit, &solution).is_some_and(|limit| force.length() >= limit * (1.0 - 1e-9));
        regime.limited[index] = at_limit.then(|| force.normalize_or_zero());
    }
    (regime, solution)
}
