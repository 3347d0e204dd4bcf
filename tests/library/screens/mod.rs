//! What is seen: keys, the mouse and news go through the real app, and what it shows is looked at.

mod advice;
mod calibration;
mod coach;
mod drills;
mod edges;
mod faults;
mod film;
mod finder;
mod follow;
mod heights;
mod keys;
mod mouse;
mod player;
mod positions;
mod practice;
mod runs;
mod settings;
mod sides;
mod sizes;
mod systems;
mod table;
mod tabs;
mod toasts;
mod training;
mod undo;
mod what_if;
