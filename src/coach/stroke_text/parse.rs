//! Parser for the parts of a stroke text.

use super::{Mark, Speed, StrokeText, StrokeTextError};
use crate::{
    coach::{
        RailPoint,
        systems::SIZE,
        words::{NUMBERS, PACES, SIXTEENTHS, TIP, pace_word},
    },
    simulation::Rail,
    table::BALL_NAMES,
};

/// Words for the fullness other than those in sixteenths.
const FULLNESS: [(&str, f64); 2] = [("thin", 0.25), ("thick", 0.75)];

impl StrokeText {
    /// Parses `text`. Also reads the coach's own words in tips and diamonds; skips its course of the cue ball after the
    /// first ball, which follows from the stroke.
    ///
    /// # Errors
    /// Fails if a part is not understood.
    pub fn parse(text: &str) -> Result<Self, StrokeTextError> {
        let mut stroke = Self::default();
        for line in text.to_lowercase().lines() {
            // Skips what follows from the stroke in the coach's words: the course, the pattern, and the reason up to the end of its line.
            let told = line.split("why:").next().unwrap_or_default();
            let follows = |said: &&str| [" \u{2013} ", " - ", "pattern:"].iter().any(|part| said.contains(part));
            let sentences = told.split(". ").filter(|said| !follows(said));
            for part in sentences.flat_map(parts) {
                let twice = |what| StrokeTextError::Duplicate(what, part.clone());
                parse_part(&part, &mut stroke, twice)?;
            }
        }
        // The coach gives both: "medium (2.9 table lengths)". Players round.
        if let (Some(pace), Some(Speed::Lengths(lengths))) = (stroke.pace, stroke.speed)
            && lengths >= 0.0
            && (pace - lengths.min(PACES.len() as f64)).abs() > 1.0
        {
            return Err(StrokeTextError::Pace(lengths, pace_word(lengths), pace_word(pace)));
        }
        if stroke == Self::default() { Err(StrokeTextError::Empty) } else { Ok(stroke) }
    }
}

/// Splits a line at commas, semicolons, brackets and full stops, except at those inside numbers.
fn parts(line: &str) -> Vec<String> {
    let letters: Vec<char> = line.replace('\u{bd}', ".5").chars().collect();
    let is_digit = |index: Option<usize>| index.and_then(|index| letters.get(index)).is_some_and(char::is_ascii_digit);
    let divided = letters.iter().enumerate().map(|(index, letter)| match letter {
        ',' if is_digit(index.checked_sub(1)) && is_digit(Some(index + 1)) => '.',
        '.' if is_digit(Some(index + 1)) => '.',
        ',' | ';' | '(' | ')' | '.' => '\n',
        letter => *letter,
    });
    let words = |part: &str| part.split_whitespace().collect::<Vec<_>>().join(" ");
    divided.collect::<String>().lines().map(words).filter(|part| !part.is_empty()).collect()
}

/// Parses one part into `stroke`.
fn parse_part(
    part: &str,
    stroke: &mut StrokeText,
    twice: impl Fn(&'static str) -> StrokeTextError + Copy,
) -> Result<(), StrokeTextError> {
    let not_understood = || StrokeTextError::UnknownPart(part.to_owned());
    // The coach's words for a stroke that hits none.
    if part == "no ball" {
        return Ok(());
    }
    // "Bottom long rail first at 3, then red": the cushions between the balls follow from the stroke.
    let part = match part.strip_prefix("then ") {
        Some(rail) if rail_named(rail).is_some() => return Ok(()),
        Some(part) => part,
        None => part,
    };
    if let Some((from, to)) = line_of_cue(part) {
        if let Some(from) = from {
            set(&mut stroke.from, Some(mark(from).ok_or_else(not_understood)?), twice("where the cue comes from"))?;
        }
        return set(&mut stroke.to, Some(mark(to).ok_or_else(not_understood)?), twice("where the cue points"));
    }
    if let Some((rail, diamond)) = part.split_once(" first at ") {
        let point = rail_named(rail).zip(diamond.parse().ok()).and_then(|(rail, diamond)| rail_point(rail, diamond));
        return set(&mut stroke.rail, Some(point.ok_or_else(not_understood)?), twice("the first cushion"));
    }
    if let Some(speed) = speed(part) {
        return set(&mut stroke.speed, Some(speed), twice("the speed"));
    }
    if let Some(place) = PACES.iter().position(|word| part == *word) {
        return set(&mut stroke.pace, Some(place as f64 + 1.0), twice("the speed"));
    }
    if let Some(degrees) = elevation(part) {
        return set(&mut stroke.elevation, Some(f64::to_radians(degrees)), twice("the cue's elevation"));
    }
    let (colour, rest) = colour(part);
    set(&mut stroke.colour, colour, twice("the ball"))?;
    if rest.is_empty() {
        return Ok(());
    }
    if let Some((fullness, left)) = fullness(&rest) {
        set(&mut stroke.fullness, Some(fullness), twice("how full"))?;
        return set(&mut stroke.left, left, twice("the side of the ball"));
    }
    let (side, height) = tip(part).filter(|_| colour.is_none()).ok_or_else(not_understood)?;
    set(&mut stroke.side, side, twice("side"))?;
    set(&mut stroke.height, height, twice("height"))
}

/// Sets a property that has not been set yet.
fn set<T>(place: &mut Option<T>, value: Option<T>, twice: StrokeTextError) -> Result<(), StrokeTextError> {
    match (place.is_some(), value) {
        (true, Some(_)) => Err(twice),
        (_, Some(value)) => {
            *place = Some(value);
            Ok(())
        }
        (_, None) => Ok(()),
    }
}

/// Parses the start, if stated, and the end of a line of aim: "cue from 2.8 on the left short rail to 1.65 on the right one",
/// "to 1.65 right", "left 2.8 → right 1.65", "through 2 top".
fn line_of_cue(part: &str) -> Option<(Option<&str>, &str)> {
    let arrow = part.split_once('\u{2192}').or_else(|| part.split_once("->"));
    let part = part.strip_prefix("cue ").or_else(|| part.strip_prefix("aim ")).unwrap_or(part);
    match arrow.or_else(|| part.strip_prefix("from ")?.split_once(" to ")) {
        Some((from, to)) => Some((Some(from), to)),
        None => Some((None, part.strip_prefix("to ").or_else(|| part.starts_with("through ").then_some(part))?)),
    }
}

/// Parses a point at a cushion: "1.65 on the right short rail", "right 1.65", "2 top on the wood". "through" refers to
/// a diamond, "to" to the nose.
fn mark(text: &str) -> Option<Mark> {
    let through = text.trim().strip_prefix("through ");
    let (text, wood) = match through.unwrap_or(text.trim()).split_once("wood") {
        Some((text, "")) => (text, true),
        Some(_) => return None,
        None => (through.unwrap_or(text.trim()), false),
    };
    let number = text.split_whitespace().find_map(|word| word.parse::<f64>().ok())?;
    let point = rail_point(rail_named(text)?, number)?;
    Some(Mark { point, on_wood: wood || through.is_some() })
}

/// Creates a point on a cushion; `None` beyond its ends.
fn rail_point(rail: Rail, diamond: f64) -> Option<RailPoint> {
    let along = if matches!(rail, Rail::Left | Rail::Right) { SIZE.y } else { SIZE.x };
    (0.0..=along).contains(&diamond).then_some(RailPoint { rail, diamond })
}

/// Finds the rail named in a text; `None` unless it names exactly one.
fn rail_named(text: &str) -> Option<Rail> {
    let named = |rail: &Rail| text.split_whitespace().any(|word| word == rail.name());
    let mut rails = Rail::ALL.into_iter().filter(named);
    rails.next().filter(|_| rails.next().is_none())
}

/// Parses a speed: "3.5 lengths", "4 table lengths", "medium 2.9", "2.3 m/s".
fn speed(part: &str) -> Option<Speed> {
    let (number, unit) = part.split_once(' ')?;
    let paced = PACES.iter().find_map(|word| part.strip_prefix(word)?.trim().parse().ok());
    match (paced, number.parse().ok()) {
        (Some(lengths), _) => Some(Speed::Lengths(lengths)),
        (None, Some(number)) => match unit {
            "length" | "lengths" | "table length" | "table lengths" => Some(Speed::Lengths(number)),
            "m/s" => Some(Speed::Cue(number)),
            "ft/s" => Some(Speed::Cue(0.3048 * number)),
            _ => None,
        },
        (None, None) => None,
    }
}

/// Parses the elevation of the cue, degrees: "level cue", "cue raised 20°", "20 degrees".
fn elevation(part: &str) -> Option<f64> {
    if part.contains("level") {
        return Some(0.0);
    }
    let text = part.strip_prefix("cue ").unwrap_or(part);
    let raised = text.strip_prefix("raised ");
    let text = raised.unwrap_or(text).trim_start_matches("by ");
    let number = ["degrees", "degree", "\u{b0}"].into_iter().find_map(|unit| text.strip_suffix(unit));
    number.or(raised)?.trim().parse().ok()
}

/// Finds the colour named in a part, as an index into white, yellow and red, and the rest of the part.
fn colour(part: &str) -> (Option<usize>, String) {
    let named = |word: &str| BALL_NAMES.iter().position(|name| *name == word);
    let is_other = |word: &&str| named(word).is_none() && !["the", "ball"].contains(word);
    let rest = part.split_whitespace().filter(is_other).collect::<Vec<_>>().join(" ");
    (part.split_whitespace().find_map(named), rest)
}

/// Parses the fullness of a hit, and whether it is on the left: "half full on the right", "1/2 right", "full".
fn fullness(text: &str) -> Option<(f64, Option<bool>)> {
    let (text, left) = match (text.strip_suffix("left"), text.strip_suffix("right")) {
        (Some(text), _) => (text, Some(true)),
        (_, Some(text)) => (text, Some(false)),
        _ => (text, None),
    };
    let text = bare(text);
    let sixteenths = SIXTEENTHS.iter().position(|words| bare(words) == text).map(|index| index as f64 / 16.0);
    let others = || FULLNESS.into_iter().find(|(word, _)| *word == text).map(|(_, fullness)| fullness);
    let fraction = || {
        let (part, whole) = text.split_once('/')?;
        let [part, whole] = [part, whole].map(|number| number.parse::<u8>().ok().map(f64::from));
        Some(part? / whole?)
    };
    let share = || text.strip_suffix('%')?.trim().parse::<f64>().ok().map(|percent| 0.01 * percent);
    let fullness = sixteenths.or_else(others).or_else(fraction).or_else(share)?;
    (0.0..=1.0).contains(&fullness).then_some((fullness, left))
}

/// Removes optional words from a description of the fullness.
fn bare(text: &str) -> String {
    let mut words: Vec<&str> =
        text.split_whitespace().filter(|word| !["a", "an", "on", "the"].contains(word)).collect();
    if words.len() > 1 {
        words.pop_if(|word| *word == "full");
    }
    words.join(" ")
}

/// Words next to a number of tips that add no information.
const IGNORED_WORDS: [&str; 9] = ["of", "running", "reverse", "english", "side", "centre", "center", "tip", "tips"];

/// Parses the tip position, to the left and up, radii: "1.5 left", "two tips of running right at 2 o'clock", "a little
/// above centre", "no side", "2 tips at 1:30".
fn tip(part: &str) -> Option<(Option<f64>, Option<f64>)> {
    match part {
        "centre ball" | "center ball" | "centre" | "center" => return Some((Some(0.0), Some(0.0))),
        "no side" | "no english" => return Some((Some(0.0), None)),
        "centre height" | "center height" => return Some((None, Some(0.0))),
        _ => {}
    }
    let (part, hour) = match part.split_once(" at ") {
        Some((part, hour)) => (part, Some(hour_named(hour)?)),
        None => (part, None),
    };
    let way = |word: &str| match word {
        "left" => Some((1.0, 0.0)),
        "right" => Some((-1.0, 0.0)),
        "up" | "above" | "high" | "follow" => Some((0.0, 1.0)),
        "down" | "below" | "low" | "draw" => Some((0.0, -1.0)),
        _ => None,
    };
    let words: Vec<&str> = part.split_whitespace().filter(|word| !IGNORED_WORDS.contains(word)).collect();
    let mut ways = words.iter().filter_map(|word| way(word));
    let (left, up) = match (ways.next(), hour) {
        (Some(way), _) => way,
        (None, Some(hour)) => (-f64::sin(hour), f64::cos(hour)),
        (None, None) => return None,
    };
    if ways.next().is_some() {
        return None;
    }
    let number: Vec<&str> = words.iter().filter(|word| way(word).is_none()).copied().collect();
    let offset = TIP * number_named(&number.join(" "))?;
    let along = |share: f64| (share != 0.0).then_some(share * offset);
    Some((along(left), along(up)))
}

/// Parses a number of tips: "1.5", "two", "one and a half", "half a", "a little".
fn number_named(text: &str) -> Option<f64> {
    let whole = |word: &str| {
        let named = NUMBERS.iter().position(|number| *number == word).map(|number| number as f64);
        named.or_else(|| word.parse().ok()).filter(|number| (0.0..=20.0).contains(number))
    };
    match text {
        "a little" | "half" | "half a" | "1/2" => Some(0.5),
        "a" => Some(1.0),
        _ => match text.strip_suffix(" and a half") {
            Some(text) => Some(whole(text)? + 0.5),
            None => whole(text),
        },
    }
}

/// Parses a clock position as an angle from 12 o'clock, clockwise, rad: "2 o'clock", "half past 1 o'clock", "1:30".
fn hour_named(text: &str) -> Option<f64> {
    let text = text.trim_end_matches(" o'clock");
    let (hour, minutes) = match (text.strip_prefix("half past "), text.split_once(':')) {
        (Some(hour), _) => (hour, 30.0),
        (None, Some((hour, minutes))) => (hour, minutes.parse::<u8>().ok().filter(|minutes| *minutes < 60)?.into()),
        (None, None) => (text, 0.0),
    };
    let hour = hour.parse::<u8>().ok().filter(|hour| (1..=12).contains(hour))?;
    Some(30_f64.to_radians() * (f64::from(hour) + minutes / 60.0))
}
