//! A recommendation in words.

use std::io::{self, Write};

use serde::Serialize;

use crate::{
    coach::{FirstContact, Pattern, Recommendation, Shooter, ShotWords, Technique, Units, Why, why},
    game::Rule,
    physics::CueInputs,
    simulation::ShotError,
    table::{CueBall, Layout, Table},
};

/// A shot in words: three sentences, and the numbers in them.
#[derive(Serialize)]
pub struct Words {
    sentence: String,
    course: String,
    aim: String,
    #[serde(flatten)]
    numbers: ShotWords,
}

/// Why the shot is ranked first: a sentence, and the facts.
#[derive(Serialize)]
pub struct Reasons {
    sentence: String,
    #[serde(flatten)]
    facts: Why,
}

/// The description of a shot.
#[derive(Serialize)]
pub struct Description {
    /// Absent if the cue ball does not meet both balls.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pattern: Option<&'static str>,
    words: Words,
    #[serde(skip)]
    pattern_course: Option<String>,
}

impl Description {
    /// Describes one shot.
    pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Self, ShotError> {
        let technique = Technique::of(table, layout, cue)?;
        let pattern = Pattern::of(&technique);
        let numbers = ShotWords::of_technique(table, layout, cue, &technique);
        let units = Units::default();
        Ok(Self {
            pattern: pattern.map(|pattern| pattern.name),
            words: Words {
                sentence: numbers.sentence(CueBall::White, units),
                course: numbers.course(CueBall::White, units),
                aim: numbers.aim(units),
                numbers,
            },
            pattern_course: pattern.map(|pattern| pattern.course_of(&technique)),
        })
    }

    /// Prints the description, with the pattern if the shot is `solved`.
    pub fn describe(&self, out: &mut impl Write, units: Units, solved: bool) -> io::Result<()> {
        let numbers = &self.words.numbers;
        writeln!(out, "{}", self.sentence(units))?;
        writeln!(out, "{}", numbers.course(CueBall::White, units))?;
        writeln!(out, "{}", numbers.aim(units))?;
        match (self.pattern, &self.pattern_course) {
            (Some(pattern), Some(course)) if solved => writeln!(out, "Pattern: {pattern} ({course})."),
            _ => Ok(()),
        }
    }

    /// Returns only the sentence about how to strike.
    pub fn sentence(&self, units: Units) -> String {
        self.words.numbers.sentence(CueBall::White, units)
    }

    /// Whether the cue ball meets first what was requested.
    pub fn begins_with(&self, first: FirstContact) -> bool {
        first.allows_words(&self.words.numbers)
    }
}

impl Reasons {
    /// Finds the reasons for a recommendation that makes the point.
    pub fn of(
        shooter: Shooter,
        rule: Rule,
        table: &Table,
        layout: &Layout,
        advice: &Recommendation,
        seed: u64,
    ) -> Result<Self, ShotError> {
        let facts = why(shooter, rule, table, layout, advice, seed)?;
        Ok(Self { sentence: facts.words(CueBall::White, Units::default()), facts })
    }

    /// Prints the reasons.
    pub fn describe(&self, out: &mut impl Write, units: Units) -> io::Result<()> {
        writeln!(out, "Why: {}", self.facts.words(CueBall::White, units))
    }
}
