//! The last row of the screen: hints for the enabled keys.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::terminal::{
    Action, App, Condition, KeyContext, SettingsContext,
    app::bindings::{AppBinding, bindings},
    keymap::{Chord, Section, keys_text},
    ui::{Theme, Ui},
};

/// Columns between two hints, and the smaller gap used if it makes all of them fit.
const GAP: usize = 3;
const CLOSE: usize = 2;

/// Draws hints for the enabled keys, as many as fit.
pub fn draw_hints(app: &App, area: Rect, ui: &mut Ui) {
    let all = bindings(app.key_context());
    let mut hints: Vec<(&AppBinding, Line)> = all
        .iter()
        .filter(|binding| app.disabled_reason(binding.when).is_none())
        .filter_map(|binding| Some((binding, hint(app, binding, ui.theme)?)))
        .collect();
    // One blank at either end.
    let room = usize::from(area.width.saturating_sub(2));
    let width = |hints: &[(&AppBinding, Line)], gap: usize| {
        hints.iter().map(|(_, line)| line.width() + gap).sum::<usize>().saturating_sub(gap)
    };
    let mut gap = GAP;
    // If there is no room for all, hints are dropped from the end. Those of the program stay longest, except the command palette and the
    // coach's keys for other screens.
    let is_palette = |binding: &AppBinding| binding.keys[0].1 == Action::OpenPalette;
    let stays = |binding: &AppBinding| {
        binding.section == Section::Program && !matches!(binding.when, Condition::Coach(_)) && !is_palette(binding)
    };
    while width(&hints, gap) > room {
        if width(&hints, CLOSE) <= room {
            gap = CLOSE;
            break;
        }
        let last = hints.iter().rposition(|(binding, _)| !stays(binding));
        hints.remove(last.unwrap_or(hints.len() - 1));
    }
    let mut x = area.x + 1;
    ui.buffer.set_style(area, ui.theme.text());
    for (_, line) in hints {
        x = ui.buffer.set_line(x, area.y, &line, area.right().saturating_sub(x)).0 + gap as u16;
    }
}

fn hint(app: &App, binding: &AppBinding, theme: &Theme) -> Option<Line<'static>> {
    let (words, keys) = binding.hint?;
    let keys = keys_text(binding.keys.iter().take(keys).filter_map(|(chord, ..)| working(app, *chord)), app.caps);
    if keys.is_empty() {
        return None;
    }
    Some(Line::from(vec![Span::styled(keys, theme.accent()), Span::styled(format!(" {words}"), theme.faint())]))
}

/// The key to display for `chord` in this context. Where letters are typed, user-defined keys that would type a character are skipped.
/// Where a key or an answer is requested, user-defined keys do not apply and `chord` itself is returned.
fn working(app: &App, chord: Chord) -> Option<Chord> {
    let context = app.key_context();
    if matches!(context, KeyContext::Settings(SettingsContext::Pressing) | KeyContext::Question { is_typed: false }) {
        return Some(chord);
    }
    app.keys().keys_for(chord).find(|pressed| !context.types(*pressed))
}
