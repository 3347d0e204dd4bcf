//! `carom drill skill`: estimates the player's skill from results at a real table.

use serde_json::json;

use super::Workspace;
use crate::{
    commands::{
        Failure,
        output::{json_line, plural, print_line, print_note},
    },
    drills::estimate::{Estimate, estimate},
};

/// The message if the results give only a bound.
const NO_SKILL: &str =
    "this is only a bound, not a skill that can be saved: results at exercises of other grades tell more";

/// Estimate the player's skill from the results at a real table.
///
/// The skill is reported as the three-cushion average of a player with the estimated errors, with the 95 % interval. Averages from almost
/// zero to far above world class are considered; an interval that reaches one of these ends is open there. The estimate assumes that the
/// player played the shots of the exercises, or those shown by a hint.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Save the estimate: `--skill own` then means this player.
    #[arg(long)]
    keep: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let workspace = Workspace::open();
    let estimate = estimate(&workspace.sessions()).map_err(Failure::failed)?;
    let Estimate { skill, scale, low, high, attempts, made, shots, left_out } = estimate;
    if args.keep {
        let skill = skill.ok_or_else(|| Failure::failed(format_args!("average {}; {NO_SKILL}", estimate.words())))?;
        workspace.store.save_skill(skill).map_err(Failure::failed)?;
    }
    // Compared as text: the file contains degrees, which convert back to nearly the same radians. An unreadable file counts as no saved
    // skill.
    let own = workspace.store.own_skill().ok().flatten();
    let kept = own.is_some_and(|own| skill.is_some_and(|skill| own.skill.to_string() == skill.to_string()));
    if args.json {
        let [least, average, most] = estimate.averages();
        let mut answer = json!({
            // Points per inning at three-cushion.
            "average": average, "average_interval": [least, most],
            // Errors as a multiple of those of level 1, which are an expert's at the reference stroke.
            "scale": scale, "interval": [low, high],
            "attempts": attempts, "made": made, "shots": shots, "left_out": left_out,
            // Whether this is the player of `--skill own`.
            "kept": kept,
        });
        if let Some(skill) = skill {
            answer["skill"] = json!(skill);
        }
        // The only known end of the interval: the player averages at least the lower end, or at most the upper end.
        if let Some((bound, _)) = estimate.bound() {
            answer["bound"] = bound.into();
        }
        return Ok(json_line(&answer)?);
    }
    print_line(format_args!("you play like an average of {} at three-cushion (95 % interval)", estimate.words()))?;
    print_line(format_args!("from {made} of {attempts} made at {}", plural(shots, "shot")))?;
    match skill {
        Some(skill) => print_line(format_args!("as a skill: {skill}"))?,
        None => print_line(NO_SKILL)?,
    }
    if left_out > 0 {
        print_note(format_args!(
            "note: {} not used, because the shot is unknown, as with shifted balls, or the cue has no room for it",
            plural(left_out, "attempt")
        ));
    }
    if kept {
        print_line("saved: --skill own is this player")?;
    }
    Ok(())
}
