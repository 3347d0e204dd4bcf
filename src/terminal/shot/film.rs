//! Filmed shots, prepared for display with their simulation.

use std::sync::{Arc, OnceLock};

use crate::{
    game::Rule,
    physics::{CueInputs, level_stroke},
    study::filmed::{FilmedShot, Replay, bundled},
    table::{Layout, Table},
    terminal::Shot,
};

/// A filmed shot in the list.
#[derive(Debug)]
pub struct ListedShot {
    /// The film.
    pub filmed: FilmedShot,
    /// Positions of the balls before the stroke.
    pub layout: Layout,
    /// Whether the film shows a three-cushion point.
    pub is_point: bool,
}

/// The table of the films.
pub fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(Table::default)
}

/// All filmed shots, in the order of the match; read at the first call.
pub fn listed() -> &'static [ListedShot] {
    static FILM: OnceLock<Vec<ListedShot>> = OnceLock::new();
    FILM.get_or_init(|| {
        let list = |filmed: FilmedShot| ListedShot {
            layout: filmed.layout(table()),
            is_point: filmed.is_point(table(), Rule::ThreeCushion),
            filmed,
        };
        bundled().into_iter().map(list).collect()
    })
}

/// A filmed shot ready for playback.
#[derive(Clone, Debug)]
pub struct FilmReplay {
    /// Film and simulation.
    pub replay: Replay,
    /// The simulated shot.
    pub shot: Arc<Shot>,
    /// The stroke with a level cue that gives the fitted motion, or `None` if there is none.
    pub stroke: Option<CueInputs>,
}

impl FilmReplay {
    /// Fits the stroke and simulates the shot. This may take a second, so it must not run on the screen's thread.
    ///
    /// # Errors
    /// A message that says why the shot cannot be simulated.
    pub fn new(filmed: &FilmedShot) -> Result<Self, String> {
        let replay = Replay::new(table(), filmed).map_err(|error| error.to_string())?;
        let impulse = replay.recording.impulse();
        let stroke = level_stroke(table(), impulse);
        // If no level cue gives this spin, only the direction and speed are known.
        let shown = stroke.unwrap_or_else(|| CueInputs {
            a: 0.0,
            b: 0.0,
            theta: 0.0,
            phi: impulse.velocity.to_angle(),
            speed: impulse.velocity.length(),
        });
        let solved = replay.is_simulated_point(Rule::ThreeCushion);
        let shot = Arc::new(Shot::of(table(), replay.recording.clone(), shown, solved, "film"));
        Ok(Self { replay, shot, stroke })
    }
}
