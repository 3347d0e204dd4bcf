//! The panel of the marked test: the table with the balls, the paths and the positions to mark, and the instructions.

use glam::DVec2;
use ratatui::{
    layout::{Margin, Rect},
    style::Modifier,
};

use crate::{
    calibration::{
        Mark,
        Quantity::{RailAcross, RailAlong},
        RAILS, Sketch, Test, Unit,
    },
    coach::words::TipUnit,
    table::{BALLS, Table},
    terminal::{
        Glyphs, Mapping,
        pages::calibration::{CalibrationPage, Question, form::Form, view::values::sentences},
        ui::{
            Spot, TableView, Ui, columns, cue_sign, draw_table, draw_tip, draw_title, shorten, wrap, write_paragraphs,
        },
        words::{across_word, height_word, speed_words},
    },
};

/// Width of the tip next to the table; rows of its title and of the largest face that leaves a column free at the page's edge; and the
/// panel width from which on the tip fits there.
const TIP: u16 = 14;
const TIP_ROWS: u16 = 7;
const BESIDE: u16 = 46;
/// Rows of the text below the tip.
const WORDS: u16 = 3;
/// Width of a mark's sign, letter and name with a blank after it; then the minimum and maximum width of the typed value; columns.
const NAME: u16 = 11;
const TYPED: [usize; 2] = [3, 18];
/// The letters of the marks. Numbers are used for the diamonds.
const LETTERS: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];
/// Minimum rows of the panel "What the marks say".
const MIN_RESULT_ROWS: u16 = 3;
/// Columns between two dots of a path.
const DOT_COLUMNS: f64 = 2.0;
/// Length of the drawn cue and distance between its dots, m.
const CUE: f64 = 0.3;
const CUE_DOTS: f64 = 0.01;

/// Draws the panel. Returns whether it had room for what the marks say.
pub fn draw(page: &CalibrationPage, area: Rect, ui: &mut Ui) -> bool {
    let test = page.sheet().test();
    let room = usize::from(area.width.saturating_sub(4));
    let inner = draw_title(shorten(test.title, room, ui.caps), area, ui);
    let width = inner.width.saturating_sub(2);
    let words = [("put", test.placement), ("strike", test.strike)].map(|(what, words)| format!("{what}: {words}"));
    let lines: usize = words.iter().map(|words| wrap(words, usize::from(width)).len()).sum();
    let asked: Vec<&str> = test.field_names().collect();
    let rows = (lines + asked.len()) as u16;
    let picture = Rect { height: inner.height.saturating_sub(rows), ..inner };
    let has_tip = inner.width >= BESIDE && picture.height > WORDS + 3;
    let table = Rect { width: picture.width.saturating_sub(if has_tip { TIP } else { 0 }), ..picture };
    let sketch = Sketch::of(&page.table, test);
    draw_picture(&page.table, test, &sketch, table, ui);
    let bottom = Mapping::fit(&page.table, table).outer().bottom();
    if has_tip {
        let left = Rect { x: table.right(), width: TIP, height: bottom - picture.y, ..picture };
        draw_stroke(page, &sketch, left, ui);
    }
    let style = ui.theme.text();
    let text = Rect { y: bottom, height: inner.bottom() - bottom, ..inner }.inner(Margin::new(1, 0));
    let [place, strike] = words;
    let below = write_paragraphs(&[(place, style), (strike, style)], text, ui);
    let typed: Vec<String> = (0..asked.len()).map(|n| typed(page, test, n, asked[n], ui)).collect();
    let longest = typed.iter().map(|typed| columns(typed) + 1).max().unwrap_or(0);
    let room = longest.clamp(TYPED[0], TYPED[1]) as u16;
    for (((n, name), typed), y) in asked.iter().enumerate().zip(typed).zip(below..text.bottom()) {
        draw_mark(page, test, (n, name), (&typed, room), Rect { y, height: 1, ..text }, ui);
    }
    // If there is room, the results are shown here too.
    let end = (below + asked.len() as u16 + 1).min(inner.bottom());
    let rest = Rect { y: end, height: inner.bottom() - end, ..inner };
    let found = page.sheet().calibration().filter(|_| rest.height > MIN_RESULT_ROWS);
    if let Some(found) = found {
        let rest = draw_title("What the marks say", rest, ui);
        write_paragraphs(&sentences(page, found, ui), rest.inner(Margin::new(1, 0)), ui);
    }
    found.is_some()
}

/// Draws the tip and, below it, the stroke in numbers.
fn draw_stroke(page: &CalibrationPage, sketch: &Sketch, area: Rect, ui: &mut Ui) {
    let (table, unit, cue) = (&page.table, page.units.tip, &sketch.cue);
    let height = area.height.saturating_sub(WORDS).min(TIP_ROWS);
    draw_tip(Some(cue), unit == TipUnit::Tips, table, Rect { height, ..area }, ui);
    let offset = |radii: f64, word: &str| Some(format!("{} {word}", unit.words(radii, table.radius)?));
    let parts = [offset(cue.a, across_word(cue.a)), offset(cue.b, height_word(cue.b))];
    let mut words: Vec<String> = parts.into_iter().flatten().collect();
    if words.is_empty() {
        words.push("centre ball".to_owned());
    }
    words.push(format!("at {}", speed_words(cue.speed, page.units.length, 1)));
    for (text, y) in words.iter().zip(area.y + height..area.bottom()) {
        // The longest text begins at the table, and the last column of the page stays free.
        let x = (area.right() - 1).saturating_sub(columns(text) as u16).clamp(area.x, area.x + 1);
        ui.buffer.set_stringn(x, y, text, usize::from(area.width - 1), ui.theme.faint());
    }
}

/// Draws the table with the balls, their paths, and the letters of the marks at the expected positions.
fn draw_picture(table: &Table, test: &Test, sketch: &Sketch, area: Rect, ui: &mut Ui) {
    let mapping = Mapping::fit(table, area);
    if mapping.bed.is_empty() {
        return;
    }
    let dot = ui.caps.pick('·', '.');
    let stride = (DOT_COLUMNS / (mapping.scale().x * Sketch::SPACING)).round().max(1.0) as usize;
    let mut spots = Vec::new();
    // The paths of the object balls are drawn over that of the cue ball.
    for ball in 0..BALLS {
        let color = ui.theme.paths[ball];
        let dots = sketch.paths[ball].iter().step_by(stride);
        spots.extend(dots.map(|place| Spot { position: *place, is_ball: false, color, letter: dot }));
    }
    let ahead = DVec2::from_angle(sketch.cue.phi);
    let sign = cue_sign(ahead, ui.caps);
    let behind = (0..=(CUE / CUE_DOTS) as u32).map(|n| 1.5 * table.radius + f64::from(n) * CUE_DOTS);
    let cue = behind.map(|back| sketch.layout.balls[0] - ahead * back).filter(|place| mapping.is_on_bed(*place));
    spots.extend(cue.map(|place| Spot { position: place, is_ball: false, color: ui.theme.cue, letter: sign }));
    let marks = sketch.mark_positions.iter().flatten();
    spots.extend(marks.map(|place| Spot { position: *place, is_ball: true, color: ui.theme.mark, letter: 'o' }));
    let view = TableView { spots: &spots, is_numbered: false, ..TableView::new(table, &sketch.layout) };
    draw_table(&view, area, ui);
    number_rails(table, &mapping, ui);
    letter_marks(test, sketch, &mapping, ui);
}

/// Writes the numbers of the diamonds: along the table on the bottom rail, across it on the left rail.
fn number_rails(table: &Table, mapping: &Mapping, ui: &mut Ui) {
    let bed = mapping.bed;
    let diamond = table.diamond() * mapping.scale();
    let is_wood = ui.caps.glyphs != Glyphs::Letters;
    let behind = if is_wood { ui.theme.wood } else { ui.theme.background };
    let style = ui.theme.text().fg(ui.theme.sight).bg(behind);
    let column = |n: u16| (f64::from(n) * diamond.x) as u16;
    for n in 0..=8_u16 {
        // Rounded from both ends inwards, like the diamonds themselves.
        let x = if n <= 4 { bed.x + column(n) } else { bed.right().saturating_sub(1 + column(8 - n)) };
        ui.buffer.set_string(x, bed.bottom(), n.to_string(), style);
    }
    for n in 1..4_u16 {
        let y = (bed.y + (f64::from(4 - n) * diamond.y) as u16).min(bed.bottom() - 1);
        ui.buffer.set_string(bed.x - 1, y, n.to_string(), style);
    }
}

/// Writes the letters of the marks next to their expected positions: on the rail, or to the right of a ball that has stopped.
fn letter_marks(test: &Test, sketch: &Sketch, mapping: &Mapping, ui: &mut Ui) {
    let bed = mapping.bed;
    let half = 0.5 * f64::from(bed.height);
    let style = ui.theme.accent().add_modifier(Modifier::REVERSED);
    let mut taken: Vec<DVec2> = Vec::new();
    for (n, place) in sketch.mark_positions.iter().enumerate() {
        let Some(place) = *place else { continue };
        // Two marks at the same position have their letters side by side.
        let beside = taken.iter().filter(|other| **other == place).count() as u16;
        taken.push(place);
        let (x, y) = mapping.to_cell(place);
        let at = mapping.to_cells(place);
        let (x, y) = match test.marks[n].quantity {
            RailAlong(..) if at.y < half => (x, bed.y - 1),
            RailAlong(..) => (x, bed.bottom()),
            RailAcross(..) if at.x < half * 2.0 => (bed.x - 1, y),
            RailAcross(..) => (bed.right(), y),
            _ => (x + 2 + beside, y),
        };
        ui.buffer.set_stringn(x.min(bed.right() + 1), y, letter(n), 1, style);
    }
}

/// The letter of the mark with this index.
const fn letter(n: usize) -> &'static str {
    LETTERS[n % LETTERS.len()]
}

/// The open form, if there is one.
const fn form(page: &CalibrationPage) -> Option<&Form> {
    if let Some(Question::Marks(form)) = &page.question { Some(form) } else { None }
}

/// The typed or entered value of the mark with this index and name, with its unit.
fn typed(page: &CalibrationPage, test: &Test, n: usize, name: &str, ui: &Ui) -> String {
    let typed = match form(page) {
        Some(form) => form.fields[n].1.text().to_owned(),
        None => page.sheet().marked_stroke().map_or_else(String::new, |(_, entry)| entry.field_text(name)),
    };
    let mark = test.marks.iter().find(|mark| mark.name == name);
    let is_bare = mark.map(Mark::unit) == Some(Unit::Seconds) && !typed.ends_with('s');
    match typed {
        typed if typed.is_empty() => "-".to_owned(),
        typed => (if is_bare { typed + " s" } else { typed }).replace('±', ui.caps.pick("±", "~")),
    }
}

/// Draws a mark: its letter and name, its value in `room` columns, and its description.
fn draw_mark(
    page: &CalibrationPage,
    test: &Test,
    (n, name): (usize, &str),
    (typed, room): (&str, u16),
    area: Rect,
    ui: &mut Ui,
) {
    let is_typed = form(page).is_some_and(|form| form.field == n);
    let style = if is_typed { ui.theme.accent() } else { ui.theme.text() };
    let sign = if is_typed { ui.caps.pick("▸", ">") } else { " " };
    ui.buffer.set_stringn(area.x, area.y, format!("{sign}{} {name}", letter(n)), usize::from(NAME), style);
    let value = if form(page).is_some() { ui.theme.text() } else { ui.theme.faint() };
    ui.buffer.set_string(area.x + NAME, area.y, shorten(typed, usize::from(room - 1), ui.caps), value);
    let usual = test.rails.map_or_else(String::new, |rails| format!(", if not {rails}"));
    let mark = test.marks.iter().find(|mark| mark.name == name);
    let words = match mark {
        // The value shows its unit already.
        Some(mark) if typed.ends_with(" s") => mark.words.replacen("seconds ", "", 1),
        Some(mark) => mark.words.to_owned(),
        None if name == RAILS => format!("how many short rails it has met{usual}"),
        None => String::new(),
    };
    let x = NAME + room;
    let words = brief(words, usize::from(area.width.saturating_sub(x)), ui);
    ui.buffer.set_string(area.x + x, area.y, words, ui.theme.faint());
}

/// Shortens the description of a mark step by step until it fits into `room` columns. That is acceptable because its name stands before
/// it and the question for the mark shows the full text.
fn brief(words: String, room: usize, ui: &Ui) -> String {
    let ever_shorter = [
        ("where it ", ""),
        ("how many ", ""),
        (" it has met", " met"),
        ("seconds ", "s "),
        (" the stroke", " stroke"),
        (" the ball ", " it "),
        (" until it stops", " to its stop"),
        (" after that", ""),
        (" your own ", " own "),
    ];
    let mut text = words;
    for (long, short) in ever_shorter {
        if columns(&text) > room {
            text = text.replacen(long, short, 1);
        }
    }
    if columns(&text) > room
        && let Some((main, _)) = text.split_once([',', '('])
    {
        text = main.trim_end().to_owned();
    }
    shorten(&text, room, ui.caps)
}
