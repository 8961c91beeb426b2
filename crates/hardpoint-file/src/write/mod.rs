//! Model files written: edits for a changed design, other entries, the JSON Schema, and the tables of the
//! documentation.

mod curves;
#[cfg(test)]
mod docs;
mod edit;
mod files;
mod laws;
mod lengths;
mod merge;
mod schema;
mod split;
mod start;
mod text;

pub use edit::{at_keys, hardpoint_in, hardpoints_in, placed, with_keys};
pub use merge::{Contents, merged};
pub use schema::schema;
