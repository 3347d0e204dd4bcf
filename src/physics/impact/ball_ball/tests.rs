//! Properties of every ball-ball impact law.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;

/// Radius of the balls, m.
const RADIUS: f64 = 0.03;

/// Rounding error of sums of squares of a few m/s.
const ROUNDING: f64 = 1e-12;

/// Laws with and without a coefficient of friction, constant or dependent on speed and slip.
fn laws() -> impl Strategy<Value = BallImpact> {
    let fade = (0.0..3.0f64, 0.0..0.2f64, 0.0..1.0f64).prop_map(|(from, slope, least)| Fade { from, slope, least });
    let by_slip =
        (0.0..0.1f64, 0.0..0.9f64, 0.0..2.0f64).prop_map(|(least, rise, fade)| SlipFriction { least, rise, fade });
    (0.0..=1.0f64, prop::option::of(0.0..1.0f64), prop::option::of(fade), prop::option::of(by_slip))
        .prop_map(|(restitution, friction, fade, by_slip)| BallImpact { restitution, friction, fade, by_slip })
}

/// Two touching balls that approach each other, and the unit vector from the second to the first.
fn meeting() -> impl Strategy<Value = (DVec2, [BallState; 2])> {
    let velocities = prop::array::uniform4(-5.0..5.0f64);
    let spins = prop::array::uniform6(-200.0..200.0f64);
    (-3.2..3.2f64, velocities, spins).prop_map(|(angle, v, w)| {
        let n = DVec2::from_angle(angle);
        let ball = |position, v: &[f64], w: &[f64]| BallState {
            position,
            velocity: DVec2::from_slice(v),
            spin: DVec3::from_slice(w),
        };
        let mut balls = [ball(n * 2.0 * RADIUS, &v[..2], &w[..3]), ball(DVec2::ZERO, &v[2..], &w[3..])];
        // If the balls would separate, their velocities are reversed.
        let sign = (balls[1].velocity - balls[0].velocity).dot(n).signum();
        for ball in &mut balls {
            ball.velocity *= sign;
        }
        (n, balls)
    })
}

fn collide(law: &BallImpact, balls: [BallState; 2]) -> [BallState; 2] {
    let [mut first, mut second] = balls;
    law.resolve(RADIUS, &mut first, &mut second);
    [first, second]
}

/// Whether two pairs are equal up to rounding, in velocity and R times spin.
fn are_same(one: &[BallState; 2], other: &[BallState; 2]) -> bool {
    one.iter().zip(other).all(|(one, other)| {
        one.velocity.distance(other.velocity).max(RADIUS * one.spin.distance(other.spin)) < ROUNDING
    })
}

proptest! {
    #[test]
    fn collision_keeps_momentum_obeys_restitution_and_loses_energy(law in laws(), (n, before) in meeting()) {
        let after = collide(&law, before);
        let momentum = |balls: &[BallState; 2]| balls[0].velocity + balls[1].velocity;
        prop_assert!(momentum(&after).distance(momentum(&before)) < 1e-13);
        let opening = |balls: &[BallState; 2]| (balls[0].velocity - balls[1].velocity).dot(n);
        let approach = -opening(&before);
        prop_assert!((opening(&after) - law.restitution_at(approach) * approach).abs() < ROUNDING);
        let energy = |balls: &[BallState; 2]| balls.iter().map(|ball| ball.specific_energy(RADIUS)).sum::<f64>();
        prop_assert!(energy(&after) <= energy(&before) * (1.0 + 1e-14) + 1e-13);
    }

    /// An impact without loss is undone by the same impact with reversed velocities.
    #[test]
    fn an_impact_without_loss_is_reversible((_, before) in meeting()) {
        let law = BallImpact { restitution: 1.0, friction: Some(0.0), fade: None, by_slip: None };
        let reversed = |balls: [BallState; 2]| {
            balls.map(|ball| BallState { velocity: -ball.velocity, spin: -ball.spin, ..ball })
        };
        let back = reversed(collide(&law, reversed(collide(&law, before))));
        prop_assert!(are_same(&back, &before), "{back:?}");
    }

    /// A reflection mirrors velocities as polar vectors and spins as axial vectors.
    #[test]
    fn mirrored_collision_has_mirrored_result(law in laws(), (_, before) in meeting()) {
        let mirror = |balls: [BallState; 2]| {
            balls.map(|ball| BallState {
                position: ball.position * DVec2::new(1.0, -1.0),
                velocity: ball.velocity * DVec2::new(1.0, -1.0),
                spin: ball.spin * DVec3::new(-1.0, 1.0, -1.0),
            })
        };
        prop_assert!(are_same(&mirror(collide(&law, before)), &collide(&law, mirror(before))));
    }
}

#[test]
fn spatial_collision_on_cloth_equals_planar_except_for_lift() {
    for name in crate::table::PRESETS {
        let table = Table::preset(name).unwrap();
        let (law, radius) = (BallImpact::of(&table), table.radius);
        let ball = |position: DVec2, velocity: [f64; 2], spin: [f64; 3]| BallState {
            position,
            velocity: velocity.into(),
            spin: DVec3::from_array(spin),
        };
        let n = DVec2::from_angle(0.7);
        let mut one = ball(DVec2::ZERO, [2.0, 1.4], [-20.0, 50.0, 30.0]);
        let mut other = ball(2.0 * radius * n, [-0.2, 0.1], [3.0, 0.0, -9.0]);
        let [mut a, mut b] = [one, other].map(SpatialState::from);
        law.resolve(radius, &mut one, &mut other);
        law.resolve_in_space(radius, 0.0, &mut a, &mut b);
        for (plane, space) in [(one, a), (other, b)] {
            assert!(plane.velocity.distance(space.velocity.truncate()) < 1e-14, "{name}");
            assert!(plane.spin.distance(space.spin) < 1e-11, "{name}");
        }
        assert_eq!(a.velocity.z, -b.velocity.z);
        assert!(a.velocity.z != 0.0);
    }
}
