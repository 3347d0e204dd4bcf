//! Widgets that pages and panels share: headers, titles, frames, paragraphs, and texts for empty panels.

use ratatui::{
    layout::{
        Constraint::{Fill, Length},
        Layout, Rect,
    },
    style::Style,
    symbols::border,
    text::{Line, Span},
    widgets::Block,
};

use crate::terminal::{
    Capabilities,
    ui::{Theme, Ui, columns, shorten, truncate_lines, wrap, write_right},
};

/// Draws the first row of a page, to the right of the tabs: its title, details, and a text at the right end. If there is no room, the last
/// parts of `more` are dropped first.
pub fn draw_header(title: &str, more: &str, right: &Span, area: Rect, ui: &mut Ui) {
    let taken = if right.content.is_empty() { 0 } else { right.width() + 2 };
    let room = usize::from(area.width).saturating_sub(taken);
    let title = shorten(title, room.saturating_sub(1), ui.caps);
    let mut line = Line::from(Span::styled(format!(" {title}"), ui.theme.text()));
    let parts = std::iter::successors(Some(more), |more| more.rsplit_once(separator(ui.caps)).map(|(parts, _)| parts));
    let more = parts.map(|parts| format!("  {parts}")).find(|more| line.width() + columns(more) <= room);
    line.push_span(Span::styled(more.unwrap_or_default(), ui.theme.faint()));
    ui.buffer.set_line(area.x, area.y, &line, room as u16);
    write_right(ui.buffer, area.x, area.right(), area.y, &right.content, right.style);
}

/// The separator between two parts of a header.
pub const fn separator(caps: Capabilities) -> &'static str {
    caps.pick(" · ", " - ")
}

/// A value that keys step through, between arrows if it `is_marked`.
pub fn stepper<'a>(value: Span<'a>, is_marked: bool, ui: &Ui) -> [Span<'a>; 3] {
    let (left, right) = if is_marked { ui.caps.pick(("◂ ", " ▸"), ("< ", " >")) } else { ("  ", "") };
    [Span::styled(left, ui.theme.faint()), value, Span::styled(right, ui.theme.faint())]
}

/// Draws a panel's first row, a rule with its title, and returns the rest of the panel.
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
    below_title(area)
}

/// The part of a panel below its title.
pub const fn below_title(area: Rect) -> Rect {
    Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area }
}

/// Splits `area` into its left `width` columns and the rest, with a blank column between them.
pub fn split(width: u16, area: Rect) -> [Rect; 2] {
    Layout::horizontal([Length(width), Fill(1)]).spacing(1).areas(area)
}

/// Border characters for ASCII terminals.
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

/// Gives `block` border characters that the terminal has.
pub fn frame(block: Block, caps: Capabilities) -> Block {
    if caps.unicode { block } else { block.border_set(ASCII_FRAME) }
}

/// Writes paragraphs from the top of `area`, each in its style, wrapped to the width. A paragraph without enough room ends with an
/// ellipsis. Returns the first free row.
pub fn write_paragraphs(paragraphs: &[(String, Style)], area: Rect, ui: &mut Ui) -> u16 {
    let width = usize::from(area.width);
    let mut row = area.y;
    for (text, style) in paragraphs {
        let room = usize::from(area.bottom() - row);
        if room == 0 {
            break;
        }
        for line in truncate_lines(wrap(text, width), room, width, ui.caps) {
            ui.buffer.set_stringn(area.x, row, line, width, *style);
            row += 1;
        }
    }
    row
}

/// Writes in a panel why it is empty: one line per row, after a blank row.
pub fn draw_placeholder(lines: &[&str], inner: Rect, ui: &mut Ui) {
    for (text, row) in lines.iter().zip(inner.y + 1..inner.bottom()) {
        ui.buffer.set_stringn(inner.x + 1, row, text, usize::from(inner.width.saturating_sub(1)), ui.theme.faint());
    }
}

/// Draws lines from the top of `area`, as many as there are rows.
pub fn draw_lines<'a>(lines: impl IntoIterator<Item = Line<'a>>, area: Rect, ui: &mut Ui) {
    for (line, row) in lines.into_iter().zip(area.y..area.bottom()) {
        ui.buffer.set_line(area.x, row, &line, area.width);
    }
}

/// A line with a name, padded to `columns` columns, and its value.
pub fn pair(name: &str, columns: usize, value: impl Into<String>, theme: &Theme) -> Line<'static> {
    Line::from(vec![Span::styled(format!("{name:<columns$}"), theme.faint()), Span::styled(value.into(), theme.text())])
}
