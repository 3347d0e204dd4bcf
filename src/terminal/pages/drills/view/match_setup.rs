//! The screen on which a match against the coach is chosen.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    coach::Skill,
    terminal::{
        pages::drills::{
            DrillsPage, MatchField, MatchSetup,
            view::{READABLE, draw_header},
        },
        ui::{Message, Ui, draw_title, list, stepper, wrap, write_paragraphs},
        words::{others_skill_word, player_words},
    },
};

/// Widths of the names of the lines and of their values, columns.
const NAME: u16 = 18;
const VALUE: u16 = 18;

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    draw_header(drills, "match", "", header, ui);
    let inner = draw_title("A match against the coach", area, ui);
    let setup = &drills.match_setup;
    for (field, y) in MatchField::ALL.into_iter().zip((inner.y + 1..).step_by(2)) {
        let is_marked = field == setup.field;
        let (name, value, note) = words(setup, field, drills.player.skill);
        list::draw_mark(is_marked, inner.x + 1, y, ui);
        ui.buffer.set_string(inner.x + 3, y, name, ui.theme.faint());
        let x = inner.x + 3 + NAME;
        let style = if is_marked { ui.theme.accent() } else { ui.theme.text() };
        let value = Line::from_iter(stepper(Span::styled(value, style), is_marked, ui));
        ui.buffer.set_line(x - 2, y, &value, VALUE + 2);
        // The note can use two rows, since the row below is free.
        let (x, room) = (x + VALUE, usize::from(inner.right().saturating_sub(x + VALUE + 1)));
        for (line, y) in wrap(&note, room).into_iter().take(2).zip(y..) {
            ui.buffer.set_stringn(x, y, line, room, ui.theme.faint());
        }
    }
    // One free row below the second row of the last note.
    let top = inner.y + 2 * MatchField::ALL.len() as u16 + 2;
    let text = Rect {
        x: inner.x + 3,
        y: top,
        width: READABLE.min(inner.width.saturating_sub(4)),
        height: inner.bottom().saturating_sub(top),
    };
    let paragraphs = [
        "You begin with white from the opening. A miss passes the turn to the coach with yellow. Space plays each of the \
         coach's strokes.",
        "Both sides have the same number of innings. If you reach the points first, the coach has the equalising inning, \
         from the opening; if it reaches them too, the match is a draw.",
        "Esc leaves a match, and F9 goes on with it, at the next start of the program too.",
    ];
    let spaced = paragraphs.into_iter().flat_map(|words| [words.to_owned(), String::new()]);
    write_paragraphs(&spaced.map(|words| (words, ui.theme.text())).collect::<Vec<_>>(), text, ui);
    Message::plain("arrows choose; Enter begins the match")
}

/// The name of a line, its value, and a note on it. `player` is the player's skill.
fn words(setup: &MatchSetup, field: MatchField, player: Skill) -> (&'static str, String, String) {
    let count = |count: u32, what: &str| match count {
        0 => "no limit".to_owned(),
        _ => format!("{count} {what}"),
    };
    match field {
        MatchField::Rule => ("what counts", setup.rule.to_string(), String::new()),
        MatchField::Distance => {
            let note = match (setup.points, setup.innings) {
                (0, 0) => "no end and no winner",
                (0, _) => "only the innings count",
                _ => "both sides have equally many innings",
            };
            ("distance", count(setup.points, "points"), note.to_owned())
        }
        MatchField::Innings => {
            let note = match (setup.innings, setup.points) {
                (0, _) => "",
                (_, 0) => "whoever has more points then wins",
                _ => "the match also ends after these; more points win",
            };
            ("innings", count(setup.innings, "innings"), note.to_owned())
        }
        MatchField::Level => match setup.level {
            None => (
                "the coach plays",
                "as you".to_owned(),
                format!("with errors as large as yours: {}", player_words(player)),
            ),
            Some(level) if level.is_perfect() => {
                ("the coach plays", others_skill_word(level), "without errors".to_owned())
            }
            Some(level) => (
                "the coach plays",
                others_skill_word(level),
                format!("with the errors of this level: {}", player_words(level)),
            ),
        },
    }
}
