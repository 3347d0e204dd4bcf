//! Impact at the height of the nose, above the ball's centre: the geometry of Han, "Dynamics in carom and three cushion
//! billiards" (2005), with the impulse in closed form.
//!
//! With `d` the unit vector from the ball's centre to the nose, `d = -n cos α + z sin α`, `sin α = (h - R)/R`, the impulse along `d` is
//! `P/m = (1 + e) v·d`. The slip `S` of the contact is `v + R ω×d` without its component along `d`. The friction impulse is `J/m = -f S`. A
//! ball on the cloth keeps its height: the cloth absorbs the downward part of the impulse.

use glam::{DVec2, DVec3};

use super::{
    super::{super::SpatialState, separation_correction, separation_speed},
    BallState,
};

/// Transition of friction from slip to stick.
#[derive(Clone, Copy, Debug)]
pub(super) enum StickSlip {
    /// Coulomb friction up to the no-slip limit: `f = min(2/7, μ P / (m |S|))`.
    Sharp,
    /// `f = L tanh(μ P / (m L |S|))`, with `L` the upper limit of `f`.
    Smooth {
        /// `L`; 2/7 removes the slip exactly.
        most: f64,
    },
}

impl StickSlip {
    /// Returns the factor `f` for `μ P/m` and the magnitude of the slip, both m/s.
    #[inline(always)]
    pub(super) fn factor(self, push: f64, slip: f64) -> f64 {
        // Without slip there is no friction.
        if slip <= 0.0 {
            return 0.0;
        }
        match self {
            Self::Sharp => {
                let slips = push / slip;
                if slips < 2.0 / 7.0 { slips } else { 2.0 / 7.0 }
            }
            Self::Smooth { most } => {
                // Hyperbolic tangent at half the cost of the library function; it equals one beyond this bound.
                let grown = libm::exp(2.0 * push / (most * slip));
                if grown < 1e17 { most * (grown - 1.0) / (grown + 1.0) } else { most }
            }
        }
    }
}

/// Applies the collision of a ball in the air with a nose in the direction `d` from its centre, a unit vector; the ball leaves at least at
/// the speed `slowest`, m/s. Returns its approach speed, m/s, which is negative if it does not approach.
pub(super) fn collide_in_space(
    radius: f64,
    [restitution, friction, slowest]: [f64; 3],
    stick_slip: StickSlip,
    d: DVec3,
    ball: &mut SpatialState,
) -> f64 {
    let approach = ball.velocity.dot(d);
    if approach < 0.0 {
        return approach;
    }
    let across = ball.velocity - approach * d;
    let opening = separation_speed(approach, restitution, slowest);
    let normal = approach + opening;
    let slip = across + radius * ball.spin.cross(d);
    let rub = -stick_slip.factor(friction * normal, slip.length()) * slip;
    ball.velocity += rub - normal * d + separation_correction(opening, slowest, across + rub, -d);
    ball.spin += 2.5 / radius * d.cross(rub);
    approach
}

/// Applies the collision of a ball on the cloth; `[sine, cosine]` of the nose's elevation, `n` the normal into the table. Returns `P/m` and
/// the speed at which the ball would climb if nothing held it, both m/s.
pub(super) fn collide(
    radius: f64,
    restitution: f64,
    friction: f64,
    [sine, cosine]: [f64; 2],
    stick_slip: StickSlip,
    n: DVec2,
    ball: &mut BallState,
) -> [f64; 2] {
    let approach = -ball.velocity.dot(n);
    let normal = (1.0 + restitution) * cosine * approach;
    if normal <= 0.0 {
        return [normal, 0.0];
    }
    let t = n.perp();
    let [spin_n, spin_t] = [n, t].map(|axis| ball.spin.truncate().dot(axis));
    // Components of the slip along t and along n sin α + z cos α, both orthogonal to d.
    let slip_t = ball.velocity.dot(t) - radius * (cosine * ball.spin.z + sine * spin_n);
    let slip_up = radius * spin_t - sine * approach;
    let slip = (slip_t * slip_t + slip_up * slip_up).sqrt();
    let factor = stick_slip.factor(friction * normal, slip);
    let (along, up) = (-factor * slip_t, -factor * slip_up);
    ball.velocity += (normal * cosine + up * sine) * n + along * t;
    let lever = 2.5 / radius;
    ball.spin += DVec3::new(
        lever * (up * t.x - along * sine * n.x),
        lever * (up * t.y - along * sine * n.y),
        -lever * along * cosine,
    );
    [normal, up * cosine - normal * sine]
}
