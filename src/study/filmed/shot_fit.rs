//! Predictions of whole shots: the stroke is fitted to the cue ball's first two seconds, and the following seconds are
//! predicted with all impacts.

use glam::DVec2;

use super::{
    film::{FilmedShot, Sample},
    motion::{Motion, best_fit, extend_with_misses},
};
use crate::{
    simulation::Follower,
    statistics::Fit,
    table::{Layout, PAIRS, Table},
};

/// Duration of the fitted part of the cue ball's course, s.
pub const FITTED_SECONDS: f64 = 2.0;

/// Times after the stroke at which the prediction is evaluated, s.
pub const EVALUATION_TIMES: [f64; 3] = [3.0, 4.0, 5.0];

/// The prediction of a whole shot, compared with the film.
#[derive(Clone, Debug)]
pub struct ShotFit {
    /// The cue ball's motion just after the stroke.
    pub motion: Motion,
    /// Time of the stroke, s of the film.
    pub start: f64,
    /// Root mean square residual on the fitted part, m.
    pub rms: f64,
    /// Distances between the predicted and the filmed cue ball at the times of `EVALUATION_TIMES`, m.
    pub errors: [f64; 3],
}

impl FilmedShot {
    /// Returns the positions of the balls before the stroke. Overlaps from the noise of the film are removed.
    pub fn layout(&self, table: &Table) -> Layout {
        let mut balls = [0, 1, 2].map(|ball: usize| self.balls[ball][0].position.clamp(-table.reach(), table.reach()));
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

    /// Whether the film is long enough for the evaluation.
    pub fn is_long_enough(&self) -> bool {
        self.balls[0].last().is_some_and(|last| last.time > self.start + EVALUATION_TIMES[2])
    }
}

/// Fits the stroke of a shot on `table` and predicts the rest; `None` if the film has fewer than two samples for the fit.
pub fn fit_shot(table: &Table, shot: &FilmedShot) -> Option<ShotFit> {
    let layout = shot.layout(table);
    let track = &shot.balls[0];
    let used: Vec<Sample> =
        track.iter().copied().filter(|s| s.time > shot.start + 0.005 && s.time < shot.start + FITTED_SECONDS).collect();
    let (first, second) = (*used.first()?, *used.get(1)?);
    let velocity = (second.position - first.position) / (second.time - first.time);
    let residuals = |numbers: &[f64; 6], out: &mut Vec<f64>| {
        out.clear();
        let [vx, vy, ux, uy, side, late] = *numbers;
        let motion = motion_of(&layout, [vx, vy, ux, uy, side]);
        let times: Vec<f64> = used.iter().map(|s| (s.time - shot.start - late).max(0.0)).collect();
        let followed = Follower::new(&times, 0).follow(table, &layout, &motion.impulse(table.radius));
        extend_with_misses(out, &followed.positions, &used);
        // A weak prior: small slip and spin and a level cue are likelier if the film does not determine them.
        let across = DVec2::new(ux, uy).dot(velocity.perp().normalize_or_zero());
        out.extend([2e-4 * ux, 2e-4 * uy, 2e-4 * side, 4e-3 * across, 0.1 * late]);
    };
    let speed = velocity.length();
    let starts = [-0.4, 0.1, 0.6, 1.1].into_iter().flat_map(|roll| {
        // By the first samples, a rolling ball has lost less speed than a sliding one.
        let slip = (1.0 - roll) * velocity;
        let sides = [-0.9, -0.4, 0.0, 0.4, 0.9];
        sides.map(|share| [1.02 * velocity.x, 1.02 * velocity.y, slip.x, slip.y, share * speed, 0.0])
    });
    let Fit { parameters, squares, .. } = best_fit(starts, [1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 1e-4], 25, residuals)?;
    let [vx, vy, ux, uy, side, late] = parameters;
    let motion = motion_of(&layout, [vx, vy, ux, uy, side]);
    let start = shot.start + late;
    let times = EVALUATION_TIMES.map(|time| time - late);
    let followed = Follower::new(&times, 0).follow(table, &layout, &motion.impulse(table.radius));
    let errors = [0, 1, 2]
        .map(|index| followed.positions[index].distance(shot.position(0, shot.start + EVALUATION_TIMES[index])));
    Some(ShotFit { motion, start, rms: (squares / used.len() as f64).sqrt(), errors })
}

fn motion_of(layout: &Layout, [vx, vy, ux, uy, side]: [f64; 5]) -> Motion {
    Motion { position: layout.balls[0], velocity: DVec2::new(vx, vy), slip: DVec2::new(ux, uy), side }
}
