//! The active set: contacts that push and modes of the frictions, which stay constant between two transitions.

use arrayvec::ArrayVec;
use glam::DVec2;

use super::{
    Contact,
    problem::{ForceKind, coefficient},
};
use crate::{
    physics::{BallState, slip},
    table::{BALLS, Table},
};

/// Largest number of contacts of three balls: with each other, and with two cushions each.
pub const MAX_CONTACTS: usize = 9;

/// A list of contacts in a fixed order.
pub type Contacts = ArrayVec<Contact, MAX_CONTACTS>;

/// Mode of a friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// Stick.
    Sticks,
    /// The friction is at its limit and slip begins, but so slowly that the friction opposes the rate of the slip. The direction of the
    /// slip itself would turn too fast.
    Yields,
    /// Slip: the friction acts at its limit against the slip plus this offset, m/s, because slip has a direction before it has a speed. For
    /// a spin, the offset is the sign.
    Slips(DVec2),
    /// Filippov sliding mode of the rolling resistance: it acts only as far as the cloth's friction can hold the ball without sliding.
    /// Sliding would end at once, because a sliding ball has no rolling resistance (Filippov 1988).
    Filippov,
}

impl Friction {
    /// Returns slip if it is faster than `none`, m/s, otherwise stick.
    fn of(slip: DVec2, none: f64) -> Self {
        if slip.length() > none { Self::Slips(DVec2::ZERO) } else { Self::Sticks }
    }

    /// Returns the unit vector against which the friction acts; `None` if it sticks.
    pub(super) fn direction(self, slip: DVec2) -> Option<DVec2> {
        match self {
            Self::Sticks | Self::Yields => None,
            Self::Slips(start) => Some((slip + start).normalize_or_zero()),
            Self::Filippov => Some(slip.normalize_or_zero()),
        }
    }

    /// Whether a slip begins in this mode.
    pub(super) fn begins(self) -> bool {
        !matches!(self, Self::Sticks | Self::Filippov | Self::Slips(DVec2::ZERO))
    }
}

/// The modes of all frictions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveSet {
    /// Friction of the cloth against the slip of each ball.
    pub cloth: [Friction; BALLS],
    /// Rolling resistance of the cloth on each ball; only used if the ball does not slip.
    pub roll: [Friction; BALLS],
    /// Friction of the cloth against each ball's spin about the vertical.
    pub spin: [Friction; BALLS],
    /// Friction in each contact.
    pub contact: [Friction; MAX_CONTACTS],
}

impl ActiveSet {
    /// Every friction slips, without a known initial direction.
    pub const SLIPPING: Self = Self {
        cloth: [Friction::Slips(DVec2::ZERO); BALLS],
        roll: [Friction::Slips(DVec2::ZERO); BALLS],
        spin: [Friction::Slips(DVec2::ZERO); BALLS],
        contact: [Friction::Slips(DVec2::ZERO); MAX_CONTACTS],
    };

    /// Returns the active set of the state `balls`, with slips and speeds below `none`, m/s, taken as zero. Slipping contacts without a
    /// coefficient of friction yield.
    pub fn of(table: &Table, balls: &[BallState; BALLS], contacts: &[Contact], none: f64) -> Self {
        let radius = table.radius;
        let mut friction = [Friction::Sticks; MAX_CONTACTS];
        for (friction, contact) in friction.iter_mut().zip(contacts) {
            // A contact without friction cannot stick.
            let none = if coefficient(table, contact) > 0.0 { none } else { -1.0 };
            *friction = Friction::of(contact.slip(radius, balls), none);
            if contact.never_slips(table) && *friction != Friction::Sticks {
                *friction = Friction::Yields;
            }
        }
        let spin = |ball: BallState| match radius * ball.spin.z {
            speed if speed > none => Friction::Slips(DVec2::X),
            speed if speed < -none => Friction::Slips(DVec2::NEG_X),
            _ => Friction::Sticks,
        };
        Self {
            cloth: balls.map(|ball| Friction::of(slip(radius, ball.velocity, ball.spin), none)),
            roll: balls.map(|ball| Friction::of(ball.velocity, none)),
            spin: balls.map(spin),
            contact: friction,
        }
    }

    /// Returns this set with slip wherever this set or the `other` yields, so that no speed is stopped there.
    #[must_use]
    pub fn with_yielding_as_slipping(mut self, yields: &Self) -> Self {
        let each = |mine: &mut [Friction], theirs: &[Friction]| {
            for (mine, theirs) in mine.iter_mut().zip(theirs) {
                if *mine == Friction::Yields || *theirs == Friction::Yields {
                    *mine = Friction::Slips(DVec2::ZERO);
                }
            }
        };
        each(&mut self.cloth, &yields.cloth);
        each(&mut self.roll, &yields.roll);
        each(&mut self.contact, &yields.contact);
        self
    }

    /// Whether no slip begins: no friction yields, and no slip has a direction only.
    pub fn begins_no_slip(&self) -> bool {
        !self.cloth.iter().chain(&self.roll).chain(&self.contact).any(|friction| friction.begins())
    }

    /// Whether a ball slips, rolls or spins that is held in the set `held`.
    pub fn releases(&self, held: &Self) -> bool {
        let pairs = [(&self.cloth, &held.cloth), (&self.roll, &held.roll), (&self.spin, &held.spin)];
        let releases = |(now, before): (&Friction, &Friction)| *before == Friction::Sticks && *now != Friction::Sticks;
        pairs.into_iter().any(|(now, before)| now.iter().zip(before).any(releases))
    }

    /// Returns the first ball whose rolling resistance is in Filippov mode, if any.
    pub(super) fn filippov_ball(&self) -> Option<usize> {
        self.roll.iter().position(|friction| *friction == Friction::Filippov)
    }

    /// Returns the friction of an unknown; `None` for a normal force.
    pub(super) const fn friction_mut(&mut self, kind: ForceKind) -> Option<&mut Friction> {
        match kind {
            ForceKind::Normal(_) => None,
            ForceKind::Cloth(ball) => Some(&mut self.cloth[ball]),
            ForceKind::Roll(ball) => Some(&mut self.roll[ball]),
            ForceKind::Spin(ball) => Some(&mut self.spin[ball]),
            ForceKind::Contact(index) => Some(&mut self.contact[index]),
        }
    }

    /// Whether any friction yields.
    pub fn yields(&self) -> bool {
        self.cloth.iter().chain(&self.roll).chain(&self.contact).any(|friction| *friction == Friction::Yields)
    }
}
