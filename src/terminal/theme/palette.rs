//! The palettes to choose from: what each changes of the dark one.

use std::{fmt, str::FromStr};

use ratatui::style::Color;

use super::{Theme, resolve};
use crate::terminal::look::Depth;

/// A choice of colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Palette {
    /// Light on dark.
    #[default]
    Dark,
    /// Dark on light.
    Light,
    /// White and pure colours on black.
    HighContrast,
    /// Colours that people tell apart who see no red, green or blue (Okabe and Ito 2008).
    ColourBlind,
    /// None: letters and modifiers alone.
    Mono,
}

/// A name that no palette has.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no theme \"{0}\"; use dark, light, high-contrast, colour-blind or mono")]
pub struct UnknownPalette(String);

impl Palette {
    /// All of them.
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

    /// The next one, and the first after the last.
    #[must_use]
    pub fn next(self) -> Self {
        let place = Self::ALL.iter().position(|palette| *palette == self).unwrap_or(0);
        Self::ALL[(place + 1) % Self::ALL.len()]
    }
}

impl fmt::Display for Palette {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for Palette {
    type Err = UnknownPalette;

    fn from_str(text: &str) -> Result<Self, UnknownPalette> {
        Self::ALL.into_iter().find(|palette| palette.name() == text).ok_or_else(|| UnknownPalette(text.to_owned()))
    }
}

impl Theme {
    /// The colours of a palette for `depth`. The table itself looks the same in light and dark.
    pub fn of(palette: Palette, depth: Depth) -> Self {
        match palette {
            Palette::Dark => Self::new(depth),
            Palette::Light => light(depth),
            Palette::HighContrast => high_contrast(depth),
            Palette::ColourBlind => colour_blind(depth),
            Palette::Mono => Self::new(Depth::Mono),
        }
    }
}

fn light(depth: Depth) -> Theme {
    let ink = |rgb, index, ansi| resolve(depth, rgb, index, ansi);
    Theme {
        background: ink(0x00f6_f5f0, 255, Color::Reset),
        text: ink(0x0022_282e, 235, Color::Black),
        faint: ink(0x0062_6b74, 241, Color::DarkGray),
        accent: ink(0x0094_4f00, 94, Color::Magenta),
        good: ink(0x0016_6b30, 22, Color::Green),
        warning: ink(0x00b4_2a1e, 124, Color::Red),
        face: ink(0x00ff_fdf6, 231, Color::White),
        miscue: ink(0x00a9_aaa4, 248, Color::Gray),
        curves: [ink(0x0000_6685, 24, Color::Blue), ink(0x00a2_5200, 130, Color::Magenta)],
        bands: [ink(0x00b2_d8e4, 152, Color::Cyan), ink(0x00ea_cfac, 223, Color::Gray)],
        grid: ink(0x00cf_d2d4, 252, Color::Gray),
        ..Theme::new(depth)
    }
}

fn high_contrast(depth: Depth) -> Theme {
    let ink = |rgb, index, ansi| resolve(depth, rgb, index, ansi);
    Theme {
        background: ink(0x0000_0000, 16, Color::Black),
        text: ink(0x00ff_ffff, 231, Color::White),
        faint: ink(0x00cf_cfcf, 252, Color::Gray),
        accent: ink(0x00ff_ff00, 226, Color::LightYellow),
        good: ink(0x0000_ff5f, 47, Color::LightGreen),
        warning: ink(0x00ff_9a8a, 216, Color::LightRed),
        cloth: ink(0x0000_3a5c, 17, Color::Blue),
        cushion: ink(0x0000_5f87, 24, Color::Cyan),
        wood: ink(0x0080_5020, 94, Color::DarkGray),
        sight: ink(0x00ff_ffff, 231, Color::White),
        cue: ink(0x00ff_d7a0, 223, Color::Gray),
        balls: [
            ink(0x00ff_ffff, 231, Color::White),
            ink(0x00ff_d700, 220, Color::LightYellow),
            ink(0x00ff_4d40, 203, Color::LightRed),
        ],
        paths: [
            ink(0x00d7_ffff, 195, Color::Gray),
            ink(0x00ff_ea80, 228, Color::Yellow),
            ink(0x00ff_a8a0, 217, Color::Red),
        ],
        face: ink(0x00ff_ffff, 231, Color::White),
        miscue: ink(0x009a_9a9a, 247, Color::DarkGray),
        tip: ink(0x0000_40ff, 27, Color::Blue),
        curves: [ink(0x0000_d7ff, 45, Color::LightCyan), ink(0x00ff_af00, 214, Color::LightYellow)],
        bands: [ink(0x0000_5070, 23, Color::Blue), ink(0x0070_4800, 58, Color::DarkGray)],
        grid: ink(0x0060_6060, 241, Color::DarkGray),
        ..Theme::new(depth)
    }
}

fn colour_blind(depth: Depth) -> Theme {
    let ink = |rgb, index, ansi| resolve(depth, rgb, index, ansi);
    Theme {
        accent: ink(0x00f0_e442, 227, Color::LightYellow),
        good: ink(0x0056_b4e9, 74, Color::LightCyan),
        warning: ink(0x00e6_9f00, 172, Color::Yellow),
        cloth: ink(0x000b_4f7a, 24, Color::Blue),
        cushion: ink(0x0007_3550, 23, Color::Cyan),
        balls: [
            ink(0x00ff_ffff, 231, Color::White),
            ink(0x00f0_d942, 221, Color::LightYellow),
            ink(0x00d5_5e00, 166, Color::Red),
        ],
        paths: [
            ink(0x00b9_d3e8, 152, Color::Gray),
            ink(0x00d8_ca6a, 185, Color::Yellow),
            ink(0x00ee_8a45, 209, Color::LightRed),
        ],
        curves: [ink(0x0056_b4e9, 74, Color::LightCyan), ink(0x00e6_9f00, 172, Color::Yellow)],
        ..Theme::new(depth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear red, green and blue of a colour with 24 bits.
    fn linear(color: Color) -> [f64; 3] {
        let Color::Rgb(r, g, b) = color else { panic!("{color} has no 24 bits") };
        [r, g, b].map(|part| {
            let part = f64::from(part) / 255.0;
            if part <= 0.040_45 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
        })
    }

    /// Contrast of two colours as the Web Content Accessibility Guidelines 2.1 define it, 1 to 21.
    fn contrast(one: Color, other: Color) -> f64 {
        let luminance = |color| {
            let [r, g, b] = linear(color);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    /// What is left of linear colours for those who lack the long, the middle or the short cones (Machado, Oliveira and
    /// Fernandes 2009, severity 1).
    const DEFICIENCIES: [[[f64; 3]; 3]; 3] = [
        [[0.152_286, 1.052_583, -0.204_868], [0.114_503, 0.786_281, 0.099_216], [-0.003_882, -0.048_116, 1.051_998]],
        [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]],
        [[1.255_528, -0.076_749, -0.178_779], [-0.078_411, 0.930_809, 0.147_602], [0.004_733, 0.691_367, 0.303_900]],
    ];

    /// Distance of two colours in CIELAB as somebody sees them; 2 can just be told apart side by side.
    fn distance(one: Color, other: Color, seen: &[[f64; 3]; 3]) -> f64 {
        let lab = |color| {
            let rgb = linear(color);
            let rgb =
                seen.map(|row| row.iter().zip(rgb).map(|(weight, part)| weight * part).sum::<f64>().clamp(0.0, 1.0));
            let f = |t: f64| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
            let x = f((0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2]) / 0.9505);
            let y = f(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
            let z = f((0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2]) / 1.089);
            [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
        };
        lab(one).iter().zip(lab(other)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    }

    #[test]
    fn text_can_be_read_in_every_palette() {
        for palette in Palette::ALL.into_iter().filter(|palette| *palette != Palette::Mono) {
            let theme = Theme::of(palette, Depth::True);
            let least = if palette == Palette::HighContrast { 7.0 } else { 4.5 };
            for color in [theme.text, theme.faint, theme.accent, theme.good, theme.warning] {
                let contrast = contrast(color, theme.background);
                assert!(contrast >= least, "{palette}: {color} has {contrast:.1}");
            }
        }
    }

    #[test]
    fn colour_blind_people_tell_the_balls_the_cloth_and_the_news_apart() {
        let theme = Theme::of(Palette::ColourBlind, Depth::True);
        let things = [theme.balls[0], theme.balls[1], theme.balls[2], theme.cloth];
        for seen in &DEFICIENCIES {
            for (n, one) in things.iter().enumerate() {
                for other in &things[n + 1..] {
                    let distance = distance(*one, *other, seen);
                    assert!(distance >= 20.0, "{one} and {other}: {distance:.1}");
                }
            }
            for (one, other) in [(theme.good, theme.warning), (theme.curves[0], theme.curves[1])] {
                assert!(distance(one, other, seen) >= 20.0, "{one} and {other}");
            }
        }
    }

    #[test]
    fn things_that_mean_something_differ_at_every_depth() {
        for palette in Palette::ALL.into_iter().filter(|palette| *palette != Palette::Mono) {
            for depth in [Depth::True, Depth::Indexed, Depth::Ansi] {
                let theme = Theme::of(palette, depth);
                for group in [
                    vec![theme.balls[0], theme.balls[1], theme.balls[2], theme.cloth],
                    vec![theme.curves[0], theme.curves[1], theme.bands[0], theme.bands[1], theme.background],
                    vec![theme.good, theme.warning, theme.background],
                    vec![theme.face, theme.miscue, theme.tip],
                    [&theme.outcomes[..], &[theme.tip]].concat(),
                ] {
                    for (n, colour) in group.iter().enumerate() {
                        assert!(!group[n + 1..].contains(colour), "{palette} {depth:?} {colour}");
                    }
                }
            }
        }
    }

    #[test]
    fn names_are_read_back_and_go_round() {
        let mut palette = Palette::default();
        for _ in Palette::ALL {
            assert_eq!(palette.name().parse(), Ok(palette));
            palette = palette.next();
        }
        assert_eq!(palette, Palette::default());
        assert!("neon".parse::<Palette>().unwrap_err().to_string().contains("high-contrast"));
    }
}
