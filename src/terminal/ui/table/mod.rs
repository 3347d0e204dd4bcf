//! The table: cloth, rails, the predicted paths and the three balls.

mod cushions;
mod paint;
mod picture;
mod rails;
mod ways;

use glam::DVec2;
use ratatui::{layout::Rect, style::Color};

use crate::{
    simulation::TOLD_HEIGHT,
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

/// Dots and rings nearer to a ball than this, in radii, are left out: three colours do not fit a cell.
const CLEAR_RADII: f64 = 2.2;
/// The same against the pictures of the balls, where they are enlarged, in halves of their width.
const CLEAR_PICTURES: f64 = 1.45;

/// Something else at a place on the table: a dot, or a ball that is not there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Where, m.
    pub place: DVec2,
    /// Whether it is as large as a ball, an outline; else it is a dot.
    pub is_ball: bool,
    /// Its colour.
    pub color: Color,
    /// Its sign where only letters are drawn.
    pub letter: char,
}

/// What is drawn of a table, and how.
#[derive(Clone, Copy, Debug)]
pub struct TableView<'a> {
    /// The table.
    pub table: &'a Table,
    /// Where the balls lie before the shot.
    pub layout: &'a Layout,
    /// The shot from there, if there is one.
    pub shot: Option<&'a Shot>,
    /// Another shot from there, whose cue ball's way is drawn as well, in dashes and with the word for whose it is.
    pub other: Option<&'a Shot>,
    /// That word.
    pub other_name: &'static str,
    /// Seconds since the stroke.
    pub time: f64,
    /// Whether the balls are drawn where the shot has them at `time`; otherwise they wait to be placed.
    pub is_moving: bool,
    /// The ball that lies on top of the others; marked while balls are placed.
    pub front: usize,
    /// Whether the paths of the object balls are left out, for something else that there is to see.
    pub cue_path_only: bool,
    /// Whether the cushions of the shot are numbered on the rails, and the corners with the diamonds that are counted to there.
    pub is_numbered: bool,
    /// What else is drawn, below the paths and the balls, the first lowest.
    pub spots: &'a [Spot],
    /// Words at a place, where there is something to see.
    pub note: Option<(DVec2, &'a str)>,
    /// Where a film shows the balls at the same moment: outlines below the balls. The outlines of what lies ahead in the
    /// shot are left out then.
    pub film: Option<[DVec2; BALLS]>,
}

impl<'a> TableView<'a> {
    /// The balls as they lie, with nothing else.
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

/// Draws the table in the upper middle of `area`, as large as fits.
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
    let told = |height: f64| if height < TOLD_HEIGHT { 0.0 } else { height };
    let heights = std::array::from_fn(|ball| shot.map_or(0.0, |shot| told(shot.recording.height(ball, view.time))));
    let off_table = std::array::from_fn(|ball| shot.is_some_and(|shot| is_gone(shot, ball, view.time, &mapping)));
    let balls = apart_on_cloth(balls, heights, 2.0 * reach);
    let time = if view.is_moving { view.time } else { 0.0 };
    let picture = TablePicture { view, caps: ui.caps, mapping, time, balls, heights, off_table, sprite, clear };
    paint::paint(&picture, ui);
    if view.is_numbered {
        draw_counts(view.table, &mapping, ui);
        view.shot.inspect(|shot| draw_cushions(&shot.words, view.table, &mapping, ui));
    }
    ways::draw_words(&picture, ui);
}

/// Whether a ball that leaves the table is beyond the rails already, though it may not have come down there.
fn is_gone(shot: &Shot, ball: usize, time: f64, mapping: &Mapping) -> bool {
    shot.recording.off_table()[ball] && !mapping.is_on_bed(shot.recording.positions(time)[ball])
}

/// The centres at which the pictures of the balls are drawn: where the pictures are larger than the balls, those of balls
/// that touch are to touch as well, and not to hide each other.
fn apart(mut balls: [DVec2; BALLS], least: f64) -> [DVec2; BALLS] {
    // Twice, since moving one pair may bring another together; a third time would not be seen.
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

/// The same of balls of which some are so high in the air, m: those are wherever they are.
fn apart_on_cloth(balls: [DVec2; BALLS], heights: [f64; BALLS], least: f64) -> [DVec2; BALLS] {
    let is_aloft = |ball: usize| heights[ball] > 0.0;
    // So far away that no picture reaches another.
    let away = |ball: usize| DVec2::splat(1e6 * (ball + 1) as f64);
    let moved = apart(std::array::from_fn(|ball| if is_aloft(ball) { away(ball) } else { balls[ball] }), least);
    std::array::from_fn(|ball| if is_aloft(ball) { balls[ball] } else { moved[ball] })
}

/// The ball that is drawn in a cell of the screen, column and row; the nearest one where pictures share it.
pub fn ball_at(balls: [DVec2; BALLS], mapping: &Mapping, glyphs: Glyphs, cell: (u16, u16)) -> Option<usize> {
    let middle = mapping.to_metres(cell.0, cell.1)?;
    let reach = Sprite::new(mapping, glyphs).reach(mapping, glyphs);
    let half_cell = 0.5 / mapping.scale();
    let drawn = apart(balls, 2.0 * reach);
    let is_there = |ball: DVec2| ball.clamp(middle - half_cell, middle + half_cell).distance(ball) <= reach;
    let found = (0..BALLS).filter(|&ball| is_there(drawn[ball]));
    found.min_by(|&one, &other| drawn[one].distance(middle).total_cmp(&drawn[other].distance(middle)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_touching_balls_touch_and_others_stay() {
        let balls = [DVec2::ZERO, DVec2::new(0.06, 0.0), DVec2::new(0.5, 0.0)];
        let [one, two, three] = apart(balls, 0.12);
        assert!((one.distance(two) - 0.12).abs() < 1e-12);
        assert_eq!(three, balls[2]);
        assert_eq!(apart(balls, 0.05), balls);
        // A ball that flies over another stays above it.
        assert_eq!(apart_on_cloth(balls, [0.1, 0.0, 0.0], 0.12), balls);
    }
}
