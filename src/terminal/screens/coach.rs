//! The coach's screen: the table, what the coach recommends, and the shot as it plays.

use ratatui::{buffer::Buffer, layout::Rect};

use super::panes::Panes;
use crate::{
    table::BALLS,
    terminal::{
        app::{App, Mode},
        playback::passed,
        status::Message,
        widgets::{
            TableView, draw_balls, draw_events, draw_header, draw_hints, draw_shot, draw_status, draw_table, draw_tip,
        },
        words::{BALL_NAMES, event_words, fixed, millimetres, step_words},
    },
};

/// Draws the screen.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let panes = Panes::new(app.table(), area);
    draw_header(app, panes.header, buffer);
    let view = TableView {
        table: app.table(),
        layout: app.layout(),
        shot: app.shot().map(AsRef::as_ref),
        time: app.playback().time,
        is_moving: app.mode() == Mode::Watching,
        front: app.selected(),
        spots: &[],
        theme: app.theme(),
        look: app.look(),
    };
    draw_table(&view, panes.table, buffer);
    draw_balls(app, panes.balls, buffer);
    let (table, shot, theme, look) = (app.table(), app.shot().map(AsRef::as_ref), app.theme(), app.look());
    draw_shot(shot, &["no shot yet", "Enter asks", "the coach"], table, panes.shot, theme, look, buffer);
    draw_tip(shot.map(|shot| &shot.cue), table, panes.tip, theme, look, buffer);
    let time = app.watched().map(|_| app.playback().readout);
    draw_events(shot, time, panes.events, theme, look, buffer);
    let standing = || Message::plain(standing(app));
    draw_status(&app.message().cloned().unwrap_or_else(standing), panes.status, app.theme(), app.look(), buffer);
    draw_hints(app, panes.hints, buffer);
}

/// What the status line says while there is no news.
fn standing(app: &App) -> String {
    if let Some(picture) = app.spinner() {
        let pictures =
            app.look().pick(["⠋", "⠙", "⠹", "⠸", "⠼", "⠴", "⠦", "⠧"], ["|", "/", "-", "\\", "|", "/", "-", "\\"]);
        return format!("{} the coach is thinking; Esc stops it", pictures[picture % pictures.len()]);
    }
    match app.watched() {
        Some(shot) => {
            let (events, time) = (shot.recording.events(), app.playback().readout);
            events.get(passed(events, time)).map_or("all balls lie still".to_owned(), |next| {
                format!("next: {} in {} s", event_words(next.kind), fixed(next.time - time, 1))
            })
        }
        None => selected_ball(app),
    }
}

/// Where the selected ball lies, how far the nearest other one is, and how far a key moves it.
fn selected_ball(app: &App) -> String {
    let (ball, balls) = (app.selected(), app.layout().balls);
    let others = (0..BALLS).filter(|&other| other != ball);
    let gap = |other: usize| (balls[ball].distance(balls[other]) - 2.0 * app.table().radius).max(0.0);
    let nearest = others.min_by(|&one, &two| gap(one).total_cmp(&gap(two)));
    let near =
        nearest.map_or(String::new(), |other| format!(", {} mm from {}", millimetres(gap(other)), BALL_NAMES[other]));
    let (x, y) = (millimetres(balls[ball].x), millimetres(balls[ball].y));
    format!("{} at x {x} mm, y {y} mm{near}; step {}", BALL_NAMES[ball], step_words(app.step_mm()))
}
