//! The view of the settings: the list of settings with their values, and the description of the marked one.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::terminal::{
    Settings, SettingsPage, Terms,
    config::{ENTRIES, Entry},
    pages::settings::view::write_words,
    ui::{Ui, columns, draw_title, list::Grouped, shorten, stepper},
};

/// Width of the names, columns.
const NAME: u16 = 13;

/// The list, grouped.
pub fn list(settings: &SettingsPage) -> Grouped<&'static Entry> {
    Grouped::new(ENTRIES, settings.mark, |entry| entry.group)
}

/// Draws the list and the description. Returns the default text of the status line.
pub fn draw(settings: &SettingsPage, area: Rect, words: Rect, ui: &mut Ui) -> &'static str {
    let changed = ENTRIES.iter().filter(|entry| settings.is_changed(entry)).count();
    let of = if changed == 0 { String::new() } else { format!(" {changed} changed") };
    let title = vec![Span::styled("Settings", ui.theme.text()), Span::styled(of, ui.theme.faint())];
    let inner = draw_title(title, area, ui);
    list(settings).draw(inner, ui, |entry, is_marked, area, ui| {
        draw_entry(settings, entry, is_marked, area, ui);
    });
    draw_description(settings, words, ui);
    if settings.is_writable {
        "changes apply at once and are saved"
    } else {
        "changes last until the program ends: the file has a fault (F6), or cannot be written"
    }
}

fn draw_entry(settings: &SettingsPage, entry: &Entry, is_marked: bool, area: Rect, ui: &mut Ui) {
    let is_changed = settings.is_changed(entry);
    let (name, value) =
        if is_marked { (ui.theme.accent(), ui.theme.accent()) } else { (ui.theme.faint(), ui.theme.text()) };
    ui.buffer.set_string(area.x, area.y, entry.key, name);
    if is_changed {
        ui.buffer.set_string(area.x + NAME - 1, area.y, ui.caps.pick("•", "*"), ui.theme.good());
    }
    let x = area.x + NAME;
    let room = usize::from(area.right().saturating_sub(x + 5));
    let text = shorten(&settings.display_value(&(entry.get)(&settings.settings)), room, ui.caps);
    let mut spans = stepper(Span::styled(text, value), is_marked, ui).to_vec();
    if let Some(other) = settings.different_value_in_file(entry) {
        let room = usize::from(area.right().saturating_sub(x)).saturating_sub(Line::from(spans.clone()).width());
        let whole = if Terms::KEPT.contains(&entry.key) {
            " now and at the next start".to_owned()
        } else {
            format!(" now; the next start uses {}", settings.display_value(&other))
        };
        // If this does not fit, the description of the marked setting contains the rest.
        let note = if columns(&whole) <= room { whole } else { " now".to_owned() };
        spans.push(Span::styled(note, ui.theme.warning()));
    }
    ui.buffer.set_line(x, area.y, &Line::from(spans), area.right().saturating_sub(x));
}

fn draw_description(settings: &SettingsPage, area: Rect, ui: &mut Ui) {
    let entry = settings.marked();
    let inner = draw_title(entry.key, area, ui);
    let default = (entry.get)(&Settings::default());
    let own: Vec<String> = settings
        .own_tables_of(entry)
        .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .collect();
    let accepted = if own.is_empty() { String::new() } else { format!(" Your own: {}.", own.join(", ")) };
    let mut paragraphs = vec![
        (entry.about.to_owned(), ui.theme.text()),
        (format!("Accepted: {}.{accepted}", entry.accepted), ui.theme.text()),
        (format!("Default: {default}."), if settings.is_changed(entry) { ui.theme.text() } else { ui.theme.faint() }),
    ];
    if let Some(other) = settings.different_value_in_file(entry) {
        let now = (entry.get)(&settings.settings);
        let keep = if settings.is_writable { format!(" Enter twice saves {now}.") } else { String::new() };
        let words = if Terms::KEPT.contains(&entry.key) {
            format!("Now {now}, also at the next start. The file says {other}.{keep}")
        } else {
            format!("Now {now}; the next start uses {other}.{keep}")
        };
        paragraphs.insert(0, (words, ui.theme.warning()));
    }
    write_words(paragraphs, inner, ui);
}
