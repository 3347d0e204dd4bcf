//! A picture that says of each place what is there: in sub-pixels, or in letters where there are none.

use ratatui::{buffer::Buffer, layout::Rect, style::Style};

use crate::terminal::{
    canvas::{Canvas, Ink},
    look::{Glyphs, Look},
    theme::Theme,
};

/// What is at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Its colour in sub-pixels.
    pub ink: Ink,
    /// Its sign where letters are drawn.
    pub letter: char,
    /// That sign's style.
    pub style: Style,
}

/// Paints `area` with what `mark` says of each place: right and up from the middle, -1 to 1, and half the height of a cell
/// where letters are drawn, nought where sub-pixels are. Where it says nothing is the colour `ground`, or what was there
/// before if letters are drawn.
pub fn draw_field(
    area: Rect,
    ground: ratatui::style::Color,
    look: Look,
    buffer: &mut Buffer,
    mark: impl Fn(f64, f64, f64) -> Option<Mark>,
) {
    let place = |at: i32, size: i32| f64::from(2 * at + 1) / f64::from(size) - 1.0;
    if look.glyphs == Glyphs::Letters {
        let (width, height) = (i32::from(area.width), i32::from(area.height));
        for (y, row) in (0..height).zip(area.y..) {
            for (x, column) in (0..width).zip(area.x..) {
                if let Some(mark) = mark(place(x, width), -place(y, height), 1.0 / f64::from(height)) {
                    buffer[(column, row)].set_char(mark.letter).set_style(mark.style);
                }
            }
        }
        return;
    }
    let mut canvas = Canvas::new(area, look.glyphs, ground);
    let (width, height) = canvas.size();
    for y in 0..height {
        for x in 0..width {
            if let Some(mark) = mark(place(x, width), -place(y, height), 0.0) {
                canvas.set(x, y, mark.ink);
            }
        }
    }
    canvas.paint(buffer);
}

/// The largest face of a ball in a panel. A row is as high as two columns are wide: a circle is twice as many columns as
/// rows.
pub fn face_in(inner: Rect) -> Rect {
    let rows = inner.height.min(inner.width / 2);
    Rect::new(inner.x + (inner.width - 2 * rows) / 2, inner.y, 2 * rows, rows)
}

/// Whether a place of a face that is `x`, `y` from a spot is on it: within `radius`, or, of the letters' cells, the one that
/// holds the spot.
pub fn is_on_spot(x: f64, y: f64, radius: f64, cell: f64) -> bool {
    if cell > 0.0 { x.abs() <= 0.5 * cell && y.abs() <= cell } else { x.hypot(y) <= radius }
}

/// The sign of the place that a picture is about: where the tip meets the ball, the stroke.
pub fn spot_mark(theme: &Theme, weight: u8) -> Mark {
    let style = theme.accent().add_modifier(ratatui::style::Modifier::REVERSED);
    Mark { ink: Ink { color: theme.tip, weight }, letter: 'X', style }
}
