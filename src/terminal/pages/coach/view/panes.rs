//! Screen layout of the coach page. Of two arrangements the one with the larger table wins; the one with panels next to the table has
//! a small disadvantage that it must overcome.

use ratatui::layout::Rect;

use crate::{
    table::Table,
    terminal::{
        Mapping,
        ui::{geometry::with_column, side_view_below, split},
    },
};

/// Rows of the panels if all of them are below the table: minimum (a title and seven lines), the screen height from which on they grow,
/// and maximum. They get one more row for every [`ROWS_PER_PANEL_ROW`] rows above that height.
const BELOW: (u16, u16, u16) = (8, 40, 12);
const ROWS_PER_PANEL_ROW: u16 = 5;
/// Rows of the panels below the table if there is a column next to it: a title and three balls.
const BELOW_BESIDE: u16 = 4;
/// Minimum and maximum width of the column next to the table.
const BESIDE: (u16, u16) = (16, 36);
/// Widths of the panels info, shot, tip, hit and events if they are side by side: the minimum, and with more room. The tip's panel may
/// be wider, up to [`MAX_TIP_WIDTH`].
const NARROW: [u16; 5] = [38, 32, 12, 12, 22];
const WIDE: [u16; 5] = [39, 33, 14, 16, 29];
const MAX_TIP_WIDTH: u16 = 18;
/// Width of each further info panel.
const MORE_WIDTH: u16 = 38;
/// Screen width from which on all of these fit.
const ALL_BELOW_WIDTH: u16 = width(NARROW);
/// Height of the panels from which on the hit is below the tip, and their width then, which holds both balls of the hit.
const STACKED_ROWS: u16 = 12;
const STACKED_WIDTH: u16 = 16;
/// Rows of the shot's numbers with their title. In a narrow column next to the table: the minimum, and the comfortable height if the
/// column has at least [`TALL`] rows. The third value is for a wide column.
const SHOT_ROWS: [u16; 3] = [7, 9, 8];
const TALL: u16 = 20;
/// Width of the column from which on its panels use their wide form.
const WIDE_COLUMN: u16 = 30;
/// Maximum rows of tip and hit, stacked and side by side. Then the rows of the hit below the tip: the minimum, and the number if both
/// together have at least [`MANY_ROWS`] rows.
const PRECISION_ROWS: (u16, u16) = (13, 10);
const HIT_ROWS: [u16; 2] = [4, 5];
const MANY_ROWS: u16 = 13;

/// Minimum size of the table with all panels below it, relative to the table with some panels next to it. Losing a twentieth is
/// acceptable for seeing several panels at once.
const MIN_RELATIVE_SIZE: f64 = 0.95;

/// The screen areas of the coach page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panes {
    /// The table with its rails, drawn as large as fits.
    pub table: Rect,
    /// The chosen info panel.
    pub info: Rect,
    /// Further info panels; empty if there is no room.
    pub more: [Rect; 2],
    /// The cue inputs and the impulse.
    pub shot: Rect,
    /// The cue ball's face.
    pub tip: Rect,
    /// The shooter's view of the first ball, next to or below the tip.
    pub hit: Rect,
    /// The list of the shot's events.
    pub events: Rect,
}

impl Panes {
    /// Divides `area` for `table`.
    pub fn new(table: &Table, area: Rect) -> Self {
        let below = Self::all_below(table, area);
        let beside = Self::some_beside(table, area);
        let rows = |panes: &Self| Mapping::fit(table, panes.table).bed.height;
        let is_large = f64::from(rows(&below)) >= MIN_RELATIVE_SIZE * f64::from(rows(&beside));
        if area.width >= ALL_BELOW_WIDTH && is_large { below } else { beside }
    }

    /// Whether there is a column of panels next to the table. Otherwise all panels are below it.
    pub const fn is_beside(&self) -> bool {
        self.shot.y < self.info.y
    }

    /// Returns the areas with room for the side view of a jump, and that room. If there is a column of panels next to the table, the
    /// view takes rows from the table. Otherwise it replaces the info panel and the shot's panel.
    pub fn with_side_view(self) -> (Self, Rect) {
        if !self.is_beside() {
            return (self, self.info.union(self.shot));
        }
        let (table, side) = side_view_below(self.table, self.info.y);
        (Self { table, ..self }, side)
    }

    /// All rows except the header and the last two, which are for messages and keys.
    fn middle(area: Rect) -> Rect {
        Rect::new(area.x, area.y + 1, area.width, area.height.saturating_sub(3))
    }

    fn all_below(table: &Table, area: Rect) -> Self {
        let middle = Self::middle(area);
        let (least, from, most) = BELOW;
        let rows = (least + area.height.saturating_sub(from) / ROWS_PER_PANEL_ROW).min(most);
        let room = Rect { height: middle.height.saturating_sub(rows), ..middle };
        let outer = Mapping::fit(table, room).outer();
        let top = outer.bottom().min(middle.bottom());
        let mut left = area.x;
        let mut panel = |width: u16| {
            let panel = Rect::new(left, top, width.min(area.right() - left), middle.bottom() - top);
            left = (left + width + u16::from(width > 0)).min(area.right());
            panel
        };
        let mut widths = if area.width >= width(WIDE) { WIDE } else { NARROW };
        let is_stacked = rows >= STACKED_ROWS;
        if is_stacked {
            widths = [WIDE[0], WIDE[1], STACKED_WIDTH, 0, WIDE[4]];
        }
        // The cue ball's face needs twice as many columns as rows, and its panel has a title row.
        let spare = area.width.saturating_sub(width(widths));
        let [info, shot, tip, hit, events] = widths;
        let tip = (tip + spare).min(2 * (rows - 1)).clamp(tip, MAX_TIP_WIDTH);
        let taken = width([info, shot, tip, hit, events]);
        let others = area.width.saturating_sub(taken) / (MORE_WIDTH + 1);
        let [info, shot, tip, hit] = [info, shot, tip, hit].map(&mut panel);
        let (tip, hit) = if is_stacked { stacked(tip) } else { (tip, hit) };
        let more = [1, 2].map(|n| panel(if n <= others { MORE_WIDTH } else { 0 }));
        let events = panel(area.width);
        Self { table: room, info, more, shot, tip, hit, events }
    }

    fn some_beside(table: &Table, area: Rect) -> Self {
        let middle = Self::middle(area);
        let (room, column) = with_column(table, middle, BELOW_BESIDE, BESIDE);
        let (bottom, rows) = (column.bottom(), column.height);
        let (least, easy, wide) = (SHOT_ROWS[0], SHOT_ROWS[1], SHOT_ROWS[2]);
        let is_wide = column.width >= WIDE_COLUMN;
        let (shot, most) = match () {
            () if is_wide => (wide, PRECISION_ROWS.1),
            () if rows >= TALL => (easy, PRECISION_ROWS.0),
            () => (least, PRECISION_ROWS.0),
        };
        let precision_rows = rows.saturating_sub(shot).min(most);
        let precision = Rect { y: bottom - precision_rows, height: precision_rows, ..column };
        let (tip, hit) = if is_wide { split(column.width / 2, precision).into() } else { stacked(precision) };
        let half = area.width / 2;
        let below = |x: u16, width: u16| Rect::new(area.x + x, bottom, width, middle.bottom() - bottom);
        Self {
            table: room,
            info: below(0, half),
            more: [Rect::ZERO; 2],
            shot: Rect { height: rows - precision_rows, ..column },
            tip,
            hit,
            events: below(half + 1, area.width - half - 1),
        }
    }
}

/// Total width of panels side by side, with a blank column between neighbours.
const fn width(panels: [u16; 5]) -> u16 {
    let [info, shot, tip, hit, events] = panels;
    info + shot + tip + hit + events + if hit > 0 { 4 } else { 3 }
}

/// Divides `area` into the tip and, below it, the hit.
fn stacked(area: Rect) -> (Rect, Rect) {
    let rows = HIT_ROWS[usize::from(area.height >= MANY_ROWS)].min(area.height);
    let tip = Rect { height: area.height - rows, ..area };
    (tip, Rect { y: tip.bottom(), height: rows, ..area })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bed(width: u16, height: u16) -> (u16, u16) {
        let table = Table::default();
        let bed = Mapping::fit(&table, Panes::new(&table, Rect::new(0, 0, width, height)).table).bed;
        (bed.width, bed.height)
    }

    #[test]
    fn table_is_as_large_as_panels_allow() {
        assert_eq!(bed(80, 24), (60, 15));
        assert_eq!(bed(120, 40), (108, 27));
        assert_eq!(bed(200, 60), (172, 43));
    }

    #[test]
    fn no_two_areas_overlap_at_any_size() {
        let table = Table::default();
        for width in 80..=240 {
            for height in 24..=80 {
                let panes = Panes::new(&table, Rect::new(0, 0, width, height));
                let table = Mapping::fit(&table, panes.table).outer();
                let Panes { info, more, shot, tip, hit, events, .. } = panes;
                let [header, status] = [0, height - 2].map(|y| Rect::new(0, y, width, 1));
                let hints = Rect { y: height - 1, ..header };
                let all = [header, table, info, shot, tip, hit, events, status, hints, more[0], more[1]];
                let (smaller, side) = panes.with_side_view();
                assert!(side.height >= 6 && side.width >= 60, "{width}×{height}: {side}");
                let small = Mapping::fit(&Table::default(), smaller.table).outer();
                assert!(small.intersection(side).is_empty() && small.height >= 8, "{width}×{height}: {small} {side}");
                assert!(table.union(info).union(shot).union(side) == table.union(info).union(shot), "{side}");
                for (n, one) in all.iter().enumerate() {
                    assert!(one.right() <= width && one.bottom() <= height, "{width}×{height} {n}");
                    assert!(n > 8 || !one.is_empty(), "{width}×{height} {n}");
                    for other in &all[n + 1..] {
                        assert!(one.intersection(*other).is_empty(), "{width}×{height}: {one} and {other}");
                    }
                }
            }
        }
    }
}
