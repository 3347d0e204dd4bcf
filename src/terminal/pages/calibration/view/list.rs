//! The left column of the calibration page: the tests with their progress, the strokes of the marked test, and the values so far.

use ratatui::layout::{Position, Rect};

use crate::{
    calibration::{Calibration, Change, Entry, NO_BETTER, Test},
    terminal::{
        pages::calibration::{CalibrationPage, view::values::draw_constant_name},
        ui::{Ui, columns, draw_title, list, shorten, write_right},
    },
};

/// Right ends of a test's strokes and bits, from the right edge, columns.
const STROKES_END: u16 = 8;
const BITS_END: u16 = 1;
/// Minimum width of a constant's name, columns.
const NAME: usize = 12;

/// Draws the column.
pub fn draw(page: &CalibrationPage, area: Rect, ui: &mut Ui) {
    let below = draw_tests(page, area, ui);
    let below = draw_strokes(page, below, ui);
    draw_values(page, below, ui);
}

/// The part of `area` below its first `rows`.
fn rest(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}

fn draw_tests(page: &CalibrationPage, area: Rect, ui: &mut Ui) -> Rect {
    let sheet = page.sheet();
    let inner = draw_title("Tests", area, ui);
    for (end, label) in [(STROKES_END, " strokes "), (BITS_END, " bits ")] {
        write_right(ui.buffer, area.x, (area.right() + 1).saturating_sub(end), area.y, label, ui.theme.faint());
    }
    let best = sheet.best_next_test().map(|next| next.test);
    for ((n, test), y) in sheet.tests().enumerate().zip(inner.y..inner.bottom()) {
        let is_marked = n == sheet.mark;
        let (entered, times) = (sheet.strokes(test).len(), sheet.recommended_strokes(test));
        let is_out = sheet.is_left_out(test);
        let style = match () {
            () if is_marked => ui.theme.accent(),
            () if is_out || entered >= times => ui.theme.faint(),
            () => ui.theme.text(),
        };
        list::draw_mark(is_marked, area.x, y, ui);
        ui.buffer.set_stringn(area.x + 2, y, test.name, usize::from(area.width - 2), style);
        if has_implausible_entry(page, test) {
            ui.buffer.set_string(area.x + 14, y, "!", ui.theme.warning());
        }
        let strokes = if is_out { "out".to_owned() } else { format!("{entered}/{times}") };
        write_right(ui.buffer, area.x, area.right() - STROKES_END, y, &strokes, style);
        if let Some(bits) = sheet.expected_information(test) {
            let is_best = best == Some(test.name);
            let sign = if is_best { ui.caps.pick("◂", "<") } else { " " };
            let style = if is_best { ui.theme.good() } else { ui.theme.faint() };
            write_right(ui.buffer, area.x, area.right() - BITS_END + 1, y, &format!("{bits:.1}{sign}"), style);
        }
    }
    rest(area, 1 + sheet.tests().count() as u16)
}

/// Whether a stroke of a test is implausible or one of its marks looks misread.
fn has_implausible_entry(page: &CalibrationPage, test: &Test) -> bool {
    page.sheet().strokes(test).into_iter().any(|(place, entry)| is_doubtful(page, place, entry))
}

/// Whether the stroke with index `place` among all entries is implausible or one of its marks looks misread.
fn is_doubtful(page: &CalibrationPage, place: usize, entry: &Entry) -> bool {
    let is_strange = |found: &Calibration| {
        found.misread().contains(&(place + 1)) || found.outlier_strokes.iter().any(|one| one.trial == place + 1)
    };
    !entry.readings(&page.table).1.is_empty() || page.sheet().calibration().is_some_and(is_strange)
}

fn draw_strokes(page: &CalibrationPage, area: Rect, ui: &mut Ui) -> Rect {
    let sheet = page.sheet();
    let test = sheet.test();
    let strokes = sheet.strokes(test);
    let most = strokes.len().clamp(1, 4);
    let inner = draw_title(format!("Strokes of {}", test.name), area, ui);
    let inner = Rect { height: inner.height.min(most as u16), ..inner };
    if strokes.is_empty() {
        ui.buffer.set_stringn(inner.x + 2, inner.y, "none yet", usize::from(inner.width), ui.theme.faint());
    }
    for (n, y) in list::shown(sheet.stroke(), strokes.len(), inner) {
        let (place, entry) = strokes[n];
        let is_marked = n == sheet.stroke();
        let is_doubtful = is_doubtful(page, place, entry);
        let style = match () {
            () if is_doubtful => ui.theme.warning(),
            () if is_marked => ui.theme.accent(),
            () => ui.theme.text(),
        };
        list::draw_mark(is_marked, inner.x, y, ui);
        let marks = test.field_names().map(|name| entry.field_text(name));
        let marks: Vec<String> = marks.map(|mark| if mark.is_empty() { "-".to_owned() } else { mark }).collect();
        let sign = if is_doubtful { "! " } else { "" };
        let end = if entry.far_end { "far end: " } else { "" };
        let text = shorten(&format!("{sign}{end}{}", marks.join(", ")), usize::from(inner.width - 3), ui.caps);
        ui.buffer.set_string(inner.x + 2, y, text, style);
    }
    rest(area, 1 + most as u16)
}

/// Draws the values that have become most accurate, as many as fit.
fn draw_values(page: &CalibrationPage, area: Rect, ui: &mut Ui) {
    if area.height < 3 {
        return;
    }
    let found = page.sheet().calibration();
    let is_unsure = found.is_some_and(Calibration::is_contradictory);
    let inner = draw_title(if is_unsure { "Unsure: marks disagree" } else { "Best known so far" }, area, ui);
    let Some(found) = found else {
        ui.buffer.set_stringn(inner.x + 2, inner.y, "nothing yet", usize::from(inner.width), ui.theme.faint());
        return;
    };
    let left = |one: &Change| one.after_deviation / one.before_deviation;
    let mut constants: Vec<&Change> = found.constants.iter().collect();
    constants.sort_by(|one, other| left(one).total_cmp(&left(other)));
    for (one, y) in constants.into_iter().zip(inner.y..inner.bottom()) {
        // Both signs have the same width, so that a blank fits after the name.
        let sign = ui.caps.pick("± ", "+-");
        let value = format!("{:.4} {sign}{:.4}", one.after, one.after_deviation);
        let room = NAME.max(usize::from(inner.width).saturating_sub(columns(&value) + 4));
        let style = if found.certainty(one) == NO_BETTER { ui.theme.faint() } else { ui.theme.text() };
        draw_constant_name(one, room, style, Position::new(inner.x + 2, y), ui);
        write_right(ui.buffer, inner.x, inner.right() - 1, y, &value, style);
    }
}
