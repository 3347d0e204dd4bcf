//! Numbers and events in the words of a player.

use glam::DVec2;
use indicatif::HumanCount;

pub use crate::printing::fixed;
use crate::{
    coach::{
        Skill,
        words::{LengthUnit, short},
    },
    game::Rule,
    simulation::{EventKind, Rail},
    statistics::SuccessRate,
    table::{CueBall, Table},
};

/// The cushion's name as it lies on the screen.
pub const fn rail_name(rail: Rail) -> &'static str {
    match rail {
        Rail::Left => "left rail",
        Rail::Right => "right rail",
        Rail::Bottom => "bottom rail",
        Rail::Top => "top rail",
    }
}

/// Why a table or a position is not saved whose name another has, where nobody can be asked whether that may be replaced.
pub fn taken_words(name: &str) -> String {
    format!("{name} is not saved: there is another of this name")
}

/// What happens, in a few words, for who plays with `cue_ball`.
pub fn event_words(kind: EventKind, cue_ball: CueBall) -> String {
    let name = |ball: usize| cue_ball.names()[ball];
    match kind {
        EventKind::BallBall(first, second) => format!("{} - {}", name(first), name(second)),
        EventKind::BallRail(ball, rail) => format!("{} - {}", name(ball), rail_name(rail)),
        EventKind::SlidingRolling(ball) => format!("{} rolls", name(ball)),
        EventKind::RollingStationary(ball) => format!("{} stops", name(ball)),
        EventKind::ContactBegins(ball) => format!("{} contact begins", name(ball)),
        EventKind::ContactEnds(ball) => format!("{} contact ends", name(ball)),
        EventKind::Jumps(ball) => format!("{} jumps", name(ball)),
        EventKind::Lands(ball) => format!("{} lands", name(ball)),
        EventKind::LeavesTable(ball) => format!("{} leaves the table", name(ball)),
    }
}

/// The rule's name where there is little room.
pub const fn rule_word(rule: Rule) -> &'static str {
    match rule {
        Rule::StraightRail => "straight",
        Rule::OneCushion => "1-cushion",
        Rule::ThreeCushion => "3-cushion",
    }
}

/// The user at the table, by where the skill comes from; a skill with a name is nobody's in particular.
fn user_word(skill: Skill) -> &'static str {
    // What notes give is a multiple of a level's errors in hundredths; what is set has any average.
    let hundredths = (100.0 * skill.scale()).round() / 100.0;
    // By its words: a file has degrees, which come back as nearly the same radians.
    let is_noted = skill.as_average().is_none() && Skill::level(hundredths).to_string() == skill.to_string();
    if is_noted { "me by my notes" } else { "me as set" }
}

/// The name of a skill that has one.
pub fn named_skill(skill: Skill) -> Option<&'static str> {
    Skill::NAMED.iter().find(|(_, named)| *named == skill).map(|(name, _)| *name)
}

/// The player in a few words: the skill's name, or whether it is the user's as set or by notes, with the average at three-cushion.
pub fn skill_word(skill: Skill) -> String {
    let own = || format!("{}: {}", user_word(skill), average_words(skill));
    named_skill(skill).map_or_else(own, str::to_owned)
}

/// The same of somebody else.
pub fn others_skill_word(skill: Skill) -> String {
    named_skill(skill).map_or_else(|| format!("average {}", average_words(skill)), str::to_owned)
}

/// The same in fewer, without the average.
pub fn short_skill_word(skill: Skill) -> &'static str {
    named_skill(skill).unwrap_or_else(|| user_word(skill))
}

/// The player, and the average at three-cushion where that is known.
pub fn player_words(skill: Skill) -> String {
    let name = short_skill_word(skill);
    if skill.is_perfect() { name.to_owned() } else { format!("{name} (average {})", average_words(skill)) }
}

/// The average at three-cushion, as far as it is known: that of the named levels is about as much, a player's own has two decimals.
fn average_words(skill: Skill) -> String {
    let ((least, most), average) = (Skill::AVERAGES, Skill::average(skill.scale()));
    match named_skill(skill) {
        _ if average > most => format!("above {most}"),
        _ if average < least => format!("below {least}"),
        Some(_) => short((20.0 * average).round() / 20.0, 2),
        None => short(average, 2),
    }
}

/// A probability in per cent, to a tenth where it is almost certain, never 100 before it is.
pub fn percent(probability: f64) -> String {
    let percent = 100.0 * probability;
    if (98.5..100.0).contains(&percent) { fixed((10.0 * percent).floor() / 10.0, 1) } else { fixed(percent, 0) }
}

/// A share with its 95 % interval, like 94 % (92-95).
pub fn chance_words(rate: &SuccessRate) -> String {
    let [rate, low, high] = [rate.rate, rate.low, rate.high].map(percent);
    if low == high { format!("{rate} %") } else { format!("{rate} % ({low}-{high})") }
}

/// A whole number with its thousands set off, like 1,234,567.
pub fn count(number: u64) -> String {
    HumanCount(number).to_string()
}

/// A whole number in few columns, like 950, 12.5k, 1.2M.
pub fn short_count(number: u64) -> String {
    for (unit, size) in [("G", 1e9), ("M", 1e6), ("k", 1e3)] {
        if number as f64 >= size {
            let text = format!("{:.1}", number as f64 / size);
            return format!("{}{unit}", text.strip_suffix(".0").unwrap_or(&text));
        }
    }
    number.to_string()
}

/// A time in its two largest units, like 45 s, 3 min 20 s, 2 h 5 min, 3 d 4 h.
pub fn time_words(seconds: f64) -> String {
    let seconds = seconds.max(0.0) as u64;
    let (minutes, hours, days) = (seconds / 60, seconds / 3600, seconds / 86_400);
    match () {
        () if days > 0 => format!("{days} d {} h", hours % 24),
        () if hours > 0 => format!("{hours} h {} min", minutes % 60),
        () if minutes > 0 => format!("{minutes} min {} s", seconds % 60),
        () => format!("{seconds} s"),
    }
}

/// The same where it may be years.
pub fn long_time_words(seconds: f64) -> String {
    let years = seconds / (365.25 * 86_400.0);
    if years < 2.0 { time_words(seconds) } else { format!("{} years", count(years as u64)) }
}

/// A length of so many metres in what balls are placed in: millimetres, or hundredths of an inch; without its symbol.
pub fn fine(metres: f64, unit: LengthUnit) -> String {
    let (in_a_metre, _, decimals) = unit.fine();
    fixed(in_a_metre * metres, decimals)
}

/// A speed of so many metres a second in the player's unit, with so many decimals.
pub fn speed_words(speed: f64, unit: LengthUnit, decimals: usize) -> String {
    let (factor, symbol) = unit.speed();
    format!("{} {symbol}", fixed(factor * speed, decimals))
}

/// A place in metres from the middle of `table` in diamonds from the lower left corner of the noses, as layouts are typed.
pub fn in_diamonds(table: &Table, place: DVec2) -> DVec2 {
    (place + 0.5 * DVec2::new(table.length, table.width)) / table.diamond()
}

/// A step of so many millimetres in what balls are placed in, without needless decimals.
pub fn step_words(millimetres: f64, unit: LengthUnit) -> String {
    let (in_a_metre, symbol, decimals) = unit.fine();
    format!("{} {symbol}", short(1e-3 * in_a_metre * millimetres, decimals))
}

/// The side of the tip's offset `a`, R positive to the shooter's left, or nothing for the centre.
pub fn across_word(a: f64) -> &'static str {
    match a {
        _ if a > 0.0 => "left",
        _ if a < 0.0 => "right",
        _ => "mid",
    }
}

/// The side of the tip's offset `b`, positive above the centre.
pub fn height_word(b: f64) -> &'static str {
    match b {
        _ if b > 0.0 => "above",
        _ if b < 0.0 => "below",
        _ => "mid",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_two_skills_of_the_user_have_two_names() {
        let set = Skill::of_average(0.6).unwrap();
        let noted = Skill::level(7.85);
        assert_eq!([set, noted, Skill::CLUB].map(skill_word), ["me as set: 0.6", "me by my notes: 0.18", "club"]);
        assert_eq!(player_words(noted), "me by my notes (average 0.18)");
        assert_eq!(player_words(Skill::CLUB), "club (average 0.5)");
        assert_eq!(skill_word(Skill { a: 1e-3, ..Skill::EXPERT }), "me as set: above 2.5");
    }

    #[test]
    fn places_steps_and_speeds_are_told_in_the_players_unit() {
        assert_eq!(LengthUnit::NAMED.map(|(_, unit)| speed_words(2.5, unit, 2)), ["2.50 m/s", "8.20 ft/s"]);
        assert_eq!(LengthUnit::NAMED.map(|(_, unit)| fine(-0.71, unit)), ["-710.0", "-27.95"]);
        assert_eq!([1.0, 10.0, 50.0].map(|mm| step_words(mm, LengthUnit::Metres)), ["1 mm", "10 mm", "50 mm"]);
        assert_eq!([1.0, 10.0, 50.0].map(|mm| step_words(mm, LengthUnit::Feet)), ["0.04 in", "0.39 in", "1.97 in"]);
    }

    #[test]
    fn a_shot_that_is_missed_once_in_a_thousand_is_not_certain() {
        assert_eq!([0.0, 0.934, 0.984, 0.99, 0.9996, 1.0].map(percent), ["0", "93", "98", "99.0", "99.9", "100"]);
        assert_eq!(chance_words(&SuccessRate::new(940, 1000)), "94 % (92-95)");
    }

    #[test]
    fn large_numbers_and_times_are_written_for_people() {
        assert_eq!([0, 999, 1000, 1_234_567].map(count), ["0", "999", "1,000", "1,234,567"]);
        assert_eq!([999, 12_500, 5_000_000].map(short_count), ["999", "12.5k", "5M"]);
        assert_eq!([59.9, 200.0, 7500.0, 273_600.0].map(time_words), ["59 s", "3 min 20 s", "2 h 5 min", "3 d 4 h"]);
    }

    #[test]
    fn a_time_beyond_two_years_is_told_in_years() {
        assert_eq!([90_000.0, 7.0e7, 3.2e11].map(long_time_words), ["1 d 1 h", "2 years", "10,140 years"]);
    }

    #[test]
    fn the_side_is_the_one_the_shooter_sees() {
        assert_eq!((across_word(0.2), across_word(-0.2), height_word(-0.1)), ("left", "right", "below"));
    }
}
