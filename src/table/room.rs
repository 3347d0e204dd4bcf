//! Sizes of the cue and the rails, which limit how low the cue can be held.

use serde::{Deserialize, Serialize};

use super::flaws::Check;

/// Sizes of the cue and of the rails that it passes over: the TOML section `[room]`. Omitted sizes are those of a regulation table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Room {
    /// Width of the cue at its tip, m.
    pub tip: f64,
    /// Increase of the cue's width along its length, m per m.
    pub taper: f64,
    /// Length of the cue, m.
    pub length: f64,
    /// Height of the nose above the cloth, m; the top of the rail is at the same height.
    pub nose: f64,
    /// Width of the rail from the nose to its outer edge, m.
    pub rail: f64,
}

impl Default for Room {
    /// A carom cue and the rails of a UMB table.
    fn default() -> Self {
        Self { tip: 0.012, taper: 0.008, length: 1.4, nose: 0.037, rail: 0.13 }
    }
}

impl Room {
    /// Checks every size for balls of `radius`, m.
    pub(super) fn checks(&self, radius: f64) -> [Check; 5] {
        [
            ("room.tip", self.tip, self.tip > 0.0 && self.tip <= 2.0 * radius, "above 0 and at most a ball's diameter"),
            ("room.taper", self.taper, (0.0..=0.1).contains(&self.taper), "0 to 0.1 m a metre"),
            ("room.length", self.length, self.length > 0.0 && self.length <= 10.0, "above 0 and at most 10 m"),
            (
                "room.nose",
                self.nose,
                self.nose > 0.0 && self.nose < 2.0 * radius,
                "above 0 and less than a ball's diameter",
            ),
            ("room.rail", self.rail, (0.0..=1.0).contains(&self.rail), "0 to 1 m"),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Table, TableError};

    /// Returns the default table with an additional section `[room]`.
    fn table(room: &str) -> Result<Table, TableError> {
        let table = Table { room: None, ..Table::default() };
        Table::from_toml(&format!("{}\n{room}", toml::to_string(&table).unwrap()))
    }

    #[test]
    fn room_section_overrides_defaults_and_its_absence_removes_limits() {
        assert_eq!(table("").unwrap().room, None);
        assert_eq!(table("[room]").unwrap().room, Some(Room::default()));
        let high = table("[room]\nnose = 0.04").unwrap();
        assert_eq!(high.room, Some(Room { nose: 0.04, ..Room::default() }));
        assert_eq!(Table::from_toml(&toml::to_string(&high).unwrap()).unwrap(), high);
    }

    #[test]
    fn impossible_sizes_are_refused_by_name_and_value() {
        for (line, says) in [
            ("nose = 0.07", "room.nose = 0.07"),
            ("nose = -1", "room.nose = -1"),
            ("tip = nan", "room.tip = NaN"),
            ("taper = 0.5", "0 to 0.1 m a metre"),
            ("length = 0", "room.length = 0"),
            ("rail = 2", "room.rail = 2"),
            ("shaft = 1", "unknown name"),
        ] {
            let message = table(&format!("[room]\n{line}")).unwrap_err().to_string();
            assert!(message.contains(says), "{line}: {message}");
        }
    }
}
