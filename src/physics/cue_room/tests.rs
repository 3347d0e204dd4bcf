//! Tests of the cue's clearance against a cue that is sampled as many points.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::*;

fn table() -> Table {
    Table { room: Some(Room::default()), ..Table::default() }
}

/// Returns a layout. With probability 1/2 each, the cue ball is at a rail and another ball is near it.
fn layout(table: &Table, rng: &mut impl Rng) -> Layout {
    loop {
        let mut layout = Layout::random(table, rng);
        let reach = table.reach();
        if rng.random() {
            let gap = 0.05 * rng.random::<f64>().powi(3);
            layout.balls[0] = match rng.random_range(0..4) {
                0 => DVec2::new(reach.x - gap, layout.balls[0].y),
                1 => DVec2::new(gap - reach.x, layout.balls[0].y),
                2 => DVec2::new(layout.balls[0].x, reach.y - gap),
                _ => DVec2::new(layout.balls[0].x, gap - reach.y),
            };
        }
        if rng.random() {
            let apart = 2.0 * table.radius + 0.4 * rng.random::<f64>().powi(2);
            layout.balls[1] = layout.balls[0] + apart * DVec2::from_angle(rng.random_range(0.0..TAU));
        }
        if layout.validate(table).is_ok() {
            return layout;
        }
    }
}

fn stroke(table: &Table, rng: &mut impl Rng) -> CueInputs {
    let radius = (table.miscue_limit * rng.random::<f64>()).sqrt();
    let (sin, cos) = rng.random_range(0.0..TAU).sin_cos();
    CueInputs { a: radius * cos, b: radius * sin, theta: 0.0, phi: rng.random_range(-PI..PI), speed: 2.0 }
}

/// Returns a stroke that has another ball behind the cue ball in half of the cases: a random direction rarely has an obstacle.
fn towards_trouble(table: &Table, layout: &Layout, rng: &mut impl Rng) -> CueInputs {
    let cue = stroke(table, rng);
    if rng.random() {
        return cue;
    }
    let away = layout.balls[0] - layout.balls[1];
    CueInputs { phi: away.to_angle() + rng.random_range(-0.3..0.3), ..cue }
}

/// Whether a point of the cue is inside a rail or a ball: brute-force sampling of the definition, for comparison.
pub fn collides(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    let Some(room) = table.room else { return false };
    let (sin, cos) = cue.theta.sin_cos();
    let forward = DVec2::from_angle(cue.phi);
    let c = (1.0 - cue.a * cue.a - cue.b * cue.b).sqrt();
    let contact =
        (layout.balls[0] + table.radius * (cue.a * forward.perp() - c * forward)).extend(table.radius * cue.b);
    let axis = (-cos * forward).extend(sin);
    let (aside, up) = (forward.perp().extend(0.0), (sin * forward).extend(cos));
    let half = 0.5 * DVec2::new(table.length, table.width);
    let steps = 700;
    (0..=steps).any(|step| {
        // Denser near the tip, where the distance of obstacles is comparable to the cue's thickness.
        let s = room.length * (f64::from(step) / f64::from(steps)).powi(2);
        let radius = 0.5 * (room.tip + room.taper * s);
        (0..48).any(|turn| {
            let (across, along) = (TAU * f64::from(turn) / 48.0).sin_cos();
            // The end is a disc, the rest is a surface.
            let rings = if step == 0 { 6 } else { 1 };
            (0..rings).any(|ring| {
                let radius = radius * f64::from(rings - ring) / f64::from(rings);
                let point = contact + s * axis + radius * (across * aside + along * up);
                let place = point.truncate();
                let in_rail = point.z < room.nose - table.radius
                    && Rail::ALL.into_iter().any(|rail| (0.0..room.rail).contains(&-rail.gap(half, place)));
                in_rail || layout.balls[1..].iter().any(|ball| (point - ball.extend(0.0)).length() < table.radius)
            })
        })
    })
}

fn at(cue: &CueInputs, theta: f64) -> CueInputs {
    CueInputs { theta, ..*cue }
}

#[test]
fn cue_clears_rails_and_balls_exactly_from_the_least_elevation() {
    let table = table();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(16);
    let (mut raised, mut bounds, mut refused, mut wrongly) = (0, 0, 0, 0);
    for _ in 0..1500 {
        let layout = layout(&table, &mut rng);
        let cue = towards_trouble(&table, &layout, &mut rng);
        let Ok(least) = least_elevation(&table, &layout, &cue) else {
            refused += 1;
            let has_some = (0..30).any(|step| !collides(&table, &layout, &at(&cue, 0.05 * f64::from(step))));
            wrongly += i32::from(has_some);
            continue;
        };
        let steeper = [1e-9, 1e-3, 0.1, 0.3, 0.6, 0.9].map(|share| least.theta + share * (FRAC_PI_2 - least.theta));
        for theta in steeper {
            assert!(!collides(&table, &layout, &at(&cue, theta)), "{least:?} at {theta}: {layout:?} {cue:?}");
            assert!(has_room(&table, &layout, &at(&cue, theta)), "{least:?} at {theta}: {layout:?} {cue:?}");
        }
        // The spacing of the points resolves 2 % of the elevation.
        let lower = 0.98 * least.theta - 0.1_f64.to_radians();
        if lower > 0.0 {
            raised += 1;
            assert!(!has_room(&table, &layout, &at(&cue, least.theta - 1e-9)), "{least:?} {layout:?} {cue:?}");
            bounds += i32::from(!collides(&table, &layout, &at(&cue, lower)));
        }
    }
    // Accepted differences are cues that would fit beside a ball below its centre, cues whose flat end is nearer to a nose than its width,
    // and cues whose butt ends at a nose.
    println!(
        "{raised} raised, {bounds} by more than they must be; {refused} refused, {wrongly} that would do at some elevation"
    );
    assert!(raised > 900 && 50 * bounds < raised, "{raised} raised, {bounds} of them by more than they must be");
    assert!(refused < 150 && 15 * wrongly < refused, "{refused} refused, {wrongly} that would do at some elevation");
}

/// Returns a cue ball at the distance `gap` from the bottom rail, in one half of the default table, with the other balls far
/// away.
fn near_the_bottom(gap: f64) -> (Table, Layout) {
    let table = table();
    let cue_ball = DVec2::new(0.3, gap - table.half_width());
    let layout = Layout::new([cue_ball, DVec2::new(-1.0, 0.5), DVec2::new(-1.2, 0.3)]);
    layout.validate(&table).unwrap();
    (table, layout)
}

fn up(b: f64) -> CueInputs {
    CueInputs { a: 0.0, b, theta: 0.0, phi: FRAC_PI_2, speed: 2.0 }
}

#[test]
fn frozen_cue_ball_needs_a_raised_cue_away_from_its_rail() {
    let (table, frozen) = near_the_bottom(0.0);
    assert_eq!(least_elevation(&table, &frozen, &up(0.0)).unwrap_err().obstacle, Obstacle::Rail(Rail::Bottom));
    let low = least_elevation(&table, &frozen, &up(0.35)).unwrap();
    assert!(low.over == Some(Obstacle::Rail(Rail::Bottom)) && low.theta > 0.3, "{low:?}");
    // From 12.25 mm above the ball's middle on, the underside of a level cue with a radius of 6 mm is at the height of the nose or higher,
    // 6.25 mm above the middle; only its taper needs an elevation.
    assert!(least_elevation(&table, &frozen, &up(0.42)).unwrap().theta < 0.5_f64.to_radians());
    let (table, middle) = near_the_bottom(0.6);
    let least = least_elevation(&table, &middle, &up(0.0)).unwrap();
    // 6.25 mm up, plus the cue's own 6 mm and 2.4 mm of taper over 0.6 m.
    assert!((least.theta.tan() - 0.014_65 / 0.6).abs() < 1e-4, "{least:?}");
    // For a stroke along the rail, only the far rail is behind the cue, out of its reach.
    let along = least_elevation(&table, &frozen, &CueInputs { phi: PI, ..up(0.0) }).unwrap();
    assert!(along.theta < 1.0_f64.to_radians(), "{along:?}");
}

#[test]
fn blocked_cue_is_refused_only_on_tables_with_room_limits() {
    let (table, layout) = near_the_bottom(0.0);
    let error = raise_to_clear(&table, &layout, &up(-0.2)).unwrap_err();
    assert!(error.to_string().contains("the bottom rail"), "{error}");
    let free = Table { room: None, ..table.clone() };
    assert_eq!(raise_to_clear(&free, &layout, &up(-0.2)), Ok(up(-0.2)));
    assert_eq!(least_elevation(&free, &layout, &up(-0.2)), Ok(LeastElevation { theta: 0.0, over: None }));
    // A ball that touches the cue ball from behind, with the tip at the middle of the cue ball.
    let cue_ball = DVec2::new(0.0, 0.1);
    let behind = cue_ball - DVec2::new(0.0, 2.0 * table.radius);
    let layout = Layout::new([cue_ball, DVec2::new(-1.0, 0.5), behind]);
    assert_eq!(least_elevation(&table, &layout, &up(0.0)).unwrap_err().obstacle, Obstacle::Ball(2));
    let over = least_elevation(&table, &layout, &up(0.5)).unwrap();
    assert!(over.over == Some(Obstacle::Ball(2)) && over.theta > 0.7, "{over:?}");
}

#[test]
fn ball_ahead_never_blocks_the_cue() {
    let table = table();
    for (apart, b) in [(0.062, -0.45), (0.3, -0.3), (0.3, 0.0), (1.0, 0.45)] {
        let layout = Layout::new([DVec2::ZERO, DVec2::new(0.0, apart), DVec2::new(-1.2, 0.3)]);
        let least = least_elevation(&table, &layout, &up(b)).unwrap();
        assert!(least.theta < 3.0_f64.to_radians() && !matches!(least.over, Some(Obstacle::Ball(_))), "{b}: {least:?}");
    }
}

#[test]
fn more_room_never_needs_a_steeper_cue() {
    let theta = |table: &Table, layout: &Layout, cue: &CueInputs| {
        least_elevation(table, layout, cue).map_or(FRAC_PI_2, |least| least.theta)
    };
    let falls = |steps: Vec<f64>, what: &str| {
        assert!(steps.is_sorted_by(|one, next| next <= one) && steps[0] > steps[steps.len() - 1], "{what}: {steps:?}");
    };
    let steps = |range: f64| (0..60).map(move |step| range * f64::from(step) / 60.0);
    let from_rail = steps(0.6).map(|gap| {
        let (table, layout) = near_the_bottom(gap);
        theta(&table, &layout, &up(0.1))
    });
    falls(from_rail.collect(), "further from the rail");
    let (table, layout) = near_the_bottom(0.1);
    falls(steps(0.5).map(|b| theta(&table, &layout, &up(b))).collect(), "a higher tip");
    let lower = steps(0.03).map(|by| {
        let room = Room { nose: 0.04 - by, ..Room::default() };
        theta(&Table { room: Some(room), ..table.clone() }, &layout, &up(0.1))
    });
    falls(lower.collect(), "a lower nose");
    let ball = steps(0.4).map(|further| {
        let behind = layout.balls[0] - DVec2::new(0.0, -0.07 - further);
        let layout = Layout::new([layout.balls[0], layout.balls[1], behind]);
        theta(&table, &layout, &CueInputs { phi: -FRAC_PI_2, ..up(0.1) })
    });
    falls(ball.collect(), "a ball further behind");
}

proptest! {
    #[test]
    fn a_mirrored_stroke_needs_the_same_elevation(seed in any::<u64>()) {
        let table = table();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let layout = layout(&table, &mut rng);
        let cue = towards_trouble(&table, &layout, &mut rng);
        let mirrored = Layout::new(layout.balls.map(|ball| DVec2::new(-ball.x, ball.y)));
        let other = CueInputs { a: -cue.a, phi: PI - cue.phi, ..cue };
        match (least_elevation(&table, &layout, &cue), least_elevation(&table, &mirrored, &other)) {
            (Ok(one), Ok(other)) => prop_assert!((one.theta - other.theta).abs() < 1e-9, "{:?} {:?}", one, other),
            (one, other) => prop_assert_eq!(one.is_err(), other.is_err(), "{:?} {:?}", one, other),
        }
    }

    #[test]
    fn raised_stroke_has_room_is_minimal_and_stays(seed in any::<u64>()) {
        let table = table();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let layout = layout(&table, &mut rng);
        let cue = towards_trouble(&table, &layout, &mut rng);
        if let Ok(raised) = raise_to_clear(&table, &layout, &cue) {
            raised.validate().unwrap();
            prop_assert!(has_room(&table, &layout, &raised));
            prop_assert_eq!(raise_to_clear(&table, &layout, &raised), Ok(raised));
            let least = least_elevation(&table, &layout, &cue).unwrap();
            // A low tip may have clearance when level and none at some steeper elevations.
            if has_room(&table, &layout, &cue) {
                prop_assert_eq!(raised, cue);
            } else {
                prop_assert!((0.0..0.0101_f64.to_radians()).contains(&(raised.theta - least.theta)));
            }
            prop_assert_eq!(CueInputs { theta: cue.theta, ..raised }, cue);
        }
    }
}
