//! The animation in the README: a ball is moved, the coach recommends a shot, and the shot is played.

use std::error::Error;

use carom::{
    table::{Layout, Table},
    terminal::{App, Capabilities},
};
use crossterm::event::{
    KeyCode::{self, Char, Enter, Right, Up},
    KeyEvent, KeyModifiers,
};
use ratatui::{
    Terminal,
    backend::TestBackend,
    buffer::{Buffer, Cell},
    style::{Modifier, Style},
};

use crate::{
    animation::{Frame, moving_picture},
    answer,
};

/// Columns and rows of the screen.
const SIZE: (u16, u16) = (100, 30);
/// Rows below the screen, for the pressed key and what it does.
const CAPTION: u16 = 2;
/// Initial layout, in metres. Red is then moved to its position in the other pictures.
const LAYOUT: &str = "-0.57,-0.43 -1.11,-0.3 0.09,0.46";
/// Seconds between two frames of a shot.
const STEP: f64 = 1.0 / 15.0;
/// Seconds of the shot that are played at real speed; the rest is played faster.
const WATCHED: f64 = 2.6;
/// How often `+` is pressed for the rest.
const FASTER: usize = 2;

/// Returns the animation as SVG.
pub fn picture(caps: Capabilities) -> Result<String, Box<dyn Error>> {
    let table = Table::default();
    let layout = Layout::parse(LAYOUT, &table)?;
    let mut film =
        Film { app: App::new(table, layout, caps, 7)?, frames: Vec::new(), caption: ("", "place the balls") };
    film.show(1.5)?;
    film.caption = ("3", "selects the red ball");
    film.press(Char('3'), KeyModifiers::NONE, 1.0)?;
    film.caption = ("Shift-→", "moves it by 100 mm");
    for _ in 0..3 {
        film.press(Right, KeyModifiers::SHIFT, 0.25)?;
    }
    film.caption = ("Shift-↑", "moves it by 100 mm");
    for _ in 0..2 {
        film.press(Up, KeyModifiers::SHIFT, 0.25)?;
    }
    film.lengthen(0.75);
    let still = film.ask()?;
    film.play()?;
    Ok(moving_picture(&film.frames, still, "A ball is moved, the coach recommends a shot, and the shot is played"))
}

/// The program and the frames that were drawn.
struct Film {
    app: App,
    frames: Vec<Frame>,
    /// The key that was pressed last, and what it does.
    caption: (&'static str, &'static str),
}

impl Film {
    /// Adds a frame with the current screen.
    fn show(&mut self, seconds: f64) -> Result<(), Box<dyn Error>> {
        let mut terminal = Terminal::new(TestBackend::new(SIZE.0, SIZE.1))?;
        terminal.draw(|frame| self.app.draw(frame))?;
        let screen = with_caption(terminal.backend().buffer(), self.caption);
        self.frames.push(Frame { screen, seconds });
        Ok(())
    }

    fn press(&mut self, key: KeyCode, modifiers: KeyModifiers, seconds: f64) -> Result<(), Box<dyn Error>> {
        self.app.handle(&KeyEvent::new(key, modifiers));
        self.show(seconds)
    }

    /// Shows the last frame for this many seconds more.
    fn lengthen(&mut self, seconds: f64) {
        if let Some(last) = self.frames.last_mut() {
            last.seconds += seconds;
        }
    }

    /// Asks the coach, and returns the index of the frame with its advice.
    fn ask(&mut self) -> Result<usize, Box<dyn Error>> {
        self.caption = ("Enter", "asks the coach for a shot");
        let question = self.app.handle(&Enter.into());
        self.show(0.7)?;
        answer(&mut self.app, question, |_| {});
        self.caption = ("Enter", "the coach says how to strike, and how often you make the shot");
        self.show(4.0)?;
        Ok(self.frames.len() - 1)
    }

    /// Plays the shot to its end.
    fn play(&mut self) -> Result<(), Box<dyn Error>> {
        let duration = self
            .app
            .coach
            .shot()
            .filter(|shot| shot.solved)
            .ok_or("the coach finds no point here")?
            .recording
            .duration();
        self.caption = ("Space", "plays the shot");
        self.app.handle(&Char(' ').into());
        let watched = (WATCHED.min(duration) / STEP).round() as usize;
        for _ in 0..watched {
            self.app.tick(STEP);
            self.show(STEP)?;
        }
        self.caption = ("+", "plays faster");
        for _ in 0..FASTER {
            self.app.handle(&Char('+').into());
        }
        while self.app.frame_interval().is_some() {
            self.app.tick(STEP);
            self.show(STEP)?;
        }
        self.caption = ("", "the point is made");
        self.show(3.0)
    }
}

/// Returns the screen with a caption line below it. The key is drawn like the open tab in the first row of the screen.
fn with_caption(screen: &Buffer, (key, words): (&str, &str)) -> Buffer {
    let mut area = screen.area;
    area.height += CAPTION;
    let (page, tab) = (screen.content.last().map_or(Style::new(), Cell::style), screen[(1, 0)].style());
    let mut all = Buffer::empty(area);
    all.set_style(area, page.remove_modifier(Modifier::all()));
    all.merge(screen);
    let row = area.height - 1;
    let mut column = 1;
    if !key.is_empty() {
        let key = format!(" {key} ");
        (column, _) = all.set_stringn(column, row, &key, usize::from(area.width), tab);
        column += 1;
    }
    all.set_stringn(column, row, words, usize::from(area.width - column), Style::new());
    all
}
