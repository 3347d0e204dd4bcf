//! Whether a ball is free, bounces slowly, or rests against something.

/// What a ball's contacts do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactMode {
    /// It is free, or hits something now and then.
    Free,
    /// It chatters: bounces that have been told as the beginning of a contact, and are played one by one without being told. Or it
    /// rests no more, and may bounce again.
    Bouncing,
    /// It rests against something, the limit of its bounces.
    Resting,
}
