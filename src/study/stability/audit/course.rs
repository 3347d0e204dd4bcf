//! A cursor over one ball's course, piece by piece.

use super::{Motion, aloft::energy, moment::Bounces};
use crate::{
    physics::{BallState, Impulse, SpatialState},
    simulation::{Constants, Segment},
    study::stability::trace::{Piece, Trace},
    table::Table,
};

/// The current position in a ball's course.
#[derive(Clone, Copy)]
pub struct Course<'a> {
    ball: usize,
    pieces: &'a [Piece],
    /// Number of pieces that have begun; one more when the last has ended.
    begun: usize,
    /// State at the end of the current piece, or after the stroke.
    pub before: SpatialState,
    /// Energy at that end, at the start of that piece, and the largest involved energy of the last change, m²/s².
    pub energy: f64,
    pub first_energy: f64,
    pub largest: f64,
    /// The bounces that a resting contact replaces, and the time from which on, s.
    pub bounces: Option<(f64, Bounces)>,
}

impl<'a> Course<'a> {
    /// Creates the course of a ball, starting at the stroke.
    pub fn new(table: &Table, trace: &'a Trace, ball: usize) -> Self {
        let pieces = &trace.pieces[ball];
        let mut before = SpatialState::from(BallState::at_rest(trace.layout.balls[ball]));
        if ball == 0 {
            let Impulse { velocity, spin, lift } = trace.impulse;
            // A stroke that lifts a ball no faster than this leaves it on the cloth.
            let lift = if lift > trace.constants.tolerance.slowest_in_air { lift } else { 0.0 };
            (before.velocity, before.spin) = (velocity.extend(lift), spin);
        }
        let energy = energy(table, &before);
        Self { ball, pieces, begun: 0, before, energy, first_energy: energy, largest: energy, bounces: None }
    }

    /// Returns the time of the next change, s; infinity after the end.
    pub fn changes(&self) -> f64 {
        match (self.pieces.get(self.begun), self.pieces.last()) {
            (Some(piece), _) => piece.segment.start,
            (None, Some(last)) if self.begun == self.pieces.len() => last.end,
            _ => f64::INFINITY,
        }
    }

    /// Returns the current piece.
    pub fn piece(&self) -> Option<&'a Piece> {
        self.pieces.get(self.begun.checked_sub(1)?)
    }

    /// Returns the segment of the current piece if the ball is in resting contact.
    pub fn resting(&self) -> Option<&'a Segment> {
        self.piece().map(|piece| &piece.segment).filter(|segment| segment.motion == Motion::Resting)
    }

    /// Whether the ball is in the air, or the stroke lifts it.
    pub fn flies(&self) -> bool {
        self.piece().map_or(self.before.velocity.z > 0.0, |piece| piece.segment.motion == Motion::Flying)
    }

    /// Whether the ball has left the table.
    pub fn is_off(&self, trace: &Trace) -> bool {
        let is_at_end = trace.end.off_table[self.ball];
        self.piece().map_or(is_at_end, |piece| piece.segment.motion == Motion::OffTable)
    }

    /// Returns the state of the ball at time `now`, s.
    pub fn state(&self, constants: &Constants, now: f64) -> SpatialState {
        self.piece().map_or(self.before, |piece| piece.segment.spatial_after(constants, now - piece.segment.start))
    }

    /// Returns the state `by` seconds after the end of the current piece, extrapolated beyond it: rounding decides on which
    /// side of a landing that end is.
    pub fn beside(&self, constants: &Constants, by: f64) -> SpatialState {
        self.piece().map_or(self.before, |piece| {
            piece.segment.spatial_after(constants, (piece.end - piece.segment.start + by).max(0.0))
        })
    }

    /// Begins the next piece, or the rest after the last one, and returns the state at its start.
    pub fn begin(&mut self, table: &Table, trace: &Trace) -> SpatialState {
        self.begun += 1;
        let Some(piece) = self.piece() else { return trace.end.balls[self.ball].into() };
        let first = piece.segment.spatial_after(&trace.constants, 0.0);
        self.before = piece.segment.spatial_after(&trace.constants, piece.end - piece.segment.start);
        let last = self.energy;
        self.first_energy = energy(table, &first);
        self.energy = energy(table, &self.before);
        self.largest = last.max(self.first_energy).max(self.energy);
        first
    }
}
