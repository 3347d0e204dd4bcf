//! The small table, on which a run's latest shots are replayed.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use crate::terminal::{
    app::App,
    training::{Scene, Watch},
    widgets::{TableView, draw_table, draw_title, write_right},
    words::short_count,
};

/// Draws the table with its title.
pub fn draw(app: &App, watch: &Watch, area: Rect, buffer: &mut Buffer) {
    let (theme, look, replay) = (app.theme(), app.look(), &watch.replay);
    let dot = look.pick(" · ", " - ");
    let (Some(table), Some(reel), Some(Scene { example, shot })) = (watch.table(), replay.reel(), replay.scene())
    else {
        let inner = draw_title(&Line::from(Span::styled("Shots", theme.text())), area, theme, look, buffer);
        let words = if watch.lacks_config() {
            ["", "shots need the run's", "configuration"]
        } else {
            ["", "shots come with the", "first measurement"]
        };
        for (text, y) in words.into_iter().zip(inner.y..inner.bottom()) {
            buffer.set_stringn(inner.x + 2, y, text, usize::from(inner.width.saturating_sub(2)), theme.faint());
        }
        return;
    };
    let (outcome, style) = match example.reward {
        reward if !watch.is_share() => (format!("{reward:.2}"), theme.text()),
        reward if reward >= 1.0 => ("point".to_owned(), theme.good()),
        _ => ("miss".to_owned(), theme.warning()),
    };
    let title = Line::from(vec![
        Span::styled(format!("Shot {} of {}", replay.index() + 1, reel.scenes.len()), theme.text()),
        Span::styled(dot, theme.faint()),
        Span::styled(outcome, style),
    ]);
    let inner = draw_title(&title, area, theme, look, buffer);
    let after = format!(" after {} shots ", short_count(reel.after));
    let free = area.x + title.width() as u16 + 5;
    if usize::from(area.right().saturating_sub(free)) > after.len() {
        write_right(buffer, free, area.right().saturating_sub(1), area.y, &after, theme.faint());
    }
    let view = TableView {
        table,
        layout: &example.layout,
        shot: shot.as_ref(),
        time: replay.time(),
        is_moving: true,
        front: 0,
        is_lean: false,
        spots: &[],
        film: None,
        theme,
        look,
    };
    draw_table(&view, inner, buffer);
}
