//! From event to event: all balls are moved to each event, and everything is predicted anew behind it.

use super::{
    Ball, Finder, Motion, Numbers, Real, Vector,
    course::{Course, press},
    impact::{balls_collide, rail_collides},
    meeting::{Meeting, balls_meet, rail_met},
    press::Press,
    table::normal,
};
use crate::{
    simulation::{EventKind, Rail},
    table::BALLS,
};

/// More events than any shot has whose balls come to rest.
const MOST_EVENTS: usize = 20_000;

/// Pairs of balls.
const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// What became of a shot.
#[derive(Clone, Debug)]
pub struct Shot<R> {
    /// The events and their times, s.
    pub events: Vec<(R, EventKind)>,
    /// The balls at rest.
    pub end: [Ball<R>; BALLS],
    /// Time of the last event, s.
    pub duration: R,
    /// Whether a ball was pressed against a cushion.
    pub pressed: bool,
    /// Kinetic energy over mass at the start, and the part of it for which friction and impacts do not account.
    pub energy: [R; 2],
}

/// Why a shot cannot be judged by this engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unjudged {
    /// Friction presses two balls together.
    #[error("two balls rest against each other while they move")]
    BallsPressed,
    /// The cloth presses a ball into a corner.
    #[error("a ball rests against two cushions while it moves")]
    Corner,
    /// The events do not end.
    #[error("more than {MOST_EVENTS} events")]
    Endless,
}

/// What comes next.
#[derive(Clone, Copy)]
enum Next {
    MotionEnds(usize),
    Rail(usize, Rail),
    Balls(usize, usize),
}

/// Plays a shot: ball 0 starts with the given velocity and spin.
///
/// # Errors
/// [`Unjudged`], where the shot has a resting contact that this engine has no equations for.
pub fn play<R: Real>(
    numbers: &Numbers<R>,
    positions: [Vector<R>; BALLS],
    velocity: Vector<R>,
    spin: Vector<R>,
    finder: Finder<R>,
) -> Result<Shot<R>, Unjudged> {
    let still =
        |position| Ball { position, velocity: Vector::zero(), spin: Vector::zero(), motion: Motion::Stationary };
    let mut balls = positions.map(still);
    (balls[0].velocity, balls[0].spin) = (velocity, spin);
    balls[0].set_off(numbers);
    let energy_of = |balls: &[Ball<R>; BALLS]| balls.iter().fold(R::zero(), |sum, ball| sum + ball.energy(numbers));
    let energy = energy_of(&balls);
    let (mut events, mut now, mut pressed, mut work) = (Vec::new(), R::zero(), false, R::zero());
    loop {
        for ball in &mut balls {
            press(numbers, ball)?;
            pressed |= matches!(ball.motion, Motion::Pressed(_));
        }
        let courses = balls.map(|ball| Course::new(numbers, ball));
        let Some((time, next)) = predict(numbers, &courses, finder)? else { break };
        now = now + time;
        for (ball, course) in balls.iter_mut().zip(&courses) {
            let (moved, lost) = course.after(numbers, time);
            (*ball, work) = (moved, work + lost);
        }
        work = work + happen(numbers, &mut balls, next, |kind| events.push((now, kind)));
        if events.len() > MOST_EVENTS {
            return Err(Unjudged::Endless);
        }
    }
    let duration = events.last().map_or(R::zero(), |event| event.0);
    let unaccounted = energy - energy_of(&balls) - work;
    Ok(Shot { events, end: balls, duration, pressed, energy: [energy, unaccounted] })
}

/// The next event and the time to it.
fn predict<R: Real>(
    numbers: &Numbers<R>,
    courses: &[Course<R>; BALLS],
    finder: Finder<R>,
) -> Result<Option<(R, Next)>, Unjudged> {
    let mut first: Option<(R, Next)> = None;
    let mut offer = |time: R, next| {
        if first.is_none_or(|(earliest, _)| time < earliest) {
            first = Some((time, next));
        }
    };
    for (index, course) in courses.iter().enumerate() {
        if let Some(time) = course.lasts(numbers) {
            offer(time, Next::MotionEnds(index));
            for rail in Rail::ALL {
                if let Some(time) = rail_met(numbers, course, rail, time) {
                    offer(time, Next::Rail(index, rail));
                }
            }
        }
    }
    let Some((horizon, _)) = first else { return Ok(None) };
    for (one, other) in PAIRS {
        match balls_meet(numbers, &courses[one], &courses[other], horizon, finder) {
            Meeting::Never => {}
            Meeting::After(time) => {
                if first.is_none_or(|(earliest, _)| time < earliest) {
                    first = Some((time, Next::Balls(one, other)));
                }
            }
            Meeting::Pressed => return Err(Unjudged::BallsPressed),
        }
    }
    Ok(first)
}

/// Lets it happen, and returns the energy over mass that it takes.
fn happen<R: Real>(
    numbers: &Numbers<R>,
    balls: &mut [Ball<R>; BALLS],
    next: Next,
    mut tell: impl FnMut(EventKind),
) -> R {
    match next {
        Next::MotionEnds(index) => {
            let ball = &mut balls[index];
            if let Motion::Pressed(rail) = ball.motion {
                Press::settle(numbers, ball, rail);
            } else {
                let ended = ball.motion;
                ball.motion = ended.successor(ball, numbers);
                let rolled = ended == Motion::Rolling;
                tell(if rolled { EventKind::RollingStationary(index) } else { EventKind::SlidingRolling(index) });
            }
            R::zero()
        }
        Next::Rail(index, rail) => {
            tell(EventKind::BallRail(index, rail));
            let (n, before) = (normal(rail), balls[index]);
            let ball = &mut balls[index];
            // Exactly at the cushion, so that the next gap starts at zero.
            ball.position = ball.position - n * (numbers.reach(rail) + ball.position.dot(n));
            let mut work = rail_collides(numbers, numbers.rail_restitution, n, ball);
            if ball.velocity.dot(n) <= Numbers::settled() {
                (ball.velocity, ball.spin) = (before.velocity, before.spin);
                work = rail_collides(numbers, R::zero(), n, ball);
            }
            ball.set_off(numbers);
            work
        }
        Next::Balls(one, other) => {
            tell(EventKind::BallBall(one, other));
            let [mut first, mut second] = [balls[one], balls[other]];
            let work = balls_collide(numbers, numbers.ball_restitution, &mut first, &mut second);
            first.set_off(numbers);
            second.set_off(numbers);
            (balls[one], balls[other]) = (first, second);
            work
        }
    }
}
