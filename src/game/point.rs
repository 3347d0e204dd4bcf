//! The conditions of a point: the rule, and the required first ball at the opening of a match.

use super::{Rule, Tally};
use crate::table::{Layout, Opening, Table};

/// The conditions of a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Point {
    /// The rule.
    pub rule: Rule,
    /// Whether the red ball must be hit before the other object ball.
    pub red_first: bool,
}

impl From<Rule> for Point {
    fn from(rule: Rule) -> Self {
        Self { rule, red_first: false }
    }
}

impl Point {
    /// Returns the conditions for a shot from this layout. In the opening position by UMB rules, a shot must hit the red
    /// ball first.
    #[inline]
    pub fn of(rule: Rule, table: &Table, layout: &Layout) -> Self {
        Self { rule, red_first: table.opening == Opening::Umb && layout.is_opening(table) }
    }

    /// Returns the object ball that must be hit first, or ball 1 if either may be.
    pub const fn first_ball(self) -> usize {
        if self.red_first { 2 } else { 1 }
    }

    /// Whether a shot with this tally is a point; it can still become one until both object balls are hit.
    pub fn is_made(self, tally: &Tally) -> bool {
        tally.is_point(self.rule) && (tally.red_first || !self.red_first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        game::scores,
        physics::CueInputs,
        simulation::{Event, EventKind, Rail},
        table::Side,
    };

    #[test]
    fn opening_by_umb_rules_requires_red_first() {
        let umb = Table { opening: Opening::Umb, ..Table::default() };
        let thesis = Table { opening: Opening::Thesis, ..Table::default() };
        for side in [Side::Left, Side::Right] {
            let layout = Layout::opening_on(&umb, side);
            for rule in Rule::ALL {
                assert!(Point::of(rule, &umb, &layout).red_first);
                assert!(!Point::of(rule, &thesis, &layout).red_first);
            }
            let mut later = layout;
            later.balls[2].y += 0.01;
            assert!(!Point::of(Rule::ThreeCushion, &umb, &later).red_first);
        }
        assert!(!Point::of(Rule::ThreeCushion, &thesis, &Layout::opening(&thesis)).red_first);
    }

    #[test]
    fn other_ball_first_is_no_point_if_red_required() {
        let [one, two, three] = [Rail::Top, Rail::Left, Rail::Bottom].map(|rail| EventKind::BallRail(0, rail));
        let tally = |first, second| {
            let mut tally = Tally::default();
            for kind in [EventKind::BallBall(0, first), one, two, three, EventKind::BallBall(0, second)] {
                tally.count(&Event { time: 0.0, kind });
            }
            tally
        };
        let point = Point { rule: Rule::ThreeCushion, red_first: true };
        assert!(point.is_made(&tally(2, 1)) && !point.is_made(&tally(1, 2)));
        assert!(Point::from(Rule::ThreeCushion).is_made(&tally(1, 2)));
    }

    /// From the opening, some strokes make three cushions off the opponent's ball; these do not count.
    #[test]
    fn opening_shot_scores_only_if_red_is_first() {
        let umb = Table { opening: Opening::Umb, ..Table::default() };
        let free = Table { opening: Opening::Thesis, ..umb.clone() };
        let layout = Layout::opening(&umb);
        let (mut kept, mut lost) = (0, 0);
        for step in 0..3600 {
            let phi = f64::from(step) * 0.1_f64.to_radians();
            let cue = CueInputs { a: if step % 2 == 0 { 0.4 } else { -0.4 }, b: 0.0, theta: 0.0, phi, speed: 4.0 };
            let [strict, loose] = [&umb, &free].map(|table| scores(Rule::ThreeCushion, table, &layout, &cue));
            assert!(loose || !strict);
            kept += u32::from(strict);
            lost += u32::from(loose && !strict);
        }
        assert!(kept > 3 && lost > 3, "{kept} {lost}");
    }
}
