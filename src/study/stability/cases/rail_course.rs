//! The course of a ball pressed on a cushion without friction, from two integrals: implemented independently of the engine.
//!
//! With only the cloth's friction and the cushion's normal force, the slip along the cushion decreases at `7/2 μ g û_t` and the
//! slip across it at `5/2 μ g û_n`. So `u_n = c |u_t|^(5/7)`, both end together, and the time is an integral over `u_t`. The
//! speed along the cushion follows from the slip: `v_t = v_t0 + 2/7 (u_t - u_t0)`.

use glam::DVec2;

use crate::{
    simulation::{Event, EventKind, Rail},
    study::stability::{Shot, Trace},
    table::Table,
};

/// Accepted error of the engine's resting contacts, s and m.
const ALLOWED: f64 = 1e-9;

/// Remaining distance, m, below which the engine may stop a ball in the contact although it still slips: twice its own limit
/// (`Tolerance::still`).
const NEGLIGIBLE_DISTANCE: f64 = 2e-11;

/// Number of intervals of Simpson's rule: the integrands are smooth, and doubling the number changes less than 1e-14.
const INTERVALS: u32 = 2000;

/// Checks that a ball that is pressed on its first cushion, and meets nothing else, stops where and when the integrals predict;
/// other shots pass.
pub fn follows_quadrature(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let from = shot.layout.balls[0];
    let (v, w) = (trace.impulse.velocity, trace.impulse.spin);
    let Some(n) = cushion(table, from).filter(|n| v.dot(*n) < 0.0) else { return Ok(()) };
    let t = n.perp();
    // The impact without restitution leaves only the speed along the cushion.
    let slip = DVec2::new(-table.radius * w.y, table.radius * w.x) + v.dot(t) * t;
    let (across, along) = (slip.dot(n), slip.dot(t));
    let meets_more = |e: &Event| {
        e.kind.balls().1.is_some()
            || matches!(e.kind, EventKind::BallRail(_, rail) if rail.normal() != n)
            || e.kind.balls().0 != 0
    };
    // A slip towards the cushion drives the ball away from it; a slip only along it does not press.
    if across <= 1e-3 || along.abs() <= 1e-3 || trace.events.iter().any(meets_more) {
        return Ok(());
    }
    let friction = table.sliding_friction * table.gravity;
    // With u_t = along y⁷ and k = across/along: dt = 2/(7μg) √(1 + (u_n/u_t)²) du_t = 2|along|/(μg) y⁴ √(y⁴ + k²) dy.
    let k = across / along;
    let weight = |y: f64| y.powi(4) * (y.powi(4) + k * k).sqrt();
    let time = 2.0 * along.abs() / friction * simpson(weight);
    let slid = 2.0 * along.abs() / friction * along * simpson(|y| y.powi(7) * weight(y));
    let end = v.dot(t) - 2.0 / 7.0 * along;
    let deceleration = 5.0 / 7.0 * table.rolling_friction * table.gravity;
    let distance_left = end * end.abs() / (2.0 * deceleration);
    let place = from.dot(t) + end * time + 2.0 / 7.0 * slid + distance_left;
    let off = (trace.end.balls[0].position.dot(t) - place).abs();
    let late = (trace.end.time - (time + end.abs() / deceleration)).abs();
    // A ball that rolls at almost zero speed takes very long to stop, so the time is less certain than the position.
    let stopped =
        if distance_left.abs() < NEGLIGIBLE_DISTANCE { (2.0 * NEGLIGIBLE_DISTANCE / deceleration).sqrt() } else { 0.0 };
    if off > ALLOWED || late > ALLOWED * (1.0 + 1.0 / deceleration) + stopped {
        return Err(format!("pressed on a smooth cushion for {time} s, it stops {off:e} m and {late:e} s off"));
    }
    Ok(())
}

/// Returns the normal of the cushion that a ball touches.
fn cushion(table: &Table, place: DVec2) -> Option<DVec2> {
    Rail::ALL.into_iter().find(|rail| rail.gap(table.reach(), place) == 0.0).map(Rail::normal)
}

/// Returns the integral from 0 to 1.
fn simpson(f: impl Fn(f64) -> f64) -> f64 {
    let h = 1.0 / f64::from(INTERVALS);
    let inner: f64 = (1..INTERVALS).map(|i| f(f64::from(i) * h) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
    h / 3.0 * (f(0.0) + inner + f(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{physics::CueDegrees, table::Layout};

    #[test]
    fn very_slow_ball_may_stop_when_its_slip_ends() {
        let mut table = Table::preset("textbook").unwrap();
        (table.rail_friction, table.rail_restitution) = (0.0, 0.0);
        let from = DVec2::new(-1.389_249_999_999_999_9, 0.103_462_840_455_506_34);
        let layout = Layout::new([from, DVec2::new(1.250_325, 0.0), DVec2::new(1.250_325, 0.123)]);
        // The ball reaches 5e-7 m/s along the cushion, and would roll on for 1.8e-12 m, in 7 µs.
        let cue = CueDegrees {
            a: 0.074_935_402_441_466_46,
            b: 0.683_397_420_328_201_2,
            theta_deg: 20.0,
            phi_deg: 178.899_194_767_320_98,
            speed: 0.101_524_723_760_162_82,
        };
        let shot = Shot { layout, cue };
        let mut trace = Trace::of(&table, &shot);
        assert_eq!(follows_quadrature(&table, &shot, &trace), Ok(()));
        // A much earlier stop is detected.
        trace.end.time -= 1e-4;
        assert!(follows_quadrature(&table, &shot, &trace).is_err());
    }
}
