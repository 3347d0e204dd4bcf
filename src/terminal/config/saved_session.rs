//! The state of the last session, from which the next one can continue.

use std::{collections::HashSet, path::Path};

use serde::{Deserialize, Serialize};

use crate::{
    coach::{FirstContact, Skill},
    drills::Session,
    game::Rule,
    storage::{self, describe_json_error},
    table::{CueBall, Layout, Table, is_default},
    terminal::Terms,
};

/// Version of the file format.
const VERSION: u32 = 1;

/// Most earlier sessions kept with the last one, and as many with an unfinished exam, game or match.
const MAX_FORMER: usize = 4;

/// The part of the file with its version.
#[derive(Deserialize)]
struct Header {
    version: u32,
}

/// Saved state of a session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedSession {
    version: u32,
    /// The table.
    pub table: Table,
    /// Positions of the balls.
    pub layout: Layout,
    /// Which ball was the cue ball.
    #[serde(default, skip_serializing_if = "is_default")]
    pub cue_ball: CueBall,
    /// The rule.
    pub rule: Rule,
    /// The player's skill.
    pub skill: Skill,
    /// Whether the next point counted too.
    pub plan: bool,
    /// The values of these three terms in the settings of that time: a setting that was changed since takes precedence over the saved
    /// value. `None` in files of older versions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<Terms>,
    /// The practice session, if it was open on the screen and unfinished.
    #[serde(default)]
    pub practice: Option<Session>,
    /// Earlier sessions that were not continued since, the latest first: a key pressed by mistake at the start must not overwrite them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    former: Vec<Self>,
}

impl SavedSession {
    /// Creates the saved state of the present screens.
    pub fn new(table: Table, layout: Layout, cue_ball: CueBall, terms: Terms, practice: Option<Session>) -> Self {
        let Terms { rule, skill, plan, .. } = terms;
        let (settings, former) = (None, Vec::new());
        Self { version: VERSION, table, layout, cue_ball, rule, skill, plan, settings, practice, former }
    }

    /// Records the terms that the settings had.
    #[must_use]
    pub fn with_settings(self, settings: Terms) -> Self {
        Self { settings: Some(settings), ..self }
    }

    /// The terms of the questions to the coach.
    pub const fn terms(&self) -> Terms {
        Terms { rule: self.rule, skill: self.skill, plan: self.plan, first: FirstContact::Any }
    }

    /// Appends earlier sessions that were not continued, the latest first.
    #[must_use]
    pub fn with_former_sessions(self, mut former: Vec<Self>) -> Self {
        let mut counts = [0; 2];
        former.retain(|session| {
            let is_offered = session.practice.as_ref().is_some_and(|practice| practice.is_exam() || practice.is_game());
            let count = &mut counts[usize::from(is_offered)];
            *count += 1;
            *count <= MAX_FORMER
        });
        Self { former, ..self }
    }

    /// Joins sessions, the latest first, as [`into_sessions`](Self::into_sessions) returns them. `None` if there is none.
    pub fn of_sessions(sessions: &[Self]) -> Option<Self> {
        let (last, former) = sessions.split_first()?;
        Some(last.clone().with_former_sessions(former.to_vec()))
    }

    /// Adds to the sessions of this program the unfinished exams, games and matches of others that are running: those `stored` in the file
    /// that are not among the `known` ones, which this program has loaded or saved. `None` if there are none.
    pub fn with_those_of_others(mine: Option<Self>, stored: Option<Self>, known: &HashSet<String>) -> Option<Self> {
        let mut sessions = mine.map_or_else(Vec::new, Self::into_sessions);
        let is_of_another = |session: &Self| {
            let offered = session.practice.as_ref().filter(|practice| practice.is_exam() || practice.is_game());
            offered.is_some_and(|practice| !known.contains(&practice.id))
        };
        sessions.extend(stored.map_or_else(Vec::new, Self::into_sessions).into_iter().filter(is_of_another));
        Self::of_sessions(&sessions)
    }

    /// Returns the identifiers of the practice sessions.
    pub fn practice_ids(&self) -> impl Iterator<Item = String> {
        [self].into_iter().chain(&self.former).filter_map(|session| Some(session.practice.as_ref()?.id.clone()))
    }

    /// Loads the file; `None` if it does not exist.
    ///
    /// # Errors
    /// Why the session cannot be continued: the file cannot be read, is damaged, or has a newer version.
    pub fn load(path: &Path) -> Result<Option<Self>, String> {
        let bytes = storage::read_if_exists(path, storage::MAX_PRACTICE_FILE).map_err(|error| error.to_string())?;
        let Some(bytes) = bytes else { return Ok(None) };
        let damage = |error| format!("it is damaged: {}", describe_json_error(&error));
        let header: Header = serde_json::from_slice(&bytes).map_err(damage)?;
        if header.version != VERSION {
            return Err(format!("it is of version {}, but this program reads version {VERSION}", header.version));
        }
        serde_json::from_slice::<Self>(&bytes).map_err(damage)?.checked().map(Some)
    }

    /// Replaces an outdated table and checks that the balls can lie on it.
    fn checked(mut self) -> Result<Self, String> {
        self.table = renewed(self.table);
        self.layout.validate(&self.table).map_err(|error| format!("it is damaged: {error}"))?;
        Ok(self)
    }

    /// Loads the file at the start of the program. A file that cannot be used is set aside, since this session will overwrite it.
    ///
    /// # Errors
    /// The message about such a file.
    pub fn load_or_rename_unreadable(path: &Path) -> Result<Option<Self>, String> {
        Self::load(path).map_err(|error| {
            format!(
                "{}: {error}; the last session cannot be continued, and {}",
                path.display(),
                storage::rename_unreadable(path)
            )
        })
    }

    /// Returns this session followed by the earlier ones. A practice session that occurs several times stays only in the latest.
    pub fn into_sessions(mut self) -> Vec<Self> {
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
}

/// Replaces the table that "match" meant in older versions by the one that it means now.
fn renewed(table: Table) -> Table {
    let is_former = |textbook: Table| Table { name: table.name.clone(), ..textbook } == table;
    if table.name == "match" && Table::preset("textbook").is_ok_and(is_former) { Table::default() } else { table }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        drills::{Exercise, Goal, Venue},
        storage::save_json,
    };

    fn session(table: Table) -> SavedSession {
        let terms = Terms { rule: Rule::OneCushion, skill: Skill::CLUB, plan: false, first: FirstContact::Any };
        let layout = Layout::opening(&table);
        SavedSession::new(table, layout, CueBall::White, terms, None)
    }

    #[test]
    fn a_session_is_read_back_and_other_content_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state/last.json");
        assert_eq!(SavedSession::load(&path), Ok(None));
        let last = session(Table::default());
        let refused = |what: &str| {
            let said = SavedSession::load(&path).unwrap_err();
            assert!(said.starts_with(what), "{said}");
        };
        save_json(&path, &last).unwrap();
        assert_eq!(SavedSession::load(&path).as_ref(), Ok(&Some(last.clone())));
        // After some thousand attempts, a session is larger than one mebibyte.
        let mut long = std::fs::read(&path).unwrap();
        long.resize(2 << 20, b' ');
        std::fs::write(&path, long).unwrap();
        assert_eq!(SavedSession::load(&path).as_ref(), Ok(&Some(last.clone())));
        let newer = SavedSession { version: VERSION + 1, ..last.clone() };
        save_json(&path, &newer).unwrap();
        refused("it is of version 2");
        let mut impossible = last;
        impossible.layout.balls[1] = impossible.layout.balls[0];
        save_json(&path, &impossible).unwrap();
        refused("it is damaged");
        let mut endless = session(Table::default());
        endless.table.sliding_friction = 0.0;
        save_json(&path, &endless).unwrap();
        refused("it is damaged");
        std::fs::write(&path, "{").unwrap();
        refused("it is damaged");
        let said = SavedSession::load_or_rename_unreadable(&path).unwrap_err();
        assert!(said.contains("last.json: it is damaged") && said.contains("last.unread.json"), "{said}");
        assert_eq!(std::fs::read(path.with_extension("unread.json")).unwrap(), b"{");
        assert_eq!(SavedSession::load_or_rename_unreadable(&path), Ok(None));
    }

    #[test]
    fn a_session_of_an_older_version_has_no_settings() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let last = session(Table::default());
        save_json(&path, &last).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(!text.contains("settings"), "as older versions wrote it: {text}");
        assert_eq!(SavedSession::load(&path).unwrap().unwrap().settings, None);
        let set = Terms { skill: Skill::EXPERT, ..last.terms() };
        save_json(&path, &last.with_settings(set)).unwrap();
        assert_eq!(SavedSession::load(&path).unwrap().unwrap().settings, Some(set));
    }

    #[test]
    fn former_sessions_are_kept_until_they_are_continued() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let by = |number: u32| {
            let mut session = session(Table::default());
            session.layout.balls[2].y = 0.05 * f64::from(number);
            session
        };
        for number in 1..=9 {
            let former = SavedSession::load(&path).unwrap().map_or_else(Vec::new, SavedSession::into_sessions);
            save_json(&path, &by(number).with_former_sessions(former)).unwrap();
        }
        let kept = SavedSession::load(&path).unwrap().unwrap().into_sessions();
        assert_eq!(kept, (1..=9).rev().take(1 + MAX_FORMER).map(by).collect::<Vec<_>>());
    }

    #[test]
    fn an_unfinished_match_outlives_any_number_of_later_sessions() {
        let half_ball = Exercise::new_own("half-ball", Rule::StraightRail, "match", Layout::opening(&Table::default()));
        let goal = Goal::Match { innings: 10, points: 0, against_coach: true };
        let open = Session::new(goal, Venue::Program, vec![half_ball], Skill::CLUB, 1);
        let mut last = SavedSession { practice: Some(open.clone()), ..session(Table::default()) };
        for _ in 0..20 {
            last = session(Table::default()).with_former_sessions(last.into_sessions());
        }
        let practised: Vec<_> = last.into_sessions().into_iter().filter_map(|before| before.practice).collect();
        assert_eq!(practised, [open]);
    }

    #[test]
    fn a_program_keeps_the_unfinished_match_of_another_one_until_that_one_ends_it() {
        let half_ball = Exercise::new_own("half-ball", Rule::StraightRail, "match", Layout::opening(&Table::default()));
        let playing = |seed: u64| {
            let goal = Goal::Match { innings: 10, points: 0, against_coach: true };
            let open = Session::new(goal, Venue::Program, vec![half_ball.clone()], Skill::CLUB, seed);
            SavedSession { practice: Some(Session { id: seed.to_string(), ..open }), ..session(Table::default()) }
        };
        let open = |saved: &Option<SavedSession>| saved.iter().flat_map(SavedSession::practice_ids).collect::<Vec<_>>();
        let ids = |saved: &SavedSession| saved.practice_ids().collect::<HashSet<_>>();
        let (mine, other) = (playing(1), playing(2));
        let both = SavedSession::with_those_of_others(Some(mine.clone()), Some(other.clone()), &ids(&mine));
        assert_eq!(open(&both), ["1", "2"]);
        // The other program plays on, and does not keep its own older state.
        let again = SavedSession::with_those_of_others(Some(other.clone()), both, &ids(&other));
        assert_eq!(open(&again), ["2", "1"]);
        // My match is over; the file still has it.
        let over = SavedSession::with_those_of_others(Some(session(Table::default())), again.clone(), &ids(&mine));
        assert_eq!(open(&over), ["2"]);
        assert_eq!(open(&SavedSession::with_those_of_others(None, again, &ids(&mine))), ["2"]);
        assert_eq!(SavedSession::with_those_of_others(None, Some(mine.clone()), &ids(&mine)), None);
    }

    #[test]
    fn a_session_on_the_former_match_table_moves_to_the_present_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("last.json");
        let on = |textbook: &str, name: &str| {
            let table = Table { name: name.to_owned(), ..Table::preset(textbook).unwrap() };
            save_json(&path, &session(table)).unwrap();
            SavedSession::load(&path).unwrap().unwrap().table
        };
        assert_eq!(on("textbook", "match"), Table::default());
        assert_eq!(on("thesis", "match").length, Table::preset("thesis").unwrap().length, "somebody's own");
        assert_eq!(on("textbook", "textbook"), Table::preset("textbook").unwrap());
    }
}
