//! The table: cloth, rails, the predicted paths and the three balls.

use glam::DVec2;
use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::{Color, Modifier, Style},
};

use super::rails::draw_rails;
use crate::{
    table::BALLS,
    terminal::{
        app::{App, Mode},
        canvas::{Canvas, Ink},
        geometry::Mapping,
        look::Glyphs,
        sprites::Sprite,
    },
};

/// Dots and rings nearer to a ball than this, in radii, are left out: three colours do not fit a cell.
const CLEAR_RADII: f64 = 2.2;
/// Columns across a ball from which on a ring has a hole that can be seen.
const RING_COLUMNS: f64 = 2.0;
/// Letters of the balls, and the signs of their paths.
const LETTERS: [char; BALLS] = ['W', 'Y', 'R'];
const DOTS: [char; BALLS] = ['·', '+', '×'];
const PLAIN_DOTS: [char; BALLS] = ['.', '+', 'x'];

/// Weights of what shares a cell; the cloth weighs 2 (see [`Ink`]).
const DOT_WEIGHT: u8 = 3;
const RING_WEIGHT: u8 = 4;
const BALL_WEIGHT: u8 = 6;

/// Draws the table in the upper middle of `area`, as large as fits.
pub fn draw_table(app: &App, area: Rect, buffer: &mut Buffer) {
    let mapping = Mapping::fit(app.table(), area);
    if mapping.bed.is_empty() {
        return;
    }
    let balls = app.watched().map_or(app.layout().balls, |shot| shot.recording.positions(app.playback().time));
    let marked = (app.mode() == Mode::Placing).then(|| balls[app.selected()]);
    draw_rails(&mapping, app.table().diamond(), marked, app.theme(), app.look(), buffer);
    let scene = Scene { app, mapping, balls };
    if app.look().glyphs == Glyphs::Letters {
        scene.draw_letters(buffer);
    } else {
        scene.draw_blocks(buffer);
    }
}

struct Scene<'a> {
    app: &'a App,
    mapping: Mapping,
    balls: [DVec2; BALLS],
}

impl Scene<'_> {
    fn is_clear(&self, place: DVec2) -> bool {
        self.balls.iter().all(|ball| ball.distance(place) > CLEAR_RADII * self.mapping.radius)
    }

    /// Calls `draw` with each dot of the predicted paths that no ball hides.
    fn each_dot(&self, mut draw: impl FnMut(usize, DVec2)) {
        let Some(shot) = self.app.shot() else { return };
        for (ball, path) in shot.paths.iter().enumerate().rev() {
            for dot in path.iter().filter(|dot| self.is_clear(dot.place)) {
                draw(ball, dot.place);
            }
        }
    }

    /// Calls `draw` with the places where balls will be: the first contact, and where they come to rest.
    fn each_ghost(&self, mut draw: impl FnMut(usize, DVec2)) {
        let Some(shot) = self.app.shot() else { return };
        let contact = shot.contact.map(|contact| (0, contact.place));
        let ends = shot.recording.final_layout().balls.into_iter().enumerate();
        for (ball, place) in contact.into_iter().chain(ends) {
            if self.is_clear(place) {
                draw(ball, place);
            }
        }
    }

    /// The balls, the selected one last, so that it lies on top.
    fn order(&self) -> [usize; BALLS] {
        let selected = self.app.selected();
        [(selected + 1) % BALLS, (selected + 2) % BALLS, selected]
    }

    fn draw_blocks(&self, buffer: &mut Buffer) {
        let (theme, glyphs) = (self.app.theme(), self.app.look().glyphs);
        let mapping = &self.mapping;
        let sprite = Sprite::new(mapping, glyphs);
        let mut canvas = Canvas::new(mapping.bed, glyphs, theme.cloth);
        let (width, height) = canvas.size();
        let grid = DVec2::new(f64::from(width), f64::from(height))
            / DVec2::new(f64::from(mapping.bed.width), f64::from(mapping.bed.height));
        self.each_dot(|ball, place| {
            let at = (mapping.to_cells(place) * grid).floor();
            canvas.set(at.x as i32, at.y as i32, Ink { color: theme.paths[ball], weight: DOT_WEIGHT });
        });
        if mapping.ball_columns() >= RING_COLUMNS && glyphs == Glyphs::Sextant {
            self.each_ghost(|ball, place| {
                sprite.stamp_ring(&mut canvas, mapping, place, Ink { color: theme.paths[ball], weight: RING_WEIGHT });
            });
        }
        for ball in self.order() {
            sprite.stamp(
                &mut canvas,
                mapping,
                self.balls[ball],
                Ink { color: theme.balls[ball], weight: BALL_WEIGHT },
            );
        }
        canvas.paint(buffer);
    }

    fn draw_letters(&self, buffer: &mut Buffer) {
        let (theme, look) = (self.app.theme(), self.app.look());
        let mapping = &self.mapping;
        buffer.set_style(mapping.bed, Style::new().bg(theme.cloth));
        let mut put = |place: DVec2, symbol: char, color: Color| {
            let cell = &mut buffer[mapping.to_cell(place)];
            cell.set_char(symbol).set_fg(color);
        };
        let dots = look.pick(DOTS, PLAIN_DOTS);
        self.each_dot(|ball, place| put(place, dots[ball], theme.paths[ball]));
        self.each_ghost(|ball, place| put(place, LETTERS[ball].to_ascii_lowercase(), theme.paths[ball]));
        for ball in self.order() {
            let (x, y) = mapping.to_cell(self.balls[ball]);
            let wide = mapping.ball_columns() >= RING_COLUMNS && x > mapping.bed.x && x + 1 < mapping.bed.right();
            let text = if wide { format!("({})", LETTERS[ball]) } else { LETTERS[ball].to_string() };
            let mut style = Style::new().fg(theme.balls[ball]).add_modifier(Modifier::BOLD);
            if self.app.mode() == Mode::Placing && ball == self.app.selected() {
                style = style.add_modifier(Modifier::REVERSED);
            }
            buffer.set_stringn(x - u16::from(wide), y, &text, 3, style);
        }
    }
}
