//! Whose way is whose, where a stroke of the player's own is drawn beside the coach's: a word at each.

use std::collections::HashSet;

use glam::DVec2;
use ratatui::style::Style;

use crate::terminal::{
    shot::Dot,
    ui::{Ui, columns, table::scene::Scene},
};

/// Distance of the two ways from which on the words stand there, m: two balls.
const APART: f64 = 0.12;

/// Writes the words, each beside its way where the two lie apart; none where they never do.
pub fn draw_words(scene: &Scene, ui: &mut Ui) {
    let Some((own, other)) = scene.view.shot.zip(scene.view.other) else { return };
    let [own, other] = [&own.paths[0], &other.paths[0]];
    let mut taken: HashSet<(u16, u16)> = own.iter().chain(other).map(|dot| scene.mapping.to_cell(dot.place)).collect();
    let balls = scene.balls.into_iter().chain(scene.ghosts().into_iter().map(|ghost| ghost.place));
    for (x, y) in balls.map(|place| scene.mapping.to_cell(place)) {
        // A picture may reach into the rows and columns beside its middle.
        let across = x.saturating_sub(2)..=x + 2;
        taken.extend(across.flat_map(|x| (y.saturating_sub(1)..=y + 1).map(move |y| (x, y))));
    }
    let theme = ui.theme;
    for (text, way, from, color) in
        [("you", own, other, theme.paths[0]), (scene.view.other_name, other, own, theme.way)]
    {
        let Some(cells) = place(scene, columns(text) as u16, way, from, &taken) else { continue };
        let style = Style::new().fg(color).bg(theme.cloth).add_modifier(theme.strong);
        ui.buffer.set_string(cells[0].0, cells[0].1, text, style);
        taken.extend(cells);
    }
}

/// The cells of a word beside `way`, where that is far from `from`, and nothing else is there.
fn place(scene: &Scene, width: u16, way: &[Dot], from: &[Dot], taken: &HashSet<(u16, u16)>) -> Option<Vec<(u16, u16)>> {
    let bed = scene.mapping.bed;
    let is_apart = |place: DVec2| from.iter().all(|dot| dot.place.distance(place) > APART);
    let starts = |(x, y): (u16, u16)| {
        let left = x.checked_sub(width + 1).map(|x| (x, y));
        let middle = x.saturating_sub(width / 2);
        [Some((x + 2, y)), left, y.checked_sub(1).map(|y| (middle, y)), Some((middle, y + 1))]
    };
    let is_free = |&(x, y): &(u16, u16)| {
        let is_inside = x >= bed.x && y >= bed.y && x + width <= bed.right() && y < bed.bottom();
        is_inside && (x.saturating_sub(1)..=x + width).all(|x| !taken.contains(&(x, y)))
    };
    let apart = way.iter().filter(|dot| is_apart(dot.place)).map(|dot| scene.mapping.to_cell(dot.place));
    let (x, y) = apart.flat_map(starts).flatten().find(is_free)?;
    Some((x..x + width).map(|x| (x, y)).collect())
}
