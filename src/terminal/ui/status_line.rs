//! The row above the keys: what has just happened, or a question.

use ratatui::{
    layout::Rect,
    widgets::{Clear, Widget},
};

use crate::terminal::ui::{
    Ui,
    message::{Message, Tone},
    text::{cut, wrap},
};

/// Most rows that a long sentence on the status line may take, and a question with what was answered wrongly.
const STATUS_ROWS: u16 = 3;
const QUESTION_ROWS: u16 = 8;

/// Draws a sentence into the row `area`; one that is longer takes some rows above it as well.
/// Gives the first of them.
pub fn draw_status(message: &Message, area: Rect, ui: &mut Ui) -> u16 {
    draw_rows(message, STATUS_ROWS, area, ui)
}

/// Draws a question like a sentence; its end, which is answered, is to be seen however long it is.
pub fn draw_question(question: &Message, area: Rect, ui: &mut Ui) -> u16 {
    draw_rows(question, QUESTION_ROWS, area, ui)
}

fn draw_rows(message: &Message, most: u16, area: Rect, ui: &mut Ui) -> u16 {
    let style = match message.tone {
        Tone::Plain => ui.theme.text(),
        Tone::Good => ui.theme.good(),
        Tone::Poor | Tone::Warning => ui.theme.warning(),
    };
    let width = area.width.saturating_sub(2);
    let most = most.min(area.bottom());
    let lines = cut(wrap(&message.text, usize::from(width)), usize::from(most), usize::from(width), ui.caps);
    let rows = lines.len() as u16;
    let place = Rect::new(area.x, area.bottom() - rows, area.width, rows);
    Clear.render(place, ui.buffer);
    ui.buffer.set_style(place, ui.theme.text());
    for (line, row) in lines.iter().zip(place.y..place.bottom()) {
        ui.buffer.set_stringn(place.x + 1, row, line, usize::from(width), style);
    }
    place.y
}
