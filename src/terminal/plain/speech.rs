//! Sentences about balls and shots, to be read aloud.

use crate::{
    coach::{
        Aim, Growth, Input, Margin, Skill, jump_words,
        systems::Guide,
        words::{LengthUnit, TIP, TipUnit, Units},
    },
    physics::CueInputs,
    printing::number,
    simulation::{Event, EventKind, Recording},
    statistics::SuccessRate,
    table::{CueBall, Layout, Table},
    terminal::words::{event_words, fixed, percent, rail_name},
};

/// Small unit of length: how many make a metre, its name, and the decimals to display.
const fn small(unit: LengthUnit, decimals: usize) -> (f64, &'static str, usize) {
    let (in_a_metre, ..) = unit.fine();
    match unit {
        LengthUnit::Metres => (in_a_metre, "millimetres", decimals),
        LengthUnit::Feet => (in_a_metre, "inches", decimals + 2),
    }
}

/// Spells out the signs in sentences shared with the screen, so that they are read aloud the same way.
pub fn to_spoken(text: &str) -> String {
    text.replace(" %", " percent").replace('\u{b0}', " degrees")
}

/// Unit of speed in words.
pub const fn of_speed(unit: LengthUnit) -> &'static str {
    match unit {
        LengthUnit::Metres => "metres a second",
        LengthUnit::Feet => "feet a second",
    }
}

/// A coordinate in the small unit, with tenths of a millimetre only if they are not zero.
fn coordinate(metres: f64, unit: LengthUnit) -> String {
    let tenths = match unit {
        LengthUnit::Metres => 1,
        LengthUnit::Feet => 0,
    };
    let (in_a_metre, _, decimals) = small(unit, tenths);
    let text = fixed(in_a_metre * metres, decimals);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Positions of the balls; the cue ball is named if it is not white.
pub fn positions(table: &Table, layout: &Layout, cue_ball: CueBall, unit: LengthUnit) -> String {
    let (_, small, _) = small(unit, 0);
    let names = cue_ball.to_ball_order(["White", "Yellow", "Red"]);
    let place = |ball: usize| {
        let at = layout.balls[ball];
        let diamonds = table.to_diamonds(at);
        format!(
            "{} lies at {} diamonds along and {} up, {} and {} {small} from the middle.",
            names[ball],
            fixed(diamonds.x, 2),
            fixed(diamonds.y, 2),
            coordinate(at.x, unit),
            coordinate(at.y, unit)
        )
    };
    let positions = cue_ball.to_ball_order([0, 1, 2]).map(place).join("\n");
    if cue_ball == CueBall::White { positions } else { format!("{positions}\nThe cue ball is {cue_ball}.") }
}

/// The stroke in numbers.
pub fn stroke(table: &Table, cue: &CueInputs, aim: Option<&Aim>, cue_ball: CueBall, units: Units) -> String {
    let unit = units.length;
    let of_the_tip = if units.tip == TipUnit::Mm { LengthUnit::Metres } else { unit };
    let (in_a_metre, small, decimals) = small(of_the_tip, 1);
    let offset = |value: f64, plus: &str, minus: &str| match fixed(in_a_metre * table.radius * value.abs(), decimals) {
        zero if zero.chars().all(|letter| matches!(letter, '0' | '.')) => None,
        distance => Some(format!("{distance} {small} {}", if value > 0.0 { plus } else { minus })),
    };
    let tip = [offset(cue.a, "left", "right"), offset(cue.b, "above", "below")];
    let tip = tip.into_iter().flatten().collect::<Vec<_>>().join(" and ");
    let tip = if tip.is_empty() { "Strike the centre.".to_owned() } else { format!("Strike {tip} the centre.") };
    let cue_words = match fixed(cue.theta.to_degrees(), 1).as_str() {
        "0.0" => "level cue".to_owned(),
        degrees => format!("cue raised {degrees} degrees"),
    };
    let (speed, word) = (fixed(unit.speed().0 * cue.speed, 2), of_speed(unit));
    let speed = format!("Speed {speed} {word}, {cue_words}, direction {} degrees.", cue.phi_text(2));
    let mut lines = vec![tip, speed];
    if let Some(Aim { ahead, behind, hit }) = aim {
        lines.push(format!(
            "The line of aim comes from the {} at {} and goes to the {} at {}.",
            rail_name(behind.rail),
            units.position.exact(behind.diamond, table.diamond(), 2),
            rail_name(ahead.rail),
            units.position.exact(ahead.diamond, table.diamond(), 2)
        ));
        lines.extend(hit.map(|hit| {
            let side = hit.side().map_or_else(String::new, |side| format!(" on its {side} side"));
            let percent = fixed(100.0 * hit.fullness, 0);
            format!("The cue ball hits {} {percent} percent full{side}.", cue_ball.names()[hit.ball])
        }));
    }
    lines.join("\n")
}

/// The diamond system for a shot.
pub fn system(guide: Option<&Guide>) -> String {
    match guide {
        None => "No diamond system describes this shot.".to_owned(),
        Some(guide @ Guide::System(applied)) => {
            let system = applied.system;
            let side = if system.is_running() { "running side" } else { "no side" };
            format!(
                "{}.\nIn words: {}, with {side}: {}. Aim through the diamond on the wood.",
                guide.shot_words(),
                system.track(),
                system.rule()
            )
        }
        Some(Guide::Shift(shift)) => format!("{shift}. {}", shift.rule()),
    }
}

/// Explanation of the words used for shots.
pub fn words(table: &Table, unit: LengthUnit) -> String {
    let (in_a_metre, small, decimals) = small(unit, 1);
    let tip = fixed(in_a_metre * TIP * table.radius, decimals);
    format!(
        "Tips: how far the cue's tip is from the middle of the ball, {tip} {small} each; above and below, or of left and right side.\n\
         O'clock: the direction from the middle, as you look along the cue.\n\
         Running side makes the path off the first cushion longer, reverse side shorter.\n\
         Full: how much of the ball the cue ball covers at the hit; on the left is its left half.\n\
         Table lengths: how far a ball would run if struck at this speed in the centre; up the table and back is two.\n\
         Diamonds: counted from the lower left corner, 0 to 8 along the long rails, 0 to 4 up the short ones."
    )
}

/// The player's success rate at a shot, after the sentence about an attempt that makes no point.
pub fn chance(attempt: Option<String>, rate: Option<SuccessRate>, skill: Skill) -> Vec<String> {
    let rate = rate.map(|rate| {
        let [middle, low, high] = [rate.rate, rate.low, rate.high].map(percent);
        format!("{} makes it {middle} percent of the time, between {low} and {high}.", player(skill))
    });
    attempt.into_iter().chain(rate).collect()
}

/// Average of this skill at three-cushion, to two decimals.
pub fn average(skill: Skill) -> String {
    number((100.0 * Skill::average(skill.scale())).round() / 100.0)
}

/// Names the player, for the start of a sentence.
pub fn player(skill: Skill) -> String {
    if let Some(average) = skill.as_average() {
        return format!("A player who averages {average}");
    }
    match Skill::NAMED.iter().find(|(_, named)| *named == skill) {
        Some((name @ "expert", _)) => format!("An {name}"),
        Some((name @ "beginner", _)) => format!("A {name}"),
        Some((name, _)) => format!("A {name} player"),
        // The form of a user's own skill that was estimated.
        None if skill.growth == Growth::USUAL => format!("A player who averages {}", average(skill)),
        None => format!("Player {skill}"),
    }
}

/// Describes the player after a change.
pub fn now_plays(skill: Skill) -> String {
    skill.as_average().map_or_else(
        || format!("The player is {skill}."),
        |average| format!("The player averages {average} points an inning at three-cushion."),
    )
}

/// The success rate of the next point.
pub fn next_point(next: f64) -> String {
    format!("The point after it is made about {:.0} percent of the time.", 100.0 * next)
}

/// Whether the next point counts too, and its success rate.
pub fn plan(counts: bool, next: Option<f64>) -> String {
    let [now, other] = if counts { ["counts too", "off"] } else { ["does not count", "on"] };
    let next = next.map_or_else(String::new, |next| format!("{} ", next_point(next)));
    format!("The next point {now}. {next}Say plan {other} to change that.")
}

/// How far each input may be off.
pub fn margins(margins: &[Margin], unit: LengthUnit) -> String {
    let (_, small, _) = small(unit, 0);
    let line = |margin: &Margin| {
        let (name, word, less, more) = match margin.input {
            Input::Side => ("Side", small, "further right", "further left"),
            Input::Height => ("Height", small, "lower", "higher"),
            Input::Elevation => ("Cue", "degrees", "flatter", "steeper"),
            Input::Direction => ("Direction", "degrees", "to the right", "to the left"),
            Input::Speed => ("Speed", of_speed(unit), "softer", "harder"),
        };
        let (factor, _) = margin.input.display_unit(unit);
        let end = |end: Option<f64>, way: &str| match end {
            Some(end) => format!("up to {} {word} {way}", fixed(factor * end, 2)),
            // Every cue can be lowered only until it is level.
            None if way == "flatter" => "down to level".to_owned(),
            None => format!("far {way}"),
        };
        format!("{name}: {}, {}.", end(margin.less, less), end(margin.more, more))
    };
    margins.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// The contacts of a shot, or with `all` its events.
pub fn events(recording: &Recording, all: bool, cue_ball: CueBall, unit: LengthUnit) -> String {
    let names = cue_ball.names();
    let words = |kind: EventKind| match kind {
        EventKind::BallBall(one, other) => format!("{} meets {}", names[one], names[other]),
        EventKind::BallRail(ball, rail) => format!("{} meets the {}", names[ball], rail_name(rail)),
        other => event_words(other, cue_ball),
    };
    let jump = |event: &Event| {
        let jump = recording.jump_started_by(event);
        jump.map_or_else(String::new, |jump| format!(", {}", jump_words(&jump, unit)))
    };
    let line = |event: &Event| format!("{} seconds: {}{}.", fixed(event.time, 2), words(event.kind), jump(event));
    let mut lines: Vec<String> = recording.listed_events(all).map(line).collect();
    lines.push(format!("{} seconds: all balls lie still.", fixed(recording.duration(), 2)));
    lines.join("\n")
}
