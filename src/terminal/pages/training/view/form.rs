//! The view of the form for a new run.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    game::Reward,
    learning::{agents::AGENTS, run::Schedule},
    terminal::{
        pages::training::{Field, Form, TrainingPage},
        ui::{Ui, columns, draw_lines, draw_title, list, stepper, wrap},
        words::count,
    },
};

/// Widths of the fields' names and of their values, columns.
const NAME: u16 = 14;
const VALUE: u16 = 20;

/// Draws the form and, below it, the equivalent command line.
pub fn draw(training: &TrainingPage, area: Rect, ui: &mut Ui) {
    let form = &training.form;
    for (field, n) in Field::ALL.into_iter().zip(0..) {
        let y = area.y + 1 + 2 * n;
        let is_marked = field == form.field;
        let (value, note) = words(form, field);
        let style = if is_marked { ui.theme.accent() } else { ui.theme.text() };
        list::draw_mark(is_marked, area.x + 1, y, ui);
        ui.buffer.set_string(area.x + 3, y, field.name(), ui.theme.faint());
        let x = area.x + 3 + NAME;
        let value = Line::from_iter(stepper(Span::styled(value, style), is_marked, ui));
        let end = ui.buffer.set_line(x - 2, y, &value, area.right() - x).0;
        let x = (x + VALUE).max(end + 2);
        let room = usize::from(area.right().saturating_sub(x + 1));
        // The note can use two rows, since the row below is free.
        for (line, y) in wrap(&note, room).into_iter().take(2).zip(y..) {
            ui.buffer.set_stringn(x, y, line, room, ui.theme.faint());
        }
    }
    let rows = 2 * Field::ALL.len() as u16 + 2;
    let below = Rect { y: area.y + rows, height: area.height.saturating_sub(rows), ..area };
    let inner = draw_title("The same on the command line", below, ui);
    let elsewhere = (training.folder != training.places.runs).then_some(training.folder.as_path());
    let lines = command_lines(form.command(elsewhere), usize::from(area.width.saturating_sub(6)));
    let name =
        Line::from(vec![Span::styled("run           ", ui.theme.faint()), Span::styled(form.name(), ui.theme.text())]);
    let lines = lines.into_iter().map(|line| Line::styled(line, ui.theme.text())).chain([Line::default(), name]);
    draw_lines(lines, Rect { x: inner.x + 3, width: inner.width.saturating_sub(4), ..inner }, ui);
}

/// Joins the parts of a command to lines of at most `width` columns.
fn command_lines(parts: Vec<String>, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in parts {
        match lines.last_mut() {
            None => lines.push(part),
            Some(line) if columns(line) + columns(&part) + 3 <= width => line.extend([" ", &part]),
            Some(line) => {
                line.push_str(" \\");
                lines.push(format!("  {part}"));
            }
        }
    }
    lines
}

/// A field's value and an explanation of it.
fn words(form: &Form, field: Field) -> (String, String) {
    match field {
        Field::Agent => {
            let agent = AGENTS[form.agent];
            (agent.name.to_owned(), agent.title.to_owned())
        }
        Field::Reward => (form.reward.to_string(), reward_words(form.reward).to_owned()),
        Field::Table => {
            let note = match form.table {
                "match" => "2.84 x 1.42 m, as filmed balls run",
                "textbook" => "2.84 x 1.42 m, the thesis' equations",
                _ => "as in the thesis",
            };
            (form.table.to_owned(), note.to_owned())
        }
        Field::Shots => match form.shots.parse() {
            Ok(shots) => {
                let every = count(Schedule::default_interval(shots));
                (count(shots), format!("measured every {every} shots"))
            }
            Err(_) => (form.shots.clone(), "type a number".to_owned()),
        },
        Field::Seed => {
            let note = if form.seed.is_empty() { "type a number" } else { "the same seed gives the same networks" };
            (form.seed.clone(), note.to_owned())
        }
        Field::From => match &form.from {
            None => ("new networks".to_owned(), "or those of a run of this agent".to_owned()),
            Some((name, _)) => (name.clone(), String::new()),
        },
    }
}

fn reward_words(reward: Reward) -> &'static str {
    match reward {
        Reward::R1 => "meeting an object ball",
        Reward::R1Difficulty => "r1, less after cushions",
        Reward::R2 => "r1, and balls that end close together",
        Reward::R3 => "meeting both: a straight-rail point",
        Reward::R4 => "r3, and balls that end close together",
        Reward::OneCushion => "a point over one cushion",
        Reward::ThreeCushion => "a point over three cushions",
    }
}

/// The default text of the status line.
pub fn status_line(training: &TrainingPage) -> String {
    match training.form.field {
        Field::Shots | Field::Seed => {
            "arrows choose a value, digits type another, Backspace edits it; Enter starts the run".to_owned()
        }
        _ => "arrows choose; Enter starts the run".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_command_is_wrapped_with_shell_continuations() {
        let parts = ["carom train", "--agent ddpg", "--steps 10", "--from 'a --long name'"].map(str::to_owned);
        let lines = command_lines(parts.to_vec(), 24);
        assert_eq!(lines, ["carom train \\", "  --agent ddpg \\", "  --steps 10 \\", "  --from 'a --long name'"]);
    }
}
