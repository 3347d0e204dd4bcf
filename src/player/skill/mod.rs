//! A player's execution errors: the standard errors of the five cue inputs, and how they grow with the stroke.

mod level;
mod text;

use serde::{Deserialize, Serialize};

use super::{Input, errors::Errors};
use crate::physics::CueInputs;

use text::ERROR_FORMATS;
pub use text::SkillError;

/// A player's standard errors in the five cue inputs at a level stroke of [`Skill::REFERENCE_SPEED`], and their growth
/// with the stroke. The errors are independent and normally distributed.
///
/// On the command line and in JSON it is a name, a three-cushion average like `average=0.6`, or five numbers in
/// millimetres, degrees and m/s, like `a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1`. Five numbers alone do not grow. `V=5%` is
/// a share of the stroke's speed, and `growth=0.5` and `raised=1` may follow: see [`Growth`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub struct Skill {
    /// Standard error of the tip position to the side, m.
    pub a: f64,
    /// Standard error of the tip's height, m.
    pub b: f64,
    /// Standard error of the elevation, rad.
    pub theta: f64,
    /// Standard error of the direction, rad.
    pub phi: f64,
    /// Standard error of the speed, m/s.
    pub speed: f64,
    /// Growth of the errors with the stroke.
    pub growth: Growth,
}

/// How errors grow with the stroke.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Growth {
    /// The share of the variance of tip and direction at the reference stroke that grows with the square of the speed, 0 to 1.
    pub speed: f64,
    /// Relative increase of the errors of tip and direction when the cue is raised by 30°.
    pub elevation: f64,
    /// Whether the error of the speed is proportional to the speed.
    pub is_share: bool,
}

impl Growth {
    /// Errors that are the same for every stroke.
    pub const NONE: Self = Self { speed: 0.0, elevation: 0.0, is_share: false };

    /// The growth for the named levels. The noise of a movement grows with its force (Schmidt et al. 1979, Harris and
    /// Wolpert 1998), so that the error of the speed is proportional to it. Two assumptions have not been measured at
    /// carom: half of the variance of tip and aim is noise of this kind, and a cue raised by 30° doubles the errors.
    pub const USUAL: Self = Self { speed: 0.5, elevation: 1.0, is_share: true };
}

/// Steepest cue that errors can result in, rad: just below vertical, unless the intended cue is steeper.
const MAX_ELEVATION_WITH_ERRORS: f64 = 89.9_f64.to_radians();

/// Elevation to which [`Growth::elevation`] refers, rad: 30°.
const REFERENCE_ELEVATION: f64 = std::f64::consts::PI / 6.0;

impl Skill {
    /// Speed of the stroke to which the errors refer, m/s. In the filmed shots the balls leave the cue at 3.5 m/s,
    /// which corresponds to a stroke of 2.5 m/s.
    pub const REFERENCE_SPEED: f64 = 2.5;

    /// Fastest stroke that errors can result in, m/s: twice the fastest intended one.
    pub const MAX_SPEED_WITH_ERRORS: f64 = 2.0 * CueInputs::MAX_SPEED;

    /// A player without errors.
    pub const PERFECT: Self = Self { growth: Growth::NONE, ..Self::EXPERT.scaled(0.0) };

    /// The errors in the Computer Olympiad's pool tournaments: 0.5 mm, 0.5 mm, 0.1°, 0.125°, 0.075 m/s, the same for
    /// every stroke.
    pub const EXPERT: Self = Self {
        a: 0.5e-3,
        b: 0.5e-3,
        theta: 0.1_f64.to_radians(),
        phi: 0.125_f64.to_radians(),
        speed: 0.075,
        growth: Growth::NONE,
    };

    /// The named skills, best first.
    pub const NAMED: [(&'static str, Self); 6] = [
        ("perfect", Self::PERFECT),
        ("expert", Self::EXPERT),
        ("world-class", Self::WORLD_CLASS),
        ("national", Self::NATIONAL),
        ("club", Self::CLUB),
        ("beginner", Self::BEGINNER),
    ];

    /// Returns the same player with all errors multiplied by `factor`.
    #[must_use]
    pub const fn scaled(self, factor: f64) -> Self {
        Self {
            a: factor * self.a,
            b: factor * self.b,
            theta: factor * self.theta,
            phi: factor * self.phi,
            speed: factor * self.speed,
            growth: self.growth,
        }
    }

    /// Returns the errors at the reference stroke as a multiple of an expert's, averaged over the five inputs.
    pub fn scale(&self) -> f64 {
        self.values().iter().zip(Self::EXPERT.values()).map(|(own, expert)| own / expert).sum::<f64>() / 5.0
    }

    /// Whether there are no errors.
    pub fn is_perfect(&self) -> bool {
        self.values() == [0.0; 5]
    }

    /// Returns the errors at one stroke, without further growth.
    #[inline]
    #[must_use]
    pub fn at(&self, cue: &CueInputs) -> Self {
        let Growth { speed, elevation, is_share } = self.growth;
        let ratio = cue.speed / Self::REFERENCE_SPEED;
        let hand = (1.0 - speed + speed * ratio * ratio).sqrt() * (1.0 + elevation * cue.theta / REFERENCE_ELEVATION);
        Self {
            a: hand * self.a,
            b: hand * self.b,
            theta: hand * self.theta,
            phi: hand * self.phi,
            speed: if is_share { ratio * self.speed } else { self.speed },
            growth: Growth::NONE,
        }
    }

    /// Returns the stroke that results from an attempt at `cue` with these standard normal errors, on balls of `radius` m.
    #[inline]
    pub fn stroke(&self, radius: f64, cue: &CueInputs, errors: &Errors) -> CueInputs {
        let own = self.at(cue);
        CueInputs {
            a: cue.a + own.a / radius * errors[0],
            b: cue.b + own.b / radius * errors[1],
            // A cue is neither below the cloth nor beyond vertical.
            theta: (cue.theta + own.theta * errors[2]).clamp(0.0, MAX_ELEVATION_WITH_ERRORS.max(cue.theta)),
            phi: cue.phi + own.phi * errors[3],
            // A stroke never goes backwards, nor faster than a session file may state (`drills::validity`).
            speed: (cue.speed + own.speed * errors[4]).clamp(1e-3, Self::MAX_SPEED_WITH_ERRORS),
        }
    }

    /// Returns the standard error of one input at the reference stroke, in its unit; for other strokes see [`Skill::at`].
    pub fn error(&self, input: Input) -> f64 {
        let index = input as usize;
        self.values()[index] / ERROR_FORMATS[index].0
    }

    /// Returns the five errors in the order of [`ERROR_FORMATS`] and [`Input::ALL`], in SI units.
    const fn values(&self) -> [f64; 5] {
        [self.a, self.b, self.theta, self.phi, self.speed]
    }
}

impl Default for Skill {
    fn default() -> Self {
        Self::EXPERT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_applied_in_their_units() {
        let cue = CueInputs { a: 0.1, b: 0.0, theta: 0.0, phi: 1.0, speed: 2.0 };
        let stroke = Skill::EXPERT.stroke(0.03, &cue, &[3.0, 0.0, -2.0, 1.0, -1.0]);
        assert!((stroke.a - 0.15).abs() < 1e-12, "1.5 mm on a radius of 30 mm");
        assert_eq!((stroke.b, stroke.theta), (0.0, 0.0), "a cue is not held below the cloth");
        assert!(((stroke.phi - 1.0).to_degrees() - 0.125).abs() < 1e-12 && (stroke.speed - 1.925).abs() < 1e-12);
    }

    #[test]
    fn errors_never_tilt_the_cue_past_vertical() {
        for degrees in [80.0, 89.95_f64] {
            let cue = CueInputs { a: 0.0, b: 0.0, theta: degrees.to_radians(), phi: 0.0, speed: 2.0 };
            // 40° too steep by one standard error of a player with such large errors.
            let steepest = Skill { theta: 40.0_f64.to_radians(), ..Skill::CLUB }.stroke(0.03, &cue, &[1.0; 5]);
            steepest.validate().unwrap();
            assert!(steepest.theta >= cue.theta, "{steepest:?}");
        }
    }

    #[test]
    fn errors_grow_with_speed_and_elevation() {
        let cue = CueInputs { a: 0.0, b: 0.0, theta: 0.0, phi: 0.0, speed: Skill::REFERENCE_SPEED };
        let (hard, raised) = (CueInputs { speed: 5.0, ..cue }, CueInputs { theta: REFERENCE_ELEVATION, ..cue });
        let skill = Skill { growth: Growth::USUAL, ..Skill::EXPERT };
        assert_eq!(skill.at(&cue), Skill::EXPERT, "the reference stroke");
        let growth = skill.at(&hard).phi / skill.phi;
        assert!((growth - 2.5_f64.sqrt()).abs() < 1e-12, "half of the variance is four times as large: {growth}");
        assert!((skill.at(&hard).speed - 0.15).abs() < 1e-12 && (skill.at(&raised).a / skill.a - 2.0).abs() < 1e-12);
        for stroke in [cue, hard, raised] {
            assert_eq!(Skill::EXPERT.at(&stroke), Skill::EXPERT, "five numbers alone do not grow");
        }
    }
}
