//! The state of the coach's screen: the balls, the shot that was found for them, and the clock of its playback.
//!
//! [`actions`] is what each key does to it.

mod actions;

use std::sync::{Arc, atomic::AtomicBool};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use super::{
    app::Mode,
    history::History,
    keymap::CoachWhen,
    playback::Playback,
    recommender::{Answer, Effort, Tutor},
    shot::Shot,
    status::Message,
};
use crate::{
    game::Rule,
    table::{Layout, LayoutError, Table},
};

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

/// A question that the coach has not answered yet.
#[derive(Debug)]
struct Pending {
    id: u64,
    cancel: Arc<AtomicBool>,
    waited: f64,
}

/// The state of the coach's screen.
#[derive(Debug)]
pub struct CoachScreen {
    /// The table that is played on.
    pub table: Table,
    /// What the arrow keys are for.
    pub mode: Mode,
    /// The ball that the arrow keys move.
    pub selected: usize,
    /// The clock of the shot.
    pub playback: Playback,
    /// What the status line says.
    pub message: Option<Message>,
    /// Whose advice is asked, and what counts as a point.
    pub tutor: Tutor,
    balls: History<Position>,
    step: usize,
    pending: Option<Pending>,
    questions: u64,
    rng: Xoshiro256PlusPlus,
}

impl CoachScreen {
    /// The screen at its start; `seed` decides about random layouts.
    ///
    /// # Errors
    /// A layout that is not possible on the table.
    pub fn new(table: Table, layout: Layout, seed: u64) -> Result<Self, LayoutError> {
        layout.validate(&table)?;
        Ok(Self {
            table,
            mode: Mode::Placing,
            selected: 0,
            playback: Playback::default(),
            message: None,
            tutor: Tutor::default(),
            balls: History::new(Position { layout, shot: None }),
            step: FIRST_STEP,
            pending: None,
            questions: 0,
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
        })
    }

    /// Asks `tutor` from now on, on `table`: balls stay where they lie if it is the same table.
    pub fn take_tutor(&mut self, table: &Table, tutor: Tutor) {
        self.cancel();
        if self.table == *table {
            let layout = *self.layout();
            self.place(layout);
        } else {
            self.balls = History::new(Position { layout: Layout::opening(table), shot: None });
            self.table = table.clone();
            self.rest();
        }
        self.message = Some(Message::good(format!("the coach plays with {}; Enter asks it", tutor.name())));
        self.tutor = tutor;
    }

    /// Takes balls from elsewhere, and what counts as a point there; whoever was asked before is asked still if the table
    /// is the same.
    pub fn take_position(&mut self, table: &Table, layout: Layout, rule: Rule) {
        if self.table != *table {
            self.take_tutor(table, Tutor::default());
        }
        self.cancel();
        self.tutor.rule = rule;
        self.place(layout);
        self.message = Some(Message::plain("the balls of the exercise; Enter asks the coach"));
    }

    /// Where the balls lie before the shot.
    pub const fn layout(&self) -> &Layout {
        &self.balls.present().layout
    }

    /// The shot that was found for the layout.
    pub const fn shot(&self) -> Option<&Arc<Shot>> {
        self.balls.present().shot.as_ref()
    }

    /// The chosen step, mm.
    pub fn step_mm(&self) -> f64 {
        STEPS[self.step]
    }

    /// Number of the spinner's picture, while the coach thinks.
    pub fn spinner(&self) -> Option<usize> {
        self.pending.as_ref().map(|pending| (pending.waited / SPINNER_INTERVAL) as usize)
    }

    /// Why a binding may not be used now; `None` where it may.
    pub fn refusal(&self, when: CoachWhen) -> Option<&'static str> {
        let refuse = |refused: bool, reason| refused.then_some(reason);
        let thinking = refuse(self.pending.is_some(), "the coach is thinking; Esc stops it");
        match when {
            CoachWhen::Anytime => None,
            CoachWhen::Thinking => refuse(self.pending.is_none(), "the coach is not thinking"),
            _ if thinking.is_some() => thinking,
            CoachWhen::Placing => {
                refuse(self.mode != Mode::Placing, "a shot is being watched; Esc goes back to the balls")
            }
            CoachWhen::Shot | CoachWhen::Watching if self.shot().is_none() => {
                Some("there is no shot yet; Enter asks the coach")
            }
            CoachWhen::Idle | CoachWhen::Shot => None,
            CoachWhen::Watching => refuse(self.mode != Mode::Watching, "no shot is being watched; Space plays one"),
            CoachWhen::Undoable => refuse(!self.balls.can_undo(), "there is nothing to take back"),
            CoachWhen::Trained => refuse(self.tutor.policy.is_none(), "the bundled weights are asked already"),
            CoachWhen::Redoable => refuse(!self.balls.can_redo(), "nothing was taken back"),
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
    pub fn lost(&mut self) {
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
