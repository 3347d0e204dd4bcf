//! Tests of the library: shots against independent results, laws of physics, agents, exercises, and the screens of the app.

mod determinism;
mod documents;
mod exercises;
mod flights;
mod links;
mod physics_properties;
mod reference;
mod rules;
mod screens;
mod setting_names;
mod source_rules;
mod stability;
mod thesis_agents;
mod words;
