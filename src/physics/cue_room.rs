//! The room that the cue needs: how low it can be held over the rails and over balls behind the cue ball.
//!
//! **The cue** is a cone with a flat end: its axis leaves the point where the tip meets the ball along
//! `d = (-cos theta cos phi, -cos theta sin phi, sin theta)`, and at the way `s` along it, up to the cue's length, it has the
//! radius `r(s) = r0 + k s`. The point is `R (a l + b z - c f)` from the ball's centre, with `f` the direction of the
//! stroke, `l` the one to its left, `c = sqrt(1 - a² - b²)`: as thesis equations 9 and 16 have it, it does not move when the
//! cue is raised. With `tan γ = k` the cone's sides spread by `γ` from its axis.
//!
//! **A rail** is all that lies below the nose's height from the nose to the outer edge, in its whole length and beyond. The
//! nose is `δ` behind the point and `H` above it, and `e` is the share of the cue's horizontal course that goes towards it. The
//! plane through the nose that rises outwards by the angle ψ parts the two where the point is `r0 cos γ` above it,
//!
//! > `δ sin ψ - H cos ψ = r0 cos γ`,
//!
//! and the axis leaves it by `γ` or more,
//!
//! > `sin theta cos ψ - e cos theta sin ψ >= sin γ`.
//!
//! For a cone without ends that is exact: at equality the plane touches it along a line. Where ψ comes out negative, the
//! rail's outer edge stands in the nose's place, or the level plane. The flat end only counts where the nose is nearer to the
//! point than a tip's radius; then the level plane is taken, which a cue clears whose whole end stands above the nose:
//! `r0 cos theta <= -H`. That is a bound: a cue might have room a little lower.
//!
//! **A ball** is a sphere at `o` from the point. It touches the cone where the foot of its centre on the axis is at one of the
//! roots of `|o|² - s² = (R / cos γ + r0 + k s)²`; the cue has room above it while the foot stays below the larger root,
//!
//! > `o·d <= s₊`.
//!
//! That is exact too, but for two rulings: a cue that would slip in under a ball's middle, beside it, has no room, so that from
//! the least elevation on every steeper one can be played; nor has a tip that is nearer than its own radius to another ball.
//!
//! Both are `x sin theta - y cos theta >= z`, and solved by `theta = atan2(y, x) + asin(z / sqrt(x² + y²))`.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

use super::CueInputs;
use crate::table::{BALL_NAMES, Layout, Rail, Room, Table};

/// Steps to which a cue is raised, a degree: those in which people tell it.
const STEPS: f64 = 100.0;

/// What keeps the cue from being held lower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Obstacle {
    /// A cushion behind the cue ball.
    Rail(Rail),
    /// An object ball behind it, 1 or 2.
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

/// How low the cue can be held: there, and steeper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastElevation {
    /// The elevation, rad.
    pub theta: f64,
    /// What it passes over; `None` where the cue can be level.
    pub over: Option<Obstacle>,
}

/// The cue cannot be held at all: something is in its way at every elevation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the cue has no room for this stroke at any elevation: {obstacle} is in the way; strike higher or from elsewhere"
)]
pub struct NoRoom {
    /// What is in the way.
    pub obstacle: Obstacle,
}

/// How low the cue can be held for a stroke with this tip place and direction, whatever its elevation is; level on a
/// table that has no limits.
///
/// # Errors
/// Where the cue has no room at any elevation below the vertical.
pub fn least_elevation(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<LeastElevation, NoRoom> {
    let mut least = LeastElevation { theta: 0.0, over: None };
    let Some(stick) = Stick::of(table, layout, cue) else { return Ok(least) };
    for (obstacle, need) in stick.needs(layout) {
        let theta = need.least().ok_or(NoRoom { obstacle })?;
        if theta > least.theta {
            least = LeastElevation { theta, over: Some(obstacle) };
        }
    }
    Ok(least)
}

/// Whether the cue has room for a stroke as it is.
pub fn has_room(table: &Table, layout: &Layout, cue: &CueInputs) -> bool {
    Stick::of(table, layout, cue).is_none_or(|stick| {
        let (sin, cos) = libm::sincos(cue.theta);
        stick.needs(layout).all(|(_, need)| need.is_met(sin, cos))
    })
}

/// The stroke itself where the cue has room for it, else with the cue raised as far as it must be, to the next hundredth of a
/// degree.
///
/// # Errors
/// Where the cue has no room at any elevation below the vertical.
pub fn with_room(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<CueInputs, NoRoom> {
    if has_room(table, layout, cue) {
        return Ok(*cue);
    }
    let LeastElevation { theta, over } = least_elevation(table, layout, cue)?;
    // The millionth of a step is for the rounding of degrees.
    let raised = ((STEPS * theta.to_degrees() + 1e-6).ceil() / STEPS).to_radians();
    match over {
        Some(obstacle) if raised >= FRAC_PI_2 => Err(NoRoom { obstacle }),
        // What had no room for a rounding error has it now.
        _ => Ok(CueInputs { theta: raised.max(cue.theta), ..*cue }),
    }
}

/// The cue in the direction of a stroke, at an elevation that is still open.
struct Stick {
    room: Room,
    /// Ball radius, m.
    radius: f64,
    /// From the table's centre to the place where the tip meets the ball, m; heights are over the balls' centres.
    point: DVec3,
    /// Unit vector along the cloth from the ball to the butt.
    back: DVec2,
    /// Half of the playing area, m.
    half: DVec2,
    /// How much the cue's radius grows a metre, and the sine and cosine of the angle by which its sides spread.
    growth: f64,
    sin: f64,
    cos: f64,
}

/// What an obstacle asks of the elevation.
#[derive(Clone, Copy, Debug)]
enum Need {
    /// `x sin theta - y cos theta >= z`.
    Above { x: f64, y: f64, z: f64 },
    /// No part of the tip's end below its place by more than this share of its radius: `cos theta <= share`, and the
    /// underside not falling towards the butt: `sin theta >= rise`.
    Clear { share: f64, rise: f64 },
    /// There is none that would do.
    Never,
}

impl Need {
    #[inline]
    fn is_met(self, sin_theta: f64, cos_theta: f64) -> bool {
        match self {
            Self::Above { x, y, z } => x * sin_theta - y * cos_theta >= z,
            Self::Clear { share, rise } => cos_theta <= share && sin_theta >= rise,
            Self::Never => false,
        }
    }

    /// The least elevation that does, rad, not below nought.
    fn least(self) -> Option<f64> {
        let least = match self {
            Self::Above { x, y, z } => {
                let share = z / libm::hypot(x, y);
                // Smaller than -1: whatever the elevation.
                (share <= 1.0).then(|| if share <= -1.0 { 0.0 } else { libm::atan2(y, x) + libm::asin(share) })
            }
            Self::Clear { share, rise } => Some(libm::acos(share.min(1.0)).max(libm::asin(rise))),
            Self::Never => None,
        };
        least.map(|theta| theta.max(0.0)).filter(|theta| *theta < FRAC_PI_2)
    }
}

impl Stick {
    /// `None` on a table without limits.
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

    /// What every obstacle asks for that the cue can come to.
    fn needs(&self, layout: &Layout) -> impl Iterator<Item = (Obstacle, Need)> {
        let rails = Rail::ALL.into_iter().filter_map(|rail| Some((Obstacle::Rail(rail), self.over_rail(rail)?)));
        let balls = layout.balls.into_iter().enumerate().skip(1);
        rails.chain(balls.filter_map(|(ball, place)| Some((Obstacle::Ball(ball), self.over_ball(place)?))))
    }

    /// Radius of the cue at its butt, m.
    fn butt(&self) -> f64 {
        0.5 * self.room.tip + self.growth * self.room.length
    }

    /// `None` for a rail that the cue is too short for or points away from.
    fn over_rail(&self, rail: Rail) -> Option<Need> {
        let inward = rail.normal();
        let towards = -self.back.dot(inward);
        let behind = self.half.dot(inward.abs()) + self.point.truncate().dot(inward);
        if behind >= towards.max(0.0) * self.room.length + self.butt() {
            return None;
        }
        let tip = 0.5 * self.room.tip;
        let above = self.room.nose - self.radius - self.point.z;
        // The plane that touches the cone without ends: its slope outwards is `rise / run`, times the squared distance.
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
            // The cue would pass the nose falling: then it has the outer edge to pass.
            found = plane(behind + self.room.rail).filter(|(rise, ..)| *rise <= 0.0);
        }
        Some(match found {
            Some((rise, run, squared)) if run >= 0.0 => {
                Need::Above { x: run, y: towards * rise, z: self.sin * squared }
            }
            _ if above < 0.0 => Need::Clear { share: -above / tip, rise: self.sin },
            _ => Need::Never,
        })
    }

    /// `None` for a ball that the cue is too short for, or that lies ahead.
    fn over_ball(&self, place: DVec2) -> Option<Need> {
        let apart = place - self.point.truncate();
        let (behind, above) = (apart.dot(self.back), -self.point.z);
        if behind - self.radius >= self.room.length + self.butt() {
            return None;
        }
        let reach = self.radius / self.cos + 0.5 * self.room.tip;
        if behind <= 0.0 {
            // The foot comes to `above` at most, and the cue's axis no nearer than the ball is away: only a tip far out on the
            // cue ball can touch it.
            let is_near = apart.length() < reach + self.growth * above;
            return (above > 0.0 && is_near).then_some(Need::Never);
        }
        // Roots of (1 + k²) s² + 2 k reach s + reach² - |o|².
        let squared = 1.0 + self.growth * self.growth;
        let half = self.growth * reach;
        let rest = reach * reach - (apart.length_squared() + above * above);
        if rest > 0.0 {
            return Some(Need::Never);
        }
        let root = ((half * half - squared * rest).sqrt() - half) / squared;
        // At no elevation is the foot further along than the ball is away.
        (root * root < behind * behind + above * above).then_some(Need::Above { x: -above, y: behind, z: -root })
    }
}

#[cfg(test)]
pub mod tests;
