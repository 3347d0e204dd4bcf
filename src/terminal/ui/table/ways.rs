//! Words on the cloth: whose way is whose, where a stroke of the player's own is drawn beside the coach's, and what there is to see at
//! a place.

use std::collections::HashSet;

use glam::DVec2;
use ratatui::style::{Color, Style};

use crate::terminal::{
    Glyphs,
    ui::{Ui, columns, table::scene::Scene},
};

/// Distance of the two ways from which on the words stand there, m: two balls.
const APART: f64 = 0.12;

/// Writes the words, each where nothing else is.
pub fn draw_words(scene: &Scene, ui: &mut Ui) {
    name_ways(scene, ui);
    draw_note(scene, ui);
}

/// Writes whose each way is, where the two lie apart; nothing where they never do.
fn name_ways(scene: &Scene, ui: &mut Ui) {
    let Some((own, other)) = scene.view.shot.zip(scene.view.other) else { return };
    if own.cue == other.cue {
        return;
    }
    let [own, other] = [&own.paths[0], &other.paths[0]];
    let mut taken: Cells = own.iter().chain(other).map(|dot| scene.mapping.to_cell(dot.place)).collect();
    taken.extend(pictures(scene));
    let theme = ui.theme;
    for (text, way, from, color) in
        [("you", own, other, theme.paths[0]), (scene.view.other_name, other, own, theme.way)]
    {
        let width = columns(text) as u16;
        let is_apart = |place: DVec2| from.iter().all(|dot| dot.place.distance(place) > APART);
        let apart = way.iter().filter(|dot| is_apart(dot.place)).map(|dot| scene.mapping.to_cell(dot.place));
        let starts = apart.flat_map(|cell| beside(cell, width, 1));
        let Some(cells) = free(scene, width, starts, &taken) else { continue };
        write(text, &cells, color, ui);
        taken.extend(cells);
    }
}

/// Marks the place of the view's note, and writes that beside it.
fn draw_note(scene: &Scene, ui: &mut Ui) {
    let Some((place, text)) = scene.view.note.filter(|(place, _)| scene.mapping.is_on_bed(*place)) else { return };
    let (cell, color) = (scene.mapping.to_cell(place), ui.theme.mark);
    let pictures: Cells = pictures(scene).collect();
    if scene.is_clear(place) {
        // The letters of ways are others.
        write(if ui.caps.glyphs == Glyphs::Letters { "*" } else { "\u{d7}" }, &[cell], color, ui);
    }
    let mut taken = pictures.clone();
    scene.each_dot(|_, dot, _| {
        taken.insert(scene.mapping.to_cell(dot.place));
    });
    let width = columns(text) as u16;
    // Rather over a way than far off.
    let tries = [(&taken, 1), (&pictures, 1), (&pictures, 3)];
    let found = tries.into_iter().find_map(|(taken, rows)| free(scene, width, beside(cell, width, rows), taken));
    if let Some(cells) = found {
        write(text, &cells, color, ui);
    }
}

type Cells = HashSet<(u16, u16)>;

/// The cells of the balls and of those that are not there.
fn pictures(scene: &Scene) -> impl Iterator<Item = (u16, u16)> {
    let balls = scene.balls.into_iter().chain(scene.ghosts().into_iter().map(|ghost| ghost.place));
    // A picture may reach into the rows and columns beside its middle.
    balls.map(|place| scene.mapping.to_cell(place)).flat_map(|(x, y)| {
        (x.saturating_sub(2)..=x + 2).flat_map(move |x| (y.saturating_sub(1)..=y + 1).map(move |y| (x, y)))
    })
}

/// Where words of so many columns may begin beside a cell, the nearest first, up to so many rows away.
fn beside((x, y): (u16, u16), width: u16, rows: u16) -> impl Iterator<Item = (u16, u16)> {
    let (right, left) = (Some(x + 2), x.checked_sub(width + 1));
    let middle = x.saturating_sub(width / 2);
    let in_row = move |y: u16| [right, left].into_iter().flatten().map(move |x| (x, y));
    let around = move |y: u16| std::iter::once((middle, y)).chain(in_row(y));
    in_row(y).chain((1..=rows).flat_map(move |by| y.checked_sub(by).into_iter().chain([y + by]).flat_map(around)))
}

/// The cells of words of so many columns at the first of these starts at which nothing else is.
fn free(
    scene: &Scene,
    width: u16,
    mut starts: impl Iterator<Item = (u16, u16)>,
    taken: &Cells,
) -> Option<Vec<(u16, u16)>> {
    let bed = scene.mapping.bed;
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
