//! The panel of the shot's events: what has happened, what comes next and when.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use super::{draw_title, write_right};
use crate::{
    simulation::Event,
    terminal::{
        app::App,
        playback::passed,
        words::{event_words, fixed},
    },
};

/// Columns before an event's words.
const WORDS: u16 = 9;
/// Columns of an event's words and of how soon it comes.
const WAIT: u16 = 34;

/// Draws the panel: the stroke, then every event, with the present one marked and in view.
pub fn draw_events(app: &App, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let events: &[Event] = app.shot().map_or(&[], |shot| shot.recording.events());
    let time = app.playback().readout;
    // Row 0 is the stroke.
    let present = if app.watched().is_some() { passed(events, time) } else { 0 };
    let mut title = vec![Span::styled("Events", theme.text())];
    if app.shot().is_some() {
        title.push(Span::styled(format!(" {present}/{}", events.len()), theme.faint()));
    }
    let inner = draw_title(&Line::from(title), area, theme, look, buffer);
    if app.shot().is_none() || inner.is_empty() {
        return;
    }
    let rows = usize::from(inner.height);
    let first = present.saturating_sub(rows / 3).min((events.len() + 1).saturating_sub(rows));
    for (n, row) in (first..=events.len()).zip(inner.y..inner.bottom()) {
        let event = n.checked_sub(1).map(|n| events[n]);
        let (at, words) = event.map_or((0.0, "stroke".to_owned()), |event| (event.time, event_words(event.kind)));
        let style = match n {
            _ if n == present => theme.accent(),
            _ if n < present => theme.faint(),
            _ => theme.text(),
        };
        let pointer = if n == present { look.pick("▸", ">") } else { " " };
        buffer.set_string(inner.x, row, pointer, theme.accent());
        write_right(buffer, inner.x, inner.x + 7, row, &fixed(at, 3), style);
        buffer.set_stringn(inner.x + WORDS, row, &words, usize::from(inner.width.saturating_sub(WORDS)), style);
        if n == present + 1 && app.watched().is_some() {
            let wait = format!("in {} s", fixed(at - time, 1));
            if usize::from(inner.width) > usize::from(WORDS) + words.len() + wait.len() + 2 {
                let end = inner.right().saturating_sub(1).min(inner.x + WORDS + WAIT);
                write_right(buffer, inner.x, end, row, &wait, theme.faint());
            }
        }
    }
}
