//! What the terminal can show: its number of colours and its characters, detected from the environment.

use crate::printing;

/// Number of colours of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// 24-bit colours.
    True,
    /// The 256 colours of xterm.
    Indexed,
    /// The 16 colours of the user's own palette.
    Ansi,
    /// No colours: `NO_COLOR` is set, or the terminal has none.
    Mono,
}

/// Characters that the table is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glyphs {
    /// Octants: two by four sub-pixels a cell. Few fonts have them and multiplexers drop them, so they are used only on request.
    Octant,
    /// Sextants: two by three sub-pixels a cell.
    Sextant,
    /// Half blocks: one by two sub-pixels a cell, for fonts without sextants.
    Half,
    /// Letters and ASCII characters only.
    Letters,
}

/// What the drawing code has to know about the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Capabilities {
    /// Number of colours.
    pub depth: Depth,
    /// Character set for the table.
    pub glyphs: Glyphs,
    /// Whether text may contain characters beyond ASCII.
    pub unicode: bool,
}

impl Capabilities {
    /// The capabilities of most current terminals.
    pub const TRUE_COLOUR: Self = Self { depth: Depth::True, glyphs: Glyphs::Sextant, unicode: true };
    /// Text without colours.
    pub const NO_COLOUR: Self = Self { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
    /// Text without colours, in ASCII.
    pub const ASCII: Self = Self { unicode: false, ..Self::NO_COLOUR };

    /// Detects the capabilities from the environment: `NO_COLOR`, `COLORTERM`, `TERM`, the locale, and `CAROM_GLYPHS` (`octant`, `sextant`,
    /// `half` or `letters`). `CAROM_GLYPHS` is for users whose font has octants or lacks sextants. Values `chosen` in the settings override
    /// detection and `NO_COLOR`, but not `CAROM_GLYPHS`.
    pub fn detect(variable: impl Fn(&str) -> Option<String>, chosen: (Option<Depth>, Option<Glyphs>)) -> Self {
        let set = |name: &str| variable(name).filter(|value| !value.is_empty());
        let term = set("TERM").unwrap_or_default();
        let (unicode, is_windows_terminal) = (printing::is_unicode(set), printing::is_windows_terminal(set));
        let depth = match chosen.0 {
            Some(depth) => depth,
            None if set("NO_COLOR").is_some() || term.starts_with("vt") => Depth::Mono,
            None if is_windows_terminal => Depth::True,
            None => depth(&term, set("COLORTERM").as_deref().unwrap_or_default()),
        };
        let named = set("CAROM_GLYPHS").unwrap_or_default();
        let glyphs = match (named.as_str(), chosen.1) {
            _ if !unicode || depth == Depth::Mono => Glyphs::Letters,
            ("letters", _) => Glyphs::Letters,
            ("half", _) => Glyphs::Half,
            ("sextant", _) => Glyphs::Sextant,
            ("octant", _) => Glyphs::Octant,
            (_, Some(glyphs)) => glyphs,
            // The Linux console has 512 glyphs, and sextants are not among them.
            _ if term == "linux" => Glyphs::Half,
            _ => Glyphs::Sextant,
        };
        Self { depth, glyphs, unicode }
    }

    /// The finest character set that may be used: octants only if the user has asked for them.
    pub fn finest(&self) -> Glyphs {
        if self.glyphs == Glyphs::Octant { Glyphs::Octant } else { Glyphs::Sextant }
    }

    /// The next simpler character set that this terminal can show; after the simplest, `finest` again.
    #[must_use]
    pub fn with_next_glyphs(self, finest: Glyphs) -> Self {
        let glyphs = match self.glyphs {
            _ if !self.unicode || self.depth == Depth::Mono => Glyphs::Letters,
            Glyphs::Octant => Glyphs::Sextant,
            Glyphs::Sextant => Glyphs::Half,
            Glyphs::Half => Glyphs::Letters,
            Glyphs::Letters => finest,
        };
        Self { glyphs, ..self }
    }

    /// Returns `fancy` if the terminal shows characters beyond ASCII, otherwise `plain`.
    pub const fn pick<T: Copy>(&self, fancy: T, plain: T) -> T {
        if self.unicode { fancy } else { plain }
    }
}

fn depth(term: &str, colorterm: &str) -> Depth {
    // ssh does not forward COLORTERM, but these are known to have 24-bit colours by their name alone.
    const TRUE_COLOUR: [&str; 6] = ["kitty", "alacritty", "wezterm", "ghostty", "foot", "direct"];
    if matches!(colorterm, "truecolor" | "24bit") || TRUE_COLOUR.iter().any(|name| term.contains(name)) {
        Depth::True
    } else if term.contains("256") {
        Depth::Indexed
    } else {
        Depth::Ansi
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn caps(variables: &[(&str, &str)]) -> Capabilities {
        let variable =
            |name: &str| variables.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned());
        Capabilities::detect(variable, (None, None))
    }

    #[test]
    fn a_modern_terminal_gets_sextants_in_true_colour() {
        let found = caps(&[("TERM", "xterm-256color"), ("COLORTERM", "truecolor"), ("LANG", "de_DE.UTF-8")]);
        assert_eq!(found, Capabilities::TRUE_COLOUR);
    }

    #[test]
    fn no_color_and_other_locales_get_letters() {
        assert_eq!(caps(&[("TERM", "xterm"), ("NO_COLOR", "1"), ("LANG", "C.UTF-8")]).glyphs, Glyphs::Letters);
        assert_eq!(caps(&[("TERM", "xterm"), ("LC_ALL", "C"), ("LANG", "C.UTF-8")]).glyphs, Glyphs::Letters);
        assert_eq!(caps(&[("TERM", "xterm"), ("NO_COLOR", ""), ("LANG", "C.UTF-8")]).depth, Depth::Ansi);
    }

    #[test]
    fn the_terminal_name_decides_where_colorterm_is_missing() {
        assert_eq!(caps(&[("TERM", "tmux-256color")]).depth, Depth::Indexed);
        assert_eq!(caps(&[("TERM", "xterm-kitty")]).depth, Depth::True);
        assert_eq!(caps(&[("TERM", "linux"), ("LANG", "C.UTF-8")]).glyphs, Glyphs::Half);
        assert_eq!(caps(&[("TERM", "vt100")]).depth, Depth::Mono);
    }

    #[test]
    fn windows_terminal_is_recognized_by_name_without_a_locale() {
        let found = caps(&[("WT_SESSION", "1")]);
        assert_eq!(found, Capabilities::TRUE_COLOUR);
        assert_eq!(caps(&[("WT_SESSION", "1"), ("LANG", "C"), ("TERM", "xterm")]).depth, Depth::Ansi);
    }

    #[test]
    fn chosen_capabilities_override_detected_ones() {
        let caps = |chosen: &str| {
            let variable = |name: &str| match name {
                "TERM" => Some("xterm".to_owned()),
                "LANG" => Some("C.UTF-8".to_owned()),
                "NO_COLOR" => Some("1".to_owned()),
                "CAROM_GLYPHS" => Some(chosen.to_owned()),
                _ => None,
            };
            Capabilities::detect(variable, (Some(Depth::Indexed), Some(Glyphs::Half)))
        };
        assert_eq!((caps("").depth, caps("").glyphs), (Depth::Indexed, Glyphs::Half));
        assert_eq!(caps("sextant").glyphs, Glyphs::Sextant);
    }

    #[test]
    fn glyphs_cycle_within_the_terminals_capabilities() {
        use Glyphs::{Half, Letters, Octant, Sextant};
        let walk = |start: Capabilities| {
            let mut looks = vec![start];
            while looks.len() < 5 {
                looks.push(looks[looks.len() - 1].with_next_glyphs(start.finest()));
            }
            looks.iter().map(|caps| caps.glyphs).collect::<Vec<_>>()
        };
        let start = caps(&[("TERM", "xterm"), ("LANG", "C.UTF-8")]);
        assert_eq!(walk(start), [Sextant, Half, Letters, Sextant, Half]);
        let asked = caps(&[("TERM", "xterm"), ("LANG", "C.UTF-8"), ("CAROM_GLYPHS", "octant")]);
        assert_eq!(walk(asked), [Octant, Sextant, Half, Letters, Octant]);
        let plain = caps(&[("TERM", "xterm"), ("CAROM_GLYPHS", "octant")]);
        assert_eq!(walk(plain), [Letters; 5]);
    }
}
