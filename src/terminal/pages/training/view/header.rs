//! A watched run's part of the first screen row, after the tabs: name, condition and progress.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    learning::run::{follow::Condition, status::Phase},
    terminal::{
        pages::training::Watch,
        ui::{Ui, columns, shorten_start},
    },
};

/// Minimum and maximum width of the progress bar, columns.
const BAR: (u16, u16) = (6, 40);
/// Width of the longest frequent conditions, columns, so that the bar keeps its position.
const CONDITION: usize = 9;

/// Draws the row.
pub fn draw(watch: &Watch, area: Rect, ui: &mut Ui) {
    let condition = watch.condition();
    let style = match condition {
        Condition::InPhase(Phase::Failed) | Condition::Died | Condition::Stalled(_) | Condition::Removed => {
            ui.theme.warning()
        }
        Condition::InPhase(Phase::Training | Phase::Measuring | Phase::Finished) => ui.theme.good(),
        _ => ui.theme.text(),
    };
    let words = format!("{:<CONDITION$}", condition.to_string());
    let share = watch.planned_shots().map(|planned| (watch.own.run.shots() as f64 / planned.max(1) as f64).min(1.0));
    let percent = share.map_or("     -".to_owned(), |share| format!("{:>4.0} %", (100.0 * share).floor()));
    // Condition and percentage have priority. The rest of the row goes to the name, then to the description, then to the bar.
    let fixed = (columns(&words) + percent.len() + 2) as u16;
    let room = area.width.saturating_sub(fixed + 1);
    let mut left = Line::from(Span::styled(
        format!(" {}", shorten_start(&watch.own.name, usize::from(room), ui.caps)),
        ui.theme.text(),
    ));
    if let Some(config) = &watch.own.run.config {
        let what = format!("  {} for {} on \"{}\"", config.agent, config.plan.reward, config.table.name);
        if left.width() + columns(&what) + usize::from(BAR.0) + 2 <= usize::from(room) {
            left.push_span(Span::styled(what, ui.theme.faint()));
        }
    }
    let taken = ui.buffer.set_line(area.x, area.y, &left, room + 1).0 - area.x;
    let bar = (area.width - taken).saturating_sub(fixed + 2).min(BAR.1);
    let mut line = Line::from(Span::styled(words, style));
    if bar >= BAR.0 {
        let done = (share.unwrap_or(0.0) * f64::from(bar)) as usize;
        line.push_span(Span::raw("  "));
        line.push_span(Span::styled(ui.caps.pick("━", "=").repeat(done), ui.theme.accent()));
        line.push_span(Span::styled(ui.caps.pick("─", "-").repeat(usize::from(bar) - done), ui.theme.faint()));
    }
    line.push_span(Span::styled(percent, ui.theme.text()));
    let x = area.right().saturating_sub(line.width() as u16 + 1).max(area.x + taken + 1).min(area.right());
    ui.buffer.set_line(x, area.y, &line, area.right() - x);
}
