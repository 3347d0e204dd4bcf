//! The small table that replays a run's latest shots.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::terminal::{
    ReplayShot,
    pages::training::Watch,
    ui::{TableView, Ui, draw_table, draw_title, write_right},
    words::short_count,
};

/// Draws the table with its title.
pub fn draw(watch: &Watch, area: Rect, ui: &mut Ui) {
    let replay = &watch.replay;
    let (Some(table), Some(reel), Some(ReplayShot { example, shot })) = (watch.table(), &replay.reel, replay.shot())
    else {
        let inner = draw_title("Shots", area, ui);
        let words = if watch.lacks_config() {
            ["", "shots need the run's", "configuration"]
        } else {
            ["", "shots come with the", "first measurement"]
        };
        for (text, y) in words.into_iter().zip(inner.y..inner.bottom()) {
            ui.buffer.set_stringn(inner.x + 2, y, text, usize::from(inner.width.saturating_sub(2)), ui.theme.faint());
        }
        return;
    };
    let (outcome, style) = match example.reward {
        reward if !watch.own.is_success_rate() => (format!("{reward:.2}"), ui.theme.text()),
        reward if reward >= 1.0 => ("point".to_owned(), ui.theme.good()),
        _ => ("miss".to_owned(), ui.theme.warning()),
    };
    let title = Line::from(vec![
        Span::styled(format!("Shot {} of {}", replay.index + 1, reel.shots.len()), ui.theme.text()),
        ui.dash(),
        Span::styled(outcome, style),
    ]);
    let free = area.x + title.width() as u16 + 5;
    let inner = draw_title(title, area, ui);
    let after = format!(" after {} shots ", short_count(reel.after));
    if usize::from(area.right().saturating_sub(free)) > after.len() {
        write_right(ui.buffer, free, area.right().saturating_sub(1), area.y, &after, ui.theme.faint());
    }
    let view = TableView { shot: shot.as_ref(), time: replay.playback.time, ..TableView::new(table, &example.layout) };
    draw_table(&view, inner, ui);
}
