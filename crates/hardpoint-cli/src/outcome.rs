//! Outcomes of commands, for scripts.

/// Outcome of a command; `args.rs` explains the codes to the user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Outcome {
    /// Success.
    Done = 0,
    /// A sensitivity does not agree with re-solved designs, or a search ended short of an optimum.
    FellShort = 1,
    /// The command line is invalid.
    Misunderstood = 2,
    /// The model file has errors or cannot be read.
    BadModel = 3,
    /// The mechanism cannot be driven as modelled.
    CannotBeDriven = 4,
    /// The motion ended early.
    Stopped = 5,
    /// A result could not be written.
    NotWritten = 6,
    /// Interrupted by the user: 128 + SIGINT, as in shells.
    Interrupted = 130,
}

impl Outcome {
    /// Combines two outcomes: the worse one, with the larger exit code.
    pub fn and(self, other: Self) -> Self {
        if other as u8 > self as u8 { other } else { self }
    }
}
