//! A position to practise: the layout, the rule, and the lesson.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::{
    game::Rule,
    physics::{CueError, CueInputs, ImpulseError, has_room},
    simulation::ShotError,
    storage::{NAME_RULE, is_name},
    table::{Layout, LayoutError, PRESETS, Table},
};

/// The topic of an exercise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Category {
    /// Plain caroms from one ball to the other.
    FirstCaroms,
    /// The cue ball returns from the first ball.
    Draw,
    /// The cue ball runs on after the first ball.
    Follow,
    /// Side spin (english) makes the point.
    Side,
    /// A cushion before the second ball.
    OneCushion,
    /// The balls stay or come together (rappel).
    Gather,
    /// The patterns of three-cushion.
    ThreeCushion,
    /// Diamond systems.
    Systems,
    /// The cue is raised, and the cue ball leaves the cloth or runs in a curve. Most clubs forbid it.
    JumpAndMasse,
    /// A user's own position.
    Own,
}

impl Category {
    /// All categories, in the order of the library.
    pub const ALL: [Self; 10] = [
        Self::FirstCaroms,
        Self::Draw,
        Self::Follow,
        Self::Side,
        Self::OneCushion,
        Self::Gather,
        Self::ThreeCushion,
        Self::Systems,
        Self::JumpAndMasse,
        Self::Own,
    ];

    /// Returns the name on the command line and in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FirstCaroms => "first-caroms",
            Self::Draw => "draw",
            Self::Follow => "follow",
            Self::Side => "side",
            Self::OneCushion => "one-cushion",
            Self::Gather => "gather",
            Self::ThreeCushion => "three-cushion",
            Self::Systems => "systems",
            Self::JumpAndMasse => "jump-and-masse",
            Self::Own => "own",
        }
    }

    /// Returns the heading on the screen.
    pub const fn title(self) -> &'static str {
        match self {
            Self::FirstCaroms => "First caroms",
            Self::Draw => "Draw",
            Self::Follow => "Follow",
            Self::Side => "Side",
            Self::OneCushion => "One cushion",
            Self::Gather => "Gather and rappel",
            Self::ThreeCushion => "Three-cushion patterns",
            Self::Systems => "Diamond systems",
            Self::JumpAndMasse => "Jumps and massés",
            Self::Own => "My positions",
        }
    }
}

impl fmt::Display for Category {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// How often players of the named skills make the exercise's own shot, shares from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Par {
    /// A beginner.
    pub beginner: f64,
    /// A club player.
    pub club: f64,
    /// A world-class player; files of older versions have an expert's share instead.
    #[serde(rename = "world-class", alias = "expert")]
    pub world_class: f64,
}

/// A position to practise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Exercise {
    /// Identifier on the command line and in files, by [`NAME_RULE`]; unique in the library.
    pub name: String,
    /// Heading, a few words.
    pub title: String,
    /// The topic.
    pub category: Category,
    /// Difficulty: 1 is the easiest, 5 the hardest; 0 if it has not been measured.
    #[serde(default)]
    pub grade: u8,
    /// The rule of the point.
    #[serde(default)]
    pub rule: Rule,
    /// Name of the bundled table that it is designed for.
    #[serde(default = "match_table")]
    pub table: String,
    /// The ball positions, m.
    pub layout: Layout,
    /// The lesson, a sentence or two for the player.
    #[serde(default)]
    pub point: String,
    /// Search tags.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tags: Vec<String>,
    /// The model shot: a shot that makes the point as the lesson teaches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shot: Option<CueInputs>,
    /// How often players make the model shot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub par: Option<Par>,
}

/// Maximum length of a title or tag that a player enters, bytes; files may have longer ones.
pub const MAX_TITLE_BYTES: usize = 400;

/// Maximum length of a point that a player enters, bytes: some sentences.
pub const MAX_POINT_BYTES: usize = 4000;

/// Returns a tag without the `#` with which it is displayed and may be typed.
pub fn bare_tag(tag: &str) -> &str {
    tag.trim_start_matches('#')
}

pub(super) fn match_table() -> String {
    "match".to_owned()
}

/// Why an exercise cannot be played.
#[derive(Debug, thiserror::Error)]
pub enum ExerciseError {
    /// The name is not valid on the command line or in a file.
    #[error("{0:?} is not a valid exercise name; accepted are {NAME_RULE}")]
    Name(String),
    /// A text contains characters that would move the cursor or reverse the text direction.
    #[error("the {field} {text:?} has a character that cannot be shown; accepted is one line of text")]
    Text {
        /// The field that contains the text.
        field: &'static str,
        /// The text.
        text: String,
    },
    /// The table is not a bundled one.
    #[error("{0:?} is not a bundled table; accepted are {names}", names = PRESETS.join(", "))]
    Table(String),
    /// The grade is above 5.
    #[error("grade {0} is not accepted; grades are 0 (none) to 5")]
    Grade(u8),
    /// A make rate is not from 0 to 1.
    #[error("{0} is not a valid make rate; accepted is a number from 0 to 1")]
    Share(f64),
    /// The layout is impossible.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The shot is impossible.
    #[error(transparent)]
    Shot(#[from] CueError),
    /// The motion that the shot gives to the cue ball is impossible.
    #[error(transparent)]
    Motion(#[from] ImpulseError),
}

impl From<ShotError> for ExerciseError {
    fn from(error: ShotError) -> Self {
        match error {
            ShotError::Layout(error) => Self::Layout(error),
            ShotError::Cue(error) => Self::Shot(error),
            ShotError::Impulse(error) => Self::Motion(error),
        }
    }
}

impl Exercise {
    /// Creates an own exercise of the player on the bundled `table`, with `name` as its title and without a lesson.
    pub fn new_own(name: &str, rule: Rule, table: &str, layout: Layout) -> Self {
        Self {
            name: name.to_owned(),
            title: name.to_owned(),
            category: Category::Own,
            grade: 0,
            rule,
            table: table.to_owned(),
            layout,
            point: String::new(),
            tags: Vec::new(),
            shot: None,
            par: None,
        }
    }

    /// Returns the table of the exercise.
    ///
    /// # Errors
    /// Fails if the table is not bundled, or the layout is impossible on it.
    pub fn table(&self) -> Result<Table, ExerciseError> {
        let table = Table::preset(&self.table).map_err(|_| ExerciseError::Table(self.table.clone()))?;
        self.layout.validate(&table)?;
        Ok(table)
    }

    /// Returns the table on which it is played: the player's `own` if it has the same size, otherwise the exercise's.
    ///
    /// # Errors
    /// As for [`Exercise::table`].
    pub fn table_with(&self, own: Option<&Table>) -> Result<Table, ExerciseError> {
        let table = self.table()?;
        Ok(own.filter(|own| own.has_size_of(&table)).cloned().unwrap_or(table))
    }

    /// Whether the other exercise has the same name, table, layout and rule. Positions are compared to a nanometre and model shots not at all:
    /// those that were written to a file are not read back to the last bit.
    pub fn has_same_task(&self, other: &Self) -> bool {
        let mut balls = self.layout.balls.iter().zip(&other.layout.balls);
        (&self.name, &self.table, self.rule) == (&other.name, &other.table, other.rule)
            && balls.all(|(own, other)| own.distance(*other) < 1e-9)
    }

    /// Whether it has this tag.
    pub fn has_tag(&self, tag: &str) -> bool {
        self.tags.iter().any(|own| own == tag)
    }

    /// Returns the model shot; `None` if there is none, or the cue has no room for it.
    pub fn model_shot(&self) -> Option<CueInputs> {
        let table = self.table().ok()?;
        self.shot.filter(|shot| has_room(&table, &self.layout, shot))
    }

    /// Validates the name, the texts, the grade, the par, the table, the layout and the shot.
    ///
    /// # Errors
    /// Fails with the first problem found.
    pub fn validate(&self) -> Result<(), ExerciseError> {
        if !is_name(&self.name) {
            return Err(ExerciseError::Name(self.name.clone()));
        }
        let words = [("title", &self.title), ("point", &self.point)].into_iter();
        for (field, text) in words.chain(self.tags.iter().map(|tag| ("tag", tag))) {
            if text.chars().any(is_command) {
                return Err(ExerciseError::Text { field, text: text.clone() });
            }
        }
        if self.grade > MAX_GRADE {
            return Err(ExerciseError::Grade(self.grade));
        }
        let shares = self.par.map(|par| [par.beginner, par.club, par.world_class]);
        shares.into_iter().flatten().try_for_each(check_share)?;
        let table = self.table()?;
        if let Some(shot) = &self.shot {
            shot.validate()?;
            shot.validate_tip(table.miscue_limit)?;
        }
        Ok(())
    }
}

/// Maximum grade.
const MAX_GRADE: u8 = 5;

/// Checks a make rate.
pub(super) fn check_share(share: f64) -> Result<(), ExerciseError> {
    if (0.0..=1.0).contains(&share) { Ok(()) } else { Err(ExerciseError::Share(share)) }
}

/// Whether a terminal interprets this as a command instead of a letter: control characters, line ends, and marks that
/// change the text direction. A subset of [`is_hidden`](crate::printing::is_hidden), so that texts that earlier
/// versions accepted can still be read.
fn is_command(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drills::session::tests::exercise;

    #[test]
    fn control_characters_are_refused_and_never_echoed() {
        for text in ["a\u{1b}[2Jb", "two\nlines", "turned \u{202e}round", "bell\u{7}", "\u{9b}31m"] {
            let wrong = [
                Exercise { title: text.to_owned(), ..exercise("one") },
                Exercise { point: text.to_owned(), ..exercise("one") },
                Exercise { tags: vec![text.to_owned()], ..exercise("one") },
                exercise(text),
            ];
            for wrong in wrong {
                let said = wrong.validate().unwrap_err().to_string();
                assert!(!said.contains(is_command), "{said:?}");
            }
        }
        let title = "日本語 🎱 é".to_owned();
        Exercise { title, ..exercise("one") }.validate().unwrap();
    }

    #[test]
    fn invalid_grades_shares_and_tables_name_accepted_values() {
        let par = |share| Some(Par { beginner: 0.0, club: share, world_class: 1.0 });
        Exercise { grade: 5, par: par(0.5), ..exercise("one") }.validate().unwrap();
        for (wrong, says) in [
            (Exercise { grade: 6, ..exercise("one") }, "to 5"),
            (Exercise { par: par(7e10), ..exercise("one") }, "from 0 to 1"),
            (Exercise { par: par(f64::NAN), ..exercise("one") }, "from 0 to 1"),
            (Exercise { table: "mine".to_owned(), ..exercise("one") }, "accepted are match, textbook, thesis"),
        ] {
            let said = wrong.validate().unwrap_err().to_string();
            assert!(said.contains(says), "{said}");
        }
    }
}
