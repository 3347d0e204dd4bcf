//! The rails around the cloth: wood outside, rubber inside, the sights, and pointers to the selected ball.

use glam::DVec2;
use ratatui::{
    buffer::Buffer,
    style::{Color, Modifier, Style},
    symbols::pixel::{OCTANTS, SEXTANTS},
};

use crate::terminal::{
    Glyphs, Mapping,
    ui::{Ui, geometry::RAIL_COLUMNS},
};

/// Draws the rails, the sights at every `diamond`, m, and pointers to `marked`, a position on the table.
pub fn draw_rails(mapping: &Mapping, diamond: f64, marked: Option<DVec2>, ui: &mut Ui) {
    if ui.caps.glyphs == Glyphs::Letters {
        draw_lines(mapping, ui);
    } else {
        draw_blocks(mapping, ui);
    }
    draw_sights(mapping, diamond, ui);
    if let Some(place) = marked {
        draw_pointers(mapping, place, ui);
    }
}

fn put(buffer: &mut Buffer, x: u16, y: u16, symbol: char, front: Color, back: Color) {
    if let Some(cell) = buffer.cell_mut((x, y)) {
        cell.set_char(symbol).set_style(Style::new().fg(front).bg(back));
    }
}

fn draw_blocks(mapping: &Mapping, ui: &mut Ui) {
    let (bed, outer) = (mapping.bed, mapping.outer());
    let (wood, cushion) = (ui.theme.wood, ui.theme.cushion);
    for x in outer.x + 1..outer.right() - 1 {
        put(ui.buffer, x, outer.y, '▀', wood, cushion);
        put(ui.buffer, x, bed.bottom(), '▄', wood, cushion);
    }
    for y in outer.y..outer.bottom() {
        for x in [outer.x, outer.right() - 1] {
            put(ui.buffer, x, y, ' ', wood, wood);
        }
    }
    for y in bed.y..bed.bottom() {
        for x in [outer.x + 1, bed.right()] {
            put(ui.buffer, x, y, ' ', wood, cushion);
        }
    }
}

/// Draws the rails as lines, for terminals without block characters.
fn draw_lines(mapping: &Mapping, ui: &mut Ui) {
    let (bed, background) = (mapping.bed, ui.theme.background);
    let wood = if ui.theme.is_mono() { Color::Reset } else { ui.theme.faint };
    let (left, right) = (bed.x - 1, bed.right());
    for x in bed.x..bed.right() {
        for y in [bed.y - 1, bed.bottom()] {
            put(ui.buffer, x, y, ui.caps.pick('═', '='), wood, background);
        }
    }
    for y in bed.y..bed.bottom() {
        for x in [left, right] {
            put(ui.buffer, x, y, ui.caps.pick('║', '|'), wood, background);
        }
    }
    for (x, y, symbol) in
        [(left, bed.y - 1, '╔'), (right, bed.y - 1, '╗'), (left, bed.bottom(), '╚'), (right, bed.bottom(), '╝')]
    {
        put(ui.buffer, x, y, ui.caps.pick(symbol, '+'), wood, background);
    }
}

fn draw_sights(mapping: &Mapping, diamond: f64, ui: &mut Ui) {
    let (bed, scale) = (mapping.bed, mapping.scale());
    let letters = ui.caps.glyphs == Glyphs::Letters;
    let symbol = |blocks: char| if letters { ui.caps.pick('◆', 'o') } else { blocks };
    let behind = if letters { ui.theme.background } else { ui.theme.cushion };
    // From both ends inwards, so that the picture is as symmetric as the table.
    for n in 1..=4 {
        let column = (diamond * f64::from(n) * scale.x) as u16;
        if 2 * column > bed.width {
            break;
        }
        for x in [bed.x + column.min(bed.width - 1), bed.right() - 1 - column.min(bed.width - 1)] {
            // The sight in the middle would be drawn twice.
            if 2 * column == bed.width && x < bed.x + column {
                continue;
            }
            put(ui.buffer, x, bed.y - 1, symbol('▀'), ui.theme.sight, behind);
            put(ui.buffer, x, bed.bottom(), symbol('▄'), ui.theme.sight, behind);
        }
    }
    let behind = if letters { ui.theme.background } else { ui.theme.wood };
    let mut n = 1.0;
    while diamond * n * scale.y < f64::from(bed.height) - 0.5 {
        let row = diamond * n * scale.y;
        let block = part_of_row(row, ui.caps.glyphs);
        let inset = if letters { 1 } else { RAIL_COLUMNS };
        for x in [bed.x - inset, bed.right() + inset - 1] {
            put(ui.buffer, x, bed.y + row as u16, symbol(block), ui.theme.sight, behind);
        }
        n += 1.0;
    }
}

/// Draws marks on the rails, level with `place` in both directions.
fn draw_pointers(mapping: &Mapping, place: DVec2, ui: &mut Ui) {
    let (bed, (x, y)) = (mapping.bed, mapping.to_cell(place));
    if ui.caps.glyphs == Glyphs::Letters {
        for (x, y, symbol, plain) in [
            (x, bed.y - 1, '▼', 'v'),
            (x, bed.bottom(), '▲', '^'),
            (bed.x - 1, y, '▶', '>'),
            (bed.right(), y, '◀', '<'),
        ] {
            put(ui.buffer, x, y, ui.caps.pick(symbol, plain), ui.mark(), ui.theme.background);
            ui.buffer[(x, y)].modifier.insert(Modifier::BOLD);
        }
        return;
    }
    // The wood or the sight in the outer half of the cell stays.
    for y in [bed.y - 1, bed.bottom()] {
        ui.buffer[(x, y)].set_bg(ui.theme.mark);
    }
    let block = part_of_row(mapping.to_cells(place).y, ui.caps.glyphs);
    for x in [bed.x - 1, bed.right()] {
        put(ui.buffer, x, y, block, ui.theme.mark, ui.theme.cushion);
    }
}

/// The block character nearest to the fraction of `row` inside its cell.
fn part_of_row(row: f64, glyphs: Glyphs) -> char {
    let part = |parts: f64| (row.fract() * parts) as usize;
    match glyphs {
        Glyphs::Octant => OCTANTS[0b11 << (2 * part(4.0))],
        Glyphs::Sextant => SEXTANTS[0b11 << (2 * part(3.0))],
        _ if row.fract() < 0.5 => '▀',
        _ => '▄',
    }
}
