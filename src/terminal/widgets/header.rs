//! The first row: the program, the table, what is asked, and how far the shot has played.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::Modifier,
    text::{Line, Span},
};

use crate::terminal::{
    app::{App, Mode},
    words::{fixed, rule_word, skill_word},
};

/// Most cells of the bar that shows how far the shot has played.
const BAR: u16 = 40;

/// Columns from which on the table's size is told.
const WIDE: u16 = 100;

/// Draws the row.
pub fn draw_header(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let table = app.table();
    let tutor = &app.coach().tutor;
    let mut left = Line::from(vec![
        Span::styled(" carom ", theme.accent().add_modifier(Modifier::REVERSED)),
        Span::styled(format!(" {}", table.name), theme.text()),
    ]);
    match &tutor.policy {
        Some((name, _)) => left.push_span(Span::styled(format!(" {name}"), theme.good())),
        None if area.width < WIDE => {}
        None => left.push_span(Span::styled(format!(" {} x {} m", table.length, table.width), theme.faint())),
    }
    let plan = if tutor.plan { "plan" } else { "off" };
    for (key, words) in [(" R", rule_word(tutor.rule)), ("S", skill_word(tutor.skill)), ("P", plan)] {
        left.push_span(Span::styled(format!(" {key}"), theme.accent()));
        left.push_span(Span::styled(format!(" {words}"), theme.text()));
    }
    let taken = buffer.set_line(area.x, area.y, &left, area.width).0;
    let room = area.right().saturating_sub(taken + 4);
    // The bar is left out where a long name leaves it no room.
    let bar = BAR.min(room.saturating_sub(transport(app, 0).width() as u16));
    let right = transport(app, usize::from(bar));
    let x = area.right().saturating_sub(right.width() as u16 + 1).max(taken + 1);
    buffer.set_line(x, area.y, &right, area.right().saturating_sub(x));
}

fn transport(app: &App, bar: usize) -> Line<'static> {
    let (theme, look) = (app.theme(), app.look());
    let playback = app.playback();
    let is_thinking = app.spinner().is_some();
    let Some(shot) = app.shot() else {
        let words = if is_thinking { "thinking" } else { "placing balls" };
        return Line::from(Span::styled(words, theme.faint()));
    };
    let duration = shot.recording.duration();
    let state = match app.mode() {
        _ if is_thinking => "thinking",
        Mode::Placing => "shot ready",
        Mode::Watching if playback.playing => "playing",
        Mode::Watching => "paused",
    };
    let done = if duration > 0.0 { (playback.readout / duration * bar as f64) as usize } else { bar };
    Line::from(vec![
        Span::styled(format!("{state:<10}  "), theme.text()),
        Span::styled(look.pick("━", "=").repeat(done.min(bar)), theme.accent()),
        Span::styled(look.pick("─", "-").repeat(bar - done.min(bar)), theme.faint()),
        Span::styled(format!("  {:>5}", fixed(playback.readout, 2)), theme.text()),
        Span::styled(format!(" / {} s", fixed(duration, 2)), theme.faint()),
        Span::styled(format!("  {}{}", look.pick("×", "x"), playback.speed()), theme.text()),
    ])
}
