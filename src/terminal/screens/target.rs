//! What the mouse can point at.

use ratatui::layout::{Position, Rect};

use super::{SMALLEST, coach, drills, settings, training};
use crate::terminal::{
    app::{App, Screen},
    geometry::Mapping,
    keymap::{DrillPlace, Place, SettingsPlace},
    widgets::tabs,
};

/// Something on the screen that answers to the mouse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The tab of a screen.
    Tab(Screen),
    /// The cloth of the coach's table.
    Table(Mapping),
    /// A shot that may be chosen, by its place in the list.
    Shot(usize),
    /// A list with a mark, and how many lines the mark is away, down where positive; `None` where there is no line.
    List(Option<isize>),
}

/// What is drawn at a cell of the screen in `area`, nothing lying over it.
pub fn target(app: &App, area: Rect, at: Position) -> Option<Target> {
    if area.width < SMALLEST.0 || area.height < SMALLEST.1 {
        return None;
    }
    // The first row is the header's, the last two tell news and keys.
    let page = Rect::new(area.x, area.y + 1, area.width, area.height - 3);
    let header = Rect { height: 1, ..area };
    if let Some((screen, ..)) = tabs(app, header).into_iter().find(|(_, place, _)| place.contains(at)) {
        return Some(Target::Tab(screen));
    }
    match app.place() {
        Place::Coach => coach::target(app, area, at),
        Place::Runs | Place::Compare => training::runs::target(app, page, at),
        Place::Drill(DrillPlace::Library | DrillPlace::Search) => drills::library::target(app, page, at),
        Place::Drill(DrillPlace::Films) => drills::films::target(app, page, at),
        Place::Settings(SettingsPlace::Values | SettingsPlace::Keys) => settings::target(app, page, at),
        _ => None,
    }
}

/// A list whose line `line` is where the mouse is, and whose mark is at the line `mark`.
pub fn list(line: Option<usize>, mark: usize) -> Target {
    Target::List(line.map(|line| line.cast_signed() - mark.cast_signed()))
}
