//! The status line above the key hints: the latest message, or a question.

use ratatui::{
    layout::Rect,
    widgets::{Clear, Widget},
};

use crate::terminal::ui::{Message, TextField, Tone, Ui, columns, truncate_lines, wrap};

/// Most rows of a message on the status line, and of a question with the reason why an answer was refused.
const STATUS_ROWS: u16 = 3;
const QUESTION_ROWS: u16 = 8;
/// Smallest width of an answer field, columns; if the question leaves less room, the field gets its own row.
const FIELD: u16 = 20;

/// Draws a message into the row `area`; a longer one also takes rows above it. Returns the first of its rows.
pub fn draw_status(message: &Message, area: Rect, ui: &mut Ui) -> u16 {
    draw_rows(message, None, STATUS_ROWS, area, ui)
}

/// Draws a question like a message, followed by the answer field. Its end stays visible even if the question is long.
pub fn draw_question(question: &Message, typed: Option<&TextField>, area: Rect, ui: &mut Ui) -> u16 {
    draw_rows(question, typed, QUESTION_ROWS, area, ui)
}

fn draw_rows(message: &Message, typed: Option<&TextField>, most: u16, area: Rect, ui: &mut Ui) -> u16 {
    let style = match message.tone {
        Tone::Plain => ui.theme.text(),
        Tone::Good => ui.theme.good(),
        Tone::Poor | Tone::Warning => ui.theme.warning(),
    };
    let width = area.width.saturating_sub(2);
    let most = most.min(area.bottom());
    let mut lines =
        truncate_lines(wrap(&message.text, usize::from(width)), usize::from(most), usize::from(width), ui.caps);
    let end = lines.last().map_or(0, |last| columns(last) as u16 + 1);
    let start = if end + FIELD <= width { end } else { 0 };
    if typed.is_some() && start == 0 {
        lines.push(String::new());
    }
    let rows = lines.len() as u16;
    let place = Rect::new(area.x, area.bottom() - rows, area.width, rows);
    Clear.render(place, ui.buffer);
    ui.buffer.set_style(place, ui.theme.text());
    for (line, row) in lines.iter().zip(place.y..place.bottom()) {
        ui.buffer.set_stringn(place.x + 1, row, line, usize::from(width), style);
    }
    if let Some(typed) = typed {
        typed.draw(Rect::new(place.x + 1 + start, area.bottom() - 1, width - start, 1), ui);
    }
    place.y
}
