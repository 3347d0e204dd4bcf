//! What a player counts on the diamonds for the recommended shot.

use crate::{
    coach::systems::{Guide, guide},
    physics::CueInputs,
    simulation::{Recording, ShotError},
    table::{Layout, Table},
};

/// The system that describes a shot, with its numbers and what they are on this table; none where none does.
///
/// # Errors
/// What is wrong with the layout or the stroke.
pub fn of(table: &Table, layout: &Layout, cue: &CueInputs) -> Result<Option<Guide>, ShotError> {
    Ok(guide(table, &Recording::new(table, layout, cue)?))
}
