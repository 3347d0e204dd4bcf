//! The view of the lesson on a diamond system or a parallel shift: numbers at the rails, path of the ball, and arithmetic.

use glam::DVec2;
use ratatui::{
    layout::{Margin, Rect},
    style::{Color, Modifier},
    text::Span,
};

use crate::{
    coach::{
        systems::{Applied, DIAMOND_SETBACK, Guide, metres, number},
        words::capitalize,
    },
    table::Table,
    terminal::{
        Glyphs, Mapping,
        pages::coach::lesson::Lesson,
        ui::{Spot, Ui, columns, draw_title, wrap, write_paragraphs},
        words::fixed,
    },
};

/// Distance between the dots of the path, m.
const DOTS: f64 = 0.05;

/// Character of the path if only letters are drawn, unlike those of the balls' paths.
const LETTER: char = '~';

/// The ball's path as dots of this colour, starting at the diamond behind the ball.
pub fn lesson_spots(lesson: &Lesson, color: Color) -> Vec<Spot> {
    let dot = |place: DVec2| Spot { position: place, is_ball: false, color, letter: LETTER };
    let legs = lesson.path.windows(2).flat_map(|leg| {
        let way = leg[1] - leg[0];
        let count = (way.length() / DOTS).ceil().max(1.0) as u32;
        let from = leg[0];
        (0..count).map(move |step| from + f64::from(step) / f64::from(count) * way)
    });
    legs.chain(lesson.path.last().copied()).map(dot).collect()
}

/// Writes the numbers: those of the start and the first cushion on the rails, those of the third cushion on the cloth next to it.
pub fn draw_numbers(lesson: &Lesson, table: &Table, mapping: &Mapping, ui: &mut Ui) {
    let (on_rail, on_cloth) = match ui.caps.glyphs {
        Glyphs::Letters => (ui.theme.text(), ui.theme.accent()),
        _ => (ui.theme.text().fg(ui.theme.sight).bg(ui.theme.wood), ui.theme.text().fg(ui.mark()).bg(ui.theme.cloth)),
    };
    let [on_rail, on_cloth] = [on_rail, on_cloth].map(|style| style.add_modifier(Modifier::BOLD));
    for (text, place, is_inside) in labels(&lesson.guide) {
        let style = if is_inside { on_cloth } else { on_rail };
        write_at(&text, place, is_inside, table, mapping, style, ui);
    }
}

/// The numbers, their positions along the edge in diamonds, and whether they are written on the cloth.
fn labels(guide: &Guide) -> Vec<(String, DVec2, bool)> {
    match guide {
        Guide::System(Applied { system, mirror, .. }) => {
            let labels = system.labels();
            let on_rails = labels.start.iter().chain(&labels.first).map(|label| (label, false));
            let all = on_rails.chain(labels.third.iter().map(|label| (label, true)));
            all.map(|((value, place), inside)| (number(*system, *value), mirror.apply(*place), inside)).collect()
        }
        Guide::Shift(shift) => {
            let [first, third] = shift.ends();
            vec![(fixed(shift.diamond, 0), first, false), (fixed(shift.arrival, 1), third, true)]
        }
    }
}

/// Writes a number at a position along the edge, in diamonds: on the rail or on the cloth next to it.
fn write_at(
    text: &str,
    place: DVec2,
    is_inside: bool,
    table: &Table,
    mapping: &Mapping,
    style: ratatui::style::Style,
    ui: &mut Ui,
) {
    let (bed, width) = (mapping.bed, columns(text) as u16);
    let inside = place.clamp(DVec2::ZERO, DVec2::new(8.0, 4.0));
    let (column, row) = mapping.to_cell(metres(table, inside));
    let is_above = place.y > 4.0 - 0.5 * DIAMOND_SETBACK;
    let is_below = place.y < 0.5 * DIAMOND_SETBACK;
    let is_closed = place.x < 0.5 * DIAMOND_SETBACK;
    let outer = mapping.outer();
    let (x, y) = if (is_above || is_below) && (0.0..=8.0).contains(&place.x) {
        let y = match (is_above, is_inside) {
            (true, true) => bed.y,
            (true, false) => bed.y - 1,
            (false, true) => bed.bottom() - 1,
            (false, false) => bed.bottom(),
        };
        (column.saturating_sub(width / 2).clamp(bed.x, bed.right().saturating_sub(width)), y)
    } else {
        // A number in the corner is written at the junction of both rails.
        let y = match () {
            () if is_below && !is_inside => bed.bottom(),
            () if is_above && !is_inside => bed.y - 1,
            () => row,
        };
        let x = match (is_closed, is_inside) {
            (true, true) => bed.x,
            (true, false) => outer.x,
            (false, true) => bed.right().saturating_sub(width),
            (false, false) => outer.right().saturating_sub(width.max(2)),
        };
        (x, y)
    };
    ui.buffer.set_string(x, y, text, style);
}

/// Draws the panel: the arithmetic, shortened if room is short, then the explanation. Before an example it states that no system
/// describes the shot, if `has_no_system`. A sentence without room ends in an ellipsis.
pub fn draw_lesson(lesson: &Lesson, has_no_system: bool, area: Rect, ui: &mut Ui) {
    let name = match &lesson.guide {
        Guide::System(applied) => applied.system.name(),
        Guide::Shift(_) => "Parallel shift",
    };
    let whose = if lesson.is_of_shot { "for this shot" } else { "an example" };
    let title = vec![Span::styled(name, ui.theme.good()), ui.dash(), Span::styled(whose, ui.theme.text())];
    let inner = draw_title(title, area, ui);
    let inner = inner.inner(Margin::new(1, 0));
    let rows = |sentences: &[(String, bool)]| -> usize {
        let main = sentences.iter().filter(|(_, is_main)| *is_main);
        main.map(|(words, _)| wrap(words, usize::from(inner.width)).len()).sum()
    };
    let mut sentences = sentences(&lesson.guide);
    if has_no_system && !lesson.is_of_shot {
        sentences.insert(0, ("No system describes this shot.".to_owned(), true));
    }
    sentences.retain(|(words, _)| !words.is_empty());
    if let Guide::Shift(shift) = &lesson.guide
        && rows(&sentences) > usize::from(inner.height)
    {
        sentences.retain(|(_, is_main)| !is_main);
        sentences.insert(0, (capitalize(&shift.brief()), true));
    }
    let style = |is_main| if is_main { ui.theme.text() } else { ui.theme.faint() };
    let paragraphs: Vec<_> = sentences.into_iter().map(|(words, is_main)| (words, style(is_main))).collect();
    write_paragraphs(&paragraphs, inner, ui);
}

/// The sentences of the panel, and whether each is part of the arithmetic. A sentence may be empty.
fn sentences(guide: &Guide) -> Vec<(String, bool)> {
    let applied = match guide {
        Guide::System(applied) => applied,
        Guide::Shift(shift) => {
            return vec![
                (capitalize(&shift.description()), true),
                (capitalize(&shift.correction().unwrap_or_default()), true),
                ("The dots are the line to the diamond.".to_owned(), false),
                (shift.rule().to_owned(), false),
                ("On the rail: the diamond. On the cloth: where the dots reach the third cushion.".to_owned(), false),
            ];
        }
    };
    let system = applied.system;
    let side = if system.is_running() { "running side" } else { "no side" };
    let own = applied.shot_first.map(|first| format!("this shot, with its side, at {}", number(system, first)));
    vec![
        (format!("{}: aim at {} on the wood", applied.arithmetic(), applied.aim()), true),
        (applied.correction(), true),
        (own.unwrap_or_default(), true),
        (format!("{}; {side}", system.track()), false),
        (system.rule().to_owned(), false),
        ("Numbers: start and first on the rails, third on the cloth.".to_owned(), false),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coach::systems::{System, diamonds};

    #[test]
    fn path_runs_from_diamond_behind_to_third_cushion() {
        let table = Table::default();
        let applied = crate::coach::systems::Applied::example(System::Corner5, &table).unwrap();
        let guide = Guide::System(applied);
        let lesson = Lesson { path: guide.path(&table), guide, is_of_shot: false, table: table.clone().into() };
        let spots = lesson_spots(&lesson, Color::Reset);
        let [first, last] = [spots[0].position, spots[spots.len() - 1].position].map(|place| diamonds(&table, place));
        assert!(first.distance(DVec2::new(8.225, -0.225)) < 0.01, "{first}");
        assert!(last.y < 0.2 && (last.x - 2.9).abs() < 0.5, "{last}");
    }
}
