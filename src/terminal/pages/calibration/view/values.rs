//! All that was found: the table's values, which marks look misread, and what to play next.

use ratatui::{
    layout::{Margin, Rect},
    style::Style,
};

use crate::{
    calibration::{Calibration, Change},
    terminal::{
        pages::calibration::CalibrationPage,
        ui::{Ui, draw_title, write_paragraphs, write_right},
    },
};

/// Columns at which the values and the word for how well they are known end, and where the words for a constant begin.
const VALUE_END: u16 = 36;
const KNOWN_END: u16 = 46;
const WORDS: u16 = 48;

/// Draws it.
pub fn draw(page: &CalibrationPage, area: Rect, ui: &mut Ui) {
    let sheet = page.sheet();
    let inner = draw_title("The table's values", area, ui);
    let found = sheet.judged.as_ref().and_then(|judged| judged.found.as_ref());
    let constants = found.map_or(&[][..], |found| &found.constants);
    for (one, y) in constants.iter().zip(inner.y..inner.bottom()) {
        draw_constant(one, Rect { y, height: 1, ..inner }, ui);
    }
    let rows = (constants.len() as u16).min(inner.height);
    let below = Rect { y: inner.y + rows, height: inner.height - rows, ..inner };
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
    write_paragraphs(&said, below.inner(Margin::new(1, 0)), ui);
}

fn draw_constant(one: &Change, area: Rect, ui: &mut Ui) {
    let known = one.known();
    let style = match known {
        "well" => ui.theme.good(),
        "better" => ui.theme.text(),
        _ => ui.theme.faint(),
    };
    ui.buffer.set_string(area.x + 1, area.y, &one.name, style);
    let value = format!("{:.5} {} {:.5}", one.after, ui.caps.pick("±", "+-"), one.after_deviation);
    write_right(ui.buffer, area.x, area.x + VALUE_END, area.y, &value, style);
    write_right(ui.buffer, area.x, area.x + KNOWN_END, area.y, known, style);
    let room = usize::from(area.width.saturating_sub(WORDS));
    let words = if ui.caps.unicode { one.words() } else { one.words().replace('²', "2") };
    if room >= words.len() {
        ui.buffer.set_string(area.x + WORDS, area.y, words, ui.theme.faint());
    }
}

/// What is said of the marks.
pub fn sentences(page: &CalibrationPage, found: &Calibration, ui: &Ui) -> Vec<(String, Style)> {
    let mut said: Vec<(String, Style)> = Vec::new();
    let misread = found.verdicts.iter().filter(|verdict| verdict.misread);
    said.extend(misread.map(|verdict| (verdict.doubtful(), ui.theme.warning())));
    said.extend(found.strange.iter().map(|strange| (strange.words(), ui.theme.warning())));
    said.extend(found.rails_apart().into_iter().map(|sentence| (sentence, ui.theme.accent())));
    let agreement = if found.misread().is_empty() { ui.theme.good() } else { ui.theme.text() };
    said.push((found.agreement().to_owned(), agreement));
    if let Some([before, now]) = page.sheet().judged.as_ref().and_then(|judged| judged.play) {
        said.push((format!("today {}", now.against(&before)), ui.theme.accent()));
    }
    if let Some(best) = page.sheet().best() {
        let words = format!("one more stroke of {} would tell most: {:.1} bits", best.test, best.bits);
        said.push((words, ui.theme.text()));
    }
    if !ui.caps.unicode {
        for (text, _) in &mut said {
            *text = text.replace('±', "+-");
        }
    }
    said
}
