//! The last rows: what has just happened, and the keys that may be used now.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
    widgets::{Clear, Widget},
};

use crate::{
    table::BALLS,
    terminal::{
        app::App,
        chord::keys_text,
        keymap::{BINDINGS, Binding, Section},
        playback::passed,
        status::Tone,
        words::{BALL_NAMES, event_words, fixed, millimetres, step_words},
    },
};

/// Draws the status in the last row of `area`; a sentence that is longer takes the rows above it as well.
pub fn draw_status(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let (text, style) = match app.message() {
        Some(message) => {
            let style = match message.tone {
                Tone::Plain => theme.text(),
                Tone::Good => theme.good(),
                Tone::Warning => theme.warning(),
            };
            (message.text.clone(), style)
        }
        None => (standing(app), theme.text()),
    };
    let width = area.width.saturating_sub(2);
    let lines = wrap(&text, usize::from(width));
    let rows = (lines.len() as u16).min(area.height);
    let place = Rect::new(area.x, area.bottom() - rows, area.width, rows);
    Clear.render(place, buffer);
    buffer.set_style(place, theme.text());
    for (line, row) in lines.iter().zip(place.y..place.bottom()) {
        buffer.set_stringn(place.x + 1, row, line, usize::from(width), style);
    }
}

/// The words of `text` in lines of at most `width` characters; a longer word has a line to itself.
fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let line = &mut lines[last];
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= width {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// What the status line says while there is no news.
fn standing(app: &App) -> String {
    if let Some(picture) = app.spinner() {
        let pictures =
            app.look().pick(["⠋", "⠙", "⠹", "⠸", "⠼", "⠴", "⠦", "⠧"], ["|", "/", "-", "\\", "|", "/", "-", "\\"]);
        return format!("{} the coach is thinking; Esc stops it", pictures[picture % pictures.len()]);
    }
    match app.watched() {
        Some(shot) => {
            let (events, time) = (shot.recording.events(), app.playback().readout);
            events.get(passed(events, time)).map_or("all balls lie still".to_owned(), |next| {
                format!("next: {} in {} s", event_words(next.kind), fixed(next.time - time, 1))
            })
        }
        None => selected_ball(app),
    }
}

/// Where the selected ball lies, how far the nearest other one is, and how far a key moves it.
fn selected_ball(app: &App) -> String {
    let (ball, balls) = (app.selected(), app.layout().balls);
    let others = (0..BALLS).filter(|&other| other != ball);
    let gap = |other: usize| (balls[ball].distance(balls[other]) - 2.0 * app.table().radius).max(0.0);
    let nearest = others.min_by(|&one, &two| gap(one).total_cmp(&gap(two)));
    let near =
        nearest.map_or(String::new(), |other| format!(", {} mm from {}", millimetres(gap(other)), BALL_NAMES[other]));
    let (x, y) = (millimetres(balls[ball].x), millimetres(balls[ball].y));
    format!("{} at x {x} mm, y {y} mm{near}; step {}", BALL_NAMES[ball], step_words(app.step_mm()))
}

/// Draws the keys that may be used now, as many as fit.
pub fn draw_hints(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let mut hints: Vec<(Section, Line)> = BINDINGS
        .iter()
        .filter(|binding| app.refusal(binding.when).is_none())
        .filter_map(|binding| Some((binding.section, hint(app, binding)?)))
        .collect();
    let room = usize::from(area.width.saturating_sub(1));
    // The keys of the program itself stay to the last; the others go from the end.
    while hints.iter().map(|(_, line)| line.width()).sum::<usize>() > room {
        let last = hints.iter().rposition(|(section, _)| *section != Section::Program);
        hints.remove(last.unwrap_or(hints.len() - 1));
    }
    let mut x = area.x + 1;
    buffer.set_style(area, theme.text());
    for (_, line) in hints {
        x = buffer.set_line(x, area.y, &line, area.right().saturating_sub(x)).0;
    }
}

fn hint(app: &App, binding: &Binding) -> Option<Line<'static>> {
    let (words, keys) = binding.hint?;
    let keys = keys_text(binding.keys.iter().take(keys).map(|(chord, _)| *chord), app.look());
    Some(Line::from(vec![
        Span::styled(keys, app.theme().accent()),
        Span::styled(format!(" {words}   "), app.theme().faint()),
    ]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_sentences_are_broken_between_words() {
        assert_eq!(wrap("", 5), [""]);
        assert_eq!(wrap("one two three", 7), ["one two", "three"]);
        assert_eq!(wrap("unbreakable a b", 3), ["unbreakable", "a b"]);
    }
}
