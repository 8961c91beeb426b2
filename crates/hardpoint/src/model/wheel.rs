//! Road wheels: what carries them, where they touch the ground, and the axis that they steer about.

use super::{BodyId, Direction, PointId};
use crate::joint::Quantity;

/// A road wheel. Vehicle axes are those of ISO 8855: x forward, y left, z up.
#[derive(Clone, Debug, PartialEq)]
pub struct Wheel {
    /// Its name.
    pub name: String,
    /// The body that it turns on: the knuckle.
    pub body: BodyId,
    /// Its centre, a point of that body.
    pub centre: PointId,
    /// Its spin axis in the design configuration, pointing outboard.
    pub spin_axis: Direction,
    /// From the centre to the ground in the wheel's plane, m.
    pub radius: f64,
    /// On which side of the vehicle it is.
    pub side: Side,
    /// A lower and an upper point of the axis that it steers about; they may be on different bodies.
    pub kingpin: Option<[PointId; 2]>,
}

/// A side of the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Where y grows.
    Left,
    /// Where y falls.
    Right,
}

impl Side {
    /// 1 on the left, -1 on the right: the sign of y outboard.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }

    /// As model files write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

macro_rules! wheel_measures {
    ($(#[doc = $summary:literal] $variant:ident $name:literal $quantity:ident $kingpin:literal)*) => {
        /// What can be measured at a wheel. Formulas and signs are in `docs/measures.md`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum WheelMeasure {
            $(#[doc = $summary] $variant,)*
        }

        impl WheelMeasure {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// As model files write it.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),* }
            }

            /// What it is, in a sentence.
            pub fn summary(self) -> &'static str {
                match self { $(Self::$variant => $summary.trim_ascii()),* }
            }

            /// What its value is.
            pub fn quantity(self) -> Quantity {
                match self { $(Self::$variant => Quantity::$quantity),* }
            }

            /// Whether it needs the wheel's kingpin.
            pub fn needs_kingpin(self) -> bool {
                match self { $(Self::$variant => $kingpin),* }
            }
        }
    };
}

wheel_measures! {
    /// Heading of the wheel's plane; positive where its front is inboard.
    Toe "toe" Angle false
    /// Lean of the wheel's plane; positive where its top is outboard.
    Camber "camber" Angle false
    /// Heading of the wheel's plane since the design configuration; positive to the left.
    SteerAngle "steer_angle" Angle false
    /// Lean of the kingpin in side view; positive where its top is rearward.
    Caster "caster" Angle true
    /// Lean of the kingpin in front view; positive where its top is inboard.
    KingpinInclination "kingpin_inclination" Angle true
    /// How far outboard of the kingpin the contact point is, on the ground.
    ScrubRadius "scrub_radius" Length true
    /// How far outboard of the kingpin the wheel centre is, at its height.
    SpindleOffset "spindle_offset" Length true
    /// How far behind the kingpin the contact point is, on the ground.
    CasterTrail "caster_trail" Length true
    /// The same square to the kingpin, in the wheel's side view.
    MechanicalTrail "mechanical_trail" Length true
    /// How far in front of the kingpin the wheel centre is, at its height.
    HubTrail "hub_trail" Length true
    /// Rise of the wheel centre since the design configuration.
    WheelTravel "wheel_travel" Length false
    /// Way of the wheel centre rearward since the design configuration.
    WheelRecession "wheel_recession" Length false
    /// Distance of the contact point from the vehicle's plane of symmetry, outboard.
    HalfTrack "half_track" Length false
    /// Growth of that since the design configuration.
    HalfTrackChange "half_track_change" Length false
    /// Global x of the contact point.
    ContactX "contact_x" Length false
    /// Global y of the contact point.
    ContactY "contact_y" Length false
    /// Global z of the contact point.
    ContactZ "contact_z" Length false
}

impl WheelMeasure {
    /// The measure of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|m| m.name() == name)
    }
}
