//! Language of model files for editors: completion, meanings, names with all their places, renaming.
//!
//! All of it follows from the declared format and works on texts that are not valid yet. Positions are bytes of the
//! text.

mod complete;
mod document;
mod names;
mod rename;
mod syntax;

pub use complete::{Completion, CompletionKind};
pub use document::{Document, IncludedFile, KeyMeaning, LARGEST_DOCUMENT, NameAt, Reference, Symbol};
pub use rename::RenameError;
