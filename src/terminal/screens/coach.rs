//! The coach's screen: the table, what the coach recommends, and the shot as it plays.

use ratatui::{buffer::Buffer, layout::Rect};

use super::panes::Panes;
use crate::terminal::{
    app::App,
    widgets::{draw_balls, draw_events, draw_header, draw_hints, draw_shot, draw_status, draw_table, draw_tip},
};

/// Most rows that a long sentence on the status line may take.
const STATUS_ROWS: u16 = 3;

/// Draws the screen.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let panes = Panes::new(app.table(), area);
    draw_header(app, panes.header, buffer);
    draw_table(app, panes.table, buffer);
    draw_balls(app, panes.balls, buffer);
    draw_shot(app, panes.shot, buffer);
    draw_tip(app, panes.tip, buffer);
    draw_events(app, panes.events, buffer);
    let above = STATUS_ROWS - 1;
    let status = Rect { y: panes.status.y.saturating_sub(above), height: STATUS_ROWS, ..panes.status };
    draw_status(app, status, buffer);
    draw_hints(app, panes.hints, buffer);
}
