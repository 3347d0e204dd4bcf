//! Parses marks as a player types them: a number, optionally with its unit and its standard error.

use super::{
    entries::{Entry, MAX_RAILS, MarkValue},
    protocol::{Quantity, Test},
};
use crate::printing::parse_number;

/// Field name, next to the marks of a test, for the number of short rails that a ball has hit.
pub const RAILS: &str = "rails";

/// Field name, next to the marks of a test, for whether it was played from the far end.
pub const FAR_END: &str = "far-end";

/// Standard error of a position measured with a tape, as a player writes it.
pub const TAPE_ERROR_TEXT: &str = "5 mm";

impl Entry {
    /// Parses and stores the mark `name`, the number of [`RAILS`] or [`FAR_END`], as typed: `5.3`, `725 mm`, `5.3 ~ 0.2`, `yes`. An empty
    /// text or `-` means unknown and stores nothing.
    ///
    /// # Errors
    /// A message if the number of rails is not a number, or the far end is neither `yes` nor `no`.
    pub fn set_field(&mut self, name: &str, typed: &str) -> Result<(), String> {
        let typed = typed.trim();
        if typed.is_empty() || typed == "-" {
            return Ok(());
        }
        if name == RAILS {
            let no_number = |_| format!("rails {typed} is no number of rails; accepted is 0 to {MAX_RAILS}");
            self.rails = Some(typed.parse().map_err(no_number)?);
            return Ok(());
        }
        if name == FAR_END {
            self.far_end = match typed {
                "yes" => true,
                "no" => false,
                _ => return Err(format!("far-end {typed} is not understood; accepted are yes and no")),
            };
            return Ok(());
        }
        let (value, sure) = typed.split_once(['±', '~']).map_or((typed, None), |(value, sure)| (value, Some(sure)));
        self.marks.insert(name.to_owned(), written(value));
        if let Some(sure) = sure {
            self.standard_errors.insert(name.to_owned(), written(sure));
        }
        Ok(())
    }

    /// Returns the mark as a player could type it; empty if it is unknown.
    pub fn field_text(&self, name: &str) -> String {
        if name == RAILS {
            return self.rails.map_or_else(String::new, |rails| rails.to_string());
        }
        if name == FAR_END {
            return if self.far_end { "yes".to_owned() } else { String::new() };
        }
        let Some(value) = self.marks.get(name) else { return String::new() };
        let sure = self.standard_errors.get(name).map_or_else(String::new, |sure| format!(" ~ {}", plain(sure)));
        plain(value) + &sure
    }
}

impl Test {
    /// Returns the names of the fields to fill in: the marks, then [`RAILS`] if a single ball is marked where it stops along the table.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> {
        let has_rails =
            self.balls.len() == 1 && self.marks.iter().any(|mark| matches!(mark.quantity, Quantity::StopAlong(_)));
        self.marks.iter().map(|mark| mark.name).chain(has_rails.then_some(RAILS))
    }
}

/// Parses a typed value. A text that is not a number is kept, so that error messages can quote it.
fn written(typed: &str) -> MarkValue {
    parse_number(typed).map_or_else(|| MarkValue::Text(typed.trim().to_owned()), MarkValue::Number)
}

fn plain(written: &MarkValue) -> String {
    match written {
        MarkValue::Number(number) => number.to_string(),
        MarkValue::Text(text) => text.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Table;

    fn entry(typed: &[(&str, &str)]) -> Entry {
        let mut entry = Entry { test: "slow-roll".into(), ..Entry::default() };
        for (name, typed) in typed {
            entry.set_field(name, typed).unwrap();
        }
        entry
    }

    #[test]
    fn typed_marks_survive_a_round_trip() {
        let typed = [("time", "9,6"), ("stop", "725 mm ± 3 mm"), ("drift", "-"), ("rails", "1")];
        let entry = entry(&typed);
        let again: Vec<String> =
            Test::named("slow-roll").unwrap().field_names().map(|name| entry.field_text(name)).collect();
        assert_eq!(again, ["9.6", "725 mm ~ 3 mm", "", "1"]);
        let table = Table::default();
        let (readings, odd) = entry.readings(&table);
        assert_eq!((readings.len(), odd.len()), (2, 0), "{odd:?}");
        assert!((readings[1].standard_error - 0.003 / table.diamond()).abs() < 1e-12);
    }

    #[test]
    fn tape_measurements_have_the_tape_error() {
        let table = Table::default();
        let sure = |typed: &str| entry(&[("stop", typed)]).readings(&table).0[0].standard_error;
        assert!((sure("725 mm") - sure(&format!("2.04 ± {TAPE_ERROR_TEXT}"))).abs() < 1e-3);
        assert!(sure("2.04") > 5.0 * sure("725 mm"));
    }

    #[test]
    fn invalid_numbers_are_quoted_in_the_error() {
        let problems = entry(&[("stop", "far")]).readings(&Table::default()).1;
        assert!(problems[0].contains("stop = \"far\" is no length"), "{problems:?}");
        let mut entry = Entry::default();
        assert!(entry.set_field(RAILS, "two").unwrap_err().contains("rails two is no number"));
    }
}
