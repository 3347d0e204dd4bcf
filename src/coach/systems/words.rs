//! A system as a player counts it.

use std::fmt;

use super::{
    guide::{Applied, Guide},
    shift::Shift,
    system::{Numbers, System},
};

/// A system's number as players say it: tens a diamond are whole, others have a tenth.
pub fn number(system: System, number: f64) -> String {
    match system {
        System::Corner5 => format!("{number:.0}"),
        System::Plus | System::Seven => tenth(number),
    }
}

/// With a decimal, where it is not nought.
fn tenth(number: f64) -> String {
    let text = format!("{number:.1}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

/// As many decimals as are said.
fn rounded(system: System, number: f64) -> f64 {
    match system {
        System::Corner5 => number.round(),
        System::Plus | System::Seven => (10.0 * number).round() / 10.0,
    }
}

impl Applied {
    /// The arithmetic as a player does it, with the numbers as they are said: `50 - 30 = 20`.
    pub fn arithmetic(&self) -> String {
        let Numbers { start, third, .. } = self.numbers;
        let (sign, [one, other]) = match self.system {
            System::Corner5 => ("-", [start, third]),
            System::Plus => ("-", [third, start]),
            System::Seven => ("x", [start, third]),
        };
        let [one, other] = [one, other].map(|value| number(self.system, value));
        format!("{one} {sign} {other} = {}", self.aim())
    }

    /// What comes of it: the number on the first cushion.
    pub fn aim(&self) -> String {
        let Numbers { start, third, .. } = self.numbers;
        let [start, third] = [start, third].map(|number| rounded(self.system, number));
        let first = match self.system {
            System::Corner5 => start - third,
            System::Plus => third - start,
            System::Seven => start * third,
        };
        number(self.system, first)
    }

    /// What the table says to it; empty where it says nothing.
    pub fn correction(&self) -> String {
        let said = |value: f64| number(self.system, value);
        match (self.table_first, self.table_third) {
            (Some(first), _) if said(first) == self.aim() => "the same on your table".to_owned(),
            (Some(first), _) => format!("on your table {}", said(first)),
            (None, Some(third)) => format!("on your table it comes to {}", said(third)),
            (None, None) => String::new(),
        }
    }
}

impl fmt::Display for Applied {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}, aim at {}", self.system, self.arithmetic(), self.aim())?;
        let correction = self.correction();
        if correction.is_empty() { Ok(()) } else { write!(formatter, "; {correction}") }
    }
}

impl Shift {
    /// The parallel line, and where the shot arrives by it: `top 3 to top 5.1; aimed 0.4 beyond it, to 4.7`.
    pub fn counted(&self) -> String {
        let Self { rails: [first, last], diamond, arrival, by, third, table_third, .. } = self;
        let (first, last) = (first.name(), last.name());
        let side = if *by < 0.0 { "before" } else { "beyond" };
        // The sum holds as it stands there.
        let rounded = |number: f64| (10.0 * number).round() / 10.0;
        let third = rounded(*arrival) + rounded(third - arrival);
        let on_table = if tenth(third) == tenth(*table_third) {
            String::new()
        } else {
            format!(", on your table {table_third:.1}")
        };
        format!("{first} {diamond:.0} to {last} {arrival:.1}; aimed {:.1} {side} it, to {third:.1}{on_table}", by.abs())
    }
}

impl fmt::Display for Shift {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Parallel shift: {}", self.counted())
    }
}

impl fmt::Display for Guide {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::System(applied) => applied.fmt(formatter),
            Self::Shift(shift) => shift.fmt(formatter),
        }
    }
}
