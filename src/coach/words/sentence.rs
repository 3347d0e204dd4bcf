//! Sentences that describe a shot: the stroke, the path of the cue ball, and the aim.

use super::{English, ShotWords, TIP, TipUnit, Units, format_trimmed, fullness_word, numbers, pace_word};
use crate::{
    coach::{Cushion, Hit, RailPoint},
    simulation::Rail,
    table::CueBall,
};

impl ShotWords {
    /// Describes the stroke in one sentence, for a player with `cue_ball`.
    pub fn sentence(&self, cue_ball: CueBall, units: Units) -> String {
        // Side that is nearly straight above or below the centre has no clock position of its own.
        let clock = self.clock.filter(|clock| clock % 6.0 != 0.0);
        let clock = clock.map_or_else(String::new, |clock| format!(" at {}", numbers::clock_words(clock)));
        let lengths = format_trimmed(self.table_lengths, 1);
        let unit = if lengths == "1" { "length" } else { "lengths" };
        self.sentence_with(cue_ball, units, &clock, &format!(" ({lengths} table {unit})"))
    }

    /// Like [`sentence`](Self::sentence), without the clock position and the table lengths, which repeat the tip
    /// position and the pace.
    pub fn short_sentence(&self, cue_ball: CueBall, units: Units) -> String {
        self.sentence_with(cue_ball, units, "", "")
    }

    fn sentence_with(&self, cue_ball: CueBall, units: Units, clock: &str, lengths: &str) -> String {
        let (first, tip) = (self.first_words(cue_ball, units), self.tip_words(units, clock));
        capitalize(&format!("{first}; {tip}; {}{lengths}, {}.", pace_word(self.table_lengths), self.cue_words()))
    }

    /// Describes the path of the cue ball: balls, cushions with positions, and the hit on the second ball.
    pub fn course(&self, cue_ball: CueBall, units: Units) -> String {
        let second = self.second.map_or_else(String::new, |hit| {
            let full = fullness_word(hit.fullness);
            format!(", {full}{}", if full == "full" { "" } else { side_words(hit) })
        });
        format!("{}{second}.", self.stops(cue_ball, units))
    }

    /// Like [`course`](Self::course), without the hit on the second ball.
    pub fn short_course(&self, cue_ball: CueBall, units: Units) -> String {
        self.stops(cue_ball, units) + "."
    }

    fn stops(&self, cue_ball: CueBall, units: Units) -> String {
        let names = cue_ball.names();
        let cushions = |cushions: &[Cushion]| -> Vec<String> {
            let one = |cushion: &Cushion| format!("{} {}", cushion.rail.name(), self.place(cushion.diamond, units, 1));
            cushions.iter().map(one).collect()
        };
        let mut stops = cushions(&self.before);
        stops.extend(self.first.map(|hit| names[hit.ball].to_owned()));
        let (until, since) = self.between.split_at(self.rehit_after.unwrap_or_default().min(self.between.len()));
        stops.extend(cushions(until));
        stops.extend(self.rehit_after.and(self.first).map(|hit| format!("{} again", names[hit.ball])));
        stops.extend(cushions(since));
        stops.extend(self.second.map(|hit| names[hit.ball].to_owned()));
        if stops.is_empty() {
            return "Hits neither ball nor cushion".to_owned();
        }
        capitalize(&stops.join(" \u{2013} "))
    }

    /// Describes the line of aim from cushion to cushion, measured at the noses.
    pub fn aim(&self, units: Units) -> String {
        let point =
            |point: RailPoint| format!("{} on the {}", self.place(point.diamond, units, 2), rail_words(point.rail));
        format!("Cue from {} to {}.", point(self.behind), point(self.ahead))
    }

    /// Describes the first object ball and its fullness, after any cushions before it and the position on the first of them.
    fn first_words(&self, cue_ball: CueBall, units: Units) -> String {
        let ball = self.first.map(|hit| {
            let (full, is_middle) = numbers::fullness_words(hit.fullness);
            format!("{}, {full}{}", cue_ball.names()[hit.ball], if is_middle { "" } else { side_words(hit) })
        });
        // For a shot that hits no ball, only its first cushion is reported.
        let met = if ball.is_none() && self.before.is_empty() { self.between.get(..1) } else { Some(&self.before[..]) };
        let cushion = met.unwrap_or_default().split_first().map(|(first, others)| {
            let first = format!("{} first at {}", rail_words(first.rail), self.place(first.diamond, units, 1));
            others.iter().fold(first, |words, other| words + ", then " + rail_words(other.rail))
        });
        let meets = match (cushion, ball) {
            (Some(cushion), Some(ball)) => format!("{cushion}, then {ball}"),
            (Some(cushion), None) => format!("{cushion}, no ball"),
            (None, Some(ball)) => ball,
            (None, None) => "no ball".to_owned(),
        };
        match self.over {
            Some(ball) => format!("jumps over {}, then {meets}", cue_ball.names()[ball]),
            None => meets,
        }
    }

    /// Describes the tip position, with `clock` if there is side.
    fn tip_words(&self, units: Units, clock: &str) -> String {
        let [side, height] = [self.tips_right, self.tips_above].map(|tips| match units.tip {
            TipUnit::Tips => {
                let halves = (2.0 * tips.abs()).round() as u32;
                (halves > 0).then(|| numbers::tips_words(halves))
            }
            TipUnit::Mm => {
                let text = format_trimmed(1e3 * self.radius * TIP * tips.abs(), 1);
                (text != "0").then(|| format!("{text} mm"))
            }
        });
        let running = match self.english {
            Some(English::Running) => "running ",
            Some(English::Reverse) => "reverse ",
            None => "",
        };
        let way = if self.tips_right > 0.0 { "right" } else { "left" };
        let side = side.map(|side| format!("{side} of {running}{way}"));
        let above = if self.tips_above > 0.0 { "above" } else { "below" };
        let height = height.map(|height| match height.as_str() {
            "half a tip" => format!("a little {above} centre"),
            _ => format!("{height} {above} centre"),
        });
        match (side, height) {
            (None, None) => "centre ball".to_owned(),
            (None, Some(height)) => format!("no side, {height}"),
            (Some(side), height) => {
                format!("{side}{clock}, {}", height.unwrap_or_else(|| "centre height".to_owned()))
            }
        }
    }

    /// Describes the elevation of the cue.
    fn cue_words(&self) -> String {
        match self.elevation_deg.round() {
            _ if self.has_level_cue() => "level cue".to_owned(),
            _ if self.is_level => "cue as level as it can be".to_owned(),
            degrees => format!("cue raised {degrees}\u{b0}"),
        }
    }

    /// Formats a position along a cushion.
    fn place(&self, diamonds: f64, units: Units, decimals: usize) -> String {
        units.position.words(diamonds, self.diamond, decimals)
    }
}

/// Returns the half of a ball that is hit.
const fn side_words(hit: Hit) -> &'static str {
    if hit.left { " on the left" } else { " on the right" }
}

/// Returns the name of a cushion, by its position on the screen.
const fn rail_words(rail: Rail) -> &'static str {
    match rail {
        Rail::Top => "top long rail",
        Rail::Bottom => "bottom long rail",
        Rail::Left => "left short rail",
        Rail::Right => "right short rail",
    }
}

/// Capitalises the first letter.
pub fn capitalize(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
