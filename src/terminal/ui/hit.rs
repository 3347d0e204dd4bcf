//! The shooter's view of the first object ball, with the part that the cue ball covers at impact. While a shot plays, the spin is shown
//! instead: the cue ball's face and words.

use ratatui::{
    layout::Rect,
    style::{Modifier, Style},
    text::Span,
};

use crate::{
    coach::{Hit, words::capitalize},
    terminal::{
        shot::{FirstImpact, Spin},
        ui::{Ink, Theme, Ui, draw_face, draw_field, draw_title, face_in, field::Mark, write_right},
        words::{fixed, rail_name},
    },
};

/// Rows of the words, and the height below the title up to which the fullness is shown only in the title, and the words on the spin next
/// to the face.
const WORDS: u16 = 3;
const LOW: u16 = 5;
/// Columns of the words next to the face.
const WORDS_WIDTH: u16 = 9;
/// Character for the part of the object ball behind the cue ball.
const BEHIND: char = '#';

/// Draws the cue ball's spin while a shot plays, otherwise its hit on the first object ball.
pub fn draw_spin_or_hit(spin: Option<Spin>, impact: Option<FirstImpact>, area: Rect, ui: &mut Ui) {
    match spin {
        Some(spin) => draw_spin(&spin, area, ui),
        None => draw_hit_panel(None, impact, area, ui),
    }
}

/// Draws the spin. The spot marks where a level cue would have to hit the ball to give it this spin at this speed.
fn draw_spin(spin: &Spin, area: Rect, ui: &mut Ui) {
    let inner = draw_title("Spin", area, ui);
    let is_low = inner.height <= LOW;
    let room = if is_low {
        Rect { width: inner.width.saturating_sub(WORDS_WIDTH), ..inner }
    } else {
        Rect { height: inner.height - WORDS, ..inner }
    };
    let face = face_in(room, ui.caps);
    let has_spin = !spin.word.is_empty();
    draw_face(has_spin.then_some(spin.mark), None, face, ui);
    // Whole numbers: few frames change them.
    let side = fixed(spin.side.abs(), 0);
    let words = match side.as_str() {
        _ if !has_spin => ["at rest".to_owned(), String::new(), String::new()],
        "0" => [spin.word.to_owned(), "no side".to_owned(), String::new()],
        _ => {
            let to = if spin.side > 0.0 { "left" } else { "right" };
            [spin.word.to_owned(), format!("{to} side"), format!("{side} rad/s")]
        }
    };
    let top = if is_low { inner.y } else { face.bottom() };
    let styles = [ui.theme.text(), ui.theme.text(), ui.theme.faint()];
    for ((text, style), row) in words.iter().zip(styles).zip(top..inner.bottom()) {
        let text = text.as_str();
        if is_low {
            let room = usize::from(inner.right() - face.right());
            let text = if room > text.len() + 1 { text } else { text.trim_end_matches(" side") };
            // The last column stays free if possible.
            write_right(ui.buffer, face.right(), inner.right() - u16::from(room > text.len()), row, text, style);
        } else {
            write_centred(text, inner, row, style, ui);
        }
    }
}

/// Draws the panel: the hit on the object ball, or what the cue ball meets before it. If two strokes are shown, the title says `whose` it
/// is.
pub fn draw_hit_panel(whose: Option<&str>, impact: Option<FirstImpact>, area: Rect, ui: &mut Ui) {
    let is_low = area.height <= LOW + 1;
    let title = |words: &str| whose.map_or_else(|| capitalize(words), |whose| format!("{whose} {words}"));
    let title = match impact.filter(|_| is_low) {
        // A percentage alone could be taken for a success rate.
        Some(FirstImpact::Ball(hit)) => Span::styled(title(&format!("{} % full", percent(&hit))), ui.theme.accent()),
        _ => Span::styled(title("hit"), ui.theme.text()),
    };
    let inner = draw_title(title, area, ui);
    let Some(FirstImpact::Ball(hit)) = impact else {
        return draw_words(&words_without_ball(impact, ui.theme), inner, ui);
    };
    let words = if is_low { 0 } else { WORDS };
    let picture = Rect { height: inner.height.saturating_sub(words), ..inner };
    let drawn = draw_hit(&hit, picture, ui);
    let side = hit.side().map_or_else(String::new, |side| format!("{side} side"));
    let lines = [ui.theme.names()[hit.ball].to_owned(), format!("{} % full", percent(&hit)), side];
    if !is_low {
        draw_words(&lines, Rect { y: drawn.bottom(), height: words, ..inner }, ui);
    }
}

fn percent(hit: &Hit) -> String {
    format!("{:.0}", 100.0 * hit.fullness)
}

fn words_without_ball(impact: Option<FirstImpact>, theme: &Theme) -> Vec<String> {
    match impact {
        None | Some(FirstImpact::Ball(_)) => Vec::new(),
        Some(FirstImpact::Nothing) => vec!["meets".to_owned(), "nothing".to_owned()],
        Some(FirstImpact::Rail(rail, hit)) => {
            let mut words = vec![rail_name(rail).to_owned(), "first".to_owned()];
            if let Some(hit) = hit {
                words[1].push_str(", then");
                words.push(format!("{} {} %", theme.names()[hit.ball], percent(&hit)));
            }
            words
        }
    }
}

/// Writes each line centred.
fn draw_words(lines: &[String], area: Rect, ui: &mut Ui) {
    for (text, row) in lines.iter().zip(area.y..area.bottom()) {
        write_centred(text, area, row, ui.theme.text(), ui);
    }
}

fn write_centred(text: &str, area: Rect, row: u16, style: Style, ui: &mut Ui) {
    let indent = area.width.saturating_sub(text.len() as u16) / 2;
    ui.buffer.set_stringn(area.x + indent, row, text, usize::from(area.width - indent), style);
}

/// Draws both balls on a piece of cloth, centred at the top of `area`. The size leaves room even for a grazing hit. Returns the area of the
/// cloth.
fn draw_hit(hit: &Hit, area: Rect, ui: &mut Ui) -> Rect {
    // Diameter in columns; a row is as high as two columns are wide.
    let diameter = (area.width / 2).min(2 * area.height);
    let rows = diameter.div_ceil(2);
    let cloth = Rect { x: area.x + (area.width - 2 * diameter) / 2, width: 2 * diameter, height: rows, ..area };
    if cloth.is_empty() {
        return cloth;
    }
    // In ball radii; the midpoint of the two balls is the middle of the picture.
    let offset = 2.0 * (1.0 - hit.fullness).clamp(0.0, 1.0);
    let cue = if hit.left { -0.5 * offset } else { 0.5 * offset };
    let per_half = f64::from(2 * rows) / f64::from(diameter);
    let (ink, letters) = (|color, weight| Ink { color, weight }, ui.theme.letters());
    draw_field(cloth, ui.theme.cloth, ui, |x, y, _| {
        let (x, y) = (2.0 * x, per_half * y);
        let covers = |middle: f64| (x - middle).hypot(y) <= 1.0;
        let ball = hit.ball;
        let (ink, letter, style) = match (covers(cue), covers(-cue)) {
            (true, true) => (ink(ui.theme.paths[ball], 3), BEHIND, ui.theme.ball(ball)),
            (true, false) => (ink(ui.theme.balls[0], 3), letters[0], ui.theme.ball(0)),
            (false, true) => (ink(ui.theme.balls[ball], 3), letters[ball], ui.theme.ball(ball)),
            (false, false) => return None,
        };
        Some(Mark { ink, letter, style: style.add_modifier(Modifier::BOLD) })
    });
    cloth
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::Capabilities;
    use glam::DVec2;

    /// One row of the picture in letters, and the number of cells with `letter`.
    fn drawn(fullness: f64, left: bool, letter: char) -> (String, usize) {
        let area = Rect::new(0, 0, 40, 10);
        let hit = Hit { ball: 2, place: DVec2::ZERO, fullness, left };
        let buffer =
            crate::terminal::ui::drawn(area, Capabilities::ASCII, |ui| assert_eq!(draw_hit(&hit, area, ui), area));
        let text: String = buffer.content().iter().map(ratatui::buffer::Cell::symbol).collect();
        (text[5 * 40..6 * 40].to_owned(), text.matches(letter).count())
    }

    #[test]
    fn the_covered_share_of_the_object_ball_is_the_fullness() {
        let (row, covered) = drawn(0.0, true, BEHIND);
        assert_eq!((row, covered), (format!("{}{}", "W".repeat(20), "R".repeat(20)), 0));
        assert_eq!(drawn(1.0, true, 'R').1, 0);
        let (row, _) = drawn(0.5, true, BEHIND);
        assert_eq!(row.trim(), format!("{}{}{}", "W".repeat(10), "#".repeat(10), "R".repeat(10)));
        let (row, _) = drawn(0.5, false, BEHIND);
        assert_eq!(
            row.trim(),
            format!("{}{}{}", "R".repeat(10), "#".repeat(10), "W".repeat(10)),
            "its right side is hit"
        );
    }
}
