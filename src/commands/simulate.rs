//! `carom simulate`: Simulate one shot, or a file of them.

use super::Failure;

/// Simulate one shot, or a file of them.
#[derive(Debug, clap::Args)]
pub struct Args {}

pub(super) fn run(_args: &Args) -> Result<(), Failure> {
    Ok(())
}
