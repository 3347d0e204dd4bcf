//! How well a player does what the coach says: execution noise, and the probability of a point under it.

use std::{f64::consts::TAU, fmt, str::FromStr};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use crate::{
    game::{Rule, scores},
    physics::CueInputs,
    table::{Layout, Table},
};

/// A player's standard errors in the five cue inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Skill {
    /// No errors.
    Perfect,
    /// The errors of the Computer Olympiad's pool tournaments: 0.5 mm, 0.5 mm, 0.1°, 0.125°, 0.075 m/s.
    #[default]
    Expert,
    /// Twice an expert's errors.
    Club,
    /// Four times an expert's errors.
    Beginner,
}

/// A skill's name that is not known.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no skill \"{0}\"; use perfect, expert, club or beginner")]
pub struct UnknownSkill(String);

impl Skill {
    /// All skills, the best first.
    pub const ALL: [Self; 4] = [Self::Perfect, Self::Expert, Self::Club, Self::Beginner];

    /// Name on the command line and in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Perfect => "perfect",
            Self::Expert => "expert",
            Self::Club => "club",
            Self::Beginner => "beginner",
        }
    }

    /// The errors in units of an expert's.
    const fn scale(self) -> f64 {
        match self {
            Self::Perfect => 0.0,
            Self::Expert => 1.0,
            Self::Club => 2.0,
            Self::Beginner => 4.0,
        }
    }

    /// The stroke that comes of trying `cue`.
    fn attempt(self, radius: f64, cue: &CueInputs, rng: &mut Xoshiro256PlusPlus) -> CueInputs {
        let scale = self.scale();
        let mut error = |sigma: f64| scale * sigma * normal(rng);
        CueInputs {
            a: cue.a + error(0.5e-3) / radius,
            b: cue.b + error(0.5e-3) / radius,
            // A cue cannot be held below the cloth.
            theta: (cue.theta + error(0.1_f64.to_radians())).max(0.0),
            phi: cue.phi + error(0.125_f64.to_radians()),
            speed: (cue.speed + error(0.075)).max(1e-3),
        }
    }

    /// Share of `attempts` at `cue` that make a point. A tip beyond the table's miscue limit makes none. The same seed
    /// draws the same errors for every shot, so that shots compare fairly.
    pub fn make_probability(
        self,
        rule: Rule,
        table: &Table,
        layout: &Layout,
        cue: &CueInputs,
        attempts: u32,
        seed: u64,
    ) -> f64 {
        if self == Self::Perfect {
            return f64::from(u8::from(scores(rule, table, layout, cue)));
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let made = (0..attempts)
            .filter(|_| {
                let stroke = self.attempt(table.radius, cue, &mut rng);
                stroke.tip_offset_squared() <= table.miscue_limit && scores(rule, table, layout, &stroke)
            })
            .count();
        made as f64 / f64::from(attempts.max(1))
    }
}

impl fmt::Display for Skill {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for Skill {
    type Err = UnknownSkill;

    fn from_str(text: &str) -> Result<Self, UnknownSkill> {
        Self::ALL.into_iter().find(|skill| skill.name() == text).ok_or_else(|| UnknownSkill(text.to_owned()))
    }
}

/// A standard normal number, by Box and Muller (1958).
fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (TAU * rng.random::<f64>()).cos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn errors_have_the_stated_spread() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        let cue = CueInputs { a: 0.0, b: 0.1, theta: 0.5, phi: 1.0, speed: 3.0 };
        let count = 20_000;
        let variance: f64 = (0..count)
            .map(|_| Skill::Club.attempt(0.03, &cue, &mut rng).phi - cue.phi)
            .map(|error| error * error)
            .sum::<f64>()
            / f64::from(count);
        assert!((variance.sqrt().to_degrees() - 0.25).abs() < 0.005);
    }

    #[test]
    fn a_better_player_makes_more() {
        let table = Table::default();
        let layout = Layout::new([DVec2::new(-0.8, 0.0), DVec2::new(0.0, 0.0), DVec2::new(0.5, 0.25)]);
        let cue = (0..2000)
            .map(|step| CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: -0.04 + 4e-5 * f64::from(step), speed: 3.0 })
            .find(|cue| scores(Rule::StraightRail, &table, &layout, cue))
            .unwrap();
        let chance = |skill: Skill| skill.make_probability(Rule::StraightRail, &table, &layout, &cue, 500, 1);
        assert_eq!(chance(Skill::Perfect), 1.0);
        assert!(chance(Skill::Expert) > chance(Skill::Beginner));
    }
}
