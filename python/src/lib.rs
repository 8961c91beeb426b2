//! The engine as `hardpoint._native`: arrays in and out, everything else as JSON. The package around it
//! (`python/hardpoint`) is the public interface.
//!
//! Numbers are in the units of the model file. Designs are values of all design variables, NaN for nominal values: the
//! value itself for parameters, a change for all others.

mod array;
#[cfg(feature = "command")]
mod command;
mod design;
mod designs;
mod failure;
mod loads;
mod model;
mod run;
mod studies;
mod sweep;
mod watch;

use pyo3::prelude::*;

/// The engine.
#[pymodule]
mod _native {
    #[cfg(feature = "command")]
    #[pymodule_export]
    use crate::command::main;
    #[pymodule_export]
    use crate::model::{Model, parse, read, schema, to_toml};
    #[pymodule_export]
    use crate::run::Run;
    #[pymodule_export]
    use crate::sweep::Sweep;
    #[pymodule_export]
    use crate::watch::{set_patience, wake_ups};

    #[pymodule_init]
    fn init(module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        use pyo3::types::PyModuleMethods;
        module.add("version", env!("CARGO_PKG_VERSION"))
    }
}
