//! The table: cloth, rails, the predicted paths and the three balls.

use glam::DVec2;
use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::{Color, Modifier, Style},
};

use super::rails::draw_rails;
use crate::{
    table::{BALLS, Layout, Table},
    terminal::{
        canvas::{Canvas, Ink},
        geometry::Mapping,
        look::{Glyphs, Look},
        shot::{DOT_SPACING, Shot},
        sprites::Sprite,
        theme::Theme,
    },
};

/// Dots and rings nearer to a ball than this, in radii, are left out: three colours do not fit a cell.
const CLEAR_RADII: f64 = 2.2;
/// The same against the pictures of the balls, where they are enlarged, in halves of their width.
const CLEAR_PICTURES: f64 = 1.45;
/// Columns from one dot of a path to the next, and where a dot is as wide as a column.
const DOT_COLUMNS: f64 = 1.8;
const HALF_DOT_COLUMNS: f64 = 2.6;
/// Columns across a ball from which on its letter has room for brackets.
const BRACKET_COLUMNS: f64 = 2.0;
/// Length of the cue that is drawn before the stroke, m, and the distance of its dots: it is to be a line.
const CUE_LENGTH: f64 = 0.4;
const CUE_DOTS: f64 = 0.008;
/// Letters of the balls, and the signs of their paths.
const LETTERS: [char; BALLS] = ['W', 'Y', 'R'];
const DOTS: [char; BALLS] = ['·', '+', '×'];
const PLAIN_DOTS: [char; BALLS] = ['.', '+', 'x'];

/// Weights of what shares a cell (see [`Ink`]).
const DOT_WEIGHT: u8 = 3;
const RING_WEIGHT: u8 = 4;
const BALL_WEIGHT: u8 = 6;

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
    /// Seconds since the stroke.
    pub time: f64,
    /// Whether the balls are drawn where the shot has them at `time`; otherwise they wait to be placed.
    pub is_moving: bool,
    /// The ball that lies on top of the others; marked while balls are placed.
    pub front: usize,
    /// Whether the paths of the object balls are left out, for something else that there is to see.
    pub is_lean: bool,
    /// What else is drawn, below the paths and the balls, the first lowest.
    pub spots: &'a [Spot],
    /// The colours.
    pub theme: &'a Theme,
    /// What the terminal can show.
    pub look: Look,
}

/// Draws the table in the upper middle of `area`, as large as fits.
pub fn draw_table(view: &TableView, area: Rect, buffer: &mut Buffer) {
    let mapping = Mapping::fit(view.table, area);
    if mapping.bed.is_empty() {
        return;
    }
    let shot = view.shot.filter(|_| view.is_moving);
    let balls = shot.map_or(view.layout.balls, |shot| shot.recording.positions(view.time));
    let marked = (!view.is_moving).then(|| balls[view.front]);
    draw_rails(&mapping, view.table.diamond(), marked, view.theme, view.look, buffer);
    let glyphs = view.look.glyphs;
    let sprite = Sprite::new(&mapping, glyphs);
    let clear = (CLEAR_RADII * mapping.radius).max(CLEAR_PICTURES * sprite.reach(&mapping, glyphs));
    let balls = apart(balls, 2.0 * sprite.reach(&mapping, glyphs));
    let scene = Scene { view, mapping, balls, sprite, clear };
    if glyphs == Glyphs::Letters {
        scene.draw_letters(buffer);
    } else {
        scene.draw_blocks(buffer);
    }
}

/// The centres at which the pictures of the balls are drawn: where the pictures are larger than the balls, those of balls
/// that touch are to touch as well, and not to hide each other.
fn apart(mut balls: [DVec2; BALLS], least: f64) -> [DVec2; BALLS] {
    // Twice, since moving one pair may bring another together; a third time nobody would see.
    for (one, other) in [(0, 1), (0, 2), (1, 2), (0, 1), (0, 2), (1, 2)] {
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

struct Scene<'a> {
    view: &'a TableView<'a>,
    mapping: Mapping,
    /// Where the balls are drawn.
    balls: [DVec2; BALLS],
    sprite: Sprite,
    /// Distance from a ball from which on something else can be drawn, m.
    clear: f64,
}

impl Scene<'_> {
    fn is_clear(&self, place: DVec2) -> bool {
        self.balls.iter().all(|ball| ball.distance(place) > self.clear)
    }

    /// What else is drawn: a ball that is not there may touch one that is.
    fn spots(&self) -> impl Iterator<Item = &Spot> {
        self.view.spots.iter().filter(|spot| spot.is_ball || self.is_clear(spot.place))
    }

    /// Calls `draw` with each dot of the predicted paths that no ball and no ghost hides.
    fn each_dot(&self, mut draw: impl FnMut(usize, DVec2)) {
        let Some(shot) = self.view.shot else { return };
        let columns = if self.view.look.glyphs == Glyphs::Half { HALF_DOT_COLUMNS } else { DOT_COLUMNS };
        let stride = (columns / (self.mapping.scale().x * DOT_SPACING)).round().max(1.0) as usize;
        let ghosts = self.ghosts();
        let is_free = |place: DVec2| ghosts.iter().all(|(_, ghost)| ghost.distance(place) > 0.75 * self.clear);
        let balls = if self.view.is_lean { 1 } else { BALLS };
        for (ball, path) in shot.paths[..balls].iter().enumerate().rev() {
            for dot in path.iter().step_by(stride).filter(|dot| self.is_clear(dot.place) && is_free(dot.place)) {
                draw(ball, dot.place);
            }
        }
    }

    /// Where balls will be: the cue ball at the first contact, and all balls that move where they come to rest.
    fn ghosts(&self) -> Vec<(usize, DVec2)> {
        let Some(shot) = self.view.shot else { return Vec::new() };
        // At the contact the ring touches the object ball; only the cue ball itself may hide it.
        let contact = shot.contact.map(|contact| contact.place);
        let contact = contact.filter(|place| place.distance(self.balls[0]) > self.clear);
        let ends = shot.recording.final_layout().balls.into_iter().enumerate();
        contact.map(|place| (0, place)).into_iter().chain(ends.filter(|&(_, place)| self.is_clear(place))).collect()
    }

    /// Calls `draw` along the cue, as long as it has not struck.
    fn each_cue_dot(&self, mut draw: impl FnMut(DVec2)) {
        let Some(shot) = self.view.shot.filter(|_| self.view.time == 0.0) else { return };
        let back = -DVec2::from_angle(shot.cue.phi);
        let tip = 1.2 * self.sprite.reach(&self.mapping, self.view.look.glyphs);
        let dots = (CUE_LENGTH / CUE_DOTS) as u32;
        for dot in 0..=dots {
            draw(self.balls[0] + back * (tip + f64::from(dot) * CUE_DOTS));
        }
    }

    /// The balls, the selected one last, so that it lies on top.
    fn order(&self) -> [usize; BALLS] {
        let selected = self.view.front;
        [(selected + 1) % BALLS, (selected + 2) % BALLS, selected]
    }

    fn draw_blocks(&self, buffer: &mut Buffer) {
        let (theme, glyphs) = (self.view.theme, self.view.look.glyphs);
        let mapping = &self.mapping;
        let mut canvas = Canvas::new(mapping.bed, glyphs, theme.cloth);
        let (width, height) = canvas.size();
        let grid = DVec2::new(f64::from(width), f64::from(height))
            / DVec2::new(f64::from(mapping.bed.width), f64::from(mapping.bed.height));
        let dot = |canvas: &mut Canvas, place: DVec2, color: Color| {
            let at = (mapping.to_cells(place) * grid).floor();
            canvas.set(at.x as i32, at.y as i32, Ink { color, weight: DOT_WEIGHT });
        };
        for spot in self.spots() {
            if !spot.is_ball {
                dot(&mut canvas, spot.place, spot.color);
            } else if glyphs == Glyphs::Sextant {
                let ink = Ink { color: spot.color, weight: RING_WEIGHT };
                self.sprite.stamp_ring(&mut canvas, mapping, spot.place, ink);
            }
        }
        self.each_dot(|ball, place| dot(&mut canvas, place, theme.paths[ball]));
        self.each_cue_dot(|place| dot(&mut canvas, place, theme.cue));
        if glyphs == Glyphs::Sextant {
            for (ball, place) in self.ghosts() {
                let ink = Ink { color: theme.paths[ball], weight: RING_WEIGHT };
                self.sprite.stamp_ring(&mut canvas, mapping, place, ink);
            }
        }
        for ball in self.order() {
            self.sprite.stamp(
                &mut canvas,
                mapping,
                self.balls[ball],
                Ink { color: theme.balls[ball], weight: BALL_WEIGHT },
            );
        }
        canvas.paint(buffer);
    }

    fn draw_letters(&self, buffer: &mut Buffer) {
        let (theme, look) = (self.view.theme, self.view.look);
        let mapping = &self.mapping;
        buffer.set_style(mapping.bed, Style::new().bg(theme.cloth));
        let mut put = |place: DVec2, symbol: char, color: Color| {
            let cell = &mut buffer[mapping.to_cell(place)];
            cell.set_char(symbol).set_fg(color);
        };
        for spot in self.spots() {
            put(spot.place, spot.letter, spot.color);
        }
        let dots = look.pick(DOTS, PLAIN_DOTS);
        self.each_dot(|ball, place| put(place, dots[ball], theme.paths[ball]));
        for (ball, place) in self.ghosts() {
            put(place, LETTERS[ball].to_ascii_lowercase(), theme.paths[ball]);
        }
        for ball in self.order() {
            let (x, y) = mapping.to_cell(self.balls[ball]);
            let wide = mapping.ball_columns() >= BRACKET_COLUMNS && x > mapping.bed.x && x + 1 < mapping.bed.right();
            let text = if wide { format!("({})", LETTERS[ball]) } else { LETTERS[ball].to_string() };
            let mut style = Style::new().fg(theme.balls[ball]).add_modifier(Modifier::BOLD);
            if !self.view.is_moving && ball == self.view.front {
                style = style.add_modifier(Modifier::REVERSED);
            }
            buffer.set_stringn(x - u16::from(wide), y, &text, 3, style);
        }
    }
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
    }
}
