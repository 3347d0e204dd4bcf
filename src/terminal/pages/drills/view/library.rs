//! The screen with the list of exercises and a preview of the marked one with its lesson.

use ratatui::{
    layout::{Position, Rect},
    style::Style,
};

use crate::{
    drills::{Category, Exercise, Venue, bare_tag, estimate::MIN_ATTEMPTS},
    table::{CueBall, Table},
    terminal::{
        DrillAction, DrillContext,
        pages::{
            Target,
            drills::{
                DrillsPage,
                view::{READABLE, TABLE_ROWS, best_run, draw_header, draw_preview, percent_words, position_words},
            },
        },
        ui::{
            Message, Theme, Ui, below_title, columns, draw_title, list::Grouped, shorten, split, wrap,
            write_paragraphs, write_right,
        },
        words,
    },
};

/// Width of the list, percent of the screen: on narrow and on wide screens. The titles of the bundled exercises fit into
/// [`LIST_MIN`] columns, which the list keeps on screens in between.
const LIST: (u16, u16) = (58, 33);
const LIST_MIN: u16 = 58;
/// Right ends of the grade, of the points at a real table and of those in the program, from the list's right edge, columns. The points
/// are two numbers of up to three digits with a slash between them and a blank on either side.
const GRADE_END: u16 = 17;
const TABLE_END: u16 = 9;
const HERE_END: u16 = 1;

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    let sessions = drills.book.sessions.len();
    let more = match sessions {
        0 => String::new(),
        1 => "1 session so far".to_owned(),
        _ => format!("{sessions} sessions so far"),
    };
    draw_header(drills, "practice", &more, header, ui);
    let [list, preview] = halves(area);
    draw_list(drills, list, ui);
    match drills.catalogue.marked() {
        Some(exercise) => draw_exercise(drills, exercise, preview, ui),
        None => draw_placeholder(drills, list, ui),
    }
    status_line(drills, ui)
}

/// The areas of the list and of the marked exercise.
fn halves(area: Rect) -> [Rect; 2] {
    let share = |of| area.width * of / 100;
    split(share(LIST.0).min(LIST_MIN.max(share(LIST.1))), area)
}

/// The mouse target at `at`.
pub fn target(drills: &DrillsPage, area: Rect, at: Position) -> Option<Target> {
    let [list, _] = halves(area);
    let line = grouped(drills).entry_at(below_title(list), at.y);
    list.contains(at).then(|| Target::list(line, drills.catalogue.mark))
}

fn status_line(drills: &DrillsPage, ui: &Ui) -> Message {
    let book = &drills.book;
    if !book.is_known {
        return Message::plain("reading what was played so far");
    }
    if !book.troubles.is_empty() {
        return Message::warning("some saved data cannot be read: F6 lists it; the rest is here");
    }
    let notes = drills.notes_since_skill();
    // As many as an estimate needs.
    if notes >= MIN_ATTEMPTS {
        let [record, take] =
            [(DrillContext::Library, DrillAction::OpenRecord), (DrillContext::Record, DrillAction::SaveSkill)]
                .map(|(screen, action)| ui.key_of(screen.bindings(), &action));
        return Message::plain(format!(
            "{notes} notes are newer than your skill: {record}, then {take} takes the new estimate"
        ));
    }
    Message::plain("choose an exercise; Enter opens it")
}

/// The list, grouped by category.
fn grouped(drills: &DrillsPage) -> Grouped<&Exercise> {
    Grouped::new(drills.catalogue.filtered(), drills.catalogue.mark, |exercise| exercise.category.title())
}

fn draw_list(drills: &DrillsPage, area: Rect, ui: &mut Ui) {
    let count = drills.catalogue.filtered().len();
    let title = filter_words(drills, count);
    let inner = draw_title(title.as_str(), area, ui);
    if count == 0 {
        return;
    }
    let [table, here] = Venue::ALL.map(|venue| format!(" {} ", venue.word()));
    for (end, label) in [(GRADE_END, " grade "), (TABLE_END, &*table), (HERE_END, &*here)] {
        let end = (area.right() + 1).saturating_sub(end);
        if area.x + 2 + columns(&title) as u16 + 11 < end {
            write_right(ui.buffer, area.x, end, area.y, label, ui.theme.faint());
        }
    }
    grouped(drills).draw(inner, ui, |exercise, is_marked, area, ui| draw_row(drills, exercise, is_marked, area, ui));
}

/// The title of the list: number of exercises and active filters.
fn filter_words(drills: &DrillsPage, found: usize) -> String {
    let catalogue = &drills.catalogue;
    let filter = &catalogue.filter;
    let parts = [
        filter.category.map(|category| category.title().to_owned()),
        filter.grade.map(|grade| format!("grade {grade}")),
        filter.text.as_ref().map(|text| format!("\"{text}\"")),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    if parts.is_empty() { format!("All {found}") } else { format!("{found}: {}", parts.join(", ")) }
}

fn draw_row(drills: &DrillsPage, exercise: &Exercise, is_marked: bool, area: Rect, ui: &mut Ui) {
    let style = if is_marked { ui.theme.accent() } else { ui.theme.text() };
    let room = usize::from(area.width.saturating_sub(2 + GRADE_END));
    ui.buffer.set_string(area.x, area.y, shorten(&exercise.title, room, ui.caps), style);
    let grade = if exercise.grade == 0 { "-".to_owned() } else { exercise.grade.to_string() };
    write_right(ui.buffer, area.x, area.right() - GRADE_END, area.y, &grade, ui.theme.faint());
    for (venue, score) in drills.book.scores_of(&exercise.name) {
        let end = if *venue == Venue::Table { TABLE_END } else { HERE_END };
        let made = format!("{}/{}", in_three(score.made), in_three(score.tried));
        write_right(ui.buffer, area.x, area.right() - end, area.y, &made, style);
    }
}

/// Formats a number in at most three columns; from 1000 on in thousands. The preview shows the full number.
fn in_three(number: usize) -> String {
    if number < 1000 { number.to_string() } else { format!("{}k", number / 1000) }
}

fn draw_exercise(drills: &DrillsPage, exercise: &Exercise, area: Rect, ui: &mut Ui) {
    let room = usize::from(area.width.saturating_sub(4));
    let inner = draw_title(shorten(&exercise.title, room, ui.caps), area, ui);
    let Ok(table) = exercise.table() else { return };
    // The text gets the rows that it needs, and the table the rest.
    let mut paragraphs = description(drills, exercise, &table, ui.theme);
    let width = inner.width.saturating_sub(2).min(READABLE);
    let rows = |paragraphs: &[Paragraph]| {
        let rows: usize = paragraphs.iter().map(|one| wrap(&one.text, usize::from(width)).len()).sum();
        rows as u16
    };
    // If room is short, the least important paragraphs are dropped.
    while rows(&paragraphs) + TABLE_ROWS > inner.height
        && let Some(least) = paragraphs.iter().rposition(|one| one.is_extra)
    {
        paragraphs.remove(least);
    }
    let text = draw_preview(&table, &exercise.layout, [width, rows(&paragraphs)], inner, ui);
    let paragraphs: Vec<_> = paragraphs.into_iter().map(|one| (one.text, one.style)).collect();
    write_paragraphs(&paragraphs, text, ui);
}

/// A paragraph about an exercise.
struct Paragraph {
    text: String,
    style: Style,
    /// Whether the paragraph may be left out.
    is_extra: bool,
}

/// The lesson of an exercise, and the typical and the player's own success rates.
fn description(drills: &DrillsPage, exercise: &Exercise, table: &Table, theme: &Theme) -> Vec<Paragraph> {
    let mut all = Vec::new();
    let mut add = |text: String, style, is_extra| all.push(Paragraph { text, style, is_extra });
    if !exercise.point.is_empty() {
        add(String::new(), theme.text(), true);
        add(exercise.point.clone(), theme.text(), false);
    }
    add(String::new(), theme.text(), true);
    let grade = if exercise.grade == 0 { String::new() } else { format!(", grade {}", exercise.grade) };
    add(format!("rule: {}{grade}", exercise.rule), theme.text(), false);
    if let Some(par) = exercise.par {
        let [beginner, club, best] = [par.beginner, par.club, par.world_class].map(words::percent);
        add(format!("typical: beginner {beginner}, club {club}, world-class {best} %"), theme.text(), false);
    }
    let scores = drills.book.scores_of(&exercise.name);
    if scores.is_empty() {
        add("you: not tried yet".to_owned(), theme.faint(), false);
    }
    for (venue, score) in scores {
        let (place, rate) = (venue.word(), percent_words(score.rate.rate));
        let words = format!("{place}: {} of {}, {rate}{}", score.made, score.tried, best_run(score));
        add(words, theme.good(), false);
    }
    add(position_words(table, &exercise.layout, CueBall::White, drills.units.position), theme.faint(), true);
    if !exercise.tags.is_empty() {
        let tags: Vec<String> = exercise.tags.iter().map(|tag| format!("#{}", bare_tag(tag))).collect();
        add(tags.join(" "), theme.faint(), true);
    }
    all
}

fn draw_placeholder(drills: &DrillsPage, area: Rect, ui: &mut Ui) {
    let filter = &drills.catalogue.filter;
    let words = if filter.category == Some(Category::Own) && filter.text.is_none() && filter.grade.is_none() {
        "You have saved no position yet. On the coach's table, s saves the balls as they lie; here, a adds a position from \
         a code that somebody has sent you."
            .to_owned()
    } else {
        match (drills.catalogue.matches_elsewhere(), &drills.question) {
            (0, _) => "No exercise matches. 0 lists all.".to_owned(),
            (elsewhere, question) => {
                let place = match (filter.category, filter.grade) {
                    (Some(category), None) => format!("in {}", category.title()),
                    _ => "here".to_owned(),
                };
                let key = if question.is_some() { "Enter" } else { "0" };
                format!("None {place}; {elsewhere} elsewhere: {key} lists them.")
            }
        }
    };
    let text = Rect { x: area.x + 2, y: area.y + 2, width: area.width - 3, height: area.height.saturating_sub(2) };
    write_paragraphs(&[(words, ui.theme.faint())], text, ui);
}
