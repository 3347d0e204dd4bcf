//! The page of a run: its charts, its numbers and its latest shots.

use ratatui::{buffer::Buffer, layout::Rect};

use super::{charts, numbers, panes::Panes, replay};
use crate::{
    table::Table,
    terminal::{app::App, training::Watch},
};

/// Draws the page below its first row.
pub fn draw(app: &App, watch: &Watch, area: Rect, buffer: &mut Buffer) {
    // A table has the same shape everywhere, so that nothing jumps when the run's own is known.
    let panes = Panes::new(watch.table().unwrap_or(&Table::default()), area);
    charts::draw(app, watch, panes.charts, buffer);
    numbers::draw(app, watch, panes.numbers, buffer);
    replay::draw(app, watch, panes.replay, buffer);
}
