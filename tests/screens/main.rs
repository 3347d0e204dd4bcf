//! What is seen: keys and the mouse go through the real app, and its pictures are compared.

mod advice;
mod coach;
mod coach_player;
mod drill_player;
mod drills;
mod faults;
mod film;
mod finder;
mod keys;
mod mouse;
mod settings;
mod sides;
mod table;
mod tabs;
mod toasts;
mod training;
mod training_player;
mod undo;
