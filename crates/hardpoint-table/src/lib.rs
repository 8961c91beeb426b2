//! Results as tables of numbers: the user's units, names of columns, CSV files, NumPy arrays, and the compact curves of
//! the report page.
//!
//! The loops of this crate touch every number of a run. Facts of a run as a whole are in `hardpoint-report`.
//!
//! | module | contents |
//! |---|---|
//! | [`Units`] | units of a file, and conversions from and to SI |
//! | [`Unit`] | units of data by their symbols |
//! | [`figures`] | numbers and units as text |
//! | [`columns`] | columns of the result files |
//! | [`csv`] | CSV tables that spreadsheets do not misread |
//! | [`results`], [`npy`] | `motion`, `sensitivity` and `jerk` as text, or as arrays |
//! | [`series`] | curves of results over output times, for the page |
//! | [`tracks`] | curves of the page as compact integers |

pub mod columns;
pub mod csv;
pub mod figures;
pub mod npy;
pub mod results;
pub mod series;
mod symbols;
pub mod tracks;
mod units;

pub use symbols::Unit;
pub use units::{AngleUnit, LengthUnit, Units};

/// Program and version, as entered in all output.
pub const GENERATOR: &str = concat!("hardpoint ", env!("CARGO_PKG_VERSION"));
