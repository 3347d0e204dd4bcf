//! The score of a list of attempts: number, make rate and runs.

use super::session::{Attempt, Session, Venue};
use crate::statistics::SuccessRate;

/// The score of a list of attempts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// Number of attempts.
    pub tried: usize,
    /// Points.
    pub made: usize,
    /// Attempts with a hint; they are included in the others.
    pub helped: usize,
    /// Share of points, with its 95 % confidence interval.
    pub rate: SuccessRate,
    /// Innings: each miss ends one, and an open run at the end of a session counts as one, as in a match.
    pub innings: usize,
    /// Points per inning; `None` without an inning.
    pub average: Option<f64>,
    /// Longest run of points. No run continues into the next session.
    pub high_run: u32,
    /// Whether some attempts have no known order; these are left out of innings, average and runs.
    pub has_unordered: bool,
    /// Time of the last attempt, Unix time in seconds.
    pub last: Option<u64>,
}

impl Record {
    /// Returns the record of the player's attempts in `sessions` that `counts` accepts, without the coach's strokes. Attempts
    /// without a known order are left out of innings, average and runs.
    pub fn of<'a>(
        sessions: impl IntoIterator<Item = &'a Session>,
        counts: impl Fn(&Session, &Attempt) -> bool,
    ) -> Self {
        Self::of_all(sessions, |session, number| {
            let attempt = &session.attempts[number];
            !attempt.by_coach && counts(session, attempt)
        })
    }

    /// Returns the record of the attempts in a session, by either side, whose numbers, from 0 on, `counts` accepts.
    pub(super) fn of_attempts(session: &Session, counts: impl Fn(usize) -> bool) -> Self {
        Self::of_all([session], |_, number| counts(number))
    }

    fn of_all<'a>(sessions: impl IntoIterator<Item = &'a Session>, counts: impl Fn(&Session, usize) -> bool) -> Self {
        let (mut tried, mut made, mut helped, mut last, mut has_unordered) = (0, 0, 0, None, false);
        let (mut innings, mut points, mut high_run) = (0, 0_usize, 0);
        for session in sessions {
            let (mut run, mut side) = (0, 0);
            for (number, (attempt, own)) in session.attempts.iter().zip(session.sides()).enumerate() {
                let is_counted = counts(session, number);
                // An attempt by the other side, or at another exercise, ends a run.
                if !is_counted || own != side {
                    innings += usize::from(run > 0);
                    (run, side) = (0, own);
                }
                if !is_counted {
                    continue;
                }
                tried += 1;
                made += usize::from(attempt.made);
                helped += usize::from(attempt.helped);
                last = last.max(Some(attempt.at));
                if session.unordered {
                    has_unordered = true;
                    continue;
                }
                if attempt.made {
                    run += 1;
                    points += 1;
                    high_run = high_run.max(run);
                } else {
                    run = 0;
                    innings += 1;
                }
            }
            innings += usize::from(run > 0);
        }
        Self {
            tried,
            made,
            helped,
            rate: SuccessRate::new(made, tried),
            innings,
            average: (innings > 0).then(|| points as f64 / innings as f64),
            high_run,
            has_unordered,
            last,
        }
    }

    /// Returns the same `record` separately for real tables and for the program, where there are attempts: results at one say
    /// little about the other.
    pub fn by_venue<'a>(
        sessions: &'a [Session],
        record: impl Fn(&mut dyn Iterator<Item = &'a Session>) -> Self,
    ) -> Vec<(Venue, Self)> {
        let at = |venue| record(&mut sessions.iter().filter(move |session| session.venue == venue));
        Venue::ALL.into_iter().map(|venue| (venue, at(venue))).filter(|(_, record)| record.tried > 0).collect()
    }

    /// Returns the record of all repetitions of the exercise with this name; games do not count.
    pub fn of_exercise<'a>(sessions: impl IntoIterator<Item = &'a Session>, name: &str) -> Self {
        Self::of(sessions, |session, attempt| !session.is_game() && attempt.exercise == name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drills::{Goal, session::tests::session};

    #[test]
    fn points_innings_average_and_high_run_are_correct() {
        // Innings of 2, 0 and 3 points, the last one open; then 4, ended by a miss.
        let sessions = [session(Goal::Free, "xx--xxx"), session(Goal::Free, "xxxx-")];
        let record = Record::of(&sessions, |_, _| true);
        assert_eq!((record.tried, record.made, record.innings, record.high_run), (12, 9, 4, 4));
        assert_eq!(record.average, Some(9.0 / 4.0));
        assert_eq!(record.rate, SuccessRate::new(9, 12));
        assert_eq!(record.last, Some(sessions[1].attempts[4].at));
        let none = Record::of(&[], |_, _| true);
        assert_eq!((none.tried, none.average, none.last), (0, None, None));
    }

    #[test]
    fn unordered_results_count_only_in_the_rate() {
        let mut sessions = [session(Goal::Free, "xxxxx---"), session(Goal::Free, "x-")];
        sessions[0].unordered = true;
        let record = Record::of(&sessions, |_, _| true);
        assert_eq!((record.tried, record.made), (10, 6));
        assert_eq!((record.innings, record.average, record.high_run), (1, Some(1.0), 1));
        assert!(record.has_unordered);
    }

    /// Regression test: unordered misses were overlooked, so the average seemed to cover all attempts.
    #[test]
    fn unordered_misses_are_marked_as_unordered() {
        let mut sessions = [session(Goal::Free, "----------"), session(Goal::Free, "x-")];
        assert!(!Record::of(&sessions, |_, _| true).has_unordered);
        sessions[0].unordered = true;
        let record = Record::of(&sessions, |_, _| true);
        assert_eq!((record.made, record.tried, record.average, record.has_unordered), (1, 12, Some(1.0), true));
        assert!(!Record::of(&sessions[1..], |_, _| true).has_unordered);
    }

    #[test]
    fn coach_strokes_count_for_the_session_only() {
        let mut sessions = [session(Goal::Run(2), "-xx")];
        sessions[0].attempts[1].by_coach = true;
        sessions[0].attempts[2].by_coach = true;
        assert!(sessions[0].is_over());
        let (mine, all) = (Record::of_exercise(&sessions, "first"), sessions[0].record());
        assert_eq!(
            [(mine.made, mine.tried, mine.high_run), (all.made, all.tried, all.high_run)],
            [(0, 1, 0), (2, 3, 2)]
        );
    }

    #[test]
    fn a_run_ends_where_the_coach_plays() {
        let mut sessions = [session(Goal::Free, "x-x")];
        sessions[0].attempts[1].by_coach = true;
        let record = Record::of_exercise(&sessions, "first");
        assert_eq!((record.made, record.innings, record.high_run), (2, 2, 1));
    }

    #[test]
    fn real_table_and_program_results_are_separate() {
        let here = Session { venue: Venue::Program, ..session(Goal::Free, "x---") };
        let all = |sessions: &[Session]| -> Vec<_> {
            let apart = Record::by_venue(sessions, |sessions| Record::of_exercise(sessions, "first"));
            apart.into_iter().map(|(venue, record)| (venue, record.made, record.tried)).collect()
        };
        let sessions = [here, session(Goal::Free, "xx-")];
        assert_eq!(all(&sessions), [(Venue::Table, 2, 3), (Venue::Program, 1, 4)]);
        assert_eq!(all(&sessions[..1]), [(Venue::Program, 1, 4)]);
        assert!(all(&[]).is_empty());
    }

    #[test]
    fn game_does_not_count_as_repetition() {
        let sessions = [session(Goal::Game { innings: 1 }, "xx-"), session(Goal::Free, "x")];
        assert_eq!(Record::of_exercise(&sessions, "first").tried, 1);
        assert_eq!(Record::of_exercise(&sessions, "second").tried, 0);
    }
}
