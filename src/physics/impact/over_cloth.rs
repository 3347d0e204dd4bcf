//! Impact of a ball in the air on a ball on the cloth, including the reaction of the cloth.
//!
//! In a hard impact the balls separate first, and the cloth then throws the lower ball up again. In a soft impact the lower ball stays on
//! the cloth, and the upper ball cannot rebound. The two would press on each other in ever shorter bounces, each of which removes
//! tangential motion, so that a ball would never slide off the top of another. In a soft impact the cloth therefore supports the lower ball
//! during the impact: this ball gives way only along the table, and the upper ball slides off in bounces without loss.
//!
//! Friction moves the lower ball along the table, and with it the line of centres. The normal impulse makes up for that: otherwise each
//! bounce would be slower than the one before.

use glam::DVec3;

use super::{super::SpatialState, BallImpact, direction, separation_speed};
use crate::physics::Cloth;

/// Largest number of corrections of the normal impulse. If they do not converge, as with a friction far above one, the impact takes place
/// without them.
const MAX_CORRECTIONS: u32 = 100;

/// Share of the separation speed that may be missing after the corrections.
const CORRECTED: f64 = 1e-12;

impl BallImpact {
    /// Applies a collision of two balls, at least one of which is in the air, including the reaction of the `cloth`. After a soft impact
    /// they separate at the speed `slowest`, m/s, as far as the energy suffices. Returns their approach speed, m/s, which is negative if
    /// they do not approach.
    pub fn resolve_over_cloth(
        &self,
        radius: f64,
        slowest: f64,
        cloth: &Cloth,
        first: &mut SpatialState,
        second: &mut SpatialState,
    ) -> f64 {
        let before = [*first, *second];
        let approach = self.resolve_in_space(radius, slowest, first, second);
        for ball in [&mut *first, &mut *second] {
            if ball.position.z <= 0.0 {
                cloth.resolve(radius, ball);
            }
        }
        let first_is_lower = first.position.z < second.position.z;
        let [upper, lower] = if first_is_lower { [second, first] } else { [first, second] };
        let [upper_before, lower_before] = if first_is_lower { [before[1], before[0]] } else { before };
        let lies = lower.position.z <= 0.0 && upper.position.z > 0.0 && lower_before.velocity.z <= 0.0;
        if !lies || approach < 0.0 || lower.velocity.z > slowest {
            return approach;
        }
        let n = (upper.position - lower.position).normalize();
        let opening = upper.velocity.dot(n) - lower.velocity.truncate().dot(n.truncate());
        if approach <= slowest || opening < slowest {
            (*upper, *lower) = (upper_before, lower_before);
            self.resolve_supported(radius, slowest, cloth, upper, lower);
        }
        approach
    }

    /// Applies a collision in which the cloth supports the `lower` ball.
    fn resolve_supported(
        &self,
        radius: f64,
        slowest: f64,
        cloth: &Cloth,
        upper: &mut SpatialState,
        lower: &mut SpatialState,
    ) {
        let n = direction(lower.position, upper.position);
        lower.velocity.z = 0.0;
        let along_table = n.with_z(0.0);
        let approach = (lower.velocity - upper.velocity).dot(n);
        // Restitution of the balls and then of the cloth; a slow impact loses nothing.
        let restitution = self.restitution_at(approach) * cloth.restitution;
        let opening = separation_speed(approach, restitution, slowest);
        let inverse_mass = 1.0 + along_table.length_squared();
        let before = [*upper, *lower];
        let pushed = |push: f64| {
            let [mut upper, mut lower] = before;
            upper.velocity += push * n;
            lower.velocity -= push * along_table;
            let relative = upper.velocity - lower.velocity;
            let slip = relative - relative.dot(n) * n - radius * (upper.spin + lower.spin).cross(n);
            let factor = self.friction_factor(push, slip.length());
            let friction = -factor * slip;
            upper.velocity += friction;
            lower.velocity -= friction.with_z(0.0);
            let twist = (2.5 / radius * factor) * n.cross(slip);
            upper.spin += twist;
            lower.spin += twist;
            cloth.apply_friction(radius, (push * n.z + friction.z).max(0.0), &mut lower);
            [upper, lower]
        };
        let missing = |[upper, lower]: &[SpatialState; 2]| opening - (upper.velocity - lower.velocity).dot(n);
        let energy =
            |balls: &[SpatialState; 2]| balls.iter().map(|ball| ball.specific_energy(radius, 0.0)).sum::<f64>();
        let single = (approach + opening) / inverse_mass;
        let alone = pushed(single);
        let (mut push, mut after) = (single, alone);
        for _ in 0..MAX_CORRECTIONS {
            let short = missing(&after);
            if short <= f64::EPSILON * opening {
                break;
            }
            push += short / inverse_mass;
            after = pushed(push);
        }
        let is_solved = missing(&after) <= CORRECTED * opening && energy(&after) <= energy(&before);
        [*upper, *lower] = if is_solved { after } else { alone };
        separate_slowly(slowest, n, upper, lower);
    }
}

/// Makes balls that hardly separate do so at the speed `slowest`, m/s, as far as the energy of their relative sliding suffices.
///
/// The sliding impulse is made orthogonal to the separating one in the metric of the kinetic energy. Each then changes one speed and leaves
/// the other unchanged, and no energy is gained.
fn separate_slowly(slowest: f64, n: DVec3, upper: &mut SpatialState, lower: &mut SpatialState) {
    let relative = upper.velocity - lower.velocity;
    let opening = relative.dot(n);
    if opening >= 0.5 * slowest {
        return;
    }
    // Orthogonalized against the normal a second time, because rounding dominates if the vector is tiny.
    let across = relative - opening * n;
    let along = (across - across.dot(n) * n).normalize_or_zero();
    // Velocity change of the upper and the lower ball per impulse per mass of 1 m/s; the cloth supports the lower ball.
    let separating = [n, -n.with_z(0.0)];
    let inverse_mass = |[one, other]: [DVec3; 2]| one.length_squared() + other.length_squared();
    let shared = n.z * along.z / inverse_mass(separating);
    let slide = [along + shared * separating[0], -along.with_z(0.0) + shared * separating[1]];
    let sliding = upper.velocity.dot(slide[0]) + lower.velocity.dot(slide[1]);
    let [parts, slides] = [inverse_mass(separating), inverse_mass(slide)];
    if sliding * sliding == 0.0 {
        return;
    }
    // Energies are compared as squares of the separation speed.
    let available = parts / slides * sliding * sliding;
    let needed = (slowest * slowest - opening * opening).min(available);
    let push = ((opening * opening + needed).sqrt() - opening) / parts;
    let brake = ((1.0 - needed / available).sqrt() - 1.0) * sliding / slides;
    upper.velocity += push * separating[0] + brake * slide[0];
    lower.velocity += push * separating[1] + brake * slide[1];
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::table::{Flight, PRESETS, Table};

    /// Returns the specific energies before and after, and the closing and separation speeds. The speeds are `None` if friction pressed the
    /// lower ball into the cloth, which threw it up again.
    fn soft(
        table: &Table,
        angle: f64,
        velocities: [DVec3; 2],
        spins: [DVec3; 2],
        slowest: f64,
    ) -> ([f64; 2], Option<[f64; 2]>) {
        let (law, cloth) = (BallImpact::of(table), Cloth::of(table).unwrap());
        let n = DVec3::new(0.6 * angle.sin(), 0.8 * angle.sin(), angle.cos());
        let mut upper = SpatialState { position: 2.0 * table.radius * n, velocity: velocities[0], spin: spins[0] };
        let mut lower = SpatialState { position: DVec3::ZERO, velocity: velocities[1].with_z(0.0), spin: spins[1] };
        let energy = |upper: &SpatialState, lower: &SpatialState| {
            [upper, lower].map(|ball| ball.specific_energy(table.radius, table.gravity)).iter().sum()
        };
        let separation =
            |upper: &SpatialState, lower: &SpatialState| (upper.velocity - lower.velocity.with_z(0.0)).dot(n);
        let (before, closing) = (energy(&upper, &lower), -separation(&upper, &lower));
        law.resolve_over_cloth(table.radius, slowest, &cloth, &mut upper, &mut lower);
        let stays = lower.velocity.z <= slowest;
        ([before, energy(&upper, &lower)], stays.then(|| [closing, separation(&upper, &lower)]))
    }

    proptest! {
        #[test]
        fn impacts_over_cloth_gain_no_energy_and_soft_ones_separate(
            angle in 0.0..1.5f64,
            size in -4.0..0.0f64,
            v in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0],
            w in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0],
            restitution in prop_oneof![Just(0.0), Just(0.5), Just(0.99)],
        ) {
            let slowest = 2e-3;
            for name in PRESETS {
                let flight = Some(Flight { restitution, friction: None });
                let table = Table { flight, ..Table::preset(name).unwrap() };
                let speed = 10_f64.powf(size);
                let velocities = [DVec3::new(v[0], v[1], v[2]) * speed, DVec3::new(v[3], v[4], 0.0) * speed];
                let spins = [DVec3::new(w[0], w[1], w[2]), DVec3::new(w[3], w[4], w[5])].map(|w| w * speed / table.radius);
                let ([before, after], _) = soft(&table, angle, velocities, spins, slowest);
                prop_assert!(after <= before * (1.0 + 1e-14), "{name}: {before} {after}");
                let (_, speeds) = soft(&table, angle, [velocities[0], DVec3::ZERO], [DVec3::ZERO; 2], slowest);
                if let Some([closing, opening]) = speeds.filter(|[closing, _]| (0.0..slowest).contains(closing)) {
                    prop_assert!(opening > 0.1 * closing, "{name}: {opening}");
                }
            }
        }
    }

    /// The upper ball's own motion would not suffice to follow a ball that moves away as fast: the balls would collide again and again,
    /// without end.
    #[test]
    fn balls_moving_together_separate_by_their_relative_sliding() {
        let (n, slowest) = (DVec3::new(0.6 * 1.2_f64.sin(), 0.8 * 1.2_f64.sin(), 1.2_f64.cos()), 2e-3);
        let ball = |velocity| SpatialState { position: DVec3::ZERO, velocity, spin: DVec3::ZERO };
        let ahead = 0.3 * n.with_z(0.0);
        let (mut upper, mut lower) = (ball(ahead.dot(n) * n + 0.02 * n.cross(DVec3::Z)), ball(ahead));
        let energy = |upper: &SpatialState, lower: &SpatialState| {
            [upper, lower].map(|ball| ball.velocity.length_squared()).iter().sum::<f64>()
        };
        let before = energy(&upper, &lower);
        separate_slowly(slowest, n, &mut upper, &mut lower);
        let opening = (upper.velocity - lower.velocity).dot(n);
        assert!((opening - slowest).abs() < 1e-12 && lower.velocity.z == 0.0, "{opening} {lower:?}");
        assert!((energy(&upper, &lower) - before).abs() < 1e-15, "{before}");
        // If they do not slide along each other, there is no energy to take.
        let still = upper;
        separate_slowly(slowest, n, &mut upper, &mut ball(still.velocity));
        assert_eq!(upper, still);
    }

    /// The lower ball slides on the cloth, whose friction moves it: bounces that became slower by this would never end.
    #[test]
    fn friction_does_not_slow_soft_bounces() {
        let table = Table { flight: Some(Flight::default()), ..Table::preset("thesis").unwrap() };
        let (law, cloth) = (BallImpact::of(&table), Cloth::of(&table).unwrap());
        let n = DVec3::new(0.22, 0.0, (1.0_f64 - 0.22 * 0.22).sqrt());
        let (along, spin) = (DVec3::new(1.43, 0.0, 0.0), DVec3::new(0.0, 52.4, 0.0));
        let mut upper = SpatialState { position: 2.0 * table.radius * n, velocity: along - 1e-3 * n, spin: -spin };
        let mut lower = SpatialState { position: DVec3::ZERO, velocity: along, spin };
        let approach = law.resolve_over_cloth(table.radius, 2e-3, &cloth, &mut upper, &mut lower);
        let opening = (upper.velocity - lower.velocity).dot(n);
        assert!((opening - approach).abs() < 1e-11 * approach, "{approach} {opening}");
    }

    #[test]
    fn soft_landing_on_a_ball_rebounds_softly_keeping_tangential_motion() {
        let table =
            Table { flight: Some(Flight::default()), ball_friction: Some(0.0), ..Table::preset("textbook").unwrap() };
        let slowest = 2e-3;
        let down = DVec3::new(0.0, 0.0, -1.5e-3);
        let ([before, after], speeds) = soft(&table, 0.02, [down, DVec3::ZERO], [DVec3::ZERO; 2], slowest);
        let [closing, opening] = speeds.unwrap();
        assert!((opening - closing).abs() < 1e-3 * closing, "{closing} {opening}");
        assert!((after - before).abs() < 1e-3 * 1.5e-3 * 1.5e-3, "{before} {after}");
    }
}
