//! The settings with their values, by groups, and the marked one in words.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use super::{Row, draw_list, write_paragraphs};
use crate::terminal::{
    app::App,
    settings::{ENTRIES, Entry, Settings},
    widgets::{cut, draw_title, wrap},
};

/// Columns of the names.
const NAME: u16 = 11;

/// All rows of the list.
pub fn rows() -> Vec<Row<&'static Entry>> {
    let mut rows = Vec::new();
    for (n, entry) in ENTRIES.iter().enumerate() {
        if n == 0 || ENTRIES[n - 1].group != entry.group {
            rows.push(Row::Heading(entry.group));
        }
        rows.push(Row::Entry(n, entry));
    }
    rows
}

/// Draws the list and the words; gives what the status line says while there is no news.
pub fn draw(app: &App, list: Rect, words: Rect, buffer: &mut Buffer) -> &'static str {
    let (theme, look, screen) = (app.theme(), app.look(), app.settings());
    let changed = ENTRIES.iter().filter(|entry| screen.is_changed(entry)).count();
    let of = if changed == 0 { String::new() } else { format!(" {changed} changed") };
    let title = Line::from(vec![Span::styled("Settings", theme.text()), Span::styled(of, theme.faint())]);
    let inner = draw_title(&title, list, theme, look, buffer);
    draw_list(app, &rows(), screen.mark(), inner, buffer, |entry, is_marked, area, buffer| {
        draw_entry(app, entry, is_marked, area, buffer);
    });
    draw_words(app, words, buffer);
    if screen.is_writable {
        "what is set holds at once and at every start"
    } else {
        "what is set holds until the program ends, while the file cannot be read or written"
    }
}

fn draw_entry(app: &App, entry: &Entry, is_marked: bool, area: Rect, buffer: &mut Buffer) {
    let (theme, look, screen) = (app.theme(), app.look(), app.settings());
    let is_changed = screen.is_changed(entry);
    let (name, value) = if is_marked { (theme.accent(), theme.accent()) } else { (theme.faint(), theme.text()) };
    buffer.set_string(area.x, area.y, entry.key, name);
    if is_changed {
        buffer.set_string(area.x + NAME - 1, area.y, look.pick("•", "*"), theme.good());
    }
    let (left, right) = if is_marked { look.pick(("◂ ", " ▸"), ("< ", " >")) } else { ("  ", "") };
    let x = area.x + NAME;
    let room = usize::from(area.right().saturating_sub(x + 5));
    let text = cut(wrap(&shown(&(entry.get)(&screen.settings)), room), 1, room, look).swap_remove(0);
    let mut spans =
        vec![Span::styled(left, theme.faint()), Span::styled(text, value), Span::styled(right, theme.faint())];
    if let Some(other) = screen.other_in_file(entry) {
        let room = usize::from(area.right().saturating_sub(x)).saturating_sub(Line::from(spans.clone()).width());
        let whole = format!(" now; the file has {}", shown(&other));
        // Where there is no room, the words on the marked setting say the rest.
        let note = if whole.chars().count() <= room { whole } else { " now".to_owned() };
        spans.push(Span::styled(note, theme.warning()));
    }
    buffer.set_line(x, area.y, &Line::from(spans), area.right().saturating_sub(x));
}

/// A value without the quotes that TOML wants.
fn shown(value: &str) -> String {
    value.trim_matches(['"', '\'']).to_owned()
}

fn draw_words(app: &App, area: Rect, buffer: &mut Buffer) {
    let (theme, look, screen) = (app.theme(), app.look(), app.settings());
    let entry = screen.marked();
    let title = Line::from(Span::styled(entry.key, theme.text()));
    let inner = draw_title(&title, area, theme, look, buffer);
    let default = (entry.get)(&Settings::default());
    let mut paragraphs = vec![
        (entry.about.to_owned(), theme.text()),
        (format!("Accepted: {}.", entry.accepted), theme.text()),
        (format!("Default: {default}."), if screen.is_changed(entry) { theme.text() } else { theme.faint() }),
    ];
    if let Some(other) = screen.other_in_file(entry) {
        let now = (entry.get)(&screen.settings);
        let keep = if screen.is_writable { " Enter twice keeps it." } else { "" };
        paragraphs.insert(0, (format!("Now {now}; the file has {other}.{keep}"), theme.warning()));
    }
    write_paragraphs(app, &paragraphs, inner, buffer);
}
