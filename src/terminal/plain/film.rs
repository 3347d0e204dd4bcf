//! Filmed shots in sentences: the list, and the distances between simulated and filmed balls.

use crate::{
    coach::words::LengthUnit,
    study::filmed::FITTED_SECONDS,
    table::{BALL_NAMES, BALLS, CueBall},
    terminal::{
        FilmReplay,
        plain::speech,
        shot::film::{listed, table},
        words::fixed,
    },
};

/// Times for which the distances are given, s after the stroke; the end follows.
const TIMES: [f64; 5] = [1.0, 2.0, 3.0, 4.0, 5.0];

/// Lists the filmed shots.
pub fn list() -> String {
    let numbers = |points: bool| -> String {
        let found = listed().iter().filter(|listed| listed.is_point == points);
        found.map(|listed| listed.filmed.number.to_string()).collect::<Vec<_>>().join(", ")
    };
    format!(
        "There are {} filmed shots of a match at three cushions; say film and a number for one of them.\nPoints: {}.\nNo points: {}.",
        listed().len(),
        numbers(true),
        numbers(false)
    )
}

/// Describes a filmed shot and its simulation.
///
/// # Errors
/// Fails if there is no shot with this number.
pub fn describe(number: u32, unit: LengthUnit) -> Result<String, String> {
    let shot = listed().iter().find(|listed| listed.filmed.number == number);
    let shot = shot.ok_or_else(|| format!("There is no filmed shot {number}; film lists them."))?;
    let played = FilmReplay::new(&shot.filmed)?;
    let outcome = |is_point| if is_point { "a point" } else { "no point" };
    let mut lines = vec![
        format!(
            "Shot {number} of the film: {}, {} {}, {} seconds long.",
            outcome(shot.is_point),
            fixed(unit.speed().0 * shot.filmed.speed(), 1),
            speech::of_speed(unit),
            fixed(shot.filmed.duration(), 1)
        ),
        speech::positions(table(), &shot.layout, CueBall::White, unit),
        format!("The stroke was fitted on the first {FITTED_SECONDS} seconds; all that comes later is predicted."),
    ];
    let end = played.replay.duration();
    let small = match unit {
        LengthUnit::Metres => "centimetres",
        LengthUnit::Feet => "inches",
    };
    let (in_a_metre, _) = unit.small();
    let distances = |time: f64| {
        let metres = played.replay.distances(time);
        let each = (0..BALLS).map(|ball| format!("{} {}", BALL_NAMES[ball], fixed(in_a_metre * metres[ball], 1)));
        each.collect::<Vec<_>>().join(", ")
    };
    for time in TIMES.into_iter().filter(|time| *time < end) {
        let seconds = if time == 1.0 { "second" } else { "seconds" };
        lines.push(format!("{time} {seconds}: from the film, in {small}: {}.", distances(time)));
    }
    lines.push(format!("{} seconds: all balls lie still: {}.", fixed(end, 2), distances(end)));
    lines.push(format!("The simulated shot is {}.", outcome(played.shot.solved)));
    Ok(lines.join("\n"))
}
