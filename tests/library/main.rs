//! Tests of the library: shots against independent results, laws of physics, agents, exercises, and the screens of the app.

mod documents;
mod exercises;
mod flights;
mod house;
mod links;
mod physics_properties;
mod reference;
mod rules;
mod same_bits;
mod screens;
mod stability;
mod thesis_agents;
mod words;
