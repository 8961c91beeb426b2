//! Errors of requests. A request is the settings of the model file with the overrides of the caller; each study checks
//! its own in one place for the command, the page and Python.

use hardpoint::draft::{did_you_mean, some_of};
use hardpoint::model::{Model, VariableId};

/// Reason why a study cannot be requested, with what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}; {help}")]
pub struct RequestError {
    /// Origin of the error.
    pub fault: Fault,
    /// Description of the error.
    pub message: String,
    /// Instruction that corrects it.
    pub help: String,
}

/// Origin of the error in a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The model lacks something that the study requires.
    Model,
    /// An override is invalid.
    Override,
}

impl RequestError {
    pub(crate) fn model(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { fault: Fault::Model, message: message.into(), help: help.into() }
    }

    pub(crate) fn invalid(message: impl Into<String>, help: impl Into<String>) -> Self {
        Self { fault: Fault::Override, message: message.into(), help: help.into() }
    }

    /// Error of a number that is 0 or above its maximum.
    pub(crate) fn unless_counted(what: &str, n: usize, most: u32) -> Result<(), Self> {
        match n {
            0 => Err(Self::invalid(format!("the number of {what} is 0"), "give a whole number from 1")),
            n if n > most as usize => {
                Err(Self::invalid(format!("{n} {what} are too many"), format!("give at most {most}")))
            }
            _ => Ok(()),
        }
    }
}

/// Number of names in a help text.
const LISTED: usize = 12;

/// Position of a name in a list; `what` is the kind of thing that it names.
///
/// # Errors
/// A [`RequestError`] with the closest name, or else all of them, if the list does not have it.
pub fn named<'n>(
    what: &str,
    name: &str,
    known: impl IntoIterator<Item = &'n str>,
) -> Result<usize, RequestError> {
    let known: Vec<&str> = known.into_iter().collect();
    known.iter().position(|k| *k == name).ok_or_else(|| {
        let help = match did_you_mean(name, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if known.is_empty() => format!("the model has no {what}s"),
            None => format!("there are {}", some_of(&known, ", ", LISTED)),
        };
        RequestError::invalid(format!("there is no {what} named `{name}`"), help)
    })
}

/// Design variable of a model by name.
///
/// # Errors
/// A [`RequestError`] if the model has no such variable.
pub fn variable(model: &Model, name: &str) -> Result<VariableId, RequestError> {
    named("design variable", name, model.variables.iter().map(|v| v.name.as_str())).map(VariableId)
}
