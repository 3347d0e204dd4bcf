//! Simulation of one shot with bounds on run time and numbers: a valid table can still be too stiff to compute.

use std::time::Duration;

use super::Failure;
use crate::{
    physics::{CueInputs, Impulse, strike},
    printing::number,
    simulation::{BoundedRecorder, End, Recorder, Recording, Start},
    study::{SteppedShot, Steps},
    table::{Layout, Table},
};

/// Longest run time of one shot. The slowest shots on real tables take a few milliseconds.
const TIME_LIMIT: Duration = Duration::from_secs(5);

/// Maximum number of time steps of one shot: a few seconds of computing.
const MAX_STEPS: f64 = 4e6;

/// Plays a shot with the event-driven engine.
///
/// # Errors
/// Fails if the layout, the stroke or the motion is invalid, if the shot takes too much work, or if numbers overflow.
pub fn play(table: &Table, layout: &Layout, start: Start<'_>) -> Result<Recording, Failure> {
    let (recording, is_over) =
        Recording::within_bounds(table, layout, start, TIME_LIMIT, u32::MAX).map_err(Failure::wrong_input)?;
    check_finite(table, recording, is_over, "")
}

/// Plays a shot in fixed time steps.
///
/// # Errors
/// As for [`play`].
pub fn play_in_steps(
    table: &Table,
    layout: &Layout,
    cue: &CueInputs,
    steps: Steps,
) -> Result<(Recording, SteppedShot), Failure> {
    layout.validate(table).map_err(Failure::wrong_input)?;
    cue.validate().map_err(Failure::wrong_input)?;
    let finest = Steps::finest(table, &strike(table, cue), MAX_STEPS);
    if steps.dt < finest {
        return Err(Failure::wrong_input(format_args!(
            "dt = {} s might take more than {MAX_STEPS} steps; accepted is {} s or more for this shot on \"{}\"",
            number(steps.dt),
            number(rounded_up(finest)),
            table.name
        )));
    }
    let play = |impulse: &Impulse, recorder: &mut Recorder| -> (End, (SteppedShot, bool)) {
        let mut bounded = BoundedRecorder::new(recorder, TIME_LIMIT, u32::MAX);
        let stepped = steps.simulate(table, layout, impulse, &mut bounded);
        (stepped.end, (stepped, bounded.is_over()))
    };
    let (recording, (stepped, is_over)) =
        Recording::record_with(table, layout, Start::Stroke(cue), play).map_err(Failure::wrong_input)?;
    Ok((check_finite(table, recording, is_over, "larger time steps or ")?, stepped))
}

/// Rounds a positive `value` up to two significant digits.
fn rounded_up(value: f64) -> f64 {
    let unit = 10.0_f64.powf(value.log10().floor() - 1.0);
    let two_digits = |times: f64| format!("{:.1e}", times * unit).parse().unwrap_or(f64::INFINITY);
    let times = (value / unit).ceil();
    let nearest: f64 = two_digits(times);
    if nearest < value { two_digits(times + 1.0) } else { nearest }
}

/// Returns the recording if it is complete and its numbers are finite. `other_remedies` names remedies besides a less stiff table.
fn check_finite(
    table: &Table,
    recording: Recording,
    is_over: bool,
    other_remedies: &str,
) -> Result<Recording, Failure> {
    let name = &table.name;
    if is_over {
        return Err(Failure::failed(format_args!(
            "the shot takes too much work on \"{name}\" (more than {} s, or hundreds of thousands of bounces) and was stopped; use \
             {other_remedies}a less stiff table",
            TIME_LIMIT.as_secs()
        )));
    }
    if recording.is_finite() {
        return Ok(recording);
    }
    Err(Failure::failed(format_args!(
        "the shot's numbers do not stay finite on \"{name}\"; use a table with constants nearer to those of \"match\""
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_named_in_a_refusal_is_accepted() {
        for (value, said) in
            [(3.04e-5, 3.1e-5), (9.91e-5, 1e-4), (3e-7, 3e-7), (1.0, 1.0), (99.5, 100.0), (0.123, 0.13)]
        {
            assert_eq!(rounded_up(value), said, "{value}");
        }
        assert!((1..2000).all(|n| rounded_up(f64::from(n) / 7e6) >= f64::from(n) / 7e6));
    }
}
