//! Parses marks as a player types them: a number, optionally with its unit and its standard error.

use super::{
    entries::{Entry, MOST_RAILS, Written},
    protocol::{Quantity, Test},
};
use crate::printing::typed_number;

/// Field name, next to the marks of a test, for the number of short rails that a ball has hit.
pub const RAILS: &str = "rails";

/// Field name, next to the marks of a test, for whether it was played from the far end.
pub const FAR_END: &str = "far-end";

/// Standard error of a position measured with a tape, as a player writes it.
pub const TAPED: &str = "5 mm";

impl Entry {
    /// Parses and stores the mark `name`, the number of [`RAILS`] or [`FAR_END`], as typed: `5.3`, `725 mm`, `5.3 ~ 0.2`, `yes`. An empty
    /// text or `-` means unknown and stores nothing.
    ///
    /// # Errors
    /// A message if the number of rails is not a number, or the far end is neither `yes` nor `no`.
    pub fn take(&mut self, name: &str, typed: &str) -> Result<(), String> {
        let typed = typed.trim();
        if typed.is_empty() || typed == "-" {
            return Ok(());
        }
        if name == RAILS {
            let no_number = |_| format!("rails {typed} is no number of rails; accepted is 0 to {MOST_RAILS}");
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
            self.sure.insert(name.to_owned(), written(sure));
        }
        Ok(())
    }

    /// Returns the mark as a player could type it; empty if it is unknown.
    pub fn typed(&self, name: &str) -> String {
        if name == RAILS {
            return self.rails.map_or_else(String::new, |rails| rails.to_string());
        }
        if name == FAR_END {
            return if self.far_end { "yes".to_owned() } else { String::new() };
        }
        let Some(value) = self.marks.get(name) else { return String::new() };
        let sure = self.sure.get(name).map_or_else(String::new, |sure| format!(" ~ {}", plain(sure)));
        plain(value) + &sure
    }
}

impl Test {
    /// Returns the names of the fields to fill in: the marks, then [`RAILS`] if a single ball is marked where it stops along the table.
    pub fn asked(&self) -> impl Iterator<Item = &'static str> {
        let has_rails =
            self.balls.len() == 1 && self.marks.iter().any(|mark| matches!(mark.quantity, Quantity::StopAlong(_)));
        self.marks.iter().map(|mark| mark.name).chain(has_rails.then_some(RAILS))
    }
}

/// Parses a typed value. A text that is not a number is kept, so that error messages can quote it.
fn written(typed: &str) -> Written {
    typed_number(typed).map_or_else(|| Written::Text(typed.trim().to_owned()), Written::Number)
}

fn plain(written: &Written) -> String {
    match written {
        Written::Number(number) => number.to_string(),
        Written::Text(text) => text.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Table;

    fn entry(typed: &[(&str, &str)]) -> Entry {
        let mut entry = Entry { test: "slow-roll".into(), ..Entry::default() };
        for (name, typed) in typed {
            entry.take(name, typed).unwrap();
        }
        entry
    }

    #[test]
    fn what_is_typed_is_read_and_can_be_typed_again() {
        let typed = [("time", "9,6"), ("stop", "725 mm ± 3 mm"), ("drift", "-"), ("rails", "1")];
        let entry = entry(&typed);
        let again: Vec<String> = Test::named("slow-roll").unwrap().asked().map(|name| entry.typed(name)).collect();
        assert_eq!(again, ["9.6", "725 mm ~ 3 mm", "", "1"]);
        let table = Table::default();
        let (readings, odd) = entry.readings(&table);
        assert_eq!((readings.len(), odd.len()), (2, 0), "{odd:?}");
        assert!((readings[1].sure - 0.003 / table.diamond()).abs() < 1e-12);
    }

    #[test]
    fn a_tape_measurement_has_the_same_error_typed_or_inferred_from_the_unit() {
        let table = Table::default();
        let sure = |typed: &str| entry(&[("stop", typed)]).readings(&table).0[0].sure;
        assert!((sure("725 mm") - sure(&format!("2.04 ± {TAPED}"))).abs() < 1e-3);
        assert!(sure("2.04") > 5.0 * sure("725 mm"));
    }

    #[test]
    fn a_text_that_is_no_number_is_quoted_in_the_error() {
        let problems = entry(&[("stop", "far")]).readings(&Table::default()).1;
        assert!(problems[0].contains("stop = \"far\" is no length"), "{problems:?}");
        let mut entry = Entry::default();
        assert!(entry.take(RAILS, "two").unwrap_err().contains("rails two is no number"));
    }
}
