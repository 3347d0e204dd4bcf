//! Collision detection for balls in the air: with the noses of the cushions, the rails behind them, and other balls.
//!
//! Between two landings, a flight is a parabola in space, so that every gap is a polynomial of degree four. A trajectory is searched
//! landing by landing, as long as anything is within its reach.

use glam::DVec3;

use super::{
    Constants, Rail, Segment,
    ball_ball::Triangle,
    hops::{Arc, Hops},
    predict::{lesser, polynomial_closes, shifted, squared_gap, travel},
    roots::first_crossing,
    savings::Savings,
};
use crate::physics::{Cushion, ImpactLaw, Motion};

/// Largest number of landings that are searched: after it, hops are lower than an atom even on the liveliest accepted cloth.
const MAX_LANDINGS: u32 = 4000;

/// The nose of a cushion as a line, for collisions in the air.
#[derive(Clone, Copy)]
pub struct Nose {
    /// Height above the centre of a ball on the cloth, m.
    height: f64,
    /// Horizontal distance from the centre of a ball on the cloth that touches the nose, m.
    beyond: f64,
}

impl Nose {
    /// Returns the nose of a cushion.
    pub fn of(cushion: &Cushion, radius: f64) -> Self {
        let [sine, cosine] = cushion.nose;
        Self { height: radius * sine, beyond: radius * cosine }
    }

    /// Returns the vector from a ball's centre to the nose of `rail`, m. If it points into the table, the ball has passed over the nose.
    pub fn vector_from(&self, constants: &Constants, rail: Rail, centre: DVec3) -> DVec3 {
        let n = rail.normal();
        let inwards = rail.gap(constants.reach, centre.truncate()) + self.beyond;
        (-inwards * n).extend(self.height - centre.z)
    }

    /// Returns the largest horizontal cushion gap at which a ball in the air can touch the nose, if it is at most `top` above the cloth, m.
    /// The nose protrudes most at its own height.
    fn margin(&self, radius: f64, top: f64) -> f64 {
        lesser(radius - self.beyond, top * self.height.max(0.0) / self.beyond)
    }

    /// Returns when a ball on `arc` hits the nose of `rail` or lands on the rail behind it, s after the arc's start; `None` if not before
    /// its end.
    fn meets(&self, constants: &Constants, arc: &Arc, gravity: f64, rail: Rail) -> Option<f64> {
        let (radius, tolerance) = (constants.radius, &constants.tolerance);
        let duration = arc.end - arc.begin;
        let (climb, n) = (arc.velocity.z, rail.normal());
        let approach = -arc.velocity.truncate().dot(n);
        let gap = rail.gap(constants.reach, arc.position.truncate());
        if gap - (approach * duration).max(0.0) > self.margin(radius, top(arc, gravity)) + tolerance.certain_gap {
            return None;
        }
        // Horizontal distance to the nose, its height above the ball, and the squared distance minus R², without cancellation.
        let (beside, below) = (gap + self.beyond, self.height - arc.position.z);
        let c = [
            gap * (gap + 2.0 * self.beyond) - arc.position.z * (self.height + below),
            -2.0 * (beside * approach + below * climb),
            approach * approach + climb * climb + below * gravity,
            -climb * gravity,
            0.25 * gravity * gravity,
        ];
        let ahead = polynomial_closes(tolerance, &c, 2.0 * radius, duration);
        if ahead.is_some_and(|time| beside > approach * time) {
            return ahead;
        }
        // The ball passes over the nose and lands behind it.
        let above = climb * climb - 2.0 * gravity * (below + radius);
        let down = (climb + above.max(0.0).sqrt()) / gravity;
        (above >= 0.0 && (0.0..=duration).contains(&down) && beside <= approach * down).then_some(down)
    }
}

/// Returns the greatest height that an arc's energy allows, m; no later arc is higher.
fn top(arc: &Arc, gravity: f64) -> f64 {
    arc.position.z + 0.5 * arc.velocity.z * arc.velocity.z / gravity
}

/// Whether a ball certainly stays away from the nose of `rail` on this arc and all later ones, in the `rest` of the time.
fn stays_away(constants: &Constants, nose: &Nose, hops: &Hops, arc: &Arc, rest: f64, rail: Rail) -> bool {
    let n = rail.normal();
    let approach = -lesser(arc.velocity.truncate().dot(n), hops.last_velocity.dot(n));
    let nearest = rail.gap(constants.reach, arc.position.truncate()) - rest * approach.max(0.0);
    nearest > nose.margin(constants.radius, top(arc, hops.cloth.gravity)) + constants.tolerance.certain_gap
}

/// Returns when and at which cushion the ball of a flying `segment` hits the nose or lands behind it, s after the segment's start.
pub fn next_nose_impact(constants: &Constants, law: &ImpactLaw, segment: &Segment) -> Option<(f64, Rail)> {
    let hops = segment.hops()?;
    let duration = hops.duration;
    for landings in 0..MAX_LANDINGS {
        let arc = hops.arc(landings);
        let rest = duration - arc.begin;
        // The last hops are shorter than the resolution of time.
        if rest <= 0.0 || arc.end <= arc.begin {
            return None;
        }
        let (mut first, mut is_away): (Option<(f64, Rail)>, bool) = (None, true);
        for rail in Rail::ALL {
            let nose = Nose::of(law.cushion(rail), constants.radius);
            if stays_away(constants, &nose, hops, &arc, rest, rail) {
                continue;
            }
            is_away = false;
            if let Some(time) = nose.meets(constants, &arc, hops.cloth.gravity, rail)
                && first.is_none_or(|(earliest, _)| time < earliest)
            {
                first = Some((time, rail));
            }
        }
        if let Some((time, rail)) = first {
            return Some((arc.begin + time, rail));
        }
        if is_away {
            return None;
        }
    }
    None
}

/// A piece of a trajectory: a polynomial in time.
struct Piece {
    /// Coefficients of the polynomial.
    course: [DVec3; 6],
    /// End of its validity, s since the search's start.
    ends: f64,
    /// In the air, the greatest speed along the cloth from now on, m/s; `None` on the cloth.
    fastest: Option<f64>,
}

impl Piece {
    /// Returns an upper bound of the distance along the cloth within `time`, m.
    fn farthest(&self, time: f64) -> f64 {
        self.fastest.map_or_else(|| travel(&self.course.map(DVec3::length), time), |fastest| fastest * time)
    }
}

/// A trajectory that is searched piece by piece.
struct Pieces<'a> {
    segment: &'a Segment,
    /// Start of the search, s since the segment's start.
    begin: f64,
    flight: Option<(&'a Hops, u32)>,
}

impl<'a> Pieces<'a> {
    fn new(segment: &'a Segment, now: f64) -> Self {
        let begin = now - segment.start;
        Self { segment, begin, flight: segment.hops().map(|hops| (hops, hops.landings(begin).min(MAX_LANDINGS))) }
    }

    /// Returns the piece as an expansion about `after` seconds since the search's start.
    fn piece(&self, after: f64) -> Piece {
        let Some((hops, landings)) = self.flight else {
            let on_cloth = shifted(self.segment, self.segment.start + self.begin + after);
            return Piece { course: on_cloth.map(|c| c.extend(0.0)), ends: f64::INFINITY, fastest: None };
        };
        let arc = hops.arc(landings);
        let since = self.begin + after - arc.begin;
        let fall = DVec3::new(0.0, 0.0, -0.5 * hops.cloth.gravity);
        let position = arc.position + since * (arc.velocity + since * fall);
        let velocity = arc.velocity + 2.0 * since * fall;
        // The last hops are shorter than the resolution of time.
        let ends = if arc.end > arc.begin { arc.end - self.begin } else { f64::INFINITY };
        let course = [position, velocity, fall, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO];
        Piece { course, ends, fastest: Some(hops.fastest(&arc)) }
    }
}

/// Whether one ball in the air certainly passes another one that is at rest.
fn passes_by(constants: &Constants, balls: [&Segment; 2], now: f64, horizon: f64) -> bool {
    let (flies, lies) = match balls {
        [one, other] if other.motion == Motion::Stationary => (one, other),
        [one, other] if one.motion == Motion::Stationary => (other, one),
        _ => return false,
    };
    let Some(hops) = flies.hops() else { return false };
    let state = hops.state_after(now - flies.start);
    let triangle = Triangle::between(state.position.truncate(), state.velocity.truncate(), hops.last_velocity, horizon);
    triangle.clears(lies.position, constants.diameter + constants.tolerance.certain_gap)
}

/// Returns when two balls collide, at least one of which is in the air, within `horizon` seconds of time `now`.
pub fn next_collision_in_space<S: Savings>(
    constants: &Constants,
    balls: [&Segment; 2],
    now: f64,
    horizon: f64,
) -> Option<f64> {
    if S::SEPARATED_COURSES && passes_by(constants, balls, now, horizon) {
        return None;
    }
    let mut balls = balls.map(|segment| Pieces::new(segment, now));
    let mut after = 0.0;
    while after < horizon {
        let [one, other] = [balls[0].piece(after), balls[1].piece(after)];
        let d: [DVec3; 6] = std::array::from_fn(|power| one.course[power] - other.course[power]);
        let rest = horizon - after;
        let reach = one.farthest(rest) + other.farthest(rest);
        if d[0].truncate().length() - constants.diameter > constants.tolerance.certain_gap + reach {
            return None;
        }
        let ends = one.ends.min(other.ends).min(horizon);
        if let Some(time) = meet(constants, &d, ends - after) {
            return Some(after + time);
        }
        if ends >= horizon || balls.iter().any(|ball| ball.flight.is_some_and(|(_, count)| count >= MAX_LANDINGS)) {
            return None;
        }
        for (ball, its) in balls.iter_mut().zip([one.ends, other.ends]) {
            if its <= ends
                && let Some((_, landings)) = &mut ball.flight
            {
                *landings += 1;
            }
        }
        after = ends.max(after);
    }
    None
}

/// Returns when two balls with the distance vector `d[0] + t d[1] + …` collide within `horizon` seconds.
fn meet(constants: &Constants, d: &[DVec3; 6], horizon: f64) -> Option<f64> {
    let (diameter, tolerance) = (constants.diameter, &constants.tolerance);
    let scale = 2.0 * diameter;
    let closing = d[0].length() - diameter;
    if horizon <= 0.0 || closing > tolerance.certain_gap + travel(&d.map(DVec3::length), horizon) {
        return None;
    }
    if d[3..].iter().all(|c| *c == DVec3::ZERO) {
        let [d, v, k, ..] = *d;
        let apart = d.length_squared() - diameter * diameter;
        let c = [2.0 * d.dot(v), v.length_squared() + 2.0 * d.dot(k), 2.0 * v.dot(k), k.length_squared()];
        if apart <= scale * tolerance.touching {
            return polynomial_closes(tolerance, &[apart, c[0], c[1], c[2], c[3]], scale, horizon);
        }
        let slope = [c[0], 2.0 * c[1], 3.0 * c[2], 4.0 * c[3]];
        let value = |t: f64| (d + t * (v + t * k)).length_squared() - diameter * diameter;
        let rounding = f64::EPSILON * diameter * diameter;
        return first_crossing(value, &slope, horizon, rounding);
    }
    polynomial_closes(tolerance, &squared_gap(d, DVec3::dot, diameter), scale, horizon)
}
