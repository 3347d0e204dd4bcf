//! Forces of a ball whose rolling resistance is in Filippov mode: it acts only as far as the cloth can hold the ball.
//!
//! All forces are linear in the share of the resistance that is removed, so that two solutions and a quadratic equation give the share. A
//! ball that rolls along a cushion is kept from turning towards it by the cloth and by the cushion's upward friction. Their division is one
//! more unknown, and they hold most when both are at their limits.

use glam::DVec2;

use super::{
    ConstraintSystem, Movement, SINGULAR, Scene, Solved, Triple, coefficient, entries, factorize, frictions,
    rolling_resistance,
};
use crate::{physics::contact::forces::DEPARTING, table::BALLS};

/// Bound on the Newton steps towards both limits; from the share for the cloth alone, four or five are enough.
const MAX_STEPS: usize = 20;

/// Tolerance of the share, and of the upward friction as a share of the cloth's limit.
const TOLERANCE: f64 = 1e-15;

/// Contact forces and the resulting motion, both linear in the share and in the upward friction.
#[derive(Clone, Copy)]
struct ForcesAndMotion<const ROOM: usize> {
    values: [Triple; ROOM],
    free: Movement,
    moved: Movement,
    /// Force of the cloth against the slip of the ball in Filippov mode.
    cloth: DVec2,
}

impl<const ROOM: usize> ForcesAndMotion<ROOM> {
    /// Adds a multiple of the difference between two solutions.
    fn plus(mut self, factor: f64, from: &Self, to: &Self) -> Self {
        let values = from.values.as_flattened().iter().zip(to.values.as_flattened());
        for (sum, (from, to)) in self.values.as_flattened_mut().iter_mut().zip(values) {
            *sum += factor * (to - from);
        }
        self.free.follow(factor, &from.free, &to.free);
        self.moved.follow(factor, &from.moved, &to.moved);
        self.cloth += factor * (to.cloth - from.cloth);
        self
    }
}

impl Movement {
    /// Adds a multiple of the difference between two motions.
    fn follow(&mut self, factor: f64, from: &Self, to: &Self) {
        for ball in 0..BALLS {
            self.linear[ball] += factor * (to.linear[ball] - from.linear[ball]);
            self.angular[ball] += factor * (to.angular[ball] - from.angular[ball]);
        }
    }
}

impl<const ROOM: usize> ConstraintSystem<ROOM> {
    /// Whether the forces are unique.
    fn is_unique(&mut self) -> bool {
        self.number::<0>();
        let count = self.unknowns();
        let mut matrix = self.matrix(&self.responses());
        let mut pivots = [[0; 3]; ROOM];
        factorize(&mut entries(&mut matrix)[..count * count], &mut pivots.as_flattened_mut()[..count]) > SINGULAR
    }

    /// Returns forces and motion, including the force with which the cloth holds the `ball`.
    fn solution(&mut self, free: &Movement, ball: usize) -> Option<ForcesAndMotion<ROOM>> {
        let moved = self.solve(free, true)?;
        let without_cloth = self.without_cloth(free);
        let (cloth, ..) = self.sticking[ball].holding_forces(without_cloth.linear[ball], without_cloth.angular[ball]);
        Some(ForcesAndMotion { values: self.values, free: *free, moved, cloth })
    }
}

impl<const ROOM: usize> Solved<ROOM> {
    /// Returns the solution with the `ball`'s resistance in Filippov mode; the `free` motion includes the whole resistance. `None` if the
    /// division of a force is ambiguous beyond that with a single cushion.
    #[cold]
    #[inline(never)]
    pub(super) fn in_filippov_mode(
        Scene { table, balls, contacts, .. }: Scene<'_>,
        mut system: ConstraintSystem<ROOM>,
        free: &Movement,
        ball: usize,
    ) -> Option<Self> {
        let [limit, ..] = frictions(table);
        let mut without = *free;
        without.linear[ball] += rolling_resistance(table, &balls[ball]) * balls[ball].velocity.normalize_or_zero();
        let cushion = if system.is_unique() {
            None
        } else {
            Some(system.fix_redundant_friction(|held| held == ball).filter(|_| system.is_unique())?)
        };
        let (whole, none) = (system.solution(free, ball)?, system.solution(&without, ball)?);
        let held = Force { whole: whole.cloth, by_share: none.cloth - whole.cloth, by_up: DVec2::ZERO };
        let mut edge = Edge::of_the_cloth(limit, held);
        let mut solution = whole;
        if let Some(index) = cushion {
            system.values[index][2] += 1.0;
            let raised = system.solution(free, ball)?;
            let force = |of: fn(&Triple) -> DVec2| {
                let [whole, none, raised] = [&whole, &none, &raised].map(|solution| of(&solution.values[index]));
                Force { whole, by_share: none - whole, by_up: raised - whole }
            };
            let held = Force { by_up: raised.cloth - held.whole, ..held };
            let friction = force(|[_, along, up]| DVec2::new(*along, *up));
            let push = force(|[normal, ..]| DVec2::new(*normal, 0.0)).times(coefficient(table, &contacts[index]));
            let (both, up) = edge.with_a_cushion(limit, held, friction, push)?;
            (edge, solution) = (both, solution.plus(up, &whole, &raised));
            system.joints[index].unknowns = 3;
        }
        let ForcesAndMotion { values, free, moved, .. } = solution.plus(edge.share.min(1.0), &whole, &none);
        system.values = values;
        Some(Self { system, free, moved, share_margin: edge.slack(DEPARTING * table.gravity) })
    }
}

/// A force as a linear function of the removed share of the resistance and of the upward friction, per mass, m/s².
#[derive(Clone, Copy)]
struct Force {
    whole: DVec2,
    by_share: DVec2,
    by_up: DVec2,
}

impl Force {
    fn times(self, factor: f64) -> Self {
        Self { whole: factor * self.whole, by_share: factor * self.by_share, by_up: factor * self.by_up }
    }

    /// Returns the magnitude and its derivatives with respect to share and upward friction.
    fn size(&self, share: f64, up: f64) -> (f64, DVec2) {
        let force = self.whole + share * self.by_share + up * self.by_up;
        let direction = force.normalize_or_zero();
        (force.length(), DVec2::new(direction.dot(self.by_share), direction.dot(self.by_up)))
    }
}

/// The state in which the holding forces are exactly at their limits.
#[derive(Clone, Copy)]
struct Edge {
    share: f64,
    /// Decrease of the forces relative to their limits per unit of share, m/s².
    falls: f64,
    /// Remaining excess of the forces over their limits, m/s².
    over: f64,
    /// Margin by which neither force takes over the whole load, m/s².
    divided: f64,
}

impl Edge {
    /// Returns the smallest share at which the cloth is within its limit, or the share nearest to that.
    fn of_the_cloth(limit: f64, held: Force) -> Self {
        let (square, falls) = (held.by_share.length_squared(), -held.whole.dot(held.by_share));
        let excess = held.whole.length_squared() - limit * limit;
        let discriminant = falls * falls - square * excess;
        let share = if discriminant < 0.0 { falls / square } else { excess / (falls + discriminant.sqrt()) };
        let (size, by) = held.size(share, 0.0);
        Self { share, falls: -by.x, over: size - limit, divided: f64::INFINITY }
    }

    /// Returns the share at which the cloth and a cushion's friction, with the limit `most`, are both at their limits, and the resulting
    /// change of the upward friction; `None` if there is no such share.
    fn with_a_cushion(mut self, limit: f64, held: Force, friction: Force, most: Force) -> Option<(Self, f64)> {
        let mut up = 0.0;
        for _ in 0..MAX_STEPS {
            let [cloth, friction, most] = [held, friction, most].map(|force| force.size(self.share, up));
            let over = DVec2::new(cloth.0 - limit, friction.0 - most.0);
            let (by_share, by_up) =
                (DVec2::new(cloth.1.x, friction.1.x - most.1.x), DVec2::new(cloth.1.y, friction.1.y - most.1.y));
            let area = by_share.perp_dot(by_up);
            let (share_step, up_step) = (-over.perp_dot(by_up) / area, -by_share.perp_dot(over) / area);
            // More upward friction relieves one and loads the other equally.
            let part = by_up.y / (by_up.y - by_up.x);
            self = Self {
                share: self.share + share_step,
                falls: -by_share.dot(DVec2::new(part, 1.0 - part)),
                over: over.max_element(),
                divided: limit * part.min(1.0 - part),
            };
            up += up_step;
            if share_step.abs() <= TOLERANCE && up_step.abs() <= TOLERANCE * limit {
                break;
            }
        }
        (self.share.is_finite() && up.is_finite()).then_some((self, up))
    }

    /// Returns the margin of the share from its bounds, m/s²; a slip rate below `departing` counts as sticking.
    fn slack(&self, departing: f64) -> f64 {
        let bounds = (self.share * self.falls).min((1.0 - self.share) * self.falls + departing);
        bounds.min(self.divided) - self.over.max(0.0)
    }
}
