//! Rows with the numbers of a stroke that the player sets: aim, tip contact, speed and cue elevation.

use crate::{
    coach::Units,
    physics::CueInputs,
    terminal::{Capabilities, ui::tip_rows, words::fixed},
};

/// Names and values of a stroke on a ball of this `radius`, m.
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
