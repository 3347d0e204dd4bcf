//! The first row: the tabs, and behind them the table, what is asked, and how far the shot has played.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    text::{Line, Span},
};

use super::{draw_tabs, end_of};
use crate::terminal::{
    app::{App, Mode},
    chord::keys_text,
    keymap::{Action, CoachAction, Place, chord_of},
    words::{fixed, rule_word, skill_word},
};

/// Cells of the bar that shows how far the shot has played: at least, and at most; and from how many on words stand before
/// it.
const BAR: (usize, usize) = (6, 40);
const WORDY: usize = 16;
/// Columns behind the tabs from which on the usual table is named, and its size told.
const NAMED: usize = 60;
const MEASURED: usize = 90;
/// Fewest columns of a policy's name that still tell something.
const NAME: usize = 8;

/// Draws the coach's row. What is asked and the time of the shot always have room; the rest comes as it fits.
pub fn draw_header(app: &App, area: Rect, buffer: &mut Buffer) {
    let area = draw_tabs(app, area, buffer);
    let room = usize::from(area.width);
    let question = question(app);
    let name = name(app, room.saturating_sub(question.width() + transport(app, Form::Short, 0).width() + 2), room);
    let left = room.saturating_sub(question.width() + name.width() + 1);
    // The bar says more than words do.
    let wanted = [(Form::Words, WORDY), (Form::Sign, BAR.0), (Form::Words, 0), (Form::Sign, 0)];
    let fits = |(form, bar): &(Form, usize)| transport(app, *form, *bar).width() < left;
    let (form, bar) = wanted.into_iter().find(fits).unwrap_or((Form::Short, 0));
    let bar = if bar > 0 { left.saturating_sub(transport(app, form, 0).width() + 5).min(BAR.1) } else { 0 };
    let x = buffer.set_line(area.x, area.y, &name, area.width).0;
    let x = buffer.set_line(x, area.y, &question, area.right().saturating_sub(x)).0;
    let right = transport(app, form, bar);
    let start = area.right().saturating_sub(right.width() as u16 + 1).max(x + 1).min(area.right());
    buffer.set_line(start, area.y, &right, area.right() - start);
}

/// What is asked, each after the key that changes it.
fn question(app: &App) -> Line<'static> {
    let (theme, tutor) = (app.theme(), &app.coach().tutor);
    let plan = if tutor.plan { "plan" } else { "off" };
    let parts = [
        (CoachAction::NextRule, rule_word(tutor.rule)),
        (CoachAction::NextSkill, skill_word(tutor.skill)),
        (CoachAction::TurnPlan, plan),
    ];
    let mut line = Line::default();
    for (action, words) in parts {
        let chord = chord_of(Place::Coach, Action::Coach(action));
        let key = keys_text(chord.into_iter().flat_map(|chord| app.keys().for_work_of(chord).take(1)), app.look());
        line.push_span(Span::styled(format!(" {key}"), theme.accent()));
        line.push_span(Span::styled(format!(" {words}"), theme.text()));
    }
    line
}

/// The policy that is asked or the table, where it is not the usual one or there is room for it.
fn name(app: &App, left: usize, room: usize) -> Line<'static> {
    let (theme, table) = (app.theme(), app.table());
    let is_usual = app.coach().tutor.policy.is_none() && table.name == "match";
    if left < NAME || is_usual && room < NAMED {
        return Line::default();
    }
    if let Some((policy, _)) = &app.coach().tutor.policy {
        return Line::styled(format!(" {}", end_of(policy, left - 1, app.look())), theme.good());
    }
    let mut line = Line::styled(format!(" {}", end_of(&table.name, left - 1, app.look())), theme.text());
    if room >= MEASURED {
        line.push_span(Span::styled(format!(" {} x {} m", table.length, table.width), theme.faint()));
    }
    line
}

/// How much is said about the shot's time.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// What goes on, in words.
    Words,
    /// The same as a sign.
    Sign,
    /// The same in as few columns as can be.
    Short,
}

fn transport(app: &App, form: Form, bar: usize) -> Line<'static> {
    let (theme, look) = (app.theme(), app.look());
    let playback = app.playback();
    let is_thinking = app.spinner().is_some();
    let Some(shot) = app.shot() else {
        let words = if is_thinking { "thinking" } else { "placing balls" };
        return Line::from(Span::styled(if form == Form::Short { "" } else { words }, theme.faint()));
    };
    let (words, sign) = match app.mode() {
        _ if is_thinking => ("thinking", look.pick("…", "?")),
        Mode::Placing => ("shot ready", look.pick("■", "#")),
        Mode::Watching if playback.playing => ("playing", look.pick("▸", ">")),
        Mode::Watching => ("paused", look.pick("‖", "|")),
    };
    let duration = shot.recording.duration();
    let end = fixed(duration, 2);
    // As wide as the time gets, so that nothing moves.
    let now = format!("{:>width$}", fixed(playback.readout, 2), width = end.len());
    let times = look.pick("×", "x");
    let (state, of, speed) = match form {
        Form::Words => (format!("{words:<10}  "), format!(" / {end} s"), format!("  {times}{}", playback.speed())),
        Form::Sign => (format!("{sign} "), format!(" / {end} s"), format!(" {times}{}", playback.speed())),
        Form::Short => (format!("{sign} "), format!("/{end}"), format!(" {times}{}", playback.speed())),
    };
    let mut line = Line::from(Span::styled(state, theme.text()));
    if bar > 0 {
        let done = if duration > 0.0 { (playback.readout / duration * bar as f64) as usize } else { bar };
        line.push_span(Span::styled(look.pick("━", "=").repeat(done.min(bar)), theme.accent()));
        line.push_span(Span::styled(look.pick("─", "-").repeat(bar - done.min(bar)), theme.faint()));
        line.push_span(Span::styled("  ", theme.text()));
    }
    line.push_span(Span::styled(now, theme.text()));
    line.push_span(Span::styled(of, theme.faint()));
    line.push_span(Span::styled(speed, theme.text()));
    line
}
