//! The state of the filmed shots: their list, and the one that is watched beside its simulation.

use std::sync::{Arc, OnceLock};

use super::{keymap::DrillAction, playback::Playback, shot::Shot};
use crate::{
    game::Rule,
    physics::{CueInputs, level_stroke},
    study::filmed::{FilmedShot, Replay, bundled},
    table::{Layout, Table},
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
pub struct FilmScene {
    /// Film and simulation.
    pub replay: Replay,
    /// What the simulation makes of it, to be shown.
    pub shot: Arc<Shot>,
    /// The stroke with a level cue that gives the fitted motion, where one does.
    pub stroke: Option<CueInputs>,
    /// Whether the simulated shot is a point at three cushions.
    pub is_point: bool,
}

impl FilmScene {
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
        let is_point = replay.is_simulated_point(Rule::ThreeCushion);
        let shot = Arc::new(Shot::of(table(), replay.recording.clone(), shown, is_point, "film"));
        Ok(Self { replay, shot, stroke, is_point })
    }
}

/// The filmed shots on the screen.
#[derive(Debug, Default)]
pub struct FilmScreen {
    mark: usize,
    scene: Option<Box<FilmScene>>,
    /// The clock of the shot that is watched.
    pub playback: Playback,
}

impl FilmScreen {
    /// Place of the marked shot in the list.
    pub const fn mark(&self) -> usize {
        self.mark
    }

    /// The marked shot, which is the one that is watched.
    pub fn marked(&self) -> Option<&'static Listed> {
        listed().get(self.mark)
    }

    /// Moves the mark by lines, down where positive.
    pub fn move_mark(&mut self, lines: isize) {
        self.mark = self.mark.saturating_add_signed(lines).min(listed().len().saturating_sub(1));
    }

    /// Marks the shot so many after the marked one; gives what is to be played. It is watched when it is received.
    pub fn begin(&mut self, shots: isize) -> Option<FilmedShot> {
        self.move_mark(shots);
        self.scene = None;
        self.playback.jump(0.0);
        self.marked().map(|listed| listed.filmed.clone())
    }

    /// The shot of this number has been played; one that nobody waits for any more is dropped.
    ///
    /// # Errors
    /// Why it could not be played.
    pub fn receive(&mut self, number: u32, played: Result<Box<FilmScene>, String>) -> Result<(), String> {
        if self.scene.is_none() && self.marked().is_some_and(|listed| listed.filmed.number == number) {
            let scene = self.scene.insert(played?);
            self.playback.toggle(scene.replay.duration());
        }
        Ok(())
    }

    /// What is watched; `None` while the stroke is being fitted.
    pub fn scene(&self) -> Option<&FilmScene> {
        self.scene.as_deref()
    }

    /// Does what a key asks of the shot that is watched.
    pub fn watch(&mut self, action: DrillAction) {
        let Some(scene) = &self.scene else { return };
        let (events, duration) = (scene.shot.recording.events(), scene.replay.duration());
        match action {
            DrillAction::Event(step) if step > 0 => self.playback.step_forward(events, duration),
            DrillAction::Event(_) => self.playback.step_back(events),
            DrillAction::Pace(step) if step > 0 => self.playback.faster(),
            DrillAction::Pace(_) => self.playback.slower(),
            _ => self.playback.toggle(duration),
        }
    }

    /// Stops playing where it is: nobody watches.
    pub fn pause(&mut self) {
        self.playback.pause();
    }

    /// Lets `seconds` pass for the shot.
    pub fn tick(&mut self, seconds: f64) {
        if let Some(scene) = &self.scene {
            self.playback.tick(seconds, scene.replay.duration());
        }
    }
}
