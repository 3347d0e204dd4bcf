//! The score panel: the goal, the points, the runs.

use ratatui::{
    layout::Rect,
    style::Style,
    text::{Line, Span},
};

use crate::{
    drills::{Attempt, Goal, Record, Session, Venue, exam},
    terminal::{
        pages::drills::{DrillsPage, Turn, view::percent_words},
        ui::{Ui, draw_title, write_paragraphs},
        words::chance_words,
    },
};

/// Draws the panel. Returns the first row that is free below it.
pub fn draw(drills: &DrillsPage, turn: &Turn, area: Rect, ui: &mut Ui) -> u16 {
    let session = turn.settled_session();
    let place = if session.venue == Venue::Table { "Real table: " } else { "Score: " };
    let title = format!("{place}{}", session.goal.words());
    // The innings of a match are listed below.
    let title = title.split(',').next().filter(|_| session.is_match()).unwrap_or(&title).to_owned();
    let inner = draw_title(title, area, ui);
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    let top = draw_marks(&session, text, ui);
    let text = Rect { y: top, height: text.bottom() - top, ..text };
    let mut paragraphs: Vec<(String, Style)> =
        lines(&session, &turn.exercise.name).into_iter().map(|words| (words, ui.theme.text())).collect();
    let ever = drills.book.scores_of(&turn.exercise.name);
    let tried: usize = ever.iter().map(|(_, record)| record.tried).sum();
    // A stroke that is still being watched is not counted here either.
    if tried > session.attempts.len() && session.goal != Goal::Exam && !turn.is_result_hidden() {
        let scores = ever.iter().map(|(venue, record)| format!("{} {}/{}", venue.word(), record.made, record.tried));
        let words = format!("in all: {}", scores.collect::<Vec<_>>().join(", "));
        paragraphs.push((words, ui.theme.faint()));
    }
    write_paragraphs(&paragraphs, text, ui)
}

/// Draws one sign for each attempt of an exam or each point of a run. Returns the first row that is free below them.
fn draw_marks(session: &Session, area: Rect, ui: &mut Ui) -> u16 {
    let signs = ui.caps.pick(["●", "○", "·"], ["x", "o", "."]);
    let style = [ui.theme.good(), ui.theme.warning(), ui.theme.faint()];
    let sign = |made: Option<bool>| match made {
        Some(true) => 0,
        Some(false) => 1,
        None => 2,
    };
    let marks: Vec<usize> = match session.goal {
        Goal::Exam => {
            let done = session.attempts.iter().map(|attempt: &Attempt| sign(Some(attempt.made)));
            done.chain(std::iter::repeat(2)).take(session.exercises.len()).collect()
        }
        Goal::Run(points) => (0..points.min(40)).map(|n| sign((n < session.current_run()).then_some(true))).collect(),
        _ => return area.y,
    };
    let spans: Vec<Span> = marks.iter().map(|&mark| Span::styled(signs[mark], style[mark])).collect();
    ui.buffer.set_line(area.x, area.y, &Line::from(spans), area.width);
    area.y + 1
}

/// The lines of the score; `exercise` is the name of the one on the table.
fn lines(session: &Session, exercise: &str) -> Vec<String> {
    let record = session.record();
    let Record { tried, made, .. } = record;
    let mut lines = Vec::new();
    if session.goal == Goal::Exam {
        // The result of an exercise is shown while that exercise is still on the table.
        let place = session.exercises.iter().position(|each| each.name == exercise);
        let number = place.map_or(tried, |place| place + 1);
        lines.push(format!("exercise {number} of {}: {made}/{tried} made", session.exercises.len()));
        if let Some(score) = exam::score(session) {
            let [beginner, club, best] = [score.expected.beginner, score.expected.club, score.expected.world_class]
                .map(|points| format!("{points:.1}"));
            lines.push(format!("so far a beginner makes {beginner}, club {club}, world-class {best}"));
        }
        return lines;
    }
    if session.is_match() {
        lines.extend(session.winner_words().or_else(|| session.inning_words()));
    }
    if tried == 0 {
        lines.push("no attempt yet".to_owned());
        return lines;
    }
    let average = record.average.map_or(String::new(), |average| format!(", average {average:.2}"));
    let plural = |count: usize, one: &str| if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") };
    if session.is_match() {
        for cue_ball in [session.cue_ball, session.cue_ball.other()] {
            let Record { made, high_run, .. } = session.side_record(cue_ball);
            lines.push(format!("{}: {made}, best {high_run}", session.side_words(cue_ball)));
        }
        let averages = [session.cue_ball, session.cue_ball.other()]
            .map(|ball| session.side_record(ball).average.map_or("-".to_owned(), |average| format!("{average:.2}")));
        lines.push(format!("averages {}", averages.join(" : ")));
    } else if session.is_game() {
        lines.push(format!("{} in {}{average}", plural(made, "point"), plural(record.innings, "inning")));
        lines.push(format!("run {}, best {}", session.current_run(), record.high_run));
    } else {
        lines.push(format!("{made} of {tried} made, {}", chance_words(&record.rate)));
        lines.push(format!("run {}, best {}{average}", session.current_run(), record.high_run));
    }
    let own = session.attempts.iter().filter(|attempt| !attempt.by_coach);
    let (helped, unhelped): (Vec<_>, Vec<_>) = own.partition(|attempt| attempt.helped);
    if !helped.is_empty() {
        let share = helped.len() as f64 / (helped.len() + unhelped.len()) as f64;
        lines.push(format!("{} of your attempts with a hint ({})", helped.len(), percent_words(share)));
    }
    lines
}
