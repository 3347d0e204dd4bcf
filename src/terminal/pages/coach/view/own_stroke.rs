//! The panels of the player's own stroke.

use ratatui::layout::Rect;

use crate::{
    coach::words::{TipUnit, lengths_words},
    terminal::{
        Shot,
        pages::coach::{
            CoachPage,
            view::{
                draw_listed,
                panes::Panes,
                shot::{WIDE, draw_shot, shot_title},
            },
        },
        shot::WhatIf,
        ui::{Ui, draw_lines, draw_spin_or_hit, draw_tip, draw_title, draw_what_if, pair, stroke_rows},
        words::{fixed, speed_words},
    },
};

/// Name of the other shot in the comparison.
pub const COACH: &str = "coach";

/// Draws the panels: the comparison of both strokes in place of the info panel, the others for the player's own stroke.
pub fn draw_own_stroke(coach: &CoachPage, what_if: &WhatIf, panes: &Panes, ui: &mut Ui) {
    let (table, shot) = (coach.table(), &*what_if.shot);
    let proposal = coach.proposal().filter(|proposal| !proposal.is_early);
    let made = proposal.and_then(|proposal| proposal.made).map(|made| made.rate);
    // Before the stroke, the comparison also uses the room of the event list, which matters only later.
    let time = coach.playback.readout;
    let is_wide = panes.is_beside() && time == 0.0;
    let area = if is_wide { panes.info.union(panes.events) } else { panes.info };
    draw_what_if(what_if, COACH, made, coach.units, area, ui);
    if coach.is_in_numbers {
        draw_shot(Some(shot), &[], (table, coach.units.length), panes.shot, ui);
    } else {
        draw_set(shot, coach, panes.shot, ui);
    }
    draw_tip(Some(&shot.cue), coach.units.tip == TipUnit::Tips, table, panes.tip, ui);
    draw_spin_or_hit(shot.spin(time, table.radius), Some(shot.first_impact()), panes.hit, ui);
    if !is_wide {
        draw_listed(coach, Some(shot), Some(time), panes.events, ui);
    }
}

/// Draws the panel with the current inputs of the stroke, and whether it makes the point.
fn draw_set(shot: &Shot, coach: &CoachPage, area: Rect, ui: &mut Ui) {
    let inner = draw_title(shot_title(shot, ui), area, ui);
    let (unit, speed) = (coach.units.length, shot.cue.speed);
    let rows = stroke_rows(&shot.cue, coach.units, coach.table().radius, ui.caps);
    let (indent, columns) = if area.width >= WIDE { (1, 7) } else { (0, 6) };
    let lines = rows.map(|(name, value)| {
        // In a narrow column the longest name needs an extra blank, and there is no room for " deg".
        let value = match name {
            // With two digits before the decimal point, there is room for only one after it.
            "speed" if columns <= 6 && unit.speed().0 * speed >= 9.995 => speed_words(speed, unit, 1),
            "speed" if columns > 6 => format!("{value}, {}", lengths_words(shot.words.table_lengths)),
            // The coach's words call this elevation level.
            "cue" if shot.words.has_level_cue() && value != "level" => level_words(shot, columns > 6, ui),
            _ if columns > 6 => value,
            _ => value.replace(" deg", ""),
        };
        pair(name, columns.max(name.len() + 1), value, ui.theme)
    });
    draw_lines(lines, Rect { x: inner.x + indent, width: inner.width.saturating_sub(indent), ..inner }, ui);
}

/// Words for a cue that players call level, with the small elevation that the cushion or ball behind the cue ball forces.
fn level_words(shot: &Shot, is_wide: bool, ui: &Ui) -> String {
    let degrees = |decimals| fixed(shot.words.elevation_deg, decimals);
    if is_wide {
        format!("level ({}{})", degrees(1), ui.caps.pick("°", " deg"))
    } else {
        ui.caps.pick(format!("level {}°", degrees(0)).as_str(), "level").to_owned()
    }
}
