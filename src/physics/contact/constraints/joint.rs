//! A contact as a joint of two bodies: force directions, their effect on the balls, and the rates that they resist.

use glam::{DVec2, DVec3};

use crate::{
    physics::{
        BallState,
        contact::{Contact, Friction},
    },
    table::BALLS,
};

/// Accelerations, velocities or their changes: of the centre, and R times those of the spin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Movement {
    pub linear: [DVec2; BALLS],
    pub angular: [DVec3; BALLS],
}

impl Movement {
    /// Returns the largest difference of the members' motions.
    pub fn distance(&self, other: &Self, members: [bool; BALLS]) -> f64 {
        (0..BALLS).filter(|&ball| members[ball]).fold(0.0, |largest, ball| {
            let linear = self.linear[ball].distance(other.linear[ball]);
            linear.max(self.angular[ball].distance(other.angular[ball])).max(largest)
        })
    }
}

/// Motion of a contact's first and second ball under one of its unknowns alone.
#[derive(Clone, Copy, Default)]
pub struct Response {
    pub linear: [DVec2; 2],
    pub angular: [DVec3; 2],
}

/// Components of a force or rate along a contact's normal, its tangent `t = z×n` and z.
pub type Triple = [f64; 3];

/// A contact with its precomputed geometry.
#[derive(Clone, Copy, Default)]
pub struct Joint {
    pub first: usize,
    pub second: Option<usize>,
    pub n: DVec2,
    pub t: DVec2,
    /// Index of its first unknown.
    pub at: usize,
    /// Number of unknowns: the normal force alone, or with two sticking frictions; 2 if the upward friction is prescribed.
    pub unknowns: usize,
    /// Friction along t and z per unit of normal force, if the contact slips.
    pub slip_friction: DVec2,
    /// Part of the rates that does not depend on the accelerations, m/s²: the contact frame of two balls rotates.
    pub bias: Triple,
}

impl Joint {
    /// Creates the joint of a contact with this friction mode and the coefficient `mu` for slip. Its unknowns are numbered from 0. `radius`
    /// is the balls' radius, m.
    #[inline(always)]
    pub fn new(radius: f64, balls: &[BallState; BALLS], contact: &Contact, friction: Friction, mu: f64) -> Self {
        let (n, slip) = contact.normal_and_slip(radius, balls);
        let against = friction.direction(slip);
        Self {
            first: contact.first,
            second: contact.second(),
            n,
            t: n.perp(),
            at: 0,
            unknowns: if against.is_some() { 1 } else { 3 },
            slip_friction: -mu * against.unwrap_or(DVec2::ZERO),
            bias: contact.rotation_bias(radius, balls, n),
        }
    }

    /// Returns the force of one unknown alone.
    pub fn unit(&self, unknown: usize) -> Triple {
        match unknown {
            0 => [1.0, self.slip_friction.x, self.slip_friction.y],
            1 => [0.0, 1.0, 0.0],
            _ => [0.0, 0.0, 1.0],
        }
    }

    /// Returns the effect of a force on the balls: the push, which acts on the second ball in the opposite direction, and the twist.
    pub fn act(&self, [normal, along, up]: Triple) -> (DVec2, DVec3) {
        (normal * self.n + along * self.t, (2.5 * up * self.t).extend(-2.5 * along))
    }

    /// Returns the balls, with the sign with which a force acts on them.
    pub fn members(&self) -> impl Iterator<Item = (usize, f64)> {
        [(self.first, 1.0)].into_iter().chain(self.second.map(|second| (second, -1.0)))
    }

    #[inline(always)]
    pub fn rates(&self, movement: &Movement) -> Triple {
        let (mut relative, mut around) = (movement.linear[self.first], movement.angular[self.first]);
        if let Some(second) = self.second {
            relative -= movement.linear[second];
            around += movement.angular[second];
        }
        self.rates_of(relative, around)
    }

    /// As [`Self::rates`] if only the balls of another contact move, by `response`.
    #[inline(always)]
    pub fn rates_by(&self, other: &Self, response: &Response) -> Triple {
        let (mut relative, mut around) = (DVec2::ZERO, DVec3::ZERO);
        for (place, (ball, _)) in other.members().enumerate() {
            if let Some((_, sense)) = self.members().find(|(member, _)| *member == ball) {
                relative += sense * response.linear[place];
                around += response.angular[place];
            }
        }
        self.rates_of(relative, around)
    }

    #[inline(always)]
    fn rates_of(&self, relative: DVec2, around: DVec3) -> Triple {
        [relative.dot(self.n), relative.dot(self.t) - around.z, around.truncate().dot(self.t)]
    }

    /// Adds a multiple of a response of this contact to a motion.
    #[inline(always)]
    pub fn add(&self, movement: &mut Movement, factor: f64, response: &Response) {
        for (place, (ball, _)) in self.members().enumerate() {
            movement.linear[ball] += factor * response.linear[place];
            movement.angular[ball] += factor * response.angular[place];
        }
    }
}
