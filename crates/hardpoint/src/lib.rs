//! wip
pub mod constraint;
pub mod joint;
pub mod law;
pub mod model;
pub mod space;
