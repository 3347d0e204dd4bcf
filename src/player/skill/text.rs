//! The text form of a skill: a name, an average, or a player's own standard errors.

use std::{f64::consts::PI, fmt, str::FromStr};

use super::{Growth, Input, Skill};
use crate::printing::{number, parse_number};

/// Why a skill is rejected.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum SkillError {
    /// The text is neither a name, nor an average, nor five numbers, each given once.
    #[error(
        "there is no skill \"{0}\"; use perfect, expert, world-class, national, club or beginner, an average at \
         three-cushion like 0.6, or standard errors in mm, degrees and m/s like \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\""
    )]
    Unknown(String),
    /// Some of the five standard errors are missing.
    #[error(
        "the skill \"{text}\" has no {missing}; all five errors are needed, like \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\" or with V=5%, \
         and growth=0.5 and raised=1 may follow"
    )]
    Missing {
        /// The text.
        text: String,
        /// The names of the errors that it does not state.
        missing: String,
    },
    /// An error is stated twice.
    #[error("the skill \"{text}\" has {name} twice; each error is accepted once")]
    Twice {
        /// The text.
        text: String,
        /// The name of the error.
        name: &'static str,
    },
    /// The average is outside the measured range.
    #[error(
        "no measured player averages {}; accepted are {} to {} points an inning at three-cushion, or world-class \
         (about 2), national (1), club (0.5) and beginner (0.15)",
        number(*_0), Skill::AVERAGES.0, Skill::AVERAGES.1
    )]
    Average(f64),
    /// An error is outside the accepted range.
    #[error("the skill has {name} = {}; accepted is 0 to {most} {unit}", number(*value))]
    Range {
        /// Name of the cue input.
        name: &'static str,
        /// The given value.
        value: f64,
        /// The largest accepted value.
        most: f64,
        /// The unit of the value.
        unit: &'static str,
    },
}

/// The five errors in the order of [`Input::ALL`]: the size of the input's unit in SI units, and the largest accepted
/// value. A player with larger errors than a ball's radius, half a right angle or 5 m/s cannot play at all.
pub(super) const ERROR_FORMATS: [(f64, f64); 5] =
    [(1e-3, 30.0), (1e-3, 30.0), (PI / 180.0, 45.0), (PI / 180.0, 45.0), (1.0, 5.0)];

/// Optional prefix of a three-cushion average.
const AVERAGE: &str = "average=";

/// The largest accepted share of the speed, %.
const MAX_SHARE: f64 = 100.0;

impl fmt::Display for Skill {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((name, _)) = Self::NAMED.iter().find(|(_, skill)| skill == self) {
            return formatter.pad(name);
        }
        if let Some(average) = self.as_average() {
            return formatter.pad(&format!("{AVERAGE}{average}"));
        }
        // Twelve digits, so that a value read in degrees is written unchanged.
        let rounded = |value: f64| (value * 1e12).round() / 1e12;
        let Growth { speed, elevation, is_share } = self.growth;
        let part = |((input, (unit, _)), value): ((Input, (f64, f64)), f64)| {
            if is_share && input == Input::Speed {
                format!("{}={}%", input.name(), rounded(100.0 * value / Self::REFERENCE_SPEED))
            } else {
                format!("{}={}", input.name(), rounded(value / unit))
            }
        };
        let mut parts: Vec<_> = Input::ALL.into_iter().zip(ERROR_FORMATS).zip(self.values()).map(part).collect();
        for ((name, _), value) in GROWTH_LIMITS.iter().zip([speed, elevation]).filter(|(_, value)| *value != 0.0) {
            parts.push(format!("{name}={}", rounded(value)));
        }
        formatter.pad(&parts.join(","))
    }
}

/// Names and largest values of the two numbers of a growth: with the speed and with the elevation.
const GROWTH_LIMITS: [(&str, f64); 2] = [("growth", 1.0), ("raised", 10.0)];

impl FromStr for Skill {
    type Err = SkillError;

    fn from_str(text: &str) -> Result<Self, SkillError> {
        if let Some((_, skill)) = Self::NAMED.iter().find(|(name, _)| name.eq_ignore_ascii_case(text)) {
            return Ok(*skill);
        }
        if let Some(average) = parse_number(text.strip_prefix(AVERAGE).unwrap_or(text)) {
            return Self::of_average(average).ok_or(SkillError::Average(average));
        }
        let unknown = || SkillError::Unknown(text.to_owned());
        let twice = |name| SkillError::Twice { text: text.to_owned(), name };
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| unknown());
        // Written so that NaN is rejected.
        let checked = |name, value: f64, most, unit| {
            if (0.0..=most).contains(&value) { Ok(value) } else { Err(SkillError::Range { name, value, most, unit }) }
        };
        let (mut values, mut growths, mut is_share) = ([None; 5], [None; 2], false);
        for part in text.split(',') {
            let (name, value) = part.split_once('=').ok_or_else(unknown)?;
            if let Some(which) = GROWTH_LIMITS.iter().position(|growth| growth.0 == name.trim()) {
                let (name, most) = GROWTH_LIMITS[which];
                if growths[which].replace(checked(name, number(value)?, most, "(a share)")?).is_some() {
                    return Err(twice(name));
                }
                continue;
            }
            let input = Input::ALL
                .into_iter()
                .find(|input| input.name().eq_ignore_ascii_case(name.trim()))
                .ok_or_else(unknown)?;
            let (unit, most) = ERROR_FORMATS[input as usize];
            let value = match value.trim().strip_suffix('%').filter(|_| input == Input::Speed) {
                Some(share) => {
                    is_share = true;
                    checked(input.name(), number(share)?, MAX_SHARE, "%")? / 100.0 * Self::REFERENCE_SPEED
                }
                None => checked(input.name(), number(value)?, most, input.unit())? * unit,
            };
            if values[input as usize].replace(value).is_some() {
                return Err(twice(input.name()));
            }
        }
        let [Some(a), Some(b), Some(theta), Some(phi), Some(speed)] = values else {
            let names =
                Input::ALL.iter().zip(values).filter(|(_, value)| value.is_none()).map(|(input, _)| input.name());
            return Err(SkillError::Missing { text: text.to_owned(), missing: names.collect::<Vec<_>>().join(", ") });
        };
        let [by_speed, by_elevation] = growths.map(Option::unwrap_or_default);
        Ok(Self { a, b, theta, phi, speed, growth: Growth { speed: by_speed, elevation: by_elevation, is_share } })
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
    fn skill_errors_round_trip_in_mm_and_degrees() {
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
    fn skill_is_parsed_from_a_measured_average() {
        let skill: Skill = "0.6".parse().unwrap();
        assert!((Skill::average(skill.scale()) - 0.6).abs() < 1e-9 && skill.growth == Growth::USUAL);
        assert_eq!(skill.to_string(), "average=0.6");
        for text in ["0.1", "0.123", "0.5", "1", "1.37", "2.5"] {
            let skill: Skill = text.parse().unwrap();
            assert_eq!(skill.to_string().parse(), Ok(skill), "{text}");
            assert_eq!(skill.to_string(), format!("average={text}"));
        }
        assert_eq!("0,6".parse(), Ok(skill), "a decimal comma");
        assert!(Skill::NAMED.iter().all(|(_, named)| named.as_average().is_none()));
        for bad in ["0.05", "3", "-1", "0", "NaN", "inf"] {
            let said = bad.parse::<Skill>().unwrap_err().to_string();
            assert!(said.contains("0.1 to 2.5 points an inning") && said.contains("club (0.5)"), "{said}");
        }
    }

    #[test]
    fn speed_share_and_growth_round_trip() {
        let text = "a=0.7,b=0.6,theta=0.2,phi=0.15,V=4%,growth=0.5,raised=1.5";
        let skill: Skill = text.parse().unwrap();
        assert_eq!(skill.growth, Growth { speed: 0.5, elevation: 1.5, is_share: true });
        assert!((skill.speed - 0.1).abs() < 1e-15, "of the reference stroke's 2.5 m/s");
        assert_eq!(skill.to_string(), text);
        for (bad, accepted) in [("V=101%", "0 to 100 %"), ("V=4%,growth=1.1", "0 to 1"), ("V=4%,raised=-1", "0 to 10")]
        {
            let said = text.replace("V=4%,growth=0.5,raised=1.5", bad).parse::<Skill>().unwrap_err().to_string();
            assert!(said.contains(accepted), "{said}");
        }
        assert!("a=1%,b=0.6,theta=0.2,phi=0.15,V=4%".parse::<Skill>().is_err());
    }

    #[test]
    fn invalid_skill_error_names_accepted_values() {
        let said = |text: &str| text.parse::<Skill>().unwrap_err().to_string();
        assert!(said("master").contains("master") && said("master").contains("expert"));
        assert!(said("a=0.7,b=0.7,theta=0.2,phi=0.2").contains("V="), "one is missing");
        assert!(said("a=1,a=1,theta=0.2,phi=0.2,V=0.1").contains("has a twice"));
        let twice = said("a=1,b=1,theta=0.2,phi=0.2,V=0.1,growth=0.5,growth=0.1");
        assert!(twice.contains("has growth twice"), "{twice}");
        for bad in ["-0.1", "46", "NaN", "inf"] {
            let said = said(&format!("a=0.7,b=0.7,theta=0.2,phi={bad},V=0.1"));
            assert!(said.contains(&format!("phi = {bad}")) && said.contains("0 to 45 degrees"), "{said}");
        }
    }
}
