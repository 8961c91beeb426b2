//! The sections of a model, each from its table to its part of the draft.

mod bodies;
mod calibrate;
mod cases;
mod couplers;
mod data;
mod declared;
mod design;
mod drawing;
mod drivers;
mod elements;
mod equilibrium;
mod hardpoints;
mod joints;
mod law;
mod measured;
mod measures;
mod mesh;
mod metrics;
mod model;
mod model_file;
mod optimize;
mod page;
mod parameters;
mod parse;
mod points;
mod raw;
mod readings;
mod shapes;
mod start;
mod sweep;
mod task;
mod times;
mod tolerance;
mod wheels;

pub use drawing::{Appearance, Form, Mesh, MeshFrame};
pub use measured::MeasuredData;
pub use mesh::triangles;
pub use model_file::ModelFile;
pub use parse::{ReadError, parse, parse_in, parse_over, parse_with, read};

pub use task::{TaskAim, TaskFile, TaskRegion};

pub(crate) use law::LAW_TABLE;
pub(crate) use model::MODEL;
#[cfg(test)]
pub(crate) use model::tables;
pub(crate) use parse::parsed;
pub(crate) use task::TASK;
#[cfg(test)]
pub(crate) use task::task_tables;
