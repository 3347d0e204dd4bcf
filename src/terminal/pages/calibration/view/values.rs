//! The panel with all results: the table's values, the marks that look misread, and the best next test.

use ratatui::{
    layout::{Position, Rect},
    style::Style,
};

use crate::{
    calibration::{Calibration, Change},
    terminal::{
        CalibrationAction,
        pages::calibration::{CalibrationPage, keys::TESTS},
        ui::{Ui, columns, draw_title, shorten, wrap, write_right},
    },
};

/// Right ends of the values and of the word for their accuracy, and the first column of a constant's description.
const VALUE_END: u16 = 36;
const KNOWN_END: u16 = 46;
const WORDS: u16 = 48;
/// Width that the descriptions need, columns, except those of a single rail.
const WORDS_ROOM: usize = 30;
/// Right ends of the value and of the word for its accuracy if the description has no room. The constant's name is then before them.
const NARROW_VALUE_END: u16 = 37;
const NARROW_KNOWN_END: u16 = 47;

/// A row of the panel.
enum Row<'a> {
    Constant(&'a Change, &'static str),
    Text(String, Style),
}

/// Draws the panel, one page at a time if it does not fit.
pub fn draw(page: &CalibrationPage, area: Rect, ui: &mut Ui) {
    let found = page.sheet().calibration();
    let width = usize::from(area.width.saturating_sub(2));
    let lines = result_sentences(page, found, ui)
        .into_iter()
        .flat_map(|(words, style)| wrap(&words, width).into_iter().map(move |line| Row::Text(line, style)));
    let constants =
        found.into_iter().flat_map(|found| found.constants.iter().map(|one| Row::Constant(one, found.certainty(one))));
    // If the strokes contradict each other, the warnings come before the values.
    let rows: Vec<Row> = if found.is_some_and(Calibration::is_contradictory) {
        lines.chain(constants).collect()
    } else {
        constants.chain(lines).collect()
    };
    let height = usize::from(area.height.saturating_sub(1)).max(1);
    let pages = rows.len().div_ceil(height).max(1);
    let number = page.values_page.rem_euclid(pages.cast_signed()).cast_unsigned();
    let key = ui.key_of(TESTS, &CalibrationAction::Page(1));
    let paged = if pages > 1 { format!(", {} of {pages}: {key}", number + 1) } else { String::new() };
    let inner = draw_title(format!("The table's values{paged}"), area, ui);
    for (row, y) in rows.chunks(height).nth(number).unwrap_or_default().iter().zip(inner.y..inner.bottom()) {
        match row {
            Row::Constant(one, known) => draw_constant(one, known, Rect { y, height: 1, ..inner }, ui),
            Row::Text(line, style) => ui.buffer.set_string(inner.x + 1, y, line, *style),
        }
    }
}

/// The implausible values among the entries, then the results.
fn result_sentences(page: &CalibrationPage, found: Option<&Calibration>, ui: &Ui) -> Vec<(String, Style)> {
    let sheet = page.sheet();
    let mut lines: Vec<(String, Style)> = Vec::new();
    lines.extend(
        sheet.implausible_entries(&page.table).iter().map(|odd| (format!("{odd}; it is left out"), ui.theme.warning())),
    );
    match found {
        Some(found) => lines.extend(sentences(page, found, ui)),
        None => lines.push((
            "Nothing is entered yet. Play the tests in any order, as many as you like: after each stroke its values stand here, \
             with how sure they are."
                .to_owned(),
            ui.theme.faint(),
        )),
    }
    lines
}

fn draw_constant(one: &Change, known: &str, area: Rect, ui: &mut Ui) {
    let style = match known {
        "well" => ui.theme.good(),
        "better" => ui.theme.text(),
        _ => ui.theme.faint(),
    };
    let value = one.after_text().join(ui.caps.pick(" ± ", " +- "));
    let room = usize::from(area.width.saturating_sub(WORDS));
    let has_words = room >= WORDS_ROOM;
    let (value_end, known_end) = if has_words { (VALUE_END, KNOWN_END) } else { (NARROW_VALUE_END, NARROW_KNOWN_END) };
    if has_words {
        ui.buffer.set_string(area.x + 1, area.y, &one.name, style);
        let words = if ui.caps.unicode { one.words() } else { one.words().replace('²', "2") };
        let words = if columns(&words) <= room { words } else { one.short_name() };
        ui.buffer.set_string(area.x + WORDS, area.y, words, ui.theme.faint());
    } else {
        let room = usize::from(value_end).saturating_sub(2 + columns(&value));
        draw_constant_name(one, room, style, Position::new(area.x + 1, area.y), ui);
    }
    write_right(ui.buffer, area.x, area.x + value_end, area.y, &value, style);
    write_right(ui.buffer, area.x, area.x + known_end, area.y, known, style);
}

/// Writes the short description of a constant in `room` columns, followed by its name if that fits.
pub fn draw_constant_name(one: &Change, room: usize, style: Style, at: Position, ui: &mut Ui) {
    let words = one.short_name();
    if words.is_empty() {
        ui.buffer.set_string(at.x, at.y, shorten(&one.name, room, ui.caps), style);
        return;
    }
    let (end, _) = ui.buffer.set_stringn(at.x, at.y, &words, room, style);
    if words.len() + 1 + one.name.len() <= room {
        ui.buffer.set_string(end + 1, at.y, &one.name, ui.theme.faint());
    }
}

/// The sentences on the results.
pub fn sentences(page: &CalibrationPage, found: &Calibration, ui: &Ui) -> Vec<(String, Style)> {
    let mut lines: Vec<(String, Style)> = Vec::new();
    let stroke = |trial: usize, test: &str| page.sheet().stroke_name(trial, test);
    let misread = found.mark_checks.iter().filter(|verdict| verdict.misread);
    lines.extend(misread.map(|one| (one.misread_text(&stroke(one.trial, one.test)), ui.theme.warning())));
    let outlier_strokes = found.outlier_strokes.iter();
    lines.extend(outlier_strokes.map(|one| (one.words(&stroke(one.trial, one.test)), ui.theme.warning())));
    lines.extend(found.differing_rails().into_iter().map(|sentence| (sentence, ui.theme.accent())));
    let agreement = if found.is_contradictory() {
        ui.theme.warning()
    } else if found.misread().is_empty() {
        ui.theme.good()
    } else {
        ui.theme.text()
    };
    lines.push((found.agreement(stroke), agreement));
    lines.extend(found.meanings().into_iter().map(|sentence| (sentence, ui.theme.text())));
    if let Some([before, now]) = page.sheet().judged.as_ref().and_then(|judged| judged.play) {
        lines.push((format!("today {}", now.describe_change_from(&before)), ui.theme.accent()));
    }
    if let Some(best) = page.sheet().best_next_test() {
        let words = format!("next: {} helps most, with {:.1} bits; each bit halves one doubt", best.test, best.bits);
        lines.push((words, ui.theme.text()));
    }
    if !ui.caps.unicode {
        for (text, _) in &mut lines {
            *text = text.replace('±', "+-");
        }
    }
    lines
}
