//! The practice record: all sessions, and the score of every exercise, separately for real tables and for this program.

use std::collections::{BTreeSet, HashMap};

use crate::drills::{Record, Session, Venue};

/// The practice record.
#[derive(Debug, Default)]
pub struct Book {
    /// All sessions, the oldest first.
    pub sessions: Vec<Session>,
    /// The scores by exercise name, one for each venue where the exercise was tried.
    scores: HashMap<String, Vec<(Venue, Record)>>,
    /// One message for each file that could not be read.
    pub troubles: Vec<String>,
    /// Whether the record has been read from the disk.
    pub is_known: bool,
}

impl Book {
    /// Creates the record from what was read from the disk.
    pub fn new(mut sessions: Vec<Session>, troubles: Vec<String>) -> Self {
        sessions.retain(|session| !session.attempts.is_empty());
        sessions.sort_by(|one, other| (one.started, &one.id).cmp(&(other.started, &other.id)));
        let mut book = Self { sessions, scores: HashMap::new(), troubles, is_known: true };
        let names: BTreeSet<String> = book.sessions.iter().flat_map(names).collect();
        book.score(names);
        book
    }

    /// The sessions in which the player repeated the exercise `name`, games excluded; if `None`, those with any attempt by the player.
    pub fn sessions_of(&self, name: Option<&str>) -> Vec<&Session> {
        let is_of = |session: &&Session| {
            let is_wanted = |exercise: &str| name.is_none_or(|name| !session.is_game() && exercise == name);
            session.attempts.iter().any(|attempt| !attempt.by_coach && is_wanted(&attempt.exercise))
        };
        self.sessions.iter().filter(is_of).collect()
    }

    /// The scores of the exercise `name`, one for each venue where it was tried.
    pub fn scores_of(&self, name: &str) -> &[(Venue, Record)] {
        self.scores.get(name).map_or(&[], Vec::as_slice)
    }

    /// Adds a session, or replaces its earlier version. A session without attempts is removed.
    pub fn insert(&mut self, session: &Session) {
        let known = self.sessions.iter().position(|known| known.id == session.id);
        match known {
            Some(known) if session.attempts.is_empty() => drop(self.sessions.remove(known)),
            Some(known) => self.sessions[known] = session.clone(),
            None if session.attempts.is_empty() => return,
            None => self.sessions.push(session.clone()),
        }
        self.score(names(session));
    }

    fn score(&mut self, names: impl IntoIterator<Item = String>) {
        for name in names {
            let scores = Record::by_venue(&self.sessions, |sessions| Record::of_exercise(sessions, &name));
            self.scores.insert(name, scores);
        }
    }
}

/// The score of one session's attempts at the exercise `name`, or at all exercises if `None`.
pub fn record_of(session: &Session, name: Option<&str>) -> Record {
    Record::of([session], |_, attempt| name.is_none_or(|name| attempt.exercise == name))
}

fn names(session: &Session) -> Vec<String> {
    session.exercises.iter().map(|exercise| exercise.name.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::Skill,
        drills::{Goal, Library},
    };

    fn session(id: &str, goal: Goal, results: &str) -> Session {
        let exercise = Library::bundled().exercises()[0].clone();
        let mut session = Session::new(goal, Venue::Table, vec![exercise], Skill::CLUB, 1);
        session.id = id.to_owned();
        results.chars().for_each(|result| session.log(result == 'x').unwrap());
        session
    }

    #[test]
    fn session_is_replaced_in_place_and_removed_without_attempts() {
        let first = session("1", Goal::Free, "x-");
        let name = first.exercises[0].name.clone();
        let mut book = Book::new(vec![first, session("2", Goal::Free, "")], Vec::new());
        let score = |book: &Book| -> Vec<_> {
            book.scores_of(&name).iter().map(|(_, record)| (record.made, record.tried)).collect()
        };
        assert_eq!((book.sessions.len(), score(&book)), (1, vec![(1, 2)]));
        book.insert(&session("1", Goal::Free, "x-xx"));
        assert_eq!((book.sessions.len(), score(&book)), (1, vec![(3, 4)]));
        // Strokes of a game are no repetitions of the exercise.
        book.insert(&session("3", Goal::Game { innings: 9 }, "xxx"));
        assert_eq!((book.sessions.len(), score(&book)), (2, vec![(3, 4)]));
        assert_eq!((book.sessions_of(Some(&name)).len(), book.sessions_of(None).len()), (1, 2));
        book.insert(&session("1", Goal::Free, ""));
        assert_eq!((book.sessions.len(), score(&book)), (1, vec![]));
    }
}
