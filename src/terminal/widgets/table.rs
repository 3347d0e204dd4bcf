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
        canvas::{Canvas, Ink, sub_pixels},
        geometry::Mapping,
        look::Glyphs,
        shot::DOT_SPACING,
        sprites::Sprite,
    },
};

/// Dots and rings nearer to a ball than this, in radii, are left out: three colours do not fit a cell.
const CLEAR_RADII: f64 = 2.2;
/// Sub-pixels from one dot of a path to the next.
const DOT_PIXELS: f64 = 3.6;
/// Columns across a ball from which on its letter has room for brackets.
const BRACKET_COLUMNS: f64 = 2.0;
/// The cue behind the ball before the stroke, from its tip to where it is left out, in ball radii.
const CUE: (f64, f64) = (1.8, 14.0);
/// Dots of the cue in a ball radius: it is to be a line.
const CUE_DOTS: f64 = 4.0;
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

    /// Calls `draw` with each dot of the predicted paths that no ball hides; there are `across` sub-pixels in a cell.
    fn each_dot(&self, across: u16, mut draw: impl FnMut(usize, DVec2)) {
        let Some(shot) = self.app.shot() else { return };
        let pixel = 1.0 / (self.mapping.scale().x * f64::from(across));
        let stride = (DOT_PIXELS * pixel / DOT_SPACING).round().max(1.0) as usize;
        for (ball, path) in shot.paths.iter().enumerate().rev() {
            for dot in path.iter().step_by(stride).filter(|dot| self.is_clear(dot.place)) {
                draw(ball, dot.place);
            }
        }
    }

    /// Calls `draw` with the places where balls will be: the first contact, and where they come to rest.
    fn each_ghost(&self, mut draw: impl FnMut(usize, DVec2)) {
        let Some(shot) = self.app.shot() else { return };
        // At the contact the ring touches the object ball; only the cue ball itself may hide it.
        let contact = shot.contact.map(|contact| contact.place);
        if let Some(place) = contact.filter(|place| place.distance(self.balls[0]) > CLEAR_RADII * self.mapping.radius) {
            draw(0, place);
        }
        for (ball, place) in shot.recording.final_layout().balls.into_iter().enumerate() {
            if self.is_clear(place) {
                draw(ball, place);
            }
        }
    }

    /// Calls `draw` along the cue, as long as it has not struck.
    fn each_cue_dot(&self, mut draw: impl FnMut(DVec2)) {
        let Some(shot) = self.app.shot().filter(|_| self.app.playback().time == 0.0) else { return };
        let back = -DVec2::from_angle(shot.cue.phi);
        let dots = ((CUE.1 - CUE.0) * CUE_DOTS) as u32;
        for dot in 0..=dots {
            draw(self.balls[0] + back * (self.mapping.radius * (CUE.0 + f64::from(dot) / CUE_DOTS)));
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
        let dot = |canvas: &mut Canvas, place: DVec2, color: Color| {
            let at = (mapping.to_cells(place) * grid).floor();
            canvas.set(at.x as i32, at.y as i32, Ink { color, weight: DOT_WEIGHT });
        };
        self.each_dot(sub_pixels(glyphs).0, |ball, place| dot(&mut canvas, place, theme.paths[ball]));
        self.each_cue_dot(|place| dot(&mut canvas, place, theme.sight));
        if glyphs == Glyphs::Sextant {
            self.each_ghost(|ball, place| {
                sprite.stamp_ring(&mut canvas, mapping, place, Ink { color: theme.paths[ball], weight: RING_WEIGHT });
            });
        }
        for ball in self.order() {
            sprite.stamp(&mut canvas, mapping, self.balls[ball], Ink { color: theme.balls[ball], weight: BALL_WEIGHT });
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
        self.each_dot(1, |ball, place| put(place, dots[ball], theme.paths[ball]));
        self.each_ghost(|ball, place| put(place, LETTERS[ball].to_ascii_lowercase(), theme.paths[ball]));
        for ball in self.order() {
            let (x, y) = mapping.to_cell(self.balls[ball]);
            let wide = mapping.ball_columns() >= BRACKET_COLUMNS && x > mapping.bed.x && x + 1 < mapping.bed.right();
            let text = if wide { format!("({})", LETTERS[ball]) } else { LETTERS[ball].to_string() };
            let mut style = Style::new().fg(theme.balls[ball]).add_modifier(Modifier::BOLD);
            if self.app.mode() == Mode::Placing && ball == self.app.selected() {
                style = style.add_modifier(Modifier::REVERSED);
            }
            buffer.set_stringn(x - u16::from(wide), y, &text, 3, style);
        }
    }
}
