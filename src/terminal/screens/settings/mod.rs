//! The settings' screen: the settings with their values, or the keys; beside them what is marked in words.

mod keys;
mod values;

use ratatui::{
    buffer::Buffer,
    layout::{Position, Rect},
    style::Style,
    text::{Line, Span},
};

use super::target::{self, Target};
use crate::terminal::{
    app::App,
    settings::{Input, Page},
    status::Message,
    widgets::{cut, draw_hints, draw_question, draw_status, draw_tabs, end_of, wrap},
};

/// Columns of the list, of a hundred, and at most.
const LIST: (u16, u16) = (54, 70);
/// Columns of the screen from which on the words on a key stand beside the list; otherwise they have some rows below it.
const BESIDE: u16 = 100;
const BELOW: u16 = 7;
/// Rows from which on paragraphs stand apart.
const APART: u16 = 10;

/// A row of a list.
enum Row<T> {
    /// What the rows below it have in common.
    Heading(&'static str),
    /// Something that can be marked, by its place among all of them.
    Entry(usize, T),
}

/// Draws the page that is open; gives the first row of what stands below it.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> u16 {
    let (theme, look, screen) = (app.theme(), app.look(), app.settings());
    let row = |y: u16| Rect::new(area.x, y, area.width, 1);
    let page = Rect::new(area.x, area.y + 1, area.width, area.height.saturating_sub(3));
    let rest = draw_tabs(app, row(area.y), buffer);
    let path = end_of(&screen.path.display().to_string(), usize::from(rest.width.saturating_sub(2)), look);
    buffer.set_string(rest.x + 1, rest.y, path, theme.faint());
    let [list, words] = halves(screen.page, page);
    let standing = match screen.page {
        Page::Values => values::draw(app, list, words, buffer),
        Page::Keys => keys::draw(app, list, words, buffer),
    };
    draw_hints(app, row(page.bottom() + 1), buffer);
    let status = row(page.bottom());
    if let Some(question) = question(app) {
        return draw_question(&Message::plain(question), status, theme, look, buffer);
    }
    let message = app.message().cloned().unwrap_or(Message::plain(standing));
    draw_status(&message, status, theme, look, buffer)
}

/// What is being put in, as it stands on the status line.
fn question(app: &App) -> Option<String> {
    let screen = app.settings();
    match screen.input.as_ref()? {
        Input::Value(typed) if typed.is_empty() && screen.other_in_file(screen.marked()).is_some() => {
            let entry = screen.marked();
            Some(format!("{} = _ Enter alone keeps {}", entry.key, (entry.get)(&screen.settings)))
        }
        Input::Value(typed) => Some(format!("{} = {typed}_", screen.marked().key)),
        Input::Key => Some(keys::press(app)),
        Input::Taken(chord) => Some(keys::taken(app, *chord)),
    }
}

/// The list's part of the page, and that of the words.
fn halves(page: Page, area: Rect) -> [Rect; 2] {
    if page == Page::Keys && area.width < BESIDE {
        let list = Rect { height: area.height.saturating_sub(BELOW), ..area };
        return [list, Rect { y: list.bottom(), height: area.height - list.height, ..area }];
    }
    let list = Rect { width: (area.width * LIST.0 / 100).min(LIST.1), ..area };
    [list, Rect { x: list.right() + 1, width: area.width - list.width - 1, ..area }]
}

/// What the mouse points at.
pub fn target(app: &App, area: Rect, at: Position) -> Option<Target> {
    let [list, _] = halves(app.settings().page, area);
    let (places, mark) = match app.settings().page {
        Page::Values => (places(&values::rows()), app.settings().mark()),
        Page::Keys => (places(&keys::rows(app)), app.settings().keys.mark()),
    };
    // The first row is the title's.
    let inner = list.y + 1..list.bottom();
    let first = first_in_view(&places, mark, inner.len());
    let line = inner.zip(places.into_iter().skip(first)).find(|(y, _)| *y == at.y).and_then(|(_, place)| place);
    list.contains(at).then(|| target::list(line, mark))
}

/// The place of each row among those that can be marked; headings have none.
fn places<T>(rows: &[Row<T>]) -> Vec<Option<usize>> {
    let place = |row: &Row<T>| if let Row::Entry(place, _) = row { Some(*place) } else { None };
    rows.iter().map(place).collect()
}

/// The first row of a list that is shown, so that the marked one is among the first `most`.
fn first_in_view(places: &[Option<usize>], mark: usize, most: usize) -> usize {
    let marked = places.iter().position(|place| *place == Some(mark)).unwrap_or(0);
    marked.saturating_sub(most / 2).min(places.len().saturating_sub(most))
}

/// Draws the rows of a list that are in view; `draw` draws those that can be marked into theirs.
fn draw_list<T>(
    app: &App,
    rows: &[Row<T>],
    mark: usize,
    area: Rect,
    buffer: &mut Buffer,
    draw: impl Fn(&T, bool, Rect, &mut Buffer),
) {
    let theme = app.theme();
    let first = first_in_view(&places(rows), mark, usize::from(area.height));
    for (row, y) in rows.iter().skip(first).zip(area.y..area.bottom()) {
        match row {
            Row::Heading(title) => {
                buffer.set_stringn(area.x + 1, y, title, usize::from(area.width), theme.good());
            }
            Row::Entry(place, entry) => {
                let is_marked = *place == mark;
                if is_marked {
                    buffer.set_string(area.x, y, app.look().pick("▸", ">"), theme.accent());
                }
                draw(
                    entry,
                    is_marked,
                    Rect { x: area.x + 2, y, width: area.width.saturating_sub(2), height: 1 },
                    buffer,
                );
            }
        }
    }
}

/// Writes paragraphs into a panel from its top on, with blank rows between them where there is room.
fn write_paragraphs(app: &App, paragraphs: &[(String, Style)], area: Rect, buffer: &mut Buffer) {
    let gap = u16::from(area.height >= APART);
    let area = Rect { x: area.x + 1, width: area.width.saturating_sub(2), ..area };
    let width = usize::from(area.width);
    let mut y = area.y + gap;
    for (text, style) in paragraphs {
        let room = usize::from(area.bottom().saturating_sub(y));
        if room == 0 {
            return;
        }
        for line in cut(wrap(text, width), room, width, app.look()) {
            buffer.set_line(area.x, y, &Line::from(Span::styled(line, *style)), area.width);
            y += 1;
        }
        y += gap;
    }
}
