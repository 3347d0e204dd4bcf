//! The panel of the shot in words: how to strike, which way the cue ball goes, where to aim, and why.

use ratatui::{
    layout::Rect,
    style::Style,
    text::{Line, Span},
};

use crate::{
    coach::{Mark, words::PlaceUnit},
    terminal::{
        AdviceState, Proposal,
        pages::coach::{
            CoachPage,
            view::{card::chance_span, chances::why_words},
        },
        ui::{Ui, columns, cut, draw_title, spell, wrap},
        words::{fixed, rail_word},
    },
};

/// Draws the panel. What has no room is left out from the end, but for the line of aim, which the title has then.
pub fn draw_told(coach: &CoachPage, proposal: &Proposal, area: Rect, ui: &mut Ui) {
    let (words, units, cue_ball) = (&proposal.shot.words, coach.units, coach.cue_ball());
    let part = |text: String, style| (spell(&text, ui.caps), style);
    let parts = [
        part(words.sentence(cue_ball, units), ui.theme.text().add_modifier(ui.theme.strong)),
        part(words.course(cue_ball, units), ui.theme.accent()),
        part(words.aim(units), ui.theme.text()),
    ];
    let (width, rows) = (usize::from(area.width.saturating_sub(2)), usize::from(area.height.saturating_sub(1)));
    let (mut lines, count) = lay_out(&parts, width, rows);
    let why = coach.shown().and_then(|advised: &AdviceState| why_words(advised, ui));
    if let Some(why) = why.filter(|_| count == parts.len() && lines.len() < rows) {
        let lines_of_why = cut(wrap(&why, width), rows - lines.len(), width, ui.caps);
        lines.extend(lines_of_why.into_iter().map(|line| Line::styled(line, ui.theme.faint())));
    }
    let mut title = title(proposal, ui);
    if count < parts.len() {
        let aim = [
            Span::styled(ui.caps.pick(" · ", " - "), ui.theme.faint()),
            Span::styled(format!("aim {}", aim_words(coach, proposal, ui)), ui.theme.text()),
        ];
        let wide: usize = title.iter().chain(&aim).map(Span::width).sum();
        // Half of it would mislead; the shot's numbers beside this panel have it too.
        if wide < width {
            title.extend(aim);
        }
    }
    let inner = draw_title(title, area, ui);
    for (line, row) in lines.iter().zip(inner.y..inner.bottom()) {
        ui.buffer.set_line(inner.x + 1, row, line, inner.width.saturating_sub(2));
    }
}

/// The line of aim in few words: where the cue comes from and where it points, as diamonds or millimetres along the rails.
fn aim_words(coach: &CoachPage, proposal: &Proposal, ui: &Ui) -> String {
    let words = &proposal.shot.words;
    let mark = |mark: Mark| {
        let place = match coach.units.place {
            PlaceUnit::Diamonds => fixed(mark.diamond, 2),
            PlaceUnit::Mm => format!("{} mm", fixed(1e3 * coach.table().diamond() * mark.diamond, 0)),
        };
        format!("{} {place}", rail_word(mark.rail))
    };
    format!("{} {} {}", mark(words.behind), ui.caps.pick("→", ">"), mark(words.ahead))
}

/// The pattern's name, and how often the shot is made by whom.
fn title(proposal: &Proposal, ui: &Ui) -> Vec<Span<'static>> {
    let mut title = Vec::new();
    if let Some(pattern) = proposal.shot.pattern {
        let name = spell(pattern.name, ui.caps);
        title.push(Span::styled(name, ui.theme.text().add_modifier(ui.theme.strong)));
        title.push(Span::styled(ui.caps.pick(" · ", " - "), ui.theme.faint()));
    }
    title.push(chance_span(proposal, true, ui));
    title
}

/// As many of the parts as `rows` hold, each from a new row or else one behind the other, and how many these are. The first two
/// are always there, cut at their end.
fn lay_out(parts: &[(String, Style)], width: usize, rows: usize) -> (Vec<Line<'static>>, usize) {
    for count in (2..=parts.len()).rev() {
        let apart: Vec<Line> = parts[..count]
            .iter()
            .flat_map(|(text, style)| wrap(text, width).into_iter().map(|line| Line::styled(line, *style)))
            .collect();
        let layouts = [apart, flow(&parts[..count], width)];
        if let Some(lines) = layouts.into_iter().find(|lines| lines.len() <= rows) {
            return (lines, count);
        }
    }
    let mut lines = flow(&parts[..parts.len().min(2)], width);
    lines.truncate(rows);
    (lines, 2)
}

/// Texts one behind the other, each in its style.
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

    fn laid_out(parts: &[&str], width: usize, rows: usize) -> (Vec<String>, usize) {
        let (lines, count) = lay_out(&texts(parts), width, rows);
        (lines.iter().map(ToString::to_string).collect(), count)
    }

    #[test]
    fn parts_stand_apart_where_there_is_room_and_flow_where_there_is_less() {
        let parts = ["one two three", "four", "five six"];
        assert_eq!(laid_out(&parts, 9, 4).0, ["one two", "three", "four", "five six"]);
        assert_eq!(laid_out(&parts, 10, 3), (vec!["one two".into(), "three four".into(), "five six".into()], 3));
        assert_eq!(laid_out(&parts, 10, 2), (vec!["one two".into(), "three four".into()], 2));
        assert_eq!(laid_out(&parts, 10, 1), (vec!["one two".into()], 2), "what has no room at all is cut");
    }
}
