//! Screen layout of an exercise. Of two arrangements the one with the larger table wins.

use ratatui::layout::Rect;

use crate::{
    table::Table,
    terminal::{
        Mapping,
        ui::{geometry::with_column, side_view_below},
    },
};

/// Rows of the panels if all of them are below the table: a title and seven lines.
const BELOW: u16 = 8;
/// Rows of the panels below the table if there is a column next to it: a title and four lines.
const BELOW_BESIDE: u16 = 5;
/// Minimum and maximum width of the column next to the table.
const BESIDE: (u16, u16) = (22, 36);
/// Widths of the stroke, the tip and the hit if all panels are side by side.
const STROKE_WIDTH: u16 = 22;
const TIP_WIDTH: u16 = 14;
const HIT_WIDTH: u16 = 12;
/// Width that the score's title needs.
const SCORE_WIDTH: u16 = 30;
/// Rows of the stroke's numbers with their title, and of the hit below the tip.
const STROKE_ROWS: u16 = 6;
const HIT_ROWS: u16 = 4;
/// Maximum rows of tip and hit together.
const PRECISION_ROWS: u16 = 13;
/// Fraction (numerator, denominator) of the width of aim and score that the aim gets.
const AIM: (u16, u16) = (3, 5);
/// Screen width from which on all panels fit side by side.
const ALL_BELOW_WIDTH: u16 = 112;

/// The screen areas of an exercise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panes {
    /// The table with its rails, drawn as large as fits.
    pub table: Rect,
    /// The numbers of the stroke.
    pub stroke: Rect,
    /// The cue ball's face.
    pub tip: Rect,
    /// The shooter's view of the first ball.
    pub hit: Rect,
    /// The first contact of the stroke, or its result.
    pub aim: Rect,
    /// The score.
    pub score: Rect,
}

impl Panes {
    /// Divides `area` for `table`.
    pub fn new(table: &Table, area: Rect) -> Self {
        let (below, beside) = (Self::all_below(table, area), Self::some_beside(table, area));
        let rows = |panes: &Self| Mapping::fit(table, panes.table).bed.height;
        if area.width >= ALL_BELOW_WIDTH && rows(&below) >= rows(&beside) { below } else { beside }
    }

    /// Returns the areas with room for the side view of a jump, and that room. If there is a column of panels next to the table, the
    /// view takes rows from the table. Otherwise it replaces the stroke's numbers, the tip and the hit.
    pub fn with_side_view(self) -> (Self, Rect) {
        if self.stroke.y >= self.aim.y {
            return (self, self.stroke.union(self.hit));
        }
        let (table, side) = side_view_below(self.table, self.aim.y);
        (Self { table, ..self }, side)
    }

    fn all_below(table: &Table, area: Rect) -> Self {
        let upper = Rect { height: area.height.saturating_sub(BELOW), ..area };
        let top = Mapping::fit(table, upper).outer().bottom().min(area.bottom());
        let panel = |x: u16, width: u16| {
            let left = (area.x + x).min(area.right());
            Rect::new(left, top, width.min(area.right() - left), area.bottom() - top)
        };
        let hit = STROKE_WIDTH + TIP_WIDTH + 2;
        let aim = hit + HIT_WIDTH + 1;
        let room = area.width.saturating_sub(aim + 1);
        let words = (room * AIM.0 / AIM.1).min(room.saturating_sub(SCORE_WIDTH));
        let score = aim + words + 1;
        Self {
            table: upper,
            stroke: panel(0, STROKE_WIDTH),
            tip: panel(STROKE_WIDTH + 1, TIP_WIDTH),
            hit: panel(hit, HIT_WIDTH),
            aim: panel(aim, words),
            score: panel(score, area.width.saturating_sub(score)),
        }
    }

    fn some_beside(table: &Table, area: Rect) -> Self {
        let (room, column) = with_column(table, area, BELOW_BESIDE, BESIDE);
        let bottom = column.bottom();
        let precision_rows = column.height.saturating_sub(STROKE_ROWS).min(PRECISION_ROWS);
        let hit_rows = HIT_ROWS.min(precision_rows);
        let aim = area.width * AIM.0 / AIM.1;
        let below = |x: u16, width: u16| Rect::new(area.x + x, bottom, width, area.bottom() - bottom);
        Self {
            table: room,
            stroke: Rect { height: column.height - precision_rows, ..column },
            tip: Rect { y: bottom - precision_rows, height: precision_rows - hit_rows, ..column },
            hit: Rect { y: bottom - hit_rows, height: hit_rows, ..column },
            aim: below(0, aim),
            score: below(aim + 1, area.width - aim - 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_areas_overlap_at_any_size() {
        let table = Table::default();
        for width in 80..=240 {
            for height in 21..=77 {
                let panes = Panes::new(&table, Rect::new(0, 1, width, height));
                let (smaller, side) = panes.with_side_view();
                assert!(
                    side.width >= 40 && side.height >= 6 && side.bottom() <= height + 1,
                    "{width}×{height}: {side}"
                );
                let rest = [Mapping::fit(&table, smaller.table).outer(), smaller.aim, smaller.score];
                assert!(rest.iter().all(|pane| pane.intersection(side).is_empty()), "{width}×{height}: {side}");
                let bed = Mapping::fit(&table, panes.table).outer();
                let all = [bed, panes.stroke, panes.tip, panes.hit, panes.aim, panes.score];
                for (n, one) in all.iter().enumerate() {
                    assert!(one.right() <= width && one.bottom() <= height + 1, "{width}×{height} {n}: {one}");
                    assert!(one.width >= 12 && one.height >= 4, "{width}×{height} {n}: {one}");
                    for other in &all[n + 1..] {
                        assert!(one.intersection(*other).is_empty(), "{width}×{height}: {one} and {other}");
                    }
                }
            }
        }
    }
}
