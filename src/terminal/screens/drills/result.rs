//! The result of an exam: every exercise with what came of it, and what the score is worth.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use super::{draw_header, percent, write_paragraphs};
use crate::{
    drills::exam,
    terminal::{
        app::App,
        drills::Turn,
        status::Message,
        widgets::{cut, draw_title, wrap, write_right},
    },
};

/// Columns of the score beside the list, at least.
const SCORE: u16 = 34;

/// Draws the page; gives what the status line says while there is no news.
pub fn draw(app: &App, turn: &Turn, header: Rect, area: Rect, buffer: &mut Buffer) -> Message {
    let (theme, look, session) = (app.theme(), app.look(), &turn.session);
    draw_header(app, "exam", "", header, buffer);
    let score = SCORE.max(area.width * 2 / 5);
    let list = Rect { width: area.width - score - 1, ..area };
    let inner = draw_title(&Line::from(Span::styled("Exercises", theme.text())), list, theme, look, buffer);
    let signs = look.pick(["●", "○"], ["x", "o"]);
    for (n, (attempt, y)) in session.attempts.iter().zip(inner.y..inner.bottom()).enumerate() {
        let Some(exercise) = session.exercise_of(attempt) else { continue };
        let (sign, style) = if attempt.made { (signs[0], theme.good()) } else { (signs[1], theme.warning()) };
        write_right(buffer, inner.x, inner.x + 3, y, &(n + 1).to_string(), theme.faint());
        buffer.set_string(inner.x + 4, y, sign, style);
        let chance = attempt.chance.map_or(String::new(), percent);
        let room = usize::from(inner.width.saturating_sub(6 + 7));
        let title = cut(wrap(&exercise.title, room), 1, room, look).swap_remove(0);
        buffer.set_stringn(inner.x + 6, y, title, room, theme.text());
        write_right(buffer, inner.x, inner.right(), y, &chance, theme.faint());
    }
    let end = list.right();
    write_right(buffer, list.x, end + 1, list.y, " your stroke makes ", theme.faint());
    let score = Rect { x: end + 1, width: score, ..area };
    let inner = draw_title(&Line::from(Span::styled("Score", theme.text())), score, theme, look, buffer);
    let text = Rect { x: inner.x + 1, y: inner.y + 1, width: inner.width - 2, height: inner.height.saturating_sub(1) };
    let Some(mark) = exam::mark(session) else { return Message::plain("nothing was played") };
    let expected = |name: &str, points: f64| format!("{name:<10}{points:>5.1} of {}", mark.tried);
    let paragraphs = [
        (format!("{} of {} made", mark.made, mark.tried), theme.accent()),
        (String::new(), theme.text()),
        ("Who plays the shots that are taught makes, on average in the same exam:".to_owned(), theme.text()),
    ];
    let top = write_paragraphs(&paragraphs, text, look, buffer) + 1;
    let players =
        [("beginner", mark.expected.beginner), ("club", mark.expected.club), ("expert", mark.expected.expert)];
    for ((name, points), y) in players.into_iter().zip(top..text.bottom()) {
        let style = if name == mark.nearest { theme.good() } else { theme.text() };
        buffer.set_stringn(text.x, y, expected(name, points), usize::from(text.width), style);
    }
    let rest = Rect { y: (top + 4).min(text.bottom()), height: text.bottom().saturating_sub(top + 4), ..text };
    let helped = session.record().helped;
    let mut paragraphs = vec![(format!("Grade: {}", mark.nearest), theme.good())];
    if helped > 0 {
        paragraphs.push((format!("{helped} with a hint"), theme.faint()));
    }
    write_paragraphs(&paragraphs, rest, look, buffer);
    Message::good(format!("the exam is over: {} of {}, nearest to the {} player", mark.made, mark.tried, mark.nearest))
}
