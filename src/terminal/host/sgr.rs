//! Colours as escape sequences: select graphic rendition (SGR).

use std::fmt;

use ratatui::style::Color;

/// A colour as the parameters of SGR; `base` is 30 for the front and 40 for the back.
pub struct Sgr {
    /// The colour.
    pub color: Color,
    /// 30 or 40.
    pub base: u8,
}

impl fmt::Display for Sgr {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let base = self.base;
        let basic = |number: u8| base + number;
        let bright = |number: u8| base + 60 + number;
        let code = match self.color {
            Color::Reset => basic(9),
            Color::Black => basic(0),
            Color::Red => basic(1),
            Color::Green => basic(2),
            Color::Yellow => basic(3),
            Color::Blue => basic(4),
            Color::Magenta => basic(5),
            Color::Cyan => basic(6),
            Color::Gray => basic(7),
            Color::DarkGray => bright(0),
            Color::LightRed => bright(1),
            Color::LightGreen => bright(2),
            Color::LightYellow => bright(3),
            Color::LightBlue => bright(4),
            Color::LightMagenta => bright(5),
            Color::LightCyan => bright(6),
            Color::White => bright(7),
            Color::Rgb(r, g, b) => return write!(out, "{};2;{r};{g};{b}", basic(8)),
            Color::Indexed(index) => return write!(out, "{};5;{index}", basic(8)),
        };
        write!(out, "{code}")
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
