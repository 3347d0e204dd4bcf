//! The panel "Plan": this shot, where the balls stop, and the next shot; and the marks of the plan on the table.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    coach::words::LengthUnit,
    table::BALLS,
    terminal::{
        Glyphs, Proposal,
        pages::coach::{Choice, view::chances::shot_summary},
        ui::{Spot, Theme, Ui, draw_lines, draw_placeholder, draw_title, wrap},
        words::{fixed, percent},
    },
};

/// Sign of the cue ball's next path on terminals that draw only letters.
const WAY_LETTER: char = '*';

/// Width of the rows' names, columns.
const NAMES: u16 = 6;

/// Number of rows.
const ROWS: usize = 3;

/// Explanation of the distances in the row "stop".
const SPREAD_WORDS: &str = "half of the made shots stop this close";

/// Text for a shot whose background analysis has failed.
pub const FAILED: &str = "could not be computed";

/// Draws the panel; without a shot it shows the text `empty`.
pub fn draw_plan(choice: Option<&Choice>, unit: LengthUnit, empty: &str, area: Rect, ui: &mut Ui) {
    let mut title = vec![Span::styled("Plan", ui.theme.text())];
    if let Some(next) = choice.and_then(|choice| choice.proposal.next) {
        title.push(ui.dash());
        title.push(Span::styled(format!("next point on average {} %", percent(next)), ui.theme.text()));
    }
    let inner = draw_title(title, area, ui);
    let Some(choice) = choice else { return draw_placeholder(&[empty], inner, ui) };
    let room = usize::from(inner.width.saturating_sub(NAMES));
    let explained = wrap(SPREAD_WORDS, usize::from(inner.width.saturating_sub(2)));
    let has_room = usize::from(inner.height) >= ROWS + explained.len();
    let rows = [
        ("now", shot_words(&choice.proposal, room, ui)),
        stop_words(choice, unit, has_room, ui.theme),
        ("next", next_words(choice, room, ui)),
    ];
    let mut lines: Vec<Line> = rows
        .into_iter()
        .map(|(name, words)| {
            Line::from(vec![
                Span::styled(format!(" {name:<5}"), ui.theme.faint()),
                Span::styled(words, ui.theme.text()),
            ])
        })
        .collect();
    if choice.study.is_some() && has_room {
        lines.extend(explained.into_iter().map(|words| Line::styled(format!(" {words}"), ui.theme.faint())));
    }
    if choice.next.is_some() {
        let sign = if ui.caps.glyphs == Glyphs::Letters { WAY_LETTER } else { '•' };
        lines.push(Line::from(vec![
            Span::raw(" "),
            Span::styled(sign.to_string(), ui.theme.text().fg(ui.theme.next_path_sign)),
            Span::styled(" the cue ball's way then; n goes on", ui.theme.faint()),
        ]));
    }
    draw_lines(lines, inner, ui);
}

fn shot_words(proposal: &Proposal, room: usize, ui: &Ui) -> String {
    let chance = proposal.made.map_or("?".to_owned(), |made| percent(made.rate));
    let so_far = if proposal.is_early { "so far " } else { "" };
    let chance = format!("{so_far}{chance} % ");
    let sort = shot_summary(proposal, false, room.saturating_sub(chance.len()), ui);
    chance + &sort
}

/// The row "stop": the distance from the planned positions within which each ball stops in half of the attempts that make the point.
/// Unless a line below explains this (`is_explained`), the row itself says "half within" and names the balls by letters.
fn stop_words(choice: &Choice, unit: LengthUnit, is_explained: bool, theme: &Theme) -> (&'static str, String) {
    let (in_a_metre, symbol) = unit.small();
    let Some(study) = &choice.study else {
        let words = if choice.is_analysed { FAILED } else { "being tried" };
        return ("stop", words.to_owned());
    };
    let meant = choice.proposal.shot.recording.final_layout();
    let spread = |ball: usize| Some(in_a_metre * study.scatter.spread(ball, meant.balls[ball])?);
    let name = |ball: usize| {
        if is_explained { theme.names()[ball].to_owned() } else { theme.letters()[ball].to_string() }
    };
    let words: Vec<_> =
        (0..BALLS).filter_map(|ball| Some(format!("{} {}", name(ball), fixed(spread(ball)?, 0)))).collect();
    let places = format!("{} {symbol}", words.join(", "));
    match () {
        () if words.is_empty() => ("stop", "no attempt made the point".to_owned()),
        () if is_explained => ("stop", places),
        () => ("stop", format!("half within {places}")),
    }
}

fn next_words(choice: &Choice, room: usize, ui: &Ui) -> String {
    match (&choice.next, choice.is_analysed) {
        (Some(next), _) => next.proposals.first().map_or_else(String::new, |proposal| shot_words(proposal, room, ui)),
        (None, false) => "being looked for".to_owned(),
        (None, true) if choice.study.is_none() => FAILED.to_owned(),
        (None, true) => "none".to_owned(),
    }
}

/// The marks of the plan on the table: where the balls stop in many attempts, and the path of the cue ball in the next shot.
pub fn plan_spots(choice: &Choice, theme: &Theme) -> Vec<Spot> {
    let ends = choice.study.iter().flat_map(|study| &study.scatter.ends);
    let cloud = ends.flat_map(|end| {
        let spot = |ball: usize| Spot {
            position: end.balls[ball],
            is_ball: false,
            color: theme.balls[ball],
            letter: theme.letters()[ball].to_ascii_lowercase(),
        };
        (0..BALLS).map(spot)
    });
    let next = choice.next.as_ref().and_then(|next| next.proposals.first());
    let way = next.into_iter().flat_map(|next| {
        let spot = |place, is_ball| Spot { position: place, is_ball, color: theme.next_path, letter: WAY_LETTER };
        let dots = next.shot.paths[0].iter().step_by(2).enumerate();
        // The path through the air is dashed, as it is when that shot itself is displayed.
        let dots = dots.filter(|(number, dot)| !dot.is_aloft() || number % 2 == 0);
        let dots = dots.map(move |(_, dot)| spot(dot.position, false));
        dots.chain(next.shot.words.first.map(|contact| spot(contact.place, true)))
    });
    cloud.chain(way).collect()
}
