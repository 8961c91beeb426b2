//! Numbers of masses and forces, which may follow the design.

/// A number of an element: its place in [`Model::numbers`](super::Model::numbers).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NumberId(pub usize);

/// A number that an element is given, which may follow the design.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementNumber {
    /// The element's name.
    pub owner: String,
    /// Key in model files.
    pub key: &'static str,
    /// Value in the nominal design, SI.
    pub value: f64,
    /// Number of units of the text per SI unit.
    pub(crate) per_unit: f64,
}
