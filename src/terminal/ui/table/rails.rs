//! The rails around the cloth: wood outside, the cushion's rubber inside, sights, and where the selected ball lies.

use glam::DVec2;
use ratatui::{
    buffer::Buffer,
    style::{Color, Modifier, Style},
    symbols::pixel::{OCTANTS, SEXTANTS},
};

use crate::terminal::{
    Capabilities, Glyphs, Mapping,
    ui::{Theme, Ui, geometry::RAIL_COLUMNS},
};

/// Draws the rails, the sights at every `diamond`, m, and pointers to `marked`, a place on the table.
pub fn draw_rails(mapping: &Mapping, diamond: f64, marked: Option<DVec2>, ui: &mut Ui) {
    let rails = Rails { mapping, theme: ui.theme, caps: ui.caps };
    if ui.caps.glyphs == Glyphs::Letters {
        rails.lines(ui);
    } else {
        rails.blocks(ui);
    }
    rails.sights(diamond, ui);
    if let Some(place) = marked {
        rails.pointers(place, ui);
    }
}

fn put(buffer: &mut Buffer, x: u16, y: u16, symbol: char, front: Color, back: Color) {
    if let Some(cell) = buffer.cell_mut((x, y)) {
        cell.set_char(symbol).set_style(Style::new().fg(front).bg(back));
    }
}

struct Rails<'a> {
    mapping: &'a Mapping,
    theme: &'a Theme,
    caps: Capabilities,
}

impl Rails<'_> {
    fn blocks(&self, ui: &mut Ui) {
        let (bed, outer) = (self.mapping.bed, self.mapping.outer());
        let (wood, cushion) = (self.theme.wood, self.theme.cushion);
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

    /// The rails where there are no blocks to paint with.
    fn lines(&self, ui: &mut Ui) {
        let (bed, background) = (self.mapping.bed, self.theme.background);
        let wood = if self.theme.is_mono() { Color::Reset } else { self.theme.faint };
        let (left, right) = (bed.x - 1, bed.right());
        for x in bed.x..bed.right() {
            for y in [bed.y - 1, bed.bottom()] {
                put(ui.buffer, x, y, self.caps.pick('═', '='), wood, background);
            }
        }
        for y in bed.y..bed.bottom() {
            for x in [left, right] {
                put(ui.buffer, x, y, self.caps.pick('║', '|'), wood, background);
            }
        }
        for (x, y, symbol) in
            [(left, bed.y - 1, '╔'), (right, bed.y - 1, '╗'), (left, bed.bottom(), '╚'), (right, bed.bottom(), '╝')]
        {
            put(ui.buffer, x, y, self.caps.pick(symbol, '+'), wood, background);
        }
    }

    fn sights(&self, diamond: f64, ui: &mut Ui) {
        let (bed, scale) = (self.mapping.bed, self.mapping.scale());
        let letters = self.caps.glyphs == Glyphs::Letters;
        let symbol = |blocks: char| if letters { self.caps.pick('◆', 'o') } else { blocks };
        let behind = if letters { self.theme.background } else { self.theme.cushion };
        // From both ends inwards, so that the picture is as symmetric as the table.
        for n in 1..=4 {
            let column = (diamond * f64::from(n) * scale.x) as u16;
            if 2 * column > bed.width {
                break;
            }
            for x in [bed.x + column.min(bed.width - 1), bed.right() - 1 - column.min(bed.width - 1)] {
                // The one in the middle would be two.
                if 2 * column == bed.width && x < bed.x + column {
                    continue;
                }
                put(ui.buffer, x, bed.y - 1, symbol('▀'), self.theme.sight, behind);
                put(ui.buffer, x, bed.bottom(), symbol('▄'), self.theme.sight, behind);
            }
        }
        let behind = if letters { self.theme.background } else { self.theme.wood };
        let mut n = 1.0;
        while diamond * n * scale.y < f64::from(bed.height) - 0.5 {
            let row = diamond * n * scale.y;
            let block = self.part_of_row(row);
            let inset = if letters { 1 } else { RAIL_COLUMNS };
            for x in [bed.x - inset, bed.right() + inset - 1] {
                put(ui.buffer, x, bed.y + row as u16, symbol(block), self.theme.sight, behind);
            }
            n += 1.0;
        }
    }

    /// Marks in the cushions, or between the signs of the rails, where the lines through `place` meet them.
    fn pointers(&self, place: DVec2, ui: &mut Ui) {
        let (bed, (x, y)) = (self.mapping.bed, self.mapping.to_cell(place));
        if self.caps.glyphs == Glyphs::Letters {
            for (x, y, symbol, plain) in [
                (x, bed.y - 1, '▼', 'v'),
                (x, bed.bottom(), '▲', '^'),
                (bed.x - 1, y, '▶', '>'),
                (bed.right(), y, '◀', '<'),
            ] {
                put(ui.buffer, x, y, self.caps.pick(symbol, plain), self.theme.accent, self.theme.background);
                ui.buffer[(x, y)].modifier.insert(Modifier::BOLD);
            }
            return;
        }
        // The wood or the sight in the cell's outer half stays.
        for y in [bed.y - 1, bed.bottom()] {
            ui.buffer[(x, y)].set_bg(self.theme.mark);
        }
        let block = self.part_of_row(self.mapping.to_cells(place).y);
        for x in [bed.x - 1, bed.right()] {
            put(ui.buffer, x, y, block, self.theme.mark, self.theme.cushion);
        }
    }

    /// The block that is nearest to `row` inside its cell.
    fn part_of_row(&self, row: f64) -> char {
        let part = |parts: f64| (row.fract() * parts) as usize;
        match self.caps.glyphs {
            Glyphs::Octant => OCTANTS[0b11 << (2 * part(4.0))],
            Glyphs::Sextant => SEXTANTS[0b11 << (2 * part(3.0))],
            _ if row.fract() < 0.5 => '▀',
            _ => '▄',
        }
    }
}
