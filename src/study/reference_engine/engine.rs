//! The event loop: all balls are moved to each event, and everything is predicted again after it.

use super::{
    Ball, Finder, Motion, Numbers, Real, Vector,
    contact::Contact,
    course::Course,
    flight,
    meeting::{meets, touch},
    moment::process_moment,
    piece::Piece,
    rounds::collide_all_aloft,
};
use crate::{
    simulation::{EventKind, Rail},
    table::{BALLS, Layout, Table},
};

/// Returns the number of steps after which the engine gives up a shot. With 32 digits, no shot whose balls come to rest needs
/// as many. With 16 or 8 digits, balls that press each other may separate and meet again forever.
fn max_steps<R: Real>() -> usize {
    if R::ROUNDING < 1e-20 { 200_000 } else { 5_000 }
}

/// After this many slow pieces in a row, slow slips are treated as creeping.
const MAX_SLOW_PIECES: usize = 300;

/// The course and result of a shot.
#[derive(Clone, Debug)]
pub struct Shot<R> {
    /// The events and their times, s.
    pub events: Vec<(R, EventKind)>,
    /// Final states of the balls.
    pub end: [Ball<R>; BALLS],
    /// Whether a moving ball was pressed against a cushion or another ball.
    pub pressed: bool,
    /// Whether a ball in the air hit something so slowly that it may have slid off in bounces.
    pub slides: bool,
    /// Kinetic and potential energy per mass at the start, and the part of it that friction and impacts do not explain.
    pub energy: [R; 2],
}

impl<R: Real> Shot<R> {
    /// Returns the final positions, rounded; a ball that left the table is on its spot.
    pub fn layout(&self, table: &Table) -> Layout {
        let places = self.end.map(|ball| ball.position.to_f64().truncate());
        let off_table = self.end.map(|ball| ball.motion == Motion::OffTable);
        Layout::new(places).with_spotted(table.length, table.radius, off_table)
    }
}

/// Why this engine cannot judge a shot: the table has a law that it does not implement, or the equations are not solved. In
/// double-double no shot is known for which the latter is true.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unjudged {
    /// The solver found no forces that obey all laws of resting contact.
    #[error("no forces are found that obey all laws of resting contact")]
    Unsolved,
    /// A cushion's impacts are integrated over the impulse, which this engine does not implement.
    #[error("the model of the table's rails is integrated over the impulse, which the reference engine does not do")]
    IntegratedRail,
    /// The table is not level.
    #[error("the table is not level, and the reference engine has no model of a slope")]
    Slope,
    /// The shot takes too many steps from event to event.
    #[error("more than {0} steps from event to event")]
    Endless(usize),
}

/// The next event.
#[derive(Clone, Copy)]
enum Next {
    MotionEnds(usize),
    Leaves(usize),
    PieceEnds,
    Meets(Contact),
}

/// Plays a shot: ball 0 starts with the given velocity and spin.
///
/// # Errors
/// [`Unjudged`] if the table has other laws, or the equations are not solved.
pub fn play<R: Real>(
    numbers: &Numbers<R>,
    positions: [Vector<R>; BALLS],
    velocity: Vector<R>,
    spin: Vector<R>,
    finder: Finder<R>,
) -> Result<Shot<R>, Unjudged> {
    numbers.check_supported()?;
    let mut balls = positions.map(Ball::at_rest);
    (balls[0].velocity, balls[0].spin) = (velocity, spin);
    flight::settle(numbers, &mut balls[0]);
    let energy_of = |balls: &[Ball<R>; BALLS]| balls.iter().fold(R::zero(), |sum, ball| sum + ball.energy(numbers));
    let energy = energy_of(&balls);
    let (mut events, mut now, mut pressed, mut work) = (Vec::new(), R::zero(), false, R::zero());
    let mut slides = false;
    if balls[0].motion == Motion::Flying {
        events.push((now, EventKind::Jumps(0)));
    }
    let (mut resting, mut stride, mut slow) = ([false; BALLS], 1.0, 0);
    for _ in 0..max_steps::<R>() {
        let moment = process_moment(numbers, &mut balls, resting, slow > MAX_SLOW_PIECES)?;
        events.extend(moment.events.into_iter().map(|kind| (now, kind)));
        work = work + moment.work;
        let piece = moment.rest.map(|rest| Piece::new(numbers, &balls, rest, stride));
        pressed |= piece.is_some();
        stride = piece.as_ref().map_or(1.0, |piece| piece.stride);
        slow = if piece.as_ref().is_some_and(Piece::is_slow) { slow + 1 } else { 0 };
        resting = std::array::from_fn(|ball| piece.as_ref().is_some_and(|piece| piece.involves(ball)));
        for (ball, pressed) in balls.iter_mut().zip(resting) {
            ball.choose_band(numbers, pressed);
        }
        let course = Course { numbers: *numbers, balls, piece };
        let Some((time, next)) = predict(&course, finder) else {
            let unaccounted = energy - energy_of(&balls) - work;
            return Ok(Shot { events, end: balls, pressed, slides, energy: [energy, unaccounted] });
        };
        now = now + time;
        let (moved, lost) = course.after(time);
        (balls, work) = (moved, work + lost);
        match next {
            Next::MotionEnds(index) if balls[index].rolls_on() => balls[index].band = None,
            Next::MotionEnds(index) if balls[index].motion == Motion::Flying => {
                let (told, lost) = flight::land(numbers, index, &mut balls[index]);
                events.extend(told.into_iter().map(|kind| (now, kind)));
                work = work + lost;
            }
            Next::MotionEnds(index) => {
                let ball = &mut balls[index];
                let ended = ball.motion;
                ball.motion = ended.successor(ball, numbers);
                let rolled = ended == Motion::Rolling;
                let kind = if rolled { EventKind::RollingStationary(index) } else { EventKind::SlidingRolling(index) };
                events.push((now, kind));
            }
            Next::PieceEnds => {}
            Next::Leaves(index) => {
                work = work + flight::leave(numbers, &mut balls[index]);
                events.push((now, EventKind::LeavesTable(index)));
            }
            Next::Meets(contact) if contact.is_aloft(&balls) => {
                let met = collide_all_aloft(numbers, contact, &mut balls)?;
                events.extend(met.events.into_iter().map(|kind| (now, kind)));
                (work, slides) = (work + met.work, slides || met.is_slow);
            }
            Next::Meets(contact) => touch(numbers, contact, &mut balls),
        }
    }
    Err(Unjudged::Endless(max_steps::<R>()))
}

/// Returns the next event and the time until it.
fn predict<R: Real>(course: &Course<R>, finder: Finder<R>) -> Option<(R, Next)> {
    let piece = course.piece.iter().map(|piece| (piece.duration(), Next::PieceEnds));
    let motions = course.free_motions().map(|(ball, time)| (time, Next::MotionEnds(ball)));
    let ends = piece.chain(motions).reduce(|first, other| if other.0 < first.0 { other } else { first });
    let mut first = ends?;
    for contact in Contact::all() {
        if let Some(time) = meets(course, contact, first.0, finder)
            && time < first.0
        {
            first = (time, Next::Meets(contact));
        }
    }
    for (ball, rail) in (0..BALLS).flat_map(|ball| Rail::ALL.map(|rail| (ball, rail))) {
        if let Some(time) = flight::leaves(&course.numbers, &course.balls[ball], rail)
            && time < first.0
        {
            first = (time, Next::Leaves(ball));
        }
    }
    Some(first)
}
