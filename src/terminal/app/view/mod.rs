//! The whole screen: the open page between the tabs and the key hints, and the overlays on top.

mod command_palette;
mod glossary;
mod help;
mod hints;
mod tabs;
mod toasts;
mod too_small;

use ratatui::{
    buffer::Buffer,
    layout::{Position, Rect},
};

use self::{hints::draw_hints, tabs::draw_tabs, toasts::draw_toasts};
use crate::terminal::{
    App, KeyContext, Overlay, PageId, Toast,
    pages::{Page, PageArea, Target},
    ui::{Ui, draw_question, draw_status},
};

pub use self::help::end as overlay_end;

/// Smallest screen, columns and rows, with room for the table and its panels.
pub const MIN_SIZE: (u16, u16) = (80, 24);

/// Whether the screen is too small for every page.
pub const fn is_too_small(area: Rect) -> bool {
    area.width < MIN_SIZE.0 || area.height < MIN_SIZE.1
}

/// The areas of the screen that belong to the open page.
pub fn page_area(app: &App, area: Rect) -> PageArea {
    PageArea::new(area, tabs::rest(app, Rect { height: 1, ..area }))
}

/// Draws a page with its status line or its question. Returns the first row of that line.
fn draw_page(page: &dyn Page, area: &PageArea, ui: &mut Ui) -> u16 {
    let status = page.draw(area, ui);
    match page.open_question(ui.caps) {
        Some(asked) => draw_question(&asked.prompt, asked.field, area.status, ui),
        None => draw_status(&status, area.status, ui),
    }
}

/// Draws the screen of `app`.
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
    // First row of what the user has to read or answer; toasts stay above it.
    let mut foot = match app.overlay {
        Some((overlay, top)) => help::draw(app, overlay, top, &parts, ui),
        None => draw_page(app.page(), &parts, ui),
    };
    if let Some(command_palette) = &app.command_palette {
        foot = command_palette::draw(app, command_palette, area, ui);
    }
    // The list of messages starts with the kept toasts, so they are not drawn over it as well.
    let is_drawn = |toast: &&Toast| !toast.is_listed || app.overlay != Some((Overlay::Messages, 0));
    // The first row belongs to the header.
    let room = Rect::new(area.x, area.y + 1, area.width, foot.saturating_sub(area.y + 1));
    draw_toasts(app.toasts.shown.iter().filter(is_drawn), room, ui);
}

/// Something on the screen that reacts to the mouse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pointed {
    /// The tab of a screen.
    Tab(PageId),
    /// Something on the open page.
    Page(Target),
}

/// Finds the target at a cell of the screen in `area`, assuming that no overlay is open.
pub fn pointed_at(app: &App, area: Rect, at: Position) -> Option<Pointed> {
    if is_too_small(area) {
        return None;
    }
    let header = Rect { height: 1, ..area };
    if let Some((screen, ..)) = tabs::tabs(app, header).into_iter().find(|(_, place, _)| place.contains(at)) {
        return Some(Pointed::Tab(screen));
    }
    let is_question = matches!(app.key_context(), KeyContext::Question { .. });
    let target = (!is_question).then(|| app.page().target(&page_area(app, area), at));
    target.flatten().map(Pointed::Page)
}
