//! `hardpoint new`: a model from a template, with the user's own hardpoints.

mod axes;
mod command;
mod fit;
mod table;

pub use command::{TEMPLATES, run, template_named};
