//! The shot card: object ball and thickness, side, height, speed and cue elevation, one row each.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    coach::{
        RailPoint, ShotWords,
        words::{English, TIP, TipUnit, format_trimmed, lengths_words, pace_word},
    },
    terminal::{
        Proposal,
        pages::coach::{
            CoachPage,
            view::{shot::WIDE, words::place_along},
        },
        ui::{Ui, columns, draw_title, shorten, to_displayable},
        words::{chance_words, fixed, percent, speed_words},
    },
};

/// Width of a row's name with the blanks around it, columns.
const NAME: usize = 8;
/// Denominator of displayed thicknesses: parts of a ball.
const PARTS: u32 = 16;

/// Draws the panel of a shot that the coach proposes.
pub fn draw_card(proposal: &Proposal, coach: &CoachPage, area: Rect, ui: &mut Ui) {
    let is_wide = area.width >= WIDE;
    let inner = draw_title(chance_title(proposal, is_wide, ui), area, ui);
    let rows = if is_wide {
        wide_rows(proposal, coach, usize::from(area.width), usize::from(inner.height))
    } else {
        narrow_rows(proposal, coach)
    };
    for ((name, mut value), row) in rows.into_iter().zip(inner.y..inner.bottom()) {
        let mut line = Line::default();
        if is_wide {
            line.push_span(Span::styled(format!(" {name:<width$}", width = NAME - 1), ui.theme.faint()));
        } else {
            // A narrow row has no room for " degrees".
            value = value.replace('\u{b0}', ui.caps.pick("\u{b0}", " deg"));
        }
        let room = usize::from(inner.width).saturating_sub(line.width());
        line.push_span(Span::styled(shorten(&to_displayable(&value, ui.caps), room, ui.caps), ui.theme.text()));
        ui.buffer.set_line(inner.x, row, &line, inner.width);
    }
}

/// The title of the panel of a shot that the coach proposes.
pub fn chance_title(proposal: &Proposal, is_wide: bool, ui: &Ui) -> Vec<Span<'static>> {
    let chance = chance_span(proposal, is_wide, ui);
    if proposal.is_early && !is_wide {
        return vec![chance];
    }
    vec![Span::styled("Shot", ui.theme.text()), ui.dash(), chance]
}

/// The success rate of the shot, or whether the shot makes the point at all if it has no rate.
pub fn chance_span(proposal: &Proposal, is_wide: bool, ui: &Ui) -> Span<'static> {
    let (words, style) = match &proposal.made {
        _ if !proposal.shot.solved => ("misses".to_owned(), ui.theme.warning()),
        None => ("point".to_owned(), ui.theme.good()),
        Some(made) if proposal.is_early => (format!("so far {} %", percent(made.rate)), ui.theme.accent()),
        Some(made) if is_wide => (chance_words(made), ui.theme.good()),
        Some(made) => (format!("{} %", percent(made.rate)), ui.theme.good()),
    };
    Span::styled(words, style)
}

type Row = (&'static str, String);

/// Formats a position along a cushion before the first ball.
fn cushion_place(coach: &CoachPage, diamonds: f64) -> String {
    coach.units.position.words(diamonds, coach.table().diamond(), 1)
}

/// The rows of a narrow card, at most 14 columns wide, the more important rows first.
fn narrow_rows(proposal: &Proposal, coach: &CoachPage) -> Vec<Row> {
    let words = &proposal.shot.words;
    // There is no room for the unit.
    let bare = |place: String| place.replace(" mm", "");
    let mut rows = Vec::new();
    rows.extend(words.before.first().map(|cushion| {
        // The card then has no row for the side on which the ball is hit; the sentence in the other panel contains it.
        format!("off {} {}", cushion.rail.name(), bare(cushion_place(coach, cushion.diamond)))
    }));
    match words.first {
        None => rows.push("no ball".to_owned()),
        Some(hit) => {
            rows.push(format!("{} {}", coach.cue_ball().names()[hit.ball], fraction(hit.fullness)));
            let side = if hit.left { "on the left" } else { "on the right" };
            if words.before.is_empty() && fraction(hit.fullness) != "full" {
                rows.push(side.to_owned());
            }
        }
    }
    rows.extend(tip_words(proposal, coach));
    rows.push(format!("{} {}", pace_word(words.table_lengths), format_trimmed(words.table_lengths, 1)));
    rows.push(match fixed(words.elevation_deg, 0) {
        _ if words.has_level_cue() => "level cue".to_owned(),
        degrees if words.is_level => format!("low cue {degrees}\u{b0}"),
        degrees => format!("raised {degrees}\u{b0}"),
    });
    let mark = |mark: RailPoint| format!("{} {}", mark.rail.name(), bare(place_along(coach, mark.diamond)));
    rows.extend([format!("{} to", mark(words.behind)), mark(words.ahead)]);
    rows.into_iter().map(|row| ("", row)).collect()
}

/// The rows of a wide card of `width` columns, at most `most` rows if possible.
fn wide_rows(proposal: &Proposal, coach: &CoachPage, width: usize, most: usize) -> Vec<Row> {
    let words = &proposal.shot.words;
    let hit = words.first.map_or_else(
        || "no ball".to_owned(),
        |hit| {
            let (name, side) = (coach.cue_ball().names()[hit.ball], if hit.left { "left" } else { "right" });
            match fraction(hit.fullness).as_str() {
                full @ "full" => format!("{name} {full}"),
                part => format!("{name} {part}, {side}"),
            }
        },
    );
    // The cushions before the first ball share one row.
    let cushions = words.before.split_first().map(|(first, others)| {
        let first = format!("{} {}", first.rail.name(), cushion_place(coach, first.diamond));
        others.iter().fold(first, |words, other| format!("{words}, {}", other.rail.name()))
    });
    let english = match words.english {
        Some(English::Running) => ", running",
        Some(English::Reverse) => ", reverse",
        None => "",
    };
    let [side, height] = tip_words(proposal, coach);
    let cue = match fixed(words.elevation_deg, 0) {
        _ if words.has_level_cue() => "level".to_owned(),
        degrees if words.is_level => format!("{degrees}\u{b0}, as level as can be"),
        degrees => format!("raised {degrees}\u{b0}"),
    };
    // "nose" is written because diamond systems count on the wood behind the noses.
    let mark = |mark: RailPoint| format!("{} nose {}", mark.rail.name(), place_along(coach, mark.diamond));
    let lengths = lengths_words(words.table_lengths);
    let speed = format!("{lengths}, {}", speed_words(proposal.shot.cue.speed, coach.units.length, 2));
    let whole_speed = format!("{}, {speed}", pace_word(words.table_lengths));
    let aim = [("from", mark(words.behind)), ("to", mark(words.ahead))];
    let mut rows: Vec<Row> = cushions.map(|cushions| ("rails", cushions)).into_iter().collect();
    rows.extend([
        ("hit", hit),
        ("side", side + english),
        ("height", height),
        ("speed", if columns(&whole_speed) + NAME < width { whole_speed } else { speed }),
        ("cue", cue),
    ]);
    if rows.len() + aim.len() > most {
        let [from, to] = aim.map(|(_, mark)| mark.replace(" nose", ""));
        rows.push(("noses", format!("{from} to {to}")));
    } else {
        rows.extend(aim);
    }
    rows
}

/// Side and height of the tip on the cue ball in words, rounded to half a tip or a tenth of a millimetre, as in the sentence.
fn tip_words(proposal: &Proposal, coach: &CoachPage) -> [String; 2] {
    let ShotWords { tips_right, tips_above, .. } = proposal.shot.words;
    [(tips_right, ["no side", "right", "left"]), (tips_above, ["centre height", "above", "below"])]
        .map(|(tips, words)| offset_words(tips, words, coach))
}

fn offset_words(tips: f64, [middle, more, less]: [&str; 3], coach: &CoachPage) -> String {
    let (value, parts, unit) = match coach.units.tip {
        TipUnit::Tips => (tips.abs(), 2.0, "tip"),
        TipUnit::Mm => (1e3 * coach.table().radius * TIP * tips.abs(), 10.0, "mm"),
    };
    let value = (parts * value).round() / parts;
    if value == 0.0 {
        return middle.to_owned();
    }
    let plural = if unit == "tip" && value > 1.0 { "s" } else { "" };
    format!("{} {unit}{plural} {}", format_trimmed(value, 1), if tips > 0.0 { more } else { less })
}

/// The thickness of the hit as a fraction, rounded to a sixteenth.
fn fraction(fullness: f64) -> String {
    let (mut part, mut of) = ((f64::from(PARTS) * fullness.clamp(0.0, 1.0)).round() as u32, PARTS);
    if part == 0 || part == PARTS {
        return if part == 0 { "graze" } else { "full" }.to_owned();
    }
    while part.is_multiple_of(2) {
        (part, of) = (part / 2, of / 2);
    }
    format!("{part}/{of}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thickness_uses_the_shortest_fraction() {
        assert_eq!(
            [0.01, 0.0625, 0.25, 0.51, 0.69, 0.99].map(fraction),
            ["graze", "1/16", "1/4", "1/2", "11/16", "full"]
        );
    }
}
