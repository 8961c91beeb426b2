//! wip
mod analysis;
pub mod constraint;
pub mod joint;
pub mod law;
pub mod measure;
pub mod model;
pub mod motion;
pub mod sensitivity;
pub mod space;
pub mod study;
pub mod topology;

pub use analysis::{Analysis, Progress, Solution};
