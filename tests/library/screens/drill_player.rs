//! Somebody at the drill screens, with a folder of their own, and exercises to practise.

use std::path::PathBuf;

use carom::{
    coach::Skill,
    drills::{Attempt, Category, Exercise, Goal, Session, Venue, store::Store},
    game::Rule,
    physics::CueInputs,
    storage::Places,
    table::{Layout, Table},
    terminal::{App, Depth, DrillReport, Effect, Errand, Glyphs, Look, PracticeWorker},
};
use crossterm::event::KeyEvent;
use ratatui::{Terminal, backend::TestBackend};
use tempfile::TempDir;

use super::{coach_player::is_toast, keys::key};

pub const TRUE_COLOUR: Look = Look { depth: Depth::True, glyphs: Glyphs::Sextant, unicode: true };
pub const NO_COLOUR: Look = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
pub const ASCII: Look = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: false };

/// A stroke that makes the point from the opening position.
pub const SHOT: &str = "0.2,0.3,6,-72,2.5";

pub struct Player {
    pub app: App,
    pub copied: Vec<String>,
    practice: PracticeWorker,
    folder: TempDir,
}

pub fn places(folder: &TempDir) -> Places {
    Places::under(folder.path())
}

/// A position from the opening, with the shot that makes the point.
pub fn exercise(name: &str, title: &str) -> Exercise {
    Exercise {
        name: name.to_owned(),
        title: title.to_owned(),
        category: Category::Own,
        grade: 0,
        rule: Rule::StraightRail,
        table: "match".to_owned(),
        layout: Layout::opening(&Table::default()),
        point: "The first shot of every match. Hit yellow thin with left side and let the cushions do the rest."
            .to_owned(),
        tags: vec!["opening".to_owned()],
        shot: Some(CueInputs::parse(SHOT).unwrap()),
        par: None,
    }
}

/// A session at a real table on a day of November 2026, an attempt a letter: `x` made, any other missed.
pub fn session(number: u64, name: &str, goal: Goal, results: &str) -> Session {
    let mut session = Session::new(goal, Venue::Table, vec![exercise(name, "From the opening")], Skill::CLUB, 1);
    session.id = format!("202611{number:02}-120000-0000000{number}");
    session.started = 1_793_534_400 + number * 86_400;
    session.attempts =
        results.chars().map(|result| Attempt { at: session.started, ..Attempt::new(name, result == 'x') }).collect();
    session
}

impl Player {
    /// At the library, with these positions and sessions on the disk.
    pub fn with(look: Look, positions: &[Exercise], sessions: &[Session]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::new(&places(&folder));
        for position in positions {
            store.save_position(position, false).unwrap();
        }
        for session in sessions {
            store.save(session).unwrap();
        }
        Self::at_coach(look, folder).press("d")
    }

    /// At the coach, with what is in `folder` on the disk.
    pub fn at_coach(look: Look, folder: TempDir) -> Self {
        let table = Table::default();
        let app = App::new(table.clone(), Layout::opening(&table), look, 7).unwrap().with_places(places(&folder));
        Self { app, copied: Vec::new(), practice: PracticeWorker::default(), folder }
    }

    /// At the exercise from the opening.
    pub fn practising(look: Look) -> Self {
        Self::with(look, &[exercise("opening", "From the opening")], &[]).press("Left Enter")
    }

    pub fn store(&self) -> Store {
        Store::new(&places(&self.folder))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Presses keys, see [`key`]; errands are done at once.
    pub fn press(mut self, keys: &str) -> Self {
        for word in keys.split_whitespace() {
            if let Some(effect) = self.event(&key(word)) {
                panic!("{word} gives {effect:?}");
            }
        }
        self
    }

    /// One key; gives what is none of the drill screens' business.
    pub fn event(&mut self, event: &KeyEvent) -> Option<Effect> {
        match self.app.handle(event)? {
            Effect::Drill(errands) => self.run(errands),
            Effect::Copy(text) => self.copied.push(text),
            Effect::Settings(_) => {}
            other => return Some(other),
        }
        None
    }

    /// Types words, blanks included.
    pub fn type_in(mut self, text: &str) -> Self {
        for letter in text.chars() {
            let name = if letter == ' ' { "Space".to_owned() } else { letter.to_string() };
            self = self.press(&name);
        }
        self
    }

    /// Does errands, and what comes of them.
    pub fn run(&mut self, errands: Vec<Errand>) {
        for errand in errands {
            let mut reports = Vec::new();
            match errand {
                // What the coach finds depends on how fast the machine is.
                Errand::Advise(position) if position.own.is_none() => {
                    reports.push(DrillReport::Advised(position.id, Ok(None)));
                }
                errand => self.practice.run(errand, &mut |report| reports.push(report)),
            }
            for report in reports {
                let more = self.app.receive_drill(report);
                self.run(more);
            }
        }
    }

    /// Attempts on the disk.
    pub fn kept(&self) -> usize {
        self.store().sessions().items.iter().map(|session| session.attempts.len()).sum()
    }

    pub fn wait(mut self, seconds: f64) -> Self {
        self.app.tick(seconds);
        self
    }

    pub fn text(&self, width: u16, height: u16) -> String {
        let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        terminal.draw(|frame| self.app.draw(frame)).unwrap();
        terminal.backend().to_string()
    }

    /// On the screen, in a toast perhaps, which breaks its lines as it needs.
    pub fn says(&self, part: &str) -> &Self {
        let text = self.text(120, 40);
        assert!(text.contains(part) || is_toast(&self.app, part), "{part}\n{text}");
        self
    }

    pub fn is_silent_on(&self, part: &str) -> &Self {
        let text = self.text(120, 40);
        assert!(!text.contains(part), "{part}\n{text}");
        self
    }
}
