//! Checks of the equilibrium: its drivers, and what it cannot have.

use crate::draft::Section;
use crate::joint::{DIRECTION_NAMES, DIRECTIONS, tied_directions};
use crate::model::element::Compliance;
use crate::model::{DriverId, Equilibrium, Joint, JointId, OutputSource};

use super::{Checker, Here};

impl Checker<'_> {
    pub(super) fn add_equilibrium(&mut self) {
        let Some(written) = &self.draft.equilibrium else { return };
        let released = self.released_drivers(&written.released);
        self.check_forces_at_rest();
        self.model.equilibrium = Some(Equilibrium { released: released.clone() });
        self.check_measures_at_rest(&released);
    }

    /// HP0260: a driver that is released twice.
    fn released_drivers(&mut self, names: &[String]) -> Vec<DriverId> {
        let here = Here { section: Section::Equilibrium, index: 0 };
        let mut released = Vec::new();
        for (k, name) in names.iter().enumerate() {
            let Some(driver) = self.driver_named(name, here.item("released", k)) else { continue };
            if released.contains(&driver) {
                let message = format!("driver `{name}` is released twice");
                self.fault("HP0260", here.item("released", k), message).help("name it once");
            }
            released.push(driver);
        }
        released
    }

    /// HP0261: friction, or the stiffness of a joint that cannot open.
    fn check_forces_at_rest(&mut self) {
        for index in 0..self.draft.forces.len() {
            let here = Here { section: Section::Forces, index };
            let name = &self.draft.forces[index].name;
            let Some(e) = self.model.elements.iter().find(|e| e.name == *name) else { continue };
            if e.kind.has_friction(&self.model) {
                let message = format!("`{name}` is friction, which is not determined at rest");
                self.fault("HP0261", here.key("type"), message)
                    .note("an equilibrium has no motion that friction could oppose")
                    .help("remove it, or remove `equilibrium`");
            } else if let Some(Compliance::Joint(elastic)) =
                e.kind.force(&self.model).map(|force| force.compliance)
            {
                let (joint, gives) = (elastic.joint, elastic.law().gives());
                self.check_opening(name, joint, gives, here);
            }
        }
    }

    /// HP0261: an elastic joint whose type has no axes to open along, or ties the directions that deflect.
    fn check_opening(&mut self, name: &str, joint: JointId, gives: [bool; DIRECTIONS], here: Here) {
        let Joint { name: joint, kind, .. } = &self.model.joints[joint.0];
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
            return;
        }
        let tied = tied_directions(kind);
        let Some(k) = (0..DIRECTIONS).find(|k| tied[*k] && gives[*k]) else { return };
        let direction = DIRECTION_NAMES[k];
        let message = format!("joint `{joint}` of `{name}` cannot open in direction `{direction}`");
        let (note, help) = match kind.has_lead() {
            true => (
                "a screw moves along and about its axis by its lead",
                "hold its nut or its spindle by an elastic joint of another type; for a spring against its motion add a force of `type = \"torsion_spring\"`",
            ),
            false => (
                "both shafts of a constant-velocity joint turn alike",
                "divide one of its shafts by a `fixed` joint, and give the stiffness to that joint",
            ),
        };
        self.fault("HP0261", here.key(direction), message).note(note).help(help);
    }

    /// HP0261: a rate, or a measure per motion of a released driver.
    fn check_measures_at_rest(&mut self, released: &[DriverId]) {
        for index in 0..self.draft.measures.len() {
            let name = &self.draft.measures[index].name;
            let Some(k) = self.model.measures.iter().position(|m| m.name == *name) else { continue };
            let here = Here { section: Section::Measures, index };
            if self.model.known(OutputSource::Measure(k)).is_rate {
                let message = format!("measure `{name}` is a rate, and an equilibrium is at rest");
                self.fault("HP0261", here.key("type"), message).help("remove it, or remove `equilibrium`");
            }
            let alone = self.model.drivers_alone(k).find(|d| released.contains(d));
            if let Some(driver) = alone {
                let driver = &self.model.drivers[driver.0].name;
                let message =
                    format!("measure `{name}` is per motion of driver `{driver}`, which is released");
                self.fault("HP0261", here.key("type"), message)
                    .note("springs and loads determine its value, so that it cannot move alone")
                    .help("hold the driver, or remove the measure");
            }
        }
    }
}
