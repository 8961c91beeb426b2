//! Joints, couplers and drivers that share a redundancy.

use std::collections::BTreeMap;

use hardpoint::Analysis;
use hardpoint::joint::JointType;
use hardpoint::model::{JointId, MeasureKind, Model};
use hardpoint::topology::{Formulation, JointRole, Redundancy, Topology};
use serde::Serialize;

use crate::figures::{count, quoted, some_in_words};

use super::names::joint_name;

/// Redundant constraints among the same joints, couplers and drivers.
#[derive(Clone, Debug, Serialize)]
pub struct RedundancyFact {
    /// Number of redundant constraints among them.
    pub count: usize,
    /// Joints involved.
    pub joints: Vec<String>,
    /// Couplers involved.
    pub couplers: Vec<String>,
    /// Drivers that prescribe what the joints and couplers already determine.
    pub drivers: Vec<String>,
    /// Joint whose replacement by another type, together with the replacements before it, would remove all of them.
    pub instead: Option<JointReplacement>,
}

/// Replacement of a joint by a type with more freedom.
#[derive(Clone, Debug, Serialize)]
pub struct JointReplacement {
    /// Name of the joint.
    pub joint: String,
    /// Present type.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Proposed type.
    pub instead: &'static str,
}

/// Part of a redundancy, joints first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Joint(usize),
    Coupler(usize),
    Driver(usize),
}

/// All redundant constraints, grouped by the parts involved, in the order of the file; for a planar model without those
/// of the plane itself.
pub(super) fn redundancy(model: &Model, analysis: &Analysis<'_>, planar: bool) -> Vec<RedundancyFact> {
    // With equilibrium, a body that only forces hold has a joint more.
    let (solved, topology) = (analysis.solved_model(), analysis.topology());
    /// Maximum number of bodies for the exact search with every joint cut: its cost is cubic in six unknowns per body.
    const MOST_BODIES: usize = 50;
    let left_out = topology.redundant().count();
    if left_out == 0 {
        return Vec::new();
    }
    let small = model.bodies.len() - 1 <= MOST_BODIES;
    let all_cut = small
        .then(|| Topology::of(solved, Formulation::Absolute).ok())
        .flatten()
        .filter(|t| t.redundant().count() == left_out);
    // In a tree with planar coordinates, a redundant constraint that no others imply is one of the plane itself.
    let in_plane = planar.then(|| Topology::of(solved, Formulation::Relative).ok()).flatten();
    let plan = in_plane.as_ref().or(all_cut.as_ref()).unwrap_or(topology);
    let mut groups: BTreeMap<Vec<Part>, usize> = BTreeMap::new();
    for redundancy in plan.redundancies(solved).into_iter().filter(|r| !planar || !r.implied_by.is_empty()) {
        *groups.entry(parts(model, plan, &redundancy)).or_default() += 1;
    }
    let mut relaxed = RelaxedModel { model: model.clone(), redundant: left_out, mobility: topology.mobility };
    let fact = |(parts, count): (Vec<Part>, usize)| {
        let of = |pick: fn(&Part) -> Option<usize>, name: &dyn Fn(usize) -> String| {
            parts.iter().filter_map(pick).map(name).collect::<Vec<_>>()
        };
        let joint = |p: &Part| if let Part::Joint(k) = p { Some(*k) } else { None };
        let coupler = |p: &Part| if let Part::Coupler(k) = p { Some(*k) } else { None };
        let driver = |p: &Part| if let Part::Driver(k) = p { Some(*k) } else { None };
        let joints: Vec<usize> = parts.iter().filter_map(joint).collect();
        RedundancyFact {
            count,
            joints: of(joint, &|k| model.joints[k].name.clone()),
            couplers: of(coupler, &|k| model.couplers[k].name.clone()),
            drivers: of(driver, &|k| model.drivers[k].name.clone()),
            instead: if small { relaxed.find_replacement(topology, &joints, count) } else { None },
        }
    };
    groups.into_iter().map(fact).collect()
}

/// Owners of the rows of a redundancy. A row over a tree represents all joints around its loop.
fn parts(model: &Model, plan: &Topology, redundancy: &Redundancy) -> Vec<Part> {
    let mut parts = Vec::new();
    for &row in std::iter::once(&redundancy.row).chain(&redundancy.implied_by) {
        for term in plan.parts_of_row(row) {
            let closure = plan.closure_of(term.row);
            parts.push(match (closure.driver, closure.coupler) {
                (Some(d), _) => Part::Driver(d.0),
                (None, Some(c)) => Part::Coupler(c),
                (None, None) => Part::Joint(closure.joint.0),
            });
            let around = closure.links.iter().filter_map(|around| plan[around.link].joint);
            parts.extend(around.map(|j| Part::Joint(j.0)));
        }
    }
    parts.retain(|part| match part {
        Part::Joint(j) => model.joints.get(*j).is_some_and(|joint| !joint.unnamed),
        Part::Driver(d) => *d < model.drivers.len(),
        Part::Coupler(_) => true,
    });
    parts.sort_unstable();
    parts.dedup();
    parts
}

/// Model with redundant constraints removed by joints with more freedom.
struct RelaxedModel {
    model: Model,
    redundant: usize,
    mobility: usize,
}

impl RelaxedModel {
    /// Joint whose replacement removes `redundant` redundant constraints and leaves the mechanism driven as before;
    /// tested together with the replacements found so far. Joints that close a loop come first.
    fn find_replacement(
        &mut self,
        topology: &Topology,
        joints: &[usize],
        redundant: usize,
    ) -> Option<JointReplacement> {
        let is_cut = |j: &usize| matches!(topology.roles[*j], JointRole::Cut(_));
        let (cut, tree): (Vec<usize>, Vec<usize>) = joints.iter().partition(|j| is_cut(j));
        cut.into_iter().chain(tree).find_map(|j| {
            if self.is_named_by_others(JointId(j)) {
                return None;
            }
            let kind = self.model.joints[j].kind;
            let is_enough = |t: &&JointType| t.rows.len() + redundant == kind.rows.len();
            let instead = kind.relaxations.iter().copied().find(is_enough)?;
            self.model.joints[j].kind = instead;
            let plan = Topology::of(&self.model, topology.formulation);
            let left = self.redundant - redundant;
            if plan.is_ok_and(|p| p.redundant().count() == left && p.mobility == self.mobility) {
                self.redundant = left;
                return Some(JointReplacement {
                    joint: joint_name(&self.model, JointId(j)),
                    kind: kind.name,
                    instead: instead.name,
                });
            }
            self.model.joints[j].kind = kind;
            None
        })
    }

    /// True if a driver, coupler or measure uses a coordinate of the joint, which another type may not have.
    fn is_named_by_others(&self, joint: JointId) -> bool {
        let model = &self.model;
        let measured = |k: &MeasureKind| matches!(k, MeasureKind::Coordinate { joint: j, .. } if *j == joint);
        model.drivers.iter().any(|d| d.joint == joint)
            || model.couplers.iter().flat_map(|c| &c.terms).any(|t| t.joint == joint)
            || model.measures.iter().any(|m| measured(&m.kind))
    }
}

impl RedundancyFact {
    /// Note in words: `3 redundant constraints among \`A\`, \`B\` and \`C\`: ...`.
    pub fn note(&self) -> String {
        let parts = (self.joints.iter().map(|j| format!("`{j}`")))
            .chain(quoted("coupler", &self.couplers))
            .chain(quoted("driver", &self.drivers));
        let parts: Vec<String> = parts.collect();
        let them = if self.count == 1 { "it from any one" } else { "them from any" };
        let example = self.instead.as_ref().map_or(String::new(), |i| {
            format!(", for example by `{}` in place of `{}` for `{}`", i.instead, i.kind, i.joint)
        });
        let n = count(self.count, "redundant constraint");
        format!("{n} among {}: remove {them} of these{example}", some_in_words(&parts))
    }
}
