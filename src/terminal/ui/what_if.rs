//! The panel of the player's own stroke: its success rate, its outcome, and its difference from the coach's, if there is one.

use ratatui::{layout::Rect, text::Span};

use crate::{
    coach::Units,
    terminal::{
        shot::WhatIf,
        ui::{Ui, draw_title, to_displayable, write_paragraphs},
        words::percent,
    },
};

/// Draws the panel of a stroke next to a shot of the `advisor`. `made` is the player's success rate at that shot, if known.
pub fn draw_what_if(what_if: &WhatIf, advisor: &'static str, made: Option<f64>, units: Units, area: Rect, ui: &mut Ui) {
    let cue_ball = ui.theme.cue_ball;
    let mut title = vec![Span::styled("You", ui.theme.ball(0))];
    let own = match what_if.made {
        Some(rate) => format!(" {} %", percent(rate.rate)),
        None if what_if.is_rate_pending() => ui.caps.pick(" … %", " ... %").to_owned(),
        None => if what_if.is_made() { " make it" } else { " miss" }.to_owned(),
    };
    title.push(Span::styled(own, ui.theme.text()));
    if what_if.coach.is_some() {
        title.push(ui.dash());
        title.push(Span::styled(advisor, ui.theme.text().fg(ui.theme.next_path_sign)));
    }
    title.extend(made.map(|made| Span::styled(format!(" {} %", percent(made)), ui.theme.text())));
    let inner = draw_title(title, area, ui);
    let outcome_style = if what_if.is_made() { ui.theme.good() } else { ui.theme.warning() };
    let plain = |words: String| to_displayable(&words, ui.caps);
    let paragraphs = [
        (plain(what_if.outcome(cue_ball, units)), outcome_style),
        (plain(what_if.difference(advisor, made, cue_ball, units)), ui.theme.text()),
    ];
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    write_paragraphs(&paragraphs, text, ui);
}
