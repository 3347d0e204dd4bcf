//! Strokes, one after the other: from the standard input or by the coach, each played, judged, saved and answered at once.

use std::io::{self, BufRead, IsTerminal, Write};

use super::{score::plural, stroke_by_stroke::StrokeByStroke, workspace::player};
use crate::{
    coach::Skill,
    commands::{Failure, named::skill_called},
    drills::{Exercise, Goal, Session, Store, Venue},
    physics::CueInputs,
};

/// The word for the coach's shot in the place of one's own.
const COACH: &str = "coach";

/// Who plays, and how it is told.
#[derive(Debug, clap::Args)]
pub struct PlayOptions {
    /// Who plays: perfect, expert, club, beginner, own, or standard errors in mm, degrees and m/s like
    /// "a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1". Default: own where `carom drill skill --keep` has kept one, else expert.
    #[arg(long, value_parser = skill_called)]
    skill: Option<Skill>,
    /// Seed of the errors; without it they are others every time.
    #[arg(long)]
    seed: Option<u64>,
    /// Time that the coach has for a shot, ms.
    #[arg(long, default_value_t = 300, value_parser = clap::value_parser!(u64).range(0..=3_600_000))]
    pub(super) budget_ms: u64,
    /// Print JSON: an object a line, of the kinds "position", "attempt", "refused" and "result".
    #[arg(long)]
    pub(super) json: bool,
}

impl PlayOptions {
    /// A session that is played here.
    pub fn session(&self, goal: Goal, exercises: Vec<Exercise>) -> Session {
        let seed = self.seed.unwrap_or_else(rand::random);
        Session::new(goal, Venue::Program, exercises, player(self.skill), seed)
    }
}

/// Where the strokes come from.
#[derive(Clone, Copy, Debug)]
pub enum Strokes {
    /// The standard input, a stroke a line.
    Input,
    /// The coach.
    Coach,
    /// One that is repeated.
    Same(Stroke),
}

/// A stroke that is wanted.
#[derive(Clone, Copy, Debug)]
pub enum Stroke {
    /// The player's.
    Own(CueInputs),
    /// The coach's.
    Coach,
}

impl std::str::FromStr for Stroke {
    type Err = Failure;

    fn from_str(text: &str) -> Result<Self, Failure> {
        if text == COACH {
            return Ok(Self::Coach);
        }
        let cue = CueInputs::parse(text)
            .map_err(|error| Failure::wrong_input(format_args!("{error}, or \"{COACH}\" for the coach's shot")))?;
        Ok(Self::Own(cue))
    }
}

/// Plays a session until it is over, its input has ended, or it has `most` attempts.
pub fn play(
    store: &Store,
    session: Session,
    options: &PlayOptions,
    strokes: Strokes,
    most: usize,
) -> Result<(), Failure> {
    let mut game = StrokeByStroke::new(store, session, options, matches!(strokes, Strokes::Same(_)));
    let mut input = io::stdin().lock().split(b'\n');
    let (mut lines, mut refused) = (0_usize, 0_usize);
    while game.session().attempts.len() < most {
        let Some((table, layout)) = game.session().position().map_err(Failure::failed)? else { break };
        game.show(&layout)?;
        let stroke = match strokes {
            Strokes::Coach => Ok(Stroke::Coach),
            Strokes::Same(stroke) => Ok(stroke),
            Strokes::Input => {
                prompt("shot a,b,theta,phi,V or coach: ");
                let Some(line) = input.next() else { break };
                let line = line.map_err(|error| Failure::failed(format_args!("the input cannot be read: {error}")))?;
                lines += 1;
                let text = String::from_utf8_lossy(line.trim_ascii()).into_owned();
                if text.is_empty() {
                    continue;
                }
                text.parse()
            }
        };
        let is_line = matches!(strokes, Strokes::Input);
        let (failure, is_refused) = match stroke.and_then(|stroke| game.stroke(&table, &layout, stroke)) {
            Ok(true) => continue,
            Ok(false) => (game.no_point(), is_line),
            Err(failure) => {
                let is_refused = is_line && failure.code() == 2;
                (failure, is_refused)
            }
        };
        // What cannot be played does not end a session that others go on with.
        if !is_refused {
            // What was played counts all the same.
            game.finish()?;
            return Err(failure);
        }
        refused += 1;
        game.refuse(lines, &failure)?;
    }
    game.finish()?;
    if refused > 0 && !io::stdin().is_terminal() {
        return Err(Failure::wrong_input(format_args!("{} refused; each was told why", plural(refused, "line"))));
    }
    Ok(())
}

/// Asks whoever sits at the terminal.
pub fn prompt(words: &str) {
    if io::stdin().is_terminal() {
        // Nobody reads a prompt that cannot be written.
        let _ = io::stderr().write_all(words.as_bytes());
    }
}

/// A line on the standard output.
pub fn line(text: impl std::fmt::Display) -> Result<(), Failure> {
    Ok(writeln!(io::stdout(), "{text}")?)
}
