//! The state of the program; it draws on any frame and needs no terminal.
//!
//! [`actions`] is what each key does to it, [`view`] what the screens read of it.

mod actions;
mod view;

use std::sync::{Arc, atomic::AtomicBool};

use crossterm::event::{KeyEvent, KeyEventKind};
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use ratatui::Frame;

use super::{
    history::History,
    keymap::{self, When},
    look::Look,
    playback::Playback,
    recommender::{Answer, Effort, Job},
    screens,
    shot::Shot,
    status::Message,
    theme::Theme,
};
use crate::table::{Layout, LayoutError, Table};

/// Step sizes of the arrow keys, mm; Shift makes them ten times larger, Ctrl ten times smaller.
const STEPS: [f64; 5] = [1.0, 5.0, 10.0, 50.0, 100.0];
const FIRST_STEP: usize = 2;
/// Seconds a picture of the spinner stays.
const SPINNER_INTERVAL: f64 = 0.1;

/// The balls and the shot that was found for them.
#[derive(Clone, Debug)]
struct Position {
    layout: Layout,
    shot: Option<Arc<Shot>>,
}

/// What the arrow keys are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// They move balls.
    Placing,
    /// They step through a shot.
    Watching,
}

/// A question that the coach has not answered yet.
#[derive(Debug)]
struct Pending {
    id: u64,
    cancel: Arc<AtomicBool>,
    waited: f64,
}

/// What the program around the app has to do.
#[derive(Clone, Debug)]
pub enum Effect {
    /// Ask the coach and hand the answer to [`App::receive`].
    Recommend(Box<Job>),
    /// Stop until the shell continues the program.
    Suspend,
    /// End.
    Quit,
}

/// The whole state of the terminal program.
#[derive(Debug)]
pub struct App {
    table: Table,
    balls: History<Position>,
    selected: usize,
    step: usize,
    mode: Mode,
    playback: Playback,
    pending: Option<Pending>,
    questions: u64,
    message: Option<Message>,
    help: Option<u16>,
    look: Look,
    theme: Theme,
    rng: Xoshiro256PlusPlus,
}

impl App {
    /// The program at its start; `seed` decides about random layouts.
    ///
    /// # Errors
    /// A layout that is not possible on the table.
    pub fn new(table: Table, layout: Layout, look: Look, seed: u64) -> Result<Self, LayoutError> {
        layout.validate(&table)?;
        Ok(Self {
            table,
            balls: History::new(Position { layout, shot: None }),
            selected: 0,
            step: FIRST_STEP,
            mode: Mode::Placing,
            playback: Playback::default(),
            pending: None,
            questions: 0,
            message: None,
            help: None,
            look,
            theme: Theme::new(look.depth),
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
        })
    }

    /// A key was pressed.
    pub fn handle(&mut self, key: &KeyEvent) -> Option<Effect> {
        if key.kind == KeyEventKind::Release {
            return None;
        }
        match keymap::find(key, |when| self.refusal(when))? {
            Ok(action) => {
                self.message = None;
                self.update(action)
            }
            Err(reason) => {
                self.message = Some(Message::warning(reason));
                None
            }
        }
    }

    /// Why a binding may not be used now; `None` where it may.
    pub fn refusal(&self, when: When) -> Option<&'static str> {
        let refuse = |refused: bool, reason| refused.then_some(reason);
        let thinking = refuse(self.pending.is_some(), "the coach is thinking; Esc stops it");
        match when {
            When::Help => refuse(self.help.is_none(), "the help is not open"),
            _ if self.help.is_some() => Some("close the help first: Esc"),
            When::Always => None,
            When::Thinking => refuse(self.pending.is_none(), "the coach is not thinking"),
            _ if thinking.is_some() => thinking,
            When::Placing => refuse(self.mode != Mode::Placing, "a shot is being watched; Esc goes back to the balls"),
            When::Shot | When::Watching if self.shot().is_none() => Some("there is no shot yet; Enter asks the coach"),
            When::Idle | When::Shot => None,
            When::Watching => refuse(self.mode != Mode::Watching, "no shot is being watched; Space plays one"),
            When::Undoable => refuse(!self.balls.can_undo(), "there is nothing to take back"),
            When::Redoable => refuse(!self.balls.can_redo(), "nothing was taken back"),
        }
    }

    /// The coach has answered. Late answers to cancelled questions are dropped.
    pub fn receive(&mut self, answer: Answer) {
        if self.pending.as_ref().is_none_or(|pending| pending.id != answer.id) {
            return;
        }
        self.pending = None;
        match answer.shot {
            Ok(shot) => {
                self.playback.jump(0.0);
                self.message = Some(news(&shot, answer.effort));
                self.balls.present_mut().shot = Some(shot);
                self.mode = Mode::Watching;
            }
            Err(sentence) => self.message = Some(Message::warning(sentence)),
        }
    }

    /// The thread that thinks is gone, and with it the answer.
    pub fn coach_lost(&mut self) {
        if self.pending.take().is_some() {
            self.message = Some(Message::warning("the coach has failed; quit and start again to ask it"));
        }
    }

    /// Lets `seconds` pass for whatever moves on the screen.
    pub fn tick(&mut self, seconds: f64) {
        if let Some(pending) = &mut self.pending {
            pending.waited += seconds;
        }
        if let Some(duration) = self.shot().map(|shot| shot.recording.duration()) {
            self.playback.tick(seconds, duration);
        }
    }

    /// Seconds until the next picture; `None` while nothing moves by itself.
    pub fn frame_interval(&self) -> Option<f64> {
        if self.playback.playing { Some(1.0 / 30.0) } else { self.pending.as_ref().map(|_| SPINNER_INTERVAL) }
    }

    /// Draws the screen.
    pub fn draw(&self, frame: &mut Frame) {
        screens::draw(self, frame.area(), frame.buffer_mut());
    }
}

fn news(shot: &Shot, effort: Option<Effort>) -> Message {
    let contact = shot.contact_words().map_or(String::new(), |words| format!("; {words}"));
    let took = effort.map_or(String::new(), |effort| match effort.elapsed.as_millis() {
        0 => ", under 1 ms".to_owned(),
        milliseconds => format!(", {milliseconds} ms"),
    });
    if shot.solved {
        return Message::good(format!("makes the point ({}{took}){contact}", shot.source));
    }
    let tried = effort.map_or(String::new(), |effort| format!(" in {} simulations", effort.simulations));
    Message::warning(format!("no point found{tried}; this is the best attempt ({}{took}){contact}", shot.source))
}
