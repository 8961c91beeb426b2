//! Results as NumPy arrays: without a copy, and read-only, so that shared results cannot be changed by accident.

use numpy::{Element, Ix1, PyArray, PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// Converts a vector to a read-only array. Neither the array nor its base can be made writeable again.
pub(crate) fn array1<T: Element>(py: Python<'_>, numbers: Vec<T>) -> Bound<'_, PyArray<T, Ix1>> {
    let array = PyArray1::from_vec(py, numbers);
    array.readwrite().make_nonwriteable();
    array
}

/// Converts a vector to a read-only array with several dimensions.
pub(crate) fn array<const N: usize>(
    py: Python<'_>,
    numbers: Vec<f64>,
    shape: [usize; N],
) -> PyResult<Bound<'_, PyAny>>
where
    [usize; N]: numpy::ndarray::IntoDimension,
{
    Ok(array1(py, numbers).reshape(shape)?.into_any())
}
