//! Impact at the height of the nose, integrated over its impulse: Mathavan, Jackson and Parkin, "A theoretical analysis of billiard ball
//! dynamics under cushion impacts" (2010).
//!
//! While the impulse `P` along the line of impact grows, the nose's friction acts on the ball with `μ dP` against the slip there. The ball
//! is pressed into the cloth by `dN = (sin α + μ cos α · upward share of the slip) dP`, and the cloth's friction acts with `μ_s dN` against
//! its slip there. Compression ends when the ball no longer approaches. Restitution returns the share `e²` of the work of compression
//! (Stronge).
//!
//! The drag of the cloth ends with the slip there: within a step it is at most what removes the slip. Otherwise a rough cloth would drive
//! the ball.
//!
//! Velocities are linear in the impulse, except for the directions of the two slips, so that a few steps are enough. If the nose sticks,
//! the friction of a step balances the other forces.

use glam::{DVec2, DVec3};

use super::BallState;

/// Steps for compression, and the same number for restitution. For an impact at 1 m/s, the velocity error is 0.3 mm/s in the median, below
/// 2 mm/s in nine of ten cases, and 4 cm/s at worst, if a slip ends within a step. This is a tenth of the law's deviation from real rails.
const STEPS: u32 = 4;

/// If the fourth power of available over holding friction is below this, the slip keeps its direction; this saves a square root.
const NEARLY_FREE: f64 = 0.02;

/// Smallest rate of outward velocity per impulse: friction of nose and cloth cancels at most nine tenths of the driving force. Guard
/// against constants with which friction could hold the ball in the rail.
const MIN_GAIN: f64 = 0.1;

/// Velocity along the normal into the table and along the cushion, and the equatorial speeds `R ω` of the spin about these two axes and the
/// vertical, all m/s.
#[derive(Clone, Copy)]
struct Velocities {
    velocity: DVec2,
    spin: DVec3,
}

impl Velocities {
    fn plus(&self, share: f64, rate: &Self) -> Self {
        Self { velocity: self.velocity + share * rate.velocity, spin: self.spin + share * rate.spin }
    }
}

/// Coefficients of friction of nose and cloth, and sine and cosine of the nose's elevation.
struct Constants {
    nose: f64,
    cloth: f64,
    sine: f64,
    cosine: f64,
}

impl Constants {
    /// Returns the slip at the nose, along the cushion and orthogonal to both the cushion and the line of impact.
    fn slip(&self, Velocities { velocity: v, spin: w }: &Velocities) -> DVec2 {
        DVec2::new(v.y - (self.cosine * w.z + self.sine * w.x), w.y + self.sine * v.x)
    }

    /// Returns the derivative of the motion with respect to the impulse per mass along the line of impact, for a step of `impulse` that
    /// starts at `from`. The slip directions are those at `at`.
    fn rate(&self, from: &Velocities, at: &Velocities, impulse: f64) -> Velocities {
        let Self { nose, cloth, sine, cosine } = *self;
        let below = DVec2::new(at.velocity.x - at.spin.y, at.velocity.y + at.spin.x);
        // Friction of the cloth per unit of downward impulse.
        let drag = -cloth * below.normalize_or_zero();
        let rate = |friction: DVec2| {
            // The upward friction of the nose lifts the ball; its normal force presses the ball down.
            let pressing = (sine - friction.y * cosine).max(0.0);
            let removing = below.length() / (3.5 * impulse);
            let drag = (removing / (pressing * cloth)).min(1.0) * pressing * drag;
            Velocities {
                velocity: DVec2::new(cosine + friction.y * sine + drag.x, friction.x + drag.y),
                spin: 2.5 * DVec3::new(drag.y - friction.x * sine, friction.y - drag.x, -friction.x * cosine),
            }
        };
        // Friction that leaves no slip at the end of the step: the slip is linear in the friction.
        let dragged = DVec2::new((1.0 - 2.5 * sine) * drag.y, (sine - 2.5) * drag.x);
        let left = self.slip(from) / impulse + sine * (DVec2::new(0.0, cosine) + dragged);
        let up = -left.y / (2.5 + sine * sine - cosine * dragged.y);
        let holding = DVec2::new(-(left.x - cosine * dragged.x * up) / 3.5, up);
        let share = nose * nose / holding.length_squared();
        if share >= 1.0 {
            return rate(holding);
        }
        let slip = self.slip(at).normalize_or_zero();
        // Shortly before the nose sticks, the slip direction is blended towards that of the sticking friction.
        let near = share * share;
        if near < NEARLY_FREE {
            return rate(-nose * slip);
        }
        let against = near * holding.normalize_or_zero() - (1.0 - near) * slip;
        rate(nose * against.normalize_or_zero())
    }

    /// Returns the derivative for a step of `impulse` by the midpoint method, at least with the outward rate [`MIN_GAIN`].
    fn step(&self, motion: &Velocities, impulse: f64) -> Velocities {
        let first = self.rate(motion, motion, 0.5 * impulse);
        let Velocities { velocity, spin } = self.rate(motion, &motion.plus(0.5 * impulse, &first), impulse);
        Velocities { velocity: velocity.with_x(velocity.x.max(MIN_GAIN)), spin }
    }
}

/// Applies the collision; `[nose, cloth]` are the coefficients of friction, `[sine, cosine]` those of the nose's elevation, `n` is the
/// normal into the table. Returns the impulse per mass along the line of impact, m/s.
pub(super) fn collide(
    radius: f64,
    restitution: f64,
    [nose, cloth]: [f64; 2],
    [sine, cosine]: [f64; 2],
    n: DVec2,
    ball: &mut BallState,
) -> f64 {
    let approach = -ball.velocity.dot(n);
    if approach <= 0.0 {
        return approach;
    }
    let t = n.perp();
    let into = |v: DVec2| DVec2::new(v.dot(n), v.dot(t));
    let spin = radius * into(ball.spin.truncate()).extend(ball.spin.z);
    let mut motion = Velocities { velocity: into(ball.velocity), spin };
    let impulse = integrate(&Constants { nose, cloth, sine, cosine }, restitution, &mut motion, STEPS);
    let Velocities { velocity, spin } = motion;
    let spin = spin / radius;
    ball.velocity = velocity.x * n + velocity.y * t;
    ball.spin = (spin.x * n + spin.y * t).extend(spin.z);
    impulse
}

/// Integrates an impact of an approaching ball, with `steps` steps each for compression and restitution. Returns the impulse per mass.
fn integrate(law: &Constants, restitution: f64, motion: &mut Velocities, steps: u32) -> f64 {
    // Work along the line of impact is the mean speed times the impulse. The speed is v_n cos α; here without the factor cos α.
    let (mut impulse, mut work) = (0.0, 0.0);
    // Increase of the normal velocity per unit of impulse.
    let mut gain = law.cosine;
    for left in (1..=steps).rev() {
        let approach = -motion.velocity.x;
        let planned = approach / (gain * f64::from(left));
        let rate = law.step(motion, planned);
        gain = rate.velocity.x;
        // The last step ends when the normal velocity is zero.
        let part = if left == 1 { approach / gain } else { planned.min(approach / gain) };
        let next = motion.plus(part, &rate);
        work -= 0.5 * (motion.velocity.x + next.velocity.x) * part;
        impulse += part;
        *motion = next;
        if motion.velocity.x >= 0.0 {
            break;
        }
    }
    let mut owed = restitution * restitution * work;
    for left in (1..=steps).rev() {
        let slow = motion.velocity.x.max(0.0);
        // Impulse that returns the owed work at a constant rate `gain`.
        let until = |gain: f64| 2.0 * owed / (slow + (slow * slow + 2.0 * gain * owed).sqrt());
        let planned = until(gain) / f64::from(left);
        if planned.is_nan() || planned <= 0.0 {
            break;
        }
        let rate = law.step(motion, planned);
        gain = rate.velocity.x;
        let part = if left == 1 { until(gain) } else { planned.min(until(gain)) };
        let next = motion.plus(part, &rate);
        owed -= 0.5 * (motion.velocity.x + next.velocity.x) * part;
        impulse += part;
        *motion = next;
    }
    impulse
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{RailModel, max_sliding_friction};
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    fn law() -> Constants {
        let sine: f64 = 0.202;
        Constants { nose: 0.213, cloth: 0.205, sine, cosine: (1.0 - sine * sine).sqrt() }
    }

    fn after(start: &Velocities, steps: u32) -> Velocities {
        let mut motion = *start;
        integrate(&law(), 0.889, &mut motion, steps);
        motion
    }

    #[test]
    fn few_steps_meet_the_stated_accuracy_and_more_converge() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
        // Balls that approach at 1 m/s; every second one rolls.
        let starts: Vec<Velocities> = (0..400)
            .map(|index| {
                let mut number = |wide: f64| wide * (2.0 * rng.random::<f64>() - 1.0);
                let velocity = DVec2::new(-1.0, number(2.0));
                let roll = DVec3::new(-velocity.y, velocity.x, number(2.0));
                let other = DVec3::new(number(1.0), number(1.5) + 0.5, 0.0);
                Velocities { velocity, spin: if index % 2 == 0 { roll } else { roll + other } }
            })
            .collect();
        let exact: Vec<Velocities> = starts.iter().map(|start| after(start, 4096)).collect();
        let errors = |steps: u32| {
            let off = |(start, exact): (&Velocities, &Velocities)| {
                let there = after(start, steps);
                there.velocity.distance(exact.velocity) + there.spin.distance(exact.spin)
            };
            let mut errors: Vec<f64> = starts.iter().zip(&exact).map(off).collect();
            errors.sort_by(f64::total_cmp);
            [200, 360, 399].map(|rank| errors[rank])
        };
        let [median, most, worst] = errors(STEPS);
        assert!(median < 5e-4 && most < 3e-3 && worst < 0.05, "{median:e} {most:e} {worst:e}");
        let [finer, fine, least] = errors(64);
        assert!(finer < 3e-5 && fine < 1e-4 && least < 5e-3, "{finer:e} {fine:e} {least:e}");
    }

    #[test]
    fn many_steps_converge_to_explicit_friction_without_sticking() {
        let (law, e) = (law(), 0.889);
        // Explicit tiny steps with friction against the slip at their start; while the nose should stick, the slip oscillates about zero.
        let explicit = |start: &Velocities| {
            let (mut motion, mut work, mut done) = (*start, 0.0, 0.0);
            let (size, mut owed) = (1e-5, f64::INFINITY);
            while owed > 0.0 {
                let Velocities { velocity: v, spin: w } = motion;
                let below = DVec2::new(v.x - w.y, v.y + w.x);
                let (slip, drag) = (law.slip(&motion).normalize_or_zero(), -law.cloth * below.normalize_or_zero());
                let friction = -law.nose * slip;
                let drag = (law.sine - friction.y * law.cosine).max(0.0) * drag;
                let rate = Velocities {
                    velocity: DVec2::new(law.cosine + friction.y * law.sine + drag.x, friction.x + drag.y),
                    spin: 2.5
                        * DVec3::new(drag.y - friction.x * law.sine, friction.y - drag.x, -friction.x * law.cosine),
                };
                let next = motion.plus(size, &rate);
                let share = 0.5 * (motion.velocity.x + next.velocity.x) * size;
                if motion.velocity.x < 0.0 {
                    work -= share;
                } else {
                    done += share;
                    owed = e * e * work - done;
                }
                motion = next;
            }
            motion
        };
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
        for _ in 0..20 {
            let mut number = |wide: f64| wide * (2.0 * rng.random::<f64>() - 1.0);
            let start = Velocities {
                velocity: DVec2::new(-1.0, number(2.0)),
                spin: DVec3::new(number(2.0), number(2.0), number(2.0)),
            };
            let (ours, slow) = (after(&start, 4096), explicit(&start));
            let off = ours.velocity.distance(slow.velocity) + ours.spin.distance(slow.spin);
            assert!(off < 2e-3, "{off:e}");
        }
    }

    #[test]
    fn every_ball_leaves_the_rail_without_energy_gain() {
        let energy = |motion: &Velocities| motion.velocity.length_squared() + 0.4 * motion.spin.length_squared();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(9);
        // Up to the limits of a table: cloth, friction and height of the nose, restitution.
        for index in 0..40_000_u32 {
            let mut number = |wide: f64| wide * (2.0 * rng.random::<f64>() - 1.0);
            let sine = (0.3 + number(0.35)).clamp(0.0, 0.6);
            let held = Constants {
                nose: (0.5 + number(0.6)).clamp(0.0, 0.999),
                cloth: (0.45 + number(0.45)).clamp(0.0, max_sliding_friction(RailModel::Mathavan)),
                sine,
                cosine: (1.0 - sine * sine).sqrt(),
            };
            let velocity = DVec2::new(-1.0, number([0.1, 1.0, 3.0, 10.0][index as usize % 4]));
            let wide = [0.1, 1.0, 3.0, 10.0, 50.0][index as usize % 5];
            let roll = if index % 3 == 0 { DVec3::new(-velocity.y, velocity.x, 0.0) } else { DVec3::ZERO };
            let mut motion = Velocities { velocity, spin: roll + DVec3::new(number(wide), number(wide), number(wide)) };
            let (before, restitution) = (energy(&motion), (0.8 + number(0.3)).min(1.0));
            integrate(&held, restitution, &mut motion, STEPS);
            assert!(motion.velocity.x >= 0.0, "{index}: {}", motion.velocity);
            assert!(energy(&motion) <= before * (1.0 + 1e-12), "{index}: {} of {before}", energy(&motion));
        }
    }

    #[test]
    fn without_friction_restitution_reduces_the_normal_speed() {
        // Without friction, the speed is reduced by the factor e alone.
        let smooth = Constants { nose: 0.0, cloth: 0.0, ..law() };
        let mut motion = Velocities { velocity: DVec2::new(-1.5, 0.7), spin: DVec3::new(0.1, 0.2, 0.3) };
        let impulse = integrate(&smooth, 0.889, &mut motion, STEPS);
        assert!(motion.velocity.distance(DVec2::new(1.5 * 0.889, 0.7)) < 1e-12);
        assert!((impulse - 1.5 * 1.889 / smooth.cosine).abs() < 1e-12 && motion.spin == DVec3::new(0.1, 0.2, 0.3));
    }
}
