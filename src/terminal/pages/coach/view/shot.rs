//! The panel of the shot in numbers: the five cue inputs, and the velocity and spin that they give the cue ball.

use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    coach::{RailPoint, line_of_aim, words::LengthUnit},
    table::{Layout, Table},
    terminal::{
        Capabilities, Proposal, Shot,
        pages::coach::view::card::chance_title,
        ui::{Theme, Ui, columns, draw_lines, draw_placeholder, draw_title},
        words::{across_word, fixed, height_word},
    },
};

/// Width from which on the panel explains the numbers, columns.
pub const WIDE: u16 = 30;
/// Width of a row in the narrowest panel, columns. The last column of the screen stays free.
const NARROW: usize = 14;
/// Width of the spin if its three numbers share a narrow row, columns.
const SPIN_WIDTH: usize = 12;

/// Draws the panel, with speeds in `unit`; without a shot it shows the lines of `empty`.
pub fn draw_shot(shot: Option<&Shot>, empty: &[&str], (table, unit): (&Table, LengthUnit), area: Rect, ui: &mut Ui) {
    let mut title = shot.map_or_else(|| vec![Span::styled("Shot", ui.theme.text())], |shot| shot_title(shot, ui));
    if let Some(shot) = shot.filter(|_| area.width >= WIDE) {
        title.push(Span::styled(format!(" {}", shot.source), ui.theme.faint()));
    }
    let inner = draw_title(title, area, ui);
    match shot {
        Some(shot) => draw_rows(shot, String::from("from the x axis"), (table, unit), inner, ui),
        None => draw_placeholder(empty, inner, ui),
    }
}

/// The title of a shot's panel: whether it makes the point.
pub fn shot_title(shot: &Shot, ui: &Ui) -> Vec<Span<'static>> {
    let (words, style) = if shot.solved { ("point", ui.theme.good()) } else { ("misses", ui.theme.warning()) };
    vec![Span::styled("Shot", ui.theme.text()), ui.dash(), Span::styled(words, style)]
}

/// Draws the panel of a proposed shot, with its success rate and the line of aim in diamonds.
pub fn draw_proposal(
    proposal: &Proposal,
    (table, unit): (&Table, LengthUnit),
    layout: &Layout,
    area: Rect,
    ui: &mut Ui,
) {
    let shot = &proposal.shot;
    let wide = area.width >= WIDE;
    let mut title = chance_title(proposal, wide, ui);
    let source = format!(" {}", shot.source);
    // The line before the title, and a blank on either side of the title.
    let taken = 3 + title.iter().map(Span::width).sum::<usize>() + source.len();
    if wide && taken <= usize::from(area.width) {
        title.push(Span::styled(source, ui.theme.faint()));
    }
    let inner = draw_title(title, area, ui);
    let mark = |mark: RailPoint| format!("{} {}", mark.rail.name(), fixed(mark.diamond, 1));
    let [ahead, behind] = line_of_aim(table, layout, shot.cue.phi).map(mark);
    let aim = format!("{behind}{}{ahead}", ui.caps.pick("→", ">"));
    draw_rows(shot, aim, (table, unit), inner, ui);
}

/// Draws the numbers; `aim` is the note on the direction.
fn draw_rows(shot: &Shot, aim: String, (table, unit): (&Table, LengthUnit), inner: Rect, ui: &mut Ui) {
    let wide = inner.width >= WIDE;
    let rows = if wide { wide_rows(shot, aim, table.radius, unit, ui.caps) } else { narrow_rows(shot, unit, ui.caps) };
    let is_low = !wide && usize::from(inner.height) < rows.len();
    let lines = if is_low {
        low_lines(shot, rows, ui.theme, ui.caps)
    } else {
        rows.into_iter().map(|row| line(row, if wide { 3 } else { 2 }, ui.theme)).collect()
    };
    let indent = u16::from(wide);
    draw_lines(lines, Rect { x: inner.x + indent, width: inner.width.saturating_sub(indent), ..inner }, ui);
}

type Row = (&'static str, String, String);

/// Formats a row whose name is `columns` wide.
fn line((name, value, note): Row, columns: usize, theme: &Theme) -> Line<'static> {
    Line::from(vec![
        Span::styled(format!("{name:<columns$}"), theme.faint()),
        Span::styled(value, theme.text()),
        Span::styled(format!(" {note}"), theme.faint()),
    ])
}

/// Merges the narrow rows into two fewer: both angles share a row, and so do the three parts of the spin.
fn low_lines(shot: &Shot, rows: Vec<Row>, theme: &Theme, caps: Capabilities) -> Vec<Line<'static>> {
    let degree = caps.pick("°", "");
    let (phi, theta) = (caps.pick("φ", "ph"), caps.pick("θ", "th"));
    let room = NARROW - columns(phi) - columns(theta);
    let [phi_angle, theta_angle] =
        [shot.cue.phi_text(1), fixed(shot.cue.theta.to_degrees(), 1)].map(|angle| angle + degree);
    // Blanks are dropped if the numbers leave no room for them.
    let phi_width = (room.saturating_sub(columns(&theta_angle) + 1)).min(6 + columns(degree));
    let gap = usize::from(columns(&phi_angle).max(phi_width) + columns(&theta_angle) < room);
    let angles = Line::from(vec![
        Span::styled(phi, theme.faint()),
        Span::styled(format!("{phi_angle:>phi_width$}"), theme.text()),
        Span::styled(format!("{:gap$}{theta}", ""), theme.faint()),
        Span::styled(theta_angle, theme.text()),
    ]);
    let w = shot.recording.impulse().spin;
    let spin = [w.x, w.y, w.z].map(|part| fixed(part, 0));
    // Without room for blanks, minus signs separate the numbers.
    let blank = |part: &String| if part.starts_with('-') { part.clone() } else { format!(" {part}") };
    let close: String = spin.iter().map(blank).collect();
    let apart = spin.join(" ");
    let spin = if apart.len() < SPIN_WIDTH { apart } else { close };
    let mut rows = rows.into_iter();
    let mut take = |count: usize| rows.by_ref().take(count).map(|row| line(row, 2, theme)).collect::<Vec<_>>();
    let tip = take(2);
    take(2);
    let speeds = take(2);
    let spin = (caps.pick("ω0", "w0"), format!("{spin:>SPIN_WIDTH$}"), String::new());
    tip.into_iter().chain([angles]).chain(speeds).chain([line(spin, 2, theme)]).collect()
}

fn wide_rows(shot: &Shot, aim: String, radius: f64, unit: LengthUnit, caps: Capabilities) -> Vec<Row> {
    let cue = &shot.cue;
    let (factor, symbol) = unit.speed();
    let offset = |value: f64, word: &str| match value {
        0.0 => "R, at the centre".to_owned(),
        _ => format!("R, {} mm {word}", fixed((1000.0 * radius * value).abs(), 1)),
    };
    let degree = caps.pick("°", " deg");
    let (v, w) = (factor * shot.recording.impulse().velocity, shot.recording.impulse().spin);
    let value = |text: String| format!("{text:>7}");
    let elevation = fixed(cue.theta.to_degrees(), 1);
    let words = if elevation == "0.0" { "level cue" } else { "cue raised" };
    vec![
        ("a", value(fixed(cue.a, 3)), offset(cue.a, across_word(cue.a))),
        ("b", value(fixed(cue.b, 3)), offset(cue.b, height_word(cue.b))),
        (caps.pick("θ", "th"), value(elevation + degree), words.into()),
        (caps.pick("φ", "ph"), value(cue.phi_text(2) + caps.pick("°", "")), aim),
        ("V", value(fixed(factor * cue.speed, 2)), format!("{symbol}, the cue")),
        ("V0", format!("{:>6} {:>6}", fixed(v.x, 3), fixed(v.y, 3)), symbol.into()),
        (
            caps.pick("ω0", "w0"),
            format!("{:>6} {:>6} {:>6}", fixed(w.x, 1), fixed(w.y, 1), fixed(w.z, 1)),
            "rad/s".into(),
        ),
    ]
}

fn narrow_rows(shot: &Shot, unit: LengthUnit, caps: Capabilities) -> Vec<Row> {
    let cue = &shot.cue;
    let (factor, symbol) = unit.speed();
    let degree = caps.pick("°", " deg");
    let (v, w) = (factor * shot.recording.impulse().velocity, shot.recording.impulse().spin);
    let none = String::new;
    vec![
        ("a", format!("{:>6}", fixed(cue.a, 3)), across_word(cue.a).into()),
        ("b", format!("{:>6}", fixed(cue.b, 3)), height_word(cue.b).into()),
        (caps.pick("θ", "th"), format!("{:>6}", fixed(cue.theta.to_degrees(), 1)) + degree, none()),
        (caps.pick("φ", "ph"), format!("{:>6}", cue.phi_text(1)) + degree, none()),
        ("V", format!("{:>6}", fixed(factor * cue.speed, 2)), symbol.into()),
        ("V0", format!("{:>6}{:>6}", fixed(v.x, 2), fixed(v.y, 2)), none()),
        (caps.pick("ω0", "w0"), format!("{:>6}{:>6}", fixed(w.x, 0), fixed(w.y, 0)), none()),
        ("", format!("{:>6}", fixed(w.z, 0)), "rad/s".into()),
    ]
}
