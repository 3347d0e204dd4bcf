//! Files: where they live and how they are written without ever leaving half a file behind.

mod atomic;
mod limit;
mod lock;
mod places;
mod reading;

pub use atomic::{
    Staged, create_atomic, remove_abandoned_files, remove_partial_files, replace, target_of, write_atomic,
};
pub use limit::refuse_large_files;
pub use lock::Lock;
pub use places::Places;
pub use reading::{LARGE, PRACTICE, SMALL, open, read, read_text};
