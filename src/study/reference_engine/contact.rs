//! A contact between two balls, or between a ball and a cushion: its geometry, speeds and laws.

use super::{Ball, Motion, Numbers, Real, Vector, table::normal};
use crate::{
    simulation::{EventKind, Rail},
    table::{BALLS, PAIRS},
};

/// The states of all balls at one time.
pub type Balls<R> = [Ball<R>; BALLS];

/// Two bodies that can touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contact {
    /// Two balls.
    Balls(usize, usize),
    /// A ball and a cushion.
    Rail(usize, Rail),
}

impl Contact {
    /// Returns all contacts: every ball with every cushion, then all pairs of balls.
    pub fn all() -> impl Iterator<Item = Self> {
        let rails = (0..BALLS).flat_map(|ball| Rail::ALL.into_iter().map(move |rail| Self::Rail(ball, rail)));
        rails.chain(PAIRS.into_iter().map(|(first, second)| Self::Balls(first, second)))
    }

    /// Returns the ball towards which the normal points, and the other ball if there is one.
    pub fn balls(self) -> (usize, Option<usize>) {
        match self {
            Self::Balls(first, second) => (first, Some(second)),
            Self::Rail(ball, _) => (ball, None),
        }
    }

    /// Whether `ball` is part of the contact.
    pub fn involves(self, ball: usize) -> bool {
        let (first, second) = self.balls();
        first == ball || second == Some(ball)
    }

    /// Whether the two contacts have a ball in common.
    pub fn shares_a_ball(self, other: Self) -> bool {
        (0..BALLS).any(|ball| self.involves(ball) && other.involves(ball))
    }

    /// Whether any of its balls is not on the cloth.
    pub fn is_aloft<R: Real>(self, balls: &Balls<R>) -> bool {
        let (first, second) = self.balls();
        let is_off = |ball: usize| matches!(balls[ball].motion, Motion::Flying | Motion::OffTable);
        is_off(first) || second.is_some_and(is_off)
    }

    /// Whether all of its balls are among `balls`.
    pub fn is_among(self, balls: [bool; BALLS]) -> bool {
        (0..BALLS).all(|ball| balls[ball] || !self.involves(ball))
    }

    /// Returns the contact of an impact event, `None` for other events.
    pub fn of_event(kind: EventKind) -> Option<Self> {
        match kind {
            EventKind::BallBall(first, second) => Some(Self::Balls(first, second)),
            EventKind::BallRail(ball, rail) => Some(Self::Rail(ball, rail)),
            _ => None,
        }
    }

    /// Returns the event of an impact at this contact.
    pub fn event(self) -> EventKind {
        match self {
            Self::Balls(first, second) => EventKind::BallBall(first, second),
            Self::Rail(ball, rail) => EventKind::BallRail(ball, rail),
        }
    }

    /// Returns the restitution of slow impacts.
    pub fn restitution<R: Real>(self, numbers: &Numbers<R>) -> R {
        match self {
            Self::Balls(..) => numbers.ball_restitution,
            Self::Rail(_, rail) => numbers.cushion(rail).restitution,
        }
    }

    /// Returns Coulomb's coefficient at rest; `None` if the contact never slips.
    pub fn friction<R: Real>(self, numbers: &Numbers<R>) -> Option<R> {
        match self {
            Self::Balls(..) => numbers.ball_friction,
            Self::Rail(_, rail) => Some(numbers.cushion(rail).friction),
        }
    }

    /// Returns the unit normal, towards the first ball.
    pub fn normal<R: Real>(self, balls: &Balls<R>) -> Vector<R> {
        match self {
            Self::Balls(first, second) => (balls[first].position - balls[second].position).direction(),
            Self::Rail(_, rail) => normal(rail),
        }
    }

    /// Returns the distance of the two surfaces, m.
    pub fn gap<R: Real>(self, numbers: &Numbers<R>, balls: &Balls<R>) -> R {
        match self {
            Self::Balls(first, second) => {
                let (difference, diameter) =
                    (balls[first].position - balls[second].position, R::of(2.0) * numbers.radius);
                // The difference of squares keeps digits that the square root would round off.
                (difference.dot(difference) - diameter * diameter) / (difference.length() + diameter)
            }
            Self::Rail(ball, rail) => numbers.reach(rail) + balls[ball].position.dot(normal(rail)),
        }
    }

    /// Returns the velocity of the first ball relative to the other body, m/s.
    pub fn relative_velocity<R: Real>(self, balls: &Balls<R>) -> Vector<R> {
        let (first, second) = self.balls();
        second.map_or(balls[first].velocity, |second| balls[first].velocity - balls[second].velocity)
    }

    /// Returns the opening speed of the gap, m/s.
    pub fn opening_speed<R: Real>(self, balls: &Balls<R>) -> R {
        self.relative_velocity(balls).dot(self.normal(balls))
    }

    /// Returns the sum of the spins, which moves both surfaces the same way, rad/s.
    pub fn spin<R: Real>(self, balls: &Balls<R>) -> Vector<R> {
        let (first, second) = self.balls();
        second.map_or(balls[first].spin, |second| balls[first].spin + balls[second].spin)
    }

    /// Returns the slip velocity of the two surfaces (thesis equation 21), m/s.
    pub fn slip<R: Real>(self, numbers: &Numbers<R>, balls: &Balls<R>) -> Vector<R> {
        self.slip_across(numbers, self.normal(balls), balls)
    }

    /// Returns the slip velocity of the two surfaces for this unit normal towards the first ball, m/s.
    pub fn slip_across<R: Real>(self, numbers: &Numbers<R>, n: Vector<R>, balls: &Balls<R>) -> Vector<R> {
        let relative = self.relative_velocity(balls);
        relative - n * relative.dot(n) + n.cross(self.spin(balls)) * numbers.radius
    }

    /// Shifts the balls to close the remaining gap, which is rounding; each of two balls by half of it.
    pub fn close<R: Real>(self, numbers: &Numbers<R>, balls: &mut Balls<R>) {
        let shift = self.normal(balls) * self.gap(numbers, balls);
        match self {
            Self::Balls(first, second) => {
                let half = R::of(0.5);
                balls[first].position = balls[first].position - shift * half;
                balls[second].position = balls[second].position + shift * half;
            }
            Self::Rail(ball, _) => balls[ball].position = balls[ball].position - shift,
        }
    }
}
