//! The panels of the stroke: how it is set, what it meets first, and how it compares with the model shot.

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
            view::{percent_words, places_words},
        },
        shot::Meeting,
        ui::{Ui, columns, draw_lines, draw_title, pair, separator, spell, stroke_rows, wrap_by},
        words::{fixed, rail_name},
    },
};

/// Rows in which the stroke is told in both ways.
const ALL_ROWS: u16 = 7;

/// Draws how the stroke is set, or was meant: as advice is told, or `in_numbers` as the keys change it.
pub fn draw_stroke(turn: &Turn, units: Units, in_numbers: bool, area: Rect, ui: &mut Ui) {
    let cue = turn.watched().map_or_else(|| turn.raised_stroke(), |watched| watched.meant);
    // In a match there are two sides.
    let title = if turn.session.is_match() { format!("Stroke of {}", turn.cue_ball) } else { "Your stroke".to_owned() };
    let inner = draw_title(title, area, ui);
    if turn.is_coach_thinking() {
        return;
    }
    let rows = if in_numbers {
        stroke_rows(&cue, units, turn.table.radius, ui.caps).to_vec()
    } else {
        told_rows(turn, &cue, units, inner.height >= ALL_ROWS, ui.caps)
    };
    let text = Rect { x: inner.x + 1, width: inner.width.saturating_sub(1), ..inner };
    draw_lines(rows.into_iter().map(|(name, value)| pair(name, 7, value, ui.theme)), text, ui);
}

/// The aim as the place of the cushion's nose to which the cue points, and the speed in table lengths, as advice tells both; where
/// there is room for `all` with the numbers below each.
fn told_rows(turn: &Turn, cue: &CueInputs, units: Units, all: bool, caps: Capabilities) -> Vec<(&'static str, String)> {
    let [(_, degrees), side, height, (_, speed), elevation] = stroke_rows(cue, units, turn.table.radius, caps);
    let aim = aim_words(turn, cue, units);
    // The narrowest panel has no column for the blank.
    let aim = if all { aim } else { aim.replace(" mm", "mm") };
    let lengths = table_lengths(&turn.table, cue.speed).map_or_else(|| speed.clone(), lengths_words);
    let mut rows = vec![("aim", aim), ("", degrees), side, height, ("speed", lengths), ("", speed), elevation];
    rows.retain(|(name, _)| all || !name.is_empty());
    rows
}

/// The place of the cushion's nose to which the cue points.
fn aim_words(turn: &Turn, cue: &CueInputs, units: Units) -> String {
    let [ahead, _] = line_of_aim(&turn.table, &turn.layout, cue.phi);
    format!("{} {}", ahead.rail.name(), units.position.words(ahead.diamond, turn.table.diamond(), 2))
}

/// Draws what the stroke meets first and what is to be learnt; once it was played, how it compares. Below `beside`, the row from which
/// on the panel to the right is empty, the words run under it to the column `end`.
pub fn draw_task(
    drills: &DrillsPage,
    turn: &Turn,
    aim_line: Option<&AimLine>,
    area: Rect,
    (beside, end): (u16, u16),
    ui: &mut Ui,
) {
    let units = drills.units;
    let settled = turn.watched().filter(|watched| watched.is_settled);
    let rule = turn.exercise.rule;
    let task = if turn.is_with_coach() { "The coach's turn" } else { "Task" };
    let task = format!("{task}: {rule}");
    let title = settled.map_or(task, |watched| chances(turn, watched, ui.caps));
    let mut paragraphs = Vec::new();
    if let Some(watched) = settled {
        let model = turn.hint().map(|model_shot| spell(&model_words(turn, model_shot, units), ui.caps));
        let words = model.into_iter().chain(differences(turn, watched, units, ui.caps));
        paragraphs.extend(words.map(|words| (words, ui.theme.text())));
    } else {
        // The stroke's numbers tell it too: it comes last.
        let mut least = None;
        if let Some(aim_line) = aim_line {
            let met = aim_line_words(aim_line, turn.cue_ball, turn.table.diamond(), units);
            // What the model shot meets stands beside it.
            let met = if turn.shown_model().is_some() { format!("yours: {met}") } else { met };
            paragraphs.push((met, ui.theme.accent()));
            match least_elevation(&turn.table, &turn.layout, turn.stroke()) {
                Ok(LeastElevation { theta, over: Some(over) }) => {
                    least = Some((least_words(theta, over, turn.cue_ball, ui.caps), ui.theme.faint()));
                }
                Ok(LeastElevation { over: None, .. }) => {}
                Err(NoRoom { obstacle }) => {
                    paragraphs.push((no_room_words(obstacle, turn.cue_ball), ui.theme.warning()));
                }
            }
        }
        // In a game the balls have gone elsewhere, and what was to be learnt with them.
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
            other_table_words(&turn.exercise.table, &turn.table.name, &drills.of_settings)
                .map(|words| (words, ui.theme.faint())),
        );
        // The room is the hint's while that is shown.
        if turn.hint().is_none() {
            let places = places_words(&turn.table, &turn.layout, turn.cue_ball, units.position);
            paragraphs.push((places, ui.theme.faint()));
        }
    }
    let narrow = usize::from(area.width.saturating_sub(2));
    let wide = usize::from(end.saturating_sub(area.x + 2)).max(narrow);
    let full = usize::from(beside.saturating_sub(area.y + 1));
    write_pages(title, &paragraphs, turn.text_page, area, |row| if row < full { narrow } else { wide }, ui);
}

/// Writes `paragraphs` below a title, each row as wide as `width` says; where they have no room, either one behind the other, one page
/// of them: the title says which and how to turn it, and the last row that it goes on.
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
    let key = ui.key_of(EXERCISE, &DrillAction::TurnText(1));
    let title = if pages > 1 { format!("{title}{}{key} {}/{pages}", separator(ui.caps), page + 1) } else { title };
    let inner = draw_title(title, area, ui);
    let shown = lines.chunks(rows).nth(page).unwrap_or_default();
    for (((line, style), y), row) in shown.iter().zip(inner.y..inner.bottom()).zip(0..) {
        ui.buffer.set_stringn(inner.x + 1, y, line, width(row), *style);
    }
}

/// Paragraphs of one style one behind the other, which takes fewer rows.
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

/// The words of `paragraphs` in rows as wide as `width` says, each paragraph from a new row.
fn lines_of(paragraphs: &[(String, Style)], width: impl Fn(usize) -> usize) -> Vec<(String, Style)> {
    let mut lines: Vec<(String, Style)> = Vec::new();
    for (words, style) in paragraphs {
        let before = lines.len();
        lines.extend(wrap_by(words, |row| width(before + row)).into_iter().map(|line| (line, *style)));
    }
    lines
}

/// What the stroke meets first, and how far away.
fn aim_line_words(aim_line: &AimLine, cue_ball: CueBall, diamond: f64, units: Units) -> String {
    let (in_a_metre, symbol) = units.length.small();
    let way = format!("{} {symbol}", fixed(in_a_metre * aim_line.length(), 0));
    match (aim_line.meeting, aim_line.cushion) {
        (Meeting::Ball(hit), _) => {
            let side = hit.side().map_or_else(String::new, |side| format!(", {side} side"));
            format!("{} {:.0} % full{side}, {way}", cue_ball.names()[hit.ball], 100.0 * hit.fullness)
        }
        (_, Some(mark)) => {
            format!("{} at {}, {way}", rail_name(mark.rail), units.position.exact(mark.diamond, diamond, 1))
        }
        (_, None) => format!("meets nothing, {way}"),
    }
}

/// How low the cue can be held, and what it passes over.
fn least_words(theta: f64, over: Obstacle, cue_ball: CueBall, caps: Capabilities) -> String {
    let degree = caps.pick("°", " deg");
    format!("cue at least {}{degree} up, over the {}", fixed(theta.to_degrees(), 1), obstacle_word(over, cue_ball))
}

/// What keeps the cue from being held at all.
fn no_room_words(obstacle: Obstacle, cue_ball: CueBall) -> String {
    format!("no room for the cue: the {} is in the way", obstacle_word(obstacle, cue_ball))
}

fn obstacle_word(obstacle: Obstacle, cue_ball: CueBall) -> String {
    match obstacle {
        Obstacle::Rail(rail) => rail_name(rail).to_owned(),
        Obstacle::Ball(ball) => format!("{} ball", cue_ball.names()[ball]),
    }
}

/// Whose shot the advice is.
pub const fn advisor(model_shot: &ModelShot) -> &'static str {
    if model_shot.is_own { "model shot" } else { "coach" }
}

/// How a stroke differs from another one, as a player would say it; nothing where the difference is too small to see or to play.
fn told(turn: &Turn, stroke: &CueInputs, other: &CueInputs, units: Units) -> Option<String> {
    let of = |cue| ShotWords::of(&turn.table, &turn.layout, cue).ok();
    let is_seen = !changes(&turn.table, other, stroke, units).is_empty();
    // What cannot be played has nothing to be compared; playing it says why.
    let (words, others) = of(stroke).filter(|_| is_seen).zip(of(other))?;
    let parts = words.differences(&others, false, turn.cue_ball, units);
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// How often the advised stroke is made, and how to strike it.
fn model_words(turn: &Turn, model_shot: &ModelShot, units: Units) -> String {
    let advice = &model_shot.advice;
    let sentence = model_shot.shot.words.sentence(turn.cue_ball, units);
    let (made, aim) = (percent_words(advice.chance.rate), aim_words(turn, &advice.cue, units));
    format!("{} makes {made}: {sentence} Cue to {aim}.", advisor(model_shot))
}

/// The same, and how the stroke that is set differs.
fn hint(turn: &Turn, model_shot: &ModelShot, units: Units, caps: Capabilities) -> Vec<String> {
    let differs = || {
        let yours = told(turn, &turn.raised_stroke(), &model_shot.advice.cue, units);
        format!("Yours: {}", yours.unwrap_or_else(|| "the same".to_owned()))
    };
    let yours = (!turn.is_with_coach()).then(differs);
    let model = model_words(turn, model_shot, units);
    std::iter::once(model).chain(yours).map(|words| spell(&words, caps)).collect()
}

/// How often the stroke is made, and the advised one.
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

/// How the stroke that was meant differs from the advised one, and what the player's errors have added to it.
fn differences(turn: &Turn, watched: &Watched, units: Units, caps: Capabilities) -> Vec<String> {
    let Watched { meant, outcome, .. } = watched;
    let added = told(turn, &outcome.played.stroke, meant, units).unwrap_or_else(|| "hardly any change".to_owned());
    if watched.is_by_coach() {
        return vec![spell(&format!("the coach's hand: {added}"), caps)];
    }
    let compared = match &turn.model_shot {
        ModelShotState::Known(model_shot) => told(turn, meant, &model_shot.advice.cue, units).map_or_else(
            || format!("{}: almost the same", advisor(model_shot)),
            |yours| format!("yours, beside the {}: {yours}", advisor(model_shot)),
        ),
        ModelShotState::Pending => "the coach is still thinking".to_owned(),
        ModelShotState::Missing => "the coach has found no shot".to_owned(),
    };
    [compared, format!("your hand: {added}")].map(|words| spell(&words, caps)).to_vec()
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
    fn places_the_tip_and_the_speed_are_told_in_the_units_of_the_settings() {
        let table = Table::default();
        let mark = RailPoint { rail: Rail::Left, diamond: 2.04 };
        let places = vec![DVec2::ZERO, DVec2::new(0.5, 0.0)];
        let aim_line = AimLine { places, meeting: Meeting::Rail(mark.rail, None), cushion: Some(mark) };
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
    fn rows_that_run_under_an_empty_panel_hold_more() {
        let paragraphs = [("one two three four five".to_owned(), Style::new()), ("six".to_owned(), Style::new())];
        let lines = lines_of(&paragraphs, |row| if row < 1 { 7 } else { 10 });
        let lines: Vec<_> = lines.iter().map(|(line, _)| line.as_str()).collect();
        assert_eq!(lines, ["one two", "three four", "five", "six"]);
    }

    #[test]
    fn paragraphs_that_have_no_room_stand_one_behind_the_other() {
        let words = ["one.", "two", "three"].map(|words| (words.to_owned(), Style::new()));
        let other = ("four".to_owned(), Style::new().bold());
        let joined = joined(&[&words[..], &[other]].concat());
        let joined: Vec<_> = joined.iter().map(|(words, _)| words.as_str()).collect();
        assert_eq!(joined, ["one. two; three", "four"]);
    }

    #[test]
    fn the_least_elevation_is_told_with_what_the_cue_passes_over() {
        let caps = |unicode| Capabilities { depth: Depth::True, glyphs: Glyphs::Letters, unicode };
        let theta = 7.26_f64.to_radians();
        let over_rail = least_words(theta, Obstacle::Rail(Rail::Top), CueBall::White, caps(true));
        assert_eq!(over_rail, "cue at least 7.3° up, over the top rail");
        let over_ball = least_words(theta, Obstacle::Ball(1), CueBall::White, caps(false));
        assert_eq!(over_ball, "cue at least 7.3 deg up, over the yellow ball");
        assert_eq!(
            no_room_words(Obstacle::Ball(1), CueBall::Yellow),
            "no room for the cue: the white ball is in the way"
        );
    }
}
