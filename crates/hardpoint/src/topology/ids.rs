//! Ids of what a plan is made of, one kind for each of its lists: `topology[link]` is the link, and a block's id finds
//! no row.

use std::ops::{Index, IndexMut, Range};

use super::{Block, Closure, Coordinate, Link, RowPlace, Topology};

/// Ids that follow each other, alone or with what they stand for.
pub trait Ids<Id>: DoubleEndedIterator<Item = Id> + ExactSizeIterator + Clone {}

impl<Id, I: DoubleEndedIterator<Item = Id> + ExactSizeIterator + Clone> Ids<Id> for I {}

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident: $list:ident of $what:ident;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub usize);

        impl $name {
            /// Those of a range.
            #[inline(always)]
            pub fn all(range: Range<usize>) -> impl Ids<Self> {
                range.map(Self)
            }

            /// The entries of a list that has one for each, with their ids.
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
