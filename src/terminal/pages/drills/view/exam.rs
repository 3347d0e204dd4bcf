//! The screen that describes an exam before it begins.

use ratatui::layout::Rect;

use crate::{
    drills::{Category, exam},
    terminal::{
        pages::drills::{
            DrillsPage, Turn,
            view::{READABLE, draw_header},
        },
        ui::{Message, Ui, draw_title, write_paragraphs},
        words::skill_word,
    },
};

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, turn: &Turn, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    let category = exam::category(&turn.session.exercises);
    draw_header(drills, "exam", category.map_or("", Category::title), header, ui);
    let level = drills.exam_level;
    let inner = draw_title(format!("An exam of level {level}"), area, ui);
    let text = Rect { x: inner.x + 2, y: inner.y + 1, width: READABLE.min(inner.width - 3), height: inner.height - 1 };
    let count = turn.session.exercises.len();
    let of =
        exam::grades(level).map_or(String::new(), |grades| format!(" of grade {} to {}", grades.start(), grades.end()));
    let player = skill_word(turn.session.skill);
    let paragraphs = [
        match category {
            None => format!("{count} exercises{of}, easy ones first, one attempt each."),
            Some(category) => format!(
                "{count} exercises{of} of the listed category, \"{}\", easy ones first, one attempt each. 0 in the library lists all \
                 categories for an exam of all.",
                category.title()
            ),
        },
        "Set the stroke and play it. There is no hint and no second try.".to_owned(),
        format!(
            "Strokes are played with the errors of the player who is named above: {player}. p in the library chooses another."
        ),
        "At the end you see which exercises you made, and what a beginner, a club player and a world-class player \
         make on average in the same exam."
            .to_owned(),
        "Esc leaves the exam; c on the coach's page goes on with it, at the next start of the program too. x discards it."
            .to_owned(),
    ];
    let spaced = paragraphs.into_iter().flat_map(|words| [(words, ui.theme.text()), (String::new(), ui.theme.text())]);
    write_paragraphs(&spaced.collect::<Vec<_>>(), text, ui);
    Message::plain(format!("Enter begins with exercise 1 of {count}"))
}
