//! A filmed shot next to the simulated one, on a common clock that starts with the stroke.

use glam::DVec2;

use super::{
    film::FilmedShot,
    shot_fit::{self, ShotFit},
};
use crate::{
    game::{Rule, Tally},
    simulation::{Recording, ShotError, Start},
    table::{BALLS, Table},
};

/// Why a filmed shot cannot be simulated.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum ReplayError {
    /// The film is too short to fit the stroke.
    #[error("shot {0} of the film shows the cue ball too briefly to tell how it was struck; two samples are needed")]
    Short(u32),
    /// The simulator rejects the filmed positions or motion.
    #[error("shot {number} of the film cannot be played: {error}")]
    Refused {
        /// Number of the shot in the match.
        number: u32,
        /// What is wrong.
        error: ShotError,
    },
}

/// A filmed shot and its simulation, with the stroke fitted to the film's first [`super::FITTED_SECONDS`] seconds.
#[derive(Clone, Debug)]
pub struct Replay {
    /// The film.
    pub filmed: FilmedShot,
    /// The fit of the stroke.
    pub fitted: ShotFit,
    /// The simulated shot.
    pub recording: Recording,
}

impl Replay {
    /// Fits the stroke of a filmed shot on `table` and plays it.
    ///
    /// # Errors
    /// Fails if the film is too short, or contains something impossible on this table.
    pub fn new(table: &Table, filmed: &FilmedShot) -> Result<Self, ReplayError> {
        let number = filmed.number;
        let refuse = |error| ReplayError::Refused { number, error };
        let layout = filmed.layout(table);
        layout.validate(table).map_err(|error| refuse(error.into()))?;
        let fitted = shot_fit::fit_shot(table, filmed).ok_or(ReplayError::Short(number))?;
        let impulse = fitted.motion.impulse(table.radius);
        let recording = Recording::started(table, &layout, Start::Motion(&impulse)).map_err(refuse)?;
        Ok(Self { filmed: filmed.clone(), fitted, recording })
    }

    /// Returns the time until all balls are at rest in film and simulation, s after the stroke.
    pub fn duration(&self) -> f64 {
        let filmed = self.filmed.duration() + self.filmed.start - self.fitted.start;
        self.recording.duration().max(filmed)
    }

    /// Returns the filmed positions at `time`, s after the stroke; before and after the film the balls are at rest.
    pub fn filmed_positions(&self, time: f64) -> [DVec2; BALLS] {
        std::array::from_fn(|ball| self.filmed.position(ball, self.fitted.start + time))
    }

    /// Whether the simulated shot scores a point.
    pub fn is_simulated_point(&self, rule: Rule) -> bool {
        let mut tally = Tally::default();
        self.recording.events().iter().for_each(|event| tally.count(event));
        tally.is_point(rule)
    }

    /// Returns the distance of each simulated ball from the filmed one at `time`, m.
    pub fn distances(&self, time: f64) -> [f64; BALLS] {
        let (filmed, simulated) = (self.filmed_positions(time), self.recording.positions(time));
        std::array::from_fn(|ball| filmed[ball].distance(simulated[ball]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::filmed::{FITTED_SECONDS, film::bundled, shot_fit::EVALUATION_TIMES};

    fn shot(number: u32) -> FilmedShot {
        bundled().into_iter().find(|shot| shot.number == number).unwrap()
    }

    #[test]
    fn replay_distances_agree_with_the_errors_of_the_fit() {
        let table = Table::default();
        let replay = Replay::new(&table, &shot(2)).unwrap();
        // The film is interpolated linearly between frames 20 ms apart, and the stroke falls between two of them.
        assert!(replay.distances(0.0).iter().all(|apart| *apart < 0.002), "{:?}", replay.distances(0.0));
        let fitted = (1..20).map(|n| replay.distances(FITTED_SECONDS * f64::from(n) / 20.0)[0]).fold(0.0, f64::max);
        assert!(fitted < 0.03, "{fitted} m on the part that was fitted");
        let late = replay.fitted.start - replay.filmed.start;
        for (time, error) in EVALUATION_TIMES.into_iter().zip(replay.fitted.errors) {
            let apart = replay.distances(time - late)[0];
            assert!((apart - error).abs() < 1e-6, "{apart} m, {error} m at {time} s");
        }
        assert!(replay.duration() > 11.0);
        let end = replay.filmed_positions(replay.duration());
        assert_eq!(end, replay.filmed_positions(1e3), "they lie still");
    }

    #[test]
    fn too_short_or_impossible_film_is_refused_with_its_number() {
        let table = Table::default();
        let whole = shot(2);
        let mut short = whole.clone();
        short.balls[0].truncate(2);
        assert_eq!(Replay::new(&table, &short).unwrap_err(), ReplayError::Short(2));
        let mut heap = whole;
        heap.balls[1] = heap.balls[2].clone();
        let message = Replay::new(&table, &heap).unwrap_err().to_string();
        assert!(message.contains("shot 2 of the film cannot be played: yellow and red"), "{message}");
    }
}
