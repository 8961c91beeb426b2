//! Dexterity: singular values of the Jacobian between drivers and points of a body.
//!
//! ```text
//! J = [dP_p/dq_d] / sqrt(number of points),      s_k = abs(J v_k),    J^T J v_k = s_k^2 v_k
//! ```
//!
//! The directions v_k are found in plain numbers. A singular value is stationary in its direction, so that
//! `s_k = abs(J v_k)` with a constant v_k has its first derivatives (Gosselin 1990; with velocities of points instead
//! of twists the entries of J have one unit).

use crate::linalg::diagonalise;
use crate::model::JacobianValue;
use crate::number::{self, Real};
use crate::space::Vec3;

const MOST_DRIVERS: usize = JacobianValue::MOST_DRIVERS;

type Square = [[f64; MOST_DRIVERS]; MOST_DRIVERS];

/// Value of a Jacobian, given by the derivatives of points by drivers; with the first derivatives of its entries.
pub(super) fn dexterity<T: Real>(
    jacobian: impl Fn(usize, usize) -> Vec3<T>,
    [drivers, points]: [usize; 2],
    value: JacobianValue,
) -> T {
    let mut product: Square = [[0.0; MOST_DRIVERS]; MOST_DRIVERS];
    for p in 0..points {
        let columns: [Vec3; MOST_DRIVERS] =
            std::array::from_fn(|d| if d < drivers { jacobian(d, p).map(T::value) } else { Vec3::zero() });
        for (row, a) in product.iter_mut().zip(&columns) {
            row.iter_mut().zip(&columns).for_each(|(entry, b)| *entry += a.dot(*b));
        }
    }
    let directions = by_size(product, drivers);
    let gain = |k: usize| {
        let direction: [T; MOST_DRIVERS] = directions[k].map(T::constant);
        let squares = (0..points).map(|p| {
            let velocity = (0..drivers).map(|d| jacobian(d, p) * direction[d]);
            let velocity = velocity.fold(Vec3::zero(), |sum, v| sum + v);
            velocity.dot(velocity)
        });
        let sum = squares.fold(T::zero(), |sum, square| sum + square);
        let mean = sum * T::constant(1.0 / points as f64);
        // A magnitude has a kink at zero: the mean of the derivatives on both sides is zero.
        if mean.value() > 0.0 { mean.sqrt() } else { mean }
    };
    // Of more drivers than equations the others move nothing.
    let least = drivers.min(3 * points) - 1;
    match value {
        JacobianValue::InverseCondition => gain(least) / gain(0),
        JacobianValue::LeastGain => gain(least),
        JacobianValue::GreatestGain => gain(0),
    }
}

/// Unit eigenvectors of a symmetric matrix of n rows, by Jacobi's method; those of large eigenvalues first.
fn by_size(mut a: Square, n: usize) -> Square {
    let mut vectors: Square = std::array::from_fn(|j| std::array::from_fn(|k| f64::from(u8::from(j == k))));
    diagonalise(&mut a, &mut vectors, n);
    let mut order: [usize; MOST_DRIVERS] = std::array::from_fn(|k| k);
    order[..n].sort_by(|j, k| a[*k][*k].total_cmp(&a[*j][*j]));
    number::each(&order, |k| vectors[k])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eigenvectors of products with known ones.
    #[test]
    fn eigenvectors_come_by_size() {
        let u = [[2.0, -1.0, 2.0], [2.0, 2.0, -1.0], [-1.0, 2.0, 2.0]].map(|u| u.map(|x: f64| x / 3.0));
        let values = [1e-9, 4.0, 4.0 + 1e-6];
        let mut a: Square = [[0.0; MOST_DRIVERS]; MOST_DRIVERS];
        for (j, row) in a.iter_mut().take(3).enumerate() {
            for (k, entry) in row.iter_mut().take(3).enumerate() {
                *entry = (0..3).map(|n| values[n] * u[n][j] * u[n][k]).sum();
            }
        }
        let found = by_size(a, 3);
        for (vector, of) in found.iter().zip([2, 1, 0]) {
            let along: f64 = (0..3).map(|k| vector[k] * u[of][k]).sum();
            assert!((along.abs() - 1.0).abs() < 1e-12, "{of}: {along}");
        }
    }
}
