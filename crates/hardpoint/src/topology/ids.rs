//! What is what in the plan: an id for every list, by which the plan itself is indexed.

use std::ops::{Index, IndexMut, Range};

use super::{Block, Closure, Coordinate, Link, RowPlace, Topology};

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident: $list:ident of $what:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);

        impl $name {
            /// Those of a range.
            #[inline(always)]
            pub fn all(range: Range<usize>) -> impl DoubleEndedIterator<Item = Self> + ExactSizeIterator + Clone {
                range.map(Self)
            }

            /// The entries of a list that has one for each, with their ids.
            #[inline(always)]
            pub fn each<T>(list: &[T]) -> impl DoubleEndedIterator<Item = (Self, &T)> + ExactSizeIterator + Clone {
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
    /// A link's place in [`Topology::links`].
    LinkId: links of Link;
    /// A coordinate's place in [`Topology::coordinates`].
    CoordinateId: coordinates of Coordinate;
    /// A closure's place in [`Topology::closures`].
    ClosureId: closures of Closure;
    /// A row's place in [`Topology::rows`].
    RowId: rows of RowPlace;
    /// A block's place in [`Topology::blocks`].
    BlockId: blocks of Block;
}
