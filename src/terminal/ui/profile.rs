//! Side view of a jump: height against distance, with the balls and cushion noses that the ball passes.

use glam::DVec2;
use ratatui::{
    layout::Rect,
    style::{Color, Style},
    text::Span,
    widgets::{Clear, Widget},
};

use crate::{
    coach::{
        jump_words,
        words::{LengthUnit, height_words},
    },
    terminal::{
        Glyphs,
        shot::profile::{Obstacle, PassedObstacle, Profile},
        ui::{Canvas, Ink, Ui, canvas::sub_pixels, columns, draw_title, write_right},
    },
};

/// Columns left of the plot: the height label and the axis.
const LEFT: u16 = 7;
/// Rows of a side view placed below the table: a title, four rows of the plot, and the axis.
const ROWS: u16 = 6;

/// Ends of the height scale, in units of a power of ten.
const SCALE_ENDS: [f64; 7] = [1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 15.0];

/// Weights of what shares a cell (see [`Ink`]), in drawing order from the back.
const OBSTACLE_WEIGHT: u8 = 3;
const COURSE_WEIGHT: u8 = 5;
const BALL_WEIGHT: u8 = 32;

/// Splits the area of a table, next to which panels start at the row `panels`, into the table's area and that of a side view below it.
pub fn side_view_below(table: Rect, panels: u16) -> (Rect, Rect) {
    let Rect { x, y, width, height } = table;
    let bottom = panels.max(y + ROWS).min(y + height.max(ROWS));
    let side = Rect::new(x, bottom - ROWS, width, ROWS);
    (Rect { height: side.y - y, ..table }, side)
}

/// Draws the jump, with the ball at its position at `time`, s. Height and distance have different scales: heights are enlarged.
pub fn draw_profile(profile: &Profile, time: Option<f64>, unit: LengthUnit, area: Rect, ui: &mut Ui) {
    Clear.render(area, ui.buffer);
    ui.buffer.set_style(area, ui.theme.text());
    let name = ui.theme.names()[profile.jump.ball];
    let inner = draw_title(
        vec![
            Span::styled("Side view", ui.theme.text()),
            ui.dash(),
            Span::styled(format!("{name} jumps, {}", jump_words(&profile.jump, unit)), ui.theme.faint()),
        ],
        area,
        ui,
    );
    if inner.height < 3 || inner.width <= 2 * LEFT {
        return;
    }
    let plot = Rect::new(inner.x + LEFT, inner.y, inner.width - LEFT - 1, inner.height - 1);
    let scale = DVec2::new(profile.length().max(1e-9), end_of_scale(profile.top()));
    let (top, ground) = (plot.y, plot.bottom());
    write_right(ui.buffer, inner.x, plot.x - 1, top, &height_words(scale.y, unit), ui.theme.faint());
    write_right(ui.buffer, inner.x, plot.x - 1, ground, "0", ui.theme.faint());
    for row in plot.y..plot.bottom() {
        ui.buffer.set_string(plot.x - 1, row, ui.caps.pick("│", "|"), ui.theme.rule());
    }
    let floor = ui.caps.pick("─", "-").repeat(usize::from(plot.width));
    ui.buffer.set_string(plot.x, ground, floor, ui.theme.rule());
    ui.buffer.set_string(plot.x - 1, ground, ui.caps.pick("└", "+"), ui.theme.rule());
    match ui.caps.glyphs {
        Glyphs::Letters => in_letters(profile, time, plot, scale, ui),
        _ => in_blocks(profile, time, plot, scale, ui),
    }
    let end = unit.words(profile.length());
    write_right(ui.buffer, plot.x, plot.right(), ground, &end, ui.theme.faint());
    let mut free = plot.x;
    for passed in &profile.passed {
        let (words, style) = match passed.obstacle {
            Obstacle::Ball(ball) => (ui.theme.names()[ball], ui.theme.ball(ball)),
            Obstacle::Nose(_) => ("nose", ui.theme.faint()),
        };
        let width = columns(words) as u16;
        let middle = plot.x + (passed.distance / scale.x * f64::from(plot.width)) as u16;
        let last = plot.right().saturating_sub(columns(&end) as u16 + 1 + width);
        let x = middle.saturating_sub(width / 2).max(plot.x);
        // If there is no room for a name, it is left out; its obstacle is still drawn.
        if x >= free && x <= last {
            ui.buffer.set_string(x, ground, words, style);
            free = x + width + 1;
        }
    }
}

/// The next round number above a height, m.
fn end_of_scale(height: f64) -> f64 {
    let power = 10_f64.powf(height.max(1e-4).log10().floor());
    let end = SCALE_ENDS.into_iter().find(|end| end * power >= 1.02 * height);
    end.unwrap_or(SCALE_ENDS[SCALE_ENDS.len() - 1]) * power
}

fn obstacle_color(passed: &PassedObstacle, ui: &Ui) -> Color {
    match passed.obstacle {
        Obstacle::Ball(ball) => ui.theme.signs[ball],
        Obstacle::Nose(_) => ui.theme.wood,
    }
}

/// Half the width of an obstacle, m. A ball's top is one diameter high.
fn half_width(passed: &PassedObstacle) -> f64 {
    match passed.obstacle {
        Obstacle::Ball(_) => 0.5 * passed.top,
        Obstacle::Nose(_) => 0.0,
    }
}

fn in_blocks(profile: &Profile, time: Option<f64>, plot: Rect, scale: DVec2, ui: &mut Ui) {
    let glyphs = ui.caps.glyphs;
    let (across, down) = sub_pixels(glyphs);
    let (width, height) = (f64::from(plot.width * across), f64::from(plot.height * down));
    let to_pixel = |distance: f64, up: f64| {
        ((distance / scale.x * (width - 1.0)).round() as i32, ((1.0 - up / scale.y) * (height - 1.0)).round() as i32)
    };
    let to_metres =
        |x: i32, y: i32| scale * DVec2::new(f64::from(x) / (width - 1.0), 1.0 - f64::from(y) / (height - 1.0));
    let mut canvas = Canvas::new(plot, glyphs, ui.theme.background);
    for passed in &profile.passed {
        let half = DVec2::new(half_width(passed), 0.5 * passed.top);
        let middle = DVec2::new(passed.distance, half.y);
        let ((left, bottom), (right, top)) =
            (to_pixel(passed.distance - half.x, 0.0), to_pixel(passed.distance + half.x, passed.top));
        for (x, y) in (left..=right).flat_map(|x| (top..=bottom).map(move |y| (x, y))) {
            // A nose is a line. A ball is an ellipse, since the two scales differ.
            if half.x == 0.0 || ((to_metres(x, y) - middle) / half).length() <= 1.0 {
                canvas.set(x, y, Ink { color: obstacle_color(passed, ui), weight: OBSTACLE_WEIGHT });
            }
        }
    }
    let course = Ink { color: ui.theme.accent, weight: COURSE_WEIGHT };
    for point in &profile.points {
        let (x, y) = to_pixel(point.distance, point.height);
        canvas.set(x, y, course);
    }
    if let Some(point) = time.and_then(|time| profile.at(time)) {
        let (x, y) = to_pixel(point.distance, point.height);
        let ink = Ink { color: ui.theme.signs[profile.jump.ball], weight: BALL_WEIGHT };
        for (right, up) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            canvas.set(x + right, y - up, ink);
        }
    }
    canvas.paint(ui.buffer);
}

fn in_letters(profile: &Profile, time: Option<f64>, plot: Rect, scale: DVec2, ui: &mut Ui) {
    let to_cell = |distance: f64, up: f64| {
        let part = |share: f64, cells: u16| (share.clamp(0.0, 1.0) * f64::from(cells - 1)).round() as u16;
        (plot.x + part(distance / scale.x, plot.width), plot.bottom() - 1 - part(up / scale.y, plot.height))
    };
    let letters = ui.theme.letters();
    let mut put = |at: (u16, u16), sign: char, color: Color| {
        ui.buffer[at].set_char(sign).set_style(Style::new().fg(color));
    };
    let theme = ui.theme;
    for passed in &profile.passed {
        let (sign, color) = match passed.obstacle {
            Obstacle::Ball(ball) => (letters[ball].to_ascii_lowercase(), theme.signs[ball]),
            Obstacle::Nose(_) => ('|', theme.text),
        };
        let (half, (_, top)) = (half_width(passed), to_cell(0.0, passed.top));
        let ((left, _), (right, _)) = (to_cell(passed.distance - half, 0.0), to_cell(passed.distance + half, 0.0));
        for x in left..=right {
            (top..plot.bottom()).for_each(|y| put((x, y), sign, color));
        }
    }
    for point in &profile.points {
        put(to_cell(point.distance, point.height), '*', theme.accent);
    }
    if let Some(point) = time.and_then(|time| profile.at(time)) {
        put(to_cell(point.distance, point.height), letters[profile.jump.ball], theme.signs[profile.jump.ball]);
    }
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;

    use super::*;
    use crate::{
        physics::CueInputs,
        simulation::Recording,
        table::{Layout, Table},
        terminal::{
            Capabilities, Depth,
            ui::{Theme, drawn},
        },
    };

    /// The rows of the picture of a jump over yellow, and its buffer.
    fn picture(time: Option<f64>, caps: Capabilities) -> (Vec<String>, Buffer) {
        let table = Table::default();
        let layout = Layout::parse("-0.5,0 -0.2,0 0.9,0.5", &table).unwrap();
        let recording = Recording::new(&table, &layout, &CueInputs::parse("0,0,45,0,5").unwrap()).unwrap();
        let profile = Profile::of(&table, &recording).unwrap();
        let area = Rect::new(0, 0, 64, 8);
        let buffer = drawn(area, caps, |ui| draw_profile(&profile, time, LengthUnit::Metres, area, ui));
        let row = |y: u16| (0..area.width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
        ((0..area.height).map(row).collect(), buffer)
    }

    #[test]
    fn the_side_view_of_a_jump_is_drawn_in_letters_and_colours() {
        let (rows, _) = picture(None, Capabilities::ASCII);
        let text = rows.join("\n");
        assert!(rows[0].starts_with("- Side view - white jumps, ") && rows[0].contains(" mm high, "), "{text}");
        assert!(rows[7].contains("yellow") && rows[7].trim_end().ends_with('m'), "{text}");
        let column = rows[6].find('y').unwrap();
        let top = rows[1..7].iter().position(|row| row.as_bytes()[column] == b'y').unwrap();
        let course = rows[1..7].iter().position(|row| row.as_bytes()[column] == b'*').unwrap();
        assert!(course < top, "the course is above the ball\n{text}");
        assert!(!text.contains('W'));
        let (moving, _) = picture(Some(0.05), Capabilities::ASCII);
        assert_eq!(moving.join("\n").matches('W').count(), 1);
        let (_, buffer) = picture(None, Capabilities::TRUE_COLOUR);
        let theme = Theme::new(Depth::True);
        let has = |color| buffer.content().iter().any(|cell| cell.fg == color || cell.bg == color);
        assert!(has(theme.accent) && has(theme.signs[1]));
    }

    #[test]
    fn the_scale_ends_at_a_round_height_above_the_jump() {
        let ends = [0.0021, 0.0098, 0.012, 0.031, 0.099, 0.21].map(end_of_scale);
        for (end, wanted) in ends.into_iter().zip([0.003, 0.01, 0.015, 0.05, 0.15, 0.3]) {
            assert!((end - wanted).abs() < 1e-12, "{end} {wanted}");
        }
    }
}
