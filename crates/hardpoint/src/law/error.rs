//! What can be wrong with the numbers of a law.

/// What is wrong with the numbers of a law; for a law's text see [`ExpressionError`](super::ExpressionError).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct LawError {
    /// What, in words that stand alone.
    pub message: String,
    /// What to write instead, where that can be said.
    pub help: Option<String>,
}

impl LawError {
    pub(super) fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        let help = help.into();
        Self { message: message.into(), help: (!help.is_empty()).then_some(help) }
    }
}

/// That each of these named numbers is finite.
pub(super) fn check_finite<'a>(numbers: impl IntoIterator<Item = (&'a str, f64)>) -> Result<(), LawError> {
    for (name, value) in numbers {
        if !value.is_finite() {
            return Err(LawError::new(
                format!("the {name} of a law must be a finite number, not {value}"),
                "",
            ));
        }
    }
    Ok(())
}
