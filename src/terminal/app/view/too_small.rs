//! The page for a terminal that has no room for the screens: which size it has and which it needs.

use ratatui::{
    layout::Rect,
    text::Line,
    widgets::{Paragraph, Widget, Wrap},
};

use super::SMALLEST;

use crate::terminal::ui::Ui;

/// Columns of a line of it at most.
const WIDTH: u16 = 46;

/// Draws the page; it still says as much as fits where there is hardly any room.
pub fn draw(area: Rect, ui: &mut Ui) {
    let (width, height) = SMALLEST;
    let times = ui.caps.pick("×", "x");
    // Both sizes come first: the end may have no room. Ctrl-C quits whatever work keys were given.
    let sizes =
        format!("The window is {}{times}{}; at least {width}{times}{height} is needed.", area.width, area.height);
    let lines = vec![Line::styled(sizes, ui.theme.warning()), Line::styled("Ctrl-C quits.", ui.theme.faint())];
    // The sentence takes two rows where one has no room.
    let rows = 3.min(area.height);
    let top = area.y + (area.height - rows) / 2;
    let left = area.x + area.width.saturating_sub(WIDTH) / 2;
    let place = Rect::new(left, top, WIDTH.min(area.right() - left), area.bottom() - top);
    Paragraph::new(lines).style(ui.theme.text()).wrap(Wrap { trim: true }).render(place, ui.buffer);
}
