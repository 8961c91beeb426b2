//! Arrays of numbers, element by element, inlined.

/// An array of at least one number, by index: `std::array::from_fn`, inlined everywhere.
#[inline(always)]
pub(crate) fn array<T: Copy, const N: usize>(number: impl Fn(usize) -> T) -> [T; N] {
    let mut out = [number(0); N];
    for k in 1..N {
        out[k] = number(k);
    }
    out
}

/// A function of every number of an array: `map`, inlined everywhere.
#[inline(always)]
pub(crate) fn each<T: Copy, U: Copy, const N: usize>(of: &[T; N], function: impl Fn(T) -> U) -> [U; N] {
    array(
        #[inline(always)]
        |k| function(of[k]),
    )
}

/// A function of both parts of a pair: `map`, inlined everywhere.
#[inline(always)]
pub(crate) fn both<T, U>([first, second]: [T; 2], mut function: impl FnMut(T) -> U) -> [U; 2] {
    [function(first), function(second)]
}
