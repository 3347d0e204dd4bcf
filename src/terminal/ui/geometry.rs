//! Layout of the table on the screen: the mapping between metres and cells, and the space next to the table.

use glam::DVec2;
use ratatui::layout::Rect;

use crate::table::Table;

/// Columns of the rail at each side of the cloth; the rails above and below have one row, which is as thick.
pub const RAIL_COLUMNS: u16 = 2;
/// Rows of a rail above and below the cloth.
pub const RAIL_ROWS: u16 = 1;
/// Number of columns that are as wide as one row is high.
const CELL_ASPECT: f64 = 2.0;

/// Position of the cloth on the screen, and the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mapping {
    /// Cells of the cloth, without the rails.
    pub bed: Rect,
    /// Length and width of the playing area, m.
    extent: DVec2,
    /// Ball radius, m.
    pub radius: f64,
}

impl Mapping {
    /// The largest table that fits into `area` to scale, rails included: at the top and horizontally centred. The bed is empty if there is
    /// no room for the rails and a row of cloth.
    pub fn fit(table: &Table, area: Rect) -> Self {
        let columns = area.width.saturating_sub(2 * RAIL_COLUMNS);
        let rows = area.height.saturating_sub(2 * RAIL_ROWS);
        let columns_per_row = CELL_ASPECT * table.length / table.width;
        let rows = rows.min((f64::from(columns) / columns_per_row).round() as u16);
        let columns = columns.min((f64::from(rows) * columns_per_row).round() as u16);
        let x = area.x + (area.width - columns.min(area.width)) / 2;
        let bed = Rect::new(x, area.y + RAIL_ROWS.min(area.height), columns, rows);
        Self { bed, extent: DVec2::new(table.length, table.width), radius: table.radius }
    }

    /// Cells of cloth and rails together.
    pub fn outer(&self) -> Rect {
        let Rect { x, y, width, height } = self.bed;
        Rect::new(
            x.saturating_sub(RAIL_COLUMNS),
            y.saturating_sub(RAIL_ROWS),
            width + 2 * RAIL_COLUMNS,
            height + 2 * RAIL_ROWS,
        )
    }

    /// Cells per metre, across and down.
    pub fn scale(&self) -> DVec2 {
        DVec2::new(f64::from(self.bed.width), f64::from(self.bed.height)) / self.extent
    }

    /// Converts a position on the table to cells from the bed's upper left corner; the fraction is the position inside the cell.
    pub fn to_cells(&self, place: DVec2) -> DVec2 {
        DVec2::new(place.x + 0.5 * self.extent.x, 0.5 * self.extent.y - place.y) * self.scale()
    }

    /// Whether a position is over the bed.
    pub fn is_on_bed(&self, place: DVec2) -> bool {
        (2.0 * place.abs()).cmple(self.extent).all()
    }

    /// The screen cell at a position on the table, or the nearest one on the bed.
    pub fn to_cell(&self, place: DVec2) -> (u16, u16) {
        let at = self.to_cells(place);
        let column = (at.x as u16).min(self.bed.width.saturating_sub(1));
        let row = (at.y as u16).min(self.bed.height.saturating_sub(1));
        (self.bed.x + column, self.bed.y + row)
    }

    /// The position on the table at the centre of a screen cell, m; `None` outside the bed.
    pub fn to_metres(&self, column: u16, row: u16) -> Option<DVec2> {
        self.bed.contains((column, row).into()).then(|| self.extended_metres(column, row)).flatten()
    }

    /// Like [`Self::to_metres`], but also outside the bed, so that the mouse can drag a ball to the cushions; `None` only if the bed is
    /// empty.
    pub fn extended_metres(&self, column: u16, row: u16) -> Option<DVec2> {
        let corner = DVec2::new(f64::from(self.bed.x), f64::from(self.bed.y));
        let from_corner = (DVec2::new(f64::from(column), f64::from(row)) + 0.5 - corner) / self.scale();
        let place = DVec2::new(from_corner.x - 0.5 * self.extent.x, 0.5 * self.extent.y - from_corner.y);
        (!self.bed.is_empty()).then_some(place)
    }

    /// Columns across a ball at true scale.
    pub fn ball_columns(&self) -> f64 {
        2.0 * self.radius * self.scale().x
    }
}

/// Splits `area` into the area of the table, a column to its right of the same height, and `below` free rows under both. The column takes
/// the width that the table does not need, within `widths` (smallest and largest, including the blank before it).
pub fn with_column(table: &Table, area: Rect, below: u16, widths: (u16, u16)) -> (Rect, Rect) {
    let room = Rect { width: area.width.saturating_sub(widths.0), height: area.height.saturating_sub(below), ..area };
    let outer = Mapping::fit(table, room).outer();
    let width = area.width.saturating_sub(outer.width).clamp(widths.0, widths.1) - 1;
    let left = area.right().saturating_sub(width);
    let room = Rect { width: left - 1 - area.x, ..room };
    let bottom = Mapping::fit(table, room).outer().bottom().min(area.bottom());
    (room, Rect::new(left, area.y, width, bottom - area.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_carom_table_is_four_times_as_many_columns_as_rows() {
        let mapping = Mapping::fit(&Table::default(), Rect::new(0, 0, 120, 29));
        assert_eq!((mapping.bed.width, mapping.bed.height), (108, 27));
        let mapping = Mapping::fit(&Table::default(), Rect::new(0, 1, 64, 40));
        assert_eq!(mapping.outer(), Rect::new(0, 1, 64, 17));
    }

    #[test]
    fn the_corners_of_the_table_are_the_corners_of_the_bed() {
        let table = Table::default();
        let mapping = Mapping::fit(&table, Rect::new(3, 2, 64, 17));
        let corner = 0.5 * DVec2::new(table.length, table.width);
        assert_eq!(mapping.to_cells(DVec2::new(-corner.x, corner.y)), DVec2::ZERO);
        assert_eq!(mapping.to_cell(DVec2::new(corner.x, -corner.y)), (64, 17));
    }

    #[test]
    fn an_area_without_room_gives_an_empty_bed() {
        for (width, height) in [(0, 0), (3, 10), (80, 2), (1, 1)] {
            assert!(Mapping::fit(&Table::default(), Rect::new(0, 0, width, height)).bed.is_empty());
        }
    }

    proptest! {
        #[test]
        fn cells_convert_to_metres_and_back(
            width in 10_u16..300, height in 5_u16..100, across in 0.0..1.0_f64, down in 0.0..1.0_f64,
        ) {
            let mapping = Mapping::fit(&Table::default(), Rect::new(5, 7, width, height));
            prop_assume!(!mapping.bed.is_empty());
            let column = mapping.bed.x + (across * f64::from(mapping.bed.width)) as u16;
            let row = mapping.bed.y + (down * f64::from(mapping.bed.height)) as u16;
            let place = mapping.to_metres(column, row).unwrap();
            prop_assert_eq!(mapping.to_cell(place), (column, row));
        }
    }
}
