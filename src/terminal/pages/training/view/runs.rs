//! The view of the list of runs.

use ratatui::{
    buffer::Buffer,
    layout::{Position, Rect},
    style::Style,
    text::Span,
};

use crate::{
    learning::run::{follow::Condition, list::Summary, status::Phase},
    printing::local_time,
    terminal::{
        TrainingContext,
        pages::{Target, training::TrainingPage},
        ui::{Message, Ui, columns, draw_title, list, write_right},
        words::{count, short_count},
    },
};

/// Number of blanks between two columns.
const GAP: usize = 2;

/// A column of the list.
struct Column {
    heading: &'static str,
    is_number: bool,
    /// Rank for leaving columns out if there is no room: the largest is dropped first, and 0 is never dropped.
    dispensable: u8,
    text: fn(&Summary) -> String,
}

const COLUMNS: [Column; 9] = [
    Column { heading: "run", is_number: false, dispensable: 0, text: |run| run.name.clone() },
    Column { heading: "agent", is_number: false, dispensable: 4, text: |run| run.agent.clone() },
    Column { heading: "reward", is_number: false, dispensable: 3, text: |run| run.reward.to_string() },
    Column { heading: "table", is_number: false, dispensable: 5, text: |run| run.table.clone() },
    Column { heading: "shots", is_number: true, dispensable: 2, text: |run| short_count(run.shots) },
    Column { heading: "%", is_number: true, dispensable: 0, text: |run| percent(run) },
    Column { heading: "best", is_number: true, dispensable: 0, text: |run| reward(run.best_reward) },
    Column { heading: "last", is_number: true, dispensable: 1, text: |run| reward(run.last_reward) },
    Column { heading: "state", is_number: false, dispensable: 0, text: |run| run.state.word().to_owned() },
];

fn percent(run: &Summary) -> String {
    // The last iteration of a run may exceed the plan by a few shots.
    format!("{:.0}", (100.0 * run.shots as f64 / run.planned_shots.max(1) as f64).min(100.0).floor())
}

fn reward(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.3}"))
}

/// Draws the list and, below it, details of the marked run.
pub fn draw(training: &TrainingPage, area: Rect, ui: &mut Ui) {
    let (runs, mark) = (training.list.runs(), training.list.mark());
    if runs.is_empty() {
        return draw_empty(training, area, ui);
    }
    let widths: Vec<usize> = COLUMNS
        .iter()
        .map(|column| {
            let cells = runs.iter().map(|run| columns(&(column.text)(run)));
            cells.chain([column.heading.len()]).max().unwrap_or(0)
        })
        .collect();
    let shown = fitting_columns(&widths, usize::from(area.width).saturating_sub(3));
    let mut x = area.x + 3;
    let mut places = Vec::new();
    for column in shown {
        // A name that is too long even alone is cut.
        let width = (widths[column] as u16).min(area.right().saturating_sub(x));
        places.push((&COLUMNS[column], x, width));
        x = (x + width + GAP as u16).min(area.right());
    }
    let put = |buffer: &mut Buffer, y: u16, style: Style, text: &dyn Fn(&Column) -> String| {
        for (column, x, width) in &places {
            if column.is_number {
                write_right(buffer, *x, x + width, y, &text(column), style);
            } else {
                buffer.set_stringn(*x, y, text(column), usize::from(*width), style);
            }
        }
    };
    put(ui.buffer, area.y + 1, ui.theme.faint(), &|column| column.heading.to_owned());
    for (n, y) in list::shown(mark, runs.len(), rows(area)) {
        let run = &runs[n];
        let style = match run.state {
            _ if n == mark => ui.theme.accent(),
            Condition::Stalled(_) | Condition::Died | Condition::InPhase(Phase::Failed) => ui.theme.warning(),
            state if state.is_at_work() => ui.theme.good(),
            _ => ui.theme.text(),
        };
        list::draw_mark(n == mark, area.x + 1, y, ui);
        put(ui.buffer, y, style, &|column| (column.text)(run));
    }
    draw_marked(training, &runs[mark], mark, Rect { y: area.bottom() - 3, height: 3, ..area }, ui);
}

/// The area of the list's rows. Above it are a blank row and the headings, below it the details of the marked run.
fn rows(area: Rect) -> Rect {
    Rect { y: area.y + 2, height: area.height.saturating_sub(6), ..area }
}

/// The mouse target at `at`.
pub fn target(training: &TrainingPage, area: Rect, at: Position) -> Option<Target> {
    let runs = &training.list;
    let line = list::line_at(runs.mark(), runs.runs().len(), rows(area), at.y);
    area.contains(at).then(|| Target::list(line, runs.mark()))
}

/// The indices of the columns that fit into a width of `room`.
fn fitting_columns(widths: &[usize], room: usize) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..COLUMNS.len()).collect();
    while kept.iter().map(|&n| widths[n] + GAP).sum::<usize>() > room + GAP {
        match kept.iter().copied().filter(|&n| COLUMNS[n].dispensable > 0).max_by_key(|&n| COLUMNS[n].dispensable) {
            Some(least) => kept.retain(|&n| n != least),
            None => break,
        }
    }
    kept
}

fn draw_marked(training: &TrainingPage, run: &Summary, mark: usize, area: Rect, ui: &mut Ui) {
    let of = format!(" {} of {}", mark + 1, training.list.runs().len());
    let title = vec![Span::styled("Run", ui.theme.text()), Span::styled(of, ui.theme.faint())];
    let inner = draw_title(title, area, ui);
    let lines = [
        format!(
            "{} for {} on \"{}\", seed {}: {} of {} shots",
            run.agent,
            run.reward,
            run.table,
            run.seed,
            count(run.shots),
            count(run.planned_shots)
        ),
        format!("started {}, last written {}", local_time(&run.started), local_time(&run.changed)),
    ];
    for (line, y) in lines.iter().zip(inner.y..inner.bottom()) {
        ui.buffer.set_stringn(inner.x + 2, y, line, usize::from(inner.width.saturating_sub(3)), ui.theme.text());
    }
}

fn draw_empty(training: &TrainingPage, area: Rect, ui: &mut Ui) {
    let list = &training.list;
    let nothing_in = format!("There is no run in {}.", training.folder.display());
    let lines: &[&str] = match list.trouble {
        Some(_) => &["The runs cannot be listed."],
        None if list.known.is_none() => &["Looking for runs"],
        None if training.page() == TrainingContext::Compare => &["There is no run to compare with."],
        // On its own, this page may list another folder than the user's runs.
        None if training.is_only_page => &[&nothing_in],
        None => &[
            "No agent has been trained here yet.",
            "",
            "Press n to start a run: an agent plays shot after shot and learns from them,",
            "and you see how. It goes on without this screen: come back when you like.",
        ],
    };
    for (line, y) in lines.iter().zip(area.y + 2..area.bottom()) {
        ui.buffer.set_stringn(area.x + 3, y, line, usize::from(area.width.saturating_sub(4)), ui.theme.text());
    }
}

/// The default text of the status line.
pub fn status_line(training: &TrainingPage) -> Message {
    let list = &training.list;
    if let Some(sentence) = &list.trouble {
        return Message::warning(sentence);
    }
    if !list.unreadable.is_empty() {
        return Message::warning(list.unreadable.join("; "));
    }
    let paused = list.runs().iter().filter(|run| run.state == Condition::InPhase(Phase::Paused)).count();
    let working = list.runs().iter().filter(|run| run.state.is_at_work()).count() - paused;
    let working = match working {
        0 => "no run is training".to_owned(),
        1 => "1 run is training".to_owned(),
        _ => format!("{working} runs are training"),
    };
    let paused = match paused {
        0 => String::new(),
        1 => "; 1 is paused".to_owned(),
        _ => format!("; {paused} are paused"),
    };
    Message::plain(working + &paused)
}
