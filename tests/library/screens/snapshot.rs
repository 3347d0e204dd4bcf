//! Comparison of a player's screens with snapshots.

use super::{
    player::{Player, SIZES},
    runs::{OTHER_RUN, RUN},
};

/// Compares the screen at both sizes with the snapshots.
pub fn check(name: &str, player: &Player) {
    check_at(&SIZES, name, player);
}

pub fn check_at(sizes: &[(u16, u16)], name: &str, player: &Player) {
    let screen = player.app.screen.title().to_lowercase();
    for &(width, height) in sizes {
        check_text(&format!("{screen}_{name}_{width}x{height}"), &without_timestamps(&player.text(width, height)));
    }
}

pub fn check_text(name: &str, text: &str) {
    insta::with_settings!({ prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, text);
    });
}

/// Returns the text with recent timestamps of the form 20261120-143005 and all local times of the form 2026-11-20 14:30 replaced.
fn without_timestamps(text: &str) -> String {
    let mut text = text.to_owned();
    for mask in ["yyyymmdd-hhmmss", "yyyy-mm-dd hh:mm"] {
        for start in 0..=text.len().saturating_sub(mask.len()) {
            let Some(part) = text.as_bytes().get(start..start + mask.len()) else { break };
            let is_time = part.iter().zip(mask.bytes()).all(|(byte, shape)| match shape {
                b'a'..=b'z' => byte.is_ascii_digit(),
                separator => *byte == separator,
            });
            if is_time && !RUN.as_bytes().starts_with(part) && !OTHER_RUN.as_bytes().starts_with(part) {
                text.replace_range(start..start + mask.len(), mask);
            }
        }
    }
    text
}
