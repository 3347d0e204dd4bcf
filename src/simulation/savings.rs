//! Optimizations of the engine, each with a switch, so that a benchmark can measure its effect.
//!
//! An optimization omits work whose result is known: with its switch off, the engine does this work and produces identical bits. The
//! switches are associated constants of a type, which costs nothing at run time.

/// The switches; all optimizations are on by default.
pub trait Savings {
    /// Balls at rest predict nothing: neither cushion impacts nor, for two of them, collisions.
    const BALLS_AT_REST: bool = true;
    /// Predictions of a ball or a pair are kept until an event changes a trajectory. Otherwise everything is predicted again at every
    /// event, from the times at which the trajectories started.
    const KEPT_PREDICTIONS: bool = true;
    /// Only cushions that a ball can reach before its motion ends are solved for.
    const CUSHIONS_IN_REACH: bool = true;
    /// No root is sought for two balls whose trajectories are separated by a line.
    const SEPARATED_COURSES: bool = true;
    /// While a single ball moves, a specialized loop follows it, which compares no event times and does not store the trajectory in
    /// memory. It keeps predictions, and is therefore off if [`Savings::KEPT_PREDICTIONS`] is off.
    const LONE_BALL: bool = true;
    /// A ball that only rolls to rest is not simulated if the observer does not need the end.
    const LAST_ROLLS: bool = true;
    /// The simulation ends when the observer breaks, because the outcome is decided.
    const EARLY_END: bool = true;
    /// The simulation ends before a resting contact is simulated if the remaining energy cannot bring the cue ball to any of the balls for
    /// which the observer waits.
    const OUT_OF_REACH: bool = true;
}

/// All optimizations; used by [`super::simulate`].
#[derive(Clone, Copy, Debug)]
pub struct AllSavings;

impl Savings for AllSavings {}
