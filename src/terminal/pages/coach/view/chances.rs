//! The panel "Chances": the proposed shots with the player's success rate and a description of each.

use ratatui::{layout::Rect, text::Span};

use crate::{
    coach::{
        Risk,
        words::{fullness_word, pace_word},
    },
    terminal::{
        AdviceState, Proposal,
        pages::coach::Choice,
        ui::{
            Ui, below_title, columns, draw_placeholder, draw_title, list, shorten, to_displayable, truncate_lines,
            wrap, write_right,
        },
        words::{chance_words, fixed, percent, skill_word},
    },
};

/// Right ends of a shot's number and success rate, and the first column of its description.
const NUMBER_END: u16 = 2;
const CHANCE_END: u16 = 9;
const WORDS: u16 = 10;

/// Draws the panel, with the chosen shot marked and in view. Without advice it shows the text `empty`. `says_why` adds the explanation
/// of the first shot's rank, which is set if no other panel shows it.
pub fn draw_chances(advised: Option<&AdviceState>, empty: &str, says_why: bool, area: Rect, ui: &mut Ui) {
    let mut title = vec![Span::styled("Chances", ui.theme.text())];
    if let Some(advised) = advised {
        title.push(ui.dash());
        title.push(Span::styled(skill_word(advised.query.skill), ui.theme.text()));
        let proposal = &advised.choice().proposal;
        if let Some(made) = proposal.made {
            let (words, style) = if proposal.is_early {
                (format!(" so far {} %", percent(made.rate)), ui.theme.accent())
            } else {
                (format!(" {}", chance_words(&made)), ui.theme.good())
            };
            title.push(Span::styled(words, style));
        }
    }
    let inner = draw_title(title, area, ui);
    let Some(advised) = advised else { return draw_placeholder(&[empty], inner, ui) };
    for (n, row) in list::shown(advised.chosen, advised.choices.len(), inner) {
        let is_chosen = n == advised.chosen;
        let style = if is_chosen { ui.theme.accent() } else { ui.theme.text() };
        let proposal = &advised.choices[n].proposal;
        list::draw_mark(is_chosen, inner.x, row, ui);
        write_right(ui.buffer, inner.x, inner.x + NUMBER_END, row, &(n + 1).to_string(), ui.theme.faint());
        let chance = proposal.made.map_or("?".to_owned(), |made| percent(made.rate) + " %");
        write_right(ui.buffer, inner.x, inner.x + CHANCE_END, row, &chance, style);
        let room = usize::from(inner.width.saturating_sub(WORDS));
        let sort = |proposal: &Proposal, is_exact: bool| shot_summary(proposal, is_exact, room, ui);
        let words = sort(proposal, false);
        let like = |(other, choice): (usize, &Choice)| other != n && sort(&choice.proposal, false) == words;
        let is_unclear = advised.choices.iter().enumerate().any(like);
        let words = if is_unclear { sort(proposal, true) } else { words };
        ui.buffer.set_stringn(inner.x + WORDS, row, words, room, style);
    }
    // The failure rate that each source of error causes alone; known for the first shot only.
    let mut row = inner.y + advised.choices.len() as u16;
    if let (Some(risk), true) = (advised.choices[advised.chosen].proposal.risk, row < inner.bottom()) {
        let width = usize::from(inner.width.saturating_sub(1));
        for line in risk_lines(&risk, width, usize::from(inner.bottom() - row)) {
            ui.buffer.set_stringn(inner.x + 1, row, line, width, ui.theme.faint());
            row += 1;
        }
    }
    let rest = Rect { y: row, height: inner.bottom().saturating_sub(row), ..inner };
    if says_why {
        let why = if advised.chosen == 0 { "Why: " } else { "Why shot 1 leads: " };
        write_why(advised, why, rest, ui);
    }
}

/// Lines with the failure rate that each of the three sources of error would cause alone, shortened to fit into `rows`.
fn risk_lines(risk: &Risk, width: usize, rows: usize) -> Vec<String> {
    let [hand, table, balls] = [risk.hand, risk.table, risk.placing].map(percent);
    // The three rates do not add up: each is the failure rate if the other two sources had no errors.
    let whole = ["each error alone would miss:".to_owned(), format!("hand {hand} %, table {table} %, balls {balls} %")];
    let in_one = [
        whole.join(" "),
        format!("misses by: hand {hand}, table {table}, balls {balls} %"),
        format!("alone: hand {hand}, table {table}, balls {balls} %"),
    ];
    if columns(&in_one[0]) > width && rows >= whole.len() {
        return whole.into();
    }
    let [.., shortest] = &in_one;
    vec![in_one.iter().find(|words| columns(words) <= width).unwrap_or(shortest).clone()]
}

/// Draws a panel that explains why the first shot ranks first. Returns `false` if the explanation is not known.
pub fn draw_why(advised: &AdviceState, area: Rect, ui: &mut Ui) -> bool {
    if ranking_sentences(advised, ui).next().is_none() {
        return false;
    }
    let inner = draw_title(Span::styled("Why shot 1 leads", ui.theme.text()), area, ui);
    write_why(advised, "", inner, ui);
    true
}

/// The explanations of the first shot's rank that add to the list, from long to short; empty if not known.
fn ranking_sentences(advised: &AdviceState, ui: &Ui) -> impl Iterator<Item = String> + use<> {
    let why = advised.why.as_ref().map(|why| why.facts_beyond_list(ui.theme.cue_ball).collect::<Vec<_>>());
    why.unwrap_or_default().into_iter()
}

/// Writes the explanation after the introduction `word`, as much as there is room for.
fn write_why(advised: &AdviceState, word: &str, area: Rect, ui: &mut Ui) {
    let width = usize::from(area.width.saturating_sub(2));
    if area.is_empty() {
        return;
    }
    let sentences = ranking_sentences(advised, ui).map(|words| format!("{word}{words}"));
    let lines = fitting(sentences, width, usize::from(area.height), ui).unwrap_or_default();
    for (line, row) in lines.iter().zip(area.y..) {
        ui.buffer.set_stringn(area.x + 1, row, line, width, ui.theme.faint());
    }
}

/// Lines that explain why the first shot ranks first, as much as fits into `rows` of `width` columns; `None` if not known.
pub fn why_lines(advised: &AdviceState, width: usize, rows: usize, ui: &Ui) -> Option<Vec<String>> {
    let name = if advised.chosen == 0 { "Why" } else { "Why shot 1 leads" };
    let sentences = advised.why.as_ref()?.brief(ui.theme.cue_ball);
    fitting(sentences.map(|words| format!("{name}: {words}")), width, rows, ui)
}

/// One row of `width` columns that explains why the first shot ranks first, with as many facts as fit. `None` if another shot is shown,
/// the explanation is not known or no sentence fits.
pub fn why_line(advised: &AdviceState, width: usize, ui: &Ui) -> Option<String> {
    let sentences = advised.why.as_ref().filter(|_| advised.chosen == 0)?.brief(ui.theme.cue_ball);
    sentences.map(|words| to_displayable(&format!("Why: {words}"), ui.caps)).find(|line| columns(line) <= width)
}

/// Wraps the first sentence that fits into `rows` of `width` columns. The sentences come from long to short; if even the last one does not
/// fit, it is cut.
fn fitting(sentences: impl Iterator<Item = String>, width: usize, rows: usize, ui: &Ui) -> Option<Vec<String>> {
    let mut tries = sentences.map(|sentence| wrap(&to_displayable(&sentence, ui.caps), width));
    let mut lines = tries.next()?;
    while lines.len() > rows
        && let Some(shorter) = tries.next()
    {
        lines = shorter;
    }
    Some(truncate_lines(lines, rows, width, ui.caps))
}

/// The index of the shot that the panel in `area` lists in this screen row.
pub fn choice_at(advised: &AdviceState, area: Rect, row: u16) -> Option<usize> {
    list::line_at(advised.chosen, advised.choices.len(), below_title(area), row)
}

/// Describes the shot in players' words: first ball, pattern, thickness and speed; or that it makes no point.
///
/// Thickness and speed are left out if `room` columns do not hold them; ball and pattern are cut with an ellipsis. If `is_exact`, the
/// speed is in table lengths and comes before the thickness.
pub fn shot_summary(proposal: &Proposal, is_exact: bool, room: usize, ui: &Ui) -> String {
    if !proposal.shot.solved {
        return "no point".to_owned();
    }
    let words = &proposal.shot.words;
    let mut text = String::new();
    let pace = pace_word(words.table_lengths);
    let pace = if is_exact { format!("{pace} {}", fixed(words.table_lengths, 1)) } else { pace.to_owned() };
    let mut parts = [
        words.first.map(|hit| ui.theme.names()[hit.ball].to_owned()),
        proposal.shot.pattern.map(|pattern| pattern.name.to_owned()),
        words.first.map(|hit| fullness_word(hit.fullness).to_owned()),
        Some(pace),
    ];
    if is_exact {
        parts.swap(2, 3);
    }
    for (n, part) in parts.into_iter().flatten().enumerate() {
        let more = if n == 0 { part } else { format!("{text}, {part}") };
        if n < 2 || columns(&more) <= room {
            text = more;
        }
    }
    let text = to_displayable(&text, ui.caps);
    if columns(&text) > room { shorten(&text, room, ui.caps) } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_risk_also_fits_in_one_row() {
        let risk = Risk { hand: 0.63, table: 0.24, placing: 0.112 };
        assert_eq!(risk_lines(&risk, 38, 2), ["each error alone would miss:", "hand 63 %, table 24 %, balls 11 %"]);
        assert_eq!(risk_lines(&risk, 41, 1), ["misses by: hand 63, table 24, balls 11 %"]);
        assert_eq!(risk_lines(&risk, 38, 1), ["alone: hand 63, table 24, balls 11 %"]);
        assert_eq!(risk_lines(&risk, 70, 1), ["each error alone would miss: hand 63 %, table 24 %, balls 11 %"]);
    }
}
