//! Which part of the screen is for what: the arrangement that leaves the table the most room wins, by a little for panels
//! beside it.

use ratatui::layout::Rect;

use crate::{table::Table, terminal::geometry::Mapping};

/// Rows of the panels below the table where all of them stand there: a title and seven lines at least; of every so many
/// rows beyond those of the second size one more is theirs, up to the third number.
const BELOW: (u16, u16, u16) = (8, 40, 12);
const ROWS_A_PANEL_ROW: u16 = 5;
/// Rows of the panels below the table where there is a column beside it: a title and three balls.
const BELOW_BESIDE: u16 = 4;
/// Columns beside the table: at least, and at most.
const BESIDE: (u16, u16) = (16, 36);
/// Columns of the panels of balls, shot and tip where they stand side by side; the tip's may be wider.
const INFO_WIDTH: u16 = 39;
const SHOT_WIDTH: u16 = 33;
const TIP_WIDTH: (u16, u16) = (16, 18);
/// Columns of what other views tell beside them.
const MORE_WIDTH: u16 = 38;
/// Columns that the events need for their longest words.
const EVENTS_WIDTH: u16 = 29;
/// Columns from which on the events find room beside these three.
const ALL_BELOW_WIDTH: u16 = INFO_WIDTH + SHOT_WIDTH + TIP_WIDTH.0 + EVENTS_WIDTH + 3;

/// How large the table has to be above all panels, against the one that has some beside it: a twentieth is a fair price for
/// several panels at once.
const LARGE: f64 = 0.95;

/// The areas of the coach's screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panes {
    /// The first row.
    pub header: Rect,
    /// Rails and cloth are drawn as large as fits in here.
    pub table: Rect,
    /// What the chosen view tells.
    pub info: Rect,
    /// What other views tell, where there is room; empty where there is none.
    pub more: [Rect; 2],
    /// The cue inputs and the impulse.
    pub shot: Rect,
    /// The cue ball's face.
    pub tip: Rect,
    /// What happens in the shot.
    pub events: Rect,
    /// The row above the hints; longer sentences may grow upwards into the panels.
    pub status: Rect,
    /// The keys.
    pub hints: Rect,
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

    fn frame(area: Rect) -> (Rect, Rect, Rect, Rect) {
        let row = |y| Rect::new(area.x, y, area.width, 1);
        let middle = Rect::new(area.x, area.y + 1, area.width, area.height.saturating_sub(3));
        (row(area.y), middle, row(middle.bottom()), row(middle.bottom() + 1))
    }

    fn all_below(table: &Table, area: Rect) -> Self {
        let (header, middle, status, hints) = Self::frame(area);
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
        let tip = (2 * rows).clamp(TIP_WIDTH.0, TIP_WIDTH.1);
        let taken = INFO_WIDTH + SHOT_WIDTH + tip + 3 + EVENTS_WIDTH;
        let others = area.width.saturating_sub(taken) / (MORE_WIDTH + 1);
        let [info, shot, tip] = [INFO_WIDTH, SHOT_WIDTH, tip].map(&mut panel);
        let more = [1, 2].map(|n| panel(if n <= others { MORE_WIDTH } else { 0 }));
        let events = panel(area.width);
        Self { header, table: room, info, more, shot, tip, events, status, hints }
    }

    fn some_beside(table: &Table, area: Rect) -> Self {
        let (header, middle, status, hints) = Self::frame(area);
        let room = Rect {
            width: middle.width.saturating_sub(BESIDE.0),
            height: middle.height.saturating_sub(BELOW_BESIDE),
            ..middle
        };
        let outer = Mapping::fit(table, room).outer();
        // What the table does not need goes to the column beside it, up to a width that is still good to read.
        let width = middle.width.saturating_sub(outer.width).clamp(BESIDE.0, BESIDE.1) - 1;
        let left = area.right().saturating_sub(width);
        let room = Rect { width: left - 1 - area.x, ..room };
        let outer = Mapping::fit(table, room).outer();
        let bottom = outer.bottom().min(middle.bottom());
        let tip_rows = BELOW.0.min((bottom - middle.y) / 2);
        let column = |y: u16, height: u16| Rect::new(left, y, width, height);
        let half = area.width / 2;
        let below = |x: u16, width: u16| Rect::new(area.x + x, bottom, width, middle.bottom() - bottom);
        Self {
            header,
            table: room,
            info: below(0, half),
            more: [Rect::ZERO; 2],
            shot: column(middle.y, bottom - middle.y - tip_rows),
            tip: column(bottom - tip_rows, tip_rows),
            events: below(half + 1, area.width - half - 1),
            status,
            hints,
        }
    }
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
                let Panes { header, info, more, shot, tip, events, status, hints, .. } = panes;
                let all = [header, table, info, shot, tip, events, status, hints, more[0], more[1]];
                for (n, one) in all.iter().enumerate() {
                    assert!(one.right() <= width && one.bottom() <= height, "{width}×{height} {n}");
                    assert!(n > 7 || !one.is_empty(), "{width}×{height} {n}");
                    for other in &all[n + 1..] {
                        assert!(one.intersection(*other).is_empty(), "{width}×{height}: {one} and {other}");
                    }
                }
            }
        }
    }
}
