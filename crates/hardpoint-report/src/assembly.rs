//! Open constraints of the design configuration, and their assembly.

use hardpoint::joint::Quantity;
use hardpoint::model::Model;
use hardpoint::motion::{Assembly, Closing, Gap};
use hardpoint_file::Units;
use serde::Serialize;

use crate::facts::table;
use crate::figures::{symbol, with_unit};
use crate::page::Table;

/// Assembly of the mechanism before its motion.
#[derive(Clone, Debug, Serialize)]
pub struct AssemblyFact {
    /// Open constraints, largest gaps first.
    pub gaps: Vec<GapFact>,
    /// The bodies that moved.
    pub moved: Vec<MovedFact>,
    /// Number of assemblies found around the design configuration if the direct path leads to none; the nearest was
    /// used. 0 if the gaps were closed along the path.
    pub found_nearby: usize,
}

/// Open constraint of the design configuration.
#[derive(Clone, Debug, Serialize)]
pub struct GapFact {
    /// `joint`, `driver` or `coupler`.
    pub kind: &'static str,
    /// Name of the joint, driver or coupler.
    pub name: String,
    /// Size of the gap, in `unit`.
    pub size: f64,
    /// Unit of `size`.
    pub unit: &'static str,
}

/// Displacement of a body by the assembly.
#[derive(Clone, Debug, Serialize)]
pub struct MovedFact {
    /// Name of the body.
    pub body: String,
    /// Displacement of its origin, in `distance_unit`.
    pub distance: f64,
    /// Unit of `distance`.
    pub distance_unit: &'static str,
    /// Angle of its rotation, in `angle_unit`.
    pub angle: f64,
    /// Unit of `angle`.
    pub angle_unit: &'static str,
}

impl GapFact {
    /// Converts a gap to the user's units.
    pub fn new(model: &Model, units: Units, gap: &Gap) -> Self {
        let (kind, name) = match gap.of {
            Closing::Joint(j) => ("joint", &model.joints[j.0].name),
            Closing::Driver(d) => ("driver", &model.drivers[d.0].name),
            Closing::Coupler(c) => ("coupler", &model.couplers[c].name),
        };
        // The gap of a direction is a cosine that is 0 when closed. To first order it is an angle.
        let of = gap.quantity;
        Self { kind, name: name.clone(), size: units.from_si(of, gap.size), unit: symbol(units, of) }
    }

    /// Formatted size with its unit: `133.8 mm`.
    pub fn size_text(&self) -> String {
        with_unit(self.size, self.unit)
    }
}

impl AssemblyFact {
    /// Converts an assembly to the user's units.
    pub fn new(model: &Model, units: Units, assembly: &Assembly) -> Self {
        let (length, angle) = (Quantity::Length, Quantity::Angle);
        let moved = assembly.moved.iter().map(|m| MovedFact {
            body: model.bodies[m.body.0].name.clone(),
            distance: units.from_si(length, m.distance),
            distance_unit: symbol(units, length),
            angle: units.from_si(angle, m.angle),
            angle_unit: symbol(units, angle),
        });
        Self {
            gaps: assembly.gaps.iter().map(|g| GapFact::new(model, units, g)).collect(),
            moved: moved.collect(),
            found_nearby: assembly.found_nearby,
        }
    }

    /// Tables of the open constraints and of the displaced bodies.
    pub fn tables(&self) -> [Table; 2] {
        let gap = |g: &GapFact| vec![format!("{} {}", g.kind, g.name), g.size_text()];
        let moved = |m: &MovedFact| {
            vec![m.body.clone(), with_unit(m.distance, m.distance_unit), with_unit(m.angle, m.angle_unit)]
        };
        let title = match self.found_nearby {
            0 => "Moved by the assembly".to_owned(),
            1 => "Moved by the assembly, the only one found near the design configuration, which is a singular position"
                .to_owned(),
            n => format!(
                "Moved by the assembly, the nearest of {n} found near the design configuration, which is a singular position"
            ),
        };
        [
            table(
                "Assembled",
                "These constraints are open in the design configuration and closed before the motion starts, with every driver at zero.",
                ["constraint", "gap in the design configuration"],
                self.gaps.iter().map(gap),
            ),
            table(
                &title,
                "Displacements from the design configuration.",
                ["body", "origin moved by", "turned by"],
                self.moved.iter().map(moved),
            ),
        ]
    }
}
