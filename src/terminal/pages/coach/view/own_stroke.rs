//! The panels while the player's own stroke stands beside the coach's.

use crate::{
    coach::words::TipUnit,
    terminal::{
        pages::coach::{
            CoachPage,
            view::{draw_listed, panes::Panes, shot::draw_shot},
        },
        shot::WhatIf,
        ui::{Beside, Ui, draw_sight, draw_spin, draw_tip, draw_what_if},
    },
};

/// Whose shot the other one is.
pub const COACH: &str = "coach";

/// Draws the panels: both strokes where the view's panel is, the others for the player's own.
pub fn draw_own_stroke(coach: &CoachPage, what_if: &WhatIf, panes: &Panes, ui: &mut Ui) {
    let (table, shot) = (coach.table(), &*what_if.shot);
    let beside = Beside {
        teacher: COACH,
        made: coach.proposal().and_then(|proposal| proposal.made).map(|made| made.rate),
        cue_ball: coach.cue_ball(),
        units: coach.units,
    };
    // Before the stroke its words have the room of what only tells later.
    let time = coach.playback.readout;
    let is_wide = panes.is_beside() && time == 0.0;
    let area = if is_wide { panes.info.union(panes.events) } else { panes.info };
    draw_what_if(what_if, &beside, area, ui);
    draw_shot(Some(shot), &[], (table, coach.units.length), panes.shot, ui);
    draw_tip(Some(&shot.cue), coach.units.tip == TipUnit::Tips, table, panes.tip, ui);
    match shot.spin(time, table.radius) {
        Some(spin) => draw_spin(&spin, panes.sight, ui),
        None => draw_sight(Some(shot.meeting()), panes.sight, ui),
    }
    if !is_wide {
        draw_listed(coach, Some(shot), Some(time), panes.events, ui);
    }
}
