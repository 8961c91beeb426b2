//! Models to measure with: those of `models/`, read as a user's file is read.

use hardpoint::model::Model;

/// The model `models/NAME.toml`.
///
/// # Panics
/// If it does not read, which its own tests exclude.
pub fn model(name: &str) -> Model {
    let path = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    hardpoint_file::read(path.as_ref()).unwrap_or_else(|e| panic!("{e}")).model
}
