//! Colours as escape sequences: select graphic rendition (SGR).

use std::fmt;

use ratatui::style::Color;

use crate::terminal::ui::theme::ANSI;

/// A colour as SGR parameters; `base` is 30 for the foreground and 40 for the background.
pub struct Sgr {
    /// The colour.
    pub color: Color,
    /// 30 or 40.
    pub base: u8,
}

impl fmt::Display for Sgr {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let base = self.base;
        match self.color {
            Color::Reset => write!(out, "{}", base + 9),
            Color::Rgb(r, g, b) => write!(out, "{};2;{r};{g};{b}", base + 8),
            Color::Indexed(index) => write!(out, "{};5;{index}", base + 8),
            named => {
                let number = ANSI.iter().position(|color| *color == named).unwrap_or_default() as u8;
                // The bright colours have their own codes.
                write!(out, "{}", base + number % 8 + number / 8 * 60)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_colour_has_its_code() {
        let sgr = |color, base| Sgr { color, base }.to_string();
        assert_eq!(sgr(Color::Reset, 30), "39");
        assert_eq!(sgr(Color::Gray, 40), "47");
        assert_eq!(sgr(Color::White, 30), "97");
        assert_eq!(sgr(Color::LightBlue, 40), "104");
        assert_eq!(sgr(Color::Indexed(200), 30), "38;5;200");
        assert_eq!(sgr(Color::Rgb(1, 2, 3), 40), "48;2;1;2;3");
    }
}
