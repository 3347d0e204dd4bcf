//! The film: ball positions over time in the shots of a real match.

use glam::DVec2;
use serde::Deserialize;

use crate::table::{BALLS, Table};

/// The bundled half of the film.
static FILM: &str = include_str!("../../../tests/data/filmed/shots.jsonl");

/// A ball has moved if it is farther than this from its first position, m: ten times the noise.
const MOTION_THRESHOLD: f64 = 0.003;

/// Noise of a filmed position, m.
const NOISE: f64 = MOTION_THRESHOLD / 10.0;

/// The position of a ball at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time since the start of the shot's film, s.
    pub time: f64,
    /// Centre of the ball relative to the table's centre, m.
    pub position: DVec2,
}

/// One filmed shot, the cue ball first.
#[derive(Clone, Debug)]
pub struct FilmedShot {
    /// Number of the shot in the match.
    pub number: u32,
    /// Film indices of the three balls in the order used here: the struck ball, the opponent's ball, the red.
    pub order: [usize; BALLS],
    /// Positions of each ball over time; a ball at rest has few samples.
    pub balls: [Vec<Sample>; BALLS],
    /// Time of the stroke, s.
    pub start: f64,
}

/// A table whose size differs from the filmed one, so that its positions are not comparable.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
#[error(
    "the table \"{table}\" has {key} = {value} m, but the filmed one {key} = {filmed} m; accepted is the filmed size, to 0.3 mm"
)]
pub struct SizeMismatch {
    table: String,
    key: &'static str,
    value: f64,
    filmed: f64,
}

/// Checks that the table has the size of the filmed one.
///
/// # Errors
/// [`SizeMismatch`] if the sides or the balls differ from those of the filmed table.
pub fn check_size(table: &Table) -> Result<(), SizeMismatch> {
    // The default table, `match`, is fitted to the film.
    let filmed = Table::default();
    let sizes = |table: &Table| [("L", table.length), ("l", table.width), ("R", table.radius)];
    let pairs = sizes(table).into_iter().zip(sizes(&filmed));
    for ((key, value), (_, filmed)) in pairs {
        if (value - filmed).abs() > NOISE {
            return Err(SizeMismatch { table: table.name.clone(), key, value, filmed });
        }
    }
    Ok(())
}

#[derive(Deserialize)]
struct Line {
    shot: u32,
    balls: [Vec<[f64; 3]>; BALLS],
}

/// Returns the bundled film.
///
/// # Panics
/// Never panics: a test parses the bundled film.
pub fn bundled() -> Vec<FilmedShot> {
    let line = |line| serde_json::from_str(line).ok().and_then(FilmedShot::of);
    FILM.lines().map(line).collect::<Option<_>>().expect("the bundled film is valid: a test reads it")
}

impl FilmedShot {
    /// Converts a line of the file; `None` if no ball moves.
    fn of(Line { shot: number, balls }: Line) -> Option<Self> {
        let tracks = balls.map(|ball| {
            let sample = |[time, x, y]: [f64; 3]| Sample { time, position: DVec2::new(x, y) };
            ball.into_iter().map(sample).collect::<Vec<_>>()
        });
        // A ball with few samples may have started to move long before the sample that shows it.
        let shown = |ball: &usize| first_moved(&tracks[*ball]).map(|moved| tracks[*ball][moved].time);
        let starts = [0, 1, 2].map(|ball: usize| start_of(&tracks[ball]));
        let moved = (0..BALLS).filter_map(|ball| Some((ball, (shown(&ball)?, starts[ball]))));
        let struck = moved.min_by(|(_, one), (_, other)| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
        let (struck, (_, start)) = struck?;
        let order = [struck, usize::from(struck == 0), if struck == 2 { 1 } else { 2 }];
        Some(Self { number, order, balls: order.map(|ball| tracks[ball].clone()), start })
    }

    /// Returns the speed of the cue ball at its first two moving samples, m/s.
    pub fn speed(&self) -> f64 {
        let moving: Vec<_> = self.balls[0].iter().filter(|sample| sample.time > self.start + 0.005).take(2).collect();
        let [one, other] = moving[..] else { return 0.0 };
        other.position.distance(one.position) / (other.time - one.time)
    }

    /// Returns the duration of the film after the stroke, s.
    pub fn duration(&self) -> f64 {
        let ends = self.balls.iter().filter_map(|track| Some(track.last()?.time));
        ends.fold(0.0, f64::max) - self.start
    }

    /// Returns a ball's position at `time`, m, by linear interpolation between samples. A ball at rest stays there until it
    /// starts to move: it is not interpolated towards the first sample in motion.
    pub fn position(&self, ball: usize, time: f64) -> DVec2 {
        let track = &self.balls[ball];
        let after = track.partition_point(|sample| sample.time <= time);
        match (after.checked_sub(1).map(|index| track[index]), track.get(after)) {
            (Some(from), Some(to)) => {
                let since = if first_moved(track) == Some(after) { start_of(track) } else { from.time };
                from.position.lerp(to.position, ((time - since) / (to.time - since)).max(0.0))
            }
            (Some(only), None) => only.position,
            (None, _) => track[0].position,
        }
    }
}

/// Returns the index of the first sample away from the ball's first position.
pub(super) fn first_moved(track: &[Sample]) -> Option<usize> {
    track.iter().position(|sample| sample.position.distance(track[0].position) > MOTION_THRESHOLD)
}

/// Returns the time at which a ball starts to move, extrapolated back to its last position at rest.
fn start_of(track: &[Sample]) -> f64 {
    let rest = track[0].position;
    first_moved(track).map_or(f64::INFINITY, |moved| {
        let (last, now) = (track[moved - 1], track[moved]);
        // Uses the speed from this sample to the next, at least 0.05 m/s, if there is a next one: a ball that is hit does not
        // creep.
        match track.get(moved + 1) {
            Some(next) => {
                let speed = next.position.distance(now.position) / (next.time - now.time);
                (now.time - now.position.distance(rest) / speed.max(0.05)).max(last.time)
            }
            None => last.time,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bundled_film_has_91_shots_that_begin_with_the_cue_ball() {
        let film = bundled();
        assert_eq!(film.len(), 91);
        for shot in &film {
            // The film of two shots starts long before the stroke.
            assert!((0.0..7.0).contains(&shot.start), "shot {} starts at {}", shot.number, shot.start);
            let moved = shot.position(0, shot.start + 0.1).distance(shot.balls[0][0].position);
            assert!(moved > 0.02, "shot {}: {moved}", shot.number);
            assert_eq!(shot.order[2], 2, "shot {}: nobody strikes the red", shot.number);
            let rises = |track: &Vec<Sample>| track.is_sorted_by(|one, next| one.time < next.time);
            assert!(shot.balls.iter().all(rises), "shot {}", shot.number);
        }
    }

    #[test]
    fn only_tables_of_the_filmed_size_are_accepted() {
        let filmed = Table::default();
        assert_eq!(check_size(&Table { length: 2.8401, ..filmed.clone() }), Ok(()));
        let narrow = check_size(&Table { width: 1.41, ..filmed.clone() }).unwrap_err().to_string();
        assert!(narrow.contains("l = 1.41 m") && narrow.contains("l = 1.42 m"), "{narrow}");
        assert!(check_size(&Table { radius: 0.0301, ..filmed }).is_err());
        assert!(check_size(&Table::preset("textbook").unwrap()).is_ok());
    }

    #[test]
    fn a_ball_lies_still_until_it_is_struck() {
        for shot in bundled() {
            let rest = shot.balls[0][0].position;
            assert!(shot.position(0, shot.start - 1e-9).distance(rest) < MOTION_THRESHOLD, "shot {}", shot.number);
            let moving = shot.position(0, shot.start + 0.01).distance(rest);
            assert!(moving > 0.005, "shot {}: {moving} m in 10 ms", shot.number);
        }
    }

    #[test]
    fn sparsely_sampled_ball_is_not_taken_for_the_cue_ball() {
        // In shot 48 the opponent's ball is nudged at the end; the film has three samples of it.
        let film = bundled();
        let shot = film.iter().find(|shot| shot.number == 48).unwrap();
        assert_eq!((shot.order, shot.balls[1].len()), ([0, 1, 2], 3));
        assert!((3.0..4.5).contains(&shot.speed()) && shot.duration() > 11.0, "{} m/s", shot.speed());
    }
}
