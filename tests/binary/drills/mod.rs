//! Practice through the real binary: sessions, scores, positions, and their safety when something goes wrong.

mod data_safety;
mod positions;
mod scores;
mod sides;
