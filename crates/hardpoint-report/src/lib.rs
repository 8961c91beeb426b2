//! Output of results: tables, CSV, JSON and the self-contained HTML report.
//!
//! This crate does no analysis: it converts the results of the core to the user's units and formats them.
//!
//! | module | contents |
//! |---|---|
//! | [`facts`] | facts of the mechanism, shown by `check`, the summary and the page |
//! | [`course`] | facts of a whole run, gathered in windows |
//! | [`summary`] | `summary.json`: facts, outcome of the run, largest sensitivities |
//! | [`margin`] | margin of the motion to singular positions |
//! | [`assembly`] | open constraints of the design configuration, and their assembly |
//! | [`verdict`] | `verify.json`: sensitivities compared with re-solved designs |
//! | [`whatif`] | `whatif.json`, `.csv` and `.html`: a changed design, predicted and exact |
//! | [`compare`] | `compare.json`, `.csv` and `.html`: comparison of two model files |
//! | [`optimize`] | result of an optimisation: `summary.json` and tables |
//! | [`tolerance`] | tolerance study: `summary.json`, `metrics.csv`, `contributions.csv`, `bands.csv`, `samples.csv` |
//! | [`trade_off`] | front of a trade-off: `summary.json`, `front.csv` |
//! | [`study`] | facts that several studies have |
//! | [`sweep`], [`cells`] | result of a sweep: `summary.json`, and the columns of `designs` and `curves` |
//! | [`synthesis`] | answers of a synthesis: their models, `answers.csv`, `summary.json` |
//! | [`maps`] | `maps.csv`, `map_sensitivity.csv`, `maps.json`: measures over grids of two drivers |
//! | [`payload`], [`page`], [`encoding`], [`base91`] | `report.html` |
//! | [`sketch`] | line drawing of a mechanism, as SVG or for other papers |
//! | [`gallery`] | pages of all models, and of a model that cannot be shown |
//! | [`diagnose`] | diagnostics of runs that cannot start or ended early |
//! | [`entry`] | an entry of a model in a few lines, for editors |
//! | [`ranges`] | range of every measure over the motion |
//! | [`columns`], [`results`], [`npy`], [`figures`] | tables of numbers, from `hardpoint-table` |

pub mod assembly;
pub mod base91;
pub mod calibrate;
pub mod cells;
pub mod clearance;
pub mod compare;
pub mod course;
pub mod deflection;
pub mod diagnose;
pub mod encoding;
pub mod entry;
pub mod envelope;
pub mod facts;
pub mod gallery;
pub mod joint_limits;
pub mod loads;
pub mod map_table;
pub mod maps;
pub mod margin;
pub mod metric;
pub mod optimize;
pub mod page;
pub mod payload;
pub mod ranges;
mod record;
pub mod rigid;
mod shifts;
pub mod sketch;
pub mod study;
pub mod summary;
pub mod sweep;
pub mod synthesis;
pub mod tolerance;
pub mod trade_off;
pub mod validity;
pub mod verdict;
pub mod whatif;

pub use hardpoint_table::{GENERATOR, columns, figures, npy, results};
