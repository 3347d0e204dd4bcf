//! Properties of every rail model.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::table::Rails;

const RADIUS: f64 = 0.030_75;

fn cushion(model: RailModel, height: f64) -> Cushion {
    cushion_with(model, height, 0.87, 0.25)
}

fn cushion_with(model: RailModel, height: f64, rail_restitution: f64, rail_friction: f64) -> Cushion {
    let rail = Rails { model, height: Some(height), kappa: Some(1.146), ..Rails::default() };
    Cushion::of(&Table { rail, radius: RADIUS, rail_restitution, rail_friction, ..Table::default() }, Rail::Right)
}

const MODELS: [RailModel; 4] = [RailModel::Equator, RailModel::Nose, RailModel::Smooth, RailModel::Mathavan];

fn hit(cushion: &Cushion, ball: &BallState) -> BallState {
    let mut ball = *ball;
    cushion.resolve(RADIUS, DVec2::NEG_X, &mut ball);
    ball
}

fn moving() -> impl Strategy<Value = BallState> {
    ((0.001..8.0f64, -8.0..8.0f64), [-300.0..300.0f64, -300.0..300.0, -300.0..300.0]).prop_map(|((x, y), spin)| {
        BallState { position: DVec2::ZERO, velocity: DVec2::new(x, y), spin: DVec3::from_array(spin) }
    })
}

proptest! {
    #[test]
    fn rail_impacts_gain_no_energy(ball in moving(), height in 0.0308..0.040f64) {
        for model in MODELS {
            let after = hit(&cushion(model, height), &ball);
            let (before, after) = (ball.specific_energy(RADIUS), after.specific_energy(RADIUS));
            prop_assert!(after <= before * (1.0 + 1e-12), "{model:?}: {before} to {after}");
        }
    }

    #[test]
    fn lossy_rails_let_no_ball_through(
        ball in moving(),
        height in 0.0308..0.049f64,
        (e, mu) in (0.0..0.5f64, 0.0..0.99f64),
    ) {
        for model in MODELS {
            let mut after = ball;
            let impulse = cushion_with(model, height, e, mu).resolve(RADIUS, DVec2::NEG_X, &mut after);
            prop_assert!(after.velocity.x <= 1e-12 || impulse.climb > 0.0, "{model:?}: {after:?}");
            let (before, energy) = (ball.specific_energy(RADIUS), after.specific_energy(RADIUS));
            prop_assert!(energy <= before * (1.0 + 1e-12), "{model:?}: {before} to {energy}");
        }
    }

    #[test]
    fn mirrored_ball_rebounds_mirrored(ball in moving(), height in 0.0308..0.040f64) {
        // Mirrored along the cushion: spins about axes in the mirror plane change their sign.
        let mirror = |ball: &BallState| BallState {
            velocity: ball.velocity * DVec2::new(1.0, -1.0),
            spin: ball.spin * DVec3::new(-1.0, 1.0, -1.0),
            ..*ball
        };
        for model in MODELS {
            let cushion = cushion(model, height);
            prop_assert_eq!(hit(&cushion, &mirror(&ball)), mirror(&hit(&cushion, &ball)));
        }
    }

    #[test]
    fn nose_at_centre_height_equals_equator_model(ball in moving()) {
        let (nose, equator) = (hit(&cushion(RailModel::Nose, RADIUS), &ball), hit(&cushion(RailModel::Equator, RADIUS), &ball));
        prop_assert!(nose.velocity.distance(equator.velocity) < 1e-13 && nose.spin.distance(equator.spin) < 1e-11);
    }

    #[test]
    fn impact_at_centre_height_obeys_restitution_without_reversing_slip(
        ball in moving(), e in 0.0..=1.0f64, mu in 0.0..1.0f64,
    ) {
        let (n, mut after) = (DVec2::NEG_X, ball);
        collide_rail(RADIUS, e, mu, n, &mut after);
        prop_assert!((after.velocity.x + e * ball.velocity.x).abs() < 1e-13);
        let slip = |ball: &BallState| ball.velocity.dot(n.perp()) - RADIUS * ball.spin.z;
        prop_assert!(slip(&ball) * slip(&after) > -1e-12);
        prop_assert!(after.specific_energy(RADIUS) <= ball.specific_energy(RADIUS) * (1.0 + 1e-14));
    }

    /// An impact without loss is undone by the same impact with reversed velocities.
    #[test]
    fn lossless_impact_at_centre_height_is_reversible(ball in moving()) {
        let there = |mut ball: BallState| {
            collide_rail(RADIUS, 1.0, 0.0, DVec2::NEG_X, &mut ball);
            BallState { velocity: -ball.velocity, spin: -ball.spin, ..ball }
        };
        let back = there(there(ball));
        prop_assert!(back.velocity.distance(ball.velocity) < 1e-12 && back.spin.distance(ball.spin) < 1e-10);
    }

    #[test]
    fn smooth_friction_never_exceeds_coulomb_or_its_limit(ball in moving()) {
        let [smooth, sharp] = [RailModel::Smooth, RailModel::Nose].map(|model| hit(&cushion(model, 0.0365), &ball));
        let taken = |after: BallState| (after.spin - ball.spin).length();
        prop_assert!(taken(smooth) <= 1.146 * taken(sharp) * (1.0 + 1e-12));
        // With so little friction every impact slips. The spin changes by 5/(2R) times the friction impulse per mass.
        let mut after = ball;
        let impulse =
            cushion_with(RailModel::Smooth, 0.0365, 0.87, 0.02).resolve(RADIUS, DVec2::NEG_X, &mut after);
        let friction = 0.4 * RADIUS * (after.spin - ball.spin).length();
        prop_assert!(friction <= 0.02 * impulse.normal * (1.0 + 1e-9), "{friction} of {}", impulse.normal);
    }
}

#[test]
fn integrated_law_scales_with_speed() {
    let ball = BallState { position: DVec2::ZERO, velocity: DVec2::new(1.2, 0.9), spin: DVec3::new(-20.0, 35.0, 40.0) };
    let cushion = cushion(RailModel::Mathavan, 0.0365);
    let slow = BallState { velocity: 1e-3 * ball.velocity, spin: 1e-3 * ball.spin, ..ball };
    let (after, slow) = (hit(&cushion, &ball), hit(&cushion, &slow));
    assert!((1e3 * slow.velocity).distance(after.velocity) < 1e-9);
}
