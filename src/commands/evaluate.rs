//! `carom evaluate`: Measure a policy or the recommender on held-out layouts.

use super::Failure;

/// Measure a policy or the recommender on held-out layouts.
#[derive(Debug, clap::Args)]
pub struct Args {}

pub(super) fn run(_args: &Args) -> Result<(), Failure> {
    Ok(())
}
