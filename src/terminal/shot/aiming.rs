//! Changes of a stroke by keys.

use crate::{
    game::Point,
    physics::{CueInputs, signed_angle},
    table::{Layout, Table},
};

/// Smallest steps, to which values are rounded: 0.01°, 0.1 mm, 0.05 m/s.
const DEGREES: f64 = 0.01;
const MILLIMETRES: f64 = 0.1;
const SPEED: f64 = 0.05;
/// Slowest and fastest stroke, m/s; the fastest is that of the thesis (section 4.1.3).
const SPEEDS: (f64, f64) = (0.1, 6.0);
/// Steepest cue elevation, degrees.
const MAX_ELEVATION: f64 = 80.0;
/// Initial speed of a stroke, m/s: the cue ball runs about once around the table.
const FIRST_SPEED: f64 = 2.5;

/// Nearest multiple of `step`.
fn rounded(value: f64, step: f64) -> f64 {
    // Dividing by an integer gives the decimal number itself; multiplying by the step would not.
    let steps = (1.0 / step).round();
    (value * steps).round() / steps
}

/// The initial stroke: level, in the centre, aimed full at the first object ball, or at red if the rule requires red first.
pub fn first_stroke(point: Point, layout: &Layout) -> CueInputs {
    let level = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: FIRST_SPEED };
    aimed_at_ball(&level, layout, point.first_ball())
}

/// Aims the stroke full at `ball`.
pub fn aimed_at_ball(cue: &CueInputs, layout: &Layout, ball: usize) -> CueInputs {
    let degrees = (layout.balls[ball] - layout.balls[0]).to_angle().to_degrees();
    CueInputs { phi: rounded(degrees, DEGREES).to_radians(), ..*cue }
}

/// The object ball that the next press of the key aims at: the one closest to the present aim, or the other one if the stroke already aims
/// full at it.
pub fn next_ball(cue: &CueInputs, layout: &Layout) -> usize {
    let off = |ball| signed_angle(aimed_at_ball(cue, layout, ball).phi, cue.phi).abs();
    let nearer = if off(1) <= off(2) { 1 } else { 2 };
    if off(nearer) < 1e-9 { 3 - nearer } else { nearer }
}

/// Turns the aim to the left by `degrees`.
pub fn turned(cue: &CueInputs, degrees: f64) -> CueInputs {
    let turned = rounded(cue.phi.to_degrees() + degrees, DEGREES);
    // The range is -180 (excluded) to 180 degrees.
    let turned = 180.0 - (180.0 - turned).rem_euclid(360.0);
    CueInputs { phi: rounded(turned, DEGREES).to_radians(), ..*cue }
}

/// Raises the cue by `degrees`.
pub fn raised(cue: &CueInputs, degrees: f64) -> CueInputs {
    let theta = rounded(cue.theta.to_degrees() + degrees, DEGREES).clamp(0.0, MAX_ELEVATION);
    CueInputs { theta: theta.to_radians(), ..*cue }
}

/// Increases the speed by `by` m/s; `None` at the limit. A stroke that was typed may be beyond the limits of the keys.
pub fn faster(cue: &CueInputs, by: f64) -> Option<CueInputs> {
    let speed = rounded(cue.speed + by, SPEED).clamp(SPEEDS.0.min(cue.speed), SPEEDS.1.max(cue.speed));
    (speed != cue.speed).then_some(CueInputs { speed, ..*cue })
}

/// Moves the tip, mm to the player's left and up; `None` if it would slip off the ball, unless it slips already and moves inwards.
pub fn tip_moved(table: &Table, cue: &CueInputs, left: f64, up: f64) -> Option<CueInputs> {
    let millimetre = 0.001 / table.radius;
    let moved = |radii: f64, by: f64| rounded(radii / millimetre + by, MILLIMETRES) * millimetre;
    let next = CueInputs { a: moved(cue.a, left), b: moved(cue.b, up), ..*cue };
    let is_inwards = cue.is_miscue(table) && next.tip_offset_squared() < cue.tip_offset_squared();
    (is_inwards || !next.is_miscue(table)).then_some(next)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::Rule;

    fn stroke() -> (Table, Layout, CueInputs) {
        let table = Table::default();
        let layout = Layout::parse("-0.7,0 0.3,0.4 0.9,-0.5", &table).unwrap();
        let cue = first_stroke(Point::default(), &layout);
        (table, layout, cue)
    }

    #[test]
    fn the_first_stroke_of_a_match_is_aimed_at_red() {
        let table = Table::default();
        let layout = Layout::opening(&table);
        let cue = first_stroke(Point::of(Rule::ThreeCushion, &table, &layout), &layout);
        assert_eq!(cue, aimed_at_ball(&cue, &layout, 2));
    }

    #[test]
    fn the_first_stroke_is_aimed_full_and_aiming_cycles_through_balls() {
        let (_, layout, cue) = stroke();
        assert!((cue.phi.to_degrees() - 21.80).abs() < 1e-9, "{}", cue.phi.to_degrees());
        let other = aimed_at_ball(&cue, &layout, next_ball(&cue, &layout));
        assert!((other.phi.to_degrees() - -17.35).abs() < 1e-9);
        assert_eq!([0.0, 1.0, 30.0].map(|degrees| next_ball(&turned(&other, degrees), &layout)), [1, 2, 1]);
    }

    #[test]
    fn opposite_steps_cancel_and_directions_wrap() {
        let (table, _, cue) = stroke();
        let mut moved = cue;
        for _ in 0..7000 {
            moved = turned(&moved, 0.2);
        }
        assert!((moved.phi.to_degrees() - (21.8 - 40.0)).abs() < 1e-9, "{}", moved.phi.to_degrees());
        for (left, up) in [(0.5, -0.5), (3.0, 0.5), (-3.5, 0.0)] {
            moved = tip_moved(&table, &moved, left, up).unwrap();
        }
        assert!(moved.a.abs() < 1e-12 && moved.b.abs() < 1e-12);
        assert_eq!(faster(&faster(&moved, 0.1).unwrap(), -0.1).unwrap().speed, 2.5);
    }

    #[test]
    fn impossible_inputs_are_clamped() {
        let (table, _, mut cue) = stroke();
        assert_eq!(tip_moved(&table, &cue, 40.0, 0.0), None);
        while let Some(moved) = tip_moved(&table, &cue, 0.5, 0.0) {
            cue = moved;
        }
        assert!(cue.a * cue.a <= table.miscue_limit && cue.a * cue.a > 0.9 * table.miscue_limit);
        let [slowest, fastest] = [-9.0, 9.0].map(|by| faster(&cue, by).unwrap());
        assert_eq!((slowest.speed, fastest.speed), SPEEDS);
        assert_eq!((faster(&slowest, -0.1), faster(&fastest, 0.1)), (None, None));
        // Earlier a faster stroke that was typed became slower.
        let typed = CueInputs { speed: 8.0, ..cue };
        assert_eq!((faster(&typed, 0.1), faster(&typed, -0.1).unwrap().speed), (None, 7.9));
        assert_eq!(raised(&cue, -1.0).theta, 0.0);
        assert!(faster(&raised(&cue, 900.0), -9.0).unwrap().validate().is_ok());
    }
}
