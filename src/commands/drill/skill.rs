//! `carom drill skill`: what the results at a real table say of the player.

use serde_json::json;

use super::Workspace;
use crate::{
    commands::{
        Failure,
        output::{json_line, line, plural, tell},
    },
    drills::estimate::{Estimate, estimate},
};

/// What is said where the results give a bound alone.
const NO_SKILL: &str = "that is a bound and no skill to keep: makes and misses at exercises of other grades tell more";

/// Estimate the player's skill from the results at a real table.
///
/// It is told as the average at three-cushion that a player with such errors has, with the 95 % interval; averages from
/// next to nothing to far above world class are looked at, and an interval that reaches one of these ends is open there. The player is taken to have played the exercises' own shots, or those that a
/// hint has shown.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Keep the estimate: `--skill own` is then this player.
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
        workspace.store.keep_skill(skill).map_err(Failure::failed)?;
    }
    // By its words: the file has degrees, which come back as nearly the same radians. A file that cannot be read keeps nobody.
    let own = workspace.store.own_skill().ok().flatten();
    let kept = own.is_some_and(|own| skill.is_some_and(|skill| own.skill.to_string() == skill.to_string()));
    if args.json {
        let [least, average, most] = estimate.averages();
        let mut answer = json!({
            // Points an inning at three-cushion.
            "average": average, "average_interval": [least, most],
            // Errors in multiples of those of the level 1, which are an expert's at the reference stroke.
            "scale": scale, "interval": [low, high],
            "attempts": attempts, "made": made, "shots": shots, "left_out": left_out,
            // Whether this is the player of `--skill own`.
            "kept": kept,
        });
        if let Some(skill) = skill {
            answer["skill"] = json!(skill);
        }
        // Which end of the interval alone is known: the player averages at least the lower one, or at most the upper one.
        if let Some((bound, _)) = estimate.bound() {
            answer["bound"] = bound.into();
        }
        return Ok(json_line(&answer)?);
    }
    line(format_args!("you play like an average of {} at three-cushion (95 % interval)", estimate.words()))?;
    line(format_args!("from {made} of {attempts} made at {}", plural(shots, "shot")))?;
    match skill {
        Some(skill) => line(format_args!("as a skill: {skill}"))?,
        None => line(NO_SKILL)?,
    }
    if left_out > 0 {
        tell(format_args!(
            "note: {} had no part in it, for their shot is not known or the cue has no room for it",
            plural(left_out, "attempt")
        ));
    }
    if kept {
        line("kept: --skill own is this player")?;
    }
    Ok(())
}
