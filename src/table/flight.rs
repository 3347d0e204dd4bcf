//! Constants of the cloth for balls that leave it and land on it again.

use serde::{Deserialize, Serialize};

use super::flaws::Check;

/// The cloth as a ball hits it from above: the TOML section `[flight]`. Without this section all balls stay on the cloth, as in the thesis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Flight {
    /// Coefficient of restitution `e_c` of ball and cloth, 0 to below 1.
    #[serde(rename = "e_c")]
    pub restitution: f64,
    /// Coefficient of friction `mu_c` of a ball that lands on the cloth; `None` for the coefficient of sliding friction.
    #[serde(rename = "mu_c", skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}

impl Default for Flight {
    /// A cloth on slate, which returns half of a ball's vertical speed.
    fn default() -> Self {
        Self { restitution: 0.5, friction: None }
    }
}

impl Flight {
    /// Checks every value.
    pub(super) fn checks(&self) -> [Check; 2] {
        let (e, mu) = (self.restitution, self.friction.unwrap_or(0.0));
        let accepted = "0 to 0.99: a ball that loses nothing would hop forever";
        [
            ("flight.e_c", e, (0.0..=MAX_RESTITUTION).contains(&e), accepted),
            ("flight.mu_c", mu, (0.0..=1e3).contains(&mu), "0 to 1000"),
        ]
    }
}

/// Largest accepted restitution of the cloth: hops that lose less than a hundredth of their speed last for minutes.
const MAX_RESTITUTION: f64 = 0.99;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Table, TableError};

    /// Returns the textbook table with an additional section `[flight]`.
    fn table(flight: &str) -> Result<Table, TableError> {
        let table = Table::preset("textbook").unwrap();
        Table::from_toml(&format!("{}\n{flight}", toml::to_string(&table).unwrap()))
    }

    #[test]
    fn flight_section_overrides_defaults_and_its_absence_disables_flight() {
        assert_eq!(table("").unwrap().flight, None);
        assert_eq!(table("[flight]").unwrap().flight, Some(Flight::default()));
        let hard = table("[flight]\ne_c = 0.7\nmu_c = 0.15").unwrap();
        assert_eq!(hard.flight, Some(Flight { restitution: 0.7, friction: Some(0.15) }));
        assert_eq!(Table::from_toml(&toml::to_string(&hard).unwrap()).unwrap(), hard);
    }

    #[test]
    fn cloth_restitution_of_one_or_more_is_refused() {
        for (line, says) in [
            ("e_c = 1.0", "flight.e_c = 1; accepted is 0 to 0.99"),
            ("e_c = -0.1", "flight.e_c = -0.1"),
            ("e_c = nan", "flight.e_c = NaN"),
            ("mu_c = -1.0", "flight.mu_c = -1"),
        ] {
            let message = table(&format!("[flight]\n{line}")).unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
    }
}
