//! The list of filmed shots, and the marked one on a small table with what it is.

use ratatui::{
    buffer::Buffer,
    layout::{Position, Rect},
    text::{Line, Span},
};

use super::{READABLE, write_paragraphs};
use crate::terminal::{
    app::App,
    film::{Listed, listed, table},
    geometry::Mapping,
    screens::target::{self, Target},
    status::Message,
    widgets::{TableView, draw_table, draw_tabs, draw_title, wrap, write_right},
    words::fixed,
};

/// Columns of the list.
const LIST: u16 = 36;
/// Columns at which the numbers end, from the list's left edge: the shot's, its speed, and how long it takes.
const NUMBER_END: u16 = 10;
const SPEED_END: u16 = 24;
const LENGTH_END: u16 = 32;

/// Draws the page; gives what the status line says while there is no news.
pub fn draw(app: &App, header: Rect, area: Rect, buffer: &mut Buffer) -> Message {
    let points = listed().iter().filter(|listed| listed.is_point).count();
    let more = format!("{} shots of a match, {points} points", listed().len());
    draw_film_header(app, "filmed shots", &more, header, buffer);
    let [list, preview] = halves(area);
    draw_list(app, list, buffer);
    if let Some(listed) = app.drills().film.marked() {
        draw_shot(app, listed, preview, buffer);
    }
    Message::plain("choose a shot; Enter plays it, filmed balls and simulated ones together")
}

/// The first row of a page of the film: nobody plays there.
pub fn draw_film_header(app: &App, title: &str, more: &str, area: Rect, buffer: &mut Buffer) {
    let theme = app.theme();
    let area = draw_tabs(app, area, buffer);
    let line = Line::from(vec![
        Span::styled(format!(" {title}"), theme.text()),
        Span::styled(format!("  {more}"), theme.faint()),
    ]);
    buffer.set_line(area.x, area.y, &line, area.width);
}

/// What became of a shot by the film.
pub const fn outcome(listed: &Listed) -> &'static str {
    if listed.is_point { "point" } else { "no point" }
}

fn halves(area: Rect) -> [Rect; 2] {
    let list = Rect { width: LIST.min(area.width), ..area };
    [list, Rect { x: list.right() + 1, width: area.width.saturating_sub(list.width + 1), ..area }]
}

/// Places in the list of the shots in view: the marked one is among the first `most`.
fn in_view(mark: usize, most: usize) -> impl Iterator<Item = (usize, &'static Listed)> {
    let first = mark.saturating_sub(most / 2).min(listed().len().saturating_sub(most));
    listed().iter().enumerate().skip(first)
}

/// What the mouse points at.
pub fn target(app: &App, area: Rect, at: Position) -> Option<Target> {
    let [list, _] = halves(area);
    let mark = app.drills().film.mark();
    // The first row is the title's.
    let rows = list.y + 1..list.bottom();
    let line = rows.clone().zip(in_view(mark, rows.len())).find(|(y, _)| *y == at.y).map(|(_, (n, _))| n);
    list.contains(at).then(|| target::list(line, mark))
}

fn draw_list(app: &App, area: Rect, buffer: &mut Buffer) {
    let (theme, look, mark) = (app.theme(), app.look(), app.drills().film.mark());
    let title = Line::from(Span::styled(format!("All {}", listed().len()), theme.text()));
    let inner = draw_title(&title, area, theme, look, buffer);
    for (end, label) in [(SPEED_END, " m/s "), (LENGTH_END, " seconds ")] {
        write_right(buffer, area.x, area.x + end + 1, area.y, label, theme.faint());
    }
    for ((n, listed), y) in in_view(mark, usize::from(inner.height)).zip(inner.y..inner.bottom()) {
        let style = if n == mark { theme.accent() } else { theme.text() };
        if n == mark {
            buffer.set_string(inner.x, y, look.pick("▸", ">"), style);
        }
        let filmed = &listed.filmed;
        write_right(buffer, inner.x, inner.x + NUMBER_END, y, &format!("shot {:>3}", filmed.number), style);
        if listed.is_point {
            let style = if n == mark { style } else { theme.good() };
            buffer.set_string(inner.x + NUMBER_END + 2, y, "point", style);
        }
        write_right(buffer, inner.x, inner.x + SPEED_END, y, &fixed(filmed.speed(), 1), style);
        write_right(buffer, inner.x, inner.x + LENGTH_END, y, &fixed(filmed.lasts(), 1), style);
    }
}

fn draw_shot(app: &App, listed: &Listed, area: Rect, buffer: &mut Buffer) {
    let (theme, look) = (app.theme(), app.look());
    let title = format!("Shot {}, {}", listed.filmed.number, outcome(listed));
    let inner = draw_title(&Line::from(Span::styled(title, theme.text())), area, theme, look, buffer);
    let width = inner.width.saturating_sub(2).min(READABLE);
    let paragraphs = [
        (String::new(), theme.text()),
        ("Three cushions, filmed at 50 pictures a second on a heated match table.".to_owned(), theme.text()),
        (
            "The stroke is fitted to the cue ball's first 2 seconds; all that comes after, and the object balls, the simulator \
             predicts."
                .to_owned(),
            theme.text(),
        ),
    ];
    let rows: usize = paragraphs.iter().map(|(text, _)| wrap(text, usize::from(width)).len()).sum();
    let room = Rect { height: inner.height.saturating_sub(rows as u16), ..inner };
    let view = TableView {
        table: table(),
        layout: &listed.layout,
        shot: None,
        time: 0.0,
        is_moving: true,
        front: 0,
        is_lean: false,
        spots: &[],
        film: None,
        theme,
        look,
    };
    draw_table(&view, room, buffer);
    let outer = Mapping::fit(table(), room).outer();
    let left = outer.x.min(inner.right().saturating_sub(width + 1)).max(inner.x + 1);
    let text = Rect { x: left, y: outer.bottom(), width, height: inner.bottom().saturating_sub(outer.bottom()) };
    write_paragraphs(&paragraphs, text, look, buffer);
}
