//! The panels of the player's own stroke.

use ratatui::layout::Rect;

use crate::{
    coach::words::{TipUnit, format_trimmed, lengths_words, pace_word},
    terminal::{
        Shot,
        pages::coach::{
            CoachPage,
            view::{
                draw_listed,
                panes::Panes,
                shot::{WIDE, draw_shot, shot_title},
                words::place_along,
            },
        },
        shot::WhatIf,
        ui::{Ui, draw_lines, draw_spin_or_hit, draw_tip, draw_title, draw_what_if, pair, stroke_rows},
        words::fixed,
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
    let rows = stroke_rows(&shot.cue, coach.units, coach.table().radius, ui.caps);
    let is_wide = area.width >= WIDE;
    let (indent, columns) = if is_wide { (1, 7) } else { (0, 6) };
    let (ahead, lengths) = (shot.words.ahead, shot.words.table_lengths);
    let aim = format!("{} {}", ahead.rail.name(), place_along(coach, ahead.diamond));
    let lines = rows.map(|(name, value)| match name {
        "aim" if is_wide => (name, aim.clone()),
        "aim" => ("", format!("to {}", aim.replace(" mm", ""))),
        "speed" if is_wide => (name, format!("{}, {value}", lengths_words(lengths))),
        "speed" => ("", format!("{} {}", pace_word(lengths), format_trimmed(lengths, 1))),
        // The coach's words call this elevation level.
        "cue" if shot.words.has_level_cue() && value != "level" => (name, level_words(shot, is_wide, ui)),
        // In a narrow column there is no room for " deg".
        _ => (name, if is_wide { value } else { value.replace(" deg", "") }),
    });
    // The longest name needs an extra blank there.
    let width = |name: &str| if name.is_empty() { 0 } else { columns.max(name.len() + 1) };
    let lines = lines.map(|(name, value)| pair(name, width(name), value, ui.theme));
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
