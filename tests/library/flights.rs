//! Balls that leave the cloth: hops, jumps, massé, and balls off the table.

use carom::{
    physics::{CueInputs, Motion, strike},
    simulation::{EventKind, Recording},
    table::{Flight, Layout, Table},
};
use glam::DVec2;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

fn flying(preset: &str) -> Table {
    Table { flight: Some(Flight::default()), ..Table::preset(preset).unwrap() }
}

fn play(table: &Table, layout: &str, cue: &str) -> Recording {
    let layout = Layout::parse(layout, table).unwrap();
    Recording::new(table, &layout, &CueInputs::parse(cue).unwrap()).unwrap()
}

fn kinds(shot: &Recording) -> Vec<EventKind> {
    shot.events().iter().map(|event| event.kind).collect()
}

#[test]
fn a_stroke_of_45_degrees_and_6_m_s_clears_a_ball_at_30_cm() {
    let table = flying("match");
    let over = play(&table, "-0.5,0 -0.2,0 0.9,0.5", "0,0,45,0,6");
    let low = play(&table, "-0.5,0 -0.2,0 0.9,0.5", "0,0,20,0,6");
    assert!(!kinds(&over).iter().any(|kind| matches!(kind, EventKind::BallBall(0, 1))), "{:?}", kinds(&over));
    assert!(kinds(&low).iter().any(|kind| matches!(kind, EventKind::BallBall(0, 1))), "{:?}", kinds(&low));
    assert_eq!(kinds(&over)[0], EventKind::Jumps(0));
}

/// The height is `V_z²/2g`, for the part of the stroke's downward speed that the cloth returns.
#[test]
fn a_nearly_level_stroke_hops_by_about_a_millimetre() {
    let table = flying("match");
    let cue = CueInputs::parse("0,0,3,0,5").unwrap();
    let pressed = strike(&Table { flight: None, ..table.clone() }, &cue).velocity.length() * cue.theta.tan();
    let expected = 0.25 * pressed * pressed / (2.0 * 9.81);
    let shot = play(&table, "-1,0 0.9,-0.5 0.9,0.5", "0,0,3,0,5");
    let height = shot.jumps()[0].height;
    assert!((height / expected - 1.0).abs() < 0.2, "{height} {expected}");
    assert!(height > 0.0005 && height < 0.005, "{height}");
}

/// Coriolis (1835): a massé ends up rolling parallel to the line from the ball's initial position to the point on the cloth at which the
/// cue aims. This does not depend on friction during the stroke, in landings or in between.
#[test]
fn a_masse_ends_in_the_direction_constructed_by_coriolis() {
    let table = Table { width: 20.0, length: 40.0, ..flying("textbook") };
    for (a, b, degrees, speed) in
        [(0.3, 0.1, 60.0, 3.0), (-0.4, -0.1, 75.0, 4.0), (0.25, -0.3, 45.0, 2.0), (-0.2, 0.3, 30.0, 5.0)]
    {
        let cue = CueInputs { a, b, theta: f64::to_radians(degrees), phi: 0.0, speed };
        // The tip relative to the ball's contact point with the cloth, in radii: b is a height, and the rest of the radius points
        // backwards.
        let tip = [-(1.0 - a * a - b * b).sqrt(), a, 1.0 + b];
        let aim = DVec2::new(tip[0] + tip[2] / cue.theta.tan(), tip[1]);
        let layout = Layout::new([DVec2::ZERO, DVec2::new(-19.0, 9.0), DVec2::new(-19.0, -9.0)]);
        let shot = Recording::new(&table, &layout, &cue).unwrap();
        let rolls = shot.segments(0).iter().find(|segment| segment.motion == Motion::Rolling).unwrap();
        let turn = rolls.velocity.angle_to(aim).to_degrees();
        assert!(turn.abs() < 1e-6, "{degrees} degrees: {} instead of {aim}, {turn} off", rolls.velocity);
        let begins = shot.segments(0)[0].velocity.to_angle().to_degrees();
        assert!((begins - rolls.velocity.to_angle().to_degrees()).abs() > 1.0, "it bends");
    }
}

/// A shot without any lift is computed as on a table whose balls stay on the cloth.
#[test]
fn level_strokes_give_the_same_bits_with_and_without_flight() {
    for preset in ["textbook", "match"] {
        let flat = Table { flight: None, ..Table::preset(preset).unwrap() };
        let table = flying(preset);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        let mut lifted = 0;
        for _ in 0..3000 {
            let layout = Layout::random(&table, &mut rng);
            let (a, b, phi, speed) = (
                rng.random_range(-0.5..0.5),
                rng.random_range(-0.5..0.2),
                rng.random_range(-3.0..3.0),
                rng.random_range(0.3..7.0),
            );
            let cue = CueInputs { a, b, theta: 0.0, phi, speed };
            let [one, other] = [&flat, &table].map(|table| Recording::new(table, &layout, &cue).unwrap());
            if kinds(&other).iter().any(|kind| matches!(kind, EventKind::Jumps(_))) {
                lifted += 1;
                continue;
            }
            assert_eq!(one.events(), other.events());
            assert_eq!(one.final_layout(), other.final_layout());
        }
        println!("{preset}: {lifted} of 3000 climb a nose");
        assert!(lifted < 300, "only much follow climbs a nose: {lifted}");
    }
}
