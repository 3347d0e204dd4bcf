//! How well a player does what the coach says: the standard errors of the five cue inputs.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

use super::{Input, errors::Errors};
use crate::physics::CueInputs;

/// A player's standard errors in the five cue inputs. They are independent and normally distributed.
///
/// On the command line and in JSON it is a name, or five numbers as people say them: millimetres, degrees and m/s, like
/// `a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Skill {
    /// Of the tip to the side, m.
    pub a: f64,
    /// Of the tip's height, m.
    pub b: f64,
    /// Of the elevation, rad.
    pub theta: f64,
    /// Of the direction, rad.
    pub phi: f64,
    /// Of the speed, m/s.
    pub speed: f64,
}

/// Why a skill is refused.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum SkillError {
    /// Neither a name nor five numbers.
    #[error(
        "there is no skill \"{0}\"; use perfect, expert, club or beginner, or a player's own standard errors in mm, \
         degrees and m/s like \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\""
    )]
    Unknown(String),
    /// An error that nobody has.
    #[error("the skill has {name} = {value}; accepted is 0 to {most} {unit}")]
    Range {
        /// Name of the cue input.
        name: &'static str,
        /// What was given.
        value: f64,
        /// The largest that is accepted.
        most: f64,
        /// Its unit.
        unit: &'static str,
    },
}

/// Steepest cue that errors lead to, rad: just below upright, unless the stroke is meant steeper.
const STEEPEST: f64 = 89.9_f64.to_radians();

/// The five errors as people say them: name, unit, SI units in one of it, and the largest that is accepted. A player who
/// errs by more than a ball's radius, a right angle's half or 5 m/s plays no shot at all.
const FORMS: [(&str, &str, f64, f64); 5] = [
    ("a", "mm", 1e-3, 30.0),
    ("b", "mm", 1e-3, 30.0),
    ("theta", "degrees", std::f64::consts::PI / 180.0, 45.0),
    ("phi", "degrees", std::f64::consts::PI / 180.0, 45.0),
    ("V", "m/s", 1.0, 5.0),
];

impl Skill {
    /// No errors.
    pub const PERFECT: Self = Self::EXPERT.scaled(0.0);

    /// The errors of the Computer Olympiad's pool tournaments: 0.5 mm, 0.5 mm, 0.1°, 0.125°, 0.075 m/s.
    pub const EXPERT: Self =
        Self { a: 0.5e-3, b: 0.5e-3, theta: 0.1_f64.to_radians(), phi: 0.125_f64.to_radians(), speed: 0.075 };

    /// Twice an expert's errors.
    pub const CLUB: Self = Self::EXPERT.scaled(2.0);

    /// Four times an expert's errors.
    pub const BEGINNER: Self = Self::EXPERT.scaled(4.0);

    /// Those that have a name, the best first.
    pub const NAMED: [(&'static str, Self); 4] =
        [("perfect", Self::PERFECT), ("expert", Self::EXPERT), ("club", Self::CLUB), ("beginner", Self::BEGINNER)];

    /// The same player with all errors so many times as large.
    #[must_use]
    pub const fn scaled(self, factor: f64) -> Self {
        Self {
            a: factor * self.a,
            b: factor * self.b,
            theta: factor * self.theta,
            phi: factor * self.phi,
            speed: factor * self.speed,
        }
    }

    /// How many times an expert's errors, on average over the five.
    pub fn scale(&self) -> f64 {
        self.values().iter().zip(Self::EXPERT.values()).map(|(own, expert)| own / expert).sum::<f64>() / 5.0
    }

    /// Whether there are no errors.
    pub fn is_perfect(&self) -> bool {
        *self == Self::PERFECT
    }

    /// The stroke that comes of trying `cue` with these standard normal errors, on balls of `radius` m.
    #[inline]
    pub fn stroke(&self, radius: f64, cue: &CueInputs, errors: &Errors) -> CueInputs {
        CueInputs {
            a: cue.a + self.a / radius * errors[0],
            b: cue.b + self.b / radius * errors[1],
            // A cue is held neither below the cloth nor over the back.
            theta: (cue.theta + self.theta * errors[2]).clamp(0.0, STEEPEST.max(cue.theta)),
            phi: cue.phi + self.phi * errors[3],
            // Nor does a stroke go backwards.
            speed: (cue.speed + self.speed * errors[4]).max(1e-3),
        }
    }

    /// The standard error in one of the inputs, in its unit.
    pub fn error(&self, input: Input) -> f64 {
        let index = Input::ALL.iter().position(|one| *one == input).unwrap_or_default();
        self.values()[index] / FORMS[index].2
    }

    /// The five in the order of [`FORMS`] and [`Input::ALL`], SI.
    const fn values(&self) -> [f64; 5] {
        [self.a, self.b, self.theta, self.phi, self.speed]
    }
}

impl Default for Skill {
    fn default() -> Self {
        Self::EXPERT
    }
}

impl fmt::Display for Skill {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((name, _)) = Self::NAMED.iter().find(|(_, skill)| skill == self) {
            return formatter.pad(name);
        }
        let part = |((name, _, unit, _), value): (&(&str, &str, f64, f64), f64)| {
            // Twelve digits: what was read in degrees is written as it was.
            format!("{name}={}", (value / unit * 1e12).round() / 1e12)
        };
        formatter.pad(&FORMS.iter().zip(self.values()).map(part).collect::<Vec<_>>().join(","))
    }
}

impl FromStr for Skill {
    type Err = SkillError;

    fn from_str(text: &str) -> Result<Self, SkillError> {
        if let Some((_, skill)) = Self::NAMED.iter().find(|(name, _)| *name == text) {
            return Ok(*skill);
        }
        let unknown = || SkillError::Unknown(text.to_owned());
        let mut values = [None; 5];
        for part in text.split(',') {
            let (name, number) = part.split_once('=').ok_or_else(unknown)?;
            let index = FORMS.iter().position(|form| form.0 == name.trim()).ok_or_else(unknown)?;
            let value: f64 = number.trim().parse().map_err(|_| unknown())?;
            let (name, unit, si, most) = FORMS[index];
            // Written so that NaN is refused.
            if !(0.0..=most).contains(&value) {
                return Err(SkillError::Range { name, value, most, unit });
            }
            if values[index].replace(value * si).is_some() {
                return Err(unknown());
            }
        }
        let [Some(a), Some(b), Some(theta), Some(phi), Some(speed)] = values else { return Err(unknown()) };
        Ok(Self { a, b, theta, phi, speed })
    }
}

impl From<Skill> for String {
    fn from(skill: Skill) -> Self {
        skill.to_string()
    }
}

impl TryFrom<String> for Skill {
    type Error = SkillError;

    fn try_from(text: String) -> Result<Self, SkillError> {
        text.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_players_own_errors_are_read_in_millimetres_and_degrees_and_written_back() {
        let text = "a=0.7,b=0.6,theta=0.2,phi=0.15,V=0.1";
        let skill: Skill = text.parse().unwrap();
        assert!((skill.a - 0.7e-3).abs() < 1e-15 && (skill.phi.to_degrees() - 0.15).abs() < 1e-12);
        assert_eq!(skill.to_string(), text);
        assert_eq!("V=0.1, phi=0.15,a=0.7,b=0.6,theta=0.2".parse(), Ok(skill));
        for (name, skill) in Skill::NAMED {
            assert_eq!((skill.to_string().as_str(), name.parse()), (name, Ok(skill)));
        }
    }

    #[test]
    fn a_bad_skill_is_named_with_what_would_be_accepted() {
        let said = |text: &str| text.parse::<Skill>().unwrap_err().to_string();
        assert!(said("master").contains("master") && said("master").contains("expert"));
        assert!(said("a=0.7,b=0.7,theta=0.2,phi=0.2").contains("V="), "one is missing");
        assert!(said("a=1,a=1,theta=0.2,phi=0.2,V=0.1").contains("a=1,a=1"));
        for bad in ["-0.1", "46", "NaN", "inf"] {
            let said = said(&format!("a=0.7,b=0.7,theta=0.2,phi={bad},V=0.1"));
            assert!(said.contains(&format!("phi = {bad}")) && said.contains("0 to 45 degrees"), "{said}");
        }
    }

    #[test]
    fn the_errors_are_in_their_units() {
        let cue = CueInputs { a: 0.1, b: 0.0, theta: 0.0, phi: 1.0, speed: 2.0 };
        let stroke = Skill::EXPERT.stroke(0.03, &cue, &[3.0, 0.0, -2.0, 1.0, -1.0]);
        assert!((stroke.a - 0.15).abs() < 1e-12, "1.5 mm on a radius of 30 mm");
        assert_eq!((stroke.b, stroke.theta), (0.0, 0.0), "a cue is not held below the cloth");
        assert!((stroke.phi - 1.0).to_degrees() - 0.125 < 1e-12 && (stroke.speed - 1.925).abs() < 1e-12);
    }

    #[test]
    fn errors_never_turn_a_raised_cue_over() {
        for degrees in [80.0, 89.95_f64] {
            let cue = CueInputs { a: 0.0, b: 0.0, theta: degrees.to_radians(), phi: 0.0, speed: 2.0 };
            // 40° too steep by one standard error of a player who is off by so much.
            let steepest = Skill { theta: 40.0_f64.to_radians(), ..Skill::CLUB }.stroke(0.03, &cue, &[1.0; 5]);
            steepest.validate().unwrap();
            assert!(steepest.theta >= cue.theta, "{steepest:?}");
        }
    }
}
