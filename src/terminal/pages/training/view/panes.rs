//! Screen layout of a watched run: charts above, numbers and the replay below.

use ratatui::layout::Rect;

use crate::{
    table::Table,
    terminal::{Mapping, ui::split},
};

/// Rows below the charts on the smallest screen: a title and eight lines.
const BELOW: u16 = 9;
/// Rows of the smallest screen for the charts and the panels below.
const MIN_ROWS: u16 = 21;
/// Minimum and maximum width of the numbers, columns.
const NUMBERS: (u16, u16) = (44, 72);
/// Minimum width of a chart if several are side by side, columns.
const MIN_CHART_WIDTH: u16 = 26;
/// Ideal ratio of a chart's columns to its rows.
const BEST_ASPECT: f64 = 5.0;
/// Penalty for each chart that is missing in the last row, compared with the logarithm of the deviation from [`BEST_ASPECT`].
const MISSING_CHART_PENALTY: f64 = 0.3;

/// The screen areas of a watched run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panes {
    /// The charts.
    pub charts: Rect,
    /// The numbers.
    pub numbers: Rect,
    /// The small table with its title.
    pub replay: Rect,
}

impl Panes {
    /// Divides `area` for a run on `table`.
    pub fn new(table: &Table, area: Rect) -> Self {
        let rows = BELOW + area.height.saturating_sub(MIN_ROWS) * 3 / 8;
        let rows = rows.min(area.height);
        let charts = Rect { height: area.height - rows, ..area };
        let below = Rect { y: charts.bottom(), height: rows, ..area };
        let room = Rect { height: rows.saturating_sub(1), width: area.width.saturating_sub(NUMBERS.0), ..below };
        let table = Mapping::fit(table, room).outer().width.min(room.width);
        let numbers = area.width.saturating_sub(table + 1).min(NUMBERS.1);
        let [numbers, replay] = split(numbers, below);
        Self { charts, numbers, replay }
    }
}

/// Divides `area` into `count` charts in rows of equal height, and tells for each whether it is in the last row. That row is one line
/// higher, for the numbers of shots on the axis.
pub fn grid(count: usize, area: Rect) -> Vec<(Rect, bool)> {
    let count = count.min(usize::from(u16::MAX)) as u16;
    if count == 0 || area.is_empty() {
        return Vec::new();
    }
    let plots = area.height.saturating_sub(1);
    let rows_of = |columns: u16| count.div_ceil(columns);
    let penalty = |columns: u16| {
        let (width, height) = (area.width / columns, (plots / rows_of(columns)).max(1));
        let lone = columns * rows_of(columns) - count;
        (f64::from(width) / f64::from(height) / BEST_ASPECT).ln().abs() + MISSING_CHART_PENALTY * f64::from(lone)
    };
    let fits = |columns: &u16| *columns == 1 || area.width / columns >= MIN_CHART_WIDTH;
    let columns = (1..=count).filter(fits).min_by(|&one, &other| penalty(one).total_cmp(&penalty(other))).unwrap_or(1);
    let rows = rows_of(columns);
    let mut all = Vec::new();
    for row in 0..rows {
        let (top, bottom) = (plots * row / rows, plots * (row + 1) / rows);
        let is_last = row + 1 == rows;
        let height = bottom - top + u16::from(is_last && area.height > 0);
        let charts = if is_last { count - row * columns } else { columns };
        for column in 0..charts {
            let edge = |n: u16| (u32::from(area.width) * u32::from(n) / u32::from(charts)) as u16;
            let (left, right) = (edge(column), edge(column + 1));
            // There is a blank column between neighbours.
            let gap = u16::from(column + 1 < charts);
            let width = (right - left).saturating_sub(gap);
            all.push((Rect::new(area.x + left, area.y + top, width, height), is_last));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_areas_overlap_at_any_size() {
        let table = Table::default();
        for width in 80..=240 {
            for height in 21..=77 {
                let area = Rect::new(0, 1, width, height);
                let Panes { charts, numbers, replay } = Panes::new(&table, area);
                let mut all = vec![numbers, replay];
                for count in 1..=9 {
                    all.truncate(2);
                    all.extend(grid(count, charts).iter().map(|(area, _)| *area));
                    assert_eq!(all.len(), count + 2);
                    for (n, one) in all.iter().enumerate() {
                        assert_eq!(one.intersection(area), *one, "{width}×{height} {count} {n}");
                        assert!(one.width >= 12 && one.height >= 2, "{width}×{height} {count} {n}: {one}");
                        for other in &all[n + 1..] {
                            assert!(one.intersection(*other).is_empty(), "{width}×{height} {count}: {one} {other}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn four_charts_form_a_grid_and_replay_uses_remaining_width() {
        for (width, height, table) in [(80, 21, 28), (120, 37, 52), (200, 57, 80)] {
            let area = Rect::new(0, 1, width, height);
            let panes = Panes::new(&Table::default(), area);
            let four = grid(4, panes.charts);
            assert_eq!(four.iter().filter(|(_, is_last)| *is_last).count(), 2, "{width}×{height}");
            let mapping = Mapping::fit(&Table::default(), Rect { height: panes.replay.height - 1, ..panes.replay });
            assert_eq!(mapping.outer().width, table, "{width}×{height}");
        }
    }
}
