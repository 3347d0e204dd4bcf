//! Sprites of the balls in sub-pixels. The shape is always the same, wherever the ball lies.

use std::collections::HashSet;

use glam::DVec2;

use crate::terminal::{
    Glyphs, Mapping,
    ui::{Canvas, Ink, canvas::sub_pixels},
};

/// Factor by which a ball is drawn larger than it is, to make up for its cut corners.
const ROUNDED: f64 = 1.1;
/// The smallest shape in sextants that looks round: anything smaller is a cross or a block. On a table of 60 columns it is almost twice the
/// size of the ball; the physics uses the true size.
const MIN_SEXTANTS: (i32, i32) = (5, 4);
/// The smallest shape in octants, whose sub-pixels are square.
const MIN_OCTANTS: (i32, i32) = (5, 5);
/// The smallest visible shape in half blocks.
const MIN_HALVES: (i32, i32) = (2, 2);

/// Sprite of a ball, in sub-pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sprite {
    width: i32,
    height: i32,
}

impl Sprite {
    /// The sprite of a ball at the scale of `mapping`.
    pub fn new(mapping: &Mapping, glyphs: Glyphs) -> Self {
        let drawn = mapping.ball_columns() * ROUNDED;
        let (across, down) = sub_pixels(glyphs);
        let least = match glyphs {
            Glyphs::Octant => MIN_OCTANTS,
            Glyphs::Sextant => MIN_SEXTANTS,
            Glyphs::Half | Glyphs::Letters => MIN_HALVES,
        };
        // A row is as high as two columns are wide. The width is derived from the height, because rounding both would turn some balls into
        // ovals.
        let height = (drawn * f64::from(down) / 2.0).round();
        let width = (height * 2.0 * f64::from(across) / f64::from(down)).round();
        Self { width: (width as i32).max(least.0), height: (height as i32).max(least.1) }
    }

    /// The sprite of a ball at this height above the cloth, m: larger by one sub-pixel, by two from a ball's diameter on.
    #[must_use]
    pub fn raised(self, height: f64, radius: f64, glyphs: Glyphs) -> Self {
        let (across, down) = sub_pixels(glyphs);
        let larger = self.height + if height < 2.0 * radius { 1 } else { 2 };
        let width = f64::from(larger * 2) * f64::from(across) / f64::from(down);
        Self { width: (width.round() as i32).max(self.width + 1), height: larger }
    }

    /// Half the larger side of the sprite, m.
    pub fn reach(self, mapping: &Mapping, glyphs: Glyphs) -> f64 {
        let (across, down) = sub_pixels(glyphs);
        let scale = mapping.scale();
        let half = |size: i32, sub_pixels: u16, cells: f64| 0.5 * f64::from(size) / (f64::from(sub_pixels) * cells);
        half(self.width, across, scale.x).max(half(self.height, down, scale.y))
    }

    /// Whether the sub-pixel belongs to the ball, counted from the sprite's upper left corner.
    fn covers(self, x: i32, y: i32) -> bool {
        let offset = |at: i32, size: i32| f64::from(2 * at + 1 - size) / f64::from(size);
        (0..self.width).contains(&x)
            && (0..self.height).contains(&y)
            && offset(x, self.width).powi(2) + offset(y, self.height).powi(2) <= 1.0
    }

    /// The upper left corner of a ball at `place`: its centre snaps to the sub-pixels, so that the shape never changes.
    fn corner(self, canvas: &Canvas, mapping: &Mapping, place: DVec2) -> (i32, i32) {
        let (width, height) = canvas.size();
        let bed = DVec2::new(f64::from(mapping.bed.width), f64::from(mapping.bed.height));
        let at = mapping.to_cells(place) * DVec2::new(f64::from(width), f64::from(height)) / bed;
        let x = (at.x - 0.5 * f64::from(self.width)).round() as i32;
        let y = (at.y - 0.5 * f64::from(self.height)).round() as i32;
        // An enlarged ball at a cushion is still drawn entirely on the cloth.
        (x.clamp(0, (width - self.width).max(0)), y.clamp(0, (height - self.height).max(0)))
    }

    /// The cells that a ball touches whose upper left corner is at `corner`.
    fn cells(self, canvas: &Canvas, corner: (i32, i32)) -> HashSet<(i32, i32)> {
        let all = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        all.filter(|&(x, y)| self.covers(x, y)).map(|(x, y)| canvas.cell_of(corner.0 + x, corner.1 + y)).collect()
    }

    /// The upper left corners of balls at rest in these places. A cell has room for the cloth and one ball; a ball that shares a cell with
    /// one before it is drawn one sub-pixel further, if that helps.
    fn corners(self, canvas: &Canvas, mapping: &Mapping, places: impl Iterator<Item = DVec2>) -> Vec<(i32, i32)> {
        let (width, height) = canvas.size();
        let is_inside =
            |(x, y): &(i32, i32)| (0..=width - self.width).contains(x) && (0..=height - self.height).contains(y);
        let mut taken = HashSet::new();
        let free = |place: DVec2| {
            let (left, top) = self.corner(canvas, mapping, place);
            let near = [(0, 0), (0, 1), (0, -1), (1, 0), (-1, 0)].map(|(x, y)| (left + x, top + y));
            let is_free = |corner: &(i32, i32)| self.cells(canvas, *corner).is_disjoint(&taken);
            let corner = near.into_iter().filter(is_inside).find(is_free).unwrap_or((left, top));
            taken.extend(self.cells(canvas, corner));
            corner
        };
        places.map(free).collect()
    }

    /// Draws balls at rest, the uppermost first.
    pub fn stamp_at_rest(self, canvas: &mut Canvas, mapping: &Mapping, balls: &[(DVec2, Ink)]) {
        let corners = self.corners(canvas, mapping, balls.iter().map(|(place, _)| *place));
        for (corner, (_, ink)) in corners.into_iter().zip(balls).rev() {
            self.draw(canvas, corner, *ink, |_, _| true);
        }
    }

    /// Draws the ball.
    pub fn stamp(self, canvas: &mut Canvas, mapping: &Mapping, place: DVec2, ink: Ink) {
        self.draw(canvas, self.corner(canvas, mapping, place), ink, |_, _| true);
    }

    /// Whether the sprite is large enough for its outline to differ from the full ball.
    pub fn has_hole(self) -> bool {
        self.width.min(self.height) >= 3
    }

    /// Draws the ball's outline, for a position that the ball does not have yet. A sprite too small for an outline is left out.
    pub fn stamp_ring(self, canvas: &mut Canvas, mapping: &Mapping, place: DVec2, ink: Ink) {
        if !self.has_hole() {
            return;
        }
        let inside = |x, y| [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().all(|(dx, dy)| self.covers(x + dx, y + dy));
        self.draw(canvas, self.corner(canvas, mapping, place), ink, |x, y| !inside(x, y));
    }

    fn draw(self, canvas: &mut Canvas, (left, top): (i32, i32), ink: Ink, keep: impl Fn(i32, i32) -> bool) {
        for y in 0..self.height {
            for x in 0..self.width {
                if self.covers(x, y) && keep(x, y) {
                    canvas.set(left + x, top + y, ink);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Table;
    use ratatui::layout::Rect;

    fn shape(sprite: Sprite) -> Vec<String> {
        (0..sprite.height)
            .map(|y| (0..sprite.width).map(|x| if sprite.covers(x, y) { '#' } else { '.' }).collect())
            .collect()
    }

    #[test]
    fn balls_are_round_at_both_sizes() {
        let sprite = |columns| {
            let mapping = Mapping::fit(&Table::default(), Rect::new(0, 0, columns, 60));
            shape(Sprite::new(&mapping, Glyphs::Sextant))
        };
        assert_eq!(sprite(64), [".###.", "#####", "#####", ".###."]);
        assert_eq!(sprite(112), [".###.", "#####", "#####", ".###."]);
        assert_eq!(
            sprite(192),
            ["..#####..", ".#######.", "#########", "#########", "#########", ".#######.", "..#####.."]
        );
    }

    #[test]
    fn balls_apart_share_no_cell() {
        let mapping = Mapping::fit(&Table::default(), Rect::new(0, 0, 62, 18));
        let sprite = Sprite::new(&mapping, Glyphs::Sextant);
        let canvas = Canvas::new(mapping.bed, Glyphs::Sextant, ratatui::style::Color::Blue);
        let mut shifted = 0;
        // Nearer balls would have to be drawn a whole ball away.
        for millimetres in (170..400).flat_map(|distance| [distance, -distance]) {
            let places = [DVec2::ZERO, DVec2::new(0.0, 1e-3 * f64::from(millimetres))];
            let corners = sprite.corners(&canvas, &mapping, places.into_iter());
            let [one, other] = [0, 1].map(|ball| sprite.cells(&canvas, corners[ball]));
            assert!(one.is_disjoint(&other), "{millimetres} mm: {corners:?}");
            assert_eq!(corners[0], sprite.corner(&canvas, &mapping, places[0]), "the first ball stays");
            shifted += usize::from(corners[1] != sprite.corner(&canvas, &mapping, places[1]));
        }
        assert!(shifted > 0);
    }

    #[test]
    fn a_ball_in_the_air_is_larger_the_higher_it_is() {
        for (columns, glyphs) in
            [(64, Glyphs::Sextant), (112, Glyphs::Octant), (192, Glyphs::Sextant), (80, Glyphs::Half)]
        {
            let mapping = Mapping::fit(&Table::default(), Rect::new(0, 0, columns, 60));
            let lying = Sprite::new(&mapping, glyphs);
            let [low, high] = [0.01, 0.1].map(|height| lying.raised(height, mapping.radius, glyphs));
            assert!(lying.width < low.width && low.width < high.width, "{lying:?} {low:?} {high:?}");
            assert!(lying.height < low.height && low.height < high.height);
        }
    }
}
