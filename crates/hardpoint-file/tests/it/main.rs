//! Model files as their authors meet them: what is read, what is refused and how that is said, and the models of the gallery
//! solved and held against what is known of them.

mod calibrations;
mod cases;
mod diagnostics;
mod docs;
mod edit;
mod elements;
mod gallery;
mod gallery_models;
mod grids;
mod includes;
mod loads;
mod measures;
mod meshes;
mod metrics;
mod mirror;
mod models;
mod motions;
mod optimize;
mod parameters;
mod path;
mod planar;
mod prescribed;
mod published;
mod robustness;
mod searches;
mod shapes;
mod sides;
mod studies;
mod sweeps;
mod synthesis;
mod tape;
mod tolerances;
mod wheels;
