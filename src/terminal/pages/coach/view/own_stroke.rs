//! The panels while the player's own stroke stands beside the coach's.

use crate::terminal::{
    Shot,
    pages::coach::{
        CoachPage,
        view::{draw_listed, panes::Panes, shot::draw_shot},
    },
    shot::WhatIf,
    ui::{Beside, Ui, draw_sight, draw_spin, draw_tip, draw_what_if},
};

/// Whose shot the other one is.
pub const COACH: &str = "coach";

/// Draws the panels: both strokes where the view's panel is, the others for the player's own.
pub fn draw_own_stroke(coach: &CoachPage, what_if: &WhatIf, panes: &Panes, ui: &mut Ui) {
    let (table, shot): (_, &Shot) = (coach.table(), what_if.shot());
    let beside = Beside {
        teacher: COACH,
        made: coach.proposal().and_then(|proposal| proposal.made).map(|made| made.rate),
        cue_ball: coach.cue_ball(),
        units: coach.units,
    };
    draw_what_if(what_if, &beside, panes.info, ui);
    draw_shot(Some(shot), &[], table, panes.shot, ui);
    draw_tip(Some(&shot.cue), table, panes.tip, ui);
    match shot.spin(coach.playback.readout, table.radius) {
        Some(spin) => draw_spin(&spin, panes.sight, ui),
        None => draw_sight(Some(shot.meeting()), panes.sight, ui),
    }
    draw_listed(coach, Some(shot), Some(coach.playback.readout), panes.events, ui);
}
