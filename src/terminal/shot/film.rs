//! Filmed shots, ready to be shown beside their simulation.

use std::sync::{Arc, OnceLock};

use crate::{
    game::Rule,
    physics::{CueInputs, level_stroke},
    study::filmed::{FilmedShot, Replay, bundled},
    table::{Layout, Table},
    terminal::Shot,
};

/// A filmed shot as it is listed.
#[derive(Debug)]
pub struct Listed {
    /// The film.
    pub filmed: FilmedShot,
    /// Where the balls lie before the stroke.
    pub layout: Layout,
    /// Whether the film shows a point at three cushions.
    pub is_point: bool,
}

/// The table that the film is played on.
pub fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(Table::default)
}

/// All filmed shots, in the order of the match. They are read when they are first asked for.
pub fn listed() -> &'static [Listed] {
    static FILM: OnceLock<Vec<Listed>> = OnceLock::new();
    FILM.get_or_init(|| {
        let list = |filmed: FilmedShot| Listed {
            layout: filmed.layout(table()),
            is_point: filmed.is_point(table(), Rule::ThreeCushion),
            filmed,
        };
        bundled().into_iter().map(list).collect()
    })
}

/// A filmed shot that can be watched.
#[derive(Clone, Debug)]
pub struct FilmReplay {
    /// Film and simulation.
    pub replay: Replay,
    /// What the simulation makes of it, to be shown.
    pub shot: Arc<Shot>,
    /// The stroke with a level cue that gives the fitted motion, where one does.
    pub stroke: Option<CueInputs>,
}

impl FilmReplay {
    /// Fits the stroke and plays the shot. That may take a second: not for the screen's thread.
    ///
    /// # Errors
    /// A sentence on why it cannot be played.
    pub fn new(filmed: &FilmedShot) -> Result<Self, String> {
        let replay = Replay::new(table(), filmed).map_err(|error| error.to_string())?;
        let impulse = replay.recording.impulse();
        let stroke = level_stroke(table(), impulse);
        // Where no level cue gives such a spin, the direction alone is known.
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
