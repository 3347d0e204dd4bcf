//! `carom train`: Train an agent without a screen.

use super::Failure;

/// Train an agent without a screen.
#[derive(Debug, clap::Args)]
pub struct Args {}

pub(super) fn run(_args: &Args) -> Result<(), Failure> {
    Ok(())
}
