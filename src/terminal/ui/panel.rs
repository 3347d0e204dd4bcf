//! What panels have in common: a title on a rule, a frame, and words where there is nothing to show.

use ratatui::{
    layout::Rect,
    symbols::border,
    text::{Line, Span},
    widgets::Block,
};

use crate::terminal::{capabilities::Capabilities, ui::Ui};

/// Draws a panel's first row, a rule with its title, and gives the rest of the panel.
pub fn draw_title(title: &Line, area: Rect, ui: &mut Ui) -> Rect {
    if area.is_empty() {
        return area;
    }
    let rule = ui.caps.pick("─", "-").repeat(usize::from(area.width));
    ui.buffer.set_stringn(area.x, area.y, rule, usize::from(area.width), ui.theme.rule());
    if !title.spans.is_empty() {
        let mut spans = vec![Span::styled(" ", ui.theme.text())];
        spans.extend(title.spans.iter().cloned());
        spans.push(Span::styled(" ", ui.theme.text()));
        ui.buffer.set_line(area.x + 1, area.y, &Line::from(spans), area.width.saturating_sub(1));
    }
    Rect { y: area.y + 1, height: area.height - 1, ..area }
}

/// The frame where there are only plain characters.
const ASCII_FRAME: border::Set = border::Set {
    top_left: "+",
    top_right: "+",
    bottom_left: "+",
    bottom_right: "+",
    vertical_left: "|",
    vertical_right: "|",
    horizontal_top: "-",
    horizontal_bottom: "-",
};

/// `block` with a frame of characters that the terminal has.
pub fn frame(block: Block, caps: Capabilities) -> Block {
    if caps.unicode { block } else { block.border_set(ASCII_FRAME) }
}

/// Says in a panel why it is empty: after a blank row, a line a row.
pub fn draw_nothing(lines: &[&str], inner: Rect, ui: &mut Ui) {
    for (text, row) in lines.iter().zip(inner.y + 1..inner.bottom()) {
        ui.buffer.set_stringn(inner.x + 1, row, text, usize::from(inner.width.saturating_sub(1)), ui.theme.faint());
    }
}
