//! What this program calls itself: its version, the commit that it was built from, and for what machine.

/// The version, as in `Cargo.toml`.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The commit: what `git describe` says of the source, or the commit of the package that it was built from; none where
/// neither is known.
pub const SOURCE: Option<&str> = option_env!("CAROM_SOURCE");

/// The target that it was built for, like "x86_64-unknown-linux-gnu".
pub const TARGET: &str = env!("CAROM_TARGET");

/// All of it in a line, as `--version` says it behind the program's name.
pub const FULL_VERSION: &str = env!("CAROM_VERSION");
