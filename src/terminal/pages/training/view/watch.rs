//! The page of a run: its charts, its numbers and its latest shots.

use ratatui::layout::Rect;

use crate::{
    table::Table,
    terminal::{
        pages::training::{
            TrainingPage, Watch,
            view::{charts, numbers, panes::Panes, replay},
        },
        ui::Ui,
    },
};

/// Draws the page below its first row.
pub fn draw(training: &TrainingPage, watch: &Watch, area: Rect, ui: &mut Ui) {
    // A table has the same shape everywhere, so that nothing jumps when the run's own is known.
    let panes = Panes::new(watch.table().unwrap_or(&Table::default()), area);
    charts::draw(watch, panes.charts, ui);
    numbers::draw(training, watch, panes.numbers, ui);
    replay::draw(watch, panes.replay, ui);
}
