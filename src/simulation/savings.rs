//! What the engine spares itself, each with a switch, so that a bench can tell what it is worth.
//!
//! A saving leaves out work whose result is known beforehand: with its switch off the engine does that work and comes to
//! the same bits. The switches are constants of a type, which costs nothing at run time.

/// The switches; all savings are on unless a type says otherwise.
pub trait Savings {
    /// Balls at rest predict nothing: neither cushions nor, two of them, each other.
    const BALLS_AT_REST: bool = true;
    /// What a ball or a pair will meet is kept as long as no event changes its course; otherwise all of it is predicted
    /// anew at every event, from the moments at which the courses began.
    const KEPT_PREDICTIONS: bool = true;
    /// Only the cushions are solved for that a ball can reach before its motion ends.
    const CUSHIONS_IN_REACH: bool = true;
    /// No root is sought for two balls between whose courses there is a line that neither crosses.
    const COURSES_APART: bool = true;
    /// While the cue ball alone moves, a loop of its own follows it, which neither looks for what comes next nor keeps its
    /// course in memory. It keeps predictions, and so is off where [`Savings::KEPT_PREDICTIONS`] is.
    const ALONE: bool = true;
    /// A ball that only rolls out is not followed if the observer does not ask for ends.
    const LAST_ROLLS: bool = true;
    /// The simulation ends when the observer says so: the outcome is decided.
    const EARLY_END: bool = true;
    /// The simulation ends before a resting contact is followed if the energy that is left brings the cue ball to none of the balls for
    /// which the observer waits.
    const OUT_OF_REACH: bool = true;
}

/// All savings: what [`super::simulate`] uses.
#[derive(Clone, Copy, Debug)]
pub struct All;

impl Savings for All {}
