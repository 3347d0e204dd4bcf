//! The page for a terminal that is too small: its present size and the size required.

use ratatui::{
    layout::Rect,
    text::Line,
    widgets::{Paragraph, Widget, Wrap},
};

use super::MIN_SIZE;

use crate::terminal::ui::Ui;

/// Largest width of a line, columns.
const WIDTH: u16 = 46;

/// Draws the page, as much of it as fits even in a tiny window.
pub fn draw(area: Rect, ui: &mut Ui) {
    let (width, height) = MIN_SIZE;
    let times = ui.caps.pick("×", "x");
    // Both sizes come first, since the end may be cut off. Ctrl-C quits even if the user has bound it to something else.
    let sizes =
        format!("The window is {}{times}{}; at least {width}{times}{height} is needed.", area.width, area.height);
    let lines = vec![Line::styled(sizes, ui.theme.warning()), Line::styled("Ctrl-C quits.", ui.theme.faint())];
    // The sentence wraps to two rows if one is too narrow.
    let rows = 3.min(area.height);
    let top = area.y + (area.height - rows) / 2;
    let left = area.x + area.width.saturating_sub(WIDTH) / 2;
    let place = Rect::new(left, top, WIDTH.min(area.right() - left), area.bottom() - top);
    Paragraph::new(lines).style(ui.theme.text()).wrap(Wrap { trim: true }).render(place, ui.buffer);
}
