//! The screen as a whole: the open page between tabs and keys, and what lies over it.

mod command_palette;
mod glossary;
mod help;
mod hints;
mod tabs;
mod target;
mod toasts;
mod too_small;

use ratatui::{buffer::Buffer, layout::Rect};

use self::{hints::draw_hints, tabs::draw_tabs, toasts::draw_toasts};
use crate::terminal::{
    App, Overlay, Toast,
    pages::{Page, PageArea},
    ui::{Ui, draw_question, draw_status},
};

pub use self::{
    help::end as overlay_end,
    target::{Pointed, pointed_at},
};

/// Columns and rows below which there is no room for the table and its panels.
pub const SMALLEST: (u16, u16) = (80, 24);

/// Whether there is no room for any page.
pub const fn is_too_small(area: Rect) -> bool {
    area.width < SMALLEST.0 || area.height < SMALLEST.1
}

/// The parts of the screen that are the open page's.
pub fn page_area(app: &App, area: Rect) -> PageArea {
    PageArea::new(area, tabs::rest(app, Rect { height: 1, ..area }))
}

/// Draws a page with its status line, or what it asks; gives the first row of that.
fn draw_page(page: &dyn Page, area: &PageArea, ui: &mut Ui) -> u16 {
    let status = page.draw(area, ui);
    match page.asked(ui.caps) {
        Some(asked) => draw_question(&asked.words, asked.typed, area.status, ui),
        None => draw_status(&status, area.status, ui),
    }
}

/// Draws the screen that `app` is at.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let ui = &mut Ui { theme: &app.theme(), caps: app.caps, keys: app.keys(), buffer };
    ui.buffer.set_style(area, ui.theme.text());
    if is_too_small(area) {
        too_small::draw(area, ui);
        return;
    }
    let parts = page_area(app, area);
    draw_tabs(app, Rect { height: 1, ..area }, ui);
    draw_hints(app, Rect { y: area.bottom() - 1, height: 1, ..area }, ui);
    // Whatever is to be read or answered begins there; toasts stay above it.
    let mut foot = match app.overlay {
        Some((overlay, top)) => help::draw(app, overlay, top, &parts, ui),
        None => draw_page(app.page(), &parts, ui),
    };
    if let Some(command_palette) = &app.command_palette {
        foot = command_palette::draw(app, command_palette, area, ui);
    }
    // The page of messages begins with what would be told over it.
    let is_told = |toast: &&Toast| !toast.is_kept || app.overlay != Some((Overlay::Messages, 0));
    // The first row is the header's.
    let room = Rect::new(area.x, area.y + 1, area.width, foot.saturating_sub(area.y + 1));
    draw_toasts(app.toasts.shown.iter().filter(is_told), room, ui);
}
