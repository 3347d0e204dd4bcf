//! Which contacts push and which frictions hold: what is constant from one change of it to the next.

use std::ops::Deref;

use glam::DVec2;

use super::{
    Contact,
    problem::{Place, coefficient},
};
use crate::{
    physics::{BallState, slip},
    table::{BALLS, Table},
};

/// Most contacts that three balls can have: with each other and with two cushions each.
pub const MAX_CONTACTS: usize = 9;

/// Contacts in a fixed order.
#[derive(Clone, Copy, Debug)]
pub struct Contacts {
    list: [Contact; MAX_CONTACTS],
    count: usize,
}

impl Contacts {
    /// None at all.
    pub const NONE: Self = Self { list: [Contact::with_cushion(0, DVec2::ZERO); MAX_CONTACTS], count: 0 };

    /// Adds one, as long as there is room: three balls cannot have more.
    pub fn push(&mut self, contact: Contact) {
        if self.count < MAX_CONTACTS {
            self.list[self.count] = contact;
            self.count += 1;
        }
    }

    /// Keeps only the contacts asked for.
    pub fn retain(&mut self, mut wanted: impl FnMut(usize, &Contact) -> bool) {
        let before = self.count;
        self.count = 0;
        for index in 0..before {
            if wanted(index, &self.list[index]) {
                self.list[self.count] = self.list[index];
                self.count += 1;
            }
        }
    }

    /// Whether a ball takes part in any.
    pub fn hold(&self, ball: usize) -> bool {
        self.iter().any(|contact| contact.has(ball))
    }
}

impl Deref for Contacts {
    type Target = [Contact];

    fn deref(&self) -> &[Contact] {
        &self.list[..self.count]
    }
}

/// What a friction does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// It holds.
    Sticks,
    /// It is at its limit and lets a slip begin, so slowly that it acts against the rate of the slip rather than the slip
    /// itself, whose direction would turn in no time.
    Yields,
    /// It acts at its limit against the slip, to which this is added, m/s: what begins to slip has a direction before it
    /// has a speed. Of a spin it is the sign.
    Slips(DVec2),
    /// Of the resistance to rolling: as much of it acts as the cloth's friction can hold a ball against without letting it slide, and
    /// sliding would end at once, for a ball that slides has no such resistance (Filippov 1988).
    Eases,
}

impl Friction {
    /// Slipping already if faster than `none`, m/s.
    fn of(slip: DVec2, none: f64) -> Self {
        if slip.length() > none { Self::Slips(DVec2::ZERO) } else { Self::Sticks }
    }

    /// The unit vector against which the friction acts; `None` where it holds.
    pub(super) fn direction(self, slip: DVec2) -> Option<DVec2> {
        match self {
            Self::Sticks | Self::Yields => None,
            Self::Slips(start) => Some((slip + start).normalize_or_zero()),
            Self::Eases => Some(slip.normalize_or_zero()),
        }
    }

    /// Whether it lets a slip begin.
    pub(super) fn begins(self) -> bool {
        !matches!(self, Self::Sticks | Self::Eases | Self::Slips(DVec2::ZERO))
    }
}

/// What every friction does in one active set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveSet {
    /// The cloth's friction on each ball against slipping.
    pub cloth: [Friction; BALLS],
    /// The cloth's resistance against each ball's rolling; it counts where the ball does not slip.
    pub roll: [Friction; BALLS],
    /// The cloth's friction against each ball's spin about the vertical.
    pub spin: [Friction; BALLS],
    /// The friction in each contact.
    pub contact: [Friction; MAX_CONTACTS],
}

impl ActiveSet {
    /// Everything slips, where it does in no known direction.
    pub const SLIPPING: Self = Self {
        cloth: [Friction::Slips(DVec2::ZERO); BALLS],
        roll: [Friction::Slips(DVec2::ZERO); BALLS],
        spin: [Friction::Slips(DVec2::ZERO); BALLS],
        contact: [Friction::Slips(DVec2::ZERO); MAX_CONTACTS],
    };

    /// What the state `balls` shows, if slips and speeds below `none`, m/s, are zero. Balls without a coefficient of
    /// friction yield where they slip.
    pub fn of(table: &Table, balls: &[BallState; BALLS], contacts: &[Contact], none: f64) -> Self {
        let radius = table.radius;
        let mut friction = [Friction::Sticks; MAX_CONTACTS];
        for (friction, contact) in friction.iter_mut().zip(contacts) {
            // What has no friction cannot stick.
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

    /// The same with slips where this set or the `other` yields: nothing there is to stop.
    #[must_use]
    pub fn slipping_where(mut self, yields: &Self) -> Self {
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

    /// Whether nothing begins to slip: no friction yields, and no slip has only a direction.
    pub fn lasts(&self) -> bool {
        !self.cloth.iter().chain(&self.roll).chain(&self.contact).any(|friction| friction.begins())
    }

    /// Whether a ball slips, rolls or spins that by another set is held.
    pub fn lets_go(&self, held: &Self) -> bool {
        let pairs = [(&self.cloth, &held.cloth), (&self.roll, &held.roll), (&self.spin, &held.spin)];
        let lets_go = |(now, before): (&Friction, &Friction)| *before == Friction::Sticks && *now != Friction::Sticks;
        pairs.into_iter().any(|(now, before)| now.iter().zip(before).any(lets_go))
    }

    /// The first ball whose resistance to rolling eases, if there is one.
    pub(super) fn eased(&self) -> Option<usize> {
        self.roll.iter().position(|friction| *friction == Friction::Eases)
    }

    /// The friction of a place; none where the place is that of a normal force.
    pub(super) const fn friction_mut(&mut self, place: Place) -> Option<&mut Friction> {
        match place {
            Place::Normal(_) => None,
            Place::Cloth(ball) => Some(&mut self.cloth[ball]),
            Place::Roll(ball) => Some(&mut self.roll[ball]),
            Place::Spin(ball) => Some(&mut self.spin[ball]),
            Place::Contact(index) => Some(&mut self.contact[index]),
        }
    }

    /// Whether any friction yields.
    pub fn yields(&self) -> bool {
        self.cloth.iter().chain(&self.roll).chain(&self.contact).any(|friction| *friction == Friction::Yields)
    }
}
