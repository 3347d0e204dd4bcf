//! A grid of dots in layers over a rectangle of cells, and its conversion to characters. Charts do not use the table's
//! [`Canvas`](crate::terminal::ui::canvas::Canvas), because a braille cell holds eight dots of one colour: only the uppermost layer of a
//! cell is shown, otherwise one curve could be taken for the other.

use ratatui::{
    buffer::Cell,
    layout::Rect,
    style::{Color, Modifier, Style},
    symbols::braille::BRAILLE,
    text::Span,
};

use crate::terminal::{
    Capabilities, Glyphs,
    ui::{Theme, Ui},
};

/// Layers, from the lowest to the uppermost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Grid lines at the ticks.
    Lines,
    /// Raw values of the compared run, behind its mean.
    ComparedBand,
    /// Raw values of the run itself, behind its mean.
    MainBand,
    /// The compared run.
    Compared,
    /// The run itself.
    Main,
}

impl Layer {
    const ALL: [Self; 5] = [Self::Lines, Self::ComparedBand, Self::MainBand, Self::Compared, Self::Main];

    fn color(self, theme: &Theme) -> Color {
        match self {
            Self::Lines => theme.grid,
            Self::ComparedBand => theme.bands[1],
            Self::MainBand => theme.bands[0],
            Self::Compared => theme.curves[1],
            Self::Main => theme.curves[0],
        }
    }

    /// Style for character sets that show one layer per cell.
    fn style(self, theme: &Theme) -> Style {
        let style = theme.text().fg(self.color(theme));
        if theme.is_mono() && self != Self::Main { style.add_modifier(Modifier::DIM) } else { style }
    }

    /// The character if a cell is one dot; `None` for layers that could be taken for a curve.
    const fn mark(self, unicode: bool) -> Option<char> {
        match (self, unicode) {
            (Self::Main, true) => Some('•'),
            (Self::Compared, true) => Some('·'),
            (Self::Main, false) => Some('*'),
            (Self::Compared, false) => Some('.'),
            (Self::MainBand, _) => Some(':'),
            (Self::ComparedBand | Self::Lines, _) => None,
        }
    }
}

/// Character sets for the dots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dots {
    /// Two by four dots per cell.
    Braille,
    /// One by two dots per cell, each in its own colour.
    Halves,
    /// One dot per cell.
    Marks,
}

impl Dots {
    fn of(caps: Capabilities, theme: &Theme) -> Self {
        match caps.glyphs {
            Glyphs::Octant | Glyphs::Sextant if caps.unicode => Self::Braille,
            // Half blocks distinguish two curves only by colour.
            Glyphs::Half if caps.unicode && !theme.is_mono() => Self::Halves,
            _ => Self::Marks,
        }
    }

    const fn size(self) -> (u16, u16) {
        match self {
            Self::Braille => (2, 4),
            Self::Halves => (1, 2),
            Self::Marks => (1, 1),
        }
    }
}

/// Dots over a rectangle of cells.
#[derive(Clone, Debug)]
pub struct Grid {
    area: Rect,
    dots: Dots,
    unicode: bool,
    /// Whether grid lines can be distinguished from curves.
    lined: bool,
    /// The dots that are set, for each layer and cell: one bit per dot, row by row.
    cells: [Vec<u8>; Layer::ALL.len()],
}

impl Grid {
    /// An empty grid over `area`.
    pub fn new(area: Rect, caps: Capabilities, theme: &Theme) -> Self {
        let count = usize::from(area.width) * usize::from(area.height);
        let cells = std::array::from_fn(|_| vec![0; count]);
        Self { area, dots: Dots::of(caps, theme), unicode: caps.unicode, lined: !theme.is_mono(), cells }
    }

    /// Columns and rows of dots.
    pub fn size(&self) -> (i32, i32) {
        let (across, down) = self.dots.size();
        (i32::from(self.area.width) * i32::from(across), i32::from(self.area.height) * i32::from(down))
    }

    /// The row of cells that contains a row of dots, from the top of the grid.
    pub fn row_of(&self, y: i32) -> u16 {
        (y / i32::from(self.dots.size().1)) as u16
    }

    /// The column of cells that contains a column of dots, from the left of the grid.
    pub fn column_of(&self, x: i32) -> u16 {
        (x / i32::from(self.dots.size().0)) as u16
    }

    /// Sets the dots of column `x` from row `top` to row `bottom`, as far as they are on the grid.
    pub fn set_run(&mut self, layer: Layer, x: i32, top: i32, bottom: i32) {
        let (width, height) = self.size();
        if !(0..width).contains(&x) {
            return;
        }
        let (across, down) = self.dots.size();
        let (across, down) = (i32::from(across), i32::from(down));
        let (top, bottom) = (top.max(0), bottom.min(height - 1));
        if top > bottom {
            return;
        }
        // Cell by cell for speed: a curve consists of thousands of runs.
        for row in top / down..=bottom / down {
            let lines = (top - row * down).max(0)..=(bottom - row * down).min(down - 1);
            let bits = lines.fold(0, |bits, line| bits | 1 << (line * across + x % across));
            let cell = row as usize * usize::from(self.area.width) + (x / across) as usize;
            self.cells[layer as usize][cell] |= bits;
        }
    }

    /// Sets a sparse line of dots at row `y`, faint enough to stay behind everything else.
    pub fn set_line(&mut self, y: i32) {
        if !self.lined {
            return;
        }
        for x in (0..self.size().0).step_by(4) {
            self.set_run(Layer::Lines, x, y, y);
        }
    }

    /// Writes the cells that have dots into `buffer`.
    pub fn paint(&self, ui: &mut Ui) {
        for row in 0..self.area.height {
            for column in 0..self.area.width {
                let index = usize::from(row) * usize::from(self.area.width) + usize::from(column);
                if let Some(cell) = ui.buffer.cell_mut((self.area.x + column, self.area.y + row)) {
                    self.paint_cell(index, ui.theme, cell);
                }
            }
        }
    }

    fn uppermost(&self, index: usize, mask: u8) -> Option<Layer> {
        Layer::ALL.into_iter().rev().find(|layer| self.cells[*layer as usize][index] & mask != 0)
    }

    fn paint_cell(&self, index: usize, theme: &Theme, cell: &mut Cell) {
        let Some(layer) = self.uppermost(index, u8::MAX) else { return };
        match self.dots {
            Dots::Braille => {
                // The bits are the dots of the character, row by row.
                cell.set_char(BRAILLE[usize::from(self.cells[layer as usize][index])]).set_style(layer.style(theme));
            }
            Dots::Halves if layer == Layer::Lines => {
                cell.set_char('·').set_style(layer.style(theme));
            }
            Dots::Halves => {
                let half = |mask| self.uppermost(index, mask).filter(|layer| *layer != Layer::Lines);
                let color = |layer: Layer| layer.color(theme);
                match (half(1).map(color), half(2).map(color)) {
                    (Some(upper), Some(lower)) if upper == lower => cell.set_char('█').set_fg(upper),
                    (Some(upper), Some(lower)) => cell.set_char('▀').set_fg(upper).set_bg(lower),
                    (Some(upper), None) => cell.set_char('▀').set_fg(upper),
                    (None, Some(lower)) => cell.set_char('▄').set_fg(lower),
                    (None, None) => cell,
                };
            }
            Dots::Marks => {
                if let Some(mark) = layer.mark(self.unicode) {
                    cell.set_char(mark).set_style(layer.style(theme));
                }
            }
        }
    }
}

/// A sample of a layer for a legend, two cells wide.
pub fn sample(layer: Layer, caps: Capabilities, theme: &Theme) -> Span<'static> {
    let mark = match Dots::of(caps, theme) {
        Dots::Marks => layer.mark(caps.unicode).unwrap_or(' '),
        Dots::Braille | Dots::Halves => '━',
    };
    Span::styled(mark.to_string().repeat(2), layer.style(theme))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::{Depth, ui::drawn};

    #[test]
    fn only_the_upper_layer_of_two_curves_in_a_cell_is_drawn() {
        let caps = Capabilities::TRUE_COLOUR;
        let (theme, area) = (Theme::new(Depth::True), Rect::new(0, 0, 2, 1));
        let mut grid = Grid::new(area, caps, &theme);
        grid.set_run(Layer::Main, 0, 0, 0);
        grid.set_run(Layer::Compared, 1, -5, 100);
        grid.set_run(Layer::Compared, 3, 3, 3);
        grid.set_run(Layer::Main, 4, 0, 0);
        let buffer = drawn(area, caps, |ui| grid.paint(ui));
        assert_eq!((buffer[(0, 0)].symbol(), buffer[(0, 0)].fg), ("⠁", theme.curves[0]));
        assert_eq!((buffer[(1, 0)].symbol(), buffer[(1, 0)].fg), ("⢀", theme.curves[1]));
    }
}
