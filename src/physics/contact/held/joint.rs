//! A contact as a joint of two bodies: the directions of its forces, what they do to its balls, and the rates that they resist.

use glam::{DVec2, DVec3};

use crate::{
    physics::{
        BallState,
        contact::{Contact, Friction},
    },
    table::BALLS,
};

/// Accelerations, speeds or their changes: of the centre, and R times those of the spin.
#[derive(Clone, Copy, Debug)]
pub struct Movement {
    pub linear: [DVec2; BALLS],
    pub angular: [DVec3; BALLS],
}

impl Movement {
    pub const NONE: Self = Self { linear: [DVec2::ZERO; BALLS], angular: [DVec3::ZERO; BALLS] };

    /// The largest difference of the members' speeds.
    pub fn distance(&self, other: &Self, members: [bool; BALLS]) -> f64 {
        (0..BALLS).filter(|&ball| members[ball]).fold(0.0, |largest, ball| {
            let linear = self.linear[ball].distance(other.linear[ball]);
            linear.max(self.angular[ball].distance(other.angular[ball])).max(largest)
        })
    }
}

/// How a contact's balls, the first and the second, move under one of its unknowns alone.
#[derive(Clone, Copy)]
pub struct Response {
    pub linear: [DVec2; 2],
    pub angular: [DVec3; 2],
}

impl Response {
    pub const NONE: Self = Self { linear: [DVec2::ZERO; 2], angular: [DVec3::ZERO; 2] };
}

/// Along a contact's normal, its tangent `t = z×n` and z: forces, or rates.
pub type Triple = [f64; 3];

/// A contact and what is known of it.
#[derive(Clone, Copy)]
pub struct Joint {
    pub first: usize,
    pub second: Option<usize>,
    pub n: DVec2,
    pub t: DVec2,
    /// Its first unknown.
    pub at: usize,
    /// The normal force alone, or two frictions that hold as well; without the one upwards where that is prescribed.
    pub unknowns: usize,
    /// Friction along t and z for each unit of the normal force, where the contact slips.
    pub slip_friction: DVec2,
    /// What the rates have besides the accelerations' part, m/s²: two balls' courses around each other bend.
    pub bias: Triple,
}

impl Joint {
    pub const NONE: Self = Self {
        first: 0,
        second: None,
        n: DVec2::ZERO,
        t: DVec2::ZERO,
        at: 0,
        unknowns: 0,
        slip_friction: DVec2::ZERO,
        bias: [0.0; 3],
    };

    /// The joint of a contact whose friction does this, with the coefficient `mu` where it slips; the numbers of its unknowns begin
    /// at 0. The balls' radius is in m.
    #[inline(always)]
    pub fn new(radius: f64, balls: &[BallState; BALLS], contact: &Contact, friction: Friction, mu: f64) -> Self {
        let (n, slip) = contact.normal_and_slip(radius, balls);
        let against = friction.direction(slip);
        Self {
            first: contact.first,
            second: contact.second,
            n,
            t: n.perp(),
            at: 0,
            unknowns: if against.is_some() { 1 } else { 3 },
            slip_friction: -mu * against.unwrap_or(DVec2::ZERO),
            bias: contact.bends(radius, balls, n),
        }
    }

    /// The force of one unknown alone.
    pub fn unit(&self, unknown: usize) -> Triple {
        match unknown {
            0 => [1.0, self.slip_friction.x, self.slip_friction.y],
            1 => [0.0, 1.0, 0.0],
            _ => [0.0, 0.0, 1.0],
        }
    }

    /// What a force does to each of its balls: the push, which the second gets the other way, and the twist.
    pub fn act(&self, [normal, along, up]: Triple) -> (DVec2, DVec3) {
        (normal * self.n + along * self.t, (2.5 * up * self.t).extend(-2.5 * along))
    }

    /// Its balls, with the sense in which a force acts on them.
    pub fn members(&self) -> impl Iterator<Item = (usize, f64)> {
        [(self.first, 1.0)].into_iter().chain(self.second.map(|second| (second, -1.0)))
    }

    #[inline(always)]
    pub fn rates(&self, movement: &Movement) -> Triple {
        let (mut apart, mut around) = (movement.linear[self.first], movement.angular[self.first]);
        if let Some(second) = self.second {
            apart -= movement.linear[second];
            around += movement.angular[second];
        }
        self.rates_of(apart, around)
    }

    /// The same where only the balls of another contact move, in `response` to it.
    #[inline(always)]
    pub fn rates_by(&self, other: &Self, response: &Response) -> Triple {
        let (mut apart, mut around) = (DVec2::ZERO, DVec3::ZERO);
        for (place, (ball, _)) in other.members().enumerate() {
            if let Some((_, sense)) = self.members().find(|(member, _)| *member == ball) {
                apart += sense * response.linear[place];
                around += response.angular[place];
            }
        }
        self.rates_of(apart, around)
    }

    #[inline(always)]
    fn rates_of(&self, apart: DVec2, around: DVec3) -> Triple {
        [apart.dot(self.n), apart.dot(self.t) - around.z, around.truncate().dot(self.t)]
    }

    /// Adds a multiple of a response to it to a movement.
    #[inline(always)]
    pub fn add(&self, movement: &mut Movement, factor: f64, response: &Response) {
        for (place, (ball, _)) in self.members().enumerate() {
            movement.linear[ball] += factor * response.linear[place];
            movement.angular[ball] += factor * response.angular[place];
        }
    }
}
