//! The tabs at the beginning of the first row: the screens that there are, the open one reversed.

use ratatui::{layout::Rect, style::Modifier, text::Span};

use crate::terminal::{App, PageId, app::bindings::chord_of_tab, keymap::keys_text, ui::Ui};

/// Columns of the screen from which on neighbours do not share a blank, so that the open tab has its own on either side, and
/// from which on each tab has its key.
const LOOSE: u16 = 100;
const WIDE: u16 = 120;
/// Columns from which on the calibration has its tab although it is not open: it is not needed every day.
const ROOMY: u16 = 140;
/// The program's name, where there are no tabs.
const NAME: &str = " carom ";

/// Where each tab stands in the row `area`, with its key where there is room, and its title.
pub fn tabs(app: &App, area: Rect) -> Vec<(PageId, Rect, String)> {
    if app.stands_alone() {
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
        // A blank that is the neighbour's too stays as it is: the neighbour's name would touch the open tab.
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

/// What the tabs leave of the row `area`.
pub fn rest(app: &App, area: Rect) -> Rect {
    let last = tabs(app, area).into_iter().next_back();
    let end = last.map_or(area.x + NAME.len() as u16, |(_, place, _)| place.right()).min(area.right());
    Rect { x: end, width: area.right() - end, ..area }
}
