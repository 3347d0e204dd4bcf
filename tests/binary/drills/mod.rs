//! Practice through the real binary: sessions, scores, positions, and their safety when something goes wrong.

mod kept;
mod scores;
mod sides;
mod trouble;
