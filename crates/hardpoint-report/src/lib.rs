//! Shows results to people and to other programs: tables, CSV, JSON and the self-contained HTML report.
//!
//! Nothing here computes: the core has solved, and this crate converts to the user's units and formats.
//!
//! | module | what it makes |
//! |---|---|
//! | [`facts`] | what is known of the mechanism; shown alike by `check`, the summary and the page |
//! | [`course`] | what a whole run comes to, gathered window by window |
//! | [`summary`] | `summary.json`: the facts, how the run went, the largest sensitivities |
//! | [`margin`] | how far the motion stays from singular positions |
//! | [`assembly`] | what was open in the drawing, and how it closed |
//! | [`verdict`] | `verify.json`: sensitivities against re-solved designs |
//! | [`whatif`] | `whatif.json`, `.csv` and `.html`: a changed design, predicted and exact |
//! | [`compare`] | `compare.json`, `.csv` and `.html`: two model files beside each other |
//! | [`optimize`] | what a search comes to: `summary.json` and tables |
//! | [`tolerance`] | what tolerances come to: `summary.json`, `metrics.csv`, `contributions.csv`, `bands.csv`, `samples.csv` |
//! | [`sweep`], [`cells`] | what a sweep comes to: `summary.json`, and the columns of `designs` and `curves` |
//! | [`maps`] | `maps.csv`, `map_sensitivity.csv`, `maps.json`: measures over grids of two drivers |
//! | [`columns`] | what is in which column of the files of results |
//! | [`csv`], [`npy`] | `motion`, `sensitivity` and `jerk` as text, or as arrays |
//! | [`payload`], [`page`], [`encoding`] | `report.html` |
//! | [`gallery`] | the page of all models, and that of one that cannot be shown |
//! | [`diagnose`] | why a run is impossible or ended early, as diagnostics of the model file |
//! | [`figures`] | numbers and units as text |

pub mod assembly;
pub mod calibrate;
pub mod cells;
pub mod columns;
pub mod compare;
pub mod course;
pub mod csv;
pub mod diagnose;
pub mod encoding;
pub mod facts;
pub mod figures;
pub mod gallery;
pub mod loads;
pub mod maps;
pub mod margin;
pub mod metric;
pub mod npy;
pub mod optimize;
pub mod page;
pub mod payload;
mod shifts;
pub mod summary;
pub mod sweep;
pub mod tolerance;
pub mod validity;
pub mod verdict;
pub mod whatif;

/// Program and version, for everything that is written.
pub const GENERATOR: &str = concat!("hardpoint ", env!("CARGO_PKG_VERSION"));
