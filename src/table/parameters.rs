//! Parameters of a table (geometry, balls, cloth, cushions and cue), read from TOML.

use std::{path::Path, sync::LazyLock};

use glam::DVec2;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use super::{
    DoubtError, Flight, Opening, Rail, Room, TableDoubt,
    flaws::{self, Check},
    models::{Fade, Rails, SlipFriction, is_default},
};
use crate::{printing::number, storage::describe_toml_error};

/// Names of the bundled tables, the default first.
pub const PRESETS: [&str; 3] = ["match", "textbook", "thesis"];

/// Longest accepted side of a table, m; more than twice the length of any billiard table.
const MAX_SIDE: f64 = 10.0;

/// Bundled tables that use the thesis' equations only: the numerical accuracy is judged on them.
pub const THESIS_PRESETS: [&str; 2] = ["textbook", "thesis"];

// Contents of the preset files in [`PRESETS`].
const MATCH: &str = include_str!("match.toml");
const TEXTBOOK: &str = include_str!("textbook.toml");
const THESIS: &str = include_str!("thesis.toml");

/// A table with its balls, cloth, cushions and cue, in SI units.
///
/// The TOML keys are the symbols of the thesis (its Table 1). `mu_b` can be omitted: a ball-ball contact then never slips (thesis equation
/// 17).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, remote = "Self")]
pub struct Table {
    /// Name of the table, as used by `--table` and in the JSON field `preset`.
    pub name: String,
    /// Length `L` of the playing area along x, between the cushion noses, m.
    #[serde(rename = "L")]
    pub length: f64,
    /// Width `l` of the playing area along y, m.
    #[serde(rename = "l")]
    pub width: f64,
    /// Ball radius `R`, m.
    #[serde(rename = "R")]
    pub radius: f64,
    /// Ball mass `m`, kg.
    #[serde(rename = "m")]
    pub ball_mass: f64,
    /// Cue mass `M`, kg.
    #[serde(rename = "M")]
    pub cue_mass: f64,
    /// Coefficient of sliding friction between ball and cloth.
    #[serde(rename = "mu_s")]
    pub sliding_friction: f64,
    /// Coefficient of rolling friction, as defined by thesis equation (6) with its factor 5/7.
    #[serde(rename = "mu_r")]
    pub rolling_friction: f64,
    /// Coefficient of spinning friction (thesis equation 8).
    #[serde(rename = "mu_sp")]
    pub spinning_friction: f64,
    /// Coefficient of restitution between two balls, 0 to 1.
    #[serde(rename = "e_ball")]
    pub ball_restitution: f64,
    /// Coefficient of friction between two balls; `None` if the contact never slips (thesis equation 17).
    #[serde(rename = "mu_b", default, skip_serializing_if = "Option::is_none")]
    pub ball_friction: Option<f64>,
    /// Coefficient of restitution between ball and cushion, 0 to 1.
    #[serde(rename = "e_rail")]
    pub rail_restitution: f64,
    /// Coefficient of friction between ball and cushion.
    #[serde(rename = "mu_rail")]
    pub rail_friction: f64,
    /// Gravitational acceleration, m/s².
    #[serde(rename = "g")]
    pub gravity: f64,
    /// Largest `a² + b²` (in units of R²) at which the tip does not slip off the ball.
    pub miscue_limit: f64,
    /// Distance `d` between the cue ball and the opponent's ball in the opening position, m.
    #[serde(rename = "d")]
    pub opening_offset: f64,
    /// Growth of a rolling ball's deceleration with its speed, 1/s: `a = 5/7 mu_r g + c1 v`.
    #[serde(rename = "c1", default, skip_serializing_if = "is_default")]
    pub rolling_growth: f64,
    /// Decrease of the ball-ball restitution with impact speed.
    #[serde(rename = "e_ball_fade", default, skip_serializing_if = "Option::is_none")]
    pub ball_fade: Option<Fade>,
    /// Ball-ball friction that decreases with slip speed; replaces `mu_b` in impacts.
    #[serde(rename = "mu_b_slip", default, skip_serializing_if = "Option::is_none")]
    pub ball_slip_friction: Option<SlipFriction>,
    /// Effective mass of the cue's end, kg. Its lateral inertia makes a ball squirt; `None` for no squirt.
    #[serde(rename = "m_end", default, skip_serializing_if = "Option::is_none")]
    pub cue_end_mass: Option<f64>,
    /// Acceleration of a free body on a table that is not level, m/s² along x and y.
    #[serde(default, skip_serializing_if = "is_default")]
    pub tilt: DVec2,
    /// Opening rules of a game: `thesis` or `umb`.
    #[serde(default, skip_serializing_if = "is_default")]
    pub opening: Opening,
    /// Sizes that limit how low the cue can be held; `None` if every elevation can be played.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub room: Option<Room>,
    /// Constants of balls that leave the cloth and land on it; `None` if all balls stay on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flight: Option<Flight>,
    /// Model of the rails; by default balls meet them at the height of their centre.
    #[serde(default, skip_serializing_if = "is_default")]
    pub rail: Rails,
    /// Uncertainty of the constants, if the table's file states it; [`TableDoubt::of`] returns it for every table.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubt: Option<TableDoubt>,
}

/// Why a table cannot be used.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum TableError {
    /// The name is neither that of a preset nor that of a file.
    #[error(
        "there is no table \"{0}\"; use \"match\", \"textbook\", \"thesis\", one of your own by its name, or the path of a TOML file"
    )]
    Unknown(String),
    /// The TOML text does not describe a table.
    #[error("the table file is not valid: {0}")]
    Syntax(String),
    /// A value is outside what the equations allow.
    #[error("the table \"{table}\" has {key} = {}; accepted is {accepted}", number(*value))]
    Value {
        /// The table's name.
        table: String,
        /// The TOML key.
        key: &'static str,
        /// The refused value.
        value: f64,
        /// What would be accepted.
        accepted: &'static str,
    },
    /// The `[doubt]` section is invalid.
    #[error("the table \"{table}\": {error}")]
    Doubt {
        /// The table's name.
        table: String,
        /// The problem found.
        error: DoubtError,
    },
}

impl Table {
    /// Returns one of the bundled tables ([`PRESETS`]).
    ///
    /// # Errors
    /// [`TableError::Unknown`] for any other name.
    pub fn preset(name: &str) -> Result<Self, TableError> {
        // Parsed once, because every attempt of an exercise needs its table.
        static BUNDLED: LazyLock<[Table; PRESETS.len()]> = LazyLock::new(|| {
            [MATCH, TEXTBOOK, THESIS]
                .map(|text| Table::from_toml(text).expect("a bundled table is valid: a test reads them all"))
        });
        let bundled = BUNDLED.iter().find(|table| table.name == name);
        bundled.cloned().ok_or_else(|| TableError::Unknown(name.to_owned()))
    }

    /// Reads the table from the `text` of the file at `path`. If it has a bundled table's name but different values, it is named after its
    /// file, because players and saved records identify a table by its name alone.
    ///
    /// # Errors
    /// As [`Table::from_toml`]; [`TableError::Value`] also for sides that are exchanged or given in centimetres.
    pub fn from_file(path: &Path, text: &str) -> Result<Self, TableError> {
        let table = Self::from_toml(text)?;
        let flaw = if table.length > MAX_SIDE {
            Some(("L", table.length, "at most 10 m"))
        } else {
            (table.width > table.length).then_some(("l", table.width, "at most L, the longer side"))
        };
        if let Some((key, value, accepted)) = flaw {
            return Err(TableError::Value { table: table.name, key, value, accepted });
        }
        if !Self::preset(&table.name).is_ok_and(|bundled| bundled != table) {
            return Ok(table);
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let is_bundled = PRESETS.contains(&&*stem);
        Ok(Self { name: if is_bundled { format!("own {stem}") } else { stem.into_owned() }, ..table })
    }

    /// Parses a table from TOML text and checks every value.
    ///
    /// # Errors
    /// [`TableError::Syntax`], [`TableError::Value`] or [`TableError::Doubt`].
    pub fn from_toml(text: &str) -> Result<Self, TableError> {
        let table = toml::Deserializer::parse(text).and_then(Self::deserialize);
        let table = table.map_err(|error| TableError::Syntax(describe_toml_error(text, &error)))?;
        table.validated()
    }

    fn validated(self) -> Result<Self, TableError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        // Without friction on the cloth, a shot would never end.
        let cloth = |x: f64| (1e-4..=1e3).contains(&x);
        let restitution = |x: f64| (0.0..=1.0).contains(&x);
        let Self { length, width, radius, ball_mass, cue_mass, gravity, miscue_limit, opening_offset, .. } = self;
        let (spin, mu_rail, mu_b) = (self.spinning_friction, self.rail_friction, self.ball_friction.unwrap_or(0.0));
        let values: [Check; 14] = [
            // Keeps [`super::TOUCHING_TOLERANCE`] far below the size of a ball.
            (
                "R",
                radius,
                (1e-4..f64::INFINITY).contains(&radius),
                "a finite number of metres from 0.0001 on; a carom ball has 0.03075",
            ),
            // Ball: from a light toy ball to more than any stone ball. Cue: from a stick to an iron bar.
            ("m", ball_mass, (0.001..=1.0).contains(&ball_mass), "0.001 to 1 kg; a carom ball has 0.21"),
            ("M", cue_mass, (0.05..=5.0).contains(&cue_mass), "0.05 to 5 kg; a carom cue has 0.5"),
            // From asteroids to four times Jupiter. Outside this range, balls hardly separate or hardly ever stop.
            ("g", gravity, (0.1..=100.0).contains(&gravity), "0.1 to 100 m/s²; the Earth has 9.81"),
            ("L", length, positive(length), "a positive number of metres"),
            ("l", width, positive(width), "a positive number of metres"),
            ("mu_s", self.sliding_friction, cloth(self.sliding_friction), "0.0001 to 1000"),
            ("mu_r", self.rolling_friction, cloth(self.rolling_friction), "0.0001 to 1000"),
            ("mu_sp", spin, (0.0..=1e3).contains(&spin), "0 to 1000"),
            ("mu_rail", mu_rail, flaws::is_accepted_friction(mu_rail), flaws::ACCEPTED_FRICTION),
            ("mu_b", mu_b, flaws::is_accepted_friction(mu_b), "0 to below 1, or no mu_b at all for no slip"),
            ("e_ball", self.ball_restitution, restitution(self.ball_restitution), "0 to 1"),
            ("e_rail", self.rail_restitution, restitution(self.rail_restitution), "0 to 1"),
            ("miscue_limit", miscue_limit, miscue_limit > 0.0 && miscue_limit <= 1.0, "above 0 and at most 1"),
        ];
        let has_room_for_d = opening_offset >= 2.0 * radius && opening_offset <= self.half_width();
        let sizes: [Check; 3] = [
            // Two balls cannot block all three spots, which are a quarter of the length apart: see `Layout::with_spotted`.
            ("L", length, length >= 16.0 * radius, "at least sixteen ball radii"),
            // Three balls fit side by side, with room for `d`.
            ("l", width, width >= 6.0 * radius, "at least six ball radii"),
            ("d", opening_offset, has_room_for_d, "from two ball radii to l/2 - R"),
        ];
        let sections =
            self.room.iter().flat_map(|room| room.checks(radius)).chain(self.flight.iter().flat_map(Flight::checks));
        let mut all = values.into_iter().chain(flaws::checks(&self)).chain(sizes).chain(sections);
        if let Some((key, value, _, accepted)) = all.find(|(_, _, holds, _)| !holds) {
            return Err(TableError::Value { table: self.name, key, value, accepted });
        }
        if let Some(error) = self.doubt.as_ref().and_then(|doubt| doubt.validate().err()) {
            return Err(TableError::Doubt { table: self.name, error });
        }
        Ok(self)
    }

    /// Returns the largest |x| of a ball's centre: `L/2 - R`, m.
    pub fn half_length(&self) -> f64 {
        0.5 * self.length - self.radius
    }

    /// Returns the largest |y| of a ball's centre: `l/2 - R`, m.
    pub fn half_width(&self) -> f64 {
        0.5 * self.width - self.radius
    }

    /// Returns the corner of the rectangle that ball centres can reach, m.
    pub fn reach(&self) -> DVec2 {
        DVec2::new(self.half_length(), self.half_width())
    }

    /// Returns the coefficient of friction between a ball and the cushion of `rail`.
    pub fn friction_of(&self, rail: Rail) -> f64 {
        self.rail.overrides(rail).mu.unwrap_or(self.rail_friction)
    }

    /// Whether both tables have the same playing area and ball size, so that a layout of one fits the other.
    pub fn has_size_of(&self, other: &Self) -> bool {
        (self.length, self.width, self.radius) == (other.length, other.width, other.radius)
    }

    /// Returns the largest restitution between two balls or at any rail.
    pub fn largest_restitution(&self) -> f64 {
        let rails = Rail::ALL.map(|rail| self.rail.overrides(rail).e.unwrap_or(self.rail_restitution));
        rails.into_iter().fold(self.ball_restitution, f64::max)
    }

    /// Returns the table as a player at its other end sees it.
    #[must_use]
    pub fn seen_from_other_end(&self) -> Self {
        Self { tilt: -self.tilt, rail: self.rail.seen_from_other_end(), ..self.clone() }
    }

    /// Returns the distance between two neighbouring diamonds (sights), one eighth of the length, m.
    pub fn diamond(&self) -> f64 {
        self.length / 8.0
    }

    /// Converts a position in metres from the centre to diamonds from the lower left corner of the cushion noses, as layouts are typed.
    pub fn to_diamonds(&self, position: DVec2) -> DVec2 {
        (position + 0.5 * DVec2::new(self.length, self.width)) / self.diamond()
    }
}

/// With `remote = "Self"` serde derives inherent functions. The traits are implemented here, because reading must also validate.
impl Serialize for Table {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

/// Validates a table wherever it is read, be it from a run, a policy or the last session: with invalid values a shot might never end.
impl<'de> Deserialize<'de> for Table {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::deserialize(deserializer)?.validated().map_err(D::Error::custom)
    }
}

impl Default for Table {
    /// The `match` table, which models the table that players use.
    fn default() -> Self {
        Self::preset(PRESETS[0]).expect("the first of the bundled tables is one of them")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_table_names_what_would_be_accepted() {
        let message = Table::preset("snooker").unwrap_err().to_string();
        assert!(message.contains("snooker") && message.contains("match") && message.contains("thesis"));
    }

    #[test]
    fn invalid_toml_is_refused_with_its_line() {
        let message = Table::from_toml(&TEXTBOOK.replace("mu_s = 0.2", "mu_s = \"slow\"")).unwrap_err().to_string();
        let words = "line 9, mu_s: invalid type: string \"slow\", expected a number";
        assert!(message.contains(words), "{message}");
        assert!(Table::from_toml("").unwrap_err().to_string().ends_with("`name` is missing"));
        let message = Table::from_toml(&TEXTBOOK.replace("R = 0.03075", "R = inf")).unwrap_err().to_string();
        assert!(message.contains("R = inf; accepted is a finite number of metres from 0.0001 on"), "{message}");
    }

    #[test]
    fn contact_friction_with_non_unique_forces_is_refused() {
        for (from, to) in [("mu_rail = 0.2", "mu_rail = 1"), ("mu_b = 0.06", "mu_b = 10")] {
            assert!(TEXTBOOK.contains(from));
            let message = Table::from_toml(&TEXTBOOK.replace(from, to)).unwrap_err().to_string();
            assert!(message.contains(to) && message.contains("accepted is 0 to below 1"), "{message}");
        }
        assert!(Table::from_toml(&TEXTBOOK.replace("mu_rail = 0.2", "mu_rail = 0.99")).is_ok());
    }

    #[test]
    fn table_on_which_two_balls_could_block_all_spots_is_refused() {
        let of_length = |radii: f64| {
            let table = Table::default();
            Table { length: radii * table.radius, ..table }.validated()
        };
        assert!(of_length(16.0).is_ok());
        let message = of_length(15.9).unwrap_err().to_string();
        assert!(message.contains("L = 0.48") && message.contains("at least sixteen ball radii"), "{message}");
    }

    #[test]
    fn too_steep_a_slope_is_refused() {
        let (tilt, rolling_friction) = (DVec2::new(0.0588, 0.0), 0.03);
        let leaning = |sliding_friction| Table { sliding_friction, rolling_friction, tilt, ..Table::default() };
        assert!(leaning(0.03).validated().is_ok());
        let refused = leaning(0.0015).validated().unwrap_err().to_string();
        assert!(refused.contains("a fifth of mu_r g and of mu_s g"), "{refused}");
    }

    #[test]
    fn impossible_values_are_refused_by_name_and_value() {
        let with = |from: &str, to: &str| {
            assert!(TEXTBOOK.contains(from), "{from}");
            Table::from_toml(&TEXTBOOK.replace(from, to)).map_err(|error| error.to_string())
        };
        let (gravity, ball, cue) = ("\ng = 9.81", "\nm = 0.21", "\nM = 0.54");
        for (from, to, says) in [
            (gravity, "\ng = 1e9", "g = 1000000000; accepted is 0.1 to 100 m/s²"),
            (gravity, "\ng = 0.01", "g = 0.01; accepted is"),
            (gravity, "\ng = nan", "g = NaN; accepted is"),
            (ball, "\nm = 1e300", "m = 1e300; accepted is 0.001 to 1 kg"),
            (ball, "\nm = 0", "m = 0; accepted is"),
            (cue, "\nM = 1e-9", "accepted is 0.05 to 5 kg"),
            (cue, "\nM = 210", "M = 210; accepted is"),
            ("e_rail = 0.85", "e_rail = 1.5", "e_rail = 1.5; accepted is 0 to 1"),
            ("mu_s = 0.2", "mu_s = nan", "mu_s = NaN; accepted is"),
            ("mu_r = 0.010", "mu_r = 0", "mu_r = 0; accepted is"),
        ] {
            let message = with(from, to).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
        // Gravity of the Moon and Jupiter; pool and snooker balls; a child's cue.
        for (from, to) in [
            (gravity, "\ng = 1.62"),
            (gravity, "\ng = 24.8"),
            (ball, "\nm = 0.17"),
            (ball, "\nm = 0.142"),
            (cue, "\nM = 0.25"),
        ] {
            with(from, to).unwrap();
        }
    }

    #[test]
    fn changed_table_with_a_preset_name_is_named_after_its_file() {
        let name = |path: &str, text: &str| Table::from_file(Path::new(path), text).unwrap().name;
        assert_eq!(name("mine.toml", TEXTBOOK), "textbook");
        let changed = TEXTBOOK.replace("mu_r = 0.010", "mu_r = 0.011");
        assert_eq!(name("a/mine.toml", &changed), "mine");
        assert_eq!(name("a/match.toml", &changed), "own match");
        assert_eq!(name("a/b.toml", &changed.replace("\"textbook\"", "\"club\"")), "club");
    }

    #[test]
    fn table_length_is_the_longer_side_and_at_most_10_m() {
        let table = Table::preset("textbook").unwrap();
        let refused = |length: f64, width: f64| {
            let text = toml::to_string(&Table { length, width, ..table.clone() }).unwrap();
            Table::from_file(Path::new("own.toml"), &text).unwrap_err().to_string()
        };
        assert!(refused(1.42, 2.84).contains("l = 2.84; accepted is at most L"), "{}", refused(1.42, 2.84));
        assert!(refused(284.0, 142.0).contains("L = 284; accepted is at most 10 m"));
    }

    #[test]
    fn the_toml_form_survives_a_round_trip() {
        let table = Table::preset("thesis").unwrap();
        let text = toml::to_string(&table).unwrap();
        assert_eq!(Table::from_toml(&text).unwrap(), table);
    }
}
