//! Kinds of contents of a model, and the formats that write them.
//!
//! [`contents`] takes a model apart without leaving a field out, and [`Kind::supports`] has the answer of every group
//! of formats to every kind: the compiler asks for both when a model gets new contents, or the crate a new format.

use hardpoint::model::{Model, Vehicle};
use hardpoint::space::Vec3;
use hardpoint_file::{Appearance, ModelFile};

use crate::ExportedModel;

/// Group of formats that write the same kinds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Hardpoints alone: CSV, TeimOrbit.
    Table,
    /// DXF.
    Drawing,
    /// URDF.
    Urdf,
    /// MJCF.
    Mjcf,
    /// Solved motion as formulas: C, FMU.
    Motion,
}

/// Kind of contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Hardpoints,
    Coordinates,
    Bodies,
    Frames,
    Joints,
    Rods,
    Couplers,
    Driver,
    Start,
    Limits,
    DesignVariables,
    Points,
    Vehicle,
    Wheels,
    Axles,
    Masses,
    Gravity,
    Force,
    Equilibrium,
    Shapes,
    Clearances,
    Meshes,
    Measures,
    Metrics,
    Cases,
    Grids,
    Studies,
    Designs,
    Plots,
}

/// Support of a kind by a group of formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Support {
    /// Written; or reported by the writer one by one; or the writer refuses a model that has it.
    Yes,
    /// Not written, with the reason or the substitute.
    No(&'static str),
}

use Support::{No, Yes};

/// Reason of kinds for which there is nothing more to say.
const NONE: Support = No("not written");

impl Kind {
    /// Name in reports.
    fn name(self) -> &'static str {
        match self {
            Self::Hardpoints => "hardpoints",
            Self::Coordinates => "points",
            Self::Bodies => "bodies",
            Self::Frames => "frames",
            Self::Joints => "joints",
            Self::Rods => "rods",
            Self::Couplers => "couplers",
            Self::Driver => "driver",
            Self::Start => "start",
            Self::Limits => "limits",
            Self::DesignVariables => "design variables",
            Self::Points => "points of bodies",
            Self::Vehicle => "vehicle",
            Self::Wheels => "wheels",
            Self::Axles => "axles",
            Self::Masses => "masses",
            Self::Gravity => "gravity",
            Self::Force => "force",
            Self::Equilibrium => "equilibrium",
            Self::Shapes => "shapes",
            Self::Clearances => "clearances",
            Self::Meshes => "meshes",
            Self::Measures => "measures",
            Self::Metrics => "metrics",
            Self::Cases => "cases",
            Self::Grids => "grids",
            Self::Studies => "studies",
            Self::Designs => "designs",
            Self::Plots => "plots",
        }
    }

    /// Support by tables of hardpoints, DXF, URDF, MJCF, and the formats that contain the motion.
    fn supports(self) -> [Support; 5] {
        let joints_only = No("only those of joints are written, without their names");
        let own_frames = No(
            "written at the joint that carries each body, with the global axes of the design configuration",
        );
        let pose = No("written in the design configuration");
        match self {
            Self::Hardpoints => [Yes, Yes, joints_only, joints_only, Yes],
            Self::Coordinates => {
                let unnamed = No("points without the name of a hardpoint are not written");
                [unnamed, unnamed, Yes, Yes, Yes]
            }
            Self::Bodies => [NONE, Yes, Yes, Yes, Yes],
            Self::Frames => [NONE, NONE, own_frames, own_frames, Yes],
            Self::Joints => [NONE, No("DXF has no joints: only their points are written"), Yes, Yes, Yes],
            Self::Rods => [NONE, Yes, Yes, Yes, Yes],
            Self::Couplers => [NONE, NONE, Yes, Yes, Yes],
            // Drivers are arguments of a motion in formulas, whatever their laws are.
            Self::Driver => [
                NONE,
                No("DXF does not support motions"),
                No("URDF does not support motions"),
                No("MJCF does not support motions"),
                Yes,
            ],
            Self::Cases | Self::Grids => [NONE, NONE, NONE, NONE, Yes],
            Self::Start => [NONE, pose, pose, pose, Yes],
            Self::Limits => [
                NONE,
                NONE,
                Yes,
                Yes,
                No("their values are measures; nothing stops the motion at their ends"),
            ],
            // The formats that contain the motion report each of them.
            Self::DesignVariables | Self::Measures => [NONE, NONE, NONE, NONE, Yes],
            Self::Points => [NONE, Yes, NONE, NONE, Yes],
            // Their measures are written.
            Self::Wheels | Self::Axles | Self::Vehicle => [NONE, NONE, NONE, NONE, Yes],
            Self::Masses => {
                [NONE, NONE, Yes, Yes, No("the motion does not depend on them; loads are not written")]
            }
            Self::Gravity => [NONE, NONE, No("URDF does not define gravity"), Yes, NONE],
            Self::Force => [NONE; 5],
            Self::Equilibrium => [NONE, NONE, NONE, NONE, Yes],
            Self::Shapes | Self::Clearances | Self::Meshes => [NONE; 5],
            Self::Metrics | Self::Studies | Self::Designs | Self::Plots => [NONE; 5],
        }
    }

    /// Support by a group of formats.
    fn support(self, target: Target) -> Support {
        let [table, drawing, urdf, mjcf, motion] = self.supports();
        match target {
            Target::Table => table,
            Target::Drawing => drawing,
            Target::Urdf => urdf,
            Target::Mjcf => mjcf,
            Target::Motion => motion,
        }
    }
}

/// Contents of a model by kinds: their names, or their number.
fn contents(file: &ModelFile) -> Vec<(Kind, String)> {
    let Model {
        name: _,
        // Their values are those of what they define.
        parameters: _,
        formulas: _,
        numbers: _,
        hardpoints,
        bodies,
        joints: _,
        couplers,
        drivers,
        start,
        variables,
        points,
        vehicle,
        wheels,
        axles,
        shapes,
        clearances,
        elements,
        gravity,
        // Options of the motion and of its loads.
        load_mode: _,
        idle: _,
        times: _,
        at_change_points: _,
        equilibrium,
        measures,
        joint_limits,
        metrics,
        cases,
        grids,
        optimization,
        tolerancing,
        sweeping,
        calibrating,
        plots,
        designs,
    } = &file.model;
    let Appearance { bodies: meshes, joints: forms, measures: springs } = &file.drawing;
    let unnamed = hardpoints.iter().filter(|h| h.unnamed).count();
    let rods = file.model.named_joints().filter(|(_, joint)| joint.kind.is_rod()).count();
    let masses = elements.iter().filter(|e| e.kind.has_mass()).count();
    let studies = [optimization.is_some(), tolerancing.is_some(), sweeping.is_some(), calibrating.is_some()];
    let each = |kind: Kind, count: usize| (count > 0).then(|| (kind, count.to_string()));
    let is = |kind: Kind, given: bool| given.then(|| (kind, file.model.name.clone()));
    let mut found: Vec<(Kind, String)> = Vec::new();
    found.extend(each(Kind::Hardpoints, hardpoints.len() - unnamed));
    found.extend(each(Kind::Coordinates, unnamed));
    // Ground is the first body.
    found.extend(each(Kind::Bodies, bodies.len() - 1));
    found.extend(each(Kind::Frames, bodies.len() - 1));
    found.extend(each(Kind::Joints, file.model.named_joints().count() - rods));
    found.extend(each(Kind::Rods, rods));
    found.extend(each(Kind::Couplers, couplers.len()));
    found.extend(drivers.iter().map(|d| (Kind::Driver, d.name.clone())));
    found.extend(each(Kind::Start, start.len()));
    found.extend(each(Kind::Limits, joint_limits.len()));
    found.extend(each(Kind::DesignVariables, variables.len()));
    found.extend(each(Kind::Points, points.iter().filter(|p| !p.unnamed).count()));
    // Those of limits are reported with them.
    found.extend(each(Kind::Measures, measures.len() - joint_limits.len()));
    found.extend(each(Kind::Metrics, metrics.len()));
    found.extend(is(Kind::Vehicle, *vehicle != Vehicle::default()));
    found.extend(each(Kind::Wheels, wheels.len()));
    found.extend(each(Kind::Axles, axles.len()));
    found.extend(each(Kind::Masses, masses));
    found.extend(is(Kind::Gravity, *gravity != Vec3::ZERO));
    let forces = elements.iter().filter(|e| !e.kind.has_mass());
    found.extend(forces.map(|e| (Kind::Force, e.name.clone())));
    found.extend(is(Kind::Equilibrium, equilibrium.is_some()));
    found.extend(each(Kind::Shapes, shapes.len()));
    found.extend(each(Kind::Clearances, clearances.len()));
    found.extend(each(Kind::Meshes, meshes.len()));
    found.extend(each(Kind::Cases, cases.len()));
    found.extend(each(Kind::Grids, grids.len()));
    found.extend(each(Kind::Studies, studies.into_iter().filter(|has| *has).count()));
    found.extend(each(Kind::Designs, designs.len()));
    found.extend(each(Kind::Plots, plots.len() + forms.len() + springs.len()));
    found
}

impl ExportedModel {
    /// Reports the contents of a model that a group of formats does not write.
    pub(crate) fn report_contents(&mut self, file: &ModelFile, target: Target) {
        for (kind, name) in contents(file) {
            if let No(why) = kind.support(target) {
                self.report_unsupported(kind.name(), &name, why);
            }
        }
    }
}
