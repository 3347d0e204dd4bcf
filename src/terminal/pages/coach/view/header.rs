//! The coach's part of the first screen row, after the tabs: table, query terms and playback progress.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    coach::FirstContact,
    terminal::{
        CoachAction, Mode,
        pages::coach::{CoachPage, keys::COACH},
        ui::{Ui, shorten_start},
        words::{fixed, others_skill_word, rule_word, short_skill_word, skill_word},
    },
};

/// Minimum and maximum width of the progress bar, columns; and the width from which on the state before it is written in words.
const BAR: (usize, usize) = (6, 40);
const MIN_BAR_WITH_WORDS: usize = 16;
/// Widths of the row after the tabs, columns, from which on the name and the size of the default table are shown.
const MIN_WIDTH_WITH_NAME: usize = 60;
const MIN_WIDTH_WITH_SIZE: usize = 90;
/// Note that jumps and massés are forbidden. The coach's answer repeats it.
const NO_JUMPS_NOTE: &str = " no jumps";
/// Maximum width of the table's name while another player's table is followed, columns.
const TABLE: usize = 12;
/// Minimum width of a policy's name that is still readable, columns.
const NAME: usize = 8;

/// Draws the row. The query terms and the time of the shot are always shown, the rest if it fits.
pub fn draw_header(coach: &CoachPage, area: Rect, ui: &mut Ui) {
    let room = usize::from(area.width);
    // If room is short, the duration or the playback speed, then both, are dropped before any query term.
    let time = transport(coach, Form::Now, 0, ui).width() + 2;
    // Of the query terms the player's average is dropped first, then the plan. The wish for the first contact and the name of another
    // table stay.
    let is_named = coach.query.policy.is_some() || coach.table().name != "match";
    let has_plan = coach.query.plan && coach.query.first == FirstContact::Any && !is_named;
    let taken = time + if is_named { NAME } else { 0 };
    let [whole, brief, least] =
        [(true, true), (true, false), (has_plan, false)].map(|(plan, average)| question(coach, plan, average, ui));
    let question = [whole, brief].into_iter().find(|line| line.width() + taken <= room).unwrap_or(least);
    let name = name(coach, room.saturating_sub(question.width() + time), room, ui);
    let left = room.saturating_sub(question.width() + name.width() + 1);
    // The bar is more informative than words.
    let wanted = [
        (Form::Words, MIN_BAR_WITH_WORDS),
        (Form::Sign, BAR.0),
        (Form::Words, 0),
        (Form::Sign, 0),
        (Form::Short, 0),
        (Form::Time, 0),
    ];
    let fits = |(form, bar): &(Form, usize)| transport(coach, *form, *bar, ui).width() < left;
    let (form, bar) = wanted.into_iter().find(fits).unwrap_or((Form::Now, 0));
    let bar = if bar > 0 { left.saturating_sub(transport(coach, form, 0, ui).width() + 5).min(BAR.1) } else { 0 };
    let x = ui.buffer.set_line(area.x, area.y, &name, area.width).0;
    let x = ui.buffer.set_line(x, area.y, &question, area.right().saturating_sub(x)).0;
    let right = transport(coach, form, bar, ui);
    let start = area.right().saturating_sub(right.width() as u16 + 1).max(x + 1).min(area.right());
    ui.buffer.set_line(start, area.y, &right, area.right() - start);
}

/// The query terms, each after the key that changes it. The plan and the player's average are included on request.
fn question(coach: &CoachPage, has_plan: bool, has_average: bool, ui: &Ui) -> Line<'static> {
    let query = &coach.query;
    if let Some(followed) = coach.followed() {
        let words = if followed.empty_reason().is_some() {
            String::new()
        } else {
            let table = shorten_start(&coach.table().name, TABLE, ui.caps);
            format!(": {table}, {}, {}", rule_word(query.rule), others_skill_word(query.skill))
        };
        let whose = Span::styled(format!(" following {}", followed.name), ui.theme.accent());
        return Line::from(vec![whose, Span::styled(words, ui.theme.text())]);
    }
    let player = if has_average { skill_word(query.skill) } else { short_skill_word(query.skill).to_owned() };
    let plan = if query.plan { "plan on" } else { "plan off" };
    let parts = [
        (CoachAction::NextRule, rule_word(query.rule)),
        (CoachAction::NextSkill, player.as_str()),
        (CoachAction::TogglePlan, plan),
    ];
    let mut parts = parts[..if has_plan { 3 } else { 2 }].to_vec();
    let first = format!("{} first", query.first.word(coach.cue_ball().names()));
    if query.first != FirstContact::Any {
        parts.push((CoachAction::NextFirstContact, &first));
    }
    let mut line = Line::default();
    for (action, words) in parts {
        // These keys do nothing while the player's own stroke is open.
        if coach.what_if().is_none() {
            line.push_span(Span::styled(format!(" {}", ui.key_of(COACH, &action)), ui.theme.accent()));
        }
        line.push_span(Span::styled(format!(" {words}"), ui.theme.text()));
    }
    line
}

/// The name of the policy or of the table, if it is not the default one or there is room; then the note that jumps are forbidden.
fn name(coach: &CoachPage, left: usize, room: usize, ui: &Ui) -> Line<'static> {
    if coach.followed().is_some() {
        return Line::default();
    }
    let mut line = policy_or_table(coach, left, room, ui);
    if !coach.query.jumps && line.width() + NO_JUMPS_NOTE.len() <= left {
        line.push_span(Span::styled(NO_JUMPS_NOTE, ui.theme.text()));
    }
    line
}

fn policy_or_table(coach: &CoachPage, left: usize, room: usize, ui: &Ui) -> Line<'static> {
    let table = coach.table();
    let is_usual = coach.query.policy.is_none() && table.name == "match";
    if left < NAME || is_usual && room < MIN_WIDTH_WITH_NAME {
        return Line::default();
    }
    if let Some((policy, _)) = &coach.query.policy {
        return Line::styled(format!(" {}", shorten_start(policy, left - 1, ui.caps)), ui.theme.good());
    }
    let mut line = Line::styled(format!(" {}", shorten_start(&table.name, left - 1, ui.caps)), ui.theme.text());
    if room >= MIN_WIDTH_WITH_SIZE {
        line.push_span(Span::styled(format!(" {} x {} m", table.length, table.width), ui.theme.faint()));
    }
    line
}

/// Level of detail of the playback state.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    /// State in words, time, duration and speed.
    Words,
    /// The same with a symbol for the state.
    Sign,
    /// The same without blanks and unit.
    Short,
    /// The same without the duration, if the speed is not 1, or otherwise without the speed.
    Time,
    /// Only the symbol and the current time.
    Now,
}

fn transport(coach: &CoachPage, form: Form, bar: usize, ui: &Ui) -> Line<'static> {
    let playback = coach.playback;
    let is_thinking = coach.spinner().is_some();
    if coach.followed().is_some_and(|followed| followed.empty_reason().is_some()) {
        return Line::default();
    }
    let Some(shot) = coach.shot() else {
        let words = if is_thinking { "thinking" } else { "placing balls" };
        return Line::from(Span::styled(
            if matches!(form, Form::Short | Form::Time | Form::Now) { "" } else { words },
            ui.theme.faint(),
        ));
    };
    let (words, sign) = match coach.mode {
        _ if is_thinking => ("thinking", ui.caps.pick("…", "?")),
        Mode::Placing => ("shot ready", ui.caps.pick("■", "#")),
        Mode::Watching if playback.playing => ("playing", ui.caps.pick("▸", ">")),
        Mode::Watching => ("paused", ui.caps.pick("‖", "|")),
    };
    let duration = shot.recording.duration();
    let end = fixed(duration, 2);
    // The time is padded to the width of the duration so that the text does not move.
    let now = format!("{:>width$}", fixed(playback.readout, 2), width = end.len());
    let times = ui.caps.pick("×", "x");
    let (state, of, speed) = match form {
        Form::Words => (format!("{words:<10}  "), format!(" / {end} s"), format!("  {times}{}", playback.speed())),
        Form::Sign => (format!("{sign} "), format!(" / {end} s"), format!(" {times}{}", playback.speed())),
        Form::Short => (format!("{sign} "), format!("/{end}"), format!(" {times}{}", playback.speed())),
        Form::Time if playback.speed() == 1.0 => (format!("{sign} "), format!("/{end}"), String::new()),
        Form::Time => (format!("{sign} "), String::new(), format!(" {times}{}", playback.speed())),
        Form::Now => (format!("{sign} "), String::new(), String::new()),
    };
    let mut line = Line::from(Span::styled(state, ui.theme.text()));
    if bar > 0 {
        let done = if duration > 0.0 { (playback.readout / duration * bar as f64) as usize } else { bar };
        line.push_span(Span::styled(ui.caps.pick("━", "=").repeat(done.min(bar)), ui.theme.accent()));
        line.push_span(Span::styled(ui.caps.pick("─", "-").repeat(bar - done.min(bar)), ui.theme.faint()));
        line.push_span(Span::styled("  ", ui.theme.text()));
    }
    line.push_span(Span::styled(now, ui.theme.text()));
    line.push_span(Span::styled(of, ui.theme.faint()));
    line.push_span(Span::styled(speed, ui.theme.text()));
    line
}
