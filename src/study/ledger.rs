//! Keeps account of the energy while another engine plays: what friction and impacts take, by the plain engine's
//! formulas, against what is gone.

use std::ops::ControlFlow;

use super::{
    plain::{Ball, Motion, Numbers, Vector, balls_collide, rail_collides, rail_normal},
    shots::StudyShot,
};
use crate::{
    physics::{self, BallState},
    simulation::{Constants, End, Event, EventKind, Observer, Segment},
    table::{BALLS, Table},
};

/// The account of one shot. Energies are over the ball's mass.
#[derive(Clone, Debug)]
pub struct Ledger {
    numbers: Numbers<f64>,
    constants: Constants,
    start: f64,
    work: f64,
    /// The balls at the end of their last segment: just before the event that ends it.
    balls: [Ball<f64>; BALLS],
    /// Whether a resting contact has come, whose friction is not accounted for.
    rested: bool,
}

impl Ledger {
    /// An account that starts with the stroke.
    pub fn new(table: &Table, shot: &StudyShot) -> Self {
        let (numbers, constants) = (Numbers::of(table), Constants::of(table));
        let state = |index: usize| {
            let state = BallState::at_rest(shot.layout.balls[index]);
            if index > 0 {
                return state;
            }
            BallState { velocity: shot.impulse.velocity, spin: shot.impulse.spin, ..state }
        };
        let balls = std::array::from_fn(|index| plain_ball(&state(index), physics::Motion::Stationary));
        let start = balls.iter().map(|ball| ball.energy(&numbers)).sum();
        Self { numbers, constants, start, work: 0.0, balls, rested: false }
    }

    /// The share of the initial energy that is neither left nor accounted for.
    pub fn unaccounted(&self, end: &End) -> Option<f64> {
        let left: f64 =
            end.balls.iter().map(|state| plain_ball(state, physics::Motion::Stationary).energy(&self.numbers)).sum();
        (!self.rested).then(|| ((self.start - left - self.work) / self.start).abs())
    }
}

impl Observer for Ledger {
    const SEGMENTS: bool = true;

    fn event(&mut self, event: Event) -> ControlFlow<()> {
        match event.kind {
            EventKind::BallBall(first, second) => {
                let (mut a, mut b) = (self.balls[first], self.balls[second]);
                self.work += balls_collide(&self.numbers, self.numbers.ball_restitution, &mut a, &mut b);
            }
            EventKind::BallRail(index, rail) => {
                let (n, mut ball) = (rail_normal(rail), self.balls[index]);
                self.work += rail_collides(&self.numbers, self.numbers.rail_restitution, n, &mut ball);
            }
            EventKind::ContactBegins(_) => self.rested = true,
            _ => {}
        }
        ControlFlow::Continue(())
    }

    fn segment(&mut self, ball: usize, segment: &Segment, end: f64) {
        let lasted = end - segment.start;
        let state = BallState { position: segment.position, velocity: segment.velocity, spin: segment.spin };
        self.work += plain_ball(&state, segment.motion).after(&self.numbers, lasted).1;
        self.balls[ball] = plain_ball(&segment.state_after(&self.constants, lasted), segment.motion);
    }
}

fn plain_ball(state: &BallState, motion: physics::Motion) -> Ball<f64> {
    let motion = match motion {
        physics::Motion::Sliding => Motion::Sliding,
        physics::Motion::Rolling => Motion::Rolling,
        physics::Motion::Stationary | physics::Motion::Resting => Motion::Stationary,
    };
    Ball {
        position: Vector::new(state.position.x, state.position.y, 0.0),
        velocity: Vector::new(state.velocity.x, state.velocity.y, 0.0),
        spin: Vector::new(state.spin.x, state.spin.y, state.spin.z),
        motion,
    }
}
