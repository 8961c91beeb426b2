//! What is known of a mechanism once it is planned and, as far as possible, solved.
//!
//! Built once and shown three times: as text by `hardpoint check`, as JSON, and as tables of the page.

mod text;

use hardpoint::Solution;
use hardpoint::constraint::Row;
use hardpoint::joint::Quantity;
use hardpoint::model::{BodyId, Change, Direction, JointId, MeasureKind, Model, VariableId};
use hardpoint::sensitivity::{self, JointDefect, admissibility_at_design};
use hardpoint::space::Vec3;
use hardpoint::topology::{CutReason, Formulation, Role, Topology};
use hardpoint_file::{ModelFile, Units};
use serde::Serialize;

use crate::figures::{count, names, per, symbol};

/// The facts, with all names as the user wrote them and all figures in the user's units.
#[derive(Clone, Debug, Serialize)]
pub struct Facts {
    /// The mechanism's name.
    pub name: String,
    /// What the file says about itself.
    pub description: Option<String>,
    /// The model file, as it was given.
    pub file: String,
    /// The units of every figure; time is in s.
    pub units: Units,
    /// `relative` or `absolute` coordinates.
    pub formulation: &'static str,
    /// How many there are of everything.
    pub counts: Counts,
    /// Bodies without ground.
    pub bodies: Vec<BodyFact>,
    /// Joints and why each is in the tree or cut.
    pub joints: Vec<JointFact>,
    /// Drivers.
    pub drivers: Vec<DriverFact>,
    /// What is solved together, in the order of solution.
    pub blocks: Vec<BlockFact>,
    /// Constraints that the others imply.
    pub redundant: Vec<RedundantFact>,
    /// Design variables and whether the mechanism can follow them.
    pub variables: Vec<VariableFact>,
    /// Measures.
    pub measures: Vec<MeasureFact>,
}

/// How many there are.
#[derive(Clone, Debug, Serialize)]
pub struct Counts {
    /// Bodies without ground.
    pub bodies: usize,
    /// Joints.
    pub joints: usize,
    /// Drivers.
    pub drivers: usize,
    /// Degrees of freedom without drivers, at the design configuration.
    pub mobility: usize,
    /// Constraint equations of all joints.
    pub joint_constraints: usize,
    /// Constraint rows of the cut joints and of drivers across them, redundant ones included.
    pub cut_constraints: usize,
    /// Rows among those that the others imply.
    pub redundant_constraints: usize,
    /// Independent loops of the joint graph.
    pub loops: usize,
    /// Coordinates of the joints in the tree.
    pub coordinates: usize,
    /// Coordinates that no driver prescribes, solved for at every step.
    pub unknowns: usize,
}

/// A body.
#[derive(Clone, Debug, Serialize)]
pub struct BodyFact {
    /// Its name.
    pub name: String,
    /// The joint of the tree that places it; none if it moves freely or in absolute coordinates.
    pub placed_by: Option<String>,
    /// The body that carries it.
    pub carried_by: String,
    /// Joints on it.
    pub joints: Vec<String>,
}

/// A joint.
#[derive(Clone, Debug, Serialize)]
pub struct JointFact {
    /// Its name.
    pub name: String,
    /// Its type.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Bodies i and j.
    pub bodies: [String; 2],
    /// `tree` or `cut`.
    pub role: &'static str,
    /// Why.
    pub why: String,
    /// How many constraint equations it stands for.
    pub constraints: usize,
}

/// A driver.
#[derive(Clone, Debug, Serialize)]
pub struct DriverFact {
    /// Its name.
    pub name: String,
    /// The joint that it drives.
    pub joint: String,
    /// The joint's coordinate.
    pub coordinate: &'static str,
    /// The law as written, in `unit`, t in s.
    pub law: String,
    /// The law's unit.
    pub unit: &'static str,
}

/// Unknowns that are solved together.
#[derive(Clone, Debug, Serialize)]
pub struct BlockFact {
    /// Its place in the order of solution, from 1.
    pub number: usize,
    /// How many unknown coordinates it solves for.
    pub unknowns: usize,
    /// The joints whose coordinates they are.
    pub joints: Vec<String>,
    /// The cut joints, and drivers across them, that it closes.
    pub closes: Vec<String>,
    /// The bodies that stand when it is solved.
    pub places: Vec<String>,
    /// Redundant constraints among those that it closes.
    pub redundant: usize,
}

/// A constraint that the others imply.
#[derive(Clone, Debug, Serialize)]
pub struct RedundantFact {
    /// Its joint.
    pub joint: String,
    /// The driver, if it prescribes a coordinate.
    pub driver: Option<String>,
    /// What it asks for.
    pub constraint: String,
}

/// Whether the mechanism can follow a design variable over the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// All joints stay closed with all bodies where they are.
    Admissible,
    /// Joints open and the mechanism closes them by moving.
    Reassembled,
    /// No motion closes them: there is no sensitivity.
    CannotFollow,
    /// The motion was not solved.
    Unknown,
}

/// A design variable.
#[derive(Clone, Debug, Serialize)]
pub struct VariableFact {
    /// Its name.
    pub name: String,
    /// Its unit; `1` for a plain number.
    pub unit: &'static str,
    /// What changes with it.
    pub change: String,
    /// Joints that open at the design configuration while all bodies stay; none: admissible there.
    pub opens_at_design: Vec<DefectFact>,
    /// The answer over the whole solved motion.
    pub answer: Answer,
    /// Where the mechanism cannot follow: the joints that resist, with the largest defect over the motion.
    pub resists: Vec<DefectFact>,
    /// Where the mechanism cannot follow: the time of the largest defect, s.
    pub time: Option<f64>,
}

/// By how much a joint opens per unit of a variable.
#[derive(Clone, Debug, Serialize)]
pub struct DefectFact {
    /// The joint.
    pub joint: String,
    /// Its constraint that fails most.
    pub constraint: String,
    /// The defect per unit of the variable.
    pub defect: f64,
    /// Unit of the defect.
    pub unit: String,
}

/// A measure.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureFact {
    /// Its name.
    pub name: String,
    /// What it measures.
    pub what: String,
    /// Its unit.
    pub unit: &'static str,
}

impl Facts {
    /// The facts of a planned mechanism; without a solution nothing is said over the motion.
    pub fn new(file: &ModelFile, topology: &Topology, solution: Option<&Solution>) -> Self {
        let (model, units) = (&file.model, file.units);
        Self {
            name: model.name.clone(),
            description: file.description.clone(),
            file: file.file_name().into(),
            units,
            formulation: match topology.formulation {
                Formulation::Relative => "relative",
                Formulation::Absolute => "absolute",
            },
            counts: counts(model, topology),
            bodies: bodies(model, topology),
            joints: joints(model, topology),
            drivers: drivers(model, units),
            blocks: blocks(model, topology),
            redundant: redundant(model, topology),
            variables: variables(model, units, solution),
            measures: measures(model, units),
        }
    }

    /// How many variables have this answer.
    pub fn answers(&self, answer: Answer) -> usize {
        self.variables.iter().filter(|v| v.answer == answer).count()
    }
}

fn counts(model: &Model, topology: &Topology) -> Counts {
    let bodies = model.bodies.len() - 1;
    Counts {
        bodies,
        joints: model.joints.len(),
        drivers: model.drivers.len(),
        mobility: topology.mobility,
        joint_constraints: model.joints.iter().map(|j| j.kind.rows.len()).sum(),
        cut_constraints: topology.rows.len(),
        redundant_constraints: topology.redundant().count(),
        // Every joint beyond those of a spanning tree closes one.
        loops: model.joints.len().saturating_sub(bodies),
        coordinates: topology.coordinates.len(),
        unknowns: topology.unknowns(),
    }
}

fn bodies(model: &Model, topology: &Topology) -> Vec<BodyFact> {
    let fact = |b: usize| {
        let link = topology.links.iter().find(|l| l.child == BodyId(b));
        BodyFact {
            name: model.bodies[b].name.clone(),
            placed_by: link.and_then(|l| l.joint).map(|j| joint_name(model, j)),
            carried_by: link.map_or(String::new(), |l| model.bodies[l.parent.0].name.clone()),
            joints: model
                .joints
                .iter()
                .filter(|j| j.bodies.contains(&BodyId(b)))
                .map(|j| j.name.clone())
                .collect(),
        }
    };
    (1..model.bodies.len()).map(fact).collect()
}

fn joints(model: &Model, topology: &Topology) -> Vec<JointFact> {
    let facts = model.joints.iter().zip(&topology.roles).map(|(joint, role)| {
        let (role, why) = match role {
            Role::Tree { child, unknowns } => {
                let child = &model.bodies[child.0].name;
                let leaves = match unknowns {
                    0 => "no unknown".into(),
                    n => count(*n, "unknown"),
                };
                ("tree", format!("places {child}, leaves {leaves}"))
            }
            Role::Cut(reason) => (
                "cut",
                match reason {
                    CutReason::AlwaysCut => "a rod or leg carries no body".into(),
                    CutReason::ClosesLoop => "other joints place its bodies with fewer unknowns".into(),
                    CutReason::Asked => "the model asks for it".into(),
                    CutReason::Absolute => "absolute coordinates cut every joint".into(),
                },
            ),
        };
        JointFact {
            name: joint.name.clone(),
            kind: joint.kind.name,
            bodies: joint.bodies.map(|b| model.bodies[b.0].name.clone()),
            role,
            why,
            constraints: joint.kind.rows.len(),
        }
    });
    facts.collect()
}

fn drivers(model: &Model, units: Units) -> Vec<DriverFact> {
    let fact = |d: &hardpoint::model::Driver| DriverFact {
        name: d.name.clone(),
        joint: joint_name(model, d.joint),
        coordinate: model.driven(d).name,
        law: d.law.to_string(),
        unit: symbol(units, model.driven(d).quantity),
    };
    model.drivers.iter().map(fact).collect()
}

fn blocks(model: &Model, topology: &Topology) -> Vec<BlockFact> {
    let fact = |(k, block): (usize, &hardpoint::topology::Block)| {
        let links = block.unknowns.iter().map(|&c| topology.coordinates[c].link);
        let mut joints: Vec<String> = links
            .map(|l| match topology.links[l].joint {
                Some(j) => joint_name(model, j),
                None => model.bodies[topology.links[l].child.0].name.clone(),
            })
            .collect();
        joints.dedup();
        let closes = block.closures.iter().map(|&c| {
            let closure = &topology.closures[c];
            closure
                .driver
                .map_or_else(|| joint_name(model, closure.joint), |d| model.drivers[d.0].name.clone())
        });
        let rows = |c: &usize| {
            let closure = &topology.closures[*c];
            topology.rows[closure.first_row..closure.first_row + closure.rows.len()].iter()
        };
        BlockFact {
            number: k + 1,
            unknowns: block.unknowns.len(),
            joints,
            closes: closes.collect(),
            places: topology.links[block.links.clone()]
                .iter()
                .map(|l| model.bodies[l.child.0].name.clone())
                .collect(),
            redundant: block.closures.iter().flat_map(rows).filter(|r| !r.selected).count(),
        }
    };
    topology.blocks.iter().enumerate().map(fact).collect()
}

fn redundant(model: &Model, topology: &Topology) -> Vec<RedundantFact> {
    let fact = |(closure, row): (&hardpoint::topology::Closure, Row)| RedundantFact {
        joint: joint_name(model, closure.joint),
        driver: closure.driver.map(|d| model.drivers[d.0].name.clone()),
        constraint: row.describe(),
    };
    topology.redundant().map(fact).collect()
}

fn variables(model: &Model, units: Units, solution: Option<&Solution>) -> Vec<VariableFact> {
    let fact = |(k, variable): (usize, &hardpoint::model::DesignVariable)| {
        let by = variable.quantity;
        let defects = |joints: &[JointDefect]| joints.iter().map(|d| defect(model, units, by, d)).collect();
        let opens = admissibility_at_design(model, &model.field(VariableId(k)));
        let over_motion = solution.and_then(|s| s.sensitivities.admissibility.get(k));
        let (answer, resists, time) = match over_motion {
            Some(sensitivity::Admissibility::Admissible) => (Answer::Admissible, Vec::new(), None),
            Some(sensitivity::Admissibility::Reassembled { .. }) => (Answer::Reassembled, Vec::new(), None),
            Some(sensitivity::Admissibility::CannotFollow { joints, time }) => {
                (Answer::CannotFollow, defects(joints), Some(*time))
            }
            Some(sensitivity::Admissibility::Unknown) | None => (Answer::Unknown, Vec::new(), None),
        };
        VariableFact {
            name: variable.name.clone(),
            unit: symbol(units, by),
            change: change_text(model, &variable.changes, variable.fixed_length),
            opens_at_design: defects(&opens),
            answer,
            resists,
            time,
        }
    };
    model.variables.iter().enumerate().map(fact).collect()
}

fn defect(model: &Model, units: Units, by: Quantity, defect: &JointDefect) -> DefectFact {
    // The defect of a direction is a cosine that is 0 when closed: to first order an angle.
    let of = if defect.row.is_length() { Quantity::Length } else { Quantity::Angle };
    DefectFact {
        joint: joint_name(model, defect.joint),
        constraint: defect.row.describe(),
        defect: units.derivative_from_si(of, by, defect.value),
        unit: per(symbol(units, of), symbol(units, by)),
    }
}

/// What a variable changes, in a few words.
fn change_text(model: &Model, changes: &[Change], fixed_length: bool) -> String {
    let mut parts: Vec<String> = Vec::new();
    let mut moves: Vec<(Vec3, Vec<&str>)> = Vec::new();
    for change in changes {
        match change {
            Change::Move { hardpoint, velocity } => {
                let name = model.hardpoints[hardpoint.0].name.as_str();
                match moves.iter_mut().find(|(v, _)| v == velocity) {
                    Some((_, names)) => names.push(name),
                    None => moves.push((*velocity, vec![name])),
                }
            }
            Change::Marker { joint, end, position, rotation } => {
                let whose = match end {
                    hardpoint::model::End::I => "marker i of ",
                    hardpoint::model::End::J => "marker j of ",
                    hardpoint::model::End::Both => "",
                };
                let name = joint_name(model, *joint);
                if *position != Vec3::ZERO {
                    parts.push(format!("moves {whose}`{name}` along {}", direction_text(*position)));
                }
                if *rotation != Vec3::ZERO {
                    parts.push(format!("turns {whose}`{name}` about {}", direction_text(*rotation)));
                }
            }
            Change::Length { joint, .. } => parts.push(format!("lengthens `{}`", joint_name(model, *joint))),
            Change::Field { joint, end, .. } => {
                let marker = ["i", "j"][*end];
                parts.push(format!("field of marker {marker} of `{}`", joint_name(model, *joint)));
            }
        }
    }
    let moved =
        moves.into_iter().map(|(v, list)| format!("moves {} along {}", names(list), direction_text(v)));
    let mut text = moved.chain(parts).collect::<Vec<_>>().join("; ");
    if fixed_length {
        text += "; rods keep their lengths";
    }
    text
}

fn direction_text(v: Vec3) -> String {
    let Some(u) = v.unit() else { return "nothing".into() };
    const AXES: [(&str, [f64; 3]); 6] = [
        ("x", [1.0, 0.0, 0.0]),
        ("y", [0.0, 1.0, 0.0]),
        ("z", [0.0, 0.0, 1.0]),
        ("-x", [-1.0, 0.0, 0.0]),
        ("-y", [0.0, -1.0, 0.0]),
        ("-z", [0.0, 0.0, -1.0]),
    ];
    let near = |a: &[f64; 3]| u.to_array().iter().zip(a).all(|(p, q)| (p - q).abs() < 1e-12);
    match AXES.iter().find(|(_, a)| near(a)) {
        Some((name, _)) => (*name).into(),
        None => format!("({})", u.to_array().map(|x| crate::figures::rounded(x, 3)).join(", ")),
    }
}

fn measures(model: &Model, units: Units) -> Vec<MeasureFact> {
    let point = |p: hardpoint::model::PointId| {
        let p = &model.points[p.0];
        let place = &model.hardpoints[p.at.0];
        if !p.unnamed {
            format!("`{}`", p.name)
        } else if !place.unnamed {
            format!("`{}` on `{}`", place.name, model.bodies[p.body.0].name)
        } else {
            format!("a point of `{}`", model.bodies[p.body.0].name)
        }
    };
    let axis = |d: &Direction| match d {
        Direction::Along(u) => format!("spin axis along {}", direction_text(*u)),
        Direction::Through(a, b) => {
            let [a, b] = [a, b].map(|h| model.hardpoints[h.0].name.as_str());
            format!("spin axis from `{a}` to `{b}`")
        }
    };
    let fact = |m: &hardpoint::model::Measure| MeasureFact {
        name: m.name.clone(),
        unit: symbol(units, model.measured(m)),
        what: match &m.kind {
            MeasureKind::Coordinate { joint, coordinate } => {
                let joint = &model.joints[joint.0];
                format!("{} of joint `{}`", joint.kind.coordinates[*coordinate].name, joint.name)
            }
            MeasureKind::Distance { from, to } => format!("distance from {} to {}", point(*from), point(*to)),
            MeasureKind::Coordinates { point: p, along } => {
                format!("position of {} along {}", point(*p), direction_text(*along))
            }
            MeasureKind::Toe { body, spin_axis } => {
                format!("toe of `{}`, {}", model.bodies[body.0].name, axis(spin_axis))
            }
            MeasureKind::Camber { body, spin_axis } => {
                format!("camber of `{}`, {}", model.bodies[body.0].name, axis(spin_axis))
            }
        },
    };
    model.measures.iter().map(fact).collect()
}

fn joint_name(model: &Model, joint: JointId) -> String {
    model.joints[joint.0].name.clone()
}
