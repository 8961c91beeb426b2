//! Ids of the entries of a plan, one type for each of its lists: the id of a block cannot index a row.

use std::ops::Range;

/// Consecutive ids, alone or with their entries.
pub trait Ids<Id>: DoubleEndedIterator<Item = Id> + ExactSizeIterator + Clone {}

impl<Id, I: DoubleEndedIterator<Item = Id> + ExactSizeIterator + Clone> Ids<Id> for I {}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);

        impl $name {
            /// Ids of a range.
            #[inline(always)]
            pub fn all(range: Range<usize>) -> impl Ids<Self> {
                range.map(Self)
            }

            /// Entries of a list, with their ids.
            #[inline(always)]
            pub fn each<T>(list: &[T]) -> impl Ids<(Self, &T)> {
                list.iter().enumerate().map(|(k, x)| (Self(k), x))
            }
        }
    )*};
}

ids! {
    /// Index of a link in [`Topology::links`](super::Topology::links).
    LinkId;
    /// Index of a coordinate in [`Topology::coordinates`](super::Topology::coordinates).
    CoordinateId;
    /// Index of a closure in [`Topology::closures`](super::Topology::closures).
    ClosureId;
    /// Index of a row in [`Topology::rows`](super::Topology::rows).
    RowId;
    /// Index of a block in [`Topology::blocks`](super::Topology::blocks).
    BlockId;
}
