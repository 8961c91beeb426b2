//! Ids of the entries of a plan, one type for each of its lists: `topology[link]` is the link, and the id of a block
//! cannot index a row.

use std::ops::{Index, IndexMut, Range};

use super::{Block, Closure, Coordinate, Link, RowPlace, Topology};

/// Consecutive ids, alone or with their entries.
pub trait Ids<Id>: DoubleEndedIterator<Item = Id> + ExactSizeIterator + Clone {}

impl<Id, I: DoubleEndedIterator<Item = Id> + ExactSizeIterator + Clone> Ids<Id> for I {}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident: $list:ident of $what:ident;)*) => {$(
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

        impl Index<$name> for Topology {
            type Output = $what;
            #[inline(always)]
            fn index(&self, id: $name) -> &$what {
                &self.$list[id.0]
            }
        }

        impl IndexMut<$name> for Topology {
            #[inline(always)]
            fn index_mut(&mut self, id: $name) -> &mut $what {
                &mut self.$list[id.0]
            }
        }
    )*};
}

ids! {
    /// Index of a link in [`Topology::links`].
    LinkId: links of Link;
    /// Index of a coordinate in [`Topology::coordinates`].
    CoordinateId: coordinates of Coordinate;
    /// Index of a closure in [`Topology::closures`].
    ClosureId: closures of Closure;
    /// Index of a row in [`Topology::rows`].
    RowId: rows of RowPlace;
    /// Index of a block in [`Topology::blocks`].
    BlockId: blocks of Block;
}
