//! Files: where they live and how they are written without ever leaving half a file behind.

mod atomic;
mod places;

pub use atomic::write_atomic;
pub use places::Places;
