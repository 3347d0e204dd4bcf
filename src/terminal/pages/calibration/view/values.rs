//! All that was found: the table's values, which marks look misread, and what to play next.

use ratatui::{
    layout::{Position, Rect},
    style::Style,
};

use crate::{
    calibration::{Calibration, Change, Test},
    terminal::{
        CalibrationAction,
        pages::calibration::{CalibrationPage, keys::TESTS},
        ui::{Ui, columns, draw_title, shorten, wrap, write_right},
    },
};

/// Columns at which the values and the word for how well they are known end, and where the words for a constant begin.
const VALUE_END: u16 = 36;
const KNOWN_END: u16 = 46;
const WORDS: u16 = 48;
/// Columns that the words need, but for those of a single rail.
const WORDS_ROOM: usize = 30;
/// Where the value and the word for it end if the words have no room: what the constant is called then stands before them.
const NARROW_VALUE_END: u16 = 37;
const NARROW_KNOWN_END: u16 = 47;

/// A row of the part.
enum Row<'a> {
    Constant(&'a Change, &'static str),
    Text(String, Style),
}

/// Draws it, a page at a time where it is longer than its room.
pub fn draw(page: &CalibrationPage, area: Rect, ui: &mut Ui) {
    let found = page.sheet().found();
    let width = usize::from(area.width.saturating_sub(2));
    let said = said(page, found, ui)
        .into_iter()
        .flat_map(|(words, style)| wrap(&words, width).into_iter().map(move |line| Row::Text(line, style)));
    let constants =
        found.into_iter().flat_map(|found| found.constants.iter().map(|one| Row::Constant(one, found.certainty(one))));
    // What makes all values unsure stands before them.
    let rows: Vec<Row> = if found.is_some_and(Calibration::is_contradictory) {
        said.chain(constants).collect()
    } else {
        constants.chain(said).collect()
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

/// What is odd about the entries, then what the marks say.
fn said(page: &CalibrationPage, found: Option<&Calibration>, ui: &Ui) -> Vec<(String, Style)> {
    let sheet = page.sheet();
    let mut said: Vec<(String, Style)> = Vec::new();
    said.extend(sheet.odd(&page.table).iter().map(|odd| (format!("{odd}; it is left out"), ui.theme.warning())));
    match found {
        Some(found) => said.extend(sentences(page, found, ui)),
        None => said.push((
            "Nothing is entered yet. Play the tests in any order, as many as you like: after each stroke its values stand here, \
             with how sure they are."
                .to_owned(),
            ui.theme.faint(),
        )),
    }
    said
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
        draw_called(one, room, style, Position::new(area.x + 1, area.y), ui);
    }
    write_right(ui.buffer, area.x, area.x + value_end, area.y, &value, style);
    write_right(ui.buffer, area.x, area.x + known_end, area.y, known, style);
}

/// Writes what a constant is called in so many columns: the short words for it, and behind them its name where that has room.
pub fn draw_called(one: &Change, room: usize, style: Style, at: Position, ui: &mut Ui) {
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

/// What is said of the marks.
pub fn sentences(page: &CalibrationPage, found: &Calibration, ui: &Ui) -> Vec<(String, Style)> {
    let mut said: Vec<(String, Style)> = Vec::new();
    let stroke = |trial: usize, test: &str| {
        let strokes = Test::named(test).map_or_else(Vec::new, |test| page.sheet().strokes(test));
        let number = strokes.iter().position(|(place, _)| place + 1 == trial).map_or(trial, |place| place + 1);
        format!("stroke {number} of {test}")
    };
    let misread = found.mark_checks.iter().filter(|verdict| verdict.misread);
    said.extend(misread.map(|one| (one.misread_text(&stroke(one.trial, one.test)), ui.theme.warning())));
    let strange = found.outlier_strokes.iter();
    said.extend(strange.map(|one| (one.words(&stroke(one.trial, one.test)), ui.theme.warning())));
    said.extend(found.differing_rails().into_iter().map(|sentence| (sentence, ui.theme.accent())));
    let agreement = if found.is_contradictory() {
        ui.theme.warning()
    } else if found.misread().is_empty() {
        ui.theme.good()
    } else {
        ui.theme.text()
    };
    said.push((found.agreement(stroke), agreement));
    said.extend(found.meanings().into_iter().map(|sentence| (sentence, ui.theme.text())));
    if let Some([before, now]) = page.sheet().judged.as_ref().and_then(|judged| judged.play) {
        said.push((format!("today {}", now.describe_change_from(&before)), ui.theme.accent()));
    }
    if let Some(best) = page.sheet().best() {
        let words = format!("next: {} helps most, with {:.1} bits; each bit halves one doubt", best.test, best.bits);
        said.push((words, ui.theme.text()));
    }
    if !ui.caps.unicode {
        for (text, _) in &mut said {
            *text = text.replace('±', "+-");
        }
    }
    said
}
