//! The panel of a stroke of the player's own: how often it is made, what comes of it, and how it differs from the coach's, if there is one.

use ratatui::{layout::Rect, text::Span};

use crate::{
    coach::Units,
    table::CueBall,
    terminal::{
        shot::WhatIf,
        ui::{Ui, draw_title, spell, write_paragraphs},
        words::percent,
    },
};

/// Whose shot the stroke stands beside, and how they are told.
#[derive(Clone, Copy, Debug)]
pub struct Beside {
    /// The word for whose shot it is.
    pub advisor: &'static str,
    /// How often the player makes that, where it is known.
    pub made: Option<f64>,
    /// Who plays.
    pub cue_ball: CueBall,
    /// The units of lengths.
    pub units: Units,
}

/// Draws the panel.
pub fn draw_what_if(what_if: &WhatIf, beside: &Beside, area: Rect, ui: &mut Ui) {
    let Beside { advisor, made, cue_ball, units } = *beside;
    let mut title = vec![Span::styled("You", ui.theme.ball(0))];
    let own = match what_if.made {
        Some(rate) => format!(" {} %", percent(rate.rate)),
        None if what_if.is_asked() => ui.caps.pick(" … %", " ... %").to_owned(),
        None => if what_if.is_made() { " make it" } else { " miss" }.to_owned(),
    };
    title.push(Span::styled(own, ui.theme.text()));
    if what_if.coach.is_some() {
        title.push(ui.dash());
        title.push(Span::styled(advisor, ui.theme.text().fg(ui.theme.way_sign)));
    }
    title.extend(made.map(|made| Span::styled(format!(" {} %", percent(made)), ui.theme.text())));
    let inner = draw_title(title, area, ui);
    let outcome_style = if what_if.is_made() { ui.theme.good() } else { ui.theme.warning() };
    let plain = |words: String| spell(&words, ui.caps);
    let paragraphs = [
        (plain(what_if.outcome(cue_ball, units)), outcome_style),
        (plain(what_if.difference(advisor, made, cue_ball, units)), ui.theme.text()),
    ];
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    write_paragraphs(&paragraphs, text, ui);
}
