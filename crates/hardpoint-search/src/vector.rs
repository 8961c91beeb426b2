//! Vectors as slices.

use hardpoint::number::Real;

/// Dot product.
pub fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::zero(), |sum, (a, b)| sum + *a * *b)
}

/// Length.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
