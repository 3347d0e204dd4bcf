//! The first row: the program, the table, and how far the shot has played.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Modifier,
    text::{Line, Span},
};

use crate::terminal::{
    app::{App, Mode},
    words::fixed,
};

/// Cells of the bar that shows how far the shot has played.
const BAR: u16 = 24;

/// Draws the row.
pub fn draw_header(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let table = app.table();
    let left = Line::from(vec![
        Span::styled(" carom ", theme.accent().add_modifier(Modifier::REVERSED)),
        Span::styled(format!(" {}", table.name), theme.text()),
        Span::styled(format!(" table {} x {} m", table.length, table.width), theme.faint()),
    ]);
    buffer.set_line(area.x, area.y, &left, area.width);
    let right = transport(app);
    let width = right.width() as u16;
    if let Some(x) = area.right().checked_sub(width + 1) {
        buffer.set_line(x, area.y, &right, width);
    }
}

fn transport(app: &App) -> Line<'static> {
    let (theme, look) = (app.theme(), app.look());
    let playback = app.playback();
    let Some(shot) = app.shot() else {
        return Line::from(Span::styled("placing balls", theme.faint()));
    };
    let duration = shot.recording.duration();
    let state = match app.mode() {
        Mode::Placing => "shot ready",
        Mode::Watching if playback.playing => "playing",
        Mode::Watching => "paused",
    };
    let done = if duration > 0.0 { (playback.readout / duration * f64::from(BAR)) as usize } else { usize::from(BAR) };
    Line::from(vec![
        Span::styled(format!("{state}  "), theme.text()),
        Span::styled(look.pick("━", "=").repeat(done), theme.accent()),
        Span::styled(look.pick("─", "-").repeat(usize::from(BAR) - done), theme.faint()),
        Span::styled(format!("  {:>5}", fixed(playback.readout, 2)), theme.text()),
        Span::styled(format!(" / {} s", fixed(duration, 2)), theme.faint()),
        Span::styled(format!("  {}{}", look.pick("×", "x"), playback.speed()), theme.text()),
    ])
}
