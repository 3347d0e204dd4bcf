//! What all tests of the real program share: a home that is not the user's, and children that end with their test.

use std::{
    ops::{Deref, DerefMut},
    process::Child,
};

/// Where a test's program finds settings, runs and practice: none of whoever runs the tests. Nothing is looked for there by
/// a test; one that does has a folder of its own.
pub fn home() -> impl Iterator<Item = (&'static str, String)> {
    ["HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME"]
        .into_iter()
        .map(|name| (name, format!("{}/home/{name}", env!("CARGO_TARGET_TMPDIR"))))
}

/// A process that ends when the test does, however that ends.
pub struct Kept(pub Child);

impl Deref for Kept {
    type Target = Child;

    fn deref(&self) -> &Child {
        &self.0
    }
}

impl DerefMut for Kept {
    fn deref_mut(&mut self) -> &mut Child {
        &mut self.0
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        // It has ended already where the test went well.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
