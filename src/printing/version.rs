//! Version of the program: its number, the commit that it was built from, and the target.

/// The version, as in `Cargo.toml`.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The commit: the output of `git describe`, or the commit recorded in the published package; `None` if neither is known.
pub const COMMIT: Option<&str> = option_env!("CAROM_SOURCE");

/// The target triple of the build, such as "x86_64-unknown-linux-gnu".
pub const TARGET: &str = env!("CAROM_TARGET");

/// Version, commit and target in one line, as `--version` prints it after the program's name.
pub const FULL_VERSION: &str = env!("CAROM_VERSION");
