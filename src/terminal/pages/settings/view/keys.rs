//! The view of the key bindings: the list of commands with their keys, and the description of the marked one.

use ratatui::{layout::Rect, text::Span};

use crate::terminal::{
    Capabilities, SettingsPage,
    keymap::{Chord, KeyEntry, keys_text},
    pages::settings::view::write_words,
    ui::{Ui, draw_title, list::Grouped, shorten, stepper},
};

/// Width of the keys, columns.
const KEYS: u16 = 14;

/// The list, grouped by the headings of the help.
pub fn list(settings: &SettingsPage) -> Grouped<&KeyEntry> {
    Grouped::new(&settings.keys.page().entries, settings.keys.mark, |entry| entry.section.title())
}

/// Draws the list and the description. Returns the default text of the status line.
pub fn draw(settings: &SettingsPage, area: Rect, words: Rect, ui: &mut Ui) -> &'static str {
    let mut title = vec![Span::styled("Keys ", ui.theme.text())];
    title.extend(stepper(Span::styled(settings.keys.page().name, ui.theme.accent()), true, ui));
    let inner = draw_title(title, area, ui);
    list(settings).draw(inner, ui, |entry, is_marked, area, ui| {
        draw_entry(settings, entry, is_marked, area, ui);
    });
    if let Some(entry) = settings.keys.marked() {
        draw_description(settings, entry, words, ui);
    }
    "Enter gives what is marked another key"
}

fn draw_entry(settings: &SettingsPage, entry: &KeyEntry, is_marked: bool, area: Rect, ui: &mut Ui) {
    let is_changed = !settings.settings.keys.about(&entry.chords).is_empty();
    let keys = keys_of(settings, entry, ui.caps).unwrap_or_else(|| "none".to_owned());
    let keys = shorten(&keys, usize::from(KEYS - 2), ui.caps);
    ui.buffer.set_stringn(area.x, area.y, keys, usize::from(KEYS), ui.theme.accent());
    if is_changed {
        ui.buffer.set_string(area.x + KEYS - 2, area.y, ui.caps.pick("•", "*"), ui.theme.good());
    }
    let room = usize::from(area.width.saturating_sub(KEYS + 1));
    let style = if is_marked { ui.theme.accent() } else { ui.theme.text() };
    ui.buffer.set_string(area.x + KEYS, area.y, shorten(entry.words, room, ui.caps), style);
}

/// The current keys of a command, the user's own first; `None` if it has none.
fn keys_of(settings: &SettingsPage, entry: &KeyEntry, caps: Capabilities) -> Option<String> {
    let keys = &settings.settings.keys;
    let text = keys_text(entry.chords.iter().flat_map(|chord| keys.keys_for(*chord)), caps);
    (!text.is_empty()).then_some(text)
}

fn draw_description(settings: &SettingsPage, entry: &KeyEntry, area: Rect, ui: &mut Ui) {
    let inner = draw_title(entry.section.title(), area, ui);
    let keys = keys_of(settings, entry, ui.caps).unwrap_or_else(|| "no key".to_owned());
    let mut paragraphs = vec![
        (entry.words.to_owned(), ui.theme.text()),
        (format!("Keys: {keys}. By default: {}.", keys_text(entry.chords.iter().copied(), ui.caps)), ui.theme.text()),
    ];
    let commands = settings.keys.commands();
    if let (Some(chord), true) = (entry.chords.first(), commands.len() > 1) {
        let all = list_commands(&commands);
        paragraphs.push((
            format!("A key of your own does all that {} does: {all}.", keys_text([*chord], ui.caps)),
            ui.theme.faint(),
        ));
    }
    write_words(paragraphs, inner, ui);
}

/// The commands of a key, each with its page.
fn list_commands(commands: &[(&str, &str)]) -> String {
    let commands: Vec<String> = commands.iter().map(|(page, what)| format!("{what} ({page})")).collect();
    commands.join("; ")
}

/// The question for the new key.
pub fn new_key_prompt(settings: &SettingsPage) -> String {
    let what = settings.keys.marked().map_or("", |entry| entry.words);
    format!("press the key that should do this: {what}")
}

/// The question about a key that already has another command.
pub fn key_conflict_question(settings: &SettingsPage, chord: Chord, caps: Capabilities) -> String {
    let commands = settings.keys.other_commands(chord, &settings.settings.keys);
    format!("{} already does: {}. Use it for this instead?", keys_text([chord], caps), list_commands(&commands))
}
