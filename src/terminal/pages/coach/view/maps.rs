//! Maps of the shot's outcome: over the tip position on the cue ball, and over direction and speed around the stroke.

use glam::DVec2;
use ratatui::{
    layout::Rect,
    text::{Line, Span},
};

use crate::{
    coach::{Map, Outcome, Skill, words::LengthUnit},
    game::Rule,
    physics::CueInputs,
    table::Table,
    terminal::{
        Glyphs,
        ui::{
            Ink, RoundSpot, Ui, columns, draw_field, draw_lines, draw_title, face_in, field::Mark, spot_mark,
            write_right,
        },
        words::fixed,
    },
};

/// All outcomes in the order of the theme's colours, with their letters for terminals without block characters, and in words.
const OUTCOMES: [(Outcome, char, &str); 5] = [
    (Outcome::NoStroke, ' ', "no stroke"),
    (Outcome::NoBall, '.', "no ball"),
    (Outcome::OneBall, '-', "one ball"),
    (Outcome::TooFewCushions, '=', "too few cushions"),
    (Outcome::Point, '#', "point"),
];

/// Priorities of marks that share a cell (see [`Ink`]): the stroke and the player's errors hide the outcomes.
const OUTCOME_WEIGHT: u8 = 3;
const ERRORS_WEIGHT: u8 = 7;
const STROKE_WEIGHT: u8 = 16;

/// Radius of the mark of the stroke in each map, as a fraction of half the map.
const TIP_RADIUS: f64 = 0.12;
const STROKE_RADIUS: f64 = 0.07;

/// Size of the outline of the player's errors, in standard errors: 86 of 100 strokes lie inside in both inputs.
const OUTLINE: f64 = 2.0;

/// Half the line width of the outline, as a fraction of its radius: one or two sub-pixels, so that the line has no gaps.
const LINE: f64 = 0.09;
const COARSE_LINE: f64 = 0.2;

/// Panel width from which on the speeds are written next to the map, and the width of these labels, columns.
const WIDE: u16 = 24;
const GUTTER: u16 = 6;

/// What a point of a map shows.
#[derive(Clone, Copy, PartialEq)]
enum Sign {
    Outcome(Outcome),
    /// The outline of the player's errors.
    Errors,
    /// The stroke itself.
    Stroke,
}

/// Draws the outcomes over the part of the cue ball's face where the tip does not slip off, as the shooter sees it, and the tip
/// position. The title shows the extent of the map in `unit`.
pub fn draw_tip_map(map: &Map, cue: &CueInputs, table: &Table, unit: LengthUnit, area: Rect, ui: &mut Ui) {
    let reach = map.columns.last().copied().unwrap_or_default();
    let (factor, symbol) = map.across.display_unit(unit);
    let decimals = usize::from(unit == LengthUnit::Feet);
    let title = format!("Tip {}{} {symbol}", ui.caps.pick("±", "+-"), fixed(factor * reach, decimals));
    let inner = draw_title(title, area, ui);
    // Offset of the tip from the centre of the map, as a fraction of half the map; positive `a` is on the left.
    let share = 1e3 * table.radius / reach;
    let face = face_in(inner, ui.caps);
    let tip = RoundSpot::new(share * DVec2::new(-cue.a, cue.b), TIP_RADIUS, face, ui.caps);
    draw_signs(face, ui, |x, y, _| match () {
        () if x.hypot(y) > 1.0 => None,
        () if tip.covers(x, y) => Some(Sign::Stroke),
        () => Some(Sign::Outcome(outcome_at(map, -x, y))),
    });
}

/// Draws the outcomes over direction (positive to the left, as the shooter sees it) and speed (upwards), with the outline of the
/// player's errors around the stroke in the centre. Speeds are shown in `unit`. If `in_letters`, the axes have the thesis' letters.
pub fn draw_aim_map(map: &Map, skill: Skill, (unit, in_letters): (LengthUnit, bool), area: Rect, ui: &mut Ui) {
    let (factor, symbol) = map.up.display_unit(unit);
    let degree = ui.caps.pick("°", "");
    let [aim, speed] = if in_letters { [ui.caps.pick("φ", "ph"), "V"] } else { ["aim", "speed"] };
    let wide = area.width >= WIDE;
    let span = |values: &[f64]| values.last().copied().unwrap_or_default();
    let plus_minus = ui.caps.pick("±", "+-");
    // A narrow map names the speed in the title and the direction below.
    let title = if wide {
        vec![Span::styled(format!("Map: {aim}, {speed}"), ui.theme.text())]
    } else {
        let reach = format!(" {plus_minus}{}", fixed(factor * span(&map.rows), 1));
        vec![Span::styled(speed, ui.theme.text()), Span::styled(reach, ui.theme.faint())]
    };
    let inner = draw_title(title, area, ui);
    if inner.height < 2 {
        return;
    }
    let gutter = if wide { GUTTER } else { 0 };
    let plot = Rect { x: inner.x + gutter, width: inner.width - gutter, height: inner.height - 1, ..inner };
    let (across, up) = (span(&map.columns), span(&map.rows));
    if wide {
        let middle = plot.y + plot.height / 2;
        for (row, text) in [
            (plot.y, format!("+{}", fixed(factor * up, 2))),
            (middle, symbol.to_owned()),
            (plot.bottom() - 1, format!("-{}", fixed(factor * up, 2))),
        ] {
            write_right(ui.buffer, inner.x, plot.x - 1, row, &text, ui.theme.faint());
        }
    }
    let axis = plot.bottom();
    let across_words = fixed(across, 2);
    let middle = if wide { aim.to_owned() } else { format!("{aim} {plus_minus}{across_words}{degree}") };
    let indent = plot.width.saturating_sub(columns(&middle) as u16) / 2;
    ui.buffer.set_stringn(plot.x + indent, axis, middle, usize::from(plot.width), ui.theme.faint());
    if wide {
        ui.buffer.set_string(plot.x, axis, format!("+{across_words}{degree}"), ui.theme.faint());
        write_right(ui.buffer, plot.x, plot.right(), axis, &format!("-{across_words}{degree}"), ui.theme.faint());
    }
    let line = if ui.caps.glyphs == Glyphs::Half { COARSE_LINE } else { LINE };
    let errors = (OUTLINE * skill.phi.to_degrees() / across, OUTLINE * skill.speed / up);
    draw_signs(plot, ui, |x, y, cell| {
        let is_stroke = if cell > 0.0 {
            x.abs() <= 1.0 / f64::from(plot.width) && y.abs() <= 1.0 / f64::from(plot.height)
        } else {
            // The mark is a circle on the screen, whatever the shape of the panel is.
            let aspect = f64::from(plot.width) / (2.0 * f64::from(plot.height));
            (x * aspect.max(1.0)).hypot(y / aspect.min(1.0)) <= STROKE_RADIUS.max(1.0 / f64::from(plot.height) / 2.0)
        };
        let from_errors = (x / errors.0).hypot(y / errors.1);
        match () {
            () if is_stroke => Some(Sign::Stroke),
            () if cell == 0.0 && (from_errors - 1.0).abs() <= line => Some(Sign::Errors),
            () => Some(Sign::Outcome(outcome_at(map, -x, y))),
        }
    });
}

/// Draws the legend: the meaning of the colours or letters of these maps under `rule`.
pub fn draw_legend(maps: [&Map; 2], rule: Rule, area: Rect, ui: &mut Ui) {
    let inner = draw_title("The maps", area, ui);
    let letters = ui.caps.glyphs == Glyphs::Letters;
    let mut lines = vec![Line::default()];
    let mut add = |spans: [Span<'static>; 2]| {
        let width: usize = spans.iter().map(Span::width).sum();
        if lines.last().is_some_and(|line| line.width() + width + 1 > usize::from(inner.width)) {
            lines.push(Line::default());
        }
        if let Some(line) = lines.last_mut() {
            line.spans.extend(spans);
        }
    };
    for (n, (outcome, letter, words)) in OUTCOMES.into_iter().enumerate().rev() {
        // The blank draws nothing, so it needs no legend.
        if letters && letter == ' ' {
            continue;
        }
        let Some(words) = words_by(rule, outcome, words, maps) else { continue };
        let (sign, color) = match ui.theme.outcomes[n] {
            color if letters => (letter, color),
            ground if ground == ui.theme.background => ('□', ui.theme.rule),
            color => ('■', color),
        };
        add([
            Span::styled(format!(" {sign}"), ui.theme.text().fg(color)),
            Span::styled(format!(" {words}"), ui.theme.faint()),
        ]);
    }
    let stroke = if letters { " X" } else { " ●" };
    add([Span::styled(stroke, ui.theme.text().fg(ui.theme.tip)), Span::styled(" the stroke", ui.theme.faint())]);
    if !letters {
        add([Span::styled(" ○", ui.theme.text()), Span::styled(" twice your errors", ui.theme.faint())]);
    }
    draw_lines(lines, inner, ui);
}

/// The words for an outcome in the legend of these maps; `None` if the outcome does not exist under `rule`. If no cushion is needed,
/// a shot that hits both balls makes the point unless a ball leaves the table, which few maps show.
fn words_by(rule: Rule, outcome: Outcome, words: &'static str, maps: [&Map; 2]) -> Option<&'static str> {
    if outcome != Outcome::TooFewCushions || rule.cushions() > 0 {
        return Some(words);
    }
    let is_seen = maps.iter().any(|map| map.outcomes.iter().flatten().any(|one| *one == outcome));
    is_seen.then_some("foul")
}

/// The outcome at a point of the map; `x` and `y` go from -1 to 1 at its ends.
fn outcome_at(map: &Map, x: f64, y: f64) -> Outcome {
    let index = |at: f64, count: usize| {
        let place = 0.5 * (at + 1.0) * (count as f64 - 1.0);
        (place.round().max(0.0) as usize).min(count.saturating_sub(1))
    };
    map.outcomes[index(y, map.rows.len())][index(x, map.columns.len())]
}

/// Paints `area` with the marks that `sign` returns for each point; its arguments are those of [`draw_field`].
fn draw_signs(area: Rect, ui: &mut Ui, sign: impl Fn(f64, f64, f64) -> Option<Sign>) {
    let theme = ui.theme;
    draw_field(area, theme.background, ui, |x, y, cell| {
        Some(match sign(x, y, cell)? {
            Sign::Stroke => spot_mark(theme, STROKE_WEIGHT),
            // With letters there is no outline.
            Sign::Errors => Mark { ink: Ink { color: theme.outline, weight: ERRORS_WEIGHT }, ..spot_mark(theme, 0) },
            Sign::Outcome(outcome) => {
                let index = OUTCOMES.iter().position(|(one, ..)| *one == outcome).unwrap_or_default();
                let color = theme.outcomes[index];
                let ink = Ink { color, weight: OUTCOME_WEIGHT };
                Mark { ink, letter: OUTCOMES[index].1, style: theme.text().fg(color) }
            }
        })
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coach::Input;

    /// A map of made points with these outcomes in its corners, the lower ones first.
    fn cornered([[one, two], [three, four]]: [[Outcome; 2]; 2]) -> Map {
        let row = |one, other| vec![one, Outcome::Point, other];
        Map {
            across: Input::Side,
            up: Input::Height,
            columns: vec![-1.0, 0.0, 1.0],
            rows: vec![-1.0, 0.0, 1.0],
            outcomes: vec![row(one, two), row(Outcome::Point, Outcome::Point), row(three, four)],
        }
    }

    #[test]
    fn legend_omits_outcomes_unknown_to_the_rule() {
        use Outcome::{NoBall, OneBall, TooFewCushions};
        let [plain, foul] = [OneBall, TooFewCushions].map(|last| cornered([[NoBall, OneBall], [NoBall, last]]));
        let said = |rule, maps| words_by(rule, TooFewCushions, "too few cushions", maps);
        assert_eq!(said(Rule::StraightRail, [&plain, &plain]), None);
        assert_eq!(said(Rule::StraightRail, [&plain, &foul]), Some("foul"));
        for rule in [Rule::OneCushion, Rule::ThreeCushion] {
            assert_eq!(said(rule, [&plain, &plain]), Some("too few cushions"));
        }
        assert_eq!(words_by(Rule::StraightRail, OneBall, "one ball", [&plain, &plain]), Some("one ball"));
    }

    #[test]
    fn map_corners_are_the_ends_of_its_ranges() {
        use Outcome::{NoBall, NoStroke, OneBall, Point, TooFewCushions};
        let map = cornered([[NoStroke, NoBall], [OneBall, TooFewCushions]]);
        let corners =
            [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (0.1, -0.2)].map(|(x, y)| outcome_at(&map, x, y));
        assert_eq!(corners, [NoStroke, NoBall, OneBall, TooFewCushions, Point]);
    }
}
