//! Impact at the height of the nose, integrated over its impulse: Mathavan, Jackson and Parkin, "A theoretical analysis of
//! billiard ball dynamics under cushion impacts" (2010).
//!
//! While the impulse `P` along the line of the impact grows, the nose's friction acts on the ball with `μ dP` against the slip there,
//! and the ball, pressed into the cloth by `dN = (sin α + μ cos α · slip's upward share) dP`, is rubbed by the cloth with
//! `μ_s dN` against its slip below. Compression ends when the ball no longer approaches; restitution gives back the
//! share `e²` of the work that compression took (Stronge).

use glam::{DVec2, DVec3};

use super::BallState;

/// Steps of the integration for compression, and about as many for restitution: the error is some 1e-7 of the speeds where
/// contacts slip, and a thousandth of them where one stays at the end of its slip, which the steps cross to and fro.
const STEPS: f64 = 400.0;

/// Velocity and spin in the frame of the impact: along the normal into the table, along the cushion, and up.
#[derive(Clone, Copy)]
struct Motion {
    velocity: DVec2,
    spin: DVec3,
}

impl Motion {
    fn plus(&self, share: f64, rate: &Self) -> Self {
        Self { velocity: self.velocity + share * rate.velocity, spin: self.spin + share * rate.spin }
    }
}

/// What the impact is about: radius, friction of nose and cloth, sine and cosine of the nose's height.
struct Law {
    radius: f64,
    nose: f64,
    cloth: f64,
    sine: f64,
    cosine: f64,
}

impl Law {
    /// Change of the motion for each unit of impulse per mass along the line of the impact.
    fn rate(&self, motion: &Motion) -> Motion {
        let Self { radius, nose, cloth, sine, cosine } = *self;
        let Motion { velocity: v, spin: w } = *motion;
        let at_nose = DVec2::new(v.y - radius * (cosine * w.z + sine * w.x), radius * w.y + sine * v.x);
        let friction = -nose * at_nose.normalize_or_zero();
        // Upwards the nose lifts with its friction and presses down with its normal force.
        let pressed = (sine - friction.y * cosine).max(0.0);
        let below = DVec2::new(v.x - radius * w.y, v.y + radius * w.x);
        let drag = -cloth * pressed * below.normalize_or_zero();
        let lever = 2.5 / radius;
        Motion {
            velocity: DVec2::new(cosine + friction.y * sine + drag.x, friction.x + drag.y),
            spin: lever * DVec3::new(-friction.x * sine + drag.y, friction.y - drag.x, -friction.x * cosine),
        }
    }

    /// One step of Heun's method.
    fn step(&self, motion: &Motion, impulse: f64) -> Motion {
        let first = self.rate(motion);
        let second = self.rate(&motion.plus(impulse, &first));
        motion.plus(0.5 * impulse, &first).plus(0.5 * impulse, &second)
    }
}

/// Velocity and spin after the collision; `[nose, cloth]` the coefficients of friction, `[sine, cosine]` of the nose's
/// height, `n` the normal into the table. Returns the impulse per mass along the line of the impact, m/s.
pub(super) fn collide(
    radius: f64,
    restitution: f64,
    [nose, cloth]: [f64; 2],
    [sine, cosine]: [f64; 2],
    n: DVec2,
    ball: &mut BallState,
) -> f64 {
    integrate(&Law { radius, nose, cloth, sine, cosine }, restitution, n, ball, STEPS)
}

/// The same in about `steps` steps for compression and for restitution.
fn integrate(law: &Law, restitution: f64, n: DVec2, ball: &mut BallState, steps: f64) -> f64 {
    let cosine = law.cosine;
    let t = n.perp();
    let into = |v: DVec2| DVec2::new(v.dot(n), v.dot(t));
    let mut motion = Motion { velocity: into(ball.velocity), spin: into(ball.spin.truncate()).extend(ball.spin.z) };
    let approach = -motion.velocity.x;
    if approach <= 0.0 {
        return -approach.abs();
    }
    let step = approach / steps;
    let (mut impulse, mut work) = (0.0, 0.0);
    // Work along the line of the impact for a step: the mean speed times the impulse, the speed being -v_n cos α.
    let worked =
        |before: &Motion, after: &Motion, step: f64| -0.5 * (before.velocity.x + after.velocity.x) * cosine * step;
    // A nose and a cloth that could hold the ball for ever do not exist: the guard is ten times any real impulse.
    while motion.velocity.x < 0.0 && impulse < 20.0 * approach {
        let next = law.step(&motion, step);
        let part = if next.velocity.x > 0.0 { motion.velocity.x / (motion.velocity.x - next.velocity.x) } else { 1.0 };
        let next = if part < 1.0 { law.step(&motion, part * step) } else { next };
        work += worked(&motion, &next, part * step);
        impulse += part * step;
        motion = next;
        if part < 1.0 {
            break;
        }
    }
    let mut owed = restitution * restitution * work;
    while owed > 0.0 && impulse < 40.0 * approach {
        let next = law.step(&motion, step);
        let given = -worked(&motion, &next, step);
        if given >= owed {
            // The speed grows about evenly within a step.
            let (slow, fast) = (motion.velocity.x.max(0.0), next.velocity.x);
            let gain = (fast - slow) / step;
            let wanted = owed / cosine;
            let part = 2.0 * wanted / (slow + (slow * slow + 2.0 * gain * wanted).sqrt());
            motion = law.step(&motion, part.min(step));
            impulse += part.min(step);
            break;
        }
        owed -= given;
        impulse += step;
        motion = next;
    }
    ball.velocity = motion.velocity.x * n + motion.velocity.y * t;
    ball.spin = (motion.spin.x * n + motion.spin.y * t).extend(motion.spin.z);
    impulse
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How far speeds at the end are from those with 64 times as many steps, m/s, for an impact at 1.5 m/s.
    fn error(steps: f64, start: &BallState) -> f64 {
        let sine: f64 = 0.19;
        let law = Law { radius: 0.030_75, nose: 0.213, cloth: 0.205, sine, cosine: (1.0 - sine * sine).sqrt() };
        let after = |steps: f64| {
            let mut ball = *start;
            integrate(&law, 0.889, DVec2::NEG_X, &mut ball, steps);
            ball
        };
        let (coarse, fine) = (after(steps), after(64.0 * STEPS));
        coarse.velocity.distance(fine.velocity) + law.radius * coarse.spin.distance(fine.spin)
    }

    #[test]
    fn the_integrated_impulse_converges_as_its_steps_are_halved() {
        let ball = |velocity: [f64; 2], spin: [f64; 3]| BallState {
            position: DVec2::ZERO,
            velocity: DVec2::from_array(velocity),
            spin: DVec3::from_array(spin),
        };
        let slipping = [
            ball([1.2, 0.9], [-20.0, 35.0, 40.0]),
            ball([1.0, 1.0], [0.0, 0.0, 120.0]),
            ball([1.0, -1.0], [-90.0, -60.0, 150.0]),
        ];
        for start in slipping {
            let [coarse, middle, fine] = [0.25, 0.5, 1.0].map(|share| error(share * STEPS, &start));
            assert!(coarse > 3.5 * middle && middle > 3.5 * fine && fine < 3e-7, "{coarse:e}, {middle:e}, {fine:e}");
        }
        // One that rolls straight at the rail, whose slip on the cloth is none and remains about that.
        let rolling = error(STEPS, &ball([1.5, 0.0], [0.0, 1.5 / 0.030_75, 0.0]));
        assert!(rolling < 2e-3, "{rolling:e}");
    }
}
