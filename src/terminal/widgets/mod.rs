//! The parts of the screens.

mod balls;
mod chances;
mod events;
mod field;
mod footer;
mod header;
mod maps;
mod margins;
mod plan;
mod rails;
mod shot;
mod sight;
mod spin;
mod table;
mod tabs;
mod tip;
mod toasts;

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Style,
    symbols::border,
    text::{Line, Span},
    widgets::Block,
};

use super::{look::Look, theme::Theme};

pub use balls::draw_balls;
pub use chances::{choice_at, draw_chances, sort_words};
pub use events::draw_events;
pub use footer::{cut, draw_hints, draw_question, draw_status, wrap};
pub use header::draw_header;
pub use maps::{draw_aim_map, draw_legend, draw_tip_map};
pub use margins::draw_margins;
pub use plan::{draw_plan, plan_spots};
pub use shot::{draw_proposal, draw_shot};
pub use sight::draw_sight;
pub use spin::draw_spin;
pub use table::{Spot, TableView, ball_at, draw_table};
pub use tabs::{draw_tabs, tabs};
pub use tip::draw_tip;
pub use toasts::draw_toasts;

/// Draws a panel's first row, a rule with its title, and gives the rest of the panel.
pub fn draw_title(title: &Line, area: Rect, theme: &Theme, look: Look, buffer: &mut Buffer) -> Rect {
    if area.is_empty() {
        return area;
    }
    let rule = look.pick("─", "-").repeat(usize::from(area.width));
    buffer.set_stringn(area.x, area.y, rule, usize::from(area.width), theme.rule());
    if !title.spans.is_empty() {
        let mut spans = vec![Span::styled(" ", theme.text())];
        spans.extend(title.spans.iter().cloned());
        spans.push(Span::styled(" ", theme.text()));
        buffer.set_line(area.x + 1, area.y, &Line::from(spans), area.width.saturating_sub(1));
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
pub fn frame(block: Block, look: Look) -> Block {
    if look.unicode { block } else { block.border_set(ASCII_FRAME) }
}

/// The end of `text`, as much as fits into `room` columns: the ends of names differ where their beginnings do not.
pub fn end_of(text: &str, room: usize, look: Look) -> String {
    let count = text.chars().count();
    if count <= room {
        return text.to_owned();
    }
    let more = look.pick("…", "...");
    let kept = room.saturating_sub(more.chars().count());
    format!("{more}{}", text.chars().skip(count - kept).collect::<String>()).chars().take(room).collect()
}

/// Says in a panel why it is empty: after a blank row, a line a row.
pub fn draw_nothing(lines: &[&str], inner: Rect, theme: &Theme, buffer: &mut Buffer) {
    for (text, row) in lines.iter().zip(inner.y + 1..inner.bottom()) {
        buffer.set_stringn(inner.x + 1, row, text, usize::from(inner.width.saturating_sub(1)), theme.faint());
    }
}

/// Writes `text` so that it ends before column `end`, but never left of `start`.
pub fn write_right(buffer: &mut Buffer, start: u16, end: u16, row: u16, text: &str, style: Style) {
    let width = Span::raw(text).width() as u16;
    let x = end.saturating_sub(width).max(start);
    buffer.set_stringn(x, row, text, usize::from(end.saturating_sub(x)), style);
}
