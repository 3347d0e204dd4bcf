//! Curves as runs of dots, without holes between neighbours and without losing a peak.

use crate::{
    learning::run::history::Point,
    terminal::ui::chart::{
        grid::{Grid, Layer},
        scale::Scale,
        smooth::smooth,
    },
};

/// Position of a point, in columns and rows of dots, with fractions.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Mark {
    /// First and last column.
    x: (f64, f64),
    /// Rows of the largest value, the mean and the smallest value.
    y: [f64; 3],
}

/// The visible ranges of a plot.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Shots at the left and right edge.
    pub shots: (f64, f64),
    /// The values.
    pub scale: Scale,
}

impl Frame {
    /// Draws all values of `points`: a bar from the smallest to the largest of each, joined with its neighbours except across gaps.
    pub fn draw_values(&self, points: &[Point], layer: Layer, grid: &mut Grid) {
        let marks: Vec<_> = points.iter().map(|point| self.mark(point, grid)).collect();
        draw(&marks, layer, grid);
    }

    /// Draws the exponential mean of `points` over `length` shots.
    pub fn draw_smoothed(&self, points: &[Point], length: f64, layer: Layer, grid: &mut Grid) {
        let mark = |(point, value): (&Point, Option<f64>)| {
            let (x, y) = (self.column(point.shots.1, grid), self.row(value?, grid)?);
            Some(Mark { x: (x, x), y: [y; 3] })
        };
        let marks: Vec<_> = points.iter().zip(smooth(points, length)).map(mark).collect();
        draw(&marks, layer, grid);
    }

    /// The row of dots at a fraction of the height, measured from the bottom.
    pub fn row_at(share: f64, grid: &Grid) -> f64 {
        (1.0 - share) * f64::from(grid.size().1 - 1)
    }

    fn mark(&self, point: &Point, grid: &Grid) -> Option<Mark> {
        let span = point.finite?;
        let top = self.row(span.max, grid)?;
        // If a logarithmic scale cannot show all values of the point, those that it can are shown.
        let middle = self.row(span.mean, grid).unwrap_or(top);
        let bottom = self.row(span.min, grid).unwrap_or(middle);
        let x = (self.column(point.shots.0, grid), self.column(point.shots.1, grid));
        Some(Mark { x, y: [top, middle, bottom] })
    }

    fn column(&self, shots: u64, grid: &Grid) -> f64 {
        (shots as f64 - self.shots.0) / (self.shots.1 - self.shots.0) * f64::from(grid.size().0 - 1)
    }

    fn row(&self, value: f64, grid: &Grid) -> Option<f64> {
        self.scale.fraction(value).map(|share| Self::row_at(share, grid))
    }
}

/// Draws successive marks; `None` is a gap.
fn draw(marks: &[Option<Mark>], layer: Layer, grid: &mut Grid) {
    let mut before: Option<Mark> = None;
    for (n, mark) in marks.iter().enumerate() {
        if let Some(mark) = mark {
            let alone = before.is_none() && marks.get(n + 1).is_none_or(Option::is_none);
            block(mark, alone, layer, grid);
            if let Some(before) = before {
                join((before.x.1, before.y[1]), (mark.x.0, mark.y[1]), layer, grid);
            }
        }
        before = *mark;
    }
}

/// Fills a mark's columns from its largest to its smallest value. With small dots, a mark without neighbours gets an extra row and column
/// to be visible.
fn block(mark: &Mark, alone: bool, layer: Layer, grid: &mut Grid) {
    let width = grid.size().0;
    let (first, last) = (dot(mark.x.0), dot(mark.x.1));
    let (top, bottom) = (dot(mark.y[0]), dot(mark.y[2]));
    let more = i32::from(alone && grid.column_of(1) == 0);
    for x in first.max(0)..=last.saturating_add(more).min(width - 1) {
        grid.set_run(layer, x, top - more, bottom);
    }
}

/// Joins two points without a hole.
fn join(from: (f64, f64), to: (f64, f64), layer: Layer, grid: &mut Grid) {
    let width = grid.size().0;
    let (first, last) = (dot(from.0), dot(to.0));
    let at = |x: f64| {
        let length = to.0 - from.0;
        let share = if length > 0.0 { ((x - from.0) / length).clamp(0.0, 1.0) } else { 1.0 };
        from.1 + (to.1 - from.1) * share
    };
    for x in first.max(0)..=last.min(width - 1) {
        // Half a column to either side; neighbouring columns round the same number at their common edge.
        let left = if x == first { from.1 } else { at(f64::from(x) - 0.5) };
        let right = if x == last { to.1 } else { at(f64::from(x) + 0.5) };
        grid.set_run(layer, x, dot(left.min(right)), dot(left.max(right)));
    }
}

/// Rounds to a dot; numbers far outside the grid stay outside.
fn dot(place: f64) -> i32 {
    const FAR: i32 = 1_000_000;
    let far = f64::from(FAR);
    // Truncating a positive number rounds without a call into the mathematics library; there would be thousands of calls.
    (place.clamp(-far, far) + far + 0.5) as i32 - FAR
}
