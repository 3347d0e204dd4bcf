//! Draws the command palette: a box over the screen with the commands available there.

use ratatui::{
    layout::Rect,
    style::Modifier,
    text::Span,
    widgets::{Block, Clear, Widget},
};

use crate::terminal::{
    App, Command, CommandPalette,
    ui::{Message, Ui, draw_status, frame, list, shorten, write_right},
};

/// Largest width of the box, its smallest margin at either side, and its largest height; in cells.
const WIDTH: u16 = 100;
const BESIDE: u16 = 3;
const HEIGHT: u16 = 28;
/// Rows of the box that are not commands: its frame and the input.
const FRAME: u16 = 3;
/// Rows that stay free for the status line and the keys.
const BELOW: u16 = 3;
/// Columns of the keys.
const KEYS: u16 = 16;
/// Columns of the counts next to the input.
const COUNTS: u16 = 13;

/// Draws the palette over the screen in `area`, which must have at least the smallest size. Returns the first row of the status line below
/// it.
pub fn draw(app: &App, command_palette: &CommandPalette, area: Rect, ui: &mut Ui) -> u16 {
    let all = app.commands();
    let count = all.len();
    let matching = command_palette.matching(all);
    // The height does not depend on the input: a box that jumps is hard to read.
    let height = (count as u16 + FRAME).min(HEIGHT).min(area.height - BELOW - 1);
    let width = WIDTH.min(area.width - 2 * BESIDE);
    let place = Rect::new(area.x + (area.width - width) / 2, area.y + 1, width, height);
    // Blank out the page below: cut-off fragments of it would only distract.
    let below = Rect { y: area.y + 1, height: area.height - 2, ..area };
    Clear.render(below, ui.buffer);
    ui.buffer.set_style(below, ui.theme.text());
    let title = Span::styled(" Commands ", ui.theme.text());
    let frame = frame(Block::bordered(), ui.caps).border_style(ui.theme.faint()).title(title);
    let inner = frame.inner(place);
    frame.render(place, ui.buffer);
    ui.buffer.set_string(inner.x, inner.y, " : ", ui.theme.accent());
    let prompt = inner.x + 3;
    command_palette.words.draw(Rect { x: prompt, width: inner.right() - prompt - COUNTS, height: 1, ..inner }, ui);
    let of = format!("{} of {count} ", matching.len());
    write_right(ui.buffer, inner.x, inner.right(), inner.y, &of, ui.theme.faint());

    let rows = Rect { y: inner.y + 1, height: inner.height - 1, ..inner };
    let mark = command_palette.mark(matching.len());
    for (n, y) in list::shown(mark, matching.len(), rows) {
        draw_command(app, &matching[n], n == mark, Rect { y, height: 1, ..rows }, ui);
    }
    let status = Rect::new(area.x, area.bottom() - 2, area.width, 1);
    draw_status(&status_line(app, matching.get(mark)), status, ui)
}

/// Draws one command: its keys, its description, and the reason if it is disabled.
fn draw_command(app: &App, command: &Command, is_marked: bool, area: Rect, ui: &mut Ui) {
    let reason = app.disabled_reason(command.when);
    let (keys, words) =
        if reason.is_some() { (ui.theme.faint(), ui.theme.faint()) } else { (ui.theme.accent(), ui.theme.text()) };
    // The selected row has to be readable even if it is disabled.
    let words = if is_marked { ui.theme.text() } else { words };
    let text = sentence(command, reason);
    let room = usize::from(area.width.saturating_sub(KEYS + 4));
    ui.buffer.set_stringn(area.x + 2, area.y, &command.keys, usize::from(KEYS), keys);
    ui.buffer.set_string(area.x + KEYS + 3, area.y, shorten(&text, room, ui.caps), words);
    list::draw_mark(is_marked, area.x, area.y, ui);
    if is_marked {
        ui.buffer.set_style(area, words.add_modifier(Modifier::REVERSED));
    }
}

/// The description of a command, with the reason if it is disabled.
fn sentence(command: &Command, reason: Option<&str>) -> String {
    reason.map_or_else(|| command.description.to_owned(), |reason| format!("{}: {reason}", command.description))
}

/// The status line: the selected command in full.
fn status_line(app: &App, marked: Option<&Command>) -> Message {
    marked.map_or_else(
        || Message::plain("no matching command"),
        |command| {
            let reason = app.disabled_reason(command.when);
            let words = sentence(command, reason);
            let message = if reason.is_some() { Message::poor(words) } else { Message::plain(words) };
            message.prefixed(command.title)
        },
    )
}
