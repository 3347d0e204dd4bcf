//! Impact at the height of the nose, above the ball's centre: the geometry of Han, "Dynamics in carom and three cushion
//! billiards" (2005), with the impulse in closed form.
//!
//! With `d` the unit vector from the ball's centre to the nose, `d = -n cos α + z sin α`, `sin α = (h - R)/R`, the impulse
//! along `d` is `P/m = (1 + e) v·d`. The contact's slip `S` is `v + R ω×d` without its part along `d`, and the friction
//! `J/m = -f S`. A ball on the cloth keeps its height: what presses it down the cloth takes up.

use glam::{DVec2, DVec3};

use super::{
    super::{super::SpatialState, opening_in_space, raised},
    BallState,
};

/// How friction passes from slipping to sticking.
#[derive(Clone, Copy, Debug)]
pub(super) enum StickSlip {
    /// Coulomb's law up to no slip: `f = min(2/7, μ P / (m |S|))`.
    Sharp,
    /// `f = L tanh(μ P / (m L |S|))`, with the most `L` that the slip loses.
    Smooth {
        /// `L`, two sevenths where the contact just sticks.
        most: f64,
    },
}

impl StickSlip {
    /// The friction's factor `f`, given `μ P/m` and the slip's size, m/s.
    #[inline(always)]
    fn factor(self, push: f64, slip: f64) -> f64 {
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
                // The hyperbolic tangent at half the price of the library's; beyond that it is one.
                let grown = libm::exp(2.0 * push / (most * slip));
                if grown < 1e17 { most * (grown - 1.0) / (grown + 1.0) } else { most }
            }
        }
    }
}

/// The collision of a ball in the air with a nose in the direction `d` from its centre, a unit vector; it leaves with the speed
/// `slowest` at least. Returns the speed of its approach, m/s, negative if there is none.
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
    let opening = opening_in_space(approach, restitution, slowest);
    let normal = approach + opening;
    let slip = across + radius * ball.spin.cross(d);
    let rub = -stick_slip.factor(friction * normal, slip.length()) * slip;
    ball.velocity += rub - normal * d + raised(opening, slowest, across + rub, -d);
    ball.spin += 2.5 / radius * d.cross(rub);
    approach
}

/// Velocity and spin after the collision; `[sine, cosine]` of the nose's height, `n` the normal into the table. Returns
/// `P/m` and the speed with which the ball would climb, were it free to, both m/s.
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
    // The slip along t, and along n sin α + z cos α, which both stand across d.
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
