//! The drill screens: the library, the exercise that is practised, the result of an exam, and the records.

mod exercise;
mod film;
pub mod films;
pub mod library;
mod panels;
mod panes;
mod record;
mod result;
mod score;

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Style,
    text::{Line, Span},
};

use crate::terminal::{
    app::App,
    drills::Page,
    look::Look,
    status::Message,
    widgets::{cut, draw_hints, draw_question, draw_status, draw_tabs, wrap, write_right},
    words::{self, skill_word},
};

/// Most columns of a line that is good to read.
const READABLE: u16 = 80;

/// Draws the page that is open; gives the first row of what stands below it.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> u16 {
    let drills = app.drills();
    let row = |y: u16| Rect::new(area.x, y, area.width, 1);
    let page = Rect::new(area.x, area.y + 1, area.width, area.height.saturating_sub(3));
    let standing = match (drills.page(), &drills.turn) {
        (Page::Exercise, Some(turn)) => exercise::draw(app, turn, row(area.y), page, buffer),
        (Page::Result, Some(turn)) => result::draw(app, turn, row(area.y), page, buffer),
        (Page::Record, _) => record::draw(app, row(area.y), page, buffer),
        (Page::Films, _) => films::draw(app, row(area.y), page, buffer),
        (Page::Film, _) => film::draw(app, row(area.y), page, buffer),
        _ => library::draw(app, row(area.y), page, buffer),
    };
    let (theme, look, status) = (app.theme(), app.look(), row(page.bottom()));
    let message = app.message().cloned();
    draw_hints(app, row(page.bottom() + 1), buffer);
    match &drills.question {
        Some(question) => {
            let before = message.map_or(String::new(), |message| format!("{}. ", message.text));
            draw_question(&Message::plain(before + &question.text()), status, theme, look, buffer)
        }
        None => draw_status(&message.unwrap_or(standing), status, theme, look, buffer),
    }
}

/// The first row of a page behind the tabs: what it is, more about that, and who plays.
fn draw_header(app: &App, title: &str, more: &str, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let area = draw_tabs(app, area, buffer);
    let player = format!("player: {} ", skill_word(app.drills().skill()));
    let room = usize::from(area.width).saturating_sub(player.chars().count() + 2);
    let title = cut(wrap(title, room.saturating_sub(1)), 1, room.saturating_sub(1), look).swap_remove(0);
    let mut line = Line::from(Span::styled(format!(" {title}"), theme.text()));
    let more = Span::styled(format!("  {more}"), theme.faint());
    if line.width() + more.width() <= room {
        line.push_span(more);
    }
    buffer.set_line(area.x, area.y, &line, room as u16);
    write_right(buffer, area.x, area.right(), area.y, &player, theme.text());
}

/// Writes lines of text from the top of `area`, wrapped to its width, each paragraph in its style; one that has no room says
/// so by its end. Gives the first row that is left.
fn write_paragraphs(paragraphs: &[(String, Style)], area: Rect, look: Look, buffer: &mut Buffer) -> u16 {
    let width = usize::from(area.width);
    let mut row = area.y;
    for (text, style) in paragraphs {
        let room = usize::from(area.bottom() - row);
        if room == 0 {
            break;
        }
        for line in cut(wrap(text, width), room, width, look) {
            buffer.set_stringn(area.x, row, line, width, *style);
            row += 1;
        }
    }
    row
}

/// A share as people say it, like `55 %`.
fn percent(share: f64) -> String {
    format!("{} %", words::percent(share))
}
