//! Models that go beyond the thesis: rails with the nose at its real height, and friction and restitution that depend on speed. If a
//! table's file does not name a model for a part, the thesis' model applies.

use serde::{Deserialize, Serialize};

use super::Rail;

/// Impact model of the rails: contact height and friction law.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RailModel {
    /// Contact at the height of the ball's centre, with Coulomb friction up to the no-slip limit (thesis equations 22 and 23).
    #[default]
    Equator,
    /// Contact at the nose's height, with Coulomb friction up to the no-slip limit (geometry of Han 2005).
    Nose,
    /// Contact at the nose's height, with friction that changes smoothly from slip to stick.
    Smooth,
    /// Contact at the nose's height, integrated over the impulse together with the cloth's friction (Mathavan 2010). About twenty times
    /// slower than the other models.
    Mathavan,
}

/// The rails of a table: the TOML section `[rail]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rails {
    /// The impact model.
    #[serde(default)]
    pub model: RailModel,
    /// Height of the nose above the cloth, m; `None` for the ball's radius.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height: Option<f64>,
    /// Largest share of the slip velocity that the `smooth` model removes, in units of what sticking removes: 1 stops the slip, 2 reverses
    /// it at the same speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kappa: Option<f64>,
    /// Decrease of the restitution with impact speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fade: Option<Fade>,
    /// Constants of the left rail that differ from the table's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<RailOverrides>,
    /// Constants of the right rail that differ from the table's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right: Option<RailOverrides>,
    /// Constants of the bottom rail that differ from the table's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bottom: Option<RailOverrides>,
    /// Constants of the top rail that differ from the table's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub top: Option<RailOverrides>,
}

impl Rails {
    /// Returns the constants that `rail` overrides.
    pub fn overrides(&self, rail: Rail) -> RailOverrides {
        let own = match rail {
            Rail::Left => self.left,
            Rail::Right => self.right,
            Rail::Bottom => self.bottom,
            Rail::Top => self.top,
        };
        own.unwrap_or_default()
    }

    /// Returns the TOML keys of constants that the model of the rails does not use, each with the models that do.
    pub fn unused(&self) -> Vec<[&'static str; 2]> {
        let has_height = self.height.is_some() || Rail::ALL.iter().any(|rail| self.overrides(*rail).height.is_some());
        let mut unused = Vec::new();
        if has_height && self.model == RailModel::Equator {
            unused.push(["height", "nose, smooth or mathavan"]);
        }
        if self.kappa.is_some() && self.model != RailModel::Smooth {
            unused.push(["kappa", "smooth"]);
        }
        unused
    }

    /// Returns the field with the overrides of `rail`.
    pub const fn overrides_mut(&mut self, rail: Rail) -> &mut Option<RailOverrides> {
        match rail {
            Rail::Left => &mut self.left,
            Rail::Right => &mut self.right,
            Rail::Bottom => &mut self.bottom,
            Rail::Top => &mut self.top,
        }
    }

    /// Returns the rails as a player at the other end sees them: opposite rails are exchanged.
    pub(super) const fn seen_from_other_end(self) -> Self {
        Self { left: self.right, right: self.left, bottom: self.top, top: self.bottom, ..self }
    }
}

/// Constants of a single rail; `None` for the value that applies to all rails.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RailOverrides {
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

/// A restitution that decreases with the normal speed of the impact: constant up to `from`, then linear, and never below `least`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fade {
    /// Speed up to which the restitution is constant, m/s.
    pub from: f64,
    /// Decrease per m/s above `from`, s/m.
    pub slope: f64,
    /// Lower bound of the restitution.
    pub least: f64,
}

impl Fade {
    /// Returns the restitution at a normal impact speed of `speed`, m/s, if it is `slow` at low speed.
    #[inline]
    pub fn at(&self, slow: f64, speed: f64) -> f64 {
        (slow - self.slope * (speed - self.from).max(0.0)).max(self.least.min(slow))
    }
}

/// Ball-ball friction that decreases with the slip speed: `least + rise exp(-fade slip)` (Alciatore, TP A.14).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlipFriction {
    /// Coefficient at high slip speed.
    pub least: f64,
    /// Additional friction at zero slip.
    pub rise: f64,
    /// Decay rate of `rise` with the slip speed, s/m.
    pub fade: f64,
}

impl SlipFriction {
    /// Returns the coefficient at a slip speed of `slip`, m/s.
    #[inline]
    pub fn at(&self, slip: f64) -> f64 {
        self.least + self.rise * libm::exp(-self.fade * slip)
    }
}

/// Whether a value equals its default, so that a file can omit it.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
