//! The training screen: the list of runs, the form for a new one, and a run as it learns.

mod charts;
mod form;
mod header;
mod numbers;
mod panes;
mod replay;
pub mod runs;
mod watch;

use ratatui::{buffer::Buffer, layout::Rect};

use crate::terminal::{
    app::App,
    status::Message,
    training::Page,
    widgets::{draw_hints, draw_question, draw_status, draw_tabs},
};

/// Draws the page that is open; gives the first row of what stands below it.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> u16 {
    let training = app.training();
    let row = |y: u16| Rect::new(area.x, y, area.width, 1);
    let page = Rect::new(area.x, area.y + 1, area.width, area.height.saturating_sub(3));
    let standing = match (training.page(), &training.watch) {
        (Page::Watch, Some(watch)) => {
            header::draw(app, watch, row(area.y), buffer);
            watch::draw(app, watch, page, buffer);
            let (sentence, is_bad) = watch.advice();
            if is_bad { Message::warning(sentence) } else { Message::plain(sentence) }
        }
        (Page::Form, _) => {
            title(app, "a new run", row(area.y), buffer);
            form::draw(app, page, buffer);
            Message::plain(form::standing(app))
        }
        (open, _) => {
            let words = if open == Page::Compare { "compare with" } else { "training runs" };
            title(app, words, row(area.y), buffer);
            runs::draw(app, page, buffer);
            runs::standing(app)
        }
    };
    let message = app.message().cloned();
    let (theme, look, status) = (app.theme(), app.look(), row(page.bottom()));
    draw_hints(app, row(page.bottom() + 1), buffer);
    match (&training.question, &training.watch) {
        (Some(question), Some(watch)) => {
            let before = message.map_or(String::new(), |message| format!("{}. ", message.text));
            let question = Message::warning(before + &question.text(watch));
            draw_question(&question, status, theme, look, buffer)
        }
        _ => draw_status(&message.unwrap_or(standing), status, theme, look, buffer),
    }
}

/// The first row of the pages that show no run.
fn title(app: &App, words: &str, area: Rect, buffer: &mut Buffer) {
    let area = draw_tabs(app, area, buffer);
    buffer.set_stringn(area.x + 1, area.y, words, usize::from(area.width.saturating_sub(1)), app.theme().text());
}
