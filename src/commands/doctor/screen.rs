//! The terminal and its abilities.

use std::{
    env,
    io::{self, IsTerminal},
};

use serde::Serialize;

use crate::terminal::{self, Depth, Glyphs, MIN_SIZE, Settings};

/// Environment variables that affect the display.
const VARIABLES: [&str; 8] =
    ["TERM", "COLORTERM", "NO_COLOR", "LC_ALL", "LC_CTYPE", "LANG", "CAROM_GLYPHS", "WT_SESSION"];

/// The terminal.
#[derive(Serialize)]
pub struct Screen {
    /// Whether the full-screen program can open here.
    pub can_draw: bool,
    /// Columns and rows; `None` if there is no terminal.
    pub size: Option<(u16, u16)>,
    pub colours: &'static str,
    pub glyphs: &'static str,
    /// Whether the locale is UTF-8.
    pub unicode: bool,
    /// Programs between carom and the terminal: tmux, screen or SSH.
    pub over: Vec<&'static str>,
    /// The variables that are set, with their values.
    pub environment: Vec<(&'static str, String)>,
}

impl Screen {
    /// Detects the terminal on the standard input and output, with the user's settings.
    #[expect(clippy::disallowed_methods, reason = "nothing is written")]
    pub fn detect(settings: &Settings) -> Self {
        let set = |name: &str| env::var(name).ok().filter(|value| !value.is_empty());
        let caps = terminal::detect(settings);
        let colours = match caps.depth {
            Depth::True => "24-bit",
            Depth::Indexed => "256",
            Depth::Ansi => "16",
            Depth::Mono => "none",
        };
        let glyphs = match caps.glyphs {
            Glyphs::Octant => "octants",
            Glyphs::Sextant => "sextants",
            Glyphs::Half => "half blocks",
            Glyphs::Letters => "letters",
        };
        let between = [("TMUX", "tmux"), ("STY", "screen"), ("SSH_CONNECTION", "SSH")];
        Self {
            can_draw: terminal::is_there(),
            size: io::stdout().is_terminal().then(crossterm::terminal::size).and_then(Result::ok),
            colours,
            glyphs,
            unicode: caps.unicode,
            over: between.into_iter().filter(|(name, _)| set(name).is_some()).map(|(_, what)| what).collect(),
            environment: VARIABLES.into_iter().filter_map(|name| Some((name, set(name)?))).collect(),
        }
    }

    /// Returns a sentence if the terminal is too small.
    pub fn problem(&self) -> Option<String> {
        let (columns, rows) = self.size?;
        let (least_columns, least_rows) = MIN_SIZE;
        (columns < least_columns || rows < least_rows).then(|| {
            format!(
                "the terminal has {columns}x{rows} characters; the screens need {least_columns}x{least_rows}: make its \
                 window larger or its font smaller"
            )
        })
    }
}
