//! What each page of the program can do with its keys, and the marked one in words.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use super::{Row, draw_list, write_paragraphs};
use crate::terminal::{
    app::App,
    chord::{Chord, keys_text},
    finder::Command,
    widgets::{cut, draw_title, wrap},
};

/// Columns of the keys.
const KEYS: u16 = 14;

/// All rows of the list.
pub fn rows(app: &App) -> Vec<Row<Command>> {
    let commands = app.settings().keys.commands(app.keys(), app.look());
    let mut rows: Vec<Row<Command>> = Vec::new();
    let mut heading = "";
    for (n, command) in commands.into_iter().enumerate() {
        if command.title != heading {
            heading = command.title;
            rows.push(Row::Heading(heading));
        }
        rows.push(Row::Entry(n, command));
    }
    rows
}

/// Draws the list and the words; gives what the status line says while there is no news.
pub fn draw(app: &App, list: Rect, words: Rect, buffer: &mut Buffer) -> &'static str {
    let (theme, look, screen) = (app.theme(), app.look(), app.settings());
    let (left, right) = look.pick(("◂ ", " ▸"), ("< ", " >"));
    let title = Line::from(vec![
        Span::styled("Keys ", theme.text()),
        Span::styled(left, theme.faint()),
        Span::styled(screen.keys.page().1, theme.accent()),
        Span::styled(right, theme.faint()),
    ]);
    let inner = draw_title(&title, list, theme, look, buffer);
    let rows = rows(app);
    draw_list(app, &rows, screen.keys.mark(), inner, buffer, |command, is_marked, area, buffer| {
        draw_command(app, command, is_marked, area, buffer);
    });
    if let Some(command) = marked(app, rows) {
        draw_words(app, &command, words, buffer);
    }
    "Enter gives what is marked another key"
}

fn draw_command(app: &App, command: &Command, is_marked: bool, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let is_changed = !app.keys().about(&command.chords).is_empty();
    let keys = if command.keys.is_empty() { "none" } else { &command.keys };
    let keys = cut(wrap(keys, usize::from(KEYS - 2)), 1, usize::from(KEYS - 2), look).swap_remove(0);
    buffer.set_stringn(area.x, area.y, keys, usize::from(KEYS), theme.accent());
    if is_changed {
        buffer.set_string(area.x + KEYS - 2, area.y, look.pick("•", "*"), theme.good());
    }
    let room = usize::from(area.width.saturating_sub(KEYS + 1));
    let text = cut(wrap(command.description, room), 1, room, look).swap_remove(0);
    buffer.set_stringn(area.x + KEYS, area.y, text, room, if is_marked { theme.accent() } else { theme.text() });
}

fn marked(app: &App, rows: Vec<Row<Command>>) -> Option<Command> {
    let mark = app.settings().keys.mark();
    rows.into_iter().find_map(|row| match row {
        Row::Entry(place, command) if place == mark => Some(command),
        _ => None,
    })
}

fn draw_words(app: &App, command: &Command, area: Rect, buffer: &mut Buffer) {
    let (theme, look, screen) = (app.theme(), app.look(), app.settings());
    let title = Line::from(Span::styled(command.title, theme.text()));
    let inner = draw_title(&title, area, theme, look, buffer);
    let keys = if command.keys.is_empty() { "no key" } else { &command.keys };
    let mut paragraphs = vec![
        (command.description.to_owned(), theme.text()),
        (format!("Keys: {keys}. By default: {}.", keys_text(command.chords.iter().copied(), look)), theme.text()),
    ];
    let works = screen.keys.works();
    if let (Some(chord), true) = (command.chords.first(), works.len() > 1) {
        let all = tell(&works);
        paragraphs
            .push((format!("A key of your own does all that {} does: {all}.", words(app, *chord)), theme.faint()));
    }
    write_paragraphs(app, &paragraphs, inner, buffer);
}

/// What a key does, page by page.
fn tell(works: &[(&str, &str)]) -> String {
    let works: Vec<String> = works.iter().map(|(page, what)| format!("{what} ({page})")).collect();
    works.join("; ")
}

fn words(app: &App, chord: Chord) -> String {
    keys_text([chord], app.look())
}

/// What is asked while a key is to be pressed.
pub fn press(app: &App) -> String {
    let what = marked(app, rows(app)).map_or("", |command| command.description);
    format!("press the key that is to do this: {what}")
}

/// What is asked about a key that does something else.
pub fn taken(app: &App, chord: Chord) -> String {
    let works = app.settings().keys.other_works(chord, app.keys());
    format!("{} does something else: {}. Shall it do this instead? y/n", words(app, chord), tell(&works))
}
