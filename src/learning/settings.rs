//! Range checks for the agents' settings.

use std::fmt::Display;

/// A setting outside its range.
#[derive(Debug, thiserror::Error, PartialEq)]
#[error("{name} = {value} is outside its range; accepted is {accepted}")]
pub struct SettingError {
    pub(super) name: &'static str,
    value: String,
    pub(super) accepted: &'static str,
}

pub fn check(
    name: &'static str,
    value: impl Display,
    accept: bool,
    accepted: &'static str,
) -> Result<(), SettingError> {
    if accept { Ok(()) } else { Err(SettingError { name, value: value.to_string(), accepted }) }
}

pub fn check_share(name: &'static str, value: f64) -> Result<(), SettingError> {
    check(name, value, (0.0..=1.0).contains(&value), "0 to 1")
}

/// Checks a number that must be positive.
pub fn check_positive(name: &'static str, value: f64) -> Result<(), SettingError> {
    check(name, value, value > 0.0 && value <= 1e3, "above 0 and at most 1000")
}

pub fn check_count(name: &'static str, value: usize) -> Result<(), SettingError> {
    check(name, value as f64, (1..=1 << 24).contains(&value), "1 to 16777216")
}

/// Checks a number of rows that are processed at once. The limit keeps the memory within that of most machines.
pub fn check_batch(name: &'static str, value: usize) -> Result<(), SettingError> {
    check(name, value as f64, (1..=1 << 16).contains(&value), "1 to 65536")
}

pub fn check_layers(name: &'static str, layers: &[usize]) -> Result<(), SettingError> {
    check(name, format_args!("{layers:?}"), (1..=16).contains(&layers.len()), "a list of 1 to 16 layers")?;
    let check_units = |units: &usize| check(name, *units as f64, (1..=8192).contains(units), "1 to 8192 units a layer");
    layers.iter().try_for_each(check_units)
}
