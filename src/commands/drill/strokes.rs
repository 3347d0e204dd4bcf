//! A sequence of strokes from the standard input or by the coach: each is played, judged, saved and answered at once.

use super::{
    options::{PlayOptions, StrokeInput},
    stroke_by_stroke::StrokeByStroke,
};
use crate::{
    commands::{
        Failure,
        output::{print_note, prompt_line, refused_lines_result},
    },
    drills::{Session, Store},
};

/// The word that asks what can be typed, and the answer.
const HELP: (&str, &str) = (
    "help",
    "red 1/2 right, 1.5 left, 2 up, 3 lengths: the ball and how full; side and height in tips; speed in table lengths or a word like soft\n\
     to 3.2 bottom, medium, raised 20: the line of the cue to a point of a cushion; the cue raised 20 degrees\n\
     0,0.2,5,12.5,3: the inputs a, b (radii), theta, phi (degrees) and V (m/s)\n\
     coach: the coach's shot\n\
     quit: ends the session, and its score is printed",
);

/// Largest accepted value of `--strokes`.
pub const MAX_STROKES: u32 = 10_000;

/// The source of the strokes.
#[derive(Clone, Copy, Debug)]
pub enum Strokes {
    /// The standard input, one stroke a line, except for the strokes of the coach in a match against it.
    Input,
    /// The coach.
    Coach,
    /// One stroke that is repeated.
    Same(StrokeInput),
}

/// Plays a session until it is over, its input ends, or it has `most` attempts.
pub fn play(
    store: &Store,
    session: Session,
    options: &PlayOptions,
    strokes: Strokes,
    most: usize,
) -> Result<(), Failure> {
    options.print_player(&session);
    let mut game = StrokeByStroke::new(store, session, options, matches!(strokes, Strokes::Same(_)));
    let (mut lines, mut refused) = (0_usize, 0_usize);
    while game.session().attempts.len() < most {
        let Some((table, layout)) = game.session().position().map_err(Failure::failed)? else { break };
        game.show(&table, &layout)?;
        let is_line = matches!(strokes, Strokes::Input) && !game.session().is_coachs_turn();
        let stroke = match strokes {
            Strokes::Same(stroke) => Ok(stroke),
            _ if !is_line => Ok(StrokeInput::Coach),
            _ => {
                let Some(text) = prompt_line("shot, coach, help or quit: ")? else { break };
                lines += 1;
                match text.as_deref() {
                    Ok("") => continue,
                    Ok(word) if word == HELP.0 => {
                        HELP.1.lines().for_each(print_note);
                        continue;
                    }
                    _ => text.and_then(|text| text.parse()),
                }
            }
        };
        let (failure, is_refused) = match stroke.and_then(|stroke| game.stroke(&table, &layout, stroke)) {
            Ok(true) => continue,
            Ok(false) => (game.no_point(), is_line),
            Err(failure) => {
                let is_refused = is_line && failure.code() == 2;
                (failure, is_refused)
            }
        };
        // A stroke that cannot be played does not end the session if the input continues.
        if !is_refused {
            // Strokes that were already played still count.
            game.finish()?;
            return Err(failure);
        }
        refused += 1;
        game.refuse(lines, &failure)?;
    }
    game.finish()?;
    // For a repeated stroke, the user asked for this number of attempts.
    let is_cut = game.session().attempts.len() >= most && !game.session().is_over();
    if is_cut && !matches!(strokes, Strokes::Same(_)) {
        print_note(format_args!(
            "note: the limit of {most} strokes ended it; --strokes sets another, up to {MAX_STROKES}"
        ));
    }
    refused_lines_result(refused)
}
