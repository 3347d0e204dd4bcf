//! The table: cloth, rails, predicted paths and the three balls.

mod cushions;
mod labels;
mod paint;
mod picture;
mod rails;

use glam::DVec2;
use ratatui::{layout::Rect, style::Color};

use crate::{
    simulation::REPORTED_HEIGHT,
    table::{BALLS, Layout, PAIRS, Table},
    terminal::{
        Glyphs, Mapping, Shot,
        ui::{
            Ui,
            sprites::Sprite,
            table::{
                cushions::{draw_counts, draw_cushions},
                picture::TablePicture,
                rails::draw_rails,
            },
        },
    },
};

pub use self::picture::cue_sign;

/// Dots and rings closer to a ball than this, in ball radii, are left out: a cell cannot hold three colours.
const CLEAR_RADII: f64 = 2.2;
/// The same limit for enlarged sprites, in halves of their width.
const CLEAR_PICTURES: f64 = 1.45;

/// An extra mark on the table: a dot, or the outline of a ball that is not there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Position, m.
    pub position: DVec2,
    /// Whether it is an outline as large as a ball; otherwise it is a dot.
    pub is_ball: bool,
    /// The colour.
    pub color: Color,
    /// Character if only letters are drawn.
    pub letter: char,
}

/// What to draw of a table, and how.
#[derive(Clone, Copy, Debug)]
pub struct TableView<'a> {
    /// The table.
    pub table: &'a Table,
    /// Positions of the balls before the shot.
    pub layout: &'a Layout,
    /// The shot from this layout, if there is one.
    pub shot: Option<&'a Shot>,
    /// A second shot from this layout, of which only the cue ball's path is drawn, dashed and labelled with its owner.
    pub other: Option<&'a Shot>,
    /// Label of the second shot's path.
    pub other_name: &'static str,
    /// Seconds since the stroke.
    pub time: f64,
    /// Whether the balls are drawn at their positions in the shot at `time`; otherwise they are being placed.
    pub is_moving: bool,
    /// The ball drawn on top of the others; marked while balls are placed.
    pub front: usize,
    /// Whether the paths of the object balls are left out, in favour of other marks.
    pub cue_path_only: bool,
    /// Whether the cushions of the shot are numbered on the rails, and the corners show their diamond counts.
    pub is_numbered: bool,
    /// Extra marks, drawn below the paths and the balls, the first lowest.
    pub spots: &'a [Spot],
    /// A note: a position and its text.
    pub note: Option<(DVec2, &'a str)>,
    /// Positions of the balls in a film at the same time, drawn as outlines below the balls. The outlines of the shot's later positions are
    /// then left out.
    pub film: Option<[DVec2; BALLS]>,
}

impl<'a> TableView<'a> {
    /// Only the balls at their positions in the layout.
    pub const fn new(table: &'a Table, layout: &'a Layout) -> Self {
        Self {
            table,
            layout,
            shot: None,
            other: None,
            other_name: "",
            time: 0.0,
            is_moving: true,
            front: 0,
            cue_path_only: false,
            is_numbered: true,
            spots: &[],
            note: None,
            film: None,
        }
    }
}

/// Draws the table as large as fits, centred at the top of `area`.
pub fn draw_table(view: &TableView, area: Rect, ui: &mut Ui) {
    let mapping = Mapping::fit(view.table, area);
    if mapping.bed.is_empty() {
        return;
    }
    let shot = view.shot.filter(|_| view.is_moving);
    let balls = shot.map_or(view.layout.balls, |shot| shot.recording.positions(view.time));
    let marked = (!view.is_moving).then(|| balls[view.front]);
    draw_rails(&mapping, view.table.diamond(), marked, ui);
    let glyphs = ui.caps.glyphs;
    let sprite = Sprite::new(&mapping, glyphs);
    let reach = sprite.reach(&mapping, glyphs);
    let clear = (CLEAR_RADII * mapping.radius).max(CLEAR_PICTURES * reach);
    let visible_height = |height: f64| if height < REPORTED_HEIGHT { 0.0 } else { height };
    let heights =
        std::array::from_fn(|ball| shot.map_or(0.0, |shot| visible_height(shot.recording.height(ball, view.time))));
    let off_table = std::array::from_fn(|ball| shot.is_some_and(|shot| is_gone(shot, ball, view.time, &mapping)));
    let balls = separated_on_cloth(balls, heights, 2.0 * reach);
    let time = if view.is_moving { view.time } else { 0.0 };
    let picture = TablePicture { view, caps: ui.caps, mapping, time, balls, heights, off_table, sprite, clear };
    paint::paint(&picture, ui);
    if view.is_numbered {
        draw_counts(view.table, &mapping, ui);
        view.shot.inspect(|shot| draw_cushions(&shot.words, view.table, &mapping, ui));
    }
    labels::draw_words(&picture, ui);
}

/// Whether a ball that leaves the table is already beyond the rails, even if still in the air.
fn is_gone(shot: &Shot, ball: usize, time: f64, mapping: &Mapping) -> bool {
    shot.recording.off_table()[ball] && !mapping.is_on_bed(shot.recording.positions(time)[ball])
}

/// The positions at which the sprites of the balls are drawn. If sprites are larger than the balls, those of touching balls are moved apart
/// until they only touch.
fn separated(mut balls: [DVec2; BALLS], least: f64) -> [DVec2; BALLS] {
    // Two passes, since moving one pair may bring another together; a third would change nothing visible.
    for (one, other) in PAIRS.into_iter().chain(PAIRS) {
        let way = balls[other] - balls[one];
        let push = 0.5 * (least - way.length());
        if push > 0.0 {
            let push = push * way.normalize_or(DVec2::X);
            balls[one] -= push;
            balls[other] += push;
        }
    }
    balls
}

/// Like [`separated`], but balls in the air (`heights` in m above zero) keep their positions.
fn separated_on_cloth(balls: [DVec2; BALLS], heights: [f64; BALLS], least: f64) -> [DVec2; BALLS] {
    let is_aloft = |ball: usize| heights[ball] > 0.0;
    // Far enough away that no sprite reaches another.
    let away = |ball: usize| DVec2::splat(1e6 * (ball + 1) as f64);
    let moved = separated(std::array::from_fn(|ball| if is_aloft(ball) { away(ball) } else { balls[ball] }), least);
    std::array::from_fn(|ball| if is_aloft(ball) { balls[ball] } else { moved[ball] })
}

/// The ball drawn in a screen cell, given as column and row; the nearest one if sprites share the cell.
pub fn ball_at(balls: [DVec2; BALLS], mapping: &Mapping, glyphs: Glyphs, cell: (u16, u16)) -> Option<usize> {
    let middle = mapping.to_metres(cell.0, cell.1)?;
    let reach = Sprite::new(mapping, glyphs).reach(mapping, glyphs);
    let half_cell = 0.5 / mapping.scale();
    let drawn = separated(balls, 2.0 * reach);
    let is_there = |ball: DVec2| ball.clamp(middle - half_cell, middle + half_cell).distance(ball) <= reach;
    let found = (0..BALLS).filter(|&ball| is_there(drawn[ball]));
    found.min_by(|&one, &other| drawn[one].distance(middle).total_cmp(&drawn[other].distance(middle)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_balls_are_drawn_touching_and_others_stay() {
        let balls = [DVec2::ZERO, DVec2::new(0.06, 0.0), DVec2::new(0.5, 0.0)];
        let [one, two, three] = separated(balls, 0.12);
        assert!((one.distance(two) - 0.12).abs() < 1e-12);
        assert_eq!(three, balls[2]);
        assert_eq!(separated(balls, 0.05), balls);
        // A ball that flies over another stays above it.
        assert_eq!(separated_on_cloth(balls, [0.1, 0.0, 0.0], 0.12), balls);
    }
}
