//! The cue ball's face as the shooter sees it: where the tip meets it, and the circle beyond which it slips off.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Modifier,
    text::{Line, Span},
};

use super::draw_title;
use crate::{
    physics::CueInputs,
    table::Table,
    terminal::{
        canvas::{Canvas, Ink},
        look::{Glyphs, Look},
        theme::Theme,
    },
};

/// Radius of the tip's contact as it is drawn, in ball radii; a real one is smaller than a sub-pixel.
const TIP_RADIUS: f64 = 0.17;

/// Weight of the tip in a cell that it shares with both parts of the face: more than five sub-pixels of theirs, or the spot
/// would lose a piece and fall apart.
const TIP_WEIGHT: u8 = 16;

/// Draws the panel: where the tip meets the ball in the stroke `cue`, if there is one.
pub fn draw_tip(cue: Option<&CueInputs>, table: &Table, area: Rect, theme: &Theme, look: Look, buffer: &mut Buffer) {
    let title = Line::from(Span::styled("Tip", theme.text()));
    let inner = draw_title(&title, area, theme, look, buffer);
    let face = face_in(inner);
    let limit = table.miscue_limit.sqrt();
    // In radii, right and up as the shooter sees it: positive `a` is on the left.
    let tip = cue.map(|cue| (-cue.a, cue.b));
    if look.glyphs == Glyphs::Letters {
        draw_letters(tip, limit, face, theme, buffer);
    } else {
        draw_blocks(tip, limit, face, theme, look, buffer);
    }
}

/// The largest face in a panel. A row is as high as two columns are wide: a circle is twice as many columns as rows.
pub fn face_in(inner: Rect) -> Rect {
    let rows = inner.height.min(inner.width / 2);
    Rect::new(inner.x + (inner.width - 2 * rows) / 2, inner.y, 2 * rows, rows)
}

fn draw_blocks(tip: Option<(f64, f64)>, limit: f64, face: Rect, theme: &Theme, look: Look, buffer: &mut Buffer) {
    let mut canvas = Canvas::new(face, look.glyphs, theme.background);
    let (width, height) = canvas.size();
    let ink = |color, weight| Ink { color, weight };
    for row in 0..height {
        for column in 0..width {
            let x = (2.0 * f64::from(column) + 1.0) / f64::from(width) - 1.0;
            let y = 1.0 - (2.0 * f64::from(row) + 1.0) / f64::from(height);
            let radius = x.hypot(y);
            if radius > 1.0 {
                continue;
            }
            let on_tip = tip.is_some_and(|(right, up)| (x - right).hypot(y - up) <= TIP_RADIUS);
            canvas.set(
                column,
                row,
                match () {
                    () if on_tip => ink(theme.tip, TIP_WEIGHT),
                    () if radius > limit => ink(theme.miscue, 3),
                    () => ink(theme.face, 3),
                },
            );
        }
    }
    canvas.paint(buffer);
}

fn draw_letters(tip: Option<(f64, f64)>, limit: f64, face: Rect, theme: &Theme, buffer: &mut Buffer) {
    let rows = f64::from(face.height.max(1));
    // Half a row, in radii.
    let half = 1.0 / rows;
    for row in face.y..face.bottom() {
        for column in face.x..face.right() {
            let x = (f64::from(column - face.x) + 0.5) / rows - 1.0;
            let y = 1.0 - (2.0 * f64::from(row - face.y) + 1.0) / rows;
            let radius = x.hypot(y);
            let on_tip = tip.is_some_and(|(right, up)| (x - right).abs() <= 0.5 * half && (y - up).abs() <= half);
            let (symbol, style) = match () {
                () if on_tip => ('X', theme.accent().add_modifier(Modifier::REVERSED)),
                () if (radius - (1.0 - half / 2.0)).abs() <= 0.6 * half => ('o', theme.text()),
                () if (radius - limit).abs() <= 0.5 * half => ('.', theme.faint()),
                () if radius < 0.5 * half => ('+', theme.faint()),
                () => continue,
            };
            buffer[(column, row)].set_char(symbol).set_style(style);
        }
    }
}
