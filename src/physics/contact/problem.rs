//! The equations of balls in contact: which accelerations follow from which forces.

use glam::{DVec2, DVec3};

use super::{Laws, MAX_TOUCHES, Touch, contact_slip};
use crate::{
    physics::{BallState, slip},
    table::{BALLS, Table},
};

/// Most frictions that can hold: on the cloth against slipping, moving and spinning, and in every contact.
pub const MAX_GRIPS: usize = 3 * BALLS + MAX_TOUCHES;

/// Accelerations of all balls, m/s² and rad/s².
#[derive(Clone, Copy, Debug, Default)]
pub struct Accelerations {
    pub linear: [DVec2; BALLS],
    pub angular: [DVec3; BALLS],
}

/// A way in which a force acts on one ball, or with opposite senses on two. The same numbers tell what the force does
/// and which rate it changes: a rate of slip or opening is `linear·a + angular·w'`, summed over both balls.
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    first: usize,
    second: Option<usize>,
    linear: DVec2,
    /// Lever, m.
    angular: DVec3,
}

impl Direction {
    /// Rate of change of the speed along this direction, m/s².
    pub fn rate(&self, accelerations: &Accelerations) -> f64 {
        let Accelerations { linear, angular } = accelerations;
        let first = self.linear.dot(linear[self.first]) + self.angular.dot(angular[self.first]);
        match self.second {
            None => first,
            Some(second) => first - self.linear.dot(linear[second]) + self.angular.dot(angular[second]),
        }
    }

    /// Adds what a force per ball mass of size `force`, m/s², does. `twist` is `m/I`, 1/m².
    pub fn push(&self, force: f64, twist: f64, accelerations: &mut Accelerations) {
        accelerations.linear[self.first] += force * self.linear;
        accelerations.angular[self.first] += force * twist * self.angular;
        if let Some(second) = self.second {
            accelerations.linear[second] -= force * self.linear;
            accelerations.angular[second] += force * twist * self.angular;
        }
    }

    /// How much a unit of force along `other` changes the speed along this direction.
    pub fn response(&self, other: &Self, twist: f64) -> f64 {
        let linear = self.linear.dot(other.linear);
        let angular = twist * self.angular.dot(other.angular);
        let mut sum = 0.0;
        for (mine, my_sense) in self.balls() {
            for (theirs, their_sense) in other.balls() {
                if mine == theirs {
                    sum += my_sense * their_sense * linear + angular;
                }
            }
        }
        sum
    }

    fn balls(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        std::iter::once((self.first, 1.0)).chain(self.second.map(|second| (second, -1.0)))
    }

    /// The direction of this force together with `share` of friction along two others of the same contact.
    pub fn with_friction(&self, tangents: &[Self; 2], share: DVec2) -> Self {
        let mut sum = *self;
        for (tangent, share) in tangents.iter().zip(share.to_array()) {
            sum.linear += share * tangent.linear;
            sum.angular += share * tangent.angular;
        }
        sum
    }
}

/// What a contact's normal force must do.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    pub normal: Direction,
    pub tangents: [Direction; 2],
    /// Acceleration along n that the curved course of two touching balls needs, m/s².
    pub centripetal: f64,
    /// Coulomb friction per normal force along the tangents, where the contact slips.
    pub rub: DVec2,
}

/// How large a friction can be.
#[derive(Clone, Copy, Debug)]
pub enum Limit {
    /// Per mass, m/s².
    Fixed(f64),
    /// Coulomb's coefficient and the contact whose normal force counts; none for a contact that never slips.
    Coulomb(Option<f64>, usize),
}

/// A friction that holds what does not slip, as long as it can.
#[derive(Clone, Copy, Debug)]
pub struct Grip {
    pub directions: [Direction; 2],
    /// How many of the directions count.
    pub axes: usize,
    /// Acceleration along the directions that is there without any force, m/s².
    pub bias: DVec2,
    pub limit: Limit,
}

impl Grip {
    /// Rate at which the slip changes that this grip holds, m/s².
    pub fn rate(&self, accelerations: &Accelerations) -> DVec2 {
        let rates = self.directions.map(|direction| direction.rate(accelerations));
        let axes = if self.axes == 2 { DVec2::ONE } else { DVec2::X };
        (DVec2::from_array(rates) + self.bias) * axes
    }
}

/// Everything that acts on the balls in one state.
#[derive(Debug)]
pub struct Problem {
    pub contacts: Vec<Contact>,
    pub grips: Vec<Grip>,
    /// Accelerations by the forces whose size and direction are known.
    pub known: Accelerations,
    /// `m/I`, 1/m².
    pub twist: f64,
}

impl Problem {
    pub fn new(table: &Table, balls: &[BallState; BALLS], touches: &[Touch], laws: &Laws) -> Self {
        let mut problem = Self {
            contacts: Vec::with_capacity(touches.len()),
            grips: Vec::with_capacity(MAX_GRIPS),
            known: Accelerations::default(),
            twist: 2.5 / (table.radius * table.radius),
        };
        for (index, state) in balls.iter().enumerate() {
            if touches.iter().any(|touch| touch.first == index || touch.second == Some(index)) {
                problem.lay_on_cloth(table, index, state, laws);
            }
        }
        for (index, touch) in touches.iter().enumerate() {
            problem.touch(table, balls, touch, index, laws.rubs[index]);
        }
        problem
    }

    /// The cloth's forces on a ball: known where it slips, rolls or spins, a grip where it does not.
    fn lay_on_cloth(&mut self, table: &Table, ball: usize, state: &BallState, laws: &Laws) {
        let radius = table.radius;
        let sliding = table.sliding_friction * table.gravity;
        let resistance = table.rolling_friction * table.gravity;
        let along = |linear, angular| Direction { first: ball, second: None, linear, angular };
        // The slip u = v + R z×w.
        let at_cloth = |axis: DVec2| along(axis, -radius * axis.perp().extend(0.0));
        let grip = |directions, axes, limit| Grip { directions, axes, bias: DVec2::ZERO, limit: Limit::Fixed(limit) };
        let known = &mut self.known;
        if laws.slips[ball] {
            let against = -slip(radius, state.velocity, state.spin).normalize_or_zero();
            at_cloth(against).push(sliding, self.twist, known);
        } else {
            self.grips.push(grip([at_cloth(DVec2::X), at_cloth(DVec2::Y)], 2, sliding));
            if laws.moves[ball] {
                along(-state.velocity.normalize_or_zero(), DVec3::ZERO).push(resistance, self.twist, known);
            } else {
                let still = [along(DVec2::X, DVec3::ZERO), along(DVec2::Y, DVec3::ZERO)];
                self.grips.push(grip(still, 2, resistance));
            }
        }
        let about_vertical = along(DVec2::ZERO, radius * DVec3::Z);
        let boring = table.spinning_friction * table.gravity;
        if laws.spins[ball] {
            about_vertical.push(-boring.copysign(state.spin.z), self.twist, known);
        } else {
            self.grips.push(grip([about_vertical; 2], 1, boring));
        }
    }

    fn touch(&mut self, table: &Table, balls: &[BallState; BALLS], touch: &Touch, index: usize, rubs: bool) {
        let radius = table.radius;
        let (n, along, up) = contact_slip(radius, balls, touch);
        let t = n.perp();
        let direction = |linear, angular| Direction { first: touch.first, second: touch.second, linear, angular };
        let normal = direction(n, DVec3::ZERO);
        // The slip (21) along t and z; n×w has the components (-w_z, w·t) there.
        let tangents = [direction(t, -radius * DVec3::Z), direction(DVec2::ZERO, (radius * t).extend(0.0))];
        let (mut centripetal, mut turning, mut friction) = (0.0, 0.0, Some(table.rail_friction));
        if let Some(second) = touch.second {
            let diameter = 2.0 * radius;
            let across = touch.relative_velocity(balls).dot(t);
            centripetal = across * across / diameter;
            // The slip's z part changes because t turns, its t part because n does (to which v·n = 0 adds nothing).
            let spin = balls[touch.first].spin + balls[second].spin;
            turning = -radius * (across / diameter) * spin.truncate().dot(n);
            friction = table.ball_friction;
        }
        let rub = match friction {
            Some(mu) if rubs => DVec2::new(along, up).normalize_or_zero() * -mu,
            _ => DVec2::ZERO,
        };
        if !rubs || friction.is_none() {
            let bias = DVec2::new(0.0, turning);
            self.grips.push(Grip { directions: tangents, axes: 2, bias, limit: Limit::Coulomb(friction, index) });
        }
        self.contacts.push(Contact { normal, tangents, centripetal, rub });
    }
}
