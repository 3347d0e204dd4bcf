//! Numbers and events in words for players.

use indicatif::HumanCount;

pub use crate::printing::fixed;
use crate::{
    coach::{
        Skill,
        words::{LengthUnit, format_trimmed},
    },
    game::Rule,
    simulation::{EventKind, Rail},
    statistics::SuccessRate,
    table::CueBall,
};

/// Name of the cushion by its position on the screen.
pub const fn rail_name(rail: Rail) -> &'static str {
    match rail {
        Rail::Left => "left rail",
        Rail::Right => "right rail",
        Rail::Bottom => "bottom rail",
        Rail::Top => "top rail",
    }
}

/// The message that a table or position is not saved because its name is taken, for cases where the user cannot be asked about replacing
/// it.
pub fn name_taken_message(name: &str) -> String {
    format!("{name} is not saved: there is another of this name")
}

/// Describes an event in a few words, with balls named for the player of `cue_ball`.
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

/// Short name of the rule.
pub const fn rule_word(rule: Rule) -> &'static str {
    match rule {
        Rule::StraightRail => "straight",
        Rule::OneCushion => "1-cushion",
        Rule::ThreeCushion => "3-cushion",
    }
}

/// Name of the user's own skill, by its source: set by the user, or measured from their notes.
fn user_word(skill: Skill) -> &'static str {
    // A skill from notes is a multiple, in hundredths, of a level's errors; a skill that was set can have any average.
    let hundredths = (100.0 * skill.scale()).round() / 100.0;
    // Compared as text: files store degrees, so the radians may differ in the last digits after reading.
    let is_noted = skill.as_average().is_none() && Skill::level(hundredths).to_string() == skill.to_string();
    if is_noted { "me by my notes" } else { "me as set" }
}

/// Name of the skill, or `None` if it has none.
pub fn named_skill(skill: Skill) -> Option<&'static str> {
    Skill::NAMED.iter().find(|(_, named)| *named == skill).map(|(name, _)| *name)
}

/// Describes the player in a few words: the skill's name, or the source of the user's own skill and its average at three-cushion.
pub fn skill_word(skill: Skill) -> String {
    let own = || format!("{}: {}", user_word(skill), average_words(skill));
    named_skill(skill).map_or_else(own, str::to_owned)
}

/// Describes another player's skill in a few words.
pub fn others_skill_word(skill: Skill) -> String {
    named_skill(skill).map_or_else(|| format!("average {}", average_words(skill)), str::to_owned)
}

/// Like [`skill_word`], but without the average.
pub fn short_skill_word(skill: Skill) -> &'static str {
    named_skill(skill).unwrap_or_else(|| user_word(skill))
}

/// Describes the player, with the average at three-cushion unless the skill is perfect.
pub fn player_words(skill: Skill) -> String {
    let name = short_skill_word(skill);
    if skill.is_perfect() { name.to_owned() } else { format!("{name} (average {})", average_words(skill)) }
}

/// The average at three-cushion: rounded to 0.05 for the named levels, to two decimals for a player's own skill.
fn average_words(skill: Skill) -> String {
    let ((least, most), average) = (Skill::AVERAGES, Skill::average(skill.scale()));
    match named_skill(skill) {
        _ if average > most => format!("above {most}"),
        _ if average < least => format!("below {least}"),
        Some(_) => format_trimmed((20.0 * average).round() / 20.0, 2),
        None => format_trimmed(average, 2),
    }
}

/// Formats a probability in per cent: to a tenth below 1 % and from 98.5 % on, and never as 100 unless it is exactly 1.
pub fn percent(probability: f64) -> String {
    let percent = 100.0 * probability;
    if (98.5..100.0).contains(&percent) {
        fixed((10.0 * percent).floor() / 10.0, 1)
    } else if (0.05..0.95).contains(&percent) {
        fixed(percent, 1)
    } else {
        fixed(percent, 0)
    }
}

/// Formats a rate with its 95 % interval, like 94 % (92-95).
pub fn chance_words(rate: &SuccessRate) -> String {
    let [rate, low, high] = [rate.rate, rate.low, rate.high].map(percent);
    if low == high { format!("{rate} %") } else { format!("{rate} % ({low}-{high})") }
}

/// Formats a whole number with thousands separators, like 1,234,567.
pub fn count(number: u64) -> String {
    HumanCount(number).to_string()
}

/// Formats a whole number in few columns, like 950, 12.5k, 1.2M.
pub fn short_count(number: u64) -> String {
    for (unit, size) in [("G", 1e9), ("M", 1e6), ("k", 1e3)] {
        if number as f64 >= size {
            let text = format!("{:.1}", number as f64 / size);
            return format!("{}{unit}", text.strip_suffix(".0").unwrap_or(&text));
        }
    }
    number.to_string()
}

/// Formats a duration in its two largest units, like 45 s, 3 min 20 s, 2 h 5 min, 3 d 4 h.
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

/// Like [`time_words`], but in years from two years on.
pub fn long_time_words(seconds: f64) -> String {
    let years = seconds / (365.25 * 86_400.0);
    if years < 2.0 { time_words(seconds) } else { format!("{} years", count(years as u64)) }
}

/// Formats a length in the fine unit for placing balls: millimetres, or hundredths of an inch; without the symbol.
pub fn format_fine(metres: f64, unit: LengthUnit) -> String {
    let (in_a_metre, _, decimals) = unit.fine();
    fixed(in_a_metre * metres, decimals)
}

/// Formats a speed, given in metres per second, in the player's unit with `decimals` decimals.
pub fn speed_words(speed: f64, unit: LengthUnit, decimals: usize) -> String {
    let (factor, symbol) = unit.speed();
    format!("{} {symbol}", fixed(factor * speed, decimals))
}

/// Formats a step, given in millimetres, in the fine unit for placing balls, without trailing zeros.
pub fn step_words(millimetres: f64, unit: LengthUnit) -> String {
    let (in_a_metre, symbol, decimals) = unit.fine();
    format!("{} {symbol}", format_trimmed(1e-3 * in_a_metre * millimetres, decimals))
}

/// The side of the tip's offset `a`, in ball radii, positive to the shooter's left; "mid" for the centre.
pub fn across_word(a: f64) -> &'static str {
    match a {
        _ if a > 0.0 => "left",
        _ if a < 0.0 => "right",
        _ => "mid",
    }
}

/// The side of the tip's offset `b`, in ball radii, positive above the centre; "mid" for the centre.
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
    fn positions_steps_and_speeds_are_in_the_players_unit() {
        assert_eq!(LengthUnit::NAMED.map(|(_, unit)| speed_words(2.5, unit, 2)), ["2.50 m/s", "8.20 ft/s"]);
        assert_eq!(LengthUnit::NAMED.map(|(_, unit)| format_fine(-0.71, unit)), ["-710.0", "-27.95"]);
        assert_eq!([1.0, 10.0, 50.0].map(|mm| step_words(mm, LengthUnit::Metres)), ["1 mm", "10 mm", "50 mm"]);
        assert_eq!([1.0, 10.0, 50.0].map(|mm| step_words(mm, LengthUnit::Feet)), ["0.04 in", "0.39 in", "1.97 in"]);
    }

    #[test]
    fn a_shot_that_is_missed_once_in_a_thousand_is_not_certain() {
        assert_eq!([0.0, 0.934, 0.984, 0.99, 0.9996, 1.0].map(percent), ["0", "93", "98", "99.0", "99.9", "100"]);
        assert_eq!(chance_words(&SuccessRate::new(940, 1000)), "94 % (92-95)");
    }

    #[test]
    fn large_numbers_and_times_are_readable() {
        assert_eq!([0, 999, 1000, 1_234_567].map(count), ["0", "999", "1,000", "1,234,567"]);
        assert_eq!([999, 12_500, 5_000_000].map(short_count), ["999", "12.5k", "5M"]);
        assert_eq!([59.9, 200.0, 7500.0, 273_600.0].map(time_words), ["59 s", "3 min 20 s", "2 h 5 min", "3 d 4 h"]);
    }

    #[test]
    fn a_time_beyond_two_years_is_in_years() {
        assert_eq!([90_000.0, 7.0e7, 3.2e11].map(long_time_words), ["1 d 1 h", "2 years", "10,140 years"]);
    }

    #[test]
    fn sides_are_as_seen_by_the_shooter() {
        assert_eq!((across_word(0.2), across_word(-0.2), height_word(-0.1)), ("left", "right", "below"));
    }
}
