//! Display of a system's arithmetic in players' notation.

use std::{fmt, ops::RangeInclusive};

use super::{
    guide::{Applied, Guide},
    shift::ParallelShift,
    system::{Numbers, System},
};
use crate::coach::words::format_trimmed;

/// Usual numbers of Corner-5: starts from 20 to 70 and arrivals from 5 to 45, those of the published examples and a little more.
const CORNER_5_USUAL: [RangeInclusive<f64>; 2] = [20.0..=70.0, 5.0..=45.0];

/// Formats a system's number: integers if the scale has tens per diamond, otherwise one decimal.
pub fn number(system: System, number: f64) -> String {
    match system {
        System::Corner5 => format!("{number:.0}"),
        System::Plus | System::Seven => format_trimmed(number, 1),
    }
}

/// Rounds to the displayed precision.
fn rounded(system: System, number: f64) -> f64 {
    match system {
        System::Corner5 => number.round(),
        System::Plus | System::Seven => (10.0 * number).round() / 10.0,
    }
}

impl Applied {
    /// Returns the player's arithmetic with the displayed numbers: `50 - 30 = 20`.
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

    /// Returns the result of the arithmetic: the number on the first cushion.
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

    /// Describes the correction for this table, and says if the numbers are outside the usual range; empty if there is nothing to say.
    pub fn correction(&self) -> String {
        let unusual = self.is_unusual().then(|| "outside the usual range of the system".to_owned());
        let parts = [self.table_correction(), unusual.unwrap_or_default()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("; ")
    }

    /// Whether the system is hardly ever played with these numbers, because its sums hold less and less well beyond them.
    fn is_unusual(&self) -> bool {
        let Numbers { start, third, .. } = self.numbers;
        let [starts, thirds] = CORNER_5_USUAL;
        self.system == System::Corner5 && !(starts.contains(&start) && thirds.contains(&third))
    }

    fn table_correction(&self) -> String {
        let said = |value: f64| number(self.system, value);
        match (self.table_first, self.table_third) {
            (Some(first), _) if said(first) == self.aim() => "the same on this table".to_owned(),
            (Some(first), _) => format!("on this table {}", said(first)),
            (None, Some(third)) if said(third) == said(self.numbers.third) => "the same on this table".to_owned(),
            (None, Some(third)) => {
                format!("on this table it comes to {} instead of {}", said(third), said(self.numbers.third))
            }
            (None, None) => String::new(),
        }
    }

    /// Returns the number at which the shot itself is aimed, with its own side and speed; `None` if it is the number
    /// displayed before.
    fn shot_number(&self) -> Option<String> {
        let said = |value: f64| number(self.system, value);
        let last = self.table_first.map_or_else(|| self.aim(), said);
        self.shot_first.map(said).filter(|shot| *shot != last)
    }
}

impl fmt::Display for Applied {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}, aim at {} on the wood", self.system, self.arithmetic(), self.aim())?;
        let correction = self.correction();
        if correction.is_empty() { Ok(()) } else { write!(formatter, "; {correction}") }
    }
}

impl ParallelShift {
    /// Describes where the line to the diamond leads, and the shot next to it: `aimed at diamond 3 of the top rail, the ball
    /// comes to 5.1 of the bottom rail; aimed at 3.4, as here, to 4.7`.
    pub fn description(&self) -> String {
        let Self { rails: [first, last], diamond, arrival, .. } = self;
        let (first, last) = (first.name(), last.name());
        format!(
            "aimed at diamond {diamond:.0} of the {first} rail, the ball comes to {arrival:.1} of the {last} rail; aimed at {:.1}, as \
             here, to {:.1}",
            self.shot_aim(),
            self.displayed_third()
        )
    }

    /// Like [`description`](Self::description) in fewer words, with the correction for this table: `diamond 3 of the top rail
    /// leads to 5.1 of the bottom rail; 3.4, as here, to 4.7; on this table to 4.6`.
    pub fn brief(&self) -> String {
        let Self { rails: [first, last], diamond, arrival, .. } = self;
        let (first, last) = (first.name(), last.name());
        let more = self.correction().map_or_else(String::new, |correction| format!("; {correction}"));
        format!(
            "diamond {diamond:.0} of the {first} rail leads to {arrival:.1} of the {last} rail; {:.1}, as here, to {:.1}{more}",
            self.shot_aim(),
            self.displayed_third()
        )
    }

    /// Describes the correction for this table: `on this table to 4.6`; `None` if it makes no difference.
    pub fn correction(&self) -> Option<String> {
        let is_other = format_trimmed(self.displayed_third(), 1) != format_trimmed(self.table_third, 1);
        is_other.then(|| format!("on this table to {:.1}", self.table_third))
    }

    /// Returns the predicted arrival, consistent with the displayed arrival and shift.
    fn displayed_third(&self) -> f64 {
        let rounded = |number: f64| (10.0 * number).round() / 10.0;
        rounded(self.arrival) + rounded(self.third - self.arrival)
    }
}

impl fmt::Display for ParallelShift {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Parallel shift: {}", self.description())?;
        self.correction().map_or(Ok(()), |correction| write!(formatter, "; {correction}"))
    }
}

impl Guide {
    /// Describes the whole calculation for a shot in one line: the numbers, the correction for this table, and the number at
    /// which the shot itself is aimed, which a shift always contains: `Corner-5: 50 - 30 = 20, aim at 20 on the wood;
    /// on this table 19, this shot at 17`.
    pub fn shot_words(&self) -> String {
        let at = match self {
            Self::System(applied) => applied.shot_number(),
            Self::Shift(_) => None,
        };
        at.map_or_else(|| self.to_string(), |at| format!("{self}, this shot at {at}"))
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
