//! The panel of the three balls: where they lie, how fast they move and how.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Modifier,
    text::{Line, Span},
};

use super::{draw_title, write_right};
use crate::{
    table::BALLS,
    terminal::{
        app::{App, Mode},
        spin::Spin,
        words::{fixed, millimetres, step_words},
    },
};

/// Columns at which the numbers end, from the panel's left edge.
const X_END: u16 = 17;
const Y_END: u16 = 24;
const SPEED_END: u16 = 30;
const MOTION: u16 = 31;

/// Draws the panel; below the balls, if there is room, more about the layout or the shot.
pub fn draw_balls(app: &App, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let inner = draw_title(&Line::from(Span::styled("Balls", theme.text())), area, theme, look, buffer);
    for (end, label) in [(X_END, " x mm "), (Y_END, " y mm "), (SPEED_END, " m/s ")] {
        write_right(buffer, area.x, area.x + end + 1, area.y, label, theme.faint());
    }
    for (ball, row) in (0..BALLS).zip(inner.y..inner.bottom()) {
        draw_ball(app, ball, Rect { y: row, height: 1, ..inner }, buffer);
    }
    for (line, row) in more(app).into_iter().zip(inner.y + BALLS as u16 + 1..inner.bottom()) {
        buffer.set_line(inner.x + 1, row, &line, inner.width.saturating_sub(2));
    }
}

fn draw_ball(app: &App, ball: usize, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let selected = app.mode() == Mode::Placing && ball == app.selected();
    let mut style = theme.text();
    if selected {
        style = theme.accent();
    }
    let marker = if theme.is_mono() || !look.unicode { theme.letters()[ball] } else { '●' };
    let pointer = if selected { look.pick("▸", ">") } else { " " };
    buffer.set_string(area.x, area.y, pointer, theme.accent());
    buffer.set_string(area.x + 1, area.y, marker.to_string(), theme.ball(ball).add_modifier(Modifier::BOLD));
    buffer.set_string(area.x + 3, area.y, theme.names()[ball], style);
    let (place, speed, motion) = match app.watched() {
        Some(shot) => {
            let time = app.playback().readout;
            let state = shot.recording.state(ball, time);
            let speed = state.velocity.length();
            let spin = Spin::of(&state, shot.recording.motion(ball, time), app.table().radius);
            (state.position, Some(speed), spin.word)
        }
        None => (app.layout().balls[ball], None, ""),
    };
    write_right(buffer, area.x, area.x + X_END, area.y, &millimetres(place.x), style);
    write_right(buffer, area.x, area.x + Y_END, area.y, &millimetres(place.y), style);
    if let Some(speed) = speed {
        write_right(buffer, area.x, area.x + SPEED_END, area.y, &fixed(speed, 2), style);
    }
    buffer.set_stringn(area.x + MOTION, area.y, motion, usize::from(area.width.saturating_sub(MOTION)), theme.faint());
}

fn more(app: &App) -> Vec<Line<'static>> {
    let theme = app.theme();
    let label = |text: &'static str| Span::styled(text, theme.faint());
    let value = |text: String| Span::styled(text, theme.text());
    let mut lines = Vec::new();
    if app.mode() == Mode::Placing {
        lines.push(Line::from(vec![
            label("step "),
            value(step_words(app.step_mm())),
            label(" (Shift x10, Ctrl x0.1)"),
        ]));
        let mut gaps = vec![label("gap")];
        for other in (0..BALLS).filter(|&other| other != app.selected()) {
            let balls = app.layout().balls;
            let gap = (balls[app.selected()].distance(balls[other]) - 2.0 * app.table().radius).max(0.0);
            gaps.push(label(if gaps.len() > 1 { ", " } else { " " }));
            gaps.push(value(format!("{} {}", theme.names()[other], millimetres(gap))));
        }
        gaps.push(label(" mm"));
        lines.push(Line::from(gaps));
    }
    if let Some(contact) = app.shot().and_then(|shot| shot.contact_words(app.cue_ball())) {
        lines.push(Line::from(value(contact)));
    }
    lines
}
