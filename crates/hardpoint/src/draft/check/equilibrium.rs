//! Checks of the equilibrium: its drivers, and what it cannot have.

use crate::draft::Section;
use crate::joint::{DIRECTION_NAMES, DIRECTIONS, tied_directions};
use crate::model::element::Compliance;
use crate::model::{Equilibrium, Joint, MeasureKind};

use super::{Checker, Here};

impl Checker<'_> {
    pub(super) fn add_equilibrium(&mut self) {
        let draft = self.draft;
        let Some(written) = &draft.equilibrium else { return };
        let here = Here { section: Section::Equilibrium, index: 0 };
        let mut released = Vec::new();
        for (k, name) in written.released.iter().enumerate() {
            let Some(driver) = self.driver_named(name, here.item("released", k)) else { continue };
            if released.contains(&driver) {
                let message = format!("driver `{name}` is released twice");
                self.fault("HP0260", here.item("released", k), message).help("name it once");
            }
            released.push(driver);
        }
        for index in 0..draft.forces.len() {
            let here = Here { section: Section::Forces, index };
            let name = &draft.forces[index].name;
            let Some(e) = self.model.elements.iter().find(|e| e.name == *name) else { continue };
            if e.kind.has_friction(&self.model) {
                let message = format!("`{name}` is friction, which is not determined at rest");
                self.fault("HP0261", here.key("type"), message)
                    .note("an equilibrium has no motion that friction could oppose")
                    .help("remove it, or remove `equilibrium`");
                continue;
            }
            let Some(Compliance::Joint(elastic)) = e.kind.force(&self.model).map(|force| force.compliance)
            else {
                continue;
            };
            let Joint { name: joint, kind, .. } = &self.model.joints[elastic.joint.0];
            if kind.freedoms.is_none() {
                let message = format!("joint `{joint}` of `{name}` cannot open");
                let help = if kind.is_rod() {
                    "for a rod that is elastic along itself, replace the joint by a force of `type = \"spring\"` between its ends"
                } else {
                    "name a joint of another type, or remove this force"
                };
                let note =
                    format!("joints of type `{}` have no axes along which they open under load", kind.name);
                self.fault("HP0261", here.key("joint"), message).note(note).help(help);
                continue;
            }
            let (tied, gives) = (tied_directions(kind), elastic.law().gives());
            if let Some(k) = (0..DIRECTIONS).find(|k| tied[*k] && gives[*k]) {
                let (direction, screw) = (DIRECTION_NAMES[k], kind.has_lead());
                let message = format!("joint `{joint}` of `{name}` cannot open in direction `{direction}`");
                let note = match screw {
                    true => "a screw moves along and about its axis by its lead",
                    false => "both shafts of a constant-velocity joint turn alike",
                };
                let help = match screw {
                    true => {
                        "hold its nut or its spindle by an elastic joint of another type; for a spring against its motion add a force of `type = \"torsion_spring\"`"
                    }
                    false => {
                        "divide one of its shafts by a `fixed` joint, and give the stiffness to that joint"
                    }
                };
                self.fault("HP0261", here.key(direction), message).note(note).help(help);
            }
        }
        self.model.equilibrium = Some(Equilibrium { released: released.clone() });
        for index in 0..draft.measures.len() {
            let k = self.model.measures.iter().position(|m| m.name == draft.measures[index].name);
            let found = k.map(|k| &self.model.measures[k]);
            let is_rate = found.is_some_and(|m| match m.kind {
                MeasureKind::Velocity { .. }
                | MeasureKind::AngularVelocity { .. }
                | MeasureKind::Acceleration { .. }
                | MeasureKind::Curvature { .. }
                | MeasureKind::Rate { .. }
                | MeasureKind::DriverPower { .. }
                | MeasureKind::KineticEnergy { .. } => true,
                MeasureKind::Slope { .. }
                | MeasureKind::Dexterity { .. }
                | MeasureKind::Coordinate { .. }
                | MeasureKind::Distance { .. }
                | MeasureKind::Coordinates { .. }
                | MeasureKind::Angle { .. }
                | MeasureKind::Orientation { .. }
                | MeasureKind::TransmissionAngle { .. }
                | MeasureKind::Clearance { .. }
                | MeasureKind::Articulation { .. }
                | MeasureKind::Combination { .. }
                | MeasureKind::Camber { .. }
                | MeasureKind::Toe { .. }
                | MeasureKind::DriverForce { .. }
                | MeasureKind::Reaction { .. }
                | MeasureKind::SpringForce { .. }
                | MeasureKind::ShakingForce { .. }
                | MeasureKind::ShakingMoment { .. }
                | MeasureKind::Compliance { .. }
                | MeasureKind::Wheel { .. }
                | MeasureKind::Axle { .. } => false,
            });
            if is_rate {
                let message = format!(
                    "measure `{}` is a rate, and an equilibrium is at rest",
                    draft.measures[index].name
                );
                let at = Here { section: Section::Measures, index }.key("type");
                self.fault("HP0261", at, message).help("remove it, or remove `equilibrium`");
            }
            let alone = k.and_then(|k| self.model.drivers_alone(k).find(|d| released.contains(d)));
            if let Some(driver) = alone {
                let message = format!(
                    "measure `{}` is per motion of driver `{}`, which is released",
                    draft.measures[index].name, self.model.drivers[driver.0].name
                );
                let at = Here { section: Section::Measures, index }.key("type");
                self.fault("HP0261", at, message)
                    .note("springs and loads determine its value, so that it cannot move alone")
                    .help("hold the driver, or remove the measure");
            }
        }
    }
}
