//! The panel with the numbers of a watched run.

use std::path::Path;

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    learning::run::{follow::Condition, status::Phase},
    statistics::SuccessRate,
    terminal::{
        pages::training::{NamedRun, TrainingPage, Watch},
        ui::{
            Ui,
            chart::{CurveRole, curve_mark},
            draw_lines, draw_title, write_right,
        },
        words::{count, time_words},
    },
};

/// Maximum width of a name with its value, columns.
const WIDE: u16 = 30;
/// Text for an unknown value.
const UNKNOWN: &str = "-";

/// Draws the panel.
pub fn draw(training: &TrainingPage, watch: &Watch, area: Rect, ui: &mut Ui) {
    let mut title = vec![Span::styled(if watch.other.is_some() { "Compared" } else { "Numbers" }, ui.theme.text())];
    if watch.other.is_none()
        && let Some(from) = watch.own.run.config.as_ref().and_then(|config| config.from.as_ref())
    {
        let path = Path::new(&from.path);
        let name = path.strip_prefix(&training.places.runs).unwrap_or(path).display();
        title.push(Span::styled(format!(" from {name}"), ui.theme.faint()));
    }
    let inner = draw_title(title, area, ui);
    let inner = draw_legend(watch, inner, ui);
    let mut columns = columns(watch);
    if !watch.is_active() {
        // The run has ended, so unknown values stay unknown.
        for rows in &mut columns {
            rows.retain(|(_, value)| value != UNKNOWN);
        }
    }
    let [left, right] = columns;
    let width = (inner.width.saturating_sub(3) / 2).min(WIDE);
    let lines = left.len().max(right.len());
    // A blank row above, if there is room.
    let top = inner.y + u16::from(usize::from(inner.height) > lines + 2);
    for (rows, x) in [(left, inner.x + 1), (right, inner.x + width + 3)] {
        for ((name, value), y) in rows.into_iter().zip(top..inner.bottom()) {
            ui.buffer.set_stringn(x, y, name, usize::from(width), ui.theme.faint());
            write_right(ui.buffer, x + name.len() as u16 + 1, x + width, y, &value, ui.theme.text());
        }
    }
}

/// Draws the legend of a comparison: the sign of each run's curve, and the progress of the other run. Returns the rest of the panel.
fn draw_legend(watch: &Watch, area: Rect, ui: &mut Ui) -> Rect {
    let Some(other) = &watch.other else { return area };
    let named = |role, named: &NamedRun| {
        let mark = curve_mark(role, ui.theme, ui.caps);
        let name = Span::styled(format!(" {}", named.name), mark.style);
        Line::from(vec![mark, name])
    };
    let far = format!(
        "{} {} after {} shots",
        measured(other),
        or_unknown(other.run.held_out(), |value| format!("{value:.3}")),
        count(other.run.shots())
    );
    let far = Line::styled(format!("   {far}"), ui.theme.text());
    let lines = [named(CurveRole::Main, &watch.own), named(CurveRole::Compared, other), far];
    let rows = (lines.len() as u16).min(area.height);
    draw_lines(lines, Rect { x: area.x + 1, width: area.width.saturating_sub(1), ..area }, ui);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}

/// Name of the quantity that is measured on the held-out layouts.
fn measured(run: &NamedRun) -> &'static str {
    if run.is_success_rate() { "success" } else { "reward" }
}

type Row = (&'static str, String);

/// Two columns of names and values: progress and speed, then results and settings. In both the most important come first, because
/// small screens have no room for all.
fn columns(watch: &Watch) -> [Vec<Row>; 2] {
    let run = &watch.own.run;
    let (status, last) = (run.status.as_ref(), run.history.last());
    let shots = watch.own.run.shots();
    let seconds = status.map(|status| status.seconds).or(last.map(|record| record.seconds));
    let updates = status.map(|status| status.updates).or(last.map(|record| record.updates));
    // Only a run that is training has a speed.
    let working = status.filter(|_| watch.is_active());
    let speed = |value: Option<f64>| or_unknown(value.filter(|value| value.is_finite()), |value| count(value as u64));
    let is_going_on = matches!(watch.condition(), Condition::InPhase(Phase::Training | Phase::Measuring));
    let left = run.time_left().filter(|_| is_going_on);
    let exploration = status.map(|status| status.exploration).or(last.and_then(|record| record.exploration));
    let replay_fill = status.and_then(|status| status.replay_fill).or(last.and_then(|record| record.replay_fill));
    let three = |value: f64| format!("{value:.3}");
    let config = run.config.as_ref();
    let held_out = run.held_out();
    let mut learnt = vec![(measured(&watch.own), or_unknown(held_out, three)), ("best", or_unknown(run.best(), three))];
    if watch.own.is_success_rate() {
        learnt.insert(
            1,
            (
                "95 % within",
                or_unknown(held_out.zip(config), |(rate, config)| {
                    let layouts = config.schedule.evaluation_layouts;
                    let SuccessRate { low, high, .. } =
                        SuccessRate::new((rate * layouts as f64).round() as usize, layouts);
                    format!("{low:.3}-{high:.3}")
                }),
            ),
        );
    }
    learnt.extend([
        ("exploration", or_unknown(exploration, three)),
        ("replay filled", or_unknown(replay_fill, |share| format!("{:.0} %", 100.0 * share))),
        ("learning rate", or_unknown(last, |record| rate(record.learning_rate))),
        ("updates", or_unknown(updates, count)),
        ("seed", or_unknown(config, |config| config.plan.seed.to_string())),
    ]);
    if let Some(config) = config {
        learnt.extend([
            ("agent", config.agent.clone()),
            ("reward", config.plan.reward.to_string()),
            ("table", config.table.name.clone()),
        ]);
    }
    [
        vec![
            ("shots", count(shots)),
            ("planned", or_unknown(watch.planned_shots(), count)),
            ("trained for", or_unknown(seconds, time_words)),
            ("time left", or_unknown(left, |left| time_words(left.as_secs_f64()))),
            ("shots/s", speed(working.map(|status| status.shots_per_second))),
            ("updates/s", speed(working.map(|status| status.updates_per_second))),
            ("measured every", or_unknown(config, |config| count(config.schedule.evaluate_every))),
            ("layouts", or_unknown(config, |config| count(config.schedule.evaluation_layouts as u64))),
            ("started", or_unknown(config, |config| config.started.replace('T', " ").replace('Z', ""))),
            ("carom", or_unknown(config, |config| config.version.clone())),
        ],
        learnt,
    ]
}

/// Formats a learning rate with two significant digits.
fn rate(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

fn or_unknown<T>(value: Option<T>, words: impl FnOnce(T) -> String) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), words)
}
