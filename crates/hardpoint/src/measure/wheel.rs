//! Formulas of a wheel and its kingpin. Their signs: `docs/measures.md`.

use crate::model::WheelMeasure;
use crate::space::{Real, Vec3};

/// A wheel somewhere on its way: z is up and the ground level.
#[derive(Clone, Copy, Debug)]
pub(super) struct WheelAt<T> {
    /// Wheel centre.
    pub centre: Vec3<T>,
    /// Unit vector, outboard.
    pub spin_axis: Vec3<T>,
    pub radius: T,
    /// 1 for a left wheel, -1 for a right one.
    pub side: T,
    /// A lower and an upper point of the axis that it steers about.
    pub kingpin: Option<[Vec3<T>; 2]>,
}

/// `atan2(e_x, s e_y)` of the outboard spin axis e of a wheel on side s.
#[inline(always)]
pub(super) fn toe<T: Real>(e: Vec3<T>, side: T) -> T {
    e.x.atan2(side * e.y)
}

/// `-asin(e_z)`.
#[inline(always)]
pub(super) fn camber<T: Real>(e: Vec3<T>) -> T {
    -e.z.asin()
}

impl<T: Real> WheelAt<T> {
    /// The value of a measure; `design` is the wheel in the design configuration.
    pub fn measure(&self, what: WheelMeasure, design: impl Fn() -> Self) -> T {
        match what {
            WheelMeasure::Toe => toe(self.spin_axis, self.side),
            WheelMeasure::Camber => camber(self.spin_axis),
            WheelMeasure::SteerAngle => {
                let (d, f) = (design().forward(), self.forward());
                d.cross(f).z.atan2(d.dot(f))
            }
            WheelMeasure::Caster => {
                let k = self.along_kingpin();
                (-k.x).atan2(k.z)
            }
            WheelMeasure::KingpinInclination => {
                let k = self.along_kingpin();
                (-self.side * k.y).atan2(k.z)
            }
            WheelMeasure::ScrubRadius => self.off_kingpin(self.contact()).dot(self.outboard()),
            WheelMeasure::SpindleOffset => self.off_kingpin(self.centre).dot(self.outboard()),
            WheelMeasure::CasterTrail => self.caster_trail(),
            WheelMeasure::MechanicalTrail => {
                // The kingpin as the wheel's side view shows it: its slope is that of k.f against k.z.
                let k = self.along_kingpin();
                let aside = k.dot(self.forward());
                self.caster_trail() * k.z / (aside * aside + k.z * k.z).sqrt()
            }
            WheelMeasure::HubTrail => self.off_kingpin(self.centre).dot(self.forward()),
            WheelMeasure::WheelTravel => self.centre.z - design().centre.z,
            WheelMeasure::WheelRecession => design().centre.x - self.centre.x,
            WheelMeasure::HalfTrack => self.half_track(),
            WheelMeasure::HalfTrackChange => self.half_track() - design().half_track(),
            WheelMeasure::ContactX => self.contact().x,
            WheelMeasure::ContactY => self.contact().y,
            WheelMeasure::ContactZ => self.contact().z,
        }
    }

    /// Outboard along the ground: the horizontal part of the spin axis, of unit length.
    fn outboard(&self) -> Vec3<T> {
        let Vec3 { x, y, z } = self.spin_axis;
        Vec3::new(x, y, z.zero()) * (z.like(1.0) / (x * x + y * y).sqrt())
    }

    /// Forward along the ground: where the wheel's plane and the ground meet.
    fn forward(&self) -> Vec3<T> {
        let Vec3 { x, y, z } = self.outboard();
        Vec3::new(self.side * y, -self.side * x, z)
    }

    /// `C - R u`, with u the upward direction in the wheel's plane, `(z - (z.e) e) / abs(..)`.
    fn contact(&self) -> Vec3<T> {
        let e = self.spin_axis;
        let up = Vec3::AXES[2].spread(self.radius) - e * e.z;
        self.centre - up * (self.radius / up.norm())
    }

    fn half_track(&self) -> T {
        self.side * self.contact().y
    }

    fn caster_trail(&self) -> T {
        -self.off_kingpin(self.contact()).dot(self.forward())
    }

    /// From the lower point of the kingpin to the upper one.
    fn along_kingpin(&self) -> Vec3<T> {
        let [lower, upper] = self.kingpin();
        upper - lower
    }

    /// From the kingpin to a point, at the point's height: `P - L - k (P_z - L_z) / k_z`.
    fn off_kingpin(&self, p: Vec3<T>) -> Vec3<T> {
        let [lower, upper] = self.kingpin();
        let (d, k) = (p - lower, upper - lower);
        d - k * (d.z / k.z)
    }

    fn kingpin(&self) -> [Vec3<T>; 2] {
        self.kingpin.expect("a measure that needs the kingpin is of a wheel that has one")
    }
}
