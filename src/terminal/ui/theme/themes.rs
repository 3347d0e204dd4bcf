//! The available themes, defined by their differences from the dark one.

use std::{fmt, str::FromStr};

use ratatui::style::{Color, Modifier};

use crate::terminal::{
    Depth,
    ui::{Theme, theme::resolve},
};

/// Name of a theme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ThemeName {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
    /// White and pure colours on black.
    HighContrast,
    /// Colours that people with any colour blindness can distinguish (Okabe and Ito 2008).
    ColourBlind,
    /// No colours: only letters and modifiers.
    Mono,
}

/// Error for an unknown theme name.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no theme \"{0}\"; use dark, light, high-contrast, colour-blind or mono")]
pub struct UnknownTheme(String);

impl ThemeName {
    /// All themes.
    pub const ALL: [Self; 5] = [Self::Dark, Self::Light, Self::HighContrast, Self::ColourBlind, Self::Mono];

    /// Name in the configuration and on the screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Light => "light",
            Self::HighContrast => "high-contrast",
            Self::ColourBlind => "colour-blind",
            Self::Mono => "mono",
        }
    }
}

impl fmt::Display for ThemeName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for ThemeName {
    type Err = UnknownTheme;

    fn from_str(text: &str) -> Result<Self, UnknownTheme> {
        Self::ALL.into_iter().find(|one| one.name() == text).ok_or_else(|| UnknownTheme(text.to_owned()))
    }
}

impl Theme {
    /// Creates a theme for `depth`. The table itself looks the same in the light and the dark theme.
    pub fn of(name: ThemeName, depth: Depth) -> Self {
        match name {
            ThemeName::Dark => Self::new(depth),
            ThemeName::Light => light(depth),
            ThemeName::HighContrast => high_contrast(depth),
            ThemeName::ColourBlind => colour_blind(depth),
            ThemeName::Mono => Self::new(Depth::Mono),
        }
    }
}

fn light(depth: Depth) -> Theme {
    let ink = |rgb, index, ansi| resolve(depth, rgb, index, ansi);
    let dark = Theme::new(depth);
    Theme {
        background: ink(0x00f6_f5f0, 255, Color::White),
        text: ink(0x0022_282e, 235, Color::Black),
        faint: ink(0x0062_6b74, 241, Color::DarkGray),
        rule: ink(0x00b4_b7b8, 249, Color::DarkGray),
        accent: ink(0x0094_4f00, 94, Color::Magenta),
        good: ink(0x0016_6b30, 22, Color::Blue),
        warning: ink(0x00b4_2a1e, 124, Color::Red),
        // A white and a yellow ball would not be visible on the light background.
        signs: [
            ink(0x0022_282e, 235, Color::Black),
            ink(0x00ad_7b00, 136, Color::Yellow),
            ink(0x00c2_2424, 160, Color::Red),
        ],
        next_path_sign: ink(0x0016_6b30, 22, Color::Blue),
        face: ink(0x00ff_fdf6, 231, Color::White),
        miscue: ink(0x00a9_aaa4, 248, Color::DarkGray),
        curves: [ink(0x0000_6685, 24, Color::Blue), ink(0x00a2_5200, 130, Color::Magenta)],
        bands: [ink(0x00b2_d8e4, 152, Color::Cyan), ink(0x00ea_cfac, 223, Color::Gray)],
        outcomes: [
            ink(0x00e2_e2de, 253, Color::White),
            ink(0x00b0_b5b8, 249, Color::Gray),
            dark.outcomes[2],
            dark.outcomes[3],
            dark.outcomes[4],
        ],
        outline: ink(0x0022_282e, 235, Color::Black),
        grid: ink(0x00cf_d2d4, 252, Color::Gray),
        // Many terminals show bold text in the brighter variant of the 16 colours, which is too pale here.
        strong: if depth == Depth::Ansi { Modifier::empty() } else { Modifier::BOLD },
        ..dark
    }
}

fn high_contrast(depth: Depth) -> Theme {
    let ink = |rgb, index, ansi| resolve(depth, rgb, index, ansi);
    let balls = [
        ink(0x00ff_ffff, 231, Color::White),
        ink(0x00ff_d700, 220, Color::LightYellow),
        ink(0x00ff_4d40, 203, Color::LightRed),
    ];
    Theme {
        background: ink(0x0000_0000, 16, Color::Black),
        text: ink(0x00ff_ffff, 231, Color::White),
        faint: ink(0x00cf_cfcf, 252, Color::Gray),
        rule: ink(0x00a0_a0a0, 248, Color::Gray),
        accent: ink(0x00ff_ff00, 226, Color::LightYellow),
        mark: ink(0x00ff_ff00, 226, Color::LightYellow),
        good: ink(0x0000_ff5f, 47, Color::LightGreen),
        warning: ink(0x00ff_9a8a, 216, Color::LightRed),
        cloth: ink(0x0000_3a5c, 17, Color::Blue),
        cushion: ink(0x0000_5f87, 24, Color::Cyan),
        wood: ink(0x0080_5020, 94, Color::DarkGray),
        sight: ink(0x00ff_ffff, 231, Color::White),
        cue: ink(0x00ff_d7a0, 223, Color::Gray),
        balls,
        signs: balls,
        paths: [
            ink(0x00d7_ffff, 195, Color::Gray),
            ink(0x00ff_ea80, 228, Color::Yellow),
            ink(0x00ff_a8a0, 217, Color::LightMagenta),
        ],
        next_path: ink(0x005f_ff87, 84, Color::LightGreen),
        next_path_sign: ink(0x005f_ff87, 84, Color::LightGreen),
        face: ink(0x00ff_ffff, 231, Color::White),
        miscue: ink(0x009a_9a9a, 247, Color::DarkGray),
        tip: ink(0x0000_40ff, 27, Color::Blue),
        curves: [ink(0x0000_d7ff, 45, Color::LightCyan), ink(0x00ff_af00, 214, Color::LightYellow)],
        bands: [ink(0x0000_5070, 23, Color::Blue), ink(0x0070_4800, 58, Color::DarkGray)],
        outline: ink(0x00ff_ffff, 231, Color::White),
        grid: ink(0x0060_6060, 241, Color::DarkGray),
        ..Theme::new(depth)
    }
}

fn colour_blind(depth: Depth) -> Theme {
    let ink = |rgb, index, ansi| resolve(depth, rgb, index, ansi);
    let balls = [
        ink(0x00ff_ffff, 231, Color::White),
        ink(0x00f0_d942, 221, Color::LightYellow),
        ink(0x00d5_5e00, 166, Color::Red),
    ];
    Theme {
        accent: ink(0x00f0_e442, 227, Color::LightYellow),
        mark: ink(0x00f0_e442, 227, Color::LightYellow),
        good: ink(0x0056_b4e9, 74, Color::LightCyan),
        warning: ink(0x00e6_9f00, 172, Color::LightRed),
        cloth: ink(0x000b_4f7a, 24, Color::Blue),
        cushion: ink(0x0007_3550, 23, Color::Cyan),
        balls,
        signs: balls,
        paths: [
            ink(0x00b9_d3e8, 152, Color::Gray),
            ink(0x00d8_ca6a, 185, Color::Yellow),
            ink(0x00ee_8a45, 209, Color::LightRed),
        ],
        curves: [ink(0x0056_b4e9, 74, Color::LightCyan), ink(0x00e6_9f00, 172, Color::Yellow)],
        ..Theme::new(depth)
    }
}
