//! The panel of the shot's events: past ones, and the next ones with their times.

use ratatui::{layout::Rect, text::Span};

use crate::{
    coach::{
        jump_words,
        words::{LengthUnit, height_words},
    },
    simulation::{Event, Recording},
    terminal::{
        shot::playback::passed_count,
        ui::{Ui, draw_title, list, write_right},
        words::{event_words, fixed},
    },
};

/// Column where an event's time ends, column where its words start, and decimals of its time: in a wide and in a narrow panel.
const COLUMNS: (u16, u16, usize) = (7, 9, 3);
const NARROW_COLUMNS: (u16, u16, usize) = (6, 7, 2);
/// Panel width from which the longest words fit, columns.
const WIDE: u16 = 29;
/// Columns of an event's words and its countdown.
const WAIT: u16 = 34;

/// Describes the event, in at most `room` columns if possible; for a jump, with its height and length if they fit.
fn words_of(event: Event, recording: &Recording, unit: LengthUnit, room: usize, ui: &Ui) -> String {
    let words = event_words(event.kind, ui.theme.cue_ball);
    let Some(jump) = recording.jump_started_by(&event) else { return words };
    let height = height_words(jump.height, unit);
    let name = ui.theme.names()[jump.ball];
    let all =
        [format!("{words} ({})", jump_words(&jump, unit)), format!("{words} {height}"), format!("{name} {height} up")];
    all.into_iter().find(|words| words.len() <= room).unwrap_or(words)
}

/// Draws the panel `name`: the stroke, then the `listed` events of a recorded shot, with the event at `time` marked and in view. If `time`
/// is `None`, the shot is not playing.
pub fn draw_events(
    name: &str,
    listed: Option<(&Recording, &[Event])>,
    time: Option<f64>,
    unit: LengthUnit,
    area: Rect,
    ui: &mut Ui,
) {
    let events = listed.map_or(&[][..], |(_, events)| events);
    // Row 0 is the stroke.
    let present = time.map_or(0, |time| passed_count(events, time));
    let mut title = vec![Span::styled(name.to_owned(), ui.theme.text())];
    if listed.is_some() {
        title.push(Span::styled(format!(" {present}/{}", events.len()), ui.theme.faint()));
    }
    let inner = draw_title(title, area, ui);
    let Some((recording, _)) = listed.filter(|_| !inner.is_empty()) else { return };
    let is_narrow = inner.width < WIDE;
    let (end, start, decimals) = if is_narrow { NARROW_COLUMNS } else { COLUMNS };
    let room = usize::from(inner.width.saturating_sub(start));
    let rows = usize::from(inner.height);
    let first = present.saturating_sub(rows / 3).min((events.len() + 1).saturating_sub(rows));
    for (n, row) in (first..=events.len()).zip(inner.y..inner.bottom()) {
        let event = n.checked_sub(1).map(|n| events[n]);
        let row_of = |event: Event| (event.time, words_of(event, recording, unit, room, ui));
        let (at, words) = event.map_or((0.0, "stroke".to_owned()), row_of);
        let words = if is_narrow {
            words.trim_end_matches(" rail").replace("contact begins", "touches").replace("contact ends", "is free")
        } else {
            words
        };
        let is_long = words.len() + usize::from(start) >= usize::from(inner.width);
        let words = if is_long { words.replace(" - ", "-") } else { words };
        let style = match n {
            _ if n == present => ui.theme.accent(),
            _ if n < present => ui.theme.faint(),
            _ => ui.theme.text(),
        };
        list::draw_mark(n == present, inner.x, row, ui);
        write_right(ui.buffer, inner.x, inner.x + end, row, &fixed(at, decimals), style);
        ui.buffer.set_stringn(inner.x + start, row, &words, usize::from(inner.width.saturating_sub(start)), style);
        if n == present + 1
            && let Some(time) = time
        {
            let wait = format!("in {} s", fixed(at - time, 1));
            if usize::from(inner.width) > usize::from(start) + words.len() + wait.len() + 2 {
                let end = inner.right().saturating_sub(1).min(inner.x + start + WAIT);
                write_right(ui.buffer, inner.x, end, row, &wait, ui.theme.faint());
            }
        }
    }
}
