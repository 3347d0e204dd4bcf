//! What panels have in common: a title on a rule, a frame, paragraphs, and words where there is nothing to show.

use ratatui::{
    layout::Rect,
    style::Style,
    symbols::border,
    text::{Line, Span},
    widgets::Block,
};

use crate::terminal::{
    Capabilities,
    ui::{Theme, Ui, cut, wrap},
};

/// Draws a panel's first row, a rule with its title, and gives the rest of the panel.
pub fn draw_title<'a>(title: impl Into<Line<'a>>, area: Rect, ui: &mut Ui) -> Rect {
    if area.is_empty() {
        return area;
    }
    let rule = ui.caps.pick("─", "-").repeat(usize::from(area.width));
    ui.buffer.set_string(area.x, area.y, rule, ui.theme.rule());
    let mut title = title.into();
    if !title.spans.is_empty() {
        title.spans.insert(0, " ".into());
        title.push_span(" ");
        ui.buffer.set_line(area.x + 1, area.y, &title.style(ui.theme.text()), area.width.saturating_sub(1));
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

/// Writes lines of text from the top of `area`, wrapped to its width, each paragraph in its style; one that has no room says
/// so by its end. Gives the first row that is left.
pub fn write_paragraphs(paragraphs: &[(String, Style)], area: Rect, ui: &mut Ui) -> u16 {
    let width = usize::from(area.width);
    let mut row = area.y;
    for (text, style) in paragraphs {
        let room = usize::from(area.bottom() - row);
        if room == 0 {
            break;
        }
        for line in cut(wrap(text, width), room, width, ui.caps) {
            ui.buffer.set_stringn(area.x, row, line, width, *style);
            row += 1;
        }
    }
    row
}

/// Says in a panel why it is empty: after a blank row, a line a row.
pub fn draw_nothing(lines: &[&str], inner: Rect, ui: &mut Ui) {
    for (text, row) in lines.iter().zip(inner.y + 1..inner.bottom()) {
        ui.buffer.set_stringn(inner.x + 1, row, text, usize::from(inner.width.saturating_sub(1)), ui.theme.faint());
    }
}

/// Draws lines from the top of `area`, as many as it has rows.
pub fn draw_lines<'a>(lines: impl IntoIterator<Item = Line<'a>>, area: Rect, ui: &mut Ui) {
    for (line, row) in lines.into_iter().zip(area.y..area.bottom()) {
        ui.buffer.set_line(area.x, row, &line, area.width);
    }
}

/// A name in so many columns, and what it has.
pub fn pair(name: &str, columns: usize, value: impl Into<String>, theme: &Theme) -> Line<'static> {
    Line::from(vec![Span::styled(format!("{name:<columns$}"), theme.faint()), Span::styled(value.into(), theme.text())])
}
