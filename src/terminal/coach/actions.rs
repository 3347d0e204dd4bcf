//! What each action does to the state.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

use glam::DVec2;

use super::{CoachScreen, Pending, Position, STEPS};
use crate::{
    table::{BALLS, Layout, LayoutError},
    terminal::{
        app::{Effect, Mode},
        history::History,
        keymap::CoachAction as Action,
        placing,
        recommender::{Job, Tutor},
        status::Message,
        words::{BALL_NAMES, step_words},
    },
};

impl CoachScreen {
    /// Does what an enabled binding asks for.
    pub fn update(&mut self, action: Action) -> Option<Effect> {
        match action {
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
            Action::PlaceBalls => self.place_balls(),
            Action::Continue => self.go_on(),
            Action::Bundled => self.take_tutor(&self.table.clone(), Tutor::default()),
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
        self.place_balls();
    }

    /// Leaves the shot: what nobody watches does not play on.
    fn place_balls(&mut self) {
        self.playback.pause();
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
            let name = BALL_NAMES[self.selected];
            let place = match &reason {
                LayoutError::Overlap { first, second, .. } => {
                    format!("in contact with {}", BALL_NAMES[first + second - self.selected])
                }
                _ => "at the rail".to_owned(),
            };
            self.message = Some(Message::warning(format!("{name} stops {place}: beyond, {reason}")));
        }
    }

    /// Puts the balls elsewhere, as a step that can be taken back. The shot was for where they lay.
    pub(super) fn place(&mut self, layout: Layout) {
        self.balls.push(Position { layout, shot: None });
        self.rest();
    }

    fn travel(&mut self, step: impl Fn(&mut History<Position>) -> bool) {
        step(&mut self.balls);
        self.rest();
    }

    pub(super) fn rest(&mut self) {
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
        let tutor = self.tutor.clone();
        Effect::Recommend(Box::new(Job { id: self.questions, table, layout, tutor, seed: self.questions, cancel }))
    }

    pub(super) fn cancel(&mut self) {
        if let Some(pending) = self.pending.take() {
            pending.cancel.store(true, Ordering::Relaxed);
            self.message = Some(Message::plain("the coach has stopped thinking"));
        }
    }
}
