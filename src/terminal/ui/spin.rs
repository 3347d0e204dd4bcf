//! The spin panel, shown while a shot plays: the cue ball's face and words.

use ratatui::layout::Rect;

use crate::terminal::{
    shot::Spin,
    ui::{Ui, draw_face, draw_title, face_in, write_right},
    words::fixed,
};

/// Rows and columns of the words, and the panel height up to which they are next to the face.
const WORDS: u16 = 3;
const WORDS_WIDTH: u16 = 9;
const LOW: u16 = 5;

/// Draws the panel. The spot marks where a level cue would have to hit the ball to give it this spin at this speed.
pub fn draw_spin(spin: &Spin, area: Rect, ui: &mut Ui) {
    let inner = draw_title("Spin", area, ui);
    let is_low = inner.height <= LOW;
    let room = if is_low {
        Rect { width: inner.width.saturating_sub(WORDS_WIDTH), ..inner }
    } else {
        Rect { height: inner.height - WORDS, ..inner }
    };
    let face = face_in(room, ui.caps);
    let has_spin = !spin.word.is_empty();
    draw_face(has_spin.then_some(spin.mark), None, face, ui);
    // Whole numbers: few frames change them.
    let side = fixed(spin.side.abs(), 0);
    let words = match side.as_str() {
        _ if !has_spin => ["at rest".to_owned(), String::new(), String::new()],
        "0" => [spin.word.to_owned(), "no side".to_owned(), String::new()],
        _ => {
            let to = if spin.side > 0.0 { "left" } else { "right" };
            [spin.word.to_owned(), format!("{to} side"), format!("{side} rad/s")]
        }
    };
    let top = if is_low { inner.y } else { face.bottom() };
    let styles = [ui.theme.text(), ui.theme.text(), ui.theme.faint()];
    for ((text, style), row) in words.iter().zip(styles).zip(top..inner.bottom()) {
        let text = text.as_str();
        if is_low {
            let room = usize::from(inner.right() - face.right());
            let text = if room > text.len() + 1 { text } else { text.trim_end_matches(" side") };
            // The last column stays free if possible.
            write_right(ui.buffer, face.right(), inner.right() - u16::from(room > text.len()), row, text, style);
        } else {
            let indent = inner.width.saturating_sub(text.len() as u16) / 2;
            ui.buffer.set_stringn(inner.x + indent, row, text, usize::from(inner.width - indent), style);
        }
    }
}
