//! Practice through the real binary: sessions, scores, positions, and what becomes of them when something goes wrong.

mod kept;
mod scores;
mod sides;
mod trouble;
