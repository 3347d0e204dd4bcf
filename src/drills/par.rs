//! Measures the difficulty of an exercise: how often players of the named skills make its shot.

use super::{Exercise, ExerciseError, Par};
use crate::coach::{Doubt, Shooter, Skill, make_probability};

/// Attempts for each share; its standard error is at most 0.5 %.
pub const ATTEMPTS: usize = 10_000;

/// Seed of the attempts' errors.
pub const SEED: u64 = 2026;

/// Minimum share that a club player makes in grades 1 to 4; below the last one the grade is 5.
pub const GRADES: [f64; 4] = [0.95, 0.83, 0.68, 0.43];

impl Par {
    /// Plays the exercise's shot [`ATTEMPTS`] times with the errors of each player and with uncertain tables and ball
    /// positions. `None` if the exercise has no shot, or the cue has no room for it. The shares are rounded to a
    /// thousandth.
    ///
    /// # Errors
    /// Fails if the exercise cannot be played.
    pub fn measure(exercise: &Exercise) -> Result<Option<Self>, ExerciseError> {
        Self::with_doubt(exercise, Doubt::FULL, ATTEMPTS, SEED)
    }

    /// Like [`Par::measure`], with this doubt, number of attempts, and seed of their errors: without doubt for strokes in the program, where
    /// table and positions are exact.
    ///
    /// # Errors
    /// Fails if the exercise cannot be played.
    pub fn with_doubt(
        exercise: &Exercise,
        doubt: Doubt,
        attempts: usize,
        seed: u64,
    ) -> Result<Option<Self>, ExerciseError> {
        exercise.validate()?;
        let table = exercise.table()?;
        let Some(shot) = exercise.model_shot() else { return Ok(None) };
        let share = |skill| {
            let shooter = Shooter { skill, doubt };
            let made = make_probability(shooter, exercise.rule, &table, &exercise.layout, &shot, attempts, seed);
            (made.rate * 1e3).round() / 1e3
        };
        Ok(Some(Self {
            beginner: share(Skill::BEGINNER),
            club: share(Skill::CLUB),
            world_class: share(Skill::WORLD_CLASS),
        }))
    }

    /// Returns the grade, 1 to 5, by the club player's share.
    pub fn grade(&self) -> u8 {
        1 + GRADES.iter().filter(|least| self.club < **least).count() as u8
    }
}
