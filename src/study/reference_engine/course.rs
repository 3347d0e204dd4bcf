//! The course of all balls until the next event: free balls on parabolas, balls in resting contact by their piece.

use super::{Numbers, Real, contact::Balls, extrapolation::State, piece::Piece};
use crate::table::BALLS;

/// The present state of the balls, and their course from here.
#[derive(Clone, Debug)]
pub struct Course<R> {
    /// The table.
    pub numbers: Numbers<R>,
    /// The balls.
    pub balls: Balls<R>,
    /// The piece of the balls with pressing contacts.
    pub piece: Option<Piece<R>>,
}

impl<R: Real> Course<R> {
    fn is_free(&self, ball: usize) -> bool {
        self.piece.as_ref().is_none_or(|piece| !piece.involves(ball))
    }

    /// Returns the free balls, and the durations of their present motions, s.
    pub fn free_motions(&self) -> impl Iterator<Item = (usize, R)> {
        let free = (0..BALLS).filter(|ball| self.is_free(*ball));
        free.filter_map(|ball| Some((ball, self.balls[ball].motion_duration(&self.numbers)?)))
    }

    /// Returns all balls at a `tau` of their piece, and the time, s.
    pub fn at(&self, piece: &Piece<R>, tau: R) -> (Balls<R>, R) {
        let state = if tau > R::zero() { piece.at(tau) } else { return (self.balls, R::zero()) };
        (self.merged(&state).0, state.time)
    }

    /// Returns all balls `time` later, and the work of friction per mass.
    pub fn after(&self, time: R) -> (Balls<R>, R) {
        let state = match &self.piece {
            Some(piece) if time > R::zero() => piece.at(piece.tau_at(time)),
            _ => State { time, work: R::zero(), balls: self.balls },
        };
        self.merged(&State { time, ..state })
    }

    fn merged(&self, state: &State<R>) -> (Balls<R>, R) {
        let (mut balls, mut work) = (state.balls, state.work);
        for index in (0..BALLS).filter(|ball| self.is_free(*ball)) {
            let (ball, lost) = self.balls[index].after(&self.numbers, state.time);
            (balls[index], work) = (ball, work + lost);
        }
        (balls, work)
    }
}
