//! Behaviour at change points.

/// Behaviour at a change point, where two motions of a mechanism meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ChangePointPolicy {
    /// The motion ends there (HP0402).
    #[default]
    Stop,
    /// It goes on as the one of the two motions that continues it smoothly; where neither does, it ends.
    Continue,
}

impl ChangePointPolicy {
    /// All of them, with the words of model files.
    pub const WORDS: [(&'static str, Self); 2] = [("stop", Self::Stop), ("continue", Self::Continue)];
}
