//! Facts of a model and its plan.

use super::change::{change_text, direction_text};
use super::names::{joint_name, name_in_file};
use super::notes;
use super::redundancy::{self, RedundancyFact};
use crate::figures::{count, per, rounded, symbol, unit, variable_unit};
use hardpoint::constraint::Row;
use hardpoint::joint::{self, Quantity};
use hardpoint::model::{
    BodyId, Coupler, Direction, Driver, GROUND, HardpointId, Joint, JointId, Model, OutputSource, VariableId,
    Wheel,
};
use hardpoint::sensitivity::{self, Condition, JointDefect, admissibility_at_design, conditions_at_design};
use hardpoint::topology::{Block, Closure, CutReason, Formulation, JointRole, RowId, Topology};
use hardpoint::{Analysis, Solution};
use hardpoint_file::{ModelFile, Units};
use serde::Serialize;
use std::collections::{HashMap, HashSet};

/// Facts of a mechanism, with the names of the model file and values in the user's units.
#[derive(Clone, Debug, Serialize)]
pub struct Facts {
    /// Name of the mechanism.
    pub name: String,
    /// Description in the model file.
    pub description: Option<String>,
    /// Name of the model file, as given.
    pub file: String,
    /// Units of all values; time is in s.
    pub units: Units,
    /// `relative` or `absolute` coordinates.
    pub formulation: &'static str,
    /// Numbers of entries of each kind.
    pub counts: Counts,
    /// Bodies without ground.
    pub bodies: Vec<BodyFact>,
    /// Joints, each with the reason why it is in the tree or cut.
    pub joints: Vec<JointFact>,
    /// Couplers between joint coordinates; those of screws are last.
    pub couplers: Vec<CouplerFact>,
    /// Drivers.
    pub drivers: Vec<DriverFact>,
    /// Blocks in the order of solution.
    pub blocks: Vec<BlockFact>,
    /// Constraints that the others imply.
    pub redundant: Vec<RedundantFact>,
    /// Redundant constraints, grouped by the joints, couplers and drivers involved.
    pub redundancy: Vec<RedundancyFact>,
    /// Design variables with their admissibility.
    pub variables: Vec<VariableFact>,
    /// Conditions of admissibility of each joint.
    pub conditions: Vec<ConditionFact>,
    /// Measures.
    pub measures: Vec<MeasureFact>,
    /// Notes that are neither warnings nor errors, each a sentence.
    pub notes: Vec<String>,
}

/// Numbers of entries of each kind.
#[derive(Clone, Debug, Serialize)]
pub struct Counts {
    /// Bodies without ground.
    pub bodies: usize,
    /// Joints.
    pub joints: usize,
    /// Couplers; each is one constraint.
    pub couplers: usize,
    /// Drivers.
    pub drivers: usize,
    /// Degrees of freedom without drivers, in the design configuration.
    pub mobility: usize,
    /// Constraint equations of all joints, without couplers.
    pub joint_constraints: usize,
    /// Constraint rows of the cut joints, of couplers and of drivers across cut joints, redundant ones included.
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

/// Body of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct BodyFact {
    /// Name.
    pub name: String,
    /// Tree joint that places the body; `null` if it moves freely or in absolute coordinates.
    pub placed_by: Option<String>,
    /// Body that carries it.
    pub carried_by: String,
    /// Joints on the body.
    pub joints: Vec<String>,
}

/// Joint of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct JointFact {
    /// Name.
    pub name: String,
    /// Type in the model file.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// True if it is treated as a universal joint, to fix an idle rotation.
    pub holds_spin: bool,
    /// Bodies i and j.
    pub bodies: [String; 2],
    /// `tree` or `cut`.
    pub role: &'static str,
    /// Reason for the role.
    pub why: String,
    /// Number of constraint equations.
    pub constraints: usize,
}

/// Coupler of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct CouplerFact {
    /// Name.
    pub name: String,
    /// Relation of the coordinates, counted from the design configuration, in the units of the terms.
    pub relation: String,
    /// Coordinates with their factors.
    pub terms: Vec<TermFact>,
    /// Value of the sum, in the units of the terms.
    pub constant: f64,
}

/// Coordinate with its factor.
#[derive(Clone, Debug, Serialize)]
pub struct TermFact {
    /// Joint of the coordinate.
    pub joint: String,
    /// Coordinate.
    pub coordinate: &'static str,
    /// Factor, for the coordinate in `unit`.
    pub coefficient: f64,
    /// Unit of the coordinate.
    pub unit: &'static str,
}

/// Driver of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct DriverFact {
    /// Name.
    pub name: String,
    /// Prescribed quantity.
    pub drives: String,
    /// Driven joint; `null` if it drives a point or an orientation.
    pub joint: Option<String>,
    /// Driven coordinate of the joint.
    pub coordinate: Option<&'static str>,
    /// Law in the model file, in `unit`, t in s.
    pub law: String,
    /// Unit of the law.
    pub unit: &'static str,
}

/// Block: unknowns that are solved together.
#[derive(Clone, Debug, Serialize)]
pub struct BlockFact {
    /// Index in the order of solution, from 1.
    pub number: usize,
    /// Number of unknown coordinates.
    pub unknowns: usize,
    /// Joints of these coordinates.
    pub joints: Vec<String>,
    /// Cut joints, couplers, and drivers across cut joints that the block closes.
    pub closes: Vec<String>,
    /// Bodies whose poses are known after the block is solved.
    pub places: Vec<String>,
    /// Number of redundant constraints of the block.
    pub redundant: usize,
}

/// Constraint that is implied by the others.
#[derive(Clone, Debug, Serialize)]
pub struct RedundantFact {
    /// Joint.
    pub joint: String,
    /// Driver, if it prescribes a coordinate.
    pub driver: Option<String>,
    /// Coupler, if the constraint is one.
    pub coupler: Option<String>,
    /// Constraint in words.
    pub constraint: String,
}

/// Admissibility of a design variable over the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum VariableAdmissibility {
    /// All joints stay closed with all bodies fixed.
    Admissible,
    /// Joints open, and the mechanism closes them by moving.
    Reassembled,
    /// No motion closes the joints: there is no sensitivity.
    CannotFollow,
    /// The motion was not solved.
    Unknown,
}

/// Design variable of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct VariableFact {
    /// Name.
    pub name: String,
    /// Unit; `1` for a plain number.
    pub unit: String,
    /// Change per unit of the variable.
    pub change: String,
    /// Joints that open in the design configuration with all bodies fixed; empty if the variable is admissible there.
    pub opens_at_design: Vec<DefectFact>,
    /// Admissibility over the whole solved motion.
    pub answer: VariableAdmissibility,
    /// If the mechanism cannot follow: the joints that stay open, with the largest defect over the motion.
    pub resists: Vec<DefectFact>,
    /// If the mechanism cannot follow: the time of the largest defect, s.
    pub time: Option<f64>,
}

/// Opening of a joint per unit of a variable.
#[derive(Clone, Debug, Serialize)]
pub struct DefectFact {
    /// The joint.
    pub joint: String,
    /// Constraint with the largest defect.
    pub constraint: String,
    /// The defect per unit of the variable.
    pub defect: f64,
    /// Unit of the defect.
    pub unit: String,
}

/// Measure of a mechanism.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureFact {
    /// Name.
    pub name: String,
    /// Measured quantity.
    pub what: String,
    /// Unit.
    pub unit: String,
}

impl Facts {
    /// Facts of an analysed mechanism; without a solution there are none over the motion.
    pub fn new(file: &ModelFile, analysis: &Analysis<'_>, solution: Option<&Solution>) -> Self {
        let (model, units, topology) = (&file.model, file.units, analysis.topology());
        let in_plane = made_by_plane(file, analysis);
        Self {
            name: model.name.clone(),
            description: file.description.clone(),
            file: file.file_name().into(),
            units,
            formulation: match topology.formulation {
                Formulation::Relative => "relative",
                Formulation::Absolute => "absolute",
            },
            counts: counts(model, topology, &in_plane),
            bodies: bodies(model, topology),
            joints: joints(model, topology),
            couplers: couplers(model, units),
            drivers: drivers(model, units),
            blocks: blocks(model, topology, &in_plane),
            redundant: redundant(analysis, &in_plane),
            redundancy: redundancy::redundancy(model, analysis, file.plane.is_some()),
            variables: variables(model, units, solution),
            conditions: conditions(model, units),
            measures: measures(model, units),
            notes: [
                notes::idle_spins(model),
                notes::jumps(model, units),
                notes::far_away(model, units).into_iter().collect(),
            ]
            .concat(),
        }
    }

    /// Number of variables with an admissibility.
    pub fn count_admissibility(&self, answer: VariableAdmissibility) -> usize {
        self.variables.iter().filter(|v| v.answer == answer).count()
    }
}

/// Redundant constraints of a planar model that only keep it in its plane: no other constraints imply them in planar
/// coordinates.
fn made_by_plane(file: &ModelFile, analysis: &Analysis<'_>) -> Vec<RowId> {
    let topology = analysis.topology();
    if file.plane.is_none() || topology.formulation == Formulation::Absolute {
        return Vec::new();
    }
    let all = topology.redundancies(analysis.solved_model()).into_iter();
    all.filter(|r| r.implied_by.is_empty()).map(|r| r.row).collect()
}

fn counts(model: &Model, topology: &Topology, in_plane: &[RowId]) -> Counts {
    let bodies = model.bodies.len() - 1;
    let joints = model.named_joints().count();
    Counts {
        bodies,
        joints,
        couplers: model.couplers.len(),
        drivers: model.drivers.len(),
        mobility: topology.mobility,
        joint_constraints: model.named_joints().map(|(_, j)| j.kind.rows.len()).sum(),
        cut_constraints: topology.rows.iter().filter(|r| !r.is_term).count() - in_plane.len(),
        redundant_constraints: topology.redundant().count() - in_plane.len(),
        // Every joint outside a spanning tree closes a loop.
        loops: joints.saturating_sub(bodies),
        coordinates: topology.coordinates.len(),
        unknowns: topology.unknowns(),
    }
}

fn bodies(model: &Model, topology: &Topology) -> Vec<BodyFact> {
    let mut link_of = vec![None; model.bodies.len()];
    for link in &topology.links {
        link_of[link.child.0] = Some(link);
    }
    let fact = |(b, joints): (usize, Vec<String>)| BodyFact {
        name: model.bodies[b].name.clone(),
        placed_by: link_of[b].and_then(|l| l.joint).and_then(|j| name_in_file(model, j)),
        carried_by: link_of[b].map_or(String::new(), |l| model.bodies[l.parent.0].name.clone()),
        joints,
    };
    joints_on(model).into_iter().enumerate().skip(1).map(fact).collect()
}

/// Names of the joints on every body, ground included.
pub(crate) fn joints_on(model: &Model) -> Vec<Vec<String>> {
    let mut joints_on = vec![Vec::new(); model.bodies.len()];
    for (_, joint) in model.named_joints() {
        for body in joint.bodies {
            joints_on[body.0].push(joint.name.clone());
        }
    }
    joints_on
}

fn joints(model: &Model, topology: &Topology) -> Vec<JointFact> {
    let spins = fixed_spins(model);
    let fact = |(id, joint): (JointId, &Joint)| {
        let (role, why) = match &topology.roles[id.0] {
            JointRole::Tree { child, unknowns } => {
                let child = &model.bodies[child.0].name;
                let leaves = match unknowns {
                    0 => "no unknown".into(),
                    n => count(*n, "unknown"),
                };
                ("tree", format!("places {child}, leaves {leaves}"))
            }
            JointRole::Cut(reason) => ("cut", why_cut(joint, *reason).into()),
        };
        JointFact {
            name: joint.name.clone(),
            kind: written_kind(joint, spins.contains(&id)),
            holds_spin: spins.contains(&id),
            bodies: joint.bodies.map(|b| model.bodies[b.0].name.clone()),
            role,
            why,
            constraints: joint.kind.rows.len(),
        }
    };
    model.named_joints().map(fact).collect()
}

/// Spherical joints that are treated as universal joints, to fix an idle rotation.
pub(crate) fn fixed_spins(model: &Model) -> HashSet<JointId> {
    model.idle.iter().map(|i| i.joint).collect()
}

/// Type of a joint in the model file: a spherical joint with a fixed idle rotation is still spherical.
pub(crate) fn written_kind(joint: &Joint, holds_spin: bool) -> &'static str {
    if holds_spin { joint::SPHERICAL.name } else { joint.kind.name }
}

fn why_cut(joint: &Joint, reason: CutReason) -> &'static str {
    match reason {
        CutReason::AlwaysCut if joint.kind.places == 2 => "a rod or leg carries no body",
        CutReason::AlwaysCut => "a joint of this type carries no body",
        CutReason::ClosesLoop => "other joints place its bodies with fewer unknowns",
        CutReason::Requested => "the model file requests it",
        CutReason::Absolute => "absolute coordinates cut every joint",
    }
}

pub(crate) fn couplers(model: &Model, units: Units) -> Vec<CouplerFact> {
    let fact = |coupler: &Coupler| {
        let inside = |t: &hardpoint::model::CouplerTerm| units.to_si(model.coupled(t).quantity, 1.0);
        // The equation may be scaled. Coefficients from the file are shown unchanged; coefficients from teeth and radii
        // are scaled so that the first coordinate keeps its factor.
        let first = coupler.transmission.map_or(1.0, |_| inside(&coupler.terms[0]));
        let term = |t: &hardpoint::model::CouplerTerm| TermFact {
            joint: joint_name(model, t.joint),
            coordinate: model.coupled(t).name,
            coefficient: t.coefficient * (inside(t) / first),
            unit: symbol(units, model.coupled(t).quantity),
        };
        let terms: Vec<TermFact> = coupler.terms.iter().map(term).collect();
        let constant = coupler.constant / first;
        CouplerFact { name: coupler.name.clone(), relation: relation(&terms, constant), terms, constant }
    };
    model.couplers.iter().map(fact).collect()
}

/// Formatted relation: `20 R1.angle + 40 R2.angle = 0`.
fn relation(terms: &[TermFact], constant: f64) -> String {
    let mut text = String::new();
    for (k, t) in terms.iter().enumerate() {
        let sign = match (k, t.coefficient < 0.0) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        };
        let factor = rounded(t.coefficient.abs(), 6);
        let factor = if factor == "1" { String::new() } else { format!("{factor} ") };
        text += &format!("{sign}{factor}{}.{}", t.joint, t.coordinate);
    }
    format!("{text} = {}", rounded(constant, 6))
}

/// Names of the points in the model file, the first at each location.
type Points<'m> = HashMap<(BodyId, HardpointId), &'m str>;

pub(crate) fn drivers(model: &Model, units: Units) -> Vec<DriverFact> {
    let mut points = Points::new();
    for point in model.points.iter().filter(|p| !p.unnamed) {
        points.entry((point.body, point.at)).or_insert(&point.name);
    }
    let fact = |d: &Driver| {
        let joint = &model.joints[d.joint.0];
        let of_joint = (!joint.unnamed).then(|| (joint.name.clone(), model.driven(d).name));
        let drives = match &of_joint {
            Some((joint, coordinate)) => format!("{joint} {coordinate}"),
            None => driven_text(model, joint, &points),
        };
        let (joint, coordinate) = of_joint.unzip();
        let unit = symbol(units, model.driven(d).quantity);
        DriverFact {
            name: d.name.clone(),
            drives,
            joint,
            coordinate,
            law: d.coordinate_law().to_string(),
            unit,
        }
    };
    model.drivers.iter().map(fact).collect()
}

/// Description of an unnamed joint.
fn driven_text(model: &Model, joint: &Joint, points: &Points<'_>) -> String {
    let body = |e: usize| model.bodies[joint.bodies[e].0].name.as_str();
    let place = |e: usize| {
        let hardpoint = &model.hardpoints[joint.at[e].0];
        match points.get(&(joint.bodies[e], joint.at[e])) {
            Some(point) => format!("point `{point}` on `{}`", body(e)),
            None if !hardpoint.unnamed => format!("`{}` on `{}`", hardpoint.name, body(e)),
            None => format!("point on `{}`", body(e)),
        }
    };
    let axis = joint.axis.map_or(String::new(), |axis| match axis {
        Direction::Along(u) => direction_text(u),
        Direction::Through(a, b) => {
            let [a, b] = [a, b].map(|h| model.hardpoints[h.0].name.as_str());
            format!("the line from `{a}` to `{b}`")
        }
    });
    let relative =
        if joint.bodies[0] == GROUND { String::new() } else { format!(" relative to `{}`", body(0)) };
    let is_its_wheel =
        |wheel: &&Wheel| wheel.body == joint.bodies[1] && model.points[wheel.centre.0].at == joint.at[1];
    if let Some(wheel) = model.wheels.iter().find(is_its_wheel).filter(|_| joint.kind.is_pad()) {
        return format!("contact point of wheel `{}` along {axis}{relative}", wheel.name);
    }
    match joint.kind.places {
        0 => format!("orientation of `{}` about {axis}{relative}", body(1)),
        1 => format!("{} along {axis}{relative}", place(1)),
        _ => format!("distance from {} to {}", place(0), place(1)),
    }
}

fn blocks(model: &Model, topology: &Topology, in_plane: &[RowId]) -> Vec<BlockFact> {
    let fact = |(k, block): (usize, &Block)| {
        let links = block.unknowns.iter().map(|&c| &topology[topology[c].link]);
        let mut joints: Vec<String> = links
            .map(|link| {
                let joint = link.joint.and_then(|j| name_in_file(model, j));
                joint.unwrap_or_else(|| model.bodies[link.child.0].name.clone())
            })
            .collect();
        joints.dedup();
        let is_further_term = |c: &Closure| topology[c.first_row].is_term;
        let closures = block.closures.iter().map(|&c| &topology[c]);
        let closes = closures.filter(|c| !c.rows.is_empty() && !is_further_term(c));
        // An opening of an elastic mechanism is no driver of its model.
        let driver = |c: &Closure| c.driver.and_then(|d| model.drivers.get(d.0)).map(|d| d.name.clone());
        let coupler = |c: &Closure| c.coupler.map(|k| model.couplers[k].name.clone());
        let joint = |c: &Closure| {
            let name = name_in_file(model, c.joint);
            name.unwrap_or_else(|| model.bodies[c.bodies[1].0].name.clone())
        };
        let closes = closes.map(|c| driver(c).or_else(|| coupler(c)).unwrap_or_else(|| joint(c)));
        let rows = block.closures.iter().flat_map(|&c| topology[c].row_ids());
        BlockFact {
            number: k + 1,
            unknowns: block.unknowns.len(),
            joints,
            closes: closes.collect(),
            places: block.link_ids().map(|k| model.bodies[topology[k].child.0].name.clone()).collect(),
            redundant: rows.filter(|r| topology[*r].is_redundant() && !in_plane.contains(r)).count(),
        }
    };
    topology.blocks.iter().enumerate().map(fact).collect()
}

fn redundant(analysis: &Analysis<'_>, in_plane: &[RowId]) -> Vec<RedundantFact> {
    let (model, topology) = (analysis.solved_model(), analysis.topology());
    let fact = |r: RowId| {
        let closure = topology.closure_of(r);
        RedundantFact {
            joint: joint_name(model, closure.joint),
            driver: closure.driver.map(|d| model.drivers[d.0].name.clone()),
            coupler: closure.coupler.map(|c| model.couplers[c].name.clone()),
            constraint: topology.constraint(r).describe(),
        }
    };
    topology.redundant().filter(|row| !in_plane.contains(row)).map(fact).collect()
}

fn variables(model: &Model, units: Units, solution: Option<&Solution>) -> Vec<VariableFact> {
    let fact = |(k, variable): (usize, &hardpoint::model::DesignVariable)| {
        let by = variable.quantity;
        let unit = variable_unit(model, units, variable);
        let defects =
            |joints: &[JointDefect]| joints.iter().map(|d| defect(model, units, (by, &unit), d)).collect();
        let opens = admissibility_at_design(model, &model.field(VariableId(k)));
        let over_motion = solution.and_then(|s| s.sensitivities.admissibility.get(k));
        let (answer, resists, time) = match over_motion {
            Some(sensitivity::Admissibility::Admissible) => {
                (VariableAdmissibility::Admissible, Vec::new(), None)
            }
            Some(sensitivity::Admissibility::Reassembled { .. }) => {
                (VariableAdmissibility::Reassembled, Vec::new(), None)
            }
            Some(sensitivity::Admissibility::CannotFollow { joints, time }) => {
                (VariableAdmissibility::CannotFollow, defects(joints), Some(*time))
            }
            Some(sensitivity::Admissibility::Unknown) | None => {
                (VariableAdmissibility::Unknown, Vec::new(), None)
            }
        };
        VariableFact {
            name: variable.name.clone(),
            change: change_text(model, &variable.changes, variable.fixed_length),
            opens_at_design: defects(&opens),
            answer,
            resists,
            time,
            unit,
        }
    };
    model.variables.iter().enumerate().map(fact).collect()
}

/// Condition of kinematic admissibility: an elementary constraint of a joint must stay closed with all bodies fixed.
#[derive(Clone, Debug, Serialize)]
pub struct ConditionFact {
    /// Joint of the condition.
    pub joint: String,
    /// Constraint in words.
    pub constraint: String,
    /// Design variables that violate it, with the defect per unit.
    pub opened_by: Vec<OpenFact>,
}

/// Defect of a constraint by a variable.
#[derive(Clone, Debug, Serialize)]
pub struct OpenFact {
    /// Name of the variable.
    pub variable: String,
    /// Defect per unit of the variable.
    pub defect: f64,
    /// Unit of the defect.
    pub unit: String,
}

fn conditions(model: &Model, units: Units) -> Vec<ConditionFact> {
    if model.variables.is_empty() {
        return Vec::new();
    }
    let mut facts: Vec<(JointId, Row, ConditionFact)> = Vec::new();
    let mut driven = vec![Vec::new(); model.joints.len()];
    for driver in &model.drivers {
        driven[driver.joint.0].push(model.driven(driver).row);
    }
    for (id, joint) in model.named_joints() {
        let driven = driven[id.0].iter().copied();
        for row in joint.kind.rows.iter().copied().chain(driven) {
            let (joint, constraint) = (joint_name(model, id), row.describe());
            facts.push((id, row, ConditionFact { joint, constraint, opened_by: Vec::new() }));
        }
    }
    for (variable, field) in model.variables.iter().zip(model.fields(&[])) {
        let unit = variable_unit(model, units, variable);
        // Defects that are round-off do not count.
        let opens = admissibility_at_design(model, &field);
        let most: HashMap<JointId, f64> = opens.iter().map(|o| (o.joint, o.value)).collect();
        let counts = |d: &Condition| most.get(&d.joint).is_some_and(|most| d.value.abs() > ROUND_OFF * most);
        for condition in conditions_at_design(model, &field).into_iter().filter(counts) {
            // In the order of the joints.
            let first = facts.partition_point(|f| f.0 < condition.joint);
            let of_joint = facts[first..].iter_mut().take_while(|f| f.0 == condition.joint);
            let found = of_joint.into_iter().find(|f| f.1 == condition.row);
            let Some((.., fact)) = found else { continue };
            let Condition { joint, row, value } = condition;
            let d = defect(model, units, (variable.quantity, &unit), &JointDefect { joint, row, value });
            let (defect, unit) = (d.defect, d.unit);
            fact.opened_by.push(OpenFact { variable: variable.name.clone(), defect, unit });
        }
    }
    facts.into_iter().map(|f| f.2).collect()
}

/// A defect below this fraction of the largest one of the same joint is round-off.
const ROUND_OFF: f64 = 1e-9;

fn defect(model: &Model, units: Units, (by, unit): (Quantity, &str), defect: &JointDefect) -> DefectFact {
    // The defect of a direction is a cosine that is 0 when closed. To first order it is an angle.
    let of = Quantity::from(defect.row);
    DefectFact {
        joint: joint_name(model, defect.joint),
        constraint: defect.row.describe(),
        defect: units.derivative_from_si(of, by, defect.value),
        unit: per(symbol(units, of), unit),
    }
}

pub(crate) fn measures(model: &Model, units: Units) -> Vec<MeasureFact> {
    let fact = |(k, m): (usize, &hardpoint::model::Measure)| MeasureFact {
        name: m.name.clone(),
        unit: unit(units, model.dimension(OutputSource::Measure(k))),
        what: model.describe(m, &direction_text),
    };
    model.measures.iter().enumerate().map(fact).collect()
}
