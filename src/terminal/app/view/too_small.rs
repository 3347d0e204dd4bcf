//! The page for a terminal that has no room for the screens: which size it has and which it needs.

use ratatui::{
    layout::Rect,
    text::Line,
    widgets::{Paragraph, Widget, Wrap},
};

use super::SMALLEST;

use crate::terminal::ui::Ui;

/// Draws the page; it still says as much as fits where there is hardly any room.
pub fn draw(area: Rect, ui: &mut Ui) {
    let (width, height) = SMALLEST;
    let times = ui.caps.pick("×", "x");
    // Both sizes come first: the end may have no room.
    let sizes = format!("{width}{times}{height} needed, {}{times}{} here", area.width, area.height);
    let lines = vec![
        Line::styled(sizes, ui.theme.warning()),
        Line::styled("This screen needs more room.", ui.theme.text()),
        Line::styled("Make it larger, or press q to quit.", ui.theme.faint()),
    ];
    let rows = (lines.len() as u16).min(area.height);
    let top = area.y + (area.height - rows) / 2;
    let left = area.x + area.width.saturating_sub(36) / 2;
    let place = Rect::new(left, top, area.right() - left, area.bottom() - top);
    Paragraph::new(lines).style(ui.theme.text()).wrap(Wrap { trim: true }).render(place, ui.buffer);
}
