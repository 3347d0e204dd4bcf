//! Drawing for the pages: the drawing context, and widgets that several pages share.

pub mod canvas;
pub mod chart;
pub mod events;
pub mod field;
pub mod geometry;
pub mod hit;
pub mod input;
pub mod list;
pub mod message;
pub mod panel;
pub mod profile;
mod sprites;
pub mod status_line;
pub mod table;
pub mod text;
pub mod theme;
pub mod tip;
pub mod toasts;
pub mod what_if;

use ratatui::{buffer::Buffer, style::Color, text::Span};

pub use self::{
    canvas::{Canvas, Ink},
    events::draw_events,
    field::{RoundSpot, draw_field, face_in, spot_mark},
    hit::{draw_hit_panel, draw_spin_or_hit},
    input::{TextField, Typed, is_typed},
    message::{Message, Tone},
    panel::{
        below_title, draw_header, draw_lines, draw_placeholder, draw_title, frame, pair, separator, split, stepper,
        write_paragraphs,
    },
    profile::{draw_profile, side_view_below},
    status_line::{draw_question, draw_status},
    table::{Spot, TableView, ball_at, cue_sign, draw_table},
    text::{
        columns, shorten, shorten_start, suffix_within, to_displayable, truncate_lines, wrap, wrap_by, write_right,
    },
    theme::Theme,
    tip::{draw_face, draw_tip, draw_titled_tip, stroke_rows, tip_rows},
    what_if::draw_what_if,
};
use crate::terminal::{
    Capabilities, Glyphs, Keys,
    keymap::{Binding, chord_of, keys_text},
};

/// The drawing context: the buffer, the colours and characters, and the user's own key bindings.
#[derive(Debug)]
pub struct Ui<'a> {
    /// The colours.
    pub theme: &'a Theme,
    /// What the terminal can show.
    pub caps: Capabilities,
    /// The user's own key bindings.
    pub keys: &'a Keys,
    /// The cells of the screen.
    pub buffer: &'a mut Buffer,
}

impl Ui<'_> {
    /// The separator between two parts of a title.
    pub fn dash(&self) -> Span<'static> {
        Span::styled(separator(self.caps), self.theme.faint())
    }

    /// Colour of what is marked on the table, which is drawn in characters on the background of the screen or in its own colours.
    pub fn mark(&self) -> Color {
        if self.caps.glyphs == Glyphs::Letters { self.theme.accent } else { self.theme.mark }
    }

    /// The first key bound to `action` in this table; empty if there is none.
    pub fn key_of<A: PartialEq, W>(&self, table: &[Binding<A, W>], action: &A) -> String {
        keys_text(chord_of(table, action).and_then(|chord| self.keys.keys_for(chord).next()), self.caps)
    }
}

/// Returns what `draw` draws into an empty `area`, with the colours and characters of `caps`.
#[cfg(test)]
pub fn drawn(area: ratatui::layout::Rect, caps: Capabilities, draw: impl FnOnce(&mut Ui)) -> Buffer {
    let (theme, keys, mut buffer) = (Theme::new(caps.depth), Keys::default(), Buffer::empty(area));
    draw(&mut Ui { theme: &theme, caps, keys: &keys, buffer: &mut buffer });
    buffer
}
