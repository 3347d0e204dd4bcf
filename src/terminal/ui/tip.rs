//! The cue ball's face: the tip contact and the circle beyond which the tip slips off, or the ball's spin. Rows with the numbers of a
//! stroke.

use glam::DVec2;
use ratatui::layout::Rect;

use crate::{
    coach::{
        Units,
        words::{TIP, TipUnit},
    },
    physics::CueInputs,
    table::Table,
    terminal::{
        Capabilities,
        ui::{Ink, RoundSpot, Ui, draw_field, draw_title, face_in, field::Mark, spot_mark},
        words::fixed,
    },
};

/// Drawn radius of the tip contact, in ball radii; the real contact is smaller than a sub-pixel.
const TIP_RADIUS: f64 = 0.17;

/// Weight of the tip in a cell that it shares with both parts of the face: more than all other sub-pixels of the cell, so that the spot
/// stays whole.
const TIP_WEIGHT: u8 = 24;
const FACE_WEIGHT: u8 = 3;

/// Draws the panel with the tip contact of the stroke `cue`, if there is one. If `how_long`, the title gives the length of one tip, for
/// shots described in tips.
pub fn draw_tip(cue: Option<&CueInputs>, how_long: bool, table: &Table, area: Rect, ui: &mut Ui) {
    let tip = format!("{} mm", fixed(1e3 * TIP * table.radius, 0));
    let title = match area.width {
        _ if !how_long => "Tip".to_owned(),
        // Includes the blank at either side, after the rule.
        width if width > 14 => format!("1 tip = {tip}"),
        _ => format!("Tip = {tip}"),
    };
    draw_titled_tip(title, cue, table, area, ui);
}

/// Draws the panel with a title that says whose stroke it is.
pub fn draw_titled_tip(title: String, cue: Option<&CueInputs>, table: &Table, area: Rect, ui: &mut Ui) {
    let inner = draw_title(title, area, ui);
    // In ball radii, right and up as seen by the shooter: positive `a` is on the left.
    let tip = cue.map(|cue| DVec2::new(-cue.a, cue.b));
    draw_face(tip, Some(table.miscue_limit.sqrt()), face_in(inner, ui.caps), ui);
}

/// Two rows with the tip contact on a ball of this `radius`, m: the direction from the centre, and the distance in `unit`. The direction is
/// the row's name, since panels at 80 columns have no room for it after the number.
pub fn tip_rows(cue: &CueInputs, unit: TipUnit, radius: f64) -> [(&'static str, String); 2] {
    let row = |radii: f64, [more, less]: [&'static str; 2], name: &'static str| match unit.words(radii, radius) {
        Some(size) => (if radii > 0.0 { more } else { less }, size),
        None => (name, "middle".to_owned()),
    };
    [row(cue.a, ["left", "right"], "side"), row(cue.b, ["up", "down"], "height")]
}

/// Rows with the numbers of a stroke that the player sets: names and values of aim, tip contact, speed and cue elevation, on a ball of this `radius`, m.
pub fn stroke_rows(cue: &CueInputs, units: Units, radius: f64, caps: Capabilities) -> [(&'static str, String); 5] {
    let degree = caps.pick("°", " deg");
    let [side, height] = tip_rows(cue, units.tip, radius);
    let (in_a_metre, per_second) = units.length.speed();
    [
        ("aim", cue.phi_text(2) + degree),
        side,
        height,
        ("speed", format!("{} {per_second}", fixed(in_a_metre * cue.speed, 2))),
        (
            "cue",
            match fixed(cue.theta.to_degrees(), 1).as_str() {
                "0.0" => "level".to_owned(),
                angle => format!("{angle}{degree} up"),
            },
        ),
    ]
}

/// Draws a ball's face with a spot at a position in ball radii, right and up; the face is grey beyond `limit`.
pub fn draw_face(spot: Option<DVec2>, limit: Option<f64>, face: Rect, ui: &mut Ui) {
    let spot = spot.map(|spot| RoundSpot::new(spot, TIP_RADIUS, face, ui.caps));
    let ink = |color| Ink { color, weight: FACE_WEIGHT };
    draw_field(face, ui.theme.background, ui, |x, y, cell| {
        let radius = x.hypot(y);
        if spot.is_some_and(|spot| spot.covers(x, y)) {
            return Some(spot_mark(ui.theme, TIP_WEIGHT));
        }
        let is_beyond = limit.is_some_and(|limit| radius > limit);
        let face = ink(if is_beyond { ui.theme.miscue } else { ui.theme.face });
        if cell == 0.0 {
            // A cell holds only two colours. At the rim, a bulge looks better than a notch.
            let is_face = radius <= 1.0 || spot.is_some_and(|spot| spot.shares_cell(x, y));
            return is_face.then_some(Mark { ink: face, letter: ' ', style: ui.theme.text() });
        }
        // Lines instead of areas: the rim, the limit circle, and the centre.
        let (letter, style) = match limit {
            _ if (radius - (1.0 - cell / 2.0)).abs() <= 0.6 * cell => ('o', ui.theme.text()),
            Some(limit) if (radius - limit).abs() <= 0.51 * cell => ('.', ui.theme.faint()),
            _ if radius < 0.5 * cell => ('+', ui.theme.faint()),
            _ => return None,
        };
        Some(Mark { ink: face, letter, style })
    });
}
