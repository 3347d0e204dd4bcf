//! The records screen: the score of one or all exercises, at a real table and in the program, its chart over the sessions, the list of
//! sessions, and the skill estimate.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Style,
    text::{Line, Span},
};

use crate::{
    drills::{Attempt, Goal, Record, Session, Venue},
    learning::run::history::{NonFinite, Point, Span as Values},
    printing::{format_utc, local_time},
    terminal::{
        pages::drills::{
            DrillsPage, Estimate, record_of,
            view::{READABLE, draw_header, high_run, percent_words},
        },
        ui::{
            Message, Ui,
            chart::{Chart, Curve, CurveRole, curve_mark, draw_chart},
            draw_lines, draw_title, pair, shorten, split, wrap, write_paragraphs, write_right,
        },
        words::chance_words,
    },
};

/// Width of the numbers next to the chart: percent of the screen, minimum and maximum columns.
const NUMBERS: (u16, u16, u16) = (40, 38, 56);
/// Width of the numbers' names, columns.
const NAMES: usize = 10;

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    let scope = drills.records.scope();
    let title = scope.map_or("all exercises", |name| {
        drills.catalogue.library.get(name).map_or(name, |exercise| exercise.title.as_str())
    });
    draw_header(drills, "record", title, header, ui);
    let sessions = drills.book.sessions_of(scope);
    let (share, least, most) = NUMBERS;
    let width = (area.width * share / 100).clamp(least, most);
    let parts = parts(&sessions, scope);
    let rows = number_rows(&parts, ui);
    let skill = skill_words(&drills.records.estimate, ui);
    // The title, the numbers, a blank row, and the skill estimate.
    let needed = skill.as_ref().map_or(0, |(words, _)| 2 + rows.len() + wrap(words, usize::from(width) - 1).len());
    let top = Rect { height: (area.height / 2).max(11).max(needed as u16), ..area };
    let [numbers, chart] = split(width, top);
    draw_numbers(rows, skill.as_ref(), scope, numbers, ui);
    let curves: Vec<Curve> = parts
        .iter()
        .map(|part| Curve { points: &part.points, non_finite: NonFinite::default(), role: part.role })
        .collect();
    let tried = parts.iter().map(|part| part.record.tried).max().unwrap_or(0);
    let chart_of = Chart {
        title: if parts.is_empty() { "made of 100 by session" } else { "made of 100 by session, last:" },
        curves: &curves,
        shots: (0.0, tried.max(10) as f64),
        values: Some((0.0, 100.0)),
        log: false,
        smoothing: 0.0,
        selected: false,
        with_shots: true,
        unit: "tries",
        note: parts.is_empty().then_some("nothing is played yet"),
    };
    draw_chart(&chart_of, chart, ui);
    let list = Rect { y: top.bottom(), height: area.bottom() - top.bottom(), ..area };
    draw_sessions(drills, &sessions, scope, list, ui);
    if sessions.is_empty() {
        return Message::plain("nothing is played yet");
    }
    Message::plain(match &drills.records.estimate {
        Estimate::Known(Some(_), _) => "w takes the estimated skill as yours",
        Estimate::Working => "the skill is being estimated",
        _ => "",
    })
}

/// The results at one venue: a real table or the program.
struct Part {
    venue: Venue,
    record: Record,
    points: Vec<Point>,
    role: CurveRole,
}

/// The results at each venue with attempts. The first one has the upper curve.
fn parts(sessions: &[&Session], scope: Option<&str>) -> Vec<Part> {
    let part = |venue| {
        let sessions: Vec<&Session> = sessions.iter().copied().filter(|session| session.venue == venue).collect();
        let counts = |_: &Session, attempt: &Attempt| scope.is_none_or(|name| attempt.exercise == name);
        let record = Record::of(sessions.iter().copied(), counts);
        let points = points(&sessions, scope);
        (record.tried > 0).then_some(Part { venue, record, points, role: CurveRole::Main })
    };
    let mut parts: Vec<Part> = Venue::ALL.into_iter().filter_map(part).collect();
    parts.iter_mut().skip(1).for_each(|part| part.role = CurveRole::Compared);
    parts
}

/// The rows of the score in numbers. If there are two curves, each row has the sign of its curve.
fn number_rows(parts: &[Part], ui: &Ui) -> Vec<Line<'static>> {
    let row = |name: &str, value: String| pair(name, NAMES, value, ui.theme);
    if parts.is_empty() {
        return vec![row("attempts", "0".to_owned())];
    }
    let mut rows = Vec::new();
    for Part { venue, record, role, .. } in parts {
        let made = format!("{} of {}, {}", record.made, record.tried, chance_words(&record.rate));
        if parts.len() > 1 {
            let mark = curve_mark(*role, ui.theme, ui.caps);
            let width = NAMES.saturating_sub(mark.width() + 1);
            let name = Span::styled(format!(" {:<width$}", venue.word()), mark.style);
            rows.push(Line::from(vec![mark, name, Span::styled(made, ui.theme.text())]));
        } else {
            rows.push(row(venue.word(), made));
        }
        let of = if record.has_unordered { ", one by one" } else { "" };
        let average = record.average.map_or("-".to_owned(), |average| format!("{average:.2} an inning{of}"));
        rows.push(row("average", average));
        rows.push(row("high run", high_run(record).map_or("-".to_owned(), |run| run.to_string())));
        if record.helped > 0 {
            rows.push(row("hints", format!("{} of the attempts", record.helped)));
        }
    }
    rows
}

/// The skill estimate in words.
fn skill_words(estimate: &Estimate, ui: &Ui) -> Option<(String, Style)> {
    match estimate {
        Estimate::Unknown => None,
        Estimate::Working => Some(("your skill: being estimated".to_owned(), ui.theme.faint())),
        Estimate::Known(_, sentence) => Some((sentence.clone(), ui.theme.good())),
        Estimate::Missing(sentence) => Some((sentence.clone(), ui.theme.faint())),
    }
}

fn draw_numbers(
    rows: Vec<Line<'static>>,
    skill: Option<&(String, Style)>,
    scope: Option<&str>,
    area: Rect,
    ui: &mut Ui,
) {
    let title = if scope.is_some() { "This exercise" } else { "All" };
    let inner = draw_title(title, area, ui);
    let y = inner.y + rows.len() as u16;
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(1), ..inner };
    draw_lines(rows, text, ui);
    let rest = Rect { x: inner.x + 1, y: y + 1, width: inner.width - 1, height: inner.bottom().saturating_sub(y + 1) };
    write_paragraphs(skill.map_or(&[], std::slice::from_ref), rest, ui);
}

/// The percentage of made attempts in each session, over the number of attempts.
fn points(sessions: &[&Session], scope: Option<&str>) -> Vec<Point> {
    let mut before = 0;
    let shares = sessions.iter().filter_map(|session| {
        let record = record_of(session, scope);
        let (first, last) = (before + 1, before + record.tried as u64);
        before = last;
        let share = 100.0 * record.rate.rate;
        let finite = Values { min: share, mean: share, max: share, not_positive: u64::from(share <= 0.0) };
        (record.tried > 0).then_some(Point {
            shots: (first, last),
            finite: Some(finite),
            non_finite: NonFinite::default(),
        })
    });
    shares.collect()
}

/// The text in place of an empty list of sessions.
const EMPTY: &str = "A session begins with the first stroke that you play at an exercise, or with the first point or miss that \
                     you note there from a real table.";

/// Right ends of the numbers of a session, columns.
const NUMBER_ENDS: [(u16, &str); 4] = [(26, "made"), (33, "rate"), (38, "run"), (46, "average")];
/// First columns of the venue and of the exercise and goal.
const VENUE_COLUMN: u16 = 48;
const GOAL_COLUMN: u16 = 54;

fn draw_sessions(drills: &DrillsPage, sessions: &[&Session], scope: Option<&str>, area: Rect, ui: &mut Ui) {
    let inner = draw_title(vec![Span::styled("Sessions", ui.theme.text())], area, ui);
    if sessions.is_empty() {
        let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2).min(READABLE), ..inner };
        write_paragraphs(&[(EMPTY.to_owned(), ui.theme.faint())], text, ui);
        return;
    }
    for (end, label) in NUMBER_ENDS {
        write_right(ui.buffer, area.x, area.x + end + 1, area.y, &format!(" {label} "), ui.theme.faint());
    }
    let top = drills.records.top(sessions.len());
    for (session, y) in sessions.iter().rev().skip(top).zip(inner.y..inner.bottom()) {
        let record = record_of(session, scope);
        let put = |buffer: &mut Buffer, end: u16, text: &str, style: Style| {
            write_right(buffer, inner.x, inner.x + end, y, text, style);
        };
        let started = local_time(&format_utc(session.started));
        ui.buffer.set_string(inner.x + 1, y, started, ui.theme.faint());
        put(ui.buffer, NUMBER_ENDS[0].0, &format!("{}/{}", record.made, record.tried), ui.theme.text());
        put(ui.buffer, NUMBER_ENDS[1].0, &percent_words(record.rate.rate), ui.theme.text());
        put(
            ui.buffer,
            NUMBER_ENDS[2].0,
            &high_run(&record).map_or("-".to_owned(), |run| run.to_string()),
            ui.theme.text(),
        );
        let average = record.average.map_or("-".to_owned(), |average| format!("{average:.2}"));
        put(ui.buffer, NUMBER_ENDS[3].0, &average, ui.theme.text());
        ui.buffer.set_string(inner.x + VENUE_COLUMN, y, session.venue.word(), ui.theme.text());
        let room = usize::from(inner.width.saturating_sub(GOAL_COLUMN));
        ui.buffer.set_string(inner.x + GOAL_COLUMN, y, shorten(&what(session, scope), room, ui.caps), ui.theme.faint());
    }
}

/// The exercise and goal of a session.
fn what(session: &Session, scope: Option<&str>) -> String {
    let title = session.exercises.first().map_or("", |exercise| exercise.title.as_str());
    let goal = session.score_words().unwrap_or_else(|| session.goal.words());
    if scope.is_some() || session.goal == Goal::Exam { goal } else { format!("{title}: {goal}") }
}
