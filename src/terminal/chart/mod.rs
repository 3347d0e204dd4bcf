//! Charts of what a run reports.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use super::{look::Look, theme::Theme, widgets::draw_title};
use crate::learning::run::history::{Odd, Point};

/// Whose curve it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Whose {
    /// The run's that is watched.
    Own,
    /// That of the run it is compared with.
    Other,
}

/// A curve.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Its points, in order.
    pub points: &'a [Point],
    /// Values that were not finite.
    pub odd: Odd,
    /// Whose it is.
    pub whose: Whose,
}

/// A chart.
#[derive(Clone, Copy, Debug)]
pub struct Chart<'a> {
    /// Its title.
    pub title: &'a str,
    /// Its curves.
    pub curves: &'a [Curve<'a>],
    /// The shots that are shown.
    pub shots: (f64, f64),
    /// Whether its scale is logarithmic.
    pub log: bool,
    /// Share of the shots that are shown over which curves are smoothed.
    pub smoothing: f64,
    /// Whether it is the selected one.
    pub selected: bool,
    /// Whether shots are written below it.
    pub with_shots: bool,
    /// What else is to be said.
    pub note: Option<&'a str>,
}

/// Draws the chart.
pub fn draw_chart(chart: &Chart, area: Rect, theme: &Theme, look: Look, buffer: &mut Buffer) {
    let style = if chart.selected { theme.accent() } else { theme.text() };
    draw_title(&Line::from(Span::styled(chart.title.to_owned(), style)), area, theme, look, buffer);
}

/// The range of shots that shows all of a run, growing in steps.
pub fn whole(shots: u64, planned: Option<u64>) -> (f64, f64) {
    let mut end = 1000.0;
    while end < shots as f64 {
        end *= 2.0;
    }
    (0.0, planned.map_or(end, |planned| if planned >= shots { end.min(planned as f64) } else { end }))
}
