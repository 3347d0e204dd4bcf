//! The last rows: what has just happened, and the keys that may be used now.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
    widgets::{Clear, Widget},
};

use crate::terminal::{
    app::App,
    chord::{Chord, keys_text},
    keymap::{Action, Binding, FinderAction, Place, Section, SettingsPlace, When, bindings},
    look::Look,
    status::{Message, Tone},
    theme::Theme,
};

/// Columns between two hints.
const GAP: usize = 3;

/// Most rows that a long sentence on the status line may take, and a question with what was answered wrongly.
const STATUS_ROWS: u16 = 3;
const QUESTION_ROWS: u16 = 8;

/// Draws a sentence into the row `area`; one that is longer takes some rows above it as well.
/// Gives the first of them.
pub fn draw_status(message: &Message, area: Rect, theme: &Theme, look: Look, buffer: &mut Buffer) -> u16 {
    draw_rows(message, STATUS_ROWS, area, theme, look, buffer)
}

/// Draws a question like a sentence; its end, which is answered, is to be seen however long it is.
pub fn draw_question(question: &Message, area: Rect, theme: &Theme, look: Look, buffer: &mut Buffer) -> u16 {
    draw_rows(question, QUESTION_ROWS, area, theme, look, buffer)
}

fn draw_rows(message: &Message, most: u16, area: Rect, theme: &Theme, look: Look, buffer: &mut Buffer) -> u16 {
    let style = match message.tone {
        Tone::Plain => theme.text(),
        Tone::Good => theme.good(),
        Tone::Poor | Tone::Warning => theme.warning(),
    };
    let width = area.width.saturating_sub(2);
    let most = most.min(area.bottom());
    let lines = cut(wrap(&message.text, usize::from(width)), usize::from(most), usize::from(width), look);
    let rows = lines.len() as u16;
    let place = Rect::new(area.x, area.bottom() - rows, area.width, rows);
    Clear.render(place, buffer);
    buffer.set_style(place, theme.text());
    for (line, row) in lines.iter().zip(place.y..place.bottom()) {
        buffer.set_stringn(place.x + 1, row, line, usize::from(width), style);
    }
    place.y
}

/// The first `rows` lines; the last of them says by its end if there are more.
pub fn cut(mut lines: Vec<String>, rows: usize, width: usize, look: Look) -> Vec<String> {
    if lines.len() <= rows {
        return lines;
    }
    lines.truncate(rows);
    let more = look.pick("…", "...");
    if let Some(last) = lines.last_mut() {
        let room = width.saturating_sub(more.chars().count());
        *last = last.chars().take(room).collect::<String>().trim_end().to_owned() + more;
    }
    lines
}

/// The words of `text` in lines of at most `width` characters; a longer word begins a line and is broken.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let line = &mut lines[last];
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() <= width {
            line.push(' ');
            line.push_str(word);
            continue;
        }
        let letters: Vec<char> = word.chars().collect();
        let mut pieces = letters.chunks(width.max(1)).map(String::from_iter);
        if line.is_empty() {
            line.extend(pieces.next());
        }
        lines.extend(pieces);
    }
    lines
}

/// Draws the keys that may be used now, as many as fit.
pub fn draw_hints(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let mut hints: Vec<(&Binding, Line)> = bindings(app.place())
        .filter(|binding| app.refusal(binding.when).is_none())
        .filter_map(|binding| Some((binding, hint(app, binding)?)))
        .collect();
    let room = usize::from(area.width.saturating_sub(1));
    let width = |hints: &[(&Binding, Line)]| hints.iter().map(|(_, line)| line.width() + GAP).sum::<usize>();
    // The keys of the program itself stay to the last, but for the command palette's and the way from the coach to another
    // screen; the others go from the end.
    let is_finder = |binding: &Binding| matches!(binding.keys, [(_, Action::Finder(FinderAction::Open)), ..]);
    let stays = |binding: &Binding| {
        binding.section == Section::Program && !matches!(binding.when, When::Coach(_)) && !is_finder(binding)
    };
    while width(&hints) > room + GAP {
        let last = hints.iter().rposition(|(binding, _)| !stays(binding));
        hints.remove(last.unwrap_or(hints.len() - 1));
    }
    let mut x = area.x + 1;
    buffer.set_style(area, theme.text());
    for (_, line) in hints {
        x = buffer.set_line(x, area.y, &line, area.right().saturating_sub(x)).0 + GAP as u16;
    }
}

fn hint(app: &App, binding: &Binding) -> Option<Line<'static>> {
    let (words, keys) = binding.hint?;
    let keys = keys_text(binding.keys.iter().take(keys).filter_map(|(chord, _)| working(app, *chord)), app.look());
    if keys.is_empty() {
        return None;
    }
    Some(Line::from(vec![
        Span::styled(keys, app.theme().accent()),
        Span::styled(format!(" {words}"), app.theme().faint()),
    ]))
}

/// A key that does the work of `chord` here: where letters are typed, none of the user's own; where a key is asked for,
/// which has no other meaning there, `chord` itself.
fn working(app: &App, chord: Chord) -> Option<Chord> {
    let place = app.place();
    if place == Place::Settings(SettingsPlace::Pressing) {
        return Some(chord);
    }
    app.keys().for_work_of(chord).find(|pressed| !place.types(*pressed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::look::{Depth, Glyphs};

    #[test]
    fn long_sentences_are_broken_between_words() {
        assert_eq!(wrap("", 5), [""]);
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("unbreakable a b", 4), ["unbr", "eaka", "ble", "a b"]);
    }

    #[test]
    fn what_is_cut_says_so() {
        let unicode = Look { depth: Depth::Mono, glyphs: Glyphs::Letters, unicode: true };
        let lines = wrap("one two three four", 7);
        assert_eq!(cut(lines.clone(), 2, 7, unicode), ["one two", "three\u{2026}"]);
        assert_eq!(cut(lines.clone(), 1, 7, Look { unicode: false, ..unicode }), ["one..."]);
        assert_eq!(cut(lines.clone(), 3, 7, unicode), lines);
    }
}
