//! A grid of sub-pixels that becomes block characters: two colours a cell, as octants, sextants or half blocks.

use ratatui::buffer::Buffer;
use ratatui::{
    layout::Rect,
    style::Color,
    symbols::pixel::{OCTANTS, SEXTANTS},
};

use crate::terminal::Glyphs;

/// Half blocks, indexed by the bits of the upper (1) and lower (2) half.
const HALVES: [char; 4] = [' ', '▀', '▄', '█'];
/// Most sub-pixels of a cell: those of an octant.
const MAX_SUB_PIXELS: usize = 8;

/// Colour of a sub-pixel. If a cell has more than two colours, those with the most weight are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ink {
    /// The colour.
    pub color: Color,
    /// Weight of one sub-pixel of this colour.
    pub weight: u8,
}

/// Sub-pixels over a rectangle of cells, initially all in the ground colour.
#[derive(Clone, Debug)]
pub struct Canvas {
    area: Rect,
    /// Sub-pixels per cell, across and down.
    grid: (u16, u16),
    ground: Color,
    pixels: Vec<Ink>,
}

impl Canvas {
    /// Creates a canvas of the colour `ground` over `area`. Letters have no sub-pixels and are drawn without a canvas.
    pub fn new(area: Rect, glyphs: Glyphs, ground: Color) -> Self {
        let grid = sub_pixels(glyphs);
        let count = usize::from(area.width * grid.0) * usize::from(area.height * grid.1);
        Self { area, grid, ground, pixels: vec![Ink { color: ground, weight: 0 }; count] }
    }

    /// Width and height in sub-pixels.
    pub fn size(&self) -> (i32, i32) {
        (i32::from(self.area.width * self.grid.0), i32::from(self.area.height * self.grid.1))
    }

    /// The cell of the sub-pixel at `x`, `y`, from the upper left one.
    pub fn cell_of(&self, x: i32, y: i32) -> (i32, i32) {
        (x.div_euclid(i32::from(self.grid.0)), y.div_euclid(i32::from(self.grid.1)))
    }

    /// Colours the sub-pixel at `x`, `y` if it is on the canvas.
    pub fn set(&mut self, x: i32, y: i32, ink: Ink) {
        let (width, height) = self.size();
        if (0..width).contains(&x) && (0..height).contains(&y) {
            self.pixels[(y * width + x) as usize] = ink;
        }
    }

    /// Writes the cells into `buffer`.
    pub fn paint(&self, buffer: &mut Buffer) {
        let stride = usize::from(self.area.width * self.grid.0);
        for row in 0..self.area.height {
            for column in 0..self.area.width {
                let first = usize::from(row * self.grid.1) * stride + usize::from(column * self.grid.0);
                let Some(cell) = buffer.cell_mut((self.area.x + column, self.area.y + row)) else { continue };
                let mut inks = [Ink { color: self.ground, weight: 0 }; MAX_SUB_PIXELS];
                let mut count = 0;
                for line in 0..usize::from(self.grid.1) {
                    for across in 0..usize::from(self.grid.0) {
                        inks[count] = self.pixels[first + line * stride + across];
                        count += 1;
                    }
                }
                let (symbol, front, back) = two_colours(&inks[..count], self.ground);
                cell.set_char(symbol).set_fg(front).set_bg(back);
            }
        }
    }
}

/// Sub-pixels per cell, across and down.
pub const fn sub_pixels(glyphs: Glyphs) -> (u16, u16) {
    match glyphs {
        Glyphs::Octant => (2, 4),
        Glyphs::Sextant => (2, 3),
        Glyphs::Half => (1, 2),
        Glyphs::Letters => (1, 1),
    }
}

/// Returns the block character with its foreground and background colours. If the cell has ground in it, the ground is the background, and
/// only the heaviest other colour is kept: a ball without its last corner looks better than one with a foreign spot.
fn two_colours(inks: &[Ink], ground: Color) -> (char, Color, Color) {
    let mut found = [(ground, 0_u16); MAX_SUB_PIXELS];
    let mut kinds = 0;
    for ink in inks.iter().filter(|ink| ink.color != ground) {
        let index = found[..kinds].iter().position(|(color, _)| *color == ink.color).unwrap_or_else(|| {
            found[kinds] = (ink.color, 0);
            kinds += 1;
            kinds - 1
        });
        found[index].1 += u16::from(ink.weight);
    }
    // The sort is stable, so the first colour wins a tie and the result is deterministic.
    found[..kinds].sort_by_key(|&(_, weight)| std::cmp::Reverse(weight));
    let front = found[0].0;
    let has_ground = inks.iter().any(|ink| ink.color == ground);
    match (kinds, has_ground) {
        (0, _) => return (' ', ground, ground),
        // Not a blank on the ball's colour: most neighbours have the ground as background, and each colour change costs bytes.
        (1, false) => return ('█', front, ground),
        _ => {}
    }
    let back = if has_ground { ground } else { found[1].0 };
    let mut bits = 0;
    for (n, ink) in inks.iter().enumerate() {
        bits |= usize::from(ink.color == front) << n;
    }
    let symbol = match inks.len() {
        8 => OCTANTS[bits],
        6 => SEXTANTS[bits],
        _ => HALVES[bits & 3],
    };
    (symbol, front, back)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUND: Ink = Ink { color: Color::Blue, weight: 0 };
    const BALL: Ink = Ink { color: Color::Red, weight: 4 };
    const DOT: Ink = Ink { color: Color::White, weight: 1 };

    #[test]
    fn a_cell_of_one_colour_is_a_coloured_blank() {
        assert_eq!(two_colours(&[GROUND; 6], GROUND.color), (' ', Color::Blue, Color::Blue));
        assert_eq!(two_colours(&[BALL; 6], GROUND.color), ('█', Color::Red, Color::Blue));
    }

    #[test]
    fn sub_pixels_become_the_character_with_the_same_shape() {
        let left = [BALL, GROUND, BALL, GROUND, BALL, GROUND];
        assert_eq!(two_colours(&left, GROUND.color), ('▌', Color::Red, Color::Blue));
        assert_eq!(two_colours(&[GROUND, BALL], GROUND.color), ('▄', Color::Red, Color::Blue));
    }

    #[test]
    fn each_pattern_of_octants_has_a_character_of_its_own() {
        let character = |bits: usize| {
            let inks: [Ink; 8] = std::array::from_fn(|n| if bits >> n & 1 == 1 { BALL } else { GROUND });
            two_colours(&inks, GROUND.color).0
        };
        let all: std::collections::BTreeSet<char> = (0..256).map(character).collect();
        assert_eq!(all.len(), 256);
        // Octants are numbered row by row from the upper left. Shapes that Unicode already had are not among them.
        for (octants, expected) in [
            (&[3][..], '\u{1CD00}'),
            (&[2, 3], '\u{1CD01}'),
            (&[2, 3, 4, 5, 6, 7, 8], '\u{1CDE5}'),
            (&[1], '\u{1CEA8}'),
            (&[8], '\u{1CEA0}'),
            (&[3, 5], '\u{1FBE6}'),
            (&[4, 6], '\u{1FBE7}'),
            (&[1, 2], '\u{1FB82}'),
            (&[7, 8], '▂'),
            (&[1, 3], '▘'),
            (&[1, 3, 5, 7], '▌'),
            (&[5, 6, 7, 8], '▄'),
        ] {
            assert_eq!(character(octants.iter().map(|octant| 1 << (octant - 1)).sum()), expected, "{octants:?}");
        }
    }

    #[test]
    fn a_dot_yields_to_a_ball_in_the_same_cell() {
        let cell = [BALL, BALL, DOT, GROUND, GROUND, GROUND];
        let (symbol, front, back) = two_colours(&cell, GROUND.color);
        assert_eq!((front, back), (Color::Red, Color::Blue));
        assert_eq!(symbol, SEXTANTS[0b11]);
    }

    #[test]
    fn two_balls_in_one_cell_keep_both_colours() {
        let other = Ink { color: Color::Yellow, weight: 4 };
        let cell = [BALL, BALL, BALL, BALL, other, other];
        assert_eq!(two_colours(&cell, GROUND.color), (SEXTANTS[0b1111], Color::Red, Color::Yellow));
    }

    #[test]
    fn pixels_outside_the_canvas_are_ignored() {
        let area = Rect::new(0, 0, 2, 2);
        let mut canvas = Canvas::new(area, Glyphs::Sextant, Color::Blue);
        for (x, y) in [(-1, 0), (4, 0), (0, 6), (i32::MAX, i32::MIN)] {
            canvas.set(x, y, BALL);
        }
        canvas.set(0, 0, BALL);
        let mut buffer = Buffer::empty(area);
        canvas.paint(&mut buffer);
        assert_eq!(buffer[(0, 0)].symbol(), "🬀");
        assert_eq!(buffer[(1, 1)].symbol(), " ");
    }
}
