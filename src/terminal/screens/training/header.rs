//! The first row of a run's page behind the tabs: its name, how it is, and how far it has come.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    learning::run::{follow::Condition, status::Phase},
    terminal::{
        app::App,
        training::Watch,
        widgets::{draw_tabs, end_of},
    },
};

/// Cells of the bar that shows how far the run has come: at least, and at most.
const BAR: (u16, u16) = (6, 40);
/// Columns of the longest conditions that come often, so that the bar does not jump with each.
const CONDITION: usize = 9;

/// Draws the row.
pub fn draw(app: &App, watch: &Watch, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let area = draw_tabs(app, area, buffer);
    let condition = watch.condition();
    let style = match condition {
        Condition::Is(Phase::Failed) | Condition::Died | Condition::Stalled(_) | Condition::Removed => theme.warning(),
        Condition::Is(Phase::Training | Phase::Measuring | Phase::Finished) => theme.good(),
        _ => theme.text(),
    };
    let words = format!("{:<CONDITION$}", condition.to_string());
    let share = watch.planned().map(|planned| (watch.own.run.shots() as f64 / planned.max(1) as f64).min(1.0));
    let percent = share.map_or("     -".to_owned(), |share| format!("{:>4.0} %", (100.0 * share).floor()));
    // The condition and the percentage come first: what they leave is the name's, then of what it is, then the bar's.
    let fixed = (words.chars().count() + percent.len() + 2) as u16;
    let room = area.width.saturating_sub(fixed + 1);
    let mut left =
        Line::from(Span::styled(format!(" {}", end_of(&watch.own.name, usize::from(room), look)), theme.text()));
    if let Some(config) = &watch.own.run.config {
        let what = format!("  {} for {} on \"{}\"", config.agent, config.plan.reward, config.table.name);
        if left.width() + what.chars().count() + usize::from(BAR.0) + 2 <= usize::from(room) {
            left.push_span(Span::styled(what, theme.faint()));
        }
    }
    let taken = buffer.set_line(area.x, area.y, &left, room + 1).0 - area.x;
    let bar = (area.width - taken).saturating_sub(fixed + 2).min(BAR.1);
    let mut line = Line::from(Span::styled(words, style));
    if bar >= BAR.0 {
        let done = (share.unwrap_or(0.0) * f64::from(bar)) as usize;
        line.push_span(Span::raw("  "));
        line.push_span(Span::styled(look.pick("━", "=").repeat(done), theme.accent()));
        line.push_span(Span::styled(look.pick("─", "-").repeat(usize::from(bar) - done), theme.faint()));
    }
    line.push_span(Span::styled(percent, theme.text()));
    let x = area.right().saturating_sub(line.width() as u16 + 1).max(area.x + taken + 1).min(area.right());
    buffer.set_line(x, area.y, &line, area.right() - x);
}
