//! Energy never grows: not at an event, and not on the way to the next.

use crate::{physics::BallState, table::BALLS, table::Table};

use super::{figures::Figures, trace::Trace};
use crate::physics::Motion;

/// Rounding of an energy is at most this share of the largest that entered it: some thirty operations on the way from the
/// state at a piece's start through its end to the next one's, half an ε each.
const SHARE: f64 = 32.0 * f64::EPSILON;

/// Speed to which the states of resting contacts are right, m/s: it moves a ball by 1e-9 m in ten seconds. What sticks is
/// only known to slip by less than that.
const RESTING_SPEED: f64 = 1e-10;

/// What one ball's energy may be wrong by.
struct Doubt {
    energy: f64,
    time: f64,
    power: f64,
    rests: bool,
}

impl Doubt {
    /// m²/s².
    fn allowed(&self) -> f64 {
        let resting = if self.rests { RESTING_SPEED * (2.0 * self.energy).sqrt() } else { 0.0 };
        // A time is rounded, and meanwhile friction works.
        SHARE * self.energy + f64::EPSILON * self.time * self.power + resting
    }
}

/// Measures gains in units of what rounding explains.
pub fn measure(table: &Table, trace: &Trace, figures: &mut Figures) {
    let radius = table.radius;
    let energy = |state: &BallState| state.specific_energy(radius);
    // |u| and R|w| are both at most 4 √E, and every friction's power is its coefficient times g times one of them.
    let coefficient =
        table.sliding_friction + table.rolling_friction + table.spinning_friction + 2.0 * table.rail_friction;
    let power = |e: f64| 4.0 * coefficient * table.gravity * e.sqrt();
    let mut cue_ball = BallState::at_rest(trace.end.balls[0].position);
    (cue_ball.velocity, cue_ball.spin) = (trace.impulse.velocity, trace.impulse.spin);
    // Energy at the end of each ball's last piece, and the largest in it.
    let mut before = [0.0; BALLS];
    before[0] = energy(&cue_ball);
    let mut largest = before;
    let mut rested = [false; BALLS];
    let mut cursor = [0; BALLS];
    loop {
        let starts = (0..BALLS).filter_map(|ball| Some(trace.pieces[ball].get(cursor[ball])?.segment.start));
        let now = starts.fold(f64::INFINITY, f64::min);
        if now == f64::INFINITY || now >= trace.kept_until {
            break;
        }
        let (mut gained_at, mut gained_after, mut involved) = (0.0, 0.0, 0.0);
        let mut rests = false;
        for ball in 0..BALLS {
            let Some(piece) = trace.pieces[ball].get(cursor[ball]) else { continue };
            let segment = &piece.segment;
            if segment.start != now {
                continue;
            }
            cursor[ball] += 1;
            let first = energy(&segment.state_after(&trace.constants, 0.0));
            let last = energy(&segment.state_after(&trace.constants, piece.end - segment.start));
            let is_resting = segment.motion == Motion::Resting;
            gained_at += first - before[ball];
            involved += largest[ball].max(first);
            rests |= is_resting || rested[ball];
            if is_resting {
                // Balls that press each other pass energy on: only their sum falls.
                gained_after += last - first;
            } else {
                let doubt = Doubt { energy: first, time: piece.end, power: power(first), rests: false };
                note(figures, last - first, &doubt);
            }
            (before[ball], largest[ball], rested[ball]) = (last, first.max(last), is_resting);
        }
        let doubt = Doubt { energy: involved, time: now, power: power(3.0 * involved), rests };
        note(figures, gained_at, &doubt);
        note(figures, gained_after, &doubt);
    }
}

fn note(figures: &mut Figures, gained: f64, doubt: &Doubt) {
    figures.gained.note(gained, doubt.time);
    figures.energy.note(if gained > 0.0 { gained / doubt.allowed() } else { 0.0 }, doubt.time);
}
