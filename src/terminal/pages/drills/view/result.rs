//! The screen with the result of an exam: each exercise with its outcome, and the score with its grade.

use ratatui::layout::{Position, Rect};

use crate::{
    drills::{Category, exam},
    terminal::{
        pages::{
            Target,
            drills::{
                DrillsPage, ExamResult,
                view::{draw_header, percent_words},
            },
        },
        ui::{Message, Ui, below_title, draw_title, list, shorten, split, write_paragraphs, write_right},
    },
};

/// Minimum width of the score next to the list, columns.
const SCORE: u16 = 34;

/// The areas of the exercises and of the score.
fn halves(area: Rect) -> [Rect; 2] {
    split(area.width - SCORE.max(area.width * 2 / 5) - 1, area)
}

/// The mouse target at `at`.
pub fn target(drills: &DrillsPage, area: Rect, at: Position) -> Option<Target> {
    let ExamResult { session, mark } = drills.exam_result.as_ref()?;
    let [list, _] = halves(area);
    let line = list::line_at(*mark, session.attempts.len(), below_title(list), at.y);
    list.contains(at).then(|| Target::list(line, *mark))
}

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    let subject = drills.exam_result.as_ref().and_then(|result| exam::category(&result.session.exercises));
    draw_header(drills, "exam", subject.map_or("", Category::title), header, ui);
    let Some(ExamResult { session, mark }) = &drills.exam_result else { return Message::plain("nothing was played") };
    let [list, panel] = halves(area);
    let inner = draw_title("Exercises", list, ui);
    let signs = ui.caps.pick(["●", "○"], ["x", "o"]);
    for (n, y) in list::shown(*mark, session.attempts.len(), inner) {
        let attempt = &session.attempts[n];
        let Some(exercise) = session.exercise_of(attempt) else { continue };
        let (sign, style) = if attempt.made { (signs[0], ui.theme.good()) } else { (signs[1], ui.theme.warning()) };
        list::draw_mark(n == *mark, inner.x, y, ui);
        write_right(ui.buffer, inner.x + 1, inner.x + 4, y, &(n + 1).to_string(), ui.theme.faint());
        ui.buffer.set_string(inner.x + 5, y, sign, style);
        let chance = attempt.chance.map_or(String::new(), percent_words);
        let room = usize::from(inner.width.saturating_sub(7 + 7));
        let title = shorten(&exercise.title, room, ui.caps);
        let style = if n == *mark { ui.theme.accent() } else { ui.theme.text() };
        ui.buffer.set_stringn(inner.x + 7, y, title, room, style);
        write_right(ui.buffer, inner.x, inner.right(), y, &chance, ui.theme.faint());
    }
    write_right(ui.buffer, list.x, panel.x, list.y, " your stroke makes ", ui.theme.faint());
    let inner = draw_title("Score", panel, ui);
    let text = Rect { x: inner.x + 1, y: inner.y + 1, width: inner.width - 2, height: inner.height.saturating_sub(1) };
    let Some(score) = exam::score(session) else { return Message::plain("nothing was played") };
    let expected = |name: &str, points: f64| format!("{name:<12}{points:>5.1} of {}", score.tried);
    let paragraphs = [
        (format!("{} of {} made", score.made, score.tried), ui.theme.accent()),
        (String::new(), ui.theme.text()),
        ("With the model shots, on average, players make:".to_owned(), ui.theme.text()),
    ];
    let top = write_paragraphs(&paragraphs, text, ui) + 1;
    let players = [
        ("beginner", score.expected.beginner),
        ("club", score.expected.club),
        ("world-class", score.expected.world_class),
    ];
    for ((name, points), y) in players.into_iter().zip(top..text.bottom()) {
        let style = if name == score.nearest { ui.theme.good() } else { ui.theme.text() };
        ui.buffer.set_stringn(text.x, y, expected(name, points), usize::from(text.width), style);
    }
    let rest = Rect { y: (top + 4).min(text.bottom()), height: text.bottom().saturating_sub(top + 4), ..text };
    let helped = session.record().helped;
    let mut paragraphs = vec![(format!("Grade: {}", score.nearest), ui.theme.good())];
    if helped > 0 {
        paragraphs.push((format!("{helped} with a hint"), ui.theme.faint()));
    }
    write_paragraphs(&paragraphs, rest, ui);
    Message::good(format!(
        "the exam is over: {} of {}, nearest to the {} player; Enter practises the marked exercise",
        score.made, score.tried, score.nearest
    ))
}
