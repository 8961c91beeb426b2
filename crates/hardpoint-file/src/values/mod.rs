//! Values of a text: numbers, names, tables, each with its place, and the diagnostics of invalid ones.

mod diagnostic;
mod fields;
mod files;
mod format;
mod places;
mod reader;
mod scalars;
mod tables;
mod walk;

pub use diagnostic::{Diagnostic, Diagnostics, Severity, Source};
pub use files::{LARGEST_FILE, Texts};

pub(crate) use diagnostic::{closest, in_order, shown};
pub(crate) use fields::{Field, Fields, Subject, Value};
pub(crate) use files::{DataError, Folder, Wanted, bytes_of, neighbours, text_from};
pub(crate) use format::*;
pub(crate) use places::{EntryPlace, Places};
pub(crate) use reader::{Reader, all_read, quoted};
pub(crate) use scalars::axis_named;
pub(crate) use tables::above_tables;
pub(crate) use walk::{
    Leaf, alternatives, in_expression, key_list, list_form, list_of, names_in_expression, table_of, walk,
};
