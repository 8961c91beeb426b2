//! Vectors with three components.

use std::ops::{Add, AddAssign, Index, Mul, Neg, Sub, SubAssign};

use crate::number::{Dual, Jet, Rates, Real};

/// Point or direction with components along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Vec3<T = f64> {
    /// Component along x.
    pub x: T,
    /// Component along y.
    pub y: T,
    /// Component along z.
    pub z: T,
}

impl Vec3<f64> {
    /// Zero vector.
    pub const ZERO: Self = Self::new(0.0, 0.0, 0.0);
    /// Unit vectors along x, y and z.
    pub const AXES: [Self; 3] =
        [Self::new(1.0, 0.0, 0.0), Self::new(0.0, 1.0, 0.0), Self::new(0.0, 0.0, 1.0)];

    /// This vector in another scalar type, as a constant.
    #[inline(always)]
    pub fn spread<T: Real>(self) -> Vec3<T> {
        Vec3::new(T::constant(self.x), T::constant(self.y), T::constant(self.z))
    }

    /// Components as an array.
    pub fn to_array(self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    /// True if all components are finite.
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.z.is_finite()
    }

    /// Unit vector along this one; `None` if it is shorter than `1e-12` or not finite.
    pub fn unit(self) -> Option<Self> {
        let n = self.norm();
        (n > 1e-12 && n.is_finite()).then(|| self * (1.0 / n))
    }

    /// A unit vector perpendicular to this unit vector; the choice is deterministic.
    pub fn any_perpendicular(self) -> Self {
        let a = self.to_array().map(f64::abs);
        let k = (0..3).fold(0, |best, k| if a[k] < a[best] { k } else { best });
        let e = Self::AXES[k];
        let s = e - self * self.dot(e);
        s * (1.0 / s.norm())
    }
}

impl From<[f64; 3]> for Vec3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

impl<T> Vec3<T> {
    /// Vector with these components.
    #[inline(always)]
    pub const fn new(x: T, y: T, z: T) -> Self {
        Self { x, y, z }
    }

    /// Applies `f` to every component.
    #[inline(always)]
    pub fn map<U>(self, f: impl Fn(T) -> U) -> Vec3<U> {
        Vec3::new(f(self.x), f(self.y), f(self.z))
    }
}

impl<T: Copy> Vec3<T> {
    /// Vector from its value, its rate and its acceleration.
    #[inline(always)]
    pub(crate) fn of_rates([x, xd, xdd]: [Self; 3]) -> Vec3<Rates<T>> {
        Vec3::new(Jet([x.x, xd.x, xdd.x]), Jet([x.y, xd.y, xdd.y]), Jet([x.z, xd.z, xdd.z]))
    }
}

impl<T: Real> Vec3<T> {
    /// This vector with the derivative `d`.
    #[inline(always)]
    pub fn with_derivative(self, d: Self) -> Vec3<Dual<T>> {
        Vec3 { x: Dual { v: self.x, d: d.x }, y: Dual { v: self.y, d: d.y }, z: Dual { v: self.z, d: d.z } }
    }

    /// Zero vector.
    #[inline(always)]
    pub fn zero() -> Self {
        let o = T::zero();
        Self::new(o, o, o)
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> T {
        T::operation(|| self.z.times_plus(o.z, self.y.times_plus(o.y, self.x * o.x)))
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        T::operation(|| {
            Self::new(
                self.y.times_plus(o.z, -(self.z * o.y)),
                self.z.times_plus(o.x, -(self.x * o.z)),
                self.x.times_plus(o.y, -(self.y * o.x)),
            )
        })
    }

    /// `self x o + addend`.
    #[inline(always)]
    pub fn cross_plus(self, o: Self, addend: Self) -> Self {
        T::operation(
            #[inline(always)]
            || {
                Self::new(
                    self.y.times_plus(o.z, (-self.z).times_plus(o.y, addend.x)),
                    self.z.times_plus(o.x, (-self.x).times_plus(o.z, addend.y)),
                    self.x.times_plus(o.y, (-self.y).times_plus(o.x, addend.z)),
                )
            },
        )
    }

    /// `self * k + addend`.
    #[inline(always)]
    pub fn times_plus(self, k: T, addend: Self) -> Self {
        T::operation(|| {
            Self::new(
                self.x.times_plus(k, addend.x),
                self.y.times_plus(k, addend.y),
                self.z.times_plus(k, addend.z),
            )
        })
    }

    /// Mirror image in the plane through the origin with this unit normal: `v - 2 (v . n) n`.
    pub fn mirrored(self, normal: Self) -> Self {
        self - normal * (T::constant(2.0) * self.dot(normal))
    }

    /// Length.
    #[inline(always)]
    pub fn norm(self) -> T {
        T::operation(|| self.dot(self).sqrt())
    }

    /// This vector as plain numbers.
    #[inline(always)]
    pub fn value(self) -> Vec3<f64> {
        Vec3::new(self.x.value(), self.y.value(), self.z.value())
    }
}

impl<T> Index<usize> for Vec3<T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, k: usize) -> &T {
        match k {
            0 => &self.x,
            1 => &self.y,
            2 => &self.z,
            _ => panic!("a vector has components 0, 1 and 2, not {k}"),
        }
    }
}

impl<T: Real> Add for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        T::operation(|| Self::new(self.x + o.x, self.y + o.y, self.z + o.z))
    }
}

impl<T: Real> Sub for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        T::operation(|| Self::new(self.x - o.x, self.y - o.y, self.z - o.z))
    }
}

impl<T: Real> Neg for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        T::operation(|| Self::new(-self.x, -self.y, -self.z))
    }
}

impl<T: Real> Mul<T> for Vec3<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, k: T) -> Self {
        T::operation(|| Self::new(self.x * k, self.y * k, self.z * k))
    }
}

impl<T: Real> AddAssign for Vec3<T> {
    #[inline(always)]
    fn add_assign(&mut self, o: Self) {
        T::operation(|| {
            self.x += o.x;
            self.y += o.y;
            self.z += o.z;
        })
    }
}

impl<T: Real> SubAssign for Vec3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, o: Self) {
        T::operation(|| {
            self.x -= o.x;
            self.y -= o.y;
            self.z -= o.z;
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirror_image_turns_around_along_the_normal_only() {
        let v = Vec3::new(1.0, 2.0, -3.0);
        assert_eq!(v.mirrored(Vec3::AXES[1]), Vec3::new(1.0, -2.0, -3.0));
        let n = Vec3::new(0.6, 0.0, 0.8);
        let image = v.mirrored(n);
        assert!((image.dot(n) + v.dot(n)).abs() < 1e-15 && (image.cross(n) - v.cross(n)).norm() < 1e-15);
        assert!((image.mirrored(n) - v).norm() < 1e-15);
    }
}
