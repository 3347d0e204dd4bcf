//! How a ball goes on until something happens to it, free or pressed against a cushion.

use super::{Ball, Motion, Numbers, Real, engine::Unjudged, press::Press, table::normal};
use crate::simulation::Rail;

/// A ball and, where it is pressed, the piece of its course that comes next.
#[derive(Clone, Copy)]
pub struct Course<R> {
    /// The ball now.
    pub ball: Ball<R>,
    /// Where it is pressed, the piece.
    pub press: Option<Press<R>>,
}

impl<R: Real> Course<R> {
    /// The course of `ball` from now on.
    pub fn new(numbers: &Numbers<R>, ball: Ball<R>) -> Self {
        let press = match ball.motion {
            Motion::Pressed(rail) => Some(Press::new(numbers, &ball, rail)),
            _ => None,
        };
        Self { ball, press }
    }

    /// How long its present motion, or its present piece, lasts.
    pub fn lasts(&self, numbers: &Numbers<R>) -> Option<R> {
        self.press.map_or_else(|| self.ball.lasts(numbers), |press| Some(press.lasts()))
    }

    /// The ball `time` later and the friction's work over mass.
    pub fn after(&self, numbers: &Numbers<R>, time: R) -> (Ball<R>, R) {
        self.press.map_or_else(|| self.ball.after(numbers, time), |press| press.after(time))
    }
}

/// Makes a ball rest against a cushion that it touches and that the cloth presses it on.
///
/// # Errors
/// [`Unjudged::Corner`] where there are two.
pub fn press<R: Real>(numbers: &Numbers<R>, ball: &mut Ball<R>) -> Result<(), Unjudged> {
    if ball.motion != Motion::Sliding {
        return Ok(());
    }
    let (pull, Ball { position, velocity, .. }) = (ball.acceleration(numbers), *ball);
    let holds = |rail: &Rail| {
        let n = normal(*rail);
        let speed = velocity.dot(n);
        numbers.reach(*rail) + position.dot(n) <= Numbers::touching()
            && speed.abs() <= Numbers::settled()
            && pull.dot(n) < R::zero()
    };
    let mut rails = Rail::ALL.into_iter().filter(holds);
    let Some(rail) = rails.next() else { return Ok(()) };
    let n = normal(rail);
    ball.velocity = ball.velocity - n * ball.velocity.dot(n);
    ball.motion = Motion::Pressed(rail);
    if rails.next().is_some() { Err(Unjudged::Corner) } else { Ok(()) }
}
