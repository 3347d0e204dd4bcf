//! The objects drawn on the cloth and their positions: the paths, the balls, their ghosts, and the cue.

use glam::DVec2;

use crate::{
    table::BALLS,
    terminal::{
        Capabilities, Glyphs, Mapping,
        shot::{DOT_SPACING, Dot},
        ui::{Spot, TableView, canvas::sub_pixels, sprites::Sprite},
    },
};

/// Distance of the dots of a path, in columns: in most character sets, and in half blocks, where a dot is one column wide.
const DOT_COLUMNS: f64 = 1.8;
const HALF_DOT_COLUMNS: f64 = 2.6;
/// Length of the cue drawn before the stroke, m, and the distance of its dots, m: close enough to look like a line.
const CUE_LENGTH: f64 = 0.4;
const CUE_DOTS: f64 = 0.008;
/// Number of dots in a dash of the second shot's path, and in the gap after it: a tenth of a metre each.
const DASH: usize = 4;
/// Distance that dots keep from a ghost, relative to the distance from a ball: a dot next to a ring would need a third colour in the cell.
const GHOST_CLEAR: f64 = 0.95;
/// Time for which a ball's recent path counts as its trail, s.
const TRAIL: f64 = 0.4;

/// Time of a part of a path relative to the present.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Age {
    /// The ball has not reached it yet.
    Ahead,
    /// The ball has just passed it.
    Trail,
    /// The ball passed it earlier.
    Past,
}

impl Age {
    /// The age of an `event` as seen at `time`, both s since the stroke.
    fn at(event: f64, time: f64) -> Self {
        match time - event {
            since if since < 0.0 => Self::Ahead,
            since if since < TRAIL => Self::Trail,
            _ => Self::Past,
        }
    }
}

/// A ghost: the cue ball at a contact, or a ball at its final position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ghost {
    pub ball: usize,
    pub position: DVec2,
    pub age: Age,
}

/// A view of a table with the computed positions of the balls.
pub struct TablePicture<'a> {
    pub view: &'a TableView<'a>,
    pub caps: Capabilities,
    pub mapping: Mapping,
    /// Seconds since the stroke; zero while balls are placed.
    pub time: f64,
    /// Drawn positions of the balls, or of the shadows of those in the air.
    pub balls: [DVec2; BALLS],
    /// Heights of the balls, m; zero for hops too small to see.
    pub heights: [f64; BALLS],
    /// Which balls have left the table.
    pub off_table: [bool; BALLS],
    pub sprite: Sprite,
    /// Distance from a ball from which on something else can be drawn, m.
    pub clear: f64,
}

impl TablePicture<'_> {
    /// Whether no ball hides a position.
    pub fn is_clear(&self, place: DVec2) -> bool {
        self.balls.iter().all(|ball| ball.distance(place) > self.clear)
    }

    /// Half the width of a ball's sprite, m.
    fn reach(&self) -> f64 {
        self.sprite.reach(&self.mapping, self.caps.glyphs)
    }

    /// Whether the sprite of one of these balls, or a ring in its place, reaches into the cell of a position.
    pub fn has_picture(&self, place: DVec2, balls: &[DVec2]) -> bool {
        let (column, row) = self.mapping.to_cell(place);
        let Some(middle) = self.mapping.to_metres(column, row) else { return false };
        let half = 0.5 / self.mapping.scale();
        balls.iter().any(|ball| ball.clamp(middle - half, middle + half).distance(*ball) < self.reach())
    }

    /// Position of the sprite of a ball in the air: above its shadow by its height, and by at least enough to be seen separately.
    pub fn lifted(&self, ball: usize) -> DVec2 {
        let rows = match self.caps.glyphs {
            Glyphs::Letters => 1.0,
            glyphs => 2.0 / f64::from(sub_pixels(glyphs).1),
        };
        let height = self.heights[ball];
        let least = rows / self.mapping.scale().y;
        self.balls[ball] + if height > 0.0 { DVec2::new(0.0, height + least) } else { DVec2::ZERO }
    }

    /// The extra marks to draw. An outline of a ball may touch a ball, a dot may not.
    pub fn spots(&self) -> impl Iterator<Item = &Spot> {
        self.view.spots.iter().filter(|spot| spot.is_ball || self.is_clear(spot.position))
    }

    /// Whether the dot with this `number` of a path is drawn over the table. A path in the air is dashed.
    fn is_drawn(&self, number: usize, dot: &Dot) -> bool {
        let is_kept = !dot.is_aloft() || number.is_multiple_of(2) || self.caps.glyphs == Glyphs::Letters;
        is_kept && self.mapping.is_on_bed(dot.position) && self.is_clear(dot.position)
    }

    /// Calls `draw` with each visible dot of the predicted paths, that is, hidden by no ball and no ghost.
    pub fn each_dot(&self, mut draw: impl FnMut(usize, &Dot, Age)) {
        let Some(shot) = self.view.shot else { return };
        let columns = if self.caps.glyphs == Glyphs::Half { HALF_DOT_COLUMNS } else { DOT_COLUMNS };
        let stride = (columns / (self.mapping.scale().x * DOT_SPACING)).round().max(1.0) as usize;
        let ghosts = self.ghosts();
        let absent: Vec<DVec2> =
            ghosts.iter().map(|ghost| ghost.position).chain(self.view.film.into_iter().flatten()).collect();
        let is_free = |place: DVec2| absent.iter().all(|other| other.distance(place) > GHOST_CLEAR * self.clear);
        let balls = if self.view.cue_path_only { 1 } else { BALLS };
        for (ball, path) in shot.paths[..balls].iter().enumerate().rev() {
            let seen = path.iter().step_by(stride).enumerate();
            for (_, dot) in seen.filter(|(number, dot)| self.is_drawn(*number, dot) && is_free(dot.position)) {
                draw(ball, dot, Age::at(dot.time, self.time));
            }
        }
    }

    /// Calls `draw` with each dot of the cue ball's path in the second shot, dashed, that no ball hides.
    pub fn each_other_dot(&self, mut draw: impl FnMut(DVec2)) {
        let dots = self.view.other.map_or(&[][..], |shot| &shot.paths[0]);
        let dashes = dots.chunks(DASH).step_by(2).flatten().enumerate();
        dashes.filter(|(number, dot)| self.is_drawn(*number, dot)).for_each(|(_, dot)| draw(dot.position));
    }

    /// The ghosts: the cue ball at its first contact with each object ball, and the final positions of all balls that move.
    pub fn ghosts(&self) -> Vec<Ghost> {
        let Some(shot) = self.view.shot.filter(|_| self.view.film.is_none()) else { return Vec::new() };
        // A ring that a sprite would cut is left out.
        let clear = self.clear.max(2.0 * self.reach());
        let is_clear = |place: DVec2, ball: usize| self.balls[ball].distance(place) > clear;
        let contacts = shot.contacts.iter().filter_map(|contact| {
            // Enlarged sprites should touch where the balls do.
            let way = contact.position - contact.other;
            let place = contact.other + way.normalize_or(DVec2::X) * way.length().max(2.0 * self.reach());
            let is_clear = (0..BALLS).all(|ball| ball == contact.ball || is_clear(place, ball));
            is_clear.then(|| Ghost { ball: 0, position: place, age: Age::at(contact.time, self.time) })
        });
        let ends = shot.recording.final_layout().balls.into_iter().enumerate();
        let ends = ends.filter(|&(_, place)| (0..BALLS).all(|ball| is_clear(place, ball)));
        contacts.chain(ends.map(|(ball, place)| Ghost { ball, position: place, age: Age::Ahead })).collect()
    }

    /// Before the stroke, calls `draw` along the part of the cue that is over the cloth, with the character of its direction.
    pub fn each_cue_dot(&self, mut draw: impl FnMut(DVec2, char)) {
        let Some(shot) = self.view.shot.filter(|_| self.view.time == 0.0) else { return };
        let ahead = DVec2::from_angle(shot.cue.phi);
        let (tip, sign) = (1.2 * self.reach(), cue_sign(ahead, self.caps));
        let places = (0..=(CUE_LENGTH / CUE_DOTS) as u32)
            .map(|dot| self.balls[0] - ahead * (tip + f64::from(dot) * CUE_DOTS))
            .take_while(|place| self.mapping.is_on_bed(*place));
        places.for_each(|place| draw(place, sign));
    }

    /// The balls in drawing order, the selected one last, on top. A ball that takes no part lies far beyond the table, not just next to it
    /// as an enlarged sprite may; it is left out.
    pub fn order(&self) -> impl Iterator<Item = usize> {
        let selected = self.view.front;
        let all = [(selected + 1) % BALLS, (selected + 2) % BALLS, selected];
        all.into_iter().filter(|ball| !self.off_table[*ball] && self.mapping.is_on_bed(0.5 * self.balls[*ball]))
    }

    /// The balls in drawing order, those in the air after those on the cloth, the highest last.
    pub fn upwards(&self) -> Vec<usize> {
        let mut balls: Vec<usize> = self.order().collect();
        balls.sort_by(|one, other| self.heights[*one].total_cmp(&self.heights[*other]));
        balls
    }
}

/// The line character of a direction: of the four available, the one with the nearest slope on the screen.
pub fn cue_sign(direction: DVec2, caps: Capabilities) -> char {
    let signs = caps.pick(['─', '╱', '│', '╲'], ['-', '/', '|', '\\']);
    // A row is as high as two columns are wide.
    let eighths = (direction * DVec2::new(1.0, 0.5)).to_angle() / std::f64::consts::FRAC_PI_4;
    signs[(eighths.round() as i32).rem_euclid(4) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        physics::CueInputs,
        table::{Layout, Table},
        terminal::{
            Shot,
            ui::{
                drawn,
                table::{CLEAR_PICTURES, CLEAR_RADII, separated},
            },
        },
    };
    use ratatui::layout::Rect;

    /// Calls `check` with the picture at `time` of a shot that meets both balls.
    fn at(columns: u16, time: f64, check: impl Fn(&TablePicture, &Shot)) {
        let table = Table::preset("textbook").unwrap();
        let layout = Layout::parse("-1,0 0,0.02 0.6,0.1", &table).unwrap();
        let shot = Shot::new(&table, &layout, CueInputs::parse("0,0.3,0,0,4").unwrap(), true, "test").unwrap();
        assert_eq!(shot.contacts.len(), 2, "{:?}", shot.contacts);
        drawn(Rect::default(), Capabilities::TRUE_COLOUR, |ui| {
            let view = TableView { shot: Some(&shot), time, ..TableView::new(&table, &layout) };
            let mapping = Mapping::fit(&table, Rect::new(0, 0, columns, 60));
            let sprite = Sprite::new(&mapping, Glyphs::Sextant);
            let reach = sprite.reach(&mapping, Glyphs::Sextant);
            let clear = (CLEAR_RADII * mapping.radius).max(CLEAR_PICTURES * reach);
            let balls = separated(shot.recording.positions(time), 2.0 * reach);
            let (heights, off_table) = ([0.0; BALLS], [false; BALLS]);
            let lying =
                TablePicture { view: &view, caps: ui.caps, mapping, time, balls, heights, off_table, sprite, clear };
            check(&lying, &shot);
        });
    }

    #[test]
    fn each_first_contact_has_an_uncut_ring_for_the_cue_ball() {
        for columns in [64, 112, 176] {
            at(columns, 0.0, |picture, shot| {
                let ghosts = picture.ghosts();
                for contact in &shot.contacts {
                    let is_there = |ghost: &Ghost| ghost.ball == 0 && ghost.position.distance(contact.position) < 0.07;
                    assert!(ghosts.iter().any(is_there), "{columns}: {ghosts:?}");
                }
                let reach = picture.reach();
                for ghost in &ghosts {
                    let nearest =
                        picture.balls.map(|ball| ball.distance(ghost.position)).into_iter().fold(1.0, f64::min);
                    assert!(nearest > 2.0 * reach - 1e-9, "{columns}: {ghost:?} is {nearest} from a ball");
                    picture.each_dot(|_, dot, _| {
                        assert!(dot.position.distance(ghost.position) > reach, "{columns}: {ghost:?}");
                    });
                }
            });
        }
    }

    #[test]
    fn a_path_ages_as_its_ball_runs_along_it() {
        let count = |time: f64| {
            let ages = std::cell::RefCell::new([0; 3]);
            at(112, time, |picture, _| picture.each_dot(|_, _, age| ages.borrow_mut()[age as usize] += 1));
            ages.into_inner()
        };
        let [ahead, trail, past] = count(0.0);
        assert!(ahead > 20 && trail + past == 0, "before the stroke all of it lies ahead");
        let [later, trail, past] = count(0.6);
        assert!(later < ahead && trail > 3 && past > 3, "{later} {trail} {past}");
        assert_eq!(count(60.0)[..2], [0, 0]);
    }
}
