//! The panel of the three balls: positions, speeds and kinds of motion.

use ratatui::{
    layout::Rect,
    style::Modifier,
    text::{Line, Span},
};

use crate::{
    physics::Motion,
    table::BALLS,
    terminal::{
        Mode,
        pages::coach::CoachPage,
        shot::Spin,
        ui::{Theme, Ui, draw_title, list, write_right},
        words::{fixed, format_fine},
    },
};

/// Right ends of the number columns, from the panel's left edge. The kind of motion starts at [`MOTION`].
const X_END: u16 = 17;
const Y_END: u16 = 24;
const SPEED_END: u16 = 30;
const MOTION: u16 = 31;
/// Right ends of the positions in diamonds, which are shown if no shot is watched.
const X_DIAMONDS_END: u16 = 31;
const Y_DIAMONDS_END: u16 = 37;

/// Draws the panel. If there is room, further lines on the layout or the shot follow below the balls.
pub fn draw_balls(coach: &CoachPage, area: Rect, ui: &mut Ui) {
    let inner = draw_title("Balls", area, ui);
    let speed = format!(" {} ", coach.units.length.speed().1);
    let other: &[_] = if coach.watched().is_some() {
        &[(SPEED_END, &*speed)]
    } else {
        &[(X_DIAMONDS_END, " x d "), (Y_DIAMONDS_END, " y d ")]
    };
    let symbol = coach.units.length.fine().1;
    let [x, y] = ["x", "y"].map(|axis| format!(" {axis} {symbol} "));
    for &(end, label) in [(X_END, &*x), (Y_END, &*y)].iter().chain(other) {
        write_right(ui.buffer, area.x, area.x + end + 1, area.y, label, ui.theme.faint());
    }
    for (ball, row) in (0..BALLS).zip(inner.y..inner.bottom()) {
        draw_ball(coach, ball, Rect { y: row, height: 1, ..inner }, ui);
    }
    for (line, row) in more(coach, ui.theme).into_iter().zip(inner.y + BALLS as u16 + 1..inner.bottom()) {
        ui.buffer.set_line(inner.x + 1, row, &line, inner.width.saturating_sub(2));
    }
}

fn draw_ball(coach: &CoachPage, ball: usize, area: Rect, ui: &mut Ui) {
    let selected = coach.mode == Mode::Placing && ball == coach.selected;
    let mut style = ui.theme.text();
    if selected {
        style = ui.theme.accent();
    }
    let marker =
        if ui.theme.is_mono() || !ui.caps.unicode { ui.theme.letters()[ball] } else { ui.theme.ball_sign(ball) };
    list::draw_mark(selected, area.x, area.y, ui);
    ui.buffer.set_string(area.x + 1, area.y, marker.to_string(), ui.theme.ball(ball).add_modifier(Modifier::BOLD));
    ui.buffer.set_string(area.x + 3, area.y, ui.theme.names()[ball], style);
    let (place, speed, motion) = match coach.watched() {
        Some(shot) => {
            let time = coach.playback.readout;
            let state = shot.recording.state(ball, time);
            let speed = state.velocity.length();
            let motion = shot.recording.motion(ball, time);
            if motion == Motion::OffTable {
                write_right(ui.buffer, area.x, area.x + SPEED_END, area.y, "off the table", style);
                return;
            }
            let spin = Spin::of(&state, motion, coach.table().radius);
            (state.position, Some(speed), spin.word)
        }
        None => (coach.layout().balls[ball], None, ""),
    };
    let unit = coach.units.length;
    write_right(ui.buffer, area.x, area.x + X_END, area.y, &format_fine(place.x, unit), style);
    write_right(ui.buffer, area.x, area.x + Y_END, area.y, &format_fine(place.y, unit), style);
    if let Some(speed) = speed {
        write_right(ui.buffer, area.x, area.x + SPEED_END, area.y, &fixed(unit.speed().0 * speed, 2), style);
    } else {
        let diamonds = coach.table().to_diamonds(place);
        write_right(ui.buffer, area.x, area.x + X_DIAMONDS_END, area.y, &fixed(diamonds.x, 2), style);
        write_right(ui.buffer, area.x, area.x + Y_DIAMONDS_END, area.y, &fixed(diamonds.y, 2), style);
    }
    let motion = Line::styled(motion, ui.theme.faint());
    ui.buffer.set_line(area.x + MOTION, area.y, &motion, area.width.saturating_sub(MOTION));
}

fn more(coach: &CoachPage, theme: &Theme) -> Vec<Line<'static>> {
    let label = |text: &'static str| Span::styled(text, theme.faint());
    let value = |text: String| Span::styled(text, theme.text());
    let (mut lines, unit) = (Vec::new(), coach.units.length);
    if coach.mode == Mode::Placing {
        lines.push(Line::from(vec![label("step "), value(coach.step_words()), label(" (Shift x10, Ctrl x0.1)")]));
        let mut gaps = vec![label("gap")];
        for other in (0..BALLS).filter(|&other| other != coach.selected) {
            let balls = coach.layout().balls;
            let gap = (balls[coach.selected].distance(balls[other]) - 2.0 * coach.table().radius).max(0.0);
            gaps.push(label(if gaps.len() > 1 { ", " } else { " " }));
            gaps.push(value(format!("{} {}", theme.names()[other], format_fine(gap, unit))));
        }
        gaps.push(label(" "));
        gaps.push(label(unit.fine().1));
        lines.push(Line::from(gaps));
    }
    if let Some(contact) = coach.shot().and_then(|shot| shot.contact_words(coach.cue_ball())) {
        lines.push(Line::from(value(contact)));
    }
    lines
}
