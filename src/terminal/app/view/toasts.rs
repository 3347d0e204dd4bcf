//! Draws toasts: boxes with refusals and failures at the lower right of the picture, the newest lowest.

use ratatui::{
    layout::Rect,
    text::Span,
    widgets::{Block, Clear, Widget},
};

use crate::terminal::{
    Toast,
    ui::{Ui, columns, frame, truncate_lines, wrap},
};

/// Largest width of a box: in columns, and in per cent of the screen's width.
const WIDTH: (u16, u16) = (64, 60);
/// Most lines of one toast; the list of messages shows all of it.
const LINES: usize = 6;

/// Draws the toasts, given oldest first, at the bottom of `area`: as many of the newest as fit into its lower half.
pub fn draw_toasts<'a>(toasts: impl DoubleEndedIterator<Item = &'a Toast>, area: Rect, ui: &mut Ui) {
    let most = WIDTH.0.min(area.width * WIDTH.1 / 100);
    let mut bottom = area.bottom();
    for toast in toasts.rev() {
        let room = usize::from(most.saturating_sub(4));
        let all = wrap(&toast.text, room);
        let is_cut = all.len() > LINES;
        let lines = truncate_lines(all, LINES, room, ui.caps);
        let width = lines.iter().map(|line| columns(line)).max().unwrap_or(0) as u16 + 4;
        let height = lines.len() as u16 + 2;
        if bottom < area.y + area.height / 2 + height && bottom < area.bottom() || bottom < area.y + height {
            break;
        }
        let place = Rect::new(area.right() - width, bottom - height, width, height);
        Clear.render(place, ui.buffer);
        ui.buffer.set_style(place, ui.theme.text());
        let mut block = frame(Block::bordered(), ui.caps).border_style(ui.theme.warning());
        if is_cut {
            block = block.title_bottom(Span::styled(" F6 shows all of it ", ui.theme.faint()));
        }
        block.render(place, ui.buffer);
        for (line, y) in lines.iter().zip(place.y + 1..) {
            ui.buffer.set_stringn(place.x + 2, y, line, room, ui.theme.text());
        }
        bottom = place.y;
    }
}
