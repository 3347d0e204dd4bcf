//! The screen with the list of filmed shots and a preview of the marked one.

use ratatui::{
    layout::{Position, Rect},
    text::Span,
};

use crate::terminal::{
    pages::{
        Target,
        drills::{
            DrillsPage,
            view::{READABLE, draw_preview},
        },
    },
    shot::film::{ListedShot, listed, table},
    ui::{Message, Ui, below_title, draw_header, draw_title, list, split, wrap, write_paragraphs, write_right},
    words::fixed,
};

/// Width of the list, columns.
const LIST: u16 = 36;
/// Right ends of the shot's number, its speed and its duration, from the list's left edge, columns.
const NUMBER_END: u16 = 10;
const SPEED_END: u16 = 24;
const LENGTH_END: u16 = 32;

/// Draws the screen. Returns the default text of the status line.
pub fn draw(drills: &DrillsPage, header: Rect, area: Rect, ui: &mut Ui) -> Message {
    let points = listed().iter().filter(|listed| listed.is_point).count();
    let more = format!("{} shots of a match, {points} points", listed().len());
    draw_header("filmed shots", &more, &Span::default(), header, ui);
    let [list, preview] = split(LIST, area);
    draw_list(drills, list, ui);
    if let Some(listed) = drills.film.marked() {
        draw_shot(listed, preview, ui);
    }
    Message::plain("choose a shot; Enter plays it, filmed balls and simulated ones together")
}

/// The result of a shot in the film.
pub const fn outcome(listed: &ListedShot) -> &'static str {
    if listed.is_point { "point" } else { "no point" }
}

/// The mouse target at `at`.
pub fn target(drills: &DrillsPage, area: Rect, at: Position) -> Option<Target> {
    let [area, _] = split(LIST, area);
    let mark = drills.film.mark;
    let line = list::line_at(mark, listed().len(), below_title(area), at.y);
    area.contains(at).then(|| Target::list(line, mark))
}

fn draw_list(drills: &DrillsPage, area: Rect, ui: &mut Ui) {
    let mark = drills.film.mark;
    let inner = draw_title(format!("All {}", listed().len()), area, ui);
    let (factor, symbol) = drills.units.length.speed();
    for (end, label) in [(SPEED_END, symbol), (LENGTH_END, "seconds")] {
        write_right(ui.buffer, area.x, area.x + end + 1, area.y, &format!(" {label} "), ui.theme.faint());
    }
    for (n, y) in list::shown(mark, listed().len(), inner) {
        let listed = &listed()[n];
        let style = if n == mark { ui.theme.accent() } else { ui.theme.text() };
        list::draw_mark(n == mark, inner.x, y, ui);
        let filmed = &listed.filmed;
        write_right(ui.buffer, inner.x, inner.x + NUMBER_END, y, &format!("shot {:>3}", filmed.number), style);
        if listed.is_point {
            let style = if n == mark { style } else { ui.theme.good() };
            ui.buffer.set_string(inner.x + NUMBER_END + 2, y, "point", style);
        }
        write_right(ui.buffer, inner.x, inner.x + SPEED_END, y, &fixed(factor * filmed.speed(), 1), style);
        write_right(ui.buffer, inner.x, inner.x + LENGTH_END, y, &fixed(filmed.duration(), 1), style);
    }
}

fn draw_shot(listed: &ListedShot, area: Rect, ui: &mut Ui) {
    let title = format!("Shot {}, {}", listed.filmed.number, outcome(listed));
    let inner = draw_title(title, area, ui);
    let width = inner.width.saturating_sub(2).min(READABLE);
    let paragraphs = [
        (String::new(), ui.theme.text()),
        ("Three cushions, filmed at 50 pictures a second on a heated match table.".to_owned(), ui.theme.text()),
        (
            "The stroke is fitted to the cue ball's first 2 seconds; all that comes after, and the object balls, the simulator \
             predicts."
                .to_owned(),
            ui.theme.text(),
        ),
    ];
    let rows: usize = paragraphs.iter().map(|(text, _)| wrap(text, usize::from(width)).len()).sum();
    let text = draw_preview(table(), &listed.layout, [width, rows as u16], inner, ui);
    write_paragraphs(&paragraphs, text, ui);
}
