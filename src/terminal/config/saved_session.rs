//! Where the last session ended, so that the next one can go on from there.

use std::{borrow::Cow, io, path::Path};

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

/// Most former sessions that are kept with the last one.
const MOST_FORMER: usize = 4;

/// What is remembered of a session. What is large is borrowed from the screens until it is written down: whether anything has
/// changed since is asked at every wake.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedSession<'a> {
    version: u32,
    /// The table.
    pub table: Cow<'a, Table>,
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
    pub practice: Option<Cow<'a, Session>>,
    /// Sessions before it that nobody has gone on with since, the latest first: a key that was pressed by mistake at the start
    /// does not take the place of what was there.
    #[serde(default, skip_serializing_if = "<[_]>::is_empty")]
    former: Cow<'a, [SavedSession<'static>]>,
}

impl<'a> SavedSession<'a> {
    /// What is to be remembered of the screens.
    pub fn new(
        table: &'a Table,
        layout: Layout,
        cue_ball: CueBall,
        rule: Rule,
        skill: Skill,
        plan: bool,
        practice: Option<&'a Session>,
    ) -> Self {
        let (table, practice) = (Cow::Borrowed(table), practice.map(Cow::Borrowed));
        Self { version: VERSION, table, layout, cue_ball, rule, skill, plan, practice, former: Cow::Borrowed(&[]) }
    }

    /// The same after former sessions that were not gone on with, the latest first.
    #[must_use]
    pub fn after(mut self, former: &'a [SavedSession<'static>]) -> Self {
        self.former = Cow::Borrowed(&former[..former.len().min(MOST_FORMER)]);
        self
    }

    /// The same with nothing borrowed.
    pub fn into_owned(self) -> SavedSession<'static> {
        let Self { version, table, layout, cue_ball, rule, skill, plan, practice, former } = self;
        let practice = practice.map(|practice| Cow::Owned(practice.into_owned()));
        let (table, former) = (Cow::Owned(table.into_owned()), Cow::Owned(former.into_owned()));
        SavedSession { version, table, layout, cue_ball, rule, skill, plan, practice, former }
    }

    /// What the file says. One that is missing, damaged or from a newer version says nothing: it is a convenience, and
    /// the player need not know.
    pub fn load(path: &Path) -> Option<Self> {
        let last: Self = serde_json::from_slice(&storage::read(path, storage::PRACTICE).ok()?).ok()?;
        last.checked()
    }

    /// The same on the table that it means now, if it is one that can be gone on with.
    fn checked(mut self) -> Option<Self> {
        self.table = Cow::Owned(renewed(self.table.into_owned()));
        (self.version == VERSION && self.layout.validate(&self.table).is_ok()).then_some(self)
    }

    /// It, then the former sessions, each by itself. What was practised in several is gone on with in the latest.
    pub fn with_former(mut self) -> Vec<SavedSession<'static>> {
        let former = std::mem::take(&mut self.former).into_owned();
        let mut sessions = vec![self.into_owned()];
        for mut session in former.into_iter().filter_map(SavedSession::checked) {
            let practised = |session: &SavedSession| session.practice.as_ref().map(|practice| practice.id.clone());
            if sessions.iter().any(|later| practised(later) == practised(&session)) {
                session.practice = None;
            }
            sessions.push(session);
        }
        sessions
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

/// The table that the name "match" means now, where this is the one that it meant in older versions.
fn renewed(table: Table) -> Table {
    let is_former = |textbook: Table| Table { name: table.name.clone(), ..textbook } == table;
    if table.name == "match" && Table::preset("textbook").is_ok_and(is_former) { Table::default() } else { table }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn session(table: &Table) -> SavedSession<'_> {
        SavedSession::new(table, Layout::opening(table), CueBall::White, Rule::OneCushion, Skill::CLUB, false, None)
    }

    #[test]
    fn a_session_is_read_back_and_whatever_else_stands_there_is_ignored() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state/last.json");
        assert_eq!(SavedSession::load(&path), None);
        let table = Table::default();
        let last = session(&table);
        last.save(&path).unwrap();
        assert_eq!(SavedSession::load(&path), Some(last.clone()));
        // After some thousand attempts a session has more than a mebibyte.
        let mut long = std::fs::read(&path).unwrap();
        long.resize(2 << 20, b' ');
        std::fs::write(&path, long).unwrap();
        assert_eq!(SavedSession::load(&path), Some(last.clone()));
        let newer = SavedSession { version: VERSION + 1, ..last.clone() };
        newer.save(&path).unwrap();
        assert_eq!(SavedSession::load(&path), None);
        let mut impossible = last;
        impossible.layout.balls[1] = impossible.layout.balls[0];
        impossible.save(&path).unwrap();
        assert_eq!(SavedSession::load(&path), None);
        let mut endless = session(&table);
        endless.table.to_mut().sliding_friction = 0.0;
        endless.save(&path).unwrap();
        assert_eq!(SavedSession::load(&path), None, "no shot would end on this table");
        std::fs::write(&path, "{").unwrap();
        assert_eq!(SavedSession::load(&path), None);
    }

    #[test]
    fn former_sessions_are_kept_with_the_last_one_as_long_as_nobody_goes_on_with_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let table = Table::default();
        let by = |skill: Skill| SavedSession { skill, ..session(&table) }.into_owned();
        let skills: Vec<Skill> = (1..=9).map(|number| Skill::CLUB.scaled(0.1 * f64::from(number))).collect();
        for skill in &skills {
            let former = SavedSession::load(&path).map_or_else(Vec::new, SavedSession::with_former);
            by(*skill).after(&former).save(&path).unwrap();
        }
        let kept = SavedSession::load(&path).unwrap().with_former();
        let expected: Vec<SavedSession> = skills.iter().rev().take(1 + MOST_FORMER).map(|skill| by(*skill)).collect();
        assert_eq!(kept, expected);
    }

    #[test]
    fn a_session_on_the_former_match_table_goes_on_on_the_present_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let on = |textbook: &str, name: &str| {
            let table = Table { name: name.to_owned(), ..Table::preset(textbook).unwrap() };
            session(&table).save(&path).unwrap();
            SavedSession::load(&path).unwrap().table.into_owned()
        };
        assert_eq!(on("textbook", "match"), Table::default());
        assert_eq!(on("thesis", "match").length, Table::preset("thesis").unwrap().length, "somebody's own");
        assert_eq!(on("textbook", "textbook"), Table::preset("textbook").unwrap());
    }
}
