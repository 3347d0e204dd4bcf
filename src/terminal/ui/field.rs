//! A picture defined by a function of position: in sub-pixels, or in letters on terminals without them.

use glam::DVec2;
use ratatui::{
    layout::Rect,
    style::{Color, Modifier, Style},
};

use crate::terminal::{
    Capabilities, Glyphs,
    ui::{Canvas, Ink, Theme, Ui, canvas::sub_pixels},
};

/// Content of a picture at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Colour in sub-pixels.
    pub ink: Ink,
    /// Character if letters are drawn.
    pub letter: char,
    /// Style of that character.
    pub style: Style,
}

/// Paints `area` with the result of `mark` at each position. Its arguments are x to the right and y up from the middle, -1 to 1, and half
/// the height of a cell if letters are drawn (zero for sub-pixels). For `None`, sub-pixels get the colour `ground`; in letters, the old
/// content stays.
pub fn draw_field(area: Rect, ground: Color, ui: &mut Ui, mark: impl Fn(f64, f64, f64) -> Option<Mark>) {
    let place = |at: i32, size: i32| f64::from(2 * at + 1) / f64::from(size) - 1.0;
    if ui.caps.glyphs == Glyphs::Letters {
        let (width, height) = (i32::from(area.width), i32::from(area.height));
        for (y, row) in (0..height).zip(area.y..) {
            for (x, column) in (0..width).zip(area.x..) {
                if let Some(mark) = mark(place(x, width), -place(y, height), 1.0 / f64::from(height)) {
                    ui.buffer[(column, row)].set_char(mark.letter).set_style(mark.style);
                }
            }
        }
        return;
    }
    let mut canvas = Canvas::new(area, ui.caps.glyphs, ground);
    let (width, height) = canvas.size();
    for y in 0..height {
        for x in 0..width {
            if let Some(mark) = mark(place(x, width), -place(y, height), 0.0) {
                canvas.set(x, y, mark.ink);
            }
        }
    }
    canvas.paint(ui.buffer);
}

/// The largest ball face that fits into a panel. A row is as high as two columns are wide, so a circle has twice as many columns as rows.
/// In letters both numbers are odd, so that the centre is a letter.
pub fn face_in(inner: Rect, caps: Capabilities) -> Rect {
    let rows = inner.height.min(inner.width / 2);
    let [rows, columns] = match caps.glyphs {
        Glyphs::Letters => [rows.saturating_sub(u16::from(rows.is_multiple_of(2))), (2 * rows).saturating_sub(1)],
        _ => [rows, 2 * rows],
    };
    Rect::new(inner.x + (inner.width - columns) / 2, inner.y, columns, rows)
}

/// A spot in a picture. It consists of whole sub-pixels, so that its shape is the same everywhere; in letters it is one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundSpot {
    middle: DVec2,
    /// Half the width and height.
    half: DVec2,
    /// Lower left and upper right corners of the cells that the spot touches.
    cells: [DVec2; 2],
}

impl RoundSpot {
    /// Creates a spot of `radius` at `place` in the picture in `area`; both in units of half the picture.
    pub fn new(place: DVec2, radius: f64, area: Rect, caps: Capabilities) -> Self {
        let (across, down) = sub_pixels(caps.glyphs);
        let grid = DVec2::new(f64::from(across), f64::from(down));
        let size = grid * DVec2::new(f64::from(area.width), f64::from(area.height));
        let count =
            if caps.glyphs == Glyphs::Letters { DVec2::ONE } else { (radius * size).ceil().max(DVec2::splat(2.0)) };
        let corner = (0.5 * (place + 1.0) * size - 0.5 * count).round();
        let from_middle = |at: DVec2| 2.0 * at / size - 1.0;
        Self {
            middle: from_middle(corner + 0.5 * count),
            half: count / size,
            cells: [(corner / grid).floor(), ((corner + count) / grid).ceil()].map(|cell| from_middle(cell * grid)),
        }
    }

    /// Whether the spot covers a position.
    pub fn covers(&self, x: f64, y: f64) -> bool {
        ((DVec2::new(x, y) - self.middle) / self.half).length_squared() <= 1.0
    }

    /// Whether a position is in a cell that the spot touches.
    pub fn shares_cell(&self, x: f64, y: f64) -> bool {
        let [from, to] = self.cells;
        (from.x..to.x).contains(&x) && (from.y..to.y).contains(&y)
    }
}

/// The mark of a picture's subject: the tip contact or the stroke.
pub fn spot_mark(theme: &Theme, weight: u8) -> Mark {
    let style = theme.accent().add_modifier(Modifier::REVERSED);
    Mark { ink: Ink { color: theme.tip, weight }, letter: 'X', style }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::Depth;

    /// The sub-pixels, or letters, of a face that a spot at `place` covers.
    fn covered(place: DVec2, glyphs: Glyphs) -> Vec<(i32, i32)> {
        let (across, down) = sub_pixels(glyphs);
        let area = Rect::new(3, 2, 12, 6);
        let (width, height) = (i32::from(area.width * across), i32::from(area.height * down));
        let caps = Capabilities { depth: Depth::True, glyphs, unicode: true };
        let dot = RoundSpot::new(place, 0.17, area, caps);
        let at = |n: i32, size: i32| f64::from(2 * n + 1) / f64::from(size) - 1.0;
        let all = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        all.filter(|&(x, y)| dot.covers(at(x, width), at(y, height))).collect()
    }

    #[test]
    fn a_spot_has_the_same_shape_wherever_it_lies() {
        for (glyphs, count) in [(Glyphs::Octant, 21), (Glyphs::Sextant, 16), (Glyphs::Half, 9), (Glyphs::Letters, 1)] {
            for step in 0..40 {
                let place = DVec2::from_angle(f64::from(step)) * 0.015 * f64::from(step);
                let covered = covered(place, glyphs);
                assert_eq!(covered.len(), count, "{glyphs:?} {place}: {covered:?}");
            }
        }
    }
}
