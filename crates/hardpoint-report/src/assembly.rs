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
    /// Number of assemblies found around the drawing, where the path from it leads to none; the nearest was taken. 0
    /// where the gaps were closed along the path.
    pub found_nearby: usize,
}

/// Something that is open.
#[derive(Clone, Debug, Serialize)]
pub struct GapFact {
    /// `joint`, `driver` or `coupler`.
    pub kind: &'static str,
    /// Name.
    pub name: String,
    /// By how much it is open.
    pub size: f64,
    /// The unit of that.
    pub unit: &'static str,
}

/// Displacement of a body by the assembly.
#[derive(Clone, Debug, Serialize)]
pub struct MovedFact {
    /// The body.
    pub body: String,
    /// Displacement of its origin.
    pub distance: f64,
    /// The unit of that.
    pub distance_unit: &'static str,
    /// Angle of its rotation.
    pub angle: f64,
    /// The unit of that.
    pub angle_unit: &'static str,
}

impl GapFact {
    /// A gap in the user's units.
    pub fn new(model: &Model, units: Units, gap: &Gap) -> Self {
        let (kind, name) = match gap.of {
            Closing::Joint(j) => ("joint", &model.joints[j.0].name),
            Closing::Driver(d) => ("driver", &model.drivers[d.0].name),
            Closing::Coupler(c) => ("coupler", &model.couplers[c].name),
        };
        // The gap of a direction is a cosine that is 0 when closed: to first order an angle.
        let of = gap.quantity;
        Self { kind, name: name.clone(), size: units.from_si(of, gap.size), unit: symbol(units, of) }
    }

    /// `133.8 mm`.
    pub fn size_text(&self) -> String {
        with_unit(self.size, self.unit)
    }
}

impl AssemblyFact {
    /// An assembly in the user's units.
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
            1 => "Moved by the assembly, the only one found near the drawing, which is a singular position"
                .to_owned(),
            n => format!(
                "Moved by the assembly, the nearest of {n} found near the drawing, which is a singular position"
            ),
        };
        [
            table(
                "Assembled",
                "These were open in the drawing and are closed before the motion starts, with every driver at zero.",
                ["what", "open in the design configuration by"],
                self.gaps.iter().map(gap),
            ),
            table(
                &title,
                "From where the bodies were drawn.",
                ["body", "origin moved by", "turned by"],
                self.moved.iter().map(moved),
            ),
        ]
    }
}
