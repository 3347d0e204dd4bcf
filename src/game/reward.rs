//! The thesis' rewards r1 to r4 (its 4.1.5), r1 with shot difficulty, and points under the cushion rules.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

use super::{Referee, Rule, Tally};
use crate::{
    physics::{CueInputs, has_room, strike},
    simulation::{AllSavings, Observer, simulate_with, watch_with},
    table::{Layout, Table},
};

/// The reward function of an agent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reward {
    /// 1 if the cue ball hits an object ball (equation 48).
    #[serde(rename = "r1")]
    R1,
    /// r1, halved by every cushion that the cue ball hits before the first object ball. The thesis only says that more
    /// cushions give less.
    #[serde(rename = "r1-difficulty")]
    R1Difficulty,
    /// r1 plus the distance reward of the balls at rest (equation 51).
    #[serde(rename = "r2")]
    R2,
    /// 1 if the cue ball hits both object balls (equation 52) and no ball leaves the table: a straight-rail point.
    #[default]
    #[serde(rename = "r3")]
    R3,
    /// r3 plus the distance reward (equation 53).
    #[serde(rename = "r4")]
    R4,
    /// 1 for a point under the one-cushion rule.
    #[serde(rename = "one-cushion")]
    OneCushion,
    /// 1 for a point under the three-cushion rule.
    #[serde(rename = "three-cushion")]
    ThreeCushion,
}

/// Error: an unknown name of a reward.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("there is no reward \"{0}\"; use r1, r1-difficulty, r2, r3, r4, one-cushion or three-cushion")]
pub struct UnknownReward(String);

impl Reward {
    /// All rewards.
    pub const ALL: [Self; 7] =
        [Self::R1, Self::R1Difficulty, Self::R2, Self::R3, Self::R4, Self::OneCushion, Self::ThreeCushion];

    /// Returns the name on the command line and in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::R1 => "r1",
            Self::R1Difficulty => "r1-difficulty",
            Self::R2 => "r2",
            Self::R3 => "r3",
            Self::R4 => "r4",
            Self::OneCushion => Rule::OneCushion.name(),
            Self::ThreeCushion => Rule::ThreeCushion.name(),
        }
    }

    /// Returns the largest reward that a shot can earn.
    pub const fn max_value(self) -> f64 {
        match self {
            Self::R2 | Self::R4 => 2.0,
            _ => 1.0,
        }
    }

    /// Returns the rule for which the reward is exactly 1 for a point and 0 otherwise; `None` if it is not of this kind.
    pub fn rule(self) -> Option<Rule> {
        Rule::ALL.into_iter().find(|rule| Self::for_rule(*rule) == self)
    }

    /// Returns the reward of a point under `rule`.
    pub const fn for_rule(rule: Rule) -> Self {
        match rule {
            Rule::StraightRail => Self::R3,
            Rule::OneCushion => Self::OneCushion,
            Rule::ThreeCushion => Self::ThreeCushion,
        }
    }

    /// Returns the reward of a shot, simulated until it is decided. The layout and the stroke are not validated.
    pub fn of(self, table: &Table, layout: &Layout, cue: &CueInputs) -> f64 {
        self.of_within_steps(table, layout, cue, u32::MAX)
    }

    /// Like [`Reward::of`], but gives up a shot whose resting contacts need more than `steps` integration steps; it
    /// keeps what it has earned so far. For training: such shots hardly ever earn more, because balls that press each
    /// other lose their speed.
    pub fn of_within_steps(self, table: &Table, layout: &Layout, cue: &CueInputs, steps: u32) -> f64 {
        let impulse = strike(table, cue);
        let enough = match self {
            Self::R1 | Self::R1Difficulty => Some(1),
            Self::R3 | Self::OneCushion | Self::ThreeCushion => Some(2),
            Self::R2 | Self::R4 => None,
        };
        let mut referee = Referee::new(enough, steps);
        if referee.wants_ends() {
            let end = simulate_with::<AllSavings, _>(table, layout, &impulse, &mut referee);
            self.value(table, &referee.tally, &end.layout(table))
        } else {
            watch_with::<AllSavings, _>(table, layout, &impulse, &mut referee);
            self.contact_reward(&referee.tally)
        }
    }

    /// Like [`Reward::of_within_steps`], but a stroke for which the cue has no room is not played and earns nothing.
    pub fn of_playable(self, table: &Table, layout: &Layout, cue: &CueInputs, steps: u32) -> f64 {
        if has_room(table, layout, cue) { self.of_within_steps(table, layout, cue, steps) } else { 0.0 }
    }

    /// Returns the reward of a shot with this `tally` and this final layout.
    pub fn value(self, table: &Table, tally: &Tally, end: &Layout) -> f64 {
        let distance = match self {
            Self::R2 | Self::R4 => distance_reward(table, end),
            _ => 0.0,
        };
        self.contact_reward(tally) + distance
    }

    /// Returns the part of the reward that depends on the contacts of the cue ball.
    fn contact_reward(self, tally: &Tally) -> f64 {
        let one = |made: bool| f64::from(u8::from(made));
        match self {
            Self::R1 | Self::R2 => one(tally.has_hit_any()),
            Self::R1Difficulty => one(tally.has_hit_any()) * 0.5_f64.powf(f64::from(tally.cushions_before_first)),
            Self::R3 | Self::R4 => one(tally.is_point(Rule::StraightRail)),
            Self::OneCushion => one(tally.is_point(Rule::OneCushion)),
            Self::ThreeCushion => one(tally.is_point(Rule::ThreeCushion)),
        }
    }
}

impl fmt::Display for Reward {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

impl FromStr for Reward {
    type Err = UnknownReward;

    fn from_str(text: &str) -> Result<Self, UnknownReward> {
        Self::ALL.into_iter().find(|reward| reward.name() == text).ok_or_else(|| UnknownReward(text.to_owned()))
    }
}

/// Returns the distance reward `r_d` (equation 50): 1 for balls close together, 0 for balls as far apart as the table allows.
fn distance_reward(table: &Table, layout: &Layout) -> f64 {
    let [a, b, c] = layout.balls;
    let total = a.distance(b) + a.distance(c) + b.distance(c);
    // The perimeter of a triangle in a rectangle is largest with its vertices in three corners: both sides and the diagonal.
    let reach = 2.0 * table.reach();
    1.0 - total / (reach.x + reach.y + reach.length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn distance_reward_ranges_from_zero_to_one() {
        let table = Table::default();
        let reach = table.reach();
        let corners = Layout::new([-reach, reach, DVec2::new(reach.x, -reach.y)]);
        assert!(distance_reward(&table, &corners).abs() < 1e-15);
        assert!(distance_reward(&table, &Layout::new([DVec2::ZERO; 3])) == 1.0);
    }

    #[test]
    fn direct_carom_earns_rewards_without_cushions() {
        let table = Table::default();
        let layout = Layout::parse("-0.4,0 0,0 0.2,0.28", &table).unwrap();
        let cue = CueInputs::parse("0,0.25,3,4.5,1.5").unwrap();
        let earned = |reward: Reward| reward.of(&table, &layout, &cue);
        assert_eq!([Reward::R1, Reward::R1Difficulty, Reward::R3].map(earned), [1.0; 3]);
        assert!([Reward::R2, Reward::R4].map(earned).iter().all(|reward| *reward > 1.0));
        assert_eq!([Reward::OneCushion, Reward::ThreeCushion].map(earned), [0.0; 2]);
    }

    #[test]
    fn stroke_without_room_earns_nothing() {
        let table = Table::default();
        // The second object ball lies in the way of the cue.
        let layout = |behind| Layout::parse(&format!("-0.4,0 0,0 {behind},0"), &table).unwrap();
        let cue = CueInputs::parse("0,0,10,0,2").unwrap();
        for reward in Reward::ALL {
            let earned = |behind| reward.of_playable(&table, &layout(behind), &cue, u32::MAX);
            assert_eq!(earned("0.5"), reward.of(&table, &layout("0.5"), &cue), "{reward}");
            assert_eq!(earned("-0.48"), 0.0, "{reward}");
        }
    }

    #[test]
    fn cushion_rewards_count_cushions_before_second_ball() {
        let layout = Layout::opening(&Table::default());
        let earned = |cushions| {
            let tally = Tally { hit: [true; 2], cushions, cushions_before_second: cushions, ..Tally::default() };
            [Reward::OneCushion, Reward::ThreeCushion].map(|reward| reward.value(&Table::default(), &tally, &layout))
        };
        assert_eq!([0, 1, 2, 3].map(earned), [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
    }

    #[test]
    fn point_rewards_are_zero_after_a_foul() {
        let layout = Layout::opening(&Table::default());
        let made = Tally { hit: [true; 2], cushions: 3, cushions_before_second: 3, ..Tally::default() };
        for reward in Reward::ALL.into_iter().filter(|reward| reward.rule().is_some()) {
            let earned = |tally| reward.value(&Table::default(), &tally, &layout);
            assert_eq!([earned(made), earned(Tally { left_table: true, ..made })], [1.0, 0.0], "{reward}");
        }
        let fouled = Tally { left_table: true, ..made };
        assert!(Reward::R4.value(&Table::default(), &fouled, &layout) < 1.0, "the distance reward alone");
    }

    #[test]
    fn each_cushion_before_first_ball_halves_r1_difficulty() {
        let tally = Tally { hit: [true, false], cushions: 3, cushions_before_first: 2, ..Tally::default() };
        let layout = Layout::opening(&Table::default());
        assert_eq!(Reward::R1Difficulty.value(&Table::default(), &tally, &layout), 0.25);
        assert_eq!(Reward::R3.value(&Table::default(), &tally, &layout), 0.0);
    }
}
