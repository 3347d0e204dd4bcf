//! The table of all settings. Parsing, documentation and error messages are derived from it.

use std::{path::Path, str::FromStr};

use toml::de::{DeFloat, DeInteger, DeValue};

use crate::{
    coach::{
        Skill,
        words::{LengthUnit, PositionUnit, TipUnit},
    },
    game::Rule,
    storage::check_read_allowed,
    table::PRESETS,
    terminal::{
        Depth, Glyphs, Settings, ThemeName,
        shot::{placing::STEPS, playback::SPEEDS},
    },
};

/// One setting.
pub struct Entry {
    /// Its heading on the screen; settings with the same heading are neighbours.
    pub group: &'static str,
    /// Its key in the file.
    pub key: &'static str,
    /// What it is for.
    pub about: &'static str,
    /// The accepted values.
    pub accepted: &'static str,
    /// Values to step through, in TOML, all of them accepted.
    pub choices: fn() -> Vec<String>,
    /// Returns its value in TOML.
    pub get: fn(&Settings) -> String,
    /// Sets its value; `None` if it is not accepted.
    pub set: fn(&mut Settings, &DeValue) -> Option<()>,
}

/// Colour depths by name.
const DEPTHS: [(&str, Option<Depth>); 5] = [
    ("auto", None),
    ("true", Some(Depth::True)),
    ("256", Some(Depth::Indexed)),
    ("16", Some(Depth::Ansi)),
    ("none", Some(Depth::Mono)),
];

/// Character sets by name.
const GLYPHS: [(&str, Option<Glyphs>); 5] = [
    ("auto", None),
    ("octant", Some(Glyphs::Octant)),
    ("sextant", Some(Glyphs::Sextant)),
    ("half", Some(Glyphs::Half)),
    ("letters", Some(Glyphs::Letters)),
];

/// Thinking times to step through, ms.
const THINKING: [u64; 10] = [100, 250, 500, 1000, 2000, 3000, 5000, 10_000, 30_000, 60_000];

/// All settings, in the order of the file.
pub const ENTRIES: &[Entry] = &[
    Entry {
        group: "Looks",
        key: "theme",
        about: "Colours of the screen.",
        accepted: "\"dark\", \"light\", \"high-contrast\", \"colour-blind\", \"mono\"",
        choices: || ThemeName::ALL.map(|theme| quoted(theme.name())).to_vec(),
        get: |settings| quoted(settings.theme.name()),
        set: |settings, value| put(&mut settings.theme, parsed(value)),
    },
    Entry {
        group: "Looks",
        key: "colours",
        about: "Number of colours of the terminal; auto uses NO_COLOR, COLORTERM and TERM.",
        accepted: "\"auto\", \"true\", \"256\", \"16\", \"none\"",
        choices: || DEPTHS.map(|(name, _)| quoted(name)).to_vec(),
        get: |settings| quoted(name(&DEPTHS, &settings.depth)),
        set: |settings, value| put(&mut settings.depth, lookup(&DEPTHS, value)),
    },
    Entry {
        group: "Looks",
        key: "glyphs",
        about: "Characters for the table; auto uses the locale, and never octants, which few fonts have. CAROM_GLYPHS overrides it.",
        accepted: "\"auto\", \"octant\", \"sextant\", \"half\", \"letters\"",
        choices: || GLYPHS.map(|(name, _)| quoted(name)).to_vec(),
        get: |settings| quoted(name(&GLYPHS, &settings.glyphs)),
        set: |settings, value| put(&mut settings.glyphs, lookup(&GLYPHS, value)),
    },
    Entry {
        group: "Game",
        key: "table",
        about: "The table to play on; F7 measures your own table.",
        accepted: "\"match\", \"textbook\", \"thesis\" or the path of an existing TOML file; on the screen, your own tables by name",
        choices: || PRESETS.map(quoted).to_vec(),
        get: |settings| quoted(&*settings.table),
        set: |settings, value| put(&mut settings.table, table(value)),
    },
    Entry {
        group: "Game",
        key: "rule",
        about: "What counts as a point.",
        accepted: "\"straight\", \"one-cushion\", \"three-cushion\"",
        choices: || Rule::ALL.map(|rule| quoted(rule.name())).to_vec(),
        get: |settings| quoted(settings.rule.name()),
        set: |settings, value| put(&mut settings.rule, parsed(value)),
    },
    Entry {
        group: "Game",
        key: "skill",
        about: "Who plays: the errors that the coach assumes.",
        accepted: "\"perfect\", \"expert\", \"world-class\", \"national\", \"club\", \"beginner\", an average at three-cushion from 0.1 to 2.5 like \"0.6\", or standard errors in mm, degrees and m/s like \"a=0.7,b=0.7,theta=0.2,phi=0.2,V=0.1\"; your own skill is stored as its errors",
        choices: || Skill::NAMED.map(|(name, _)| quoted(name)).to_vec(),
        get: |settings| quoted(settings.skill.to_string()),
        set: |settings, value| put(&mut settings.skill, parsed(value)),
    },
    Entry {
        group: "Game",
        key: "doubt",
        about: "How uncertain the table and the balls' positions are for the coach.",
        accepted: "\"none\", \"full\" or two numbers like \"table=1,placing=3\": a multiple, and mm",
        choices: || ["none", "full"].map(quoted).to_vec(),
        get: |settings| quoted(settings.doubt.to_string()),
        set: |settings, value| put(&mut settings.doubt, parsed(value)),
    },
    Entry {
        group: "Game",
        key: "plan",
        about: "Whether the coach looks for shots that leave the next point easy.",
        accepted: "true, false",
        choices: truths,
        get: |settings| settings.plan.to_string(),
        set: |settings, value| put(&mut settings.plan, value.as_bool()),
    },
    Entry {
        group: "Game",
        key: "jumps",
        about: "Whether the coach may advise jumps over a ball and massés; most clubs forbid them.",
        accepted: "true, false",
        choices: truths,
        get: |settings| settings.jumps.to_string(),
        set: |settings, value| put(&mut settings.jumps, value.as_bool()),
    },
    Entry {
        group: "Game",
        key: "think_ms",
        about: "How long the coach may think, in milliseconds.",
        accepted: "10 to 60000",
        choices: || THINKING.map(|time| time.to_string()).to_vec(),
        get: |settings| settings.think_ms.to_string(),
        set: |settings, value| {
            put(&mut settings.think_ms, number(value, 10.0, 60_000.0).filter(|n| n.fract() == 0.0).map(|n| n as u64))
        },
    },
    Entry {
        group: "Handling",
        key: "step_mm",
        about: "How far an arrow key moves a ball, in millimetres.",
        accepted: "1, 5, 10, 50 or 100",
        choices: || STEPS.map(decimal).to_vec(),
        get: |settings| decimal(settings.step_mm),
        set: |settings, value| put(&mut settings.step_mm, one_of(value, &STEPS)),
    },
    Entry {
        group: "Handling",
        key: "speed",
        about: "Playback speed of shots; 1 is real time.",
        accepted: "0.1, 0.25, 0.5, 1, 2, 4 or 8",
        choices: || SPEEDS.map(decimal).to_vec(),
        get: |settings| decimal(settings.speed),
        set: |settings, value| put(&mut settings.speed, one_of(value, &SPEEDS)),
    },
    Entry {
        group: "Handling",
        key: "mouse",
        about: "Whether the mouse moves balls and lists; if not, the terminal's own text selection works.",
        accepted: "true, false",
        choices: truths,
        get: |settings| settings.mouse.to_string(),
        set: |settings, value| put(&mut settings.mouse, value.as_bool()),
    },
    Entry {
        group: "Units",
        key: "tip_unit",
        about: "Unit of the tip's distance from the centre of the ball.",
        accepted: "\"tips\", \"mm\"",
        choices: || TipUnit::NAMED.map(|(name, _)| quoted(name)).to_vec(),
        get: |settings| quoted(name(&TipUnit::NAMED, &settings.units.tip)),
        set: |settings, value| put(&mut settings.units.tip, lookup(&TipUnit::NAMED, value)),
    },
    Entry {
        group: "Units",
        key: "place_unit",
        about: "Unit of positions along the cushions.",
        accepted: "\"diamonds\", \"mm\"",
        choices: || PositionUnit::NAMED.map(|(name, _)| quoted(name)).to_vec(),
        get: |settings| quoted(name(&PositionUnit::NAMED, &settings.units.position)),
        set: |settings, value| put(&mut settings.units.position, lookup(&PositionUnit::NAMED, value)),
    },
    Entry {
        group: "Units",
        key: "length_unit",
        about: "Unit of distances, of ball positions while placing, of speeds and of margins.",
        accepted: "\"metres\", \"feet\"",
        choices: || LengthUnit::NAMED.map(|(name, _)| quoted(name)).to_vec(),
        get: |settings| quoted(name(&LengthUnit::NAMED, &settings.units.length)),
        set: |settings, value| put(&mut settings.units.length, lookup(&LengthUnit::NAMED, value)),
    },
];

/// Stores a value if it is accepted.
fn put<T>(place: &mut T, value: Option<T>) -> Option<()> {
    *place = value?;
    Some(())
}

/// Parses a value from a string.
fn parsed<T: FromStr>(value: &DeValue) -> Option<T> {
    value.as_str()?.parse().ok()
}

/// A bundled table, or the path of an existing file, as far as this process may read it.
fn table(value: &DeValue) -> Option<String> {
    let is_there = |path: &Path| check_read_allowed(path).is_ok() && path.is_file();
    value.as_str().filter(|name| PRESETS.contains(name) || is_there(Path::new(name))).map(str::to_owned)
}

fn truths() -> Vec<String> {
    [false, true].map(|truth| truth.to_string()).to_vec()
}

pub fn quoted(value: impl Into<String>) -> String {
    toml::Value::String(value.into()).to_string()
}

/// A number in TOML, always with a decimal point.
fn decimal(value: f64) -> String {
    toml::Value::Float(value).to_string()
}

/// An integer or a float within a range.
fn number(value: &DeValue, least: f64, most: f64) -> Option<f64> {
    let text = value.as_integer().map(DeInteger::as_str).or_else(|| value.as_float().map(DeFloat::as_str))?;
    text.replace('_', "").parse().ok().filter(|number| (least..=most).contains(number))
}

/// A number that must be one of `accepted`.
fn one_of(value: &DeValue, accepted: &[f64]) -> Option<f64> {
    number(value, f64::MIN, f64::MAX).filter(|number| accepted.contains(number))
}

fn lookup<T: Copy>(names: &[(&str, T)], value: &DeValue) -> Option<T> {
    let text = value.as_str()?;
    names.iter().find(|(name, _)| *name == text).map(|(_, value)| *value)
}

fn name<T: PartialEq>(names: &[(&'static str, T)], value: &T) -> &'static str {
    names.iter().find(|(_, known)| known == value).map_or("auto", |(name, _)| name)
}
