//! Vectors and rotations of the plane as complex numbers over any number, and rigid displacements.

use std::ops::{Add, Mul, Sub};

use hardpoint::number::Real;

/// A vector of the plane, or a rotation with a change of length.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex<T = f64> {
    /// Component along x.
    pub x: T,
    /// Component along y.
    pub y: T,
}

impl<T: Real> Complex<T> {
    /// Vector with these components.
    pub fn new(x: T, y: T) -> Self {
        Self { x, y }
    }

    /// Vector of constant components.
    pub fn constant(of: Complex) -> Self {
        Self::new(T::constant(of.x), T::constant(of.y))
    }

    /// Unit vector at an angle from x, rad.
    pub fn unit(angle: T) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self::new(cos, sin)
    }

    /// Mirror image about x.
    pub fn conjugate(self) -> Self {
        Self::new(self.x, -self.y)
    }

    /// The vector a quarter turn ahead.
    pub fn left(self) -> Self {
        Self::new(-self.y, self.x)
    }

    /// The vector times a number.
    pub fn times(self, by: T) -> Self {
        Self::new(self.x * by, self.y * by)
    }

    /// Scalar product.
    pub fn dot(self, o: Self) -> T {
        self.x * o.x + self.y * o.y
    }

    /// Component normal to the plane of the vector product.
    pub fn cross(self, o: Self) -> T {
        self.x * o.y - self.y * o.x
    }

    /// Squared length.
    pub fn square(self) -> T {
        self.dot(self)
    }

    /// Quotient: the rotation and change of length from another vector to this one.
    pub fn over(self, o: Self) -> Self {
        (self * o.conjugate()).times(T::one() / o.square())
    }
}

impl Complex {
    /// Zero.
    pub const ZERO: Self = Self { x: 0.0, y: 0.0 };

    /// Length.
    pub fn norm(self) -> f64 {
        self.x.hypot(self.y)
    }

    /// Angle from x, rad.
    pub fn angle(self) -> f64 {
        self.y.atan2(self.x)
    }

    /// True if both components are finite.
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl<T: Real> Add for Complex<T> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y)
    }
}

impl<T: Real> Sub for Complex<T> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y)
    }
}

impl<T: Real> Mul for Complex<T> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self::new(self.x * o.x - self.y * o.y, self.x * o.y + self.y * o.x)
    }
}

/// A pose of a body: the place of its origin, and its angle from x.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Origin, m.
    pub at: Complex,
    /// Angle, rad.
    pub angle: f64,
}

/// A displacement of the plane, `z -> turn z + shift`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    /// Rotation, of length 1.
    pub turn: Complex,
    /// Image of the origin.
    pub shift: Complex,
}

impl Displacement {
    /// Displacement from one pose to another.
    pub fn between(from: Pose, to: Pose) -> Self {
        let turn = Complex::unit(to.angle - from.angle);
        Self { turn, shift: to.at - turn * from.at }
    }

    /// Image of a point.
    pub fn of(self, z: Complex) -> Complex {
        self.turn * z + self.shift
    }

    /// The point that stays in place; infinite for a translation.
    pub fn pole(self) -> Complex {
        self.shift.over(Complex::new(1.0, 0.0) - self.turn)
    }
}
