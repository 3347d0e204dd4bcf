//! A contact of two balls, or of a ball and a cushion: its geometry, its speeds and its laws.

use super::{Ball, Motion, Numbers, Real, Vector, table::normal};
use crate::{
    simulation::{EventKind, Rail},
    table::{BALLS, PAIRS},
};

/// All balls at one moment.
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
    /// Every ball with every cushion, then all pairs of balls.
    pub fn all() -> impl Iterator<Item = Self> {
        let rails = (0..BALLS).flat_map(|ball| Rail::ALL.into_iter().map(move |rail| Self::Rail(ball, rail)));
        rails.chain(PAIRS.into_iter().map(|(first, second)| Self::Balls(first, second)))
    }

    /// The ball towards which the normal points, and the other one.
    pub fn balls(self) -> (usize, Option<usize>) {
        match self {
            Self::Balls(first, second) => (first, Some(second)),
            Self::Rail(ball, _) => (ball, None),
        }
    }

    /// Whether `ball` takes part.
    pub fn has(self, ball: usize) -> bool {
        let (first, second) = self.balls();
        first == ball || second == Some(ball)
    }

    /// Whether a ball takes part in both.
    pub fn shares_a_ball(self, other: Self) -> bool {
        (0..BALLS).any(|ball| self.has(ball) && other.has(ball))
    }

    /// Whether a ball takes part that is not on the cloth.
    pub fn is_aloft<R: Real>(self, balls: &Balls<R>) -> bool {
        let (first, second) = self.balls();
        let is_off = |ball: usize| matches!(balls[ball].motion, Motion::Flying | Motion::OffTable);
        is_off(first) || second.is_some_and(is_off)
    }

    /// Whether all of its balls are among these.
    pub fn is_among(self, balls: [bool; BALLS]) -> bool {
        (0..BALLS).all(|ball| balls[ball] || !self.has(ball))
    }

    /// The contact of an impact, if this is one.
    pub fn of_event(kind: EventKind) -> Option<Self> {
        match kind {
            EventKind::BallBall(first, second) => Some(Self::Balls(first, second)),
            EventKind::BallRail(ball, rail) => Some(Self::Rail(ball, rail)),
            _ => None,
        }
    }

    /// The event of an impact.
    pub fn event(self) -> EventKind {
        match self {
            Self::Balls(first, second) => EventKind::BallBall(first, second),
            Self::Rail(ball, rail) => EventKind::BallRail(ball, rail),
        }
    }

    /// Restitution of a slow impact.
    pub fn restitution<R: Real>(self, numbers: &Numbers<R>) -> R {
        match self {
            Self::Balls(..) => numbers.ball_restitution,
            Self::Rail(_, rail) => numbers.cushion(rail).restitution,
        }
    }

    /// Coulomb's coefficient at rest; `None` where nothing slips.
    pub fn friction<R: Real>(self, numbers: &Numbers<R>) -> Option<R> {
        match self {
            Self::Balls(..) => numbers.ball_friction,
            Self::Rail(_, rail) => Some(numbers.cushion(rail).friction),
        }
    }

    /// Unit vector towards the first ball.
    pub fn normal<R: Real>(self, balls: &Balls<R>) -> Vector<R> {
        match self {
            Self::Balls(first, second) => (balls[first].position - balls[second].position).direction(),
            Self::Rail(_, rail) => normal(rail),
        }
    }

    /// Distance of the two surfaces, m.
    pub fn gap<R: Real>(self, numbers: &Numbers<R>, balls: &Balls<R>) -> R {
        match self {
            Self::Balls(first, second) => {
                let (apart, diameter) = (balls[first].position - balls[second].position, R::of(2.0) * numbers.radius);
                // The difference of the squares keeps the digits that the root would round.
                (apart.dot(apart) - diameter * diameter) / (apart.length() + diameter)
            }
            Self::Rail(ball, rail) => numbers.reach(rail) + balls[ball].position.dot(normal(rail)),
        }
    }

    /// Velocity of the first ball as seen from the other body, m/s.
    pub fn relative<R: Real>(self, balls: &Balls<R>) -> Vector<R> {
        let (first, second) = self.balls();
        second.map_or(balls[first].velocity, |second| balls[first].velocity - balls[second].velocity)
    }

    /// Rate at which the gap opens, m/s.
    pub fn opening<R: Real>(self, balls: &Balls<R>) -> R {
        self.relative(balls).dot(self.normal(balls))
    }

    /// Sum of the spins, which turns both surfaces the same way, rad/s.
    pub fn spin<R: Real>(self, balls: &Balls<R>) -> Vector<R> {
        let (first, second) = self.balls();
        second.map_or(balls[first].spin, |second| balls[first].spin + balls[second].spin)
    }

    /// Slip of the two surfaces (thesis equation 21), m/s.
    pub fn slip<R: Real>(self, numbers: &Numbers<R>, balls: &Balls<R>) -> Vector<R> {
        let (n, relative) = (self.normal(balls), self.relative(balls));
        relative - n * relative.dot(n) + n.cross(self.spin(balls)) * numbers.radius
    }

    /// Shifts the balls by what rounding has left of the gap, each of two by half.
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
