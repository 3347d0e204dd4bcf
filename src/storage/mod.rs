//! Files: where they live and how they are written without ever leaving half a file behind.

mod atomic;
mod lock;
mod places;

pub use atomic::{Staged, create_atomic, remove_abandoned_files, remove_partial_files, replace, write_atomic};
pub use lock::Lock;
pub use places::Places;
