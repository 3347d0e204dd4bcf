//! Where the last session ended, so that the next one can go on from there.

use std::{io, path::Path};

use serde::{Deserialize, Serialize};

use crate::{
    coach::{FirstMet, Skill},
    drills::Session,
    game::Rule,
    storage::{self, json_flaw, replace},
    table::{CueBall, Layout, Table},
    terminal::Terms,
};

/// The version of the file that is written.
const VERSION: u32 = 1;

/// Most former sessions that are kept with the last one.
const MOST_FORMER: usize = 4;

/// The part of the file that tells its version.
#[derive(Deserialize)]
struct Header {
    version: u32,
}

/// What is remembered of a session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedSession {
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
    /// What the settings said of these three: what has been set otherwise since goes before what was left here. Older versions
    /// did not keep it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<Terms>,
    /// What was practised, where that was on the screen and not over.
    #[serde(default)]
    pub practice: Option<Session>,
    /// Sessions before it that nobody has gone on with since, the latest first: a key that was pressed by mistake at the start
    /// does not take the place of what was there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    former: Vec<Self>,
}

impl SavedSession {
    /// What is to be remembered of the screens.
    pub fn new(table: Table, layout: Layout, cue_ball: CueBall, terms: Terms, practice: Option<Session>) -> Self {
        let Terms { rule, skill, plan, .. } = terms;
        let (settings, former) = (None, Vec::new());
        Self { version: VERSION, table, layout, cue_ball, rule, skill, plan, settings, practice, former }
    }

    /// The same where the settings said this.
    #[must_use]
    pub fn under(self, settings: Terms) -> Self {
        Self { settings: Some(settings), ..self }
    }

    /// What was asked for.
    pub const fn terms(&self) -> Terms {
        Terms { rule: self.rule, skill: self.skill, plan: self.plan, first: FirstMet::Any }
    }

    /// The same, followed by former sessions that were not gone on with, the latest first.
    #[must_use]
    pub fn followed_by(self, mut former: Vec<Self>) -> Self {
        former.truncate(MOST_FORMER);
        Self { former, ..self }
    }

    /// What the file says; nothing where there is none.
    ///
    /// # Errors
    /// Why it cannot be gone on from: it cannot be read, is damaged, or is from a newer version.
    pub fn load(path: &Path) -> Result<Option<Self>, String> {
        let bytes = storage::read_if_there(path, storage::PRACTICE).map_err(|error| error.to_string())?;
        let Some(bytes) = bytes else { return Ok(None) };
        let damage = |error| format!("it is damaged: {}", json_flaw(&error));
        let header: Header = serde_json::from_slice(&bytes).map_err(damage)?;
        if header.version != VERSION {
            return Err(format!("it is of version {}, and {VERSION} is understood", header.version));
        }
        serde_json::from_slice::<Self>(&bytes).map_err(damage)?.checked().map(Some)
    }

    /// The same on the table that it means now, if the balls can lie there.
    fn checked(mut self) -> Result<Self, String> {
        self.table = renewed(self.table);
        self.layout.validate(&self.table).map_err(|error| format!("it is damaged: {error}"))?;
        Ok(self)
    }

    /// The same at the start of the program: a file that cannot be gone on from is put aside, since this session will be
    /// written in its place.
    ///
    /// # Errors
    /// A sentence about that.
    pub fn load_or_put_aside(path: &Path) -> Result<Option<Self>, String> {
        Self::load(path).map_err(|error| {
            format!(
                "{}: {error}; the last session cannot be gone on with, and {}",
                path.display(),
                storage::put_aside(path)
            )
        })
    }

    /// It, then the former sessions, each by itself. What was practised in several is gone on with in the latest.
    pub fn with_former(mut self) -> Vec<Self> {
        let former = std::mem::take(&mut self.former);
        let mut sessions = vec![self];
        for mut session in former.into_iter().flat_map(Self::checked) {
            let practised = |session: &Self| session.practice.as_ref().map(|practice| practice.id.clone());
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

    fn session(table: Table) -> SavedSession {
        let terms = Terms { rule: Rule::OneCushion, skill: Skill::CLUB, plan: false, first: FirstMet::Any };
        let layout = Layout::opening(&table);
        SavedSession::new(table, layout, CueBall::White, terms, None)
    }

    #[test]
    fn a_session_is_read_back_and_whatever_else_stands_there_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state/last.json");
        assert_eq!(SavedSession::load(&path), Ok(None));
        let last = session(Table::default());
        let refused = |what: &str| {
            let said = SavedSession::load(&path).unwrap_err();
            assert!(said.starts_with(what), "{said}");
        };
        last.save(&path).unwrap();
        assert_eq!(SavedSession::load(&path).as_ref(), Ok(&Some(last.clone())));
        // After some thousand attempts a session has more than a mebibyte.
        let mut long = std::fs::read(&path).unwrap();
        long.resize(2 << 20, b' ');
        std::fs::write(&path, long).unwrap();
        assert_eq!(SavedSession::load(&path).as_ref(), Ok(&Some(last.clone())));
        let newer = SavedSession { version: VERSION + 1, ..last.clone() };
        newer.save(&path).unwrap();
        refused("it is of version 2");
        let mut impossible = last;
        impossible.layout.balls[1] = impossible.layout.balls[0];
        impossible.save(&path).unwrap();
        refused("it is damaged");
        let mut endless = session(Table::default());
        endless.table.sliding_friction = 0.0;
        endless.save(&path).unwrap();
        refused("it is damaged");
        std::fs::write(&path, "{").unwrap();
        refused("it is damaged");
        let said = SavedSession::load_or_put_aside(&path).unwrap_err();
        assert!(said.contains("last.json: it is damaged") && said.contains("last.unread.json"), "{said}");
        assert_eq!(std::fs::read(path.with_extension("unread.json")).unwrap(), b"{");
        assert_eq!(SavedSession::load_or_put_aside(&path), Ok(None));
    }

    #[test]
    fn a_session_of_an_older_version_does_not_say_what_was_set_then() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let last = session(Table::default());
        last.save(&path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("settings"), "as older versions wrote it: {text}");
        assert_eq!(SavedSession::load(&path).unwrap().unwrap().settings, None);
        let set = Terms { skill: Skill::EXPERT, ..last.terms() };
        last.under(set).save(&path).unwrap();
        assert_eq!(SavedSession::load(&path).unwrap().unwrap().settings, Some(set));
    }

    #[test]
    fn former_sessions_are_kept_with_the_last_one_as_long_as_nobody_goes_on_with_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let by = |number: u32| {
            let mut session = session(Table::default());
            session.layout.balls[2].y = 0.05 * f64::from(number);
            session
        };
        for number in 1..=9 {
            let former = SavedSession::load(&path).unwrap().map_or_else(Vec::new, SavedSession::with_former);
            by(number).followed_by(former).save(&path).unwrap();
        }
        let kept = SavedSession::load(&path).unwrap().unwrap().with_former();
        assert_eq!(kept, (1..=9).rev().take(1 + MOST_FORMER).map(by).collect::<Vec<_>>());
    }

    #[test]
    fn a_session_on_the_former_match_table_goes_on_on_the_present_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let on = |textbook: &str, name: &str| {
            let table = Table { name: name.to_owned(), ..Table::preset(textbook).unwrap() };
            session(table).save(&path).unwrap();
            SavedSession::load(&path).unwrap().unwrap().table
        };
        assert_eq!(on("textbook", "match"), Table::default());
        assert_eq!(on("thesis", "match").length, Table::preset("thesis").unwrap().length, "somebody's own");
        assert_eq!(on("textbook", "textbook"), Table::preset("textbook").unwrap());
    }
}
