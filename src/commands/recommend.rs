//! `carom recommend`: Recommend a shot for a layout.

use super::Failure;

/// Recommend a shot for a layout.
#[derive(Debug, clap::Args)]
pub struct Args {}

pub(super) fn run(_args: &Args) -> Result<(), Failure> {
    Ok(())
}
