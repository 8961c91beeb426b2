//! Couplers: gears, racks, belts, screws and other linear relations between joint coordinates.

use super::JointId;

/// A linear relation between joint coordinates, each counted from the design configuration and through whole turns:
/// `sum of coefficient x coordinate = constant`.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupler {
    /// Name; that of the joint for a screw.
    pub name: String,
    /// Transmission that defines the relation; none if coefficients define it.
    pub transmission: Option<Transmission>,
    /// Terms; no coefficient is zero. A change of the design leaves them alone.
    pub terms: Vec<CouplerTerm>,
    /// Value of the sum, in the unit of its terms. Where it is not zero, the mechanism is assembled to it.
    pub constant: f64,
}

impl Coupler {
    /// True for the thread of a screw, which is part of its joint.
    pub fn is_thread(&self) -> bool {
        match self.transmission {
            Some(Transmission::Screw { .. }) => true,
            Some(Transmission::Gears { .. } | Transmission::Rack { .. } | Transmission::Belt { .. })
            | None => false,
        }
    }
}

/// A joint coordinate times a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CouplerTerm {
    /// Joint of the term.
    pub joint: JointId,
    /// Index of the coordinate in the joint's type.
    pub coordinate: usize,
    /// The factor, per m or per rad of the coordinate.
    pub coefficient: f64,
}

/// Transmission between two joint coordinates, with the dimensions that define the relation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transmission {
    /// Two gears: `teeth_1 angle_1 + teeth_2 angle_2 = 0`, or minus for an internal gear.
    Gears {
        /// Teeth, or any two numbers in their ratio.
        teeth: [f64; 2],
        /// True if one of them is an internal gear, so that both turn the same way.
        internal: bool,
        /// True if they are bevel gears.
        bevel: bool,
    },
    /// A rack, then its pinion: `displacement = radius x angle`.
    Rack {
        /// Pitch radius, m; negative where the rack passes the pinion's other side.
        radius: f64,
    },
    /// A belt: `radius_1 angle_1 = radius_2 angle_2`, or minus for a crossed one.
    Belt {
        /// Radii of the pulleys, m.
        radii: [f64; 2],
        /// True if the belt crosses between them.
        crossed: bool,
    },
    /// A thread: `displacement = lead / 2 pi x angle`.
    Screw {
        /// Advance per turn, m; negative for a left-hand thread.
        lead: f64,
    },
}

impl Transmission {
    /// As model files write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gears { bevel: false, .. } => "gear",
            Self::Gears { bevel: true, .. } => "bevel",
            Self::Rack { .. } => "rack",
            Self::Belt { .. } => "belt",
            Self::Screw { .. } => "screw",
        }
    }

    /// The two coordinates that it couples, with their coefficients.
    pub(crate) fn relation(self) -> [(&'static str, f64); 2] {
        let per_radian = |lead: f64| lead / (2.0 * std::f64::consts::PI);
        match self {
            Self::Gears { teeth: [a, b], internal, .. } => {
                [("angle", a), ("angle", if internal { -b } else { b })]
            }
            Self::Rack { radius } => [("displacement", 1.0), ("angle", -radius)],
            Self::Belt { radii: [a, b], crossed } => [("angle", a), ("angle", if crossed { b } else { -b })],
            Self::Screw { lead } => [("displacement", 1.0), ("angle", -per_radian(lead))],
        }
    }
}
