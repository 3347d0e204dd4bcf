//! What a player counts on the diamonds for the recommended shot.

use crate::{
    coach::systems::{Guide, guide},
    physics::CueInputs,
    simulation::Recording,
    table::{Layout, Table},
};

/// The system that describes a shot, with its numbers and what they are on this table.
pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Option<Guide> {
    guide(table, &Recording::new(table, layout, cue).ok()?)
}
