//! The panels of the stroke: its inputs, its first contact, and the comparison with the model shot.

use ratatui::{layout::Rect, style::Style};

use crate::{
    coach::{
        ShotWords, Units, line_of_aim,
        words::{lengths_words, table_lengths},
    },
    drills::changes,
    physics::{CueInputs, LeastElevation, NoRoom, Obstacle, least_elevation},
    table::CueBall,
    terminal::{
        Capabilities, DrillAction, ModelShot,
        pages::drills::{
            AimLine, DrillsPage, ModelShotState, Turn, Watched,
            keys::EXERCISE,
            other_table_words,
            view::{percent_words, position_words},
        },
        shot::FirstImpact,
        ui::{Ui, columns, draw_lines, draw_title, pair, separator, stroke_rows, to_displayable, wrap_by},
        words::{fixed, rail_name},
    },
};

/// Panel height from which on the stroke is shown both as advice and in numbers, rows.
const ALL_ROWS: u16 = 7;

/// Draws the inputs of the current stroke, or of the watched one as it was meant: in the form of the advice, or `in_numbers`, in the
/// units that the keys change.
pub fn draw_stroke(turn: &Turn, units: Units, in_numbers: bool, area: Rect, ui: &mut Ui) {
    let cue = turn.watched().map_or_else(|| turn.raised_stroke(), |watched| watched.intended);
    // A match has two sides, so "yours" would be ambiguous.
    let title = if turn.session.is_match() { format!("Stroke of {}", turn.cue_ball) } else { "Your stroke".to_owned() };
    let inner = draw_title(title, area, ui);
    if turn.is_coach_thinking() {
        return;
    }
    let rows = if in_numbers {
        stroke_rows(&cue, units, turn.table.radius, ui.caps).to_vec()
    } else {
        advice_rows(turn, &cue, units, inner.height >= ALL_ROWS, ui.caps)
    };
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(1), ..inner };
    draw_lines(rows.into_iter().map(|(name, value)| pair(name, 7, value, ui.theme)), text, ui);
}

/// The rows of the stroke in the form of the advice: the aim as a point on the cushion's nose, and the speed in table lengths. If there is
/// room for `all` rows, the numbers follow below each.
fn advice_rows(
    turn: &Turn,
    cue: &CueInputs,
    units: Units,
    all: bool,
    caps: Capabilities,
) -> Vec<(&'static str, String)> {
    let [(_, degrees), side, height, (_, speed), elevation] = stroke_rows(cue, units, turn.table.radius, caps);
    let aim = aim_words(turn, cue, units);
    // The narrowest panel has no room for the blank.
    let aim = if all { aim } else { aim.replace(" mm", "mm") };
    let lengths = table_lengths(&turn.table, cue.speed).map_or_else(|| speed.clone(), lengths_words);
    let mut rows = vec![("aim", aim), ("", degrees), side, height, ("speed", lengths), ("", speed), elevation];
    rows.retain(|(name, _)| all || !name.is_empty());
    rows
}

/// The point on the cushion's nose at which the cue points.
fn aim_words(turn: &Turn, cue: &CueInputs, units: Units) -> String {
    let [ahead, _] = line_of_aim(&turn.table, &turn.layout, cue.phi);
    format!("{} {}", ahead.rail.name(), units.position.words(ahead.diamond, turn.table.diamond(), 2))
}

/// Draws the stroke's first contact and the lesson of the exercise; after the stroke, the comparison with the model shot. From row
/// `free_row` on the panel to the right is empty, so the text extends under it to column `end`.
pub fn draw_task(
    drills: &DrillsPage,
    turn: &Turn,
    aim_line: Option<&AimLine>,
    area: Rect,
    (free_row, end): (u16, u16),
    ui: &mut Ui,
) {
    let units = drills.units;
    let settled = turn.watched().filter(|watched| watched.is_end_shown);
    let rule = turn.exercise.rule;
    let task = if turn.is_with_coach() { "The coach's turn" } else { "Task" };
    let task = format!("{task}: {rule}");
    let title = settled.map_or(task, |watched| chances(turn, watched, ui.caps));
    let mut paragraphs = Vec::new();
    if let Some(watched) = settled {
        let model = turn.hint().map(|model_shot| to_displayable(&model_words(turn, model_shot, units), ui.caps));
        let words = model.into_iter().chain(differences(turn, watched, units, ui.caps));
        paragraphs.extend(words.map(|words| (words, ui.theme.text())));
    } else {
        // The minimum elevation comes last, because the stroke's numbers contain the elevation too.
        let mut least = None;
        if let Some(aim_line) = aim_line {
            let met = aim_line_words(aim_line, turn.cue_ball, turn.table.diamond(), units);
            // The first contact of the model shot is in the same text, so this one is called "yours".
            let met = if turn.shown_model().is_some() { format!("yours: {met}") } else { met };
            paragraphs.push((met, ui.theme.accent()));
            match least_elevation(&turn.table, &turn.layout, turn.stroke()) {
                Ok(LeastElevation { theta, over: Some(over) }) => {
                    least = Some((min_elevation_words(theta, over, turn.cue_ball, ui.caps), ui.theme.faint()));
                }
                Ok(LeastElevation { over: None, .. }) => {}
                Err(NoRoom { obstacle }) => {
                    paragraphs.push((no_room_words(obstacle, turn.cue_ball), ui.theme.warning()));
                }
            }
        }
        // In a game the balls have moved, so the lesson of the exercise no longer applies.
        let is_elsewhere = turn.session.is_game() && turn.layout != turn.exercise.layout;
        match turn.hint() {
            Some(model_shot) => {
                let hint = hint(turn, model_shot, units, ui.caps);
                paragraphs.extend(hint.into_iter().map(|words| (words, ui.theme.text())));
            }
            _ if is_elsewhere || turn.exercise.point.is_empty() => {}
            _ => paragraphs.push((turn.exercise.point.clone(), ui.theme.text())),
        }
        paragraphs.extend(least);
        paragraphs.extend(
            other_table_words(&turn.exercise.table, &turn.table.name, &drills.settings_table)
                .map(|words| (words, ui.theme.faint())),
        );
        // A hint needs the room of the positions.
        if turn.hint().is_none() {
            let places = position_words(&turn.table, &turn.layout, turn.cue_ball, units.position);
            paragraphs.push((places, ui.theme.faint()));
        }
    }
    let narrow = usize::from(area.width.saturating_sub(2));
    let wide = usize::from(end.saturating_sub(area.x + 2)).max(narrow);
    let full = usize::from(free_row.saturating_sub(area.y + 1));
    write_pages(title, &paragraphs, turn.text_page, area, |row| if row < full { narrow } else { wide }, ui);
}

/// Writes `paragraphs` below a title; `width` returns the width of each row. If they do not fit, even as running text, writes one page
/// of them: then the title shows the page and the key that turns it, and the last row ends in an ellipsis.
fn write_pages(
    title: String,
    paragraphs: &[(String, Style)],
    page: isize,
    area: Rect,
    width: impl Fn(usize) -> usize,
    ui: &mut Ui,
) {
    let rows = usize::from(area.height.saturating_sub(1)).max(1);
    let goes_on = ui.caps.pick(" …", " ...");
    let mut lines = lines_of(paragraphs, |row| width(row % rows));
    if lines.len() > rows {
        let joined = lines_of(&joined(paragraphs), |row| width(row % rows));
        lines = if joined.len() <= rows { joined } else { lines };
    }
    if lines.len() > rows {
        let sign = |row: usize| if row % rows == rows - 1 { columns(goes_on) } else { 0 };
        lines = lines_of(paragraphs, |row| width(row % rows).saturating_sub(sign(row)));
        let last = lines.len() - 1;
        lines[..last].iter_mut().skip(rows - 1).step_by(rows).for_each(|(line, _)| line.push_str(goes_on));
    }
    let pages = lines.len().div_ceil(rows).max(1);
    let page = page.rem_euclid(pages.cast_signed()).cast_unsigned();
    let key = ui.key_of(EXERCISE, &DrillAction::TurnTextPage(1));
    let title = if pages > 1 { format!("{title}{}{key} {}/{pages}", separator(ui.caps), page + 1) } else { title };
    let inner = draw_title(title, area, ui);
    let shown = lines.chunks(rows).nth(page).unwrap_or_default();
    for (((line, style), y), row) in shown.iter().zip(inner.y..inner.bottom()).zip(0..) {
        ui.buffer.set_stringn(inner.x + 1, y, line, width(row), *style);
    }
}

/// Joins successive paragraphs of the same style to running text, which takes fewer rows.
fn joined(paragraphs: &[(String, Style)]) -> Vec<(String, Style)> {
    let mut joined: Vec<(String, Style)> = Vec::new();
    for (words, style) in paragraphs {
        match joined.last_mut().filter(|(_, last)| last == style) {
            Some((before, _)) => before.extend([if before.ends_with('.') { " " } else { "; " }, words.as_str()]),
            None => joined.push((words.clone(), *style)),
        }
    }
    joined
}

/// Wraps `paragraphs` into rows, each paragraph on a new row; `width` returns the width of each row.
fn lines_of(paragraphs: &[(String, Style)], width: impl Fn(usize) -> usize) -> Vec<(String, Style)> {
    let mut lines: Vec<(String, Style)> = Vec::new();
    for (words, style) in paragraphs {
        let before = lines.len();
        lines.extend(wrap_by(words, |row| width(before + row)).into_iter().map(|line| (line, *style)));
    }
    lines
}

/// The first contact of the stroke and its distance.
fn aim_line_words(aim_line: &AimLine, cue_ball: CueBall, diamond: f64, units: Units) -> String {
    let (in_a_metre, symbol) = units.length.small();
    let way = format!("{} {symbol}", fixed(in_a_metre * aim_line.length(), 0));
    match (aim_line.meeting, aim_line.cushion) {
        (FirstImpact::Ball(hit), _) => {
            let side = hit.side().map_or_else(String::new, |side| format!(", {side} side"));
            format!("{} {:.0} % full{side}, {way}", cue_ball.names()[hit.ball], 100.0 * hit.fullness)
        }
        (_, Some(mark)) => {
            format!("{} at {}, {way}", rail_name(mark.rail), units.position.exact(mark.diamond, diamond, 1))
        }
        (_, None) => format!("meets nothing, {way}"),
    }
}

/// The minimum elevation of the cue, and the obstacle that requires it.
fn min_elevation_words(theta: f64, over: Obstacle, cue_ball: CueBall, caps: Capabilities) -> String {
    let degree = caps.pick("°", " deg");
    format!("cue at least {}{degree} up, over the {}", fixed(theta.to_degrees(), 1), obstacle_word(over, cue_ball))
}

/// The obstacle that leaves no room for the cue at all.
fn no_room_words(obstacle: Obstacle, cue_ball: CueBall) -> String {
    format!("no room for the cue: the {} is in the way", obstacle_word(obstacle, cue_ball))
}

fn obstacle_word(obstacle: Obstacle, cue_ball: CueBall) -> String {
    match obstacle {
        Obstacle::Rail(rail) => rail_name(rail).to_owned(),
        Obstacle::Ball(ball) => format!("{} ball", cue_ball.names()[ball]),
    }
}

/// The name of the model shot's source.
pub const fn advisor(model_shot: &ModelShot) -> &'static str {
    if model_shot.is_own { "model shot" } else { "coach" }
}

/// The difference of a stroke from another one in a player's words; `None` if it is too small to see or to play.
fn difference_words(turn: &Turn, stroke: &CueInputs, other: &CueInputs, units: Units) -> Option<String> {
    let of = |cue| ShotWords::of(&turn.table, &turn.layout, cue).ok();
    let is_seen = !changes(&turn.table, other, stroke, units).is_empty();
    // A stroke that cannot be played cannot be compared. Playing it shows the reason.
    let (words, others) = of(stroke).filter(|_| is_seen).zip(of(other))?;
    let parts = words.differences(&others, false, turn.cue_ball, units);
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// The success rate of the model shot, and its description.
fn model_words(turn: &Turn, model_shot: &ModelShot, units: Units) -> String {
    let advice = &model_shot.advice;
    let sentence = model_shot.shot.words.sentence(turn.cue_ball, units);
    let (made, aim) = (percent_words(advice.chance.rate), aim_words(turn, &advice.cue, units));
    format!("{} makes {made}: {sentence} Cue to {aim}.", advisor(model_shot))
}

/// The description of the model shot, and the difference of the current stroke from it.
fn hint(turn: &Turn, model_shot: &ModelShot, units: Units, caps: Capabilities) -> Vec<String> {
    let differs = || {
        let yours = difference_words(turn, &turn.raised_stroke(), &model_shot.advice.cue, units);
        format!("Yours: {}", yours.unwrap_or_else(|| "the same".to_owned()))
    };
    let yours = (!turn.is_with_coach()).then(differs);
    let model = model_words(turn, model_shot, units);
    std::iter::once(model).chain(yours).map(|words| to_displayable(&words, caps)).collect()
}

/// The success rates of the player's stroke and of the model shot.
fn chances(turn: &Turn, watched: &Watched, caps: Capabilities) -> String {
    let own = watched.chance.map_or_else(|| caps.pick("…", "...").to_owned(), percent_words);
    match &turn.model_shot {
        _ if watched.is_by_coach() => format!("The coach makes this {own}"),
        ModelShotState::Known(model_shot) => {
            format!("Yours makes {own}, {} {}", advisor(model_shot), percent_words(model_shot.advice.chance.rate))
        }
        ModelShotState::Pending | ModelShotState::Missing => format!("Yours makes {own}"),
    }
}

/// The difference of the meant stroke from the model shot, and the error that the player's hand has added.
fn differences(turn: &Turn, watched: &Watched, units: Units, caps: Capabilities) -> Vec<String> {
    let Watched { intended, outcome, .. } = watched;
    let added = difference_words(turn, &outcome.played.stroke, intended, units)
        .unwrap_or_else(|| "hardly any change".to_owned());
    if watched.is_by_coach() {
        return vec![to_displayable(&format!("the coach's hand: {added}"), caps)];
    }
    let compared = match &turn.model_shot {
        ModelShotState::Known(model_shot) => difference_words(turn, intended, &model_shot.advice.cue, units)
            .map_or_else(
                || format!("{}: almost the same", advisor(model_shot)),
                |yours| format!("yours, beside the {}: {yours}", advisor(model_shot)),
            ),
        ModelShotState::Pending => "the coach is still thinking".to_owned(),
        ModelShotState::Missing => "the coach has found no shot".to_owned(),
    };
    [compared, format!("your hand: {added}")].map(|words| to_displayable(&words, caps)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        coach::{
            RailPoint,
            words::{LengthUnit, PositionUnit, TipUnit},
        },
        simulation::Rail,
        table::Table,
        terminal::{Depth, Glyphs},
    };
    use glam::DVec2;

    #[test]
    fn positions_tip_and_speed_use_the_settings_units() {
        let table = Table::default();
        let mark = RailPoint { rail: Rail::Left, diamond: 2.04 };
        let places = vec![DVec2::ZERO, DVec2::new(0.5, 0.0)];
        let aim_line = AimLine { points: places, meeting: FirstImpact::Rail(mark.rail, None), cushion: Some(mark) };
        let other = Units { tip: TipUnit::Mm, position: PositionUnit::Mm, length: LengthUnit::Feet };
        let said = |units| aim_line_words(&aim_line, CueBall::White, table.diamond(), units);
        assert_eq!(said(Units::default()), "left rail at 2.0 diamonds, 50 cm");
        assert_eq!(said(other), "left rail at 724 mm, 20 in");
        let cue = CueInputs { a: 0.2, b: 0.0, theta: 0.0, phi: 0.0, speed: 2.0 };
        let caps = Capabilities { depth: Depth::True, glyphs: Glyphs::Letters, unicode: true };
        let told = |units| stroke_rows(&cue, units, table.radius, caps).map(|(name, value)| format!("{name} {value}"));
        assert_eq!([&told(Units::default())[1], &told(Units::default())[3]], ["left 2 tips", "speed 2.00 m/s"]);
        assert_eq!([&told(other)[1], &told(other)[3]], ["left 6.2 mm", "speed 6.56 ft/s"]);
    }

    #[test]
    fn rows_under_an_empty_panel_hold_more_text() {
        let paragraphs = [("one two three four five".to_owned(), Style::new()), ("six".to_owned(), Style::new())];
        let lines = lines_of(&paragraphs, |row| if row < 1 { 7 } else { 10 });
        let lines: Vec<_> = lines.iter().map(|(line, _)| line.as_str()).collect();
        assert_eq!(lines, ["one two", "three four", "five", "six"]);
    }

    #[test]
    fn paragraphs_without_room_are_joined() {
        let words = ["one.", "two", "three"].map(|words| (words.to_owned(), Style::new()));
        let other = ("four".to_owned(), Style::new().bold());
        let joined = joined(&[&words[..], &[other]].concat());
        let joined: Vec<_> = joined.iter().map(|(words, _)| words.as_str()).collect();
        assert_eq!(joined, ["one. two; three", "four"]);
    }

    #[test]
    fn minimum_elevation_is_shown_with_the_obstacle() {
        let caps = |unicode| Capabilities { depth: Depth::True, glyphs: Glyphs::Letters, unicode };
        let theta = 7.26_f64.to_radians();
        let over_rail = min_elevation_words(theta, Obstacle::Rail(Rail::Top), CueBall::White, caps(true));
        assert_eq!(over_rail, "cue at least 7.3° up, over the top rail");
        let over_ball = min_elevation_words(theta, Obstacle::Ball(1), CueBall::White, caps(false));
        assert_eq!(over_ball, "cue at least 7.3 deg up, over the yellow ball");
        assert_eq!(
            no_room_words(Obstacle::Ball(1), CueBall::Yellow),
            "no room for the cue: the white ball is in the way"
        );
    }
}
