//! The units in which lengths are displayed.

use super::TIP;

/// Unit of the tip's distance from the centre of the ball.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TipUnit {
    /// Tips of [`super::TIP`] ball radii.
    #[default]
    Tips,
    /// Millimetres.
    Mm,
}

/// Unit of positions along the cushions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PositionUnit {
    /// Diamonds, an eighth of the table's length each.
    #[default]
    Diamonds,
    /// Millimetres.
    Mm,
}

/// Units of distances on the table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metres and centimetres.
    #[default]
    Metres,
    /// Feet and inches.
    Feet,
}

/// An inch, m.
const INCH: f64 = 0.0254;

/// The units in which lengths are displayed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Units {
    /// Unit of the tip position.
    pub tip: TipUnit,
    /// Unit of positions along the cushions.
    pub position: PositionUnit,
    /// Units of distances.
    pub length: LengthUnit,
}

impl PositionUnit {
    /// Both units, by name.
    pub const NAMED: [(&'static str, Self); 2] = [("diamonds", Self::Diamonds), ("mm", Self::Mm)];

    /// Formats a position along a cushion, given in diamonds of `diamond` m each. Diamonds have no unit name.
    pub fn words(self, diamonds: f64, diamond: f64, decimals: usize) -> String {
        match self {
            Self::Diamonds => format_trimmed(diamonds, decimals),
            Self::Mm => format!("{} mm", format_trimmed(1e3 * diamond * diamonds, 0)),
        }
    }

    /// Like [`words`](Self::words), with all of these decimals of a diamond, or to a millimetre, and the unit's name.
    pub fn exact(self, diamonds: f64, diamond: f64, decimals: u8) -> String {
        match self {
            // Adding zero removes the minus sign of a rounded zero.
            Self::Diamonds => {
                let parts = 10_f64.powi(i32::from(decimals));
                format!("{:.*} diamonds", usize::from(decimals), (parts * diamonds).round() / parts + 0.0)
            }
            Self::Mm => format!("{:.0} mm", (1e3 * diamond * diamonds).round() + 0.0),
        }
    }
}

impl TipUnit {
    /// Both units, by name.
    pub const NAMED: [(&'static str, Self); 2] = [("tips", Self::Tips), ("mm", Self::Mm)];

    /// Formats a tip distance from the centre, given in `radii` of a ball of this `radius`, m: to a tenth of a tip or
    /// of a millimetre, without the side. `None` if it rounds to zero.
    pub fn words(self, radii: f64, radius: f64) -> Option<String> {
        let (size, name) = match self {
            Self::Tips => (radii.abs() / TIP, "tip"),
            Self::Mm => (1e3 * radius * radii.abs(), "mm"),
        };
        let tenths = (10.0 * size).round();
        let plural = if self == Self::Tips && tenths > 10.0 { "s" } else { "" };
        (tenths > 0.0).then(|| format!("{} {name}{plural}", format_trimmed(0.1 * tenths, 1)))
    }
}

impl LengthUnit {
    /// Both units, by name.
    pub const NAMED: [(&'static str, Self); 2] = [("metres", Self::Metres), ("feet", Self::Feet)];

    /// Returns the smaller of the two units: the number per metre, and the symbol.
    pub const fn small(self) -> (f64, &'static str) {
        match self {
            Self::Metres => (100.0, "cm"),
            Self::Feet => (1.0 / INCH, "in"),
        }
    }

    /// Returns the unit of ball positions: the number per metre, the symbol, and the number of decimals.
    pub const fn fine(self) -> (f64, &'static str, usize) {
        match self {
            Self::Metres => (1000.0, "mm", 1),
            Self::Feet => (1.0 / INCH, "in", 2),
        }
    }

    /// Returns the unit of speed: the factor from m/s, and the symbol.
    pub const fn speed(self) -> (f64, &'static str) {
        match self {
            Self::Metres => (1.0, "m/s"),
            Self::Feet => (1.0 / (12.0 * INCH), "ft/s"),
        }
    }

    /// Formats a distance in metres; in the smaller unit if it is below a metre or 24 inches.
    pub fn words(self, metres: f64) -> String {
        match self {
            Self::Metres if metres < 0.095 => format!("{} cm", format_trimmed(100.0 * metres, 1)),
            Self::Metres if metres < 0.995 => format!("{:.0} cm", 100.0 * metres),
            Self::Metres => format!("{} m", format_trimmed(metres, 1)),
            Self::Feet if metres < 24.0 * INCH => format!("{} in", format_trimmed(metres / INCH, 1)),
            Self::Feet => format!("{} ft", format_trimmed(metres / INCH / 12.0, 1)),
        }
    }
}

/// Formats a number with this number of decimals, without trailing zeros.
pub fn format_trimmed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_use_the_unit_that_fits() {
        let told = |unit: LengthUnit| [0.004, 0.03, 0.31, 1.26].map(|metres| unit.words(metres));
        assert_eq!(told(LengthUnit::Metres), ["0.4 cm", "3 cm", "31 cm", "1.3 m"]);
        assert_eq!(told(LengthUnit::Feet), ["0.2 in", "1.2 in", "12.2 in", "4.1 ft"]);
        assert_eq!([format_trimmed(-0.01, 1), format_trimmed(30.0, 0), format_trimmed(3.10, 2)], ["0", "30", "3.1"]);
    }

    #[test]
    fn tip_distance_is_rounded_to_tenths() {
        let told =
            |unit: TipUnit| [0.0001, 0.049, -0.1, 0.45].map(|radii| unit.words(radii, 0.03075).unwrap_or_default());
        assert_eq!(told(TipUnit::Tips), ["", "0.5 tip", "1 tip", "4.5 tips"]);
        assert_eq!(told(TipUnit::Mm), ["", "1.5 mm", "3.1 mm", "13.8 mm"]);
    }
}
