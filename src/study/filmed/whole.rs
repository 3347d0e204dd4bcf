//! Whole shots: the stroke is fitted to the cue ball's first two seconds, and the seconds after are predicted, with all that
//! the ball meets.

use glam::DVec2;

use super::{
    chains::soften,
    film::{FilmedShot, Sample},
    motion::Motion,
};
use crate::{
    simulation::Follower,
    statistics::fit,
    table::{Layout, PAIRS, Table},
};

/// How much of the cue ball's course is fitted, s.
pub const FITTED: f64 = 2.0;

/// Times after the stroke at which the prediction is judged, s.
pub const JUDGED: [f64; 3] = [3.0, 4.0, 5.0];

/// How a whole shot came out.
#[derive(Clone, Debug)]
pub struct Whole {
    /// Number of the shot in the match.
    pub shot: u32,
    /// The cue ball's motion just after the stroke.
    pub motion: Motion,
    /// When it was struck, s of the film.
    pub start: f64,
    /// Root mean square of what is left on the fitted part, m.
    pub rms: f64,
    /// Distance of the cue ball from where the film shows it, at the times of `JUDGED`, m.
    pub errors: [f64; 3],
}

impl FilmedShot {
    /// Where the balls lay before the stroke; the noise of the film is taken off balls that it makes overlap.
    pub fn layout(&self, table: &Table) -> Layout {
        let mut balls = [0, 1, 2].map(|ball: usize| self.balls[ball][0].place.clamp(-table.reach(), table.reach()));
        for (one, other) in PAIRS {
            let apart = balls[one] - balls[other];
            let missing = 2.0 * table.radius - apart.length();
            if missing > 0.0 && missing < 0.01 {
                let push = 0.5 * (missing + 1e-6) * apart.normalize_or_zero();
                balls[one] += push;
                balls[other] -= push;
            }
        }
        Layout::new(balls)
    }

    /// Whether the film goes on long enough to judge.
    pub fn is_long_enough(&self) -> bool {
        self.balls[0].last().is_some_and(|last| last.time > self.start + JUDGED[2])
    }
}

/// Fits the stroke of a shot on `table` and predicts the rest.
pub fn play(table: &Table, shot: &FilmedShot) -> Option<Whole> {
    let layout = shot.layout(table);
    let track = &shot.balls[0];
    let used: Vec<Sample> =
        track.iter().copied().filter(|s| s.time > shot.start + 0.005 && s.time < shot.start + FITTED).collect();
    let (first, second) = (*used.first()?, *used.get(1)?);
    let velocity = (second.place - first.place) / (second.time - first.time);
    let mut residuals = |numbers: &[f64; 6], out: &mut Vec<f64>| {
        out.clear();
        let [vx, vy, ux, uy, side, late] = *numbers;
        let motion = motion_of(&layout, [vx, vy, ux, uy, side]);
        let times: Vec<f64> = used.iter().map(|s| (s.time - shot.start - late).max(0.0)).collect();
        let followed = Follower::new(&times, 0).of(table, &layout, &motion.impulse(table.radius));
        for (sample, place) in used.iter().zip(&followed.places) {
            let miss = *place - sample.place;
            out.extend([soften(miss.x), soften(miss.y)]);
        }
        // Where the film says nothing, less slip and spin are likelier, and a level cue.
        let across = DVec2::new(ux, uy).dot(velocity.perp().normalize_or_zero());
        out.extend([2e-4 * ux, 2e-4 * uy, 2e-4 * side, 4e-3 * across, 0.1 * late]);
    };
    let mut best: Option<([f64; 6], f64)> = None;
    let speed = velocity.length();
    for roll in [-0.4, 0.1, 0.6, 1.1] {
        for share in [-0.9, -0.4, 0.0, 0.4, 0.9] {
            // A ball that rolls has lost speed by the first samples less than one that slides.
            let slip = (1.0 - roll) * velocity;
            let start = [1.02 * velocity.x, 1.02 * velocity.y, slip.x, slip.y, share * speed, 0.0];
            let found = fit(start, [1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 1e-4], 25, &mut residuals);
            if best.as_ref().is_none_or(|(_, squares)| found.squares < *squares) {
                best = Some((found.parameters, found.squares));
            }
        }
    }
    let ([vx, vy, ux, uy, side, late], squares) = best?;
    let motion = motion_of(&layout, [vx, vy, ux, uy, side]);
    let start = shot.start + late;
    let times = JUDGED.map(|time| time - late);
    let followed = Follower::new(&times, 0).of(table, &layout, &motion.impulse(table.radius));
    let errors = [0, 1, 2].map(|index| followed.places[index].distance(shot.place(0, shot.start + JUDGED[index])));
    Some(Whole { shot: shot.number, motion, start, rms: (squares / used.len() as f64).sqrt(), errors })
}

fn motion_of(layout: &Layout, [vx, vy, ux, uy, side]: [f64; 5]) -> Motion {
    Motion { place: layout.balls[0], velocity: DVec2::new(vx, vy), slip: DVec2::new(ux, uy), side }
}
