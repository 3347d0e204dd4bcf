//! `carom simulate`: one shot as a list of events, or a file of shots.

use std::io::{self, Write};

use serde::{Deserialize, Serialize};

use super::{
    Failure,
    input::{ByTable, Scene, answer_lines},
    output::impulse_words,
};
use crate::{
    physics::CueInputs,
    simulation::{Event, Recording},
    table::{Layout, Table},
};

/// Simulate one shot, or a file of them.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: Scene,
    /// The shot: "a,b,theta,phi,V" in ball radii, degrees and m/s.
    #[arg(long, allow_hyphen_values = true, required_unless_present = "batch")]
    shot: Option<String>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
    /// JSON Lines of shots with `preset`, `layout` and `cue`; "-" reads the standard input.
    #[arg(long, value_name = "FILE", conflicts_with = "shot")]
    batch: Option<String>,
}

/// One line of a batch.
#[derive(Deserialize)]
struct Question {
    preset: String,
    layout: Layout,
    cue: CueInputs,
}

/// The answer in JSON.
#[derive(Serialize)]
struct Answer {
    events: Vec<Event>,
    #[serde(rename = "final")]
    end: Layout,
    duration: f64,
}

impl Answer {
    fn of(recording: &Recording) -> Self {
        Self { events: recording.events().to_vec(), end: recording.final_layout(), duration: recording.duration() }
    }
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if let Some(file) = &args.batch {
        let mut tables = ByTable::new(Ok);
        return answer_lines(file, |question: Question| {
            Ok(Answer::of(&play(tables.get(&question.preset)?, &question.layout, &question.cue)?))
        });
    }
    let (table, layout) = args.scene.read()?;
    // clap demands a shot where there is no batch.
    let cue = CueInputs::parse(args.shot.as_deref().unwrap_or_default()).map_err(Failure::wrong_input)?;
    let recording = play(&table, &layout, &cue)?;
    if cue.validate_tip(table.miscue_limit).is_err() {
        eprintln!(
            "note: a real tip slips off here: a² + b² is {:.3}, on \"{}\" it holds up to {}",
            cue.tip_offset_squared(),
            table.name,
            table.miscue_limit
        );
    }
    let mut out = io::stdout().lock();
    if args.json {
        serde_json::to_writer(&mut out, &Answer::of(&recording)).map_err(io::Error::from)?;
        writeln!(out)?;
    } else {
        describe(&mut out, &recording)?;
    }
    Ok(())
}

fn play(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Recording, Failure> {
    Recording::new(table, layout, cue).map_err(Failure::wrong_input)
}

/// The shot for people to read.
fn describe(out: &mut impl Write, recording: &Recording) -> io::Result<()> {
    writeln!(out, "{}", impulse_words(recording.impulse()))?;
    writeln!(out, "{:>12}  {:<18}  {:<5}  {:<6}  cue ball", "t, s", "event", "balls", "rail")?;
    for event in recording.events() {
        let (first, second) = event.kind.balls();
        let balls = second.map_or_else(|| first.to_string(), |second| format!("{first} {second}"));
        let rail = event.kind.rail().map_or("", crate::simulation::Rail::name);
        let cue_ball = recording.state(0, event.time);
        writeln!(
            out,
            "{:>12.9}  {:<18}  {balls:<5}  {rail:<6}  ({:.4}, {:.4}) m at {:.3} m/s",
            event.time,
            event.kind.name(),
            cue_ball.position.x,
            cue_ball.position.y,
            cue_ball.velocity.length()
        )?;
    }
    writeln!(out, "all still after {:.6} s:", recording.duration())?;
    for (ball, position) in recording.final_layout().balls.iter().enumerate() {
        writeln!(out, "  ball {ball} at ({:.6}, {:.6}) m", position.x, position.y)?;
    }
    Ok(())
}
