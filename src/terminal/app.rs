//! The state of the program and what each action does to it; it draws on any frame and needs no terminal.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use crossterm::event::{KeyEvent, KeyEventKind};
use glam::DVec2;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use ratatui::Frame;

use super::{
    history::History,
    keymap::{self, Action, When},
    look::Look,
    placing,
    playback::Playback,
    recommender::{Answer, Job},
    screens,
    shot::Shot,
    status::Message,
    theme::Theme,
    words::{BALL_NAMES, step_words},
};
use crate::table::{BALLS, Layout, LayoutError, Table};

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
    /// The program at its start; `seed` decides about random layouts and the coach's random numbers.
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
            When::Idle => None,
            When::Placing => refuse(self.mode != Mode::Placing, "a shot is being watched; Esc goes back to the balls"),
            When::Watching => refuse(self.mode != Mode::Watching, "no shot is being watched; Space plays one"),
            When::Shot => refuse(self.shot().is_none(), "there is no shot yet; Enter asks the coach"),
            When::Undoable => refuse(!self.balls.can_undo(), "there is nothing to take back"),
            When::Redoable => refuse(!self.balls.can_redo(), "nothing was taken back"),
        }
    }

    /// Does what an enabled binding asks for.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
            Action::Quit => return Some(Effect::Quit),
            Action::Suspend => return Some(Effect::Suspend),
            Action::OpenHelp => self.help = Some(0),
            Action::CloseHelp => self.help = None,
            Action::ScrollHelp(lines) => {
                self.help = self.help.map(|top| top.saturating_add_signed(lines).min(screens::MOST_SCROLL));
            }
            Action::NextGlyphs => self.look = self.look.with_next_glyphs(),
            Action::Select(ball) => self.select(ball),
            Action::SelectNext => self.select((self.selected + 1) % BALLS),
            Action::SelectPrevious => self.select((self.selected + BALLS - 1) % BALLS),
            Action::Move(x, y, scale) => self.move_ball(DVec2::new(f64::from(x), f64::from(y)), scale),
            Action::LargerStep => self.choose_step(self.step + 1),
            Action::SmallerStep => self.choose_step(self.step.saturating_sub(1)),
            Action::Opening => self.place(Layout::opening(&self.table)),
            Action::Random => {
                let layout = Layout::random(&self.table, &mut self.rng);
                self.place(layout);
            }
            Action::Undo => self.travel(History::undo),
            Action::Redo => self.travel(History::redo),
            Action::Recommend => return Some(self.ask()),
            Action::Cancel => self.cancel(),
            Action::PlaceBalls => self.mode = Mode::Placing,
            Action::Continue => self.go_on(),
            other => self.play(other),
        }
        None
    }

    fn play(&mut self, action: Action) {
        let Some(shot) = self.shot().cloned() else { return };
        let (events, duration) = (shot.recording.events(), shot.recording.duration());
        self.mode = Mode::Watching;
        match action {
            Action::PlayPause => self.playback.toggle(duration),
            Action::NextEvent => self.playback.step_forward(events, duration),
            Action::PreviousEvent => self.playback.step_back(events),
            Action::ToStart => self.playback.jump(0.0),
            Action::ToEnd => self.playback.jump(duration),
            Action::Faster => self.playback.faster(),
            Action::Slower => self.playback.slower(),
            _ => {}
        }
    }

    fn select(&mut self, ball: usize) {
        self.selected = ball;
        self.mode = Mode::Placing;
    }

    fn choose_step(&mut self, step: usize) {
        self.step = step.min(STEPS.len() - 1);
        self.message = Some(Message::plain(format!("one step is {}", step_words(self.step_mm()))));
    }

    fn move_ball(&mut self, direction: DVec2, scale: f64) {
        let step = direction * (0.001 * self.step_mm() * scale);
        let slide = placing::slide(&self.table, self.layout(), self.selected, step);
        if slide.layout != *self.layout() {
            self.place(slide.layout);
        }
        if let Some(reason) = slide.stopped {
            self.message = Some(Message::warning(format!("{} stops: {reason}", BALL_NAMES[self.selected])));
        }
    }

    /// Puts the balls elsewhere, as a step that can be taken back. The shot was for where they lay.
    fn place(&mut self, layout: Layout) {
        self.balls.push(Position { layout, shot: None });
        self.rest();
    }

    fn travel(&mut self, step: impl Fn(&mut History<Position>) -> bool) {
        step(&mut self.balls);
        self.rest();
    }

    fn rest(&mut self) {
        self.mode = Mode::Placing;
        self.playback.jump(0.0);
    }

    fn go_on(&mut self) {
        let Some(end) = self.shot().map(|shot| shot.recording.final_layout()) else { return };
        match end.validate(&self.table) {
            Ok(()) => self.place(end),
            Err(error) => self.message = Some(Message::warning(error.to_string())),
        }
    }

    fn ask(&mut self) -> Effect {
        self.questions += 1;
        self.playback.playing = false;
        let cancel = Arc::new(AtomicBool::new(false));
        self.pending = Some(Pending { id: self.questions, cancel: Arc::clone(&cancel), waited: 0.0 });
        let (table, layout) = (self.table.clone(), *self.layout());
        Effect::Recommend(Box::new(Job { id: self.questions, table, layout, seed: self.questions, cancel }))
    }

    fn cancel(&mut self) {
        if let Some(pending) = self.pending.take() {
            pending.cancel.store(true, Ordering::Relaxed);
            self.message = Some(Message::plain("the coach has stopped thinking"));
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
                self.message = Some(news(&shot));
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

/// What the screens read.
impl App {
    /// The table that is played on.
    pub const fn table(&self) -> &Table {
        &self.table
    }

    /// Where the balls lie before the shot.
    pub const fn layout(&self) -> &Layout {
        &self.balls.present().layout
    }

    /// The shot that was found for the layout.
    pub const fn shot(&self) -> Option<&Arc<Shot>> {
        self.balls.present().shot.as_ref()
    }

    /// What the arrow keys are for.
    pub const fn mode(&self) -> Mode {
        self.mode
    }

    /// The shot that is being watched.
    pub fn watched(&self) -> Option<&Shot> {
        self.shot().filter(|_| self.mode == Mode::Watching).map(Arc::as_ref)
    }

    /// The clock of the shot.
    pub const fn playback(&self) -> &Playback {
        &self.playback
    }

    /// The ball that the arrow keys move.
    pub const fn selected(&self) -> usize {
        self.selected
    }

    /// The chosen step, mm.
    pub fn step_mm(&self) -> f64 {
        STEPS[self.step]
    }

    /// Number of the spinner's picture, while the coach thinks.
    pub fn spinner(&self) -> Option<usize> {
        self.pending.as_ref().map(|pending| (pending.waited / SPINNER_INTERVAL) as usize)
    }

    /// What the status line says.
    pub const fn message(&self) -> Option<&Message> {
        self.message.as_ref()
    }

    /// The first line of the help, while it is open.
    pub const fn help(&self) -> Option<u16> {
        self.help
    }

    /// What the terminal can show.
    pub const fn look(&self) -> Look {
        self.look
    }

    /// The colours.
    pub const fn theme(&self) -> &Theme {
        &self.theme
    }
}

fn news(shot: &Shot) -> Message {
    let contact = shot.contact_words().map_or(String::new(), |words| format!("; {words}"));
    if shot.solved {
        Message::good(format!("makes the point ({}){contact}", shot.source))
    } else {
        Message::warning(format!("no point found in time; this is the best attempt ({}){contact}", shot.source))
    }
}
