//! The panel of chances: the shots that the coach lists, how often the player makes each, and what sort each is.

use ratatui::{layout::Rect, text::Span};

use crate::{
    table::CueBall,
    terminal::{
        AdviceState, Proposal,
        ui::{Ui, draw_nothing, draw_title, list, write_right},
        words::{chance_words, kind_words, percent, skill_word},
    },
};

/// Columns at which the number of a shot and its probability end, and before its words.
const NUMBER_END: u16 = 2;
const CHANCE_END: u16 = 9;
const WORDS: u16 = 10;

/// Draws the panel: the chosen shot is marked and in view. Without advice it says `empty`.
pub fn draw_chances(advised: Option<&AdviceState>, empty: &str, area: Rect, ui: &mut Ui) {
    let mut title = vec![Span::styled("Chances", ui.theme.text())];
    if let Some(advised) = advised {
        title.push(Span::styled(ui.caps.pick(" · ", " - "), ui.theme.faint()));
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
    let Some(advised) = advised else { return draw_nothing(&[empty], inner, ui) };
    for (n, row) in in_view(advised, inner) {
        let is_chosen = n == advised.chosen();
        let style = if is_chosen { ui.theme.accent() } else { ui.theme.text() };
        let proposal = &advised.choices()[n].proposal;
        if is_chosen {
            ui.buffer.set_string(inner.x, row, ui.caps.pick("▸", ">"), ui.theme.accent());
        }
        write_right(ui.buffer, inner.x, inner.x + NUMBER_END, row, &(n + 1).to_string(), ui.theme.faint());
        let chance = proposal.made.map_or("?".to_owned(), |made| percent(made.rate) + " %");
        write_right(ui.buffer, inner.x, inner.x + CHANCE_END, row, &chance, style);
        let room = usize::from(inner.width.saturating_sub(WORDS));
        ui.buffer.set_stringn(inner.x + WORDS, row, sort_words(proposal, ui.theme.cue_ball), room, style);
    }
    // What would miss the first shot by itself.
    let row = inner.y + advised.choices().len() as u16;
    if let (Some(risk), true) = (advised.choices()[0].proposal.risk, row < inner.bottom()) {
        let [hand, table, placing] = [risk.hand, risk.table, risk.placing].map(percent);
        let words = format!("misses %: hand {hand}, table {table}, places {placing}");
        ui.buffer.set_stringn(inner.x + 1, row, words, usize::from(inner.width.saturating_sub(1)), ui.theme.faint());
    }
}

/// The place of the shot that the panel in `area` tells in this row of the screen.
pub fn choice_at(advised: &AdviceState, area: Rect, row: u16) -> Option<usize> {
    // The first row is the title's.
    let inner = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    in_view(advised, inner).find(|(_, y)| *y == row).map(|(n, _)| n)
}

/// The shots that have a row, and their rows.
fn in_view(advised: &AdviceState, inner: Rect) -> impl Iterator<Item = (usize, u16)> {
    list::in_view(advised.chosen(), advised.choices().len(), usize::from(inner.height)).zip(inner.y..)
}

/// What sort of shot it is, or that it makes no point.
pub fn sort_words(proposal: &Proposal, cue_ball: CueBall) -> String {
    proposal.kind.map_or_else(|| "no point".to_owned(), |kind| kind_words(kind, cue_ball))
}
