//! Model files written: edits for a changed design, the JSON Schema, and the tables of the documentation.

#[cfg(test)]
mod docs;
mod edit;
mod schema;

pub use edit::{at_keys, hardpoint_in, hardpoints_in, placed, with_keys};
pub use schema::schema;
