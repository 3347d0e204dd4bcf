//! Words on the cloth: names of the two paths if the player's own stroke is drawn with the coach's, and a note at a position.

use std::{collections::HashSet, f64::consts::FRAC_PI_4};

use glam::DVec2;
use ratatui::style::{Color, Style};

use crate::terminal::{
    Glyphs,
    ui::{Ui, columns, table::picture::TablePicture},
};

/// Distance of the two paths from which on they are labelled, m: two balls.
const LABEL_DISTANCE: f64 = 0.12;
/// Largest distance from a ball's centre of a mark for a position that the ball hides, and the distance between two tries, m.
const MAX_DISTANCE: f64 = 0.3;
const STEP: f64 = 0.005;

/// Writes the words, each in free cells.
pub fn draw_words(picture: &TablePicture, ui: &mut Ui) {
    label_paths(picture, ui);
    draw_note(picture, ui);
}

/// Labels each path where the two are apart; draws nothing if they never are.
fn label_paths(picture: &TablePicture, ui: &mut Ui) {
    let Some((own, other)) = picture.view.shot.zip(picture.view.other) else { return };
    if own.cue == other.cue {
        return;
    }
    let [own, other] = [&own.paths[0], &other.paths[0]];
    let mut taken: Cells = own.iter().chain(other).map(|dot| picture.mapping.to_cell(dot.position)).collect();
    taken.extend(ball_cells(picture));
    let theme = ui.theme;
    for (text, way, from, color) in
        [("you", own, other, theme.paths[0]), (picture.view.other_name, other, own, theme.next_path)]
    {
        let width = columns(text) as u16;
        let is_apart = |place: DVec2| from.iter().all(|dot| dot.position.distance(place) > LABEL_DISTANCE);
        let apart = way.iter().filter(|dot| is_apart(dot.position)).map(|dot| picture.mapping.to_cell(dot.position));
        let starts = apart.flat_map(|cell| beside(cell, width, 1));
        let Some(cells) = free(picture, width, starts, &taken) else { continue };
        write(text, &cells, color, ui);
        taken.extend(cells);
    }
}

/// Marks the position of the view's note and writes its text next to it.
fn draw_note(picture: &TablePicture, ui: &mut Ui) {
    let Some((place, text)) = picture.view.note.filter(|(place, _)| picture.mapping.is_on_bed(*place)) else { return };
    let mark = beside_balls(picture, place);
    let (cell, color) = (picture.mapping.to_cell(mark.unwrap_or(place)), ui.theme.mark);
    let balls: Cells = ball_cells(picture).collect();
    if mark.is_some() {
        // The paths use other letters.
        write(if ui.caps.glyphs == Glyphs::Letters { "*" } else { "\u{d7}" }, &[cell], color, ui);
    }
    let mut taken = balls.clone();
    picture.each_dot(|_, dot, _| {
        taken.insert(picture.mapping.to_cell(dot.position));
    });
    let width = columns(text) as u16;
    // Covering a path is better than being far from the mark.
    let tries = [(&taken, 1), (&balls, 1), (&balls, 3)];
    let found = tries.into_iter().find_map(|(taken, rows)| free(picture, width, beside(cell, width, rows), taken));
    if let Some(cells) = found {
        write(text, &cells, color, ui);
    }
}

/// Where to mark a position: there, or if a ball hides it, next to that ball on the same side, preferably not on a ring. (A resting ball
/// hides its contact with an arriving ball.) `None` if other balls or the cushion leave no room.
fn beside_balls(picture: &TablePicture, place: DVec2) -> Option<DVec2> {
    if picture.is_clear(place) {
        return Some(place);
    }
    let nearest =
        picture.balls.into_iter().min_by(|one, other| one.distance(place).total_cmp(&other.distance(place)))?;
    let away = (place - nearest).normalize_or(DVec2::X);
    let rays = [0.0, 1.0, -1.0, 2.0, -2.0].map(|turn| DVec2::from_angle(turn * FRAC_PI_4).rotate(away));
    let along = |way: DVec2| (0..=(MAX_DISTANCE / STEP) as u32).map(move |step| nearest + f64::from(step) * STEP * way);
    let places = rays.into_iter().flat_map(|way| along(way).take_while(|at| picture.mapping.is_on_bed(*at)));
    let free: Vec<DVec2> =
        places.filter(|at| picture.is_clear(*at) && !picture.has_picture(*at, &picture.balls)).collect();
    let rings: Vec<DVec2> = picture.ghosts().into_iter().map(|ghost| ghost.position).collect();
    free.iter().find(|at| !picture.has_picture(**at, &rings)).or(free.first()).copied()
}

type Cells = HashSet<(u16, u16)>;

/// The cells of the balls and of the ghosts.
fn ball_cells(picture: &TablePicture) -> impl Iterator<Item = (u16, u16)> {
    let balls = picture.balls.into_iter().chain(picture.ghosts().into_iter().map(|ghost| ghost.position));
    // A ball may extend into the neighbouring rows and columns.
    balls.map(|place| picture.mapping.to_cell(place)).flat_map(|(x, y)| {
        (x.saturating_sub(2)..=x + 2).flat_map(move |x| (y.saturating_sub(1)..=y + 1).map(move |y| (x, y)))
    })
}

/// Possible starts for a text of `width` columns near a cell, the nearest first, up to `rows` rows away.
fn beside((x, y): (u16, u16), width: u16, rows: u16) -> impl Iterator<Item = (u16, u16)> {
    let (right, left) = (Some(x + 2), x.checked_sub(width + 1));
    let middle = x.saturating_sub(width / 2);
    let in_row = move |y: u16| [right, left].into_iter().flatten().map(move |x| (x, y));
    let around = move |y: u16| std::iter::once((middle, y)).chain(in_row(y));
    in_row(y).chain((1..=rows).flat_map(move |by| y.checked_sub(by).into_iter().chain([y + by]).flat_map(around)))
}

/// The cells of a text of `width` columns at the first free start.
fn free(
    picture: &TablePicture,
    width: u16,
    mut starts: impl Iterator<Item = (u16, u16)>,
    taken: &Cells,
) -> Option<Vec<(u16, u16)>> {
    let bed = picture.mapping.bed;
    let is_free = |&(x, y): &(u16, u16)| {
        let is_inside = x >= bed.x && y >= bed.y && x + width <= bed.right() && y < bed.bottom();
        is_inside && (x.saturating_sub(1)..=x + width).all(|x| !taken.contains(&(x, y)))
    };
    let (x, y) = starts.find(is_free)?;
    Some((x..x + width).map(|x| (x, y)).collect())
}

fn write(text: &str, cells: &[(u16, u16)], color: Color, ui: &mut Ui) {
    let style = Style::new().fg(color).bg(ui.theme.cloth).add_modifier(ui.theme.strong);
    ui.buffer.set_string(cells[0].0, cells[0].1, text, style);
}

#[cfg(test)]
mod tests {
    use ratatui::{buffer::Buffer, layout::Rect};

    use super::*;
    use crate::{
        table::{Layout, Table},
        terminal::{
            Capabilities, Depth, Mapping,
            ui::{TableView, Theme, draw_table, drawn},
        },
    };

    /// The table with a note at a position, and without.
    fn noted(layout: &Layout, place: DVec2, area: Rect, caps: Capabilities) -> [Buffer; 2] {
        let table = Table::default();
        [Some((place, "kiss 7 %")), None].map(|note| {
            drawn(area, caps, |ui| draw_table(&TableView { note, ..TableView::new(&table, layout) }, area, ui))
        })
    }

    #[test]
    fn a_contact_position_hidden_by_a_resting_ball_is_marked_beside_it() {
        let table = Table::default();
        let layout = Layout::parse("-1,0.3 -0.9,-0.4 0.4,0.1", &table).unwrap();
        let (red, color) = (layout.balls[2], Theme::new(Depth::True).balls[2]);
        for (columns, rows) in [(64, 17), (112, 30), (176, 46)] {
            let area = Rect::new(0, 0, columns, rows);
            let mapping = Mapping::fit(&table, area);
            for turn in 0..12 {
                let way = DVec2::from_angle(f64::from(turn) * std::f64::consts::FRAC_PI_6);
                let place = red + table.radius * way;
                for (caps, sign) in [(Capabilities::TRUE_COLOUR, "\u{d7}"), (Capabilities::ASCII, "*")] {
                    let [with, without] = noted(&layout, place, area, caps);
                    let marks: Vec<_> = area.positions().filter(|at| with[*at].symbol() == sign).collect();
                    let [mark] = marks[..] else { panic!("{columns} {turn}: {marks:?}\n{with:?}") };
                    let at = mapping.to_metres(mark.x, mark.y).unwrap();
                    assert!((at - red).dot(way) > 0.0, "{columns} {turn}: on the side that the other comes from");
                    assert!(at.distance(red) < 0.25, "{columns} {turn}: {at}");
                    // The sprite of the ball must stay whole.
                    let is_of_ball = |buffer: &Buffer, at| {
                        let cell = &buffer[at];
                        if caps == Capabilities::ASCII {
                            cell.symbol() == "R"
                        } else {
                            [cell.fg, cell.bg].contains(&color)
                        }
                    };
                    for at in area.positions().filter(|at| is_of_ball(&without, *at)) {
                        assert_eq!(with[at], without[at], "{columns} {turn}: {at}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_visible_contact_position_is_marked_directly() {
        let (table, area) = (Table::default(), Rect::new(0, 0, 112, 30));
        let layout = Layout::parse("-1,0.3 -0.9,-0.4 0.4,0.1", &table).unwrap();
        let place = DVec2::new(0.0, -0.2);
        let [with, _] = noted(&layout, place, area, Capabilities::TRUE_COLOUR);
        assert_eq!(with[Mapping::fit(&table, area).to_cell(place)].symbol(), "\u{d7}");
    }
}
