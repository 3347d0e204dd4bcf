//! The tabs at the start of the first row: the available screens, with the open one in reverse video.

use ratatui::{layout::Rect, style::Modifier, text::Span};

use crate::terminal::{App, PageId, app::bindings::chord_of_tab, keymap::keys_text, ui::Ui};

/// Screen width, columns, from which tabs no longer share a blank with their neighbours, and from which each tab shows its key.
const LOOSE: u16 = 100;
const WIDE: u16 = 120;
/// Screen width from which the calibration has a tab even if it is not open: it is seldom needed.
const ROOMY: u16 = 140;
/// The program's name, shown if there are no tabs.
const NAME: &str = " carom ";

/// Each tab with its area in the row `area` and its key, if there is room for it.
pub fn tabs(app: &App, area: Rect) -> Vec<(PageId, Rect, String)> {
    if app.is_only_screen() {
        return Vec::new();
    }
    let mut x = area.x;
    let mut tabs = Vec::new();
    let has_tab = |screen: &PageId| *screen != PageId::Calibration || app.screen == *screen || area.width >= ROOMY;
    for screen in PageId::ALL.into_iter().filter(has_tab) {
        let key = chord_of_tab(screen).filter(|_| area.width >= WIDE);
        let key = keys_text(key.into_iter().flat_map(|chord| app.keys().keys_for(chord).take(1)), app.caps);
        let gap = u16::from(!key.is_empty());
        let width = (Span::raw(&key).width() + Span::raw(screen.title()).width()) as u16 + gap + 2;
        let place = Rect::new(x, area.y, width.min(area.right().saturating_sub(x)), 1);
        tabs.push((screen, place, key));
        x += width - u16::from(area.width < LOOSE);
    }
    tabs
}

/// Draws the tabs.
pub fn draw_tabs(app: &App, area: Rect, ui: &mut Ui) {
    let tabs = tabs(app, area);
    let open = ui.theme.accent().add_modifier(Modifier::REVERSED);
    if tabs.is_empty() {
        ui.buffer.set_stringn(area.x, area.y, NAME, usize::from(area.width), open);
    }
    for (screen, place, key) in tabs {
        let is_open = screen == app.screen;
        let (faint, text) = if is_open { (open, open) } else { (ui.theme.faint(), ui.theme.text()) };
        // A blank shared with a neighbour keeps its style: otherwise the neighbour's name would touch the open tab.
        if is_open && area.width >= LOOSE {
            ui.buffer.set_string(place.x, place.y, " ".repeat(usize::from(place.width)), text);
        }
        let mut x = place.x + 1;
        if !key.is_empty() {
            x = ui.buffer.set_stringn(x, place.y, key, usize::from(place.width), faint).0 + 1;
        }
        ui.buffer.set_stringn(x, place.y, screen.title(), usize::from(place.width), text);
    }
}

/// The part of the row `area` that the tabs leave free.
pub fn rest(app: &App, area: Rect) -> Rect {
    let last = tabs(app, area).into_iter().next_back();
    let end = last.map_or(area.x + NAME.len() as u16, |(_, place, _)| place.right()).min(area.right());
    Rect { x: end, width: area.right() - end, ..area }
}
