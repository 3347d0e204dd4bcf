//! Where the last session ended, so that the next one can go on from there.

use std::{io, path::Path};

use serde::{Deserialize, Serialize};

use crate::{
    coach::Skill,
    drills::Session,
    game::Rule,
    storage::{self, replace},
    table::{CueBall, Layout, Table},
};

/// The version of the file that is written.
const VERSION: u32 = 1;

/// What is remembered of a session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Last {
    version: u32,
    /// The table.
    pub table: Table,
    /// Where the balls lay.
    pub layout: Layout,
    /// Which of them was the cue ball.
    #[serde(default, skip_serializing_if = "CueBall::is_white")]
    pub cue_ball: CueBall,
    /// What counted as a point.
    pub rule: Rule,
    /// Who played.
    pub skill: Skill,
    /// Whether the next point counted too.
    pub plan: bool,
    /// What was practised, where that was on the screen and not over.
    #[serde(default)]
    pub practice: Option<Session>,
}

impl Last {
    /// What is to be remembered of the coach's screen.
    pub const fn new(table: Table, layout: Layout, rule: Rule, skill: Skill, plan: bool) -> Self {
        Self { version: VERSION, table, layout, cue_ball: CueBall::White, rule, skill, plan, practice: None }
    }

    /// The same with another cue ball.
    #[must_use]
    pub fn with_cue_ball(self, cue_ball: CueBall) -> Self {
        Self { cue_ball, ..self }
    }

    /// The same with what is practised.
    #[must_use]
    pub fn with_practice(self, practice: Option<Session>) -> Self {
        Self { practice, ..self }
    }

    /// What the file says. One that is missing, damaged or from a newer version says nothing: it is a convenience, and
    /// nobody is to be bothered about it.
    pub fn load(path: &Path) -> Option<Self> {
        let last: Self = serde_json::from_slice(&storage::read(path, storage::SMALL).ok()?).ok()?;
        (last.version == VERSION && last.layout.validate(&last.table).is_ok()).then_some(last)
    }

    /// Writes it down.
    ///
    /// # Errors
    /// Whatever the file system reports; what stood there stays.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let bytes = serde_json::to_vec(self).map_err(io::Error::from)?;
        replace(path, &bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_session_is_read_back_and_whatever_else_stands_there_is_ignored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state/last.json");
        assert_eq!(Last::load(&path), None);
        let table = Table::default();
        let last = Last::new(table.clone(), Layout::opening(&table), Rule::OneCushion, Skill::CLUB, false);
        last.save(&path).unwrap();
        assert_eq!(Last::load(&path), Some(last.clone()));
        let newer = Last { version: VERSION + 1, ..last.clone() };
        newer.save(&path).unwrap();
        assert_eq!(Last::load(&path), None);
        let mut impossible = last;
        impossible.layout.balls[1] = impossible.layout.balls[0];
        impossible.save(&path).unwrap();
        assert_eq!(Last::load(&path), None);
        let mut endless = Last::new(table.clone(), Layout::opening(&table), Rule::OneCushion, Skill::CLUB, false);
        endless.table.sliding_friction = 0.0;
        endless.save(&path).unwrap();
        assert_eq!(Last::load(&path), None, "no shot would end on this table");
        std::fs::write(&path, "{").unwrap();
        assert_eq!(Last::load(&path), None);
    }
}
