//! Which part of the screen is for what: the arrangement that leaves the table the most room wins, by a little for panels
//! beside it.

use ratatui::layout::Rect;

use crate::{
    table::Table,
    terminal::{
        Mapping,
        ui::{geometry::with_column, side_view_below, split},
    },
};

/// Rows of the panels below the table where all of them stand there: a title and seven lines at least; of every so many
/// rows beyond those of the second size one more is theirs, up to the third number.
const BELOW: (u16, u16, u16) = (8, 40, 12);
const ROWS_A_PANEL_ROW: u16 = 5;
/// Rows of the panels below the table where there is a column beside it: a title and three balls.
const BELOW_BESIDE: u16 = 4;
/// Columns beside the table: at least, and at most.
const BESIDE: (u16, u16) = (16, 36);
/// Columns of what an info panel tells, of the shot, the tip, the hit and the events where they stand side by side: where there is
/// just room for them, and where there is more. The tip's may be wider.
const NARROW: [u16; 5] = [38, 32, 12, 12, 22];
const WIDE: [u16; 5] = [39, 33, 14, 16, 29];
const MOST_TIP_WIDTH: u16 = 18;
/// Columns of what other info panels tell beside them.
const MORE_WIDTH: u16 = 38;
/// Columns from which on all of these find room.
const ALL_BELOW_WIDTH: u16 = width(NARROW);
/// Rows of the panels from which on the hit stands below the tip, in columns that are as wide as both of its balls.
const STACKED_ROWS: u16 = 12;
const STACKED_WIDTH: u16 = 16;
/// Rows of the shot's numbers with their title where the column beside the table is narrow: as few as hold them all, and as
/// many as are easy to read, where the column has rows enough; and where it is wide.
const SHOT_ROWS: [u16; 3] = [7, 9, 8];
const TALL: u16 = 20;
/// Columns of a column from which on its panels are the wide ones.
const WIDE_COLUMN: u16 = 30;
/// Most rows of tip and hit, one below the other and side by side, and those of the hit below the tip: at least, and where
/// there are more than so many for both.
const PRECISION_ROWS: (u16, u16) = (13, 10);
const HIT_ROWS: [u16; 2] = [4, 5];
const MANY_ROWS: u16 = 13;

/// How large the table has to be above all panels, against the one that has some beside it: a twentieth is a fair price for
/// several panels at once.
const LARGE: f64 = 0.95;

/// The areas of the coach's screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panes {
    /// Rails and cloth are drawn as large as fits in here.
    pub table: Rect,
    /// What the chosen info panel tells.
    pub info: Rect,
    /// What other info panels tell, where there is room; empty where there is none.
    pub more: [Rect; 2],
    /// The cue inputs and the impulse.
    pub shot: Rect,
    /// The cue ball's face.
    pub tip: Rect,
    /// The shooter's view of the first ball; beside or below the tip.
    pub hit: Rect,
    /// What happens in the shot.
    pub events: Rect,
}

impl Panes {
    /// Divides `area` for `table`.
    pub fn new(table: &Table, area: Rect) -> Self {
        let below = Self::all_below(table, area);
        let beside = Self::some_beside(table, area);
        let rows = |panes: &Self| Mapping::fit(table, panes.table).bed.height;
        let is_large = f64::from(rows(&below)) >= LARGE * f64::from(rows(&beside));
        if area.width >= ALL_BELOW_WIDTH && is_large { below } else { beside }
    }

    /// Whether a column of panels stands beside the table; else all stand below.
    pub const fn is_beside(&self) -> bool {
        self.shot.y < self.info.y
    }

    /// The same with room for a jump from the side, and that room: below the table where panels stand beside it, which takes rows
    /// from the table, else in the place of the info panel and the shot's.
    pub fn with_side_view(self) -> (Self, Rect) {
        if !self.is_beside() {
            return (self, self.info.union(self.shot));
        }
        let (table, side) = side_view_below(self.table, self.info.y);
        (Self { table, ..self }, side)
    }

    /// All rows but the first, which is the header's, and the last two, for news and keys.
    fn middle(area: Rect) -> Rect {
        Rect::new(area.x, area.y + 1, area.width, area.height.saturating_sub(3))
    }

    fn all_below(table: &Table, area: Rect) -> Self {
        let middle = Self::middle(area);
        let (least, from, most) = BELOW;
        let rows = (least + area.height.saturating_sub(from) / ROWS_A_PANEL_ROW).min(most);
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
        // A face is twice as many columns as rows, and its panel has a title.
        let spare = area.width.saturating_sub(width(widths));
        let [info, shot, tip, hit, events] = widths;
        let tip = (tip + spare).min(2 * (rows - 1)).clamp(tip, MOST_TIP_WIDTH);
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

/// Columns of panels side by side, with a blank between every two that are there.
const fn width(panels: [u16; 5]) -> u16 {
    let [info, shot, tip, hit, events] = panels;
    info + shot + tip + hit + events + if hit > 0 { 4 } else { 3 }
}

/// Tip and hit one below the other.
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
    fn the_table_is_as_large_as_the_panels_allow() {
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
