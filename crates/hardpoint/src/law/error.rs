//! Errors in the numbers of a law.

use super::kind::LawKind;
use super::parameter::Parameter;

/// Error in the numbers of a law; for errors in its text see [`ExpressionError`](super::ExpressionError).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct LawError {
    /// Description of the error, as a complete phrase.
    pub message: String,
    /// Instruction to correct the error, if there is one.
    pub help: Option<String>,
}

impl LawError {
    pub(super) fn new(message: impl Into<String>, help: impl Into<String>) -> Self {
        let help = help.into();
        Self { message: message.into(), help: (!help.is_empty()).then_some(help) }
    }
}

/// Checks that all parameters of a law are finite.
pub(super) fn check_finite(law: &impl LawKind) -> Result<(), LawError> {
    match law.parameters().into_iter().find(|p| !p.value.is_finite()) {
        Some(Parameter { name, value, .. }) => {
            Err(LawError::new(format!("the `{name}` of a law must be a finite number, not {value}"), ""))
        }
        None => Ok(()),
    }
}
