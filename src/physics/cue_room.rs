//! Clearance of the cue: the lowest elevation at which it passes over the rails and the balls behind the cue ball.
//!
//! **The cue** is a cone with a flat end. Its axis starts at the contact point of the tip and has the direction `d = (-cos theta cos phi,
//! -cos theta sin phi, sin theta)`. At the distance `s` along the axis, up to the cue's length, its radius is `r(s) = r0 + k s`. The
//! contact point is at `R (a l + b z - c f)` from the ball's centre, with `f` the direction of the stroke, `l` the direction to its left
//! and `c = sqrt(1 - a² - b²)`. As in thesis equations 9 and 16, the point does not move when the cue is raised. The half-angle `γ` of the
//! cone is given by `tan γ = k`.
//!
//! **A rail** is the space below the nose's height, from the nose to the outer edge, along its whole length and beyond. The nose is at the
//! distance `δ` behind the contact point and at the height `H` above it. `e` is the component, towards the nose, of the cue's horizontal
//! direction. A plane through the nose that rises outwards at the angle ψ separates cue and rail if the contact point is `r0 cos γ` above
//! it,
//!
//! > `δ sin ψ - H cos ψ = r0 cos γ`,
//!
//! and the axis leaves it at an angle of `γ` or more,
//!
//! > `sin theta cos ψ - e cos theta sin ψ >= sin γ`.
//!
//! For an infinite cone this is exact: at equality the plane touches it along a line. If ψ is negative, the rail's outer edge replaces the
//! nose, or else the horizontal plane does. The flat end matters only if the nose is nearer to the contact point than the tip's radius.
//! Then the horizontal plane is used, which the cue clears if its whole end is above the nose: `r0 cos theta <= -H`. This is a bound: a
//! slightly lower cue might fit.
//!
//! **A ball** is a sphere at `o` from the contact point. It touches the cone if the foot of the perpendicular from its centre to the axis
//! is at a root of `|o|² - s² = (R / cos γ + r0 + k s)²`. The cue passes above it while the foot stays below the larger root,
//!
//! > `o·d <= s₊`.
//!
//! This is exact, too, with two exceptions. A cue that would pass beside a ball, below its centre, is treated as blocked, so that every
//! elevation above the lowest one is possible. So is a tip that is nearer to another ball than the tip's own radius.
//!
//! Both conditions have the form `x sin theta - y cos theta >= z`, with the solution `theta = atan2(y, x) + asin(z / sqrt(x² + y²))`.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::CueInputs;
use crate::table::{BALL_NAMES, Layout, Rail, Room, Table};

/// Elevation steps per degree: a cue is raised in hundredths of a degree, the precision at which elevations are displayed.
const STEPS: f64 = 100.0;

/// The obstacle that keeps the cue from being lower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// A cushion behind the cue ball.
    Rail(Rail),
    /// An object ball behind the cue ball, 1 or 2.
    Ball(usize),
}

impl std::fmt::Display for Obstacle {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Rail(rail) => write!(formatter, "the {} rail", rail.name()),
            Self::Ball(ball) => write!(formatter, "the {} ball", BALL_NAMES[*ball]),
        }
    }
}

/// The lowest elevation from which on every steeper one is possible. (A level cue below a ball may be possible, too.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastElevation {
    /// The elevation, rad.
    pub theta: f64,
    /// The obstacle below the cue; `None` if the cue can be level.
    pub over: Option<Obstacle>,
}

/// Error if an obstacle blocks the cue at every elevation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the cue has no room for this stroke at any elevation: {obstacle} is in the way; strike higher or from elsewhere"
)]
pub struct NoRoom {
    /// The blocking obstacle.
    pub obstacle: Obstacle,
}

/// Returns the lowest elevation for the tip offset and direction of a stroke; the stroke's own elevation is ignored. Level on a table
/// without a `[room]` section.
///
/// # Errors
/// Fails if the cue is blocked at every elevation below the vertical.
pub fn least_elevation(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<LeastElevation, NoRoom> {
    let mut least = LeastElevation { theta: 0.0, over: None };
    let Some(stick) = Stick::of(table, layout, cue) else { return Ok(least) };
    for (obstacle, condition) in stick.conditions(layout) {
        let theta = condition.least().ok_or(NoRoom { obstacle })?;
        if theta > least.theta {
            least = LeastElevation { theta, over: Some(obstacle) };
        }
    }
    Ok(least)
}

/// Whether the cue has clearance for the stroke at its own elevation.
pub fn has_room(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    Stick::of(table, layout, cue).is_none_or(|stick| {
        let (sin, cos) = libm::sincos(cue.theta);
        stick.conditions(layout).all(|(_, condition)| condition.is_met(sin, cos))
    })
}

/// Returns the stroke itself if the cue has clearance. Otherwise returns it with the cue raised to the lowest possible elevation, rounded
/// up to a hundredth of a degree.
///
/// # Errors
/// Fails if the cue is blocked at every elevation below the vertical.
pub fn raise_to_clear(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<CueInputs, NoRoom> {
    if has_room(table, layout, cue) {
        return Ok(*cue);
    }
    let LeastElevation { theta, over } = least_elevation(table, layout, cue)?;
    // A millionth of a step absorbs the rounding of degrees.
    let raised = ((STEPS * theta.to_degrees() + 1e-6).ceil() / STEPS).to_radians();
    match over {
        Some(obstacle) if raised >= FRAC_PI_2 => Err(NoRoom { obstacle }),
        // If only a rounding error blocked the cue, the elevation stays.
        _ => Ok(CueInputs { theta: raised.max(cue.theta), ..*cue }),
    }
}

/// The cue in the direction of a stroke, at an unknown elevation.
struct Stick {
    room: Room,
    /// Ball radius, m.
    radius: f64,
    /// Vector from the table's centre to the contact point of the tip, m; heights are relative to the balls' centres.
    point: DVec3,
    /// Horizontal unit vector from the ball to the butt of the cue.
    back: DVec2,
    /// Half of the playing area, m.
    half: DVec2,
    /// Increase of the cue's radius along its axis, m per m, and sine and cosine of the cone's half-angle.
    growth: f64,
    sin: f64,
    cos: f64,
}

/// Condition on the elevation that an obstacle imposes.
#[derive(Clone, Copy, Debug)]
enum Condition {
    /// `x sin theta - y cos theta >= z`.
    Above { x: f64, y: f64, z: f64 },
    /// The tip's lower edge may be below the contact point by at most this share of its radius: `cos theta <= share`. The underside must
    /// not fall towards the butt: `sin theta >= rise`.
    Clear { share: f64, rise: f64 },
    /// No elevation satisfies the condition.
    Never,
}

impl Condition {
    #[inline]
    fn is_met(self, sin_theta: f64, cos_theta: f64) -> bool {
        match self {
            Self::Above { x, y, z } => x * sin_theta - y * cos_theta >= z,
            Self::Clear { share, rise } => cos_theta <= share && sin_theta >= rise,
            Self::Never => false,
        }
    }

    /// Returns the lowest elevation that satisfies the condition, rad, at least zero; `None` if there is none below the vertical.
    fn least(self) -> Option<f64> {
        let least = match self {
            Self::Above { x, y, z } => {
                let share = z / libm::hypot(x, y);
                // Below -1, every elevation satisfies the condition.
                (share <= 1.0).then(|| if share <= -1.0 { 0.0 } else { libm::atan2(y, x) + libm::asin(share) })
            }
            Self::Clear { share, rise } => Some(libm::acos(share.min(1.0)).max(libm::asin(rise))),
            Self::Never => None,
        };
        least.map(|theta| theta.max(0.0)).filter(|theta| *theta < FRAC_PI_2)
    }
}

impl Stick {
    /// Returns `None` on a table without a `[room]` section.
    #[inline]
    fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Self> {
        let room = table.room?;
        let (a, b) = (cue.a, cue.b);
        let c = (1.0 - cue.tip_offset_squared()).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(cue.phi);
        let forward = DVec2::new(cos, sin);
        let place = layout.balls[0] + table.radius * (a * forward.perp() - c * forward);
        let growth = 0.5 * room.taper;
        let cos = 1.0 / (1.0 + growth * growth).sqrt();
        Some(Self {
            room,
            radius: table.radius,
            point: place.extend(table.radius * b),
            back: -forward,
            half: 0.5 * DVec2::new(table.length, table.width),
            growth,
            sin: growth * cos,
            cos,
        })
    }

    /// Returns the condition of every obstacle that the cue can reach.
    fn conditions(&self, layout: &Layout) -> impl Iterator<Item = (Obstacle, Condition)> {
        let rails = Rail::ALL.into_iter().filter_map(|rail| Some((Obstacle::Rail(rail), self.over_rail(rail)?)));
        let balls = layout.balls.into_iter().enumerate().skip(1);
        rails.chain(balls.filter_map(|(ball, place)| Some((Obstacle::Ball(ball), self.over_ball(place)?))))
    }

    /// Returns the radius of the cue at its butt, m.
    fn butt(&self) -> f64 {
        0.5 * self.room.tip + self.growth * self.room.length
    }

    /// Returns `None` for a rail that the cue cannot reach or points away from.
    fn over_rail(&self, rail: Rail) -> Option<Condition> {
        let towards = -self.back.dot(rail.normal());
        let behind = rail.gap(self.half, self.point.truncate());
        if behind >= towards.max(0.0) * self.room.length + self.butt() {
            return None;
        }
        let tip = 0.5 * self.room.tip;
        let above = self.room.nose - self.radius - self.point.z;
        // The plane that touches the infinite cone: outward slope `rise / run`, both scaled by the squared distance.
        let plane = |behind: f64| {
            let squared = behind * behind + above * above;
            let touch = tip * self.cos;
            let free = squared - touch * touch;
            (free >= 0.0).then(|| {
                let free = free.sqrt();
                (behind * touch + above * free, behind * free - above * touch, squared)
            })
        };
        let mut found = plane(behind);
        if found.is_some_and(|(rise, ..)| rise < 0.0) {
            // The cue would slope down over the nose, so the outer edge is the obstacle.
            found = plane(behind + self.room.rail).filter(|(rise, ..)| *rise <= 0.0);
        }
        Some(match found {
            Some((rise, run, squared)) if run >= 0.0 => {
                Condition::Above { x: run, y: towards * rise, z: self.sin * squared }
            }
            _ if above < 0.0 => Condition::Clear { share: -above / tip, rise: self.sin },
            _ => Condition::Never,
        })
    }

    /// Returns `None` for a ball that the cue cannot reach or that is ahead of it.
    fn over_ball(&self, place: DVec2) -> Option<Condition> {
        let apart = place - self.point.truncate();
        let (behind, above) = (apart.dot(self.back), -self.point.z);
        if behind - self.radius >= self.room.length + self.butt() {
            return None;
        }
        let reach = self.radius / self.cos + 0.5 * self.room.tip;
        if behind <= 0.0 {
            // The foot is at `above` at most, and the axis is at least as far from the ball as the contact point is horizontally. Only a
            // tip near the cue ball's edge can touch the ball.
            let is_near = apart.length() < reach + self.growth * above;
            return (above > 0.0 && is_near).then_some(Condition::Never);
        }
        // Roots of (1 + k²) s² + 2 k reach s + reach² - |o|².
        let squared = 1.0 + self.growth * self.growth;
        let half = self.growth * reach;
        let rest = reach * reach - (apart.length_squared() + above * above);
        if rest > 0.0 {
            return Some(Condition::Never);
        }
        let root = ((half * half - squared * rest).sqrt() - half) / squared;
        // The foot is never further along the axis than the ball's distance.
        (root * root < behind * behind + above * above).then_some(Condition::Above { x: -above, y: behind, z: -root })
    }
}

#[cfg(test)]
pub mod tests;
