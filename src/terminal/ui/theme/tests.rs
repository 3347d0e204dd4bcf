//! Checks that colours are readable and distinguishable at every depth, also for colour-blind people.

use ratatui::style::{Color, Modifier};

use crate::terminal::{
    Depth, ThemeName,
    ui::{Theme, theme::ANSI},
};

/// The 16 ANSI colours of common terminals, in the order of their codes: Linux console (and VGA), xterm, Visual Studio Code.
const SIXTEEN: [[u32; 16]; 3] = [
    [
        0x00_0000, 0xaa_0000, 0x00_aa00, 0xaa_5500, 0x00_00aa, 0xaa_00aa, 0x00_aaaa, 0xaa_aaaa, 0x55_5555, 0xff_5555,
        0x55_ff55, 0xff_ff55, 0x55_55ff, 0xff_55ff, 0x55_ffff, 0xff_ffff,
    ],
    [
        0x00_0000, 0xcd_0000, 0x00_cd00, 0xcd_cd00, 0x00_00ee, 0xcd_00cd, 0x00_cdcd, 0xe5_e5e5, 0x7f_7f7f, 0xff_0000,
        0x00_ff00, 0xff_ff00, 0x5c_5cff, 0xff_00ff, 0x00_ffff, 0xff_ffff,
    ],
    [
        0x00_0000, 0xcd_3131, 0x0d_bc79, 0xe5_e510, 0x24_72c8, 0xbc_3fbc, 0x11_a8cd, 0xe5_e5e5, 0x66_6666, 0xf1_4c4c,
        0x23_d18b, 0xf5_f543, 0x3b_8eea, 0xd6_70d6, 0x29_b8db, 0xff_ffff,
    ],
];

/// Transformations of linear colours for normal vision, and for missing long, middle or short cones (Machado, Oliveira and Fernandes 2009,
/// severity 1).
const EYES: [[[f64; 3]; 3]; 4] = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.152_286, 1.052_583, -0.204_868], [0.114_503, 0.786_281, 0.099_216], [-0.003_882, -0.048_116, 1.051_998]],
    [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]],
    [[1.255_528, -0.076_749, -0.178_779], [-0.078_411, 0.930_809, 0.147_602], [0.004_733, 0.691_367, 0.303_900]],
];

/// The themes with colours, at every depth with colours.
fn themes() -> impl Iterator<Item = (ThemeName, Theme)> {
    let names = ThemeName::ALL.into_iter().filter(|name| *name != ThemeName::Mono);
    names.flat_map(|name| [Depth::True, Depth::Indexed, Depth::Ansi].map(|depth| (name, Theme::of(name, depth))))
}

/// Index among the 16 ANSI colours, or `None`.
fn code(color: Color) -> Option<usize> {
    ANSI.iter().position(|code| *code == color)
}

/// Linear red, green and blue of a colour on a terminal with these 16 colours.
fn linear(color: Color, sixteen: &[u32; 16]) -> [f64; 3] {
    let bytes = match color {
        Color::Rgb(r, g, b) => [r, g, b],
        Color::Indexed(index @ 232..) => [8 + 10 * (index - 232); 3],
        Color::Indexed(index @ 16..) => {
            [36, 6, 1].map(|place| [0, 95, 135, 175, 215, 255][usize::from((index - 16) / place % 6)])
        }
        _ => {
            let code = code(color).unwrap_or_else(|| panic!("{color} is whatever the user has"));
            let [_, r, g, b] = sixteen[code].to_be_bytes();
            [r, g, b]
        }
    };
    bytes.map(|part| {
        let part = f64::from(part) / 255.0;
        if part <= 0.040_45 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    })
}

/// Contrast of two colours as defined by the Web Content Accessibility Guidelines 2.1, 1 to 21.
fn contrast(one: Color, other: Color, sixteen: &[u32; 16]) -> f64 {
    let luminance = |color| {
        let [r, g, b] = linear(color, sixteen);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let (one, other) = (luminance(one), luminance(other));
    (one.max(other) + 0.05) / (one.min(other) + 0.05)
}

/// Distance of two colours in CIELAB as seen by these eyes; 2 is the smallest visible difference side by side.
fn distance(one: Color, other: Color, sixteen: &[u32; 16], eyes: &[[f64; 3]; 3]) -> f64 {
    let lab = |color| {
        let rgb = linear(color, sixteen);
        let rgb = eyes.map(|row| row.iter().zip(rgb).map(|(weight, part)| weight * part).sum::<f64>().clamp(0.0, 1.0));
        let f = |t: f64| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
        let x = f((0.4124 * rgb[0] + 0.3576 * rgb[1] + 0.1805 * rgb[2]) / 0.9505);
        let y = f(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
        let z = f((0.0193 * rgb[0] + 0.1192 * rgb[1] + 0.9505 * rgb[2]) / 1.089);
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    };
    lab(one).iter().zip(lab(other)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The pairs of `group` that are closer than `least` on one of the terminals.
fn too_near(what: &str, theme: &Theme, group: &[Color], least: f64, eyes: &[[f64; 3]; 3]) -> Vec<String> {
    let mut found = Vec::new();
    for (n, one) in group.iter().enumerate() {
        for other in &group[n + 1..] {
            let distance = SIXTEEN.iter().map(|sixteen| distance(*one, *other, sixteen, eyes)).fold(f64::MAX, f64::min);
            if distance < least {
                found.push(format!("{what} {:?}: {one} and {other} are {distance:.1} apart", theme.depth));
            }
        }
    }
    found
}

#[test]
fn monochrome_never_names_a_colour() {
    let theme = Theme::new(Depth::Mono);
    assert_eq!(theme.ball(2).fg, Some(Color::Reset));
    assert_eq!([theme.cloth, theme.outcomes[4], theme.outline], [Color::Reset; 3]);
    assert_eq!(Theme::of(ThemeName::Light, Depth::Mono).balls, [Color::Reset; 3]);
}

#[test]
fn text_can_be_read_in_every_theme_at_every_depth() {
    for (name, theme) in themes() {
        let least = match (name, theme.depth) {
            (ThemeName::HighContrast, Depth::Ansi) => 5.0,
            (ThemeName::HighContrast, _) => 7.0,
            // The user's palette decides about grey.
            (_, Depth::Ansi) => 3.9,
            _ => 4.5,
        };
        for style in [theme.text(), theme.faint(), theme.accent(), theme.good(), theme.warning()] {
            let color = style.fg.unwrap();
            // Many terminals show bold text in the brighter variant of the 16 colours.
            let bold = style.add_modifier.contains(Modifier::BOLD);
            let brighter = code(color).filter(|code| bold && *code < 8).map(|code| ANSI[code + 8]);
            for color in [color].into_iter().chain(brighter) {
                for sixteen in &SIXTEEN {
                    let contrast = contrast(color, theme.background, sixteen);
                    assert!(contrast >= least, "{name} {:?}: {color} has {contrast:.1}", theme.depth);
                }
            }
        }
    }
}

#[test]
fn colours_with_meaning_are_distinguishable_in_every_theme_at_every_depth() {
    let mut found = Vec::new();
    for (name, theme) in themes() {
        let mut check = |what: &str, group: &[Color], least: f64| {
            found.extend(too_near(&format!("{name} {what}"), &theme, group, least, &EYES[0]));
        };
        let [white, yellow, red] = theme.balls;
        check("balls", &[white, yellow, red, theme.cloth], 30.0);
        let [white_sign, yellow_sign, red_sign] = theme.signs;
        check("balls among words", &[white_sign, yellow_sign, red_sign, theme.background], 20.0);
        check("the way among words", &[theme.next_path_sign, theme.background], 30.0);
        check("table", &[theme.cloth, theme.cushion, theme.wood], 12.0);
        check("marks on the rails", &[theme.mark, theme.cushion, theme.wood], 30.0);
        let [white, yellow, red] = theme.paths;
        check("next way", &[&theme.balls[..], &[theme.next_path, theme.cloth]].concat(), 30.0);
        check("both ways", &[theme.next_path, theme.paths[0]], 30.0);
        check("paths", &[white, yellow, red, theme.cloth], 30.0);
        let ([own, other], [own_band, other_band]) = (theme.curves, theme.bands);
        check("curves", &[own, other, theme.background], 30.0);
        check("own band", &[own, own_band, theme.background], 9.0);
        check("other band", &[other, other_band, theme.background], 9.0);
        check("news", &[theme.good, theme.warning, theme.text, theme.background], 20.0);
        check("face", &[theme.face, theme.miscue, theme.tip], 12.0);
        check("outcomes", &[&theme.outcomes[..], &[theme.tip]].concat(), 9.0);
        check("outline", &[&theme.outcomes[1..], &[theme.outline]].concat(), 9.0);
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn balls_cloth_and_messages_are_distinguishable_for_colour_blind_people() {
    let theme = Theme::of(ThemeName::ColourBlind, Depth::True);
    for eyes in &EYES {
        let check = |what: &str, group: &[Color]| {
            assert_eq!(too_near(what, &theme, group, 20.0, eyes), Vec::<String>::new());
        };
        check("balls", &[theme.balls[0], theme.balls[1], theme.balls[2], theme.cloth]);
        check("next way", &[theme.balls[0], theme.balls[1], theme.balls[2], theme.next_path, theme.cloth]);
        check("news", &[theme.good, theme.warning]);
        check("curves", &theme.curves);
    }
}

#[test]
fn theme_names_parse_back() {
    for name in ThemeName::ALL {
        assert_eq!(name.name().parse(), Ok(name));
    }
    assert!("neon".parse::<ThemeName>().unwrap_err().to_string().contains("high-contrast"));
}
