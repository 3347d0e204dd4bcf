//! The screens, one file each, and which of them is shown.

mod coach;
mod drills;
mod finder;
mod help;
mod panes;
mod settings;
mod target;
mod too_small;
mod training;

use ratatui::{buffer::Buffer, layout::Rect};

use super::{
    app::{App, Screen},
    widgets::draw_toasts,
};

pub use coach::table_mapping;
pub use target::{Target, target};

/// Columns and rows below which there is no room for the table and its panels.
pub const SMALLEST: (u16, u16) = (80, 24);

/// Whether there is no room for any screen.
pub const fn is_too_small(area: Rect) -> bool {
    area.width < SMALLEST.0 || area.height < SMALLEST.1
}

/// Draws the screen that `app` is at.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    buffer.set_style(area, app.theme().text());
    if is_too_small(area) {
        too_small::draw(app, area, buffer);
        return;
    }
    // Whatever is to be read or answered begins there; toasts stay above it.
    let mut foot = match (app.help(), app.screen()) {
        (Some((page, top)), _) => help::draw(app, page, top, area, buffer),
        (None, Screen::Coach) => coach::draw(app, area, buffer),
        (None, Screen::Training) => training::draw(app, area, buffer),
        (None, Screen::Drills) => drills::draw(app, area, buffer),
        (None, Screen::Settings) => settings::draw(app, area, buffer),
    };
    if let Some(finder) = app.finder() {
        foot = finder::draw(app, finder, area, buffer);
    }
    // The first row is the header's.
    let room = Rect::new(area.x, area.y + 1, area.width, foot.saturating_sub(area.y + 1));
    draw_toasts(app, room, buffer);
}
