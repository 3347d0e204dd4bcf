//! A player at the coach's screen, and a coach whose answers are always the same.

use std::sync::Arc;

use carom::{
    coach::{Kind, Pace, Way},
    learning::evaluation::SuccessRate,
    physics::CueInputs,
    table::{Layout, Table},
    terminal::{Advice, Answer, App, Capabilities, CoachNews, CoachWorker, Depth, Effect, Glyphs, Job, Proposal, Shot},
};
use ratatui::{Terminal, backend::TestBackend, buffer::Buffer};

use crate::keys::key;

pub const TRUE_COLOUR: Capabilities = Capabilities { depth: Depth::True, glyphs: Glyphs::Sextant, unicode: true };
pub const NO_COLOUR: Capabilities = Capabilities { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
pub const ASCII: Capabilities = Capabilities { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: false };

/// A shot that makes the point from the opening position, so that the pictures do not change with the coach, two others,
/// and one that makes the point from where the first leaves the balls.
pub const SHOT: &str = "0.2,0.3,6,-72,2.5";
pub const OTHERS: [&str; 2] = ["0.4,-0.22,2.37,-104.8,4.84", "0.09,0.35,2,-73.3,2.58"];
pub const NEXT: &str = "-0.353,0.054,3.2,87.8,5.07";

/// Whether a toast says `part`.
pub fn is_toast(app: &App, part: &str) -> bool {
    app.toasts().shown().iter().any(|toast| toast.text.contains(part))
}

pub struct Player {
    pub app: App,
    pub asked: Option<Box<Job>>,
    pub study: Option<Box<Job>>,
}

/// A shot with `made` of 1000 attempts.
pub fn proposal(table: &Table, layout: &Layout, cue: &str, way: Way, made: usize) -> Proposal {
    let shot = Shot::new(table, layout, CueInputs::parse(cue).unwrap(), true, "policy").unwrap();
    let pace = if shot.cue.speed < 2.5 { Pace::Soft } else { Pace::Hard };
    Proposal {
        shot: Arc::new(shot),
        kind: Some(Kind { first_ball: 1, cushion_first: false, way, pace }),
        made: Some(SuccessRate::new(made, 1000)),
        next: Some(0.97),
        is_early: false,
    }
}

/// The coach's advice on the opening position.
pub fn advice(job: &Job) -> Advice {
    let proposal = |cue, way, made| proposal(&job.table, &job.layout, cue, way, made);
    let best = proposal(SHOT, Way::OffCushion, 940);
    let others = OTHERS.into_iter().zip([893, 620]).map(|(cue, made)| proposal(cue, Way::AroundTheTable, made));
    Advice { proposals: std::iter::once(best).chain(others).collect(), effort: None }
}

impl Player {
    pub fn with(caps: Capabilities) -> Self {
        let table = Table::default();
        let app = App::new(table.clone(), Layout::opening(&table), caps, 7).unwrap();
        Self { app, asked: None, study: None }
    }

    pub fn new() -> Self {
        Self::with(TRUE_COLOUR)
    }

    /// Presses keys: letters as they are, names like `Left`, `S-Left`, `C-Left`, `Enter` between blanks.
    pub fn press(mut self, keys: &str) -> Self {
        for word in keys.split_whitespace() {
            let effect = self.app.handle(&key(word));
            self.take(effect);
        }
        self
    }

    pub fn take(&mut self, effect: Option<Effect>) {
        match effect {
            Some(Effect::Recommend(job)) => self.asked = Some(job),
            Some(Effect::Study(job)) => self.study = Some(job),
            Some(other @ (Effect::Quit | Effect::Suspend)) => panic!("{other:?}"),
            // What other screens want is another matter.
            _ => {}
        }
    }

    pub fn tell(mut self, id: u64, news: CoachNews) -> Self {
        let effect = self.app.receive(Answer { id, news });
        self.take(effect);
        self
    }

    /// The coach answers with [`SHOT`] and [`OTHERS`].
    pub fn answer(mut self) -> Self {
        let job = self.asked.take().expect("the coach was asked");
        let advice = advice(&job);
        self.tell(job.id, CoachNews::Advice(advice))
    }

    /// The coach says that the shot with this cue is the best so far, with `made` of 1000 attempts.
    pub fn better(self, cue: &str, made: usize) -> Self {
        let job = self.asked.clone().expect("the coach was asked");
        let so_far = proposal(&job.table, &job.layout, cue, Way::OffCushion, made);
        self.tell(job.id, CoachNews::Better(Proposal { is_early: true, ..so_far }))
    }

    /// The closer look at the shot that is shown, by the real coach, but for the next shot, which is [`NEXT`].
    pub fn studied(mut self) -> Self {
        // Even if nobody waits for it any more.
        let job = Job { cancel: Arc::default(), ..*self.study.take().expect("a closer caps is wanted") };
        let mut study = None;
        CoachWorker::unhurried(1).answer(&job, |answer| {
            if let CoachNews::Study(found) = answer.news {
                study = Some(found);
            }
        });
        let end = self.app.shot().unwrap().recording.final_layout();
        let next = proposal(&job.table, &end, NEXT, Way::Direct, 1000);
        self.tell(job.id, CoachNews::Study(study.unwrap()))
            .tell(job.id, CoachNews::Next(Some(Advice { proposals: vec![next], effort: None })))
    }

    pub fn wait(mut self, seconds: f64) -> Self {
        self.app.tick(seconds);
        self
    }

    pub fn draw(&self, width: u16, height: u16) -> Terminal<TestBackend> {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| self.app.draw(frame)).unwrap();
        terminal
    }

    pub fn picture(&self, width: u16, height: u16) -> Buffer {
        self.draw(width, height).backend().buffer().clone()
    }

    pub fn text(&self, width: u16, height: u16) -> String {
        self.draw(width, height).backend().to_string()
    }

    /// In a toast.
    pub fn warns(&self, part: &str) {
        assert!(is_toast(&self.app, part), "{part}\n{}", self.text(120, 40));
    }

    /// No toast is shown: nothing was refused.
    pub fn warns_nothing(&self) {
        assert!(self.app.toasts().shown().is_empty(), "{}", self.text(120, 40));
    }
}
