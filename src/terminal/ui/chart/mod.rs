//! Charts: a quantity of a training run over the number of shots, as a curve that shows every peak.

mod grid;
mod label;
mod scale;
mod smooth;
mod step;
mod title;
mod trace;

use ratatui::{layout::Rect, text::Span};

use crate::{
    learning::run::history::{NonFinite, Point},
    terminal::{
        Capabilities,
        ui::{
            Theme, Ui, below_title,
            chart::{
                grid::{Grid, Layer},
                scale::{LABEL_WIDTH, Scale, shot_ticks},
                step::Step,
                trace::Frame,
            },
            columns, write_right,
        },
    },
};

/// Columns left of the plot for labels and axis; constant, so that the plot never moves.
const LEFT: u16 = LABEL_WIDTH as u16 + 1;
/// Smallest plot width with labels, columns.
const MIN_PLOT_WIDTH: u16 = 6;

/// Which run a curve belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveRole {
    /// The run itself.
    Main,
    /// The run compared with it.
    Compared,
}

/// The values of one run.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// The values, ordered by shots.
    pub points: &'a [Point],
    /// Counts of the non-finite values of the quantity, shown in the title.
    pub non_finite: NonFinite,
    /// The run they belong to.
    pub role: CurveRole,
}

/// The data and options of a chart.
#[derive(Clone, Copy, Debug)]
pub struct Chart<'a> {
    /// The name of the quantity.
    pub title: &'a str,
    /// The values of one or two runs.
    pub curves: &'a [Curve<'a>],
    /// Shots at the left and the right edge, see [`whole`].
    pub shots: (f64, f64),
    /// The ends of the value axis; if `None`, chosen from the visible values.
    pub values: Option<(f64, f64)>,
    /// Whether the value axis is logarithmic.
    pub log: bool,
    /// Length of the exponential mean as a fraction of the visible range of shots; 0 turns smoothing off.
    pub smoothing: f64,
    /// Whether this chart has the keyboard focus.
    pub selected: bool,
    /// Whether the last row shows labels of shots.
    pub with_shots: bool,
    /// The unit shown there.
    pub unit: &'a str,
    /// A note: shown in place of the curve while there are no data, otherwise in the title if there is room.
    pub note: Option<&'a str>,
}

impl Chart<'_> {
    /// The curves in drawing order, the uppermost last.
    fn ordered(&self) -> impl DoubleEndedIterator<Item = &Curve<'_>> {
        let of = |role| self.curves.iter().filter(move |curve| curve.role == role);
        of(CurveRole::Compared).chain(of(CurveRole::Main))
    }

    /// Smoothing length in shots, or `None` if the curves are not smoothed.
    fn length(&self) -> Option<f64> {
        let length = self.smoothing * (self.shots.1 - self.shots.0);
        (length > 0.0 && length.is_finite()).then_some(length)
    }

    fn has_points(&self) -> bool {
        self.curves.iter().any(|curve| !curve.points.is_empty())
    }

    /// Whether a point overlaps the visible range of shots.
    fn shows(&self, point: &Point) -> bool {
        point.shots.1 as f64 >= self.shots.0 && point.shots.0 as f64 <= self.shots.1
    }

    /// The scale for the visible values; if there are none, for all values.
    fn scale(&self) -> Option<Scale> {
        let points = || self.curves.iter().flat_map(|curve| curve.points);
        let ends = |(low, high): (f64, f64), (min, max): (f64, f64)| (low.min(min), high.max(max));
        let spans = |all: bool| {
            let visible = points().filter(move |point| all || self.shows(point));
            visible.filter_map(|point| values(point, self.log)).reduce(ends)
        };
        let (min, max) = spans(false).or_else(|| spans(true)).map(|found| self.values.unwrap_or(found))?;
        Some(if self.log { Scale::logarithmic(min, max) } else { Scale::linear(min, max) })
    }
}

/// Smallest and largest value of a point that the scale can show.
fn values(point: &Point, log: bool) -> Option<(f64, f64)> {
    let span = point.finite?;
    if !log {
        return Some((span.min, span.max));
    }
    let min = [span.min, span.mean, span.max].into_iter().find(|value| *value > 0.0)?;
    Some((min, span.max))
}

/// The range of shots that shows a whole run of `shots` out of `planned` shots: from 0 to the next of 1, 2 and 5 times a power of ten, or
/// to the planned number if that is smaller. It changes seldom, because each change redraws everything.
pub fn whole(shots: u64, planned: Option<u64>) -> (f64, f64) {
    /// Size of the smallest range, shots.
    const FIRST: u64 = 1000;
    let next = Step::at_least(shots.max(FIRST) as f64).value();
    let planned = planned.filter(|planned| *planned >= shots.max(1)).map(|planned| planned as f64);
    (0.0, planned.map_or(next, |planned| planned.min(next)))
}

/// A sample of a curve for a legend.
pub fn curve_mark(role: CurveRole, theme: &Theme, caps: Capabilities) -> Span<'static> {
    let layer = match role {
        CurveRole::Main => Layer::Main,
        CurveRole::Compared => Layer::Compared,
    };
    grid::sample(layer, caps, theme)
}

/// Draws `chart` into `area`: its title in the first row, the value labels left of the plot, and the labels of shots in the last row if
/// requested.
pub fn draw_chart(chart: &Chart, area: Rect, ui: &mut Ui) {
    let area = area.intersection(ui.buffer.area);
    if area.is_empty() {
        return;
    }
    ui.buffer.set_style(area, ui.theme.text());
    let chart = &Chart { shots: sound(chart.shots), ..*chart };
    title::draw_chart_title(chart, area, ui);
    let below = below_title(area);
    let labelled = below.width >= LEFT + MIN_PLOT_WIDTH;
    let left = if labelled { LEFT } else { 0 };
    let with_shots = chart.with_shots && labelled && below.height > 1;
    let plot =
        Rect { x: below.x + left, width: below.width - left, height: below.height - u16::from(with_shots), ..below };
    if plot.is_empty() {
        return;
    }
    let mut grid = Grid::new(plot, ui.caps, ui.theme);
    if with_shots {
        draw_shots(chart, area, plot, &grid, ui);
    }
    let scale = chart.scale();
    if labelled {
        draw_values(scale.as_ref(), plot, &mut grid, ui);
    }
    if let Some(scale) = scale {
        draw_curves(chart, scale, &mut grid);
        grid.paint(ui);
    } else {
        let words = match (chart.has_points(), chart.log) {
            (false, _) => chart.note.unwrap_or("no data yet"),
            (true, true) => "no values above 0",
            (true, false) => "no finite values",
        };
        let row = plot.y + (plot.height - 1) / 2;
        let x = plot.x + plot.width.saturating_sub(columns(words) as u16) / 2;
        ui.buffer.set_stringn(x, row, words, usize::from(plot.right() - x), ui.theme.faint());
    }
}

/// Returns a finite range with a positive length.
fn sound(shots: (f64, f64)) -> (f64, f64) {
    let start = if shots.0.is_finite() { shots.0.clamp(-1e18, 1e18) } else { 0.0 };
    let end = if shots.1.is_finite() { shots.1.clamp(-1e18, 1e18) } else { 0.0 };
    // Above 2^53, adding one shot would not change the number.
    if end - start >= 1.0 { (start, end) } else { (start, start + 1.0_f64.max(start.abs() * 1e-9)) }
}

fn draw_curves(chart: &Chart, scale: Scale, grid: &mut Grid) {
    let frame = Frame { shots: chart.shots, scale };
    for curve in chart.ordered() {
        let (line, band) = match curve.role {
            CurveRole::Main => (Layer::Main, Layer::MainBand),
            CurveRole::Compared => (Layer::Compared, Layer::ComparedBand),
        };
        let length = chart.length();
        frame.draw_values(curve.points, if length.is_some() { band } else { line }, grid);
        if let Some(length) = length {
            frame.draw_smoothed(curve.points, length, line, grid);
        }
    }
}

/// Draws the value axis with its labels, and the grid lines.
fn draw_values(scale: Option<&Scale>, plot: Rect, grid: &mut Grid, ui: &mut Ui) {
    let axis = plot.x - 1;
    for row in plot.y..plot.bottom() {
        ui.buffer.set_string(axis, row, ui.caps.pick("│", "|"), ui.theme.rule());
    }
    for tick in scale.map_or(Vec::new(), |scale| scale.ticks(plot.height)) {
        let y = Frame::row_at(tick.at, grid).round() as i32;
        let row = plot.y + grid.row_of(y).min(plot.height - 1);
        grid.set_line(y);
        ui.buffer.set_string(axis, row, ui.caps.pick("┤", "+"), ui.theme.rule());
        write_right(ui.buffer, plot.x - LEFT, axis, row, &tick.label, ui.theme.faint());
    }
}

/// Draws the labels of shots below the plot.
fn draw_shots(chart: &Chart, area: Rect, plot: Rect, grid: &Grid, ui: &mut Ui) {
    let (mut free, mut first) = (area.x, None);
    for tick in shot_ticks(chart.shots, plot.width) {
        let column = plot.x + grid.column_of((tick.at * f64::from(grid.size().0 - 1)).round() as i32);
        let width = tick.label.len() as u16;
        let end = (column + 1 + width / 2).min(area.right());
        if let Some(start) = end.checked_sub(width).filter(|start| *start >= free) {
            ui.buffer.set_stringn(start, plot.bottom(), &tick.label, usize::from(width), ui.theme.faint());
            free = end + 1;
            first = first.or(Some(start));
        }
    }
    let unit = area.x + 1;
    if first.is_some_and(|first| first > unit + chart.unit.len() as u16) {
        ui.buffer.set_string(unit, plot.bottom(), chart.unit, ui.theme.faint());
    }
}

#[cfg(test)]
mod tests;
