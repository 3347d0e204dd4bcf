//! Validates sessions from files, whoever wrote them: all that other code relies on is checked.

use super::{Attempt, Exercise, ExerciseError, Session, exercise::check_share};
use crate::{coach::Skill, physics::CueInputs};

/// The first second of the year 10000, Unix time: no session is this late, and dates have four-digit years.
const YEAR_10000: u64 = 253_402_300_800;

/// Why a session is rejected.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// One of its exercises cannot be played.
    #[error("{name:?}: {error}")]
    Exercise {
        /// The exercise.
        name: String,
        /// The cause.
        error: ExerciseError,
    },
    /// An attempt is at an exercise that the session does not contain.
    #[error("it has an attempt at {0:?}, which is not one of its exercises")]
    Stray(String),
    /// A time that is not a valid date.
    #[error("the time {0} is not a valid date; accepted are seconds from 1970 to the year 9999")]
    Time(u64),
    /// An attempt with invalid values.
    #[error("attempt {number}: {error}")]
    Attempt {
        /// Number of the attempt, from 1 on.
        number: usize,
        /// The cause.
        error: ExerciseError,
    },
}

impl Session {
    /// Validates the exercises, the times, and the layouts and strokes of the attempts.
    ///
    /// # Errors
    /// Fails with the first problem found.
    pub fn validate(&self) -> Result<(), SessionError> {
        for exercise in &self.exercises {
            let refuse = |error| SessionError::Exercise { name: exercise.name.clone(), error };
            exercise.validate().map_err(refuse)?;
        }
        let times = self.attempts.iter().map(|attempt| attempt.at).chain([self.started]);
        if let Some(time) = times.into_iter().find(|time| *time >= YEAR_10000) {
            return Err(SessionError::Time(time));
        }
        for (attempt, number) in self.attempts.iter().zip(1..) {
            let exercise = self.exercise_of(attempt).ok_or_else(|| SessionError::Stray(attempt.exercise.clone()))?;
            attempt.validate(exercise).map_err(|error| SessionError::Attempt { number, error })?;
        }
        Ok(())
    }
}

impl Attempt {
    fn validate(&self, exercise: &Exercise) -> Result<(), ExerciseError> {
        if let Some(layout) = &self.layout {
            layout.validate(&exercise.table()?)?;
        }
        [self.chance, self.advised_chance].into_iter().flatten().try_for_each(check_share)?;
        for cue in [self.intended, self.advised].iter().flatten() {
            cue.validate()?;
        }
        if let Some(CueInputs { theta, phi, speed, .. }) = self.played {
            // Errors may move the tip off the ball, and the other inputs slightly beyond the range of intended strokes.
            let speed = speed * (CueInputs::MAX_SPEED / Skill::MAX_SPEED_WITH_ERRORS);
            CueInputs { a: 0.0, b: 0.0, theta, phi: 0.5 * phi, speed }.validate()?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::Growth,
        drills::{Goal, session::tests::session},
        table::Layout,
    };
    use glam::DVec2;

    type Change<'a> = &'a dyn Fn(&mut Session);

    #[test]
    fn impossible_strokes_are_refused_but_erroneous_ones_accepted() {
        let good = CueInputs { a: 0.0, b: 0.5, theta: 0.0, phi: 1.0, speed: 100.0 };
        let changed = |change: Change| {
            let mut session = session(Goal::Free, "x-");
            change(&mut session);
            session.validate()
        };
        changed(&|session| session.attempts[1].intended = Some(good)).unwrap();
        changed(&|session| session.attempts[1].played = Some(CueInputs { b: 1.2, speed: 100.5, ..good })).unwrap();
        // The player with the largest errors, who hits too hard by three standard errors.
        let wild = Skill { speed: Skill::REFERENCE_SPEED, growth: Growth::USUAL, ..Skill::CLUB };
        let played = wild.stroke(0.03, &good, &[0.0, 0.0, 0.0, 0.0, 3.0]);
        changed(&|session| session.attempts[1].played = Some(played)).unwrap();
        let bad = CueInputs { theta: 1e9, ..good };
        let refused: [(Change, &str); 7] = [
            (&|session| session.attempts[1].chance = Some(5e300), "make rate"),
            (&|session| session.started = u64::MAX, "time 18446"),
            (&|session| session.attempts[1].at = YEAR_10000, "time 253"),
            (&|session| session.attempts[1].advised = Some(bad), "attempt 2"),
            (&|session| session.attempts[1].intended = Some(bad), "theta"),
            (&|session| session.attempts[1].played = Some(bad), "theta"),
            (&|session| session.attempts[1].layout = Some(Layout::new([DVec2::ZERO; 3])), "white and yellow"),
        ];
        for (change, says) in refused {
            let error = changed(change).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }
}
