//! Models of the table's parts that go beyond the thesis: rails at the height of their nose, friction and restitution
//! that depend on speed. A part that a table's file does not name is the thesis' own.

use serde::{Deserialize, Serialize};

use super::Rail;

/// Where a ball meets a rail, and by what law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RailModel {
    /// At the height of the ball's centre, with Coulomb friction up to no slip (thesis equations 22 and 23).
    #[default]
    Equator,
    /// At the nose's height, with Coulomb friction up to no slip (Han 2005's geometry).
    Nose,
    /// At the nose's height, with friction that passes smoothly from slipping to sticking.
    Smooth,
    /// At the nose's height, integrated over the impulse with the cloth's friction at the same time (Mathavan 2010): some
    /// twenty times as slow as the others.
    Mathavan,
}

/// The rails of a table: the TOML section `[rail]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rails {
    /// The law of the impact.
    #[serde(default)]
    pub model: RailModel,
    /// Height of the nose over the cloth, m; the ball's radius where it is left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// How much of the slip the `smooth` model takes at most, as a multiple of what sticking takes: 1 stops the contact, 2
    /// throws it back as fast.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kappa: Option<f64>,
    /// Restitution that falls with the speed of the impact.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fade: Option<Fade>,
    /// What the left rail has of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<OneRail>,
    /// What the right rail has of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right: Option<OneRail>,
    /// What the bottom rail has of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bottom: Option<OneRail>,
    /// What the top rail has of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top: Option<OneRail>,
}

impl Rails {
    /// What a rail has of its own.
    pub fn own(&self, rail: Rail) -> OneRail {
        let own = match rail {
            Rail::Left => self.left,
            Rail::Right => self.right,
            Rail::Bottom => self.bottom,
            Rail::Top => self.top,
        };
        own.unwrap_or_default()
    }

    /// The place of what a rail has of its own.
    pub const fn own_mut(&mut self, rail: Rail) -> &mut Option<OneRail> {
        match rail {
            Rail::Left => &mut self.left,
            Rail::Right => &mut self.right,
            Rail::Bottom => &mut self.bottom,
            Rail::Top => &mut self.top,
        }
    }

    /// As they are for who stands at the other end: each in the place of the one across.
    pub(super) const fn turned(self) -> Self {
        Self { left: self.right, right: self.left, bottom: self.top, top: self.bottom, ..self }
    }
}

/// What one rail has of its own; what is left out is the table's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OneRail {
    /// Restitution, 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub e: Option<f64>,
    /// Coefficient of friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mu: Option<f64>,
    /// Height of the nose, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
}

/// A restitution that falls with the normal speed of the impact: constant up to a speed, then by a slope, never below a
/// least value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fade {
    /// Speed up to which the restitution is constant, m/s.
    pub from: f64,
    /// What it loses with each m/s above, s/m.
    pub slope: f64,
    /// The least that is left of it.
    pub least: f64,
}

impl Fade {
    /// The restitution at an impact with normal speed `speed`, m/s, of a part whose slow restitution is `slow`.
    #[inline]
    pub fn at(&self, slow: f64, speed: f64) -> f64 {
        (slow - self.slope * (speed - self.from).max(0.0)).max(self.least.min(slow))
    }
}

/// Ball-ball friction that falls with the contact's slip: `least + rise exp(-fade slip)` (Alciatore, TP A.14).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlipFriction {
    /// Coefficient at fast slip.
    pub least: f64,
    /// What slow slip adds.
    pub rise: f64,
    /// How fast that fades with the slip, s/m.
    pub fade: f64,
}

impl SlipFriction {
    /// The coefficient at a slip of `slip` m/s.
    #[inline]
    pub fn at(&self, slip: f64) -> f64 {
        self.least + self.rise * libm::exp(-self.fade * slip)
    }
}

/// Whether a number may be left out of a file.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
pub(crate) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
