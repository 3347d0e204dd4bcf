//! Determines which contacts push and which frictions stick.
//!
//! The complementarity problem determines this with one exception: the rolling resistance. While a ball rolls, the cloth's friction holds
//! it against this resistance, too; a sliding ball has none. If friction cannot hold a ball with the whole resistance but could without it,
//! neither mode is consistent, because a slip would end as soon as it begins. The ball then rolls with as much of the resistance as
//! friction can hold (a sliding mode in the sense of Filippov, "Differential Equations with Discontinuous Righthand Sides", 1988).

use glam::DVec2;

use super::{
    Effort, Forces, Friction, Scene,
    forces::{DEPARTING, Resolved},
    involve,
    margin::rates,
    problem::{ForceKind, Problem},
    solve::{ATTEMPTS, Branch, Solution, solve},
};
use crate::table::{BALLS, Table};

/// Bisection steps for the share of the resistance that is removed. They only determine which contacts hold; the share itself follows from
/// the forces.
const HALVINGS: usize = 20;

/// Largest accepted excess of a holding force over its limit, as a share of g: a thousand roundings.
const ROUNDING: f64 = 1e-12;

impl Scene<'_> {
    /// Determines the contacts that push, the frictions that stick, and the forces; the present active set defines what already slips.
    /// `None` if no normal force exceeds `least_push`, m/s², and no contact is a paradox. If forces are not unique, those near `similar`
    /// are chosen.
    pub fn resolve(self, least_push: f64, similar: Option<&Forces>, effort: &Effort) -> Option<Resolved> {
        let (mut problem, mut solution) = self.solved(similar, ATTEMPTS, effort);
        self.resolve_filippov(least_push, &mut problem, &mut solution, effort)
            .or_else(|| self.read_off(least_push, &problem, &solution, effort))
    }

    /// Returns the active set in which a ball's rolling resistance is in Filippov mode; `None` if there is no such ball. Removes the
    /// resistance from the problem and its solution for each ball that slides even without it.
    fn resolve_filippov(
        self,
        least_push: f64,
        problem: &mut Problem,
        solution: &mut Solution,
        effort: &Effort,
    ) -> Option<Resolved> {
        let Self { table, balls, set, .. } = self;
        let rolls = |ball: usize| set.cloth[ball] == Friction::Sticks && matches!(set.roll[ball], Friction::Slips(_));
        for ball in (0..BALLS).filter(|&ball| involve(self.contacts, ball) && rolls(ball) && !set.yields()) {
            if !begins_to_slide(table, problem, solution, ball) {
                continue;
            }
            let without = |share: f64, near: &Solution| {
                let mut reduced = problem.clone();
                reduced.reduce_resistance(table, ball, &balls[ball], share);
                let solution = solve(&reduced, &near.values, 1, effort);
                (reduced, solution)
            };
            let mut rolling = without(1.0, solution);
            if begins_to_slide(table, &rolling.0, &rolling.1, ball) {
                (*problem, *solution) = rolling;
                continue;
            }
            // Contacts that push and stick without the resistance mostly do so with part of it, too.
            if let Some(resolved) = self.resolve_with_share(ball, least_push, &rolling.0, &rolling.1, effort) {
                return Some(resolved);
            }
            let (mut sliding, mut most) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let share = 0.5 * (sliding + most);
                let tried = without(share, &rolling.1);
                if !tried.1.converged {
                    // Shares on either side would not converge either.
                    break;
                }
                if begins_to_slide(table, &tried.0, &tried.1, ball) {
                    sliding = share;
                } else {
                    (rolling, most) = (tried, share);
                }
            }
            if let Some(resolved) = self.resolve_with_share(ball, least_push, &rolling.0, &rolling.1, effort) {
                return Some(resolved);
            }
        }
        None
    }

    /// Returns the active set in which the ball rolls with as much resistance as the friction can hold.
    fn resolve_with_share(
        self,
        ball: usize,
        least_push: f64,
        problem: &Problem,
        solution: &Solution,
        effort: &Effort,
    ) -> Option<Resolved> {
        let mut resolved = self.read_off(least_push, problem, solution, effort)?;
        resolved.set.roll[ball] = Friction::Filippov;
        // A slip that begins without the resistance may stick with part of it.
        let begins = resolved.set.contact.iter_mut().filter(|friction| friction.begins());
        begins.for_each(|begins| *begins = Friction::Sticks);
        let scene = Scene { contacts: &resolved.contacts, set: &resolved.set, ..self };
        let forces =
            scene.forces(Some(&resolved.forces)).filter(|held| held.slack >= -ROUNDING * self.table.gravity)?;
        Some(Resolved { forces, shared: false, ..resolved })
    }
}

/// Whether the cloth can no longer hold a ball that rolled.
fn begins_to_slide(table: &Table, problem: &Problem, solution: &Solution, ball: usize) -> bool {
    problem.unknowns.iter().zip(&solution.branches).enumerate().any(|(index, (unknown, branch))| {
        matches!((unknown.kind, branch), (ForceKind::Cloth(held), Branch::Limited(_)) if held == ball)
            && DVec2::from_array(rates(problem, solution, index)).length() > DEPARTING * table.gravity
    })
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use crate::{
        physics::{ActiveSet, BallState, Contact, Effort, Forces, Friction, Resolved, Scene, slip},
        table::{Rail, Table},
    };

    /// A ball that rolls along the lower cushion and is pressed against it by another ball. `second` has the velocity and spin of the other
    /// ball, and its position relative to the first.
    fn pressed(table: &Table, speed: f64, about_vertical: f64, second: [DVec3; 3]) -> ([BallState; 3], [Contact; 2]) {
        let position = DVec2::new(0.0, -table.half_width());
        let spin = DVec3::new(0.0, speed / table.radius, about_vertical);
        let rolls = BallState { position, velocity: DVec2::new(speed, 0.0), spin };
        let [velocity, spin, apart] = second;
        let presses = BallState {
            position: position + 2.0 * table.radius * apart.truncate().normalize(),
            velocity: velocity.truncate(),
            spin,
        };
        let contacts = [Contact::with_cushion(0, Rail::Bottom), Contact::of_balls(0, 1)];
        ([rolls, presses, BallState::at_rest(DVec2::new(0.9, 0.4))], contacts)
    }

    /// `thesis` with ten per cent more rolling resistance.
    fn rough() -> Table {
        let table = Table::preset("thesis").unwrap();
        Table { rolling_friction: 1.1 * table.rolling_friction, ..table }
    }

    fn resolved(table: &Table, (balls, contacts): &([BallState; 3], [Contact; 2])) -> Resolved {
        let set = ActiveSet::of(table, balls, contacts, 1e-4);
        let scene = Scene { table, balls, contacts, set: &set };
        scene.resolve(1e-11, None, &Effort::default()).expect("they press each other")
    }

    /// Asserts that the first ball continues to roll with the cloth's friction at its limit, and that no law is violated. With the whole
    /// resistance one would be; with a thousandth of it the ball would roll with all of it.
    fn rolls_with_part_of_its_resistance(table: &Table, pressed: &([BallState; 3], [Contact; 2])) -> Forces {
        let Resolved { set, forces: reduced, shared, .. } = resolved(table, pressed);
        assert_eq!((set.cloth[0], set.roll[0], shared), (Friction::Sticks, Friction::Filippov, false));
        let limit = table.sliding_friction * table.gravity;
        assert!((reduced.cloth[0].length() - limit).abs() < 1e-12, "{:?} of {limit}", reduced.cloth[0]);
        assert!(slip(table.radius, reduced.linear[0], reduced.angular[0]).length() < 1e-12 && reduced.slack > -1e-12);
        let whole = ActiveSet { roll: [Friction::Slips(DVec2::ZERO); 3], ..set };
        let scene = Scene { table, balls: &pressed.0, contacts: &pressed.1, set: &whole };
        assert!(scene.forces(Some(&reduced)).expect("forces").slack < -1e-4);
        let smooth = Table { rolling_friction: 1e-3 * table.rolling_friction, ..table.clone() };
        let Resolved { set, .. } = resolved(&smooth, pressed);
        assert_eq!((set.cloth[0], set.roll[0]), (Friction::Sticks, Friction::Slips(DVec2::ZERO)));
        reduced
    }

    #[test]
    fn ball_at_the_edge_of_sliding_has_partial_rolling_resistance() {
        let table = rough();
        let second = [
            DVec3::new(-0.120_405, 0.000_195, 0.0),
            DVec3::new(0.214_397, -3.935_79, -1.669_767),
            DVec3::new(-0.001_608_785, 0.060_978_782, 0.0),
        ];
        rolls_with_part_of_its_resistance(&table, &pressed(&table, -0.127_815, 1.426_753, second));
    }

    /// Here the ball does not slip on the cushion either: the cushion's upward friction and the cloth's hold the ball together.
    #[test]
    fn cloth_and_cushion_together_keep_the_largest_possible_resistance() {
        let table = rough();
        let second = [
            DVec3::new(0.236_963, -0.103_806, 0.0),
            DVec3::new(7.096_403, 5.769_832, -2.173_038),
            DVec3::new(0.037_382_565, 0.048_203_152, 0.0),
        ];
        let speed = 0.103_11;
        let forces = rolls_with_part_of_its_resistance(&table, &pressed(&table, speed, -speed / table.radius, second));
        let most = table.rail_friction * forces.normal[0];
        assert!((forces.friction[0].length() - most).abs() < 1e-12, "{:?} of {most}", forces.friction[0]);
    }
}
