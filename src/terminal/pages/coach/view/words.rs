//! The panel of the shot in words: the stroke, the course of the cue ball, the line of aim, and the reason for the shot.

use ratatui::{
    layout::{Margin, Rect},
    style::Style,
    text::{Line, Span},
};

use crate::{
    coach::words::PositionUnit,
    terminal::{
        Proposal,
        pages::coach::{
            CoachPage,
            view::{card::chance_span, chances::why_lines},
        },
        ui::{Ui, columns, draw_lines, draw_title, to_displayable, wrap},
        words::fixed,
    },
};

/// Draws the panel. The line of aim is in the title or, if it does not fit there, in the text. Whatever does not fit is left out from the
/// end. Returns whether the panel explains why the first shot ranks first.
pub fn draw_shot_words(coach: &CoachPage, proposal: &Proposal, area: Rect, ui: &mut Ui) -> bool {
    let (words, units, cue_ball) = (&proposal.shot.words, coach.units, coach.cue_ball());
    let part = |text: String, style| (to_displayable(&text, ui.caps), style);
    let (width, rows) = (usize::from(area.width.saturating_sub(2)), usize::from(area.height.saturating_sub(1)));
    let [titles @ .., bare] = titles(coach, proposal, ui);
    // There is a line before the title and a blank on either side.
    let fits = |title: &Vec<Span>| title.iter().map(Span::width).sum::<usize>() < width;
    let title = titles.into_iter().find(fits);
    let aim = title.is_none().then(|| part(words.aim(units), ui.theme.text()));
    let how = |sentence: &str| Some(part(sentence.to_owned(), ui.theme.text().add_modifier(ui.theme.strong)));
    let way = |course: &str| Some(part(course.to_owned(), ui.theme.accent()));
    let [sentence, brief] = [words.sentence(cue_ball, units), words.short_sentence(cue_ball, units)];
    let [long, short] = [words.course(cue_ball, units), words.short_course(cue_ball, units)];
    // If room is short, the line of aim is dropped first, since the card contains it too. Then the end of the course is dropped, and
    // then repetitions in the sentence. The course itself is never cut, because only the sentence is repeated by the card.
    let tries = [
        [how(&sentence), way(&long), aim.clone()],
        [how(&sentence), way(&short), aim],
        [how(&sentence), way(&short), None],
        [how(&brief), way(&short), None],
        [way(&short), how(&brief), None],
    ]
    .map(|parts| parts.into_iter().flatten().collect::<Vec<_>>());
    let mut lines = lay_out(&tries, width, rows, ui.caps.pick(" …", " ..."));
    let left = rows - lines.len();
    let why = coach.displayed_advice().filter(|_| left > 0).and_then(|advised| why_lines(advised, width, left, ui));
    let says_why = why.is_some();
    lines.extend(why.into_iter().flatten().map(|line| Line::styled(line, ui.theme.faint())));
    let inner = draw_title(title.unwrap_or(bare), area, ui);
    draw_lines(lines, inner.inner(Margin::new(1, 0)), ui);
    says_why
}

/// The titles, from long to short: pattern name, success rate and line of aim. The last one has no line of aim.
fn titles(coach: &CoachPage, proposal: &Proposal, ui: &Ui) -> [Vec<Span<'static>>; 4] {
    let name = proposal.shot.pattern.map(|pattern| {
        Span::styled(to_displayable(pattern.name, ui.caps), ui.theme.text().add_modifier(ui.theme.strong))
    });
    let [long, short] = aim_words(coach, proposal, ui).map(|words| Span::styled(words, ui.theme.text()));
    let title = |is_wide: bool, aim: Option<&Span<'static>>| {
        let chance = chance_span(proposal, is_wide, ui);
        let parts = [name.clone(), Some(chance), aim.cloned()].into_iter().flatten();
        parts.flat_map(|part| [ui.dash(), part]).skip(1).collect()
    };
    [title(true, Some(&long)), title(true, Some(&short)), title(false, Some(&short)), title(true, None)]
}

/// Formats a point of aim on a cushion in the player's unit.
pub fn place_along(coach: &CoachPage, diamonds: f64) -> String {
    match coach.units.position {
        PositionUnit::Diamonds => fixed(diamonds, 2),
        PositionUnit::Mm => format!("{} mm", fixed(1e3 * coach.table().diamond() * diamonds, 0)),
    }
}

/// The line of aim in a long and a short form: the points behind and ahead of the cue ball, as diamonds or millimetres along the noses
/// of the rails. Both forms say "noses", because diamond systems count on the wood behind them.
fn aim_words(coach: &CoachPage, proposal: &Proposal, ui: &Ui) -> [String; 2] {
    let words = &proposal.shot.words;
    let [behind, ahead] = [words.behind, words.ahead].map(|mark| (mark.rail.name(), place_along(coach, mark.diamond)));
    let arrow = ui.caps.pick("→", ">");
    let line = format!("{} {} {arrow} {} {}", behind.0, behind.1, ahead.0, ahead.1);
    [format!("aim {line}, at noses"), format!("noses {line}")]
}

/// Lays out the first of the `tries` that fits into `rows`, with each part on a new row or else as running text. If none fits, the last
/// one is cut and ends in `more`.
fn lay_out(tries: &[Vec<(String, Style)>], width: usize, rows: usize, more: &'static str) -> Vec<Line<'static>> {
    for parts in tries {
        let apart: Vec<Line> = parts
            .iter()
            .flat_map(|(text, style)| wrap(text, width).into_iter().map(|line| Line::styled(line, *style)))
            .collect();
        if let Some(lines) = [apart, flow(parts, width)].into_iter().find(|lines| lines.len() <= rows) {
            return lines;
        }
    }
    let mut lines = tries.last().map_or_else(Vec::new, |parts| flow(parts, width));
    lines.truncate(rows);
    if let Some(last) = lines.last_mut() {
        while last.width() + columns(more) > width && !last.spans.is_empty() {
            last.spans.pop();
        }
        last.push_span(more);
    }
    lines
}

/// Sets texts one after the other as running text, each in its style.
fn flow(parts: &[(String, Style)], width: usize) -> Vec<Line<'static>> {
    let mut lines = vec![Line::default()];
    let mut taken = 0;
    for (text, style) in parts {
        for word in text.split_whitespace() {
            let wide = columns(word);
            if taken > 0 && taken + 1 + wide > width {
                lines.push(Line::default());
                taken = 0;
            }
            let blank = usize::from(taken > 0);
            taken += blank + wide;
            if let Some(line) = lines.last_mut() {
                line.push_span(Span::styled(format!("{:blank$}{word}", ""), *style));
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(texts: &[&str]) -> Vec<(String, Style)> {
        texts.iter().map(|text| ((*text).to_owned(), Style::new())).collect()
    }

    fn laid_out(tries: &[&[&str]], width: usize, rows: usize) -> Vec<String> {
        let tries: Vec<_> = tries.iter().map(|parts| texts(parts)).collect();
        lay_out(&tries, width, rows, " …").iter().map(ToString::to_string).collect()
    }

    #[test]
    fn parts_are_spread_flowed_or_shortened_to_fit() {
        let tries = [&["one two three", "four", "five six"][..], &["one two three", "four"]];
        assert_eq!(laid_out(&tries, 9, 4), ["one two", "three", "four", "five six"]);
        assert_eq!(laid_out(&tries, 10, 3), ["one two", "three four", "five six"]);
        assert_eq!(laid_out(&tries, 10, 2), ["one two", "three four"]);
        assert_eq!(laid_out(&tries, 10, 1), ["one two …"], "what has no room at all is cut");
    }
}
