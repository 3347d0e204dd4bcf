//! The screens, one file each, and which of them is shown.

mod coach;
mod drills;
mod finder;
mod help;
mod panes;
mod target;
mod too_small;
mod training;

use ratatui::{buffer::Buffer, layout::Rect};

use super::app::{App, Screen};

pub use coach::table_mapping;
pub use target::{Target, target};

/// Columns and rows below which there is no room for the table and its panels.
pub const SMALLEST: (u16, u16) = (80, 24);

/// Draws the screen that `app` is at.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    buffer.set_style(area, app.theme().text());
    if area.width < SMALLEST.0 || area.height < SMALLEST.1 {
        too_small::draw(app, area, buffer);
    } else if let Some(top) = app.help() {
        help::draw(app, top, area, buffer);
    } else {
        match app.screen() {
            Screen::Coach => coach::draw(app, area, buffer),
            Screen::Training => training::draw(app, area, buffer),
            Screen::Drills => drills::draw(app, area, buffer),
        }
        if let Some(finder) = app.finder() {
            finder::draw(app, finder, area, buffer);
        }
    }
}
