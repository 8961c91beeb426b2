//! Vectors as slices.

/// Dot product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

/// Length.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
