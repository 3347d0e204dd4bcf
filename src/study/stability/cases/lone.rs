//! A ball without impacts, in closed form: implemented independently of the engine, directly from thesis equations (25) and
//! (26).

use glam::DVec2;

use crate::{
    study::stability::{Shot, Trace},
    table::Table,
};

/// Rounding of a position on the table, in ε: some ten operations for sliding and rolling each.
const OPERATIONS: f64 = 64.0;

/// Checks that a cue ball without impacts stops where the closed form predicts, to rounding; other shots pass.
pub fn stops_where_the_closed_form_says(table: &Table, shot: &Shot, trace: &Trace) -> Result<(), String> {
    let meets = |event: &crate::simulation::Event| event.kind.balls().1.is_some() || event.kind.rail().is_some();
    let rests = trace.pieces.iter().flatten().any(|piece| piece.segment.curve().is_some());
    if trace.events.iter().any(meets) || rests {
        return Ok(());
    }
    let (v, w) = (trace.impulse.velocity, trace.impulse.spin);
    let slip = DVec2::new(v.x - table.radius * w.y, v.y + table.radius * w.x);
    let friction = table.sliding_friction * table.gravity;
    let slide = 2.0 * slip.length() / (7.0 * friction);
    let after = v - 2.0 / 7.0 * slip;
    let slid = slide * v - 0.5 * friction * slide * slide * slip.normalize_or_zero();
    let rolled = after * after.length() / (2.0 * 5.0 / 7.0 * table.rolling_friction * table.gravity);
    let expected = shot.layout.balls[0] + slid + rolled;
    let off = expected.distance(trace.end.balls[0].position);
    // The speeds of translation and rotation partly cancel in the slip: the difference has their rounding, which affects the
    // whole roll.
    let fastest = v.length() + table.radius * w.truncate().length();
    let scale = shot.layout.balls[0].length()
        + fastest * (slide + 2.0 * after.length() / (table.rolling_friction * table.gravity));
    let allowed = OPERATIONS * f64::EPSILON * scale;
    if off <= allowed {
        Ok(())
    } else {
        Err(format!("stops {off:e} m from the closed form; rounding explains {allowed:e} m"))
    }
}
