//! Numbers on the rails: the order of the cue ball's cushions, and the diamond counts at the corners.

use glam::DVec2;
use ratatui::style::Modifier;

use crate::{
    coach::{Cushion, ShotWords},
    simulation::Rail,
    table::Table,
    terminal::{Glyphs, Mapping, ui::Ui},
};

/// Most cushions that get a number: each number must be one digit.
const NUMBERED: usize = 9;

/// Writes 1, 2, 3 … where the cue ball meets cushions before the second object ball: outside the cloth, so that no ball is hidden.
pub fn draw_cushions(words: &ShotWords, table: &Table, mapping: &Mapping, ui: &mut Ui) {
    let back = if ui.caps.glyphs == Glyphs::Letters { ui.theme.background } else { ui.theme.cushion };
    let style = ui.theme.text().fg(ui.mark()).bg(back).add_modifier(Modifier::BOLD);
    let cushions = words.before.iter().chain(&words.between).take(NUMBERED);
    for (cell, number) in cells(cushions, table, mapping).into_iter().zip(1..) {
        ui.buffer.set_string(cell.0, cell.1, number.to_string(), style);
    }
}

/// Writes 0 at the lower left corner, where the diamonds are counted from, and the number of diamonds at the two corners next to it.
pub fn draw_counts(table: &Table, mapping: &Mapping, ui: &mut Ui) {
    let bed = mapping.bed;
    let back = if ui.caps.glyphs == Glyphs::Letters { ui.theme.background } else { ui.theme.wood };
    let style = ui.theme.text().fg(ui.theme.sight).bg(back);
    let [long, short] = [table.length, table.width].map(|side| (side / table.diamond()).round().to_string());
    let (left, right, below) = (bed.x - 1, bed.right(), bed.bottom());
    for (x, y, count) in [(left, below, "0"), (right, below, &*long), (left, bed.y - 1, &*short)] {
        ui.buffer.set_stringn(x, y, count, 1, style);
    }
}

/// Offsets along the rail, in cells, tried for a number whose cell is taken, nearest first: one for each number.
const OFFSETS: [i16; NUMBERED] = [0, 1, -1, 2, -2, 3, -3, 4, -4];

/// The cells of the numbers, all different: a number whose cell is taken moves along its rail.
fn cells<'a>(cushions: impl Iterator<Item = &'a Cushion>, table: &Table, mapping: &Mapping) -> Vec<(u16, u16)> {
    let bed = mapping.bed;
    let mut taken = Vec::new();
    for cushion in cushions {
        let along = cushion.diamond * table.diamond();
        let from_middle = DVec2::splat(along) - 0.5 * DVec2::new(table.length, table.width);
        let (column, row) = mapping.to_cell(from_middle);
        let x = |way: i16| column.saturating_add_signed(way).clamp(bed.x, bed.right() - 1);
        let y = |way: i16| row.saturating_add_signed(way).clamp(bed.y, bed.bottom() - 1);
        let at = |way: i16| match cushion.rail {
            Rail::Top => (x(way), bed.y - 1),
            Rail::Bottom => (x(way), bed.bottom()),
            Rail::Left => (bed.x - 1, y(way)),
            Rail::Right => (bed.right(), y(way)),
        };
        taken.push(OFFSETS.map(at).into_iter().find(|cell| !taken.contains(cell)).unwrap_or_else(|| at(0)));
    }
    taken
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;

    #[test]
    fn cushion_numbers_lie_on_their_rails_without_overlap() {
        let table = Table::default();
        let mapping = Mapping::fit(&table, Rect::new(0, 0, 80, 20));
        let bed = mapping.bed;
        let cushion = |rail, diamond| Cushion { rail, diamond, along: 0.0 };
        let met = [
            cushion(Rail::Top, 4.0),
            cushion(Rail::Top, 4.01),
            cushion(Rail::Right, 0.0),
            cushion(Rail::Right, 0.0),
            cushion(Rail::Left, 4.0),
            cushion(Rail::Bottom, 8.0),
        ];
        let found = cells(met.iter(), &table, &mapping);
        let middle = bed.x + bed.width / 2;
        let lowest = bed.bottom() - 1;
        let wanted = [
            (middle, bed.y - 1),
            (middle + 1, bed.y - 1),
            (bed.right(), lowest),
            (bed.right(), lowest - 1),
            (bed.x - 1, bed.y),
            (bed.right() - 1, bed.bottom()),
        ];
        assert_eq!(found, wanted);
    }
}
