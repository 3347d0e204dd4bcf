//! Mouse targets on the screen.

use ratatui::layout::{Position, Rect};

use super::{is_too_small, page_area, tabs::tabs};
use crate::terminal::{App, KeyContext, PageId, pages::Target};

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
    if let Some((screen, ..)) = tabs(app, header).into_iter().find(|(_, place, _)| place.contains(at)) {
        return Some(Pointed::Tab(screen));
    }
    let is_question = matches!(app.key_context(), KeyContext::Question { .. });
    let target = (!is_question).then(|| app.page().target(&page_area(app, area), at));
    target.flatten().map(Pointed::Page)
}
