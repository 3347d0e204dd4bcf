//! Why a shot misses: execution errors, unknown table constants, or unknown ball positions.

use std::fmt;

use serde::Serialize;

use super::Doubt;

/// How often a shot would be missed if only one source of error existed, as shares of the attempts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Risk {
    /// Due to execution errors alone.
    pub hand: f64,
    /// Due to unknown table constants alone.
    pub table: f64,
    /// Due to the ball positions alone.
    pub placing: f64,
}

/// Minimum share of attempts for a cause to be reported.
const MIN_REPORTED_SHARE: f64 = 0.02;

/// A source of error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// The player's execution errors.
    Hand,
    /// The table's constants.
    Table,
    /// The ball positions.
    Placing,
}

impl Cause {
    /// All causes.
    pub const ALL: [Self; 3] = [Self::Hand, Self::Table, Self::Placing];

    /// Returns the doubt that remains if this is the only cause, and whether the player makes execution errors.
    pub(super) const fn isolated(self, doubt: Doubt) -> (Doubt, bool) {
        match self {
            Self::Hand => (Doubt::NONE, true),
            Self::Table => (Doubt { placing: 0.0, ..doubt }, false),
            Self::Placing => (Doubt { table: 0.0, ..doubt }, false),
        }
    }
}

impl Risk {
    /// Returns the cause that alone misses the shot most often, given the total share of misses. `None` if no cause misses at
    /// least 2 % of the attempts, or the shot is at its limit.
    pub fn main_cause(&self, missed: Option<f64>) -> Option<Cause> {
        let all = [(Cause::Hand, self.hand), (Cause::Table, self.table), (Cause::Placing, self.placing)];
        let [first, ..] = all;
        let largest = all.into_iter().fold(first, |largest, other| if other.1 > largest.1 { other } else { largest });
        (largest.1 >= MIN_REPORTED_SHARE && !self.is_at_edge(missed)).then_some(largest.0)
    }

    /// Whether the intended stroke is at the edge of the region that makes the point. There any error misses, so that
    /// two causes alone miss as often as all together.
    fn is_at_edge(&self, missed: Option<f64>) -> bool {
        let mut shares = [self.hand, self.table, self.placing];
        shares.sort_by(f64::total_cmp);
        missed.is_some_and(|missed| shares[1] >= MIN_REPORTED_SHARE && shares[1] > 0.9 * missed)
    }

    /// Describes the risk in a sentence, given the total share of misses.
    pub fn words(&self, missed: Option<f64>) -> String {
        let [hand, table, placing] = [self.hand, self.table, self.placing].map(|share| 100.0 * share);
        let alone = format!(
            "missed due to the hand alone {hand:.0} %, the unknown table alone {table:.0} %, the ball positions alone {placing:.0} %"
        );
        match self.main_cause(missed) {
            _ if self.is_at_edge(missed) => format!(
                "{alone}; two of these alone miss as often as all together: the stroke is at the edge of what makes the point"
            ),
            Some(Cause::Table) => format!("{alone}; mostly the table, which carom calibrate measures"),
            Some(cause) => format!("{alone}; mostly {cause}"),
            None => alone,
        }
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Hand => "the hand",
            Self::Table => "the table",
            Self::Placing => "the ball positions",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn main_cause_alone_misses_most() {
        let risk = |hand, table, placing| Risk { hand, table, placing };
        assert_eq!(risk(0.3, 0.4, 0.1).main_cause(None), Some(Cause::Table));
        assert_eq!(risk(0.3, 0.1, 0.31).main_cause(None), Some(Cause::Placing));
        assert_eq!(risk(0.02, 0.0, 0.0).main_cause(None), Some(Cause::Hand));
        assert_eq!(risk(0.01, 0.0, 0.005).main_cause(None), None, "a shot that hardly ever misses");
    }

    #[test]
    fn no_main_cause_if_two_alone_miss_as_often() {
        let risk = Risk { hand: 0.37, table: 0.36, placing: 0.39 };
        assert!(risk.words(Some(0.354)).contains("two of these alone miss as often as all together"));
        assert_eq!((risk.main_cause(Some(0.354)), risk.main_cause(Some(0.7))), (None, Some(Cause::Placing)));
        assert!(
            risk.words(Some(0.7)).ends_with("mostly the ball positions")
                && risk.words(None).ends_with("mostly the ball positions")
        );
        let hand = Risk { hand: 0.37, table: 0.05, placing: 0.02 };
        assert!(hand.words(Some(0.38)).ends_with("mostly the hand"));
    }
}
