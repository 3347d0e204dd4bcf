//! The first row of a run's page: its name, how it is, and how far it has come.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Modifier,
    text::{Line, Span},
};

use crate::{
    learning::run::{follow::Condition, standing::Phase},
    terminal::{app::App, training::Watch},
};

/// Cells of the bar that shows how far the run has come: at least, and at most.
const BAR: (u16, u16) = (6, 40);
/// Columns of the longest conditions that come often, so that the bar does not jump with each.
const CONDITION: usize = 9;

/// Draws the row.
pub fn draw(app: &App, watch: &Watch, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let condition = watch.condition();
    let style = match condition {
        Condition::Is(Phase::Failed) | Condition::Died | Condition::Stalled(_) | Condition::Removed => theme.warning(),
        Condition::Is(Phase::Training | Phase::Measuring | Phase::Finished) => theme.good(),
        _ => theme.text(),
    };
    let words = format!("{:<CONDITION$}", condition.to_string());
    let share = watch.planned().map(|planned| (watch.own.run.shots() as f64 / planned.max(1) as f64).min(1.0));
    let percent = share.map_or("    -".to_owned(), |share| format!("{:>4.0}%", (100.0 * share).floor()));
    // The condition, a bar and the percentage come first: what they leave is the name's, and then of what it is.
    let fixed = (words.chars().count() + percent.len() + 3) as u16;
    let right = area.width.saturating_sub(fixed + BAR.0 + 2);
    let badge = Span::styled(" carom ", theme.accent().add_modifier(Modifier::REVERSED));
    let mut left = Line::from(vec![badge, Span::styled(format!(" {}", watch.own.name), theme.text())]);
    if let Some(config) = &watch.own.run.config {
        let what = format!("  {} for {} on \"{}\"", config.agent, config.plan.reward, config.table.name);
        if left.width() + what.chars().count() <= usize::from(right) {
            left.push_span(Span::styled(what, theme.faint()));
        }
    }
    let taken = buffer.set_line(area.x, area.y, &left, right).0 - area.x;
    let bar = area.width.saturating_sub(taken + fixed + 2).clamp(BAR.0, BAR.1);
    let done = (share.unwrap_or(0.0) * f64::from(bar)) as usize;
    let line = Line::from(vec![
        Span::styled(words, style),
        Span::raw("  "),
        Span::styled(look.pick("━", "=").repeat(done), theme.accent()),
        Span::styled(look.pick("─", "-").repeat(usize::from(bar) - done), theme.faint()),
        Span::styled(percent, theme.text()),
    ]);
    let x = area.right().saturating_sub(line.width() as u16 + 1).max(area.x + taken + 1);
    buffer.set_line(x, area.y, &line, area.right().saturating_sub(x));
}
