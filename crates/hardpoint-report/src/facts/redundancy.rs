//! Which joints, couplers and drivers say the same.

use std::collections::BTreeMap;

use hardpoint::constraint::Row;
use hardpoint::model::{JointId, Model};
use hardpoint::topology::{Formulation, Redundancy, Topology};
use serde::Serialize;

use super::joint_name;
use crate::figures::{count, quoted, some_in_words};

/// Redundant constraints among the same joints, couplers and drivers.
#[derive(Clone, Debug, Serialize)]
pub struct RedundancyFact {
    /// How many constraints are redundant among them.
    pub count: usize,
    /// The joints.
    pub joints: Vec<String>,
    /// The couplers.
    pub couplers: Vec<String>,
    /// The drivers that prescribe what the others already do.
    pub drivers: Vec<String>,
    /// A joint with exactly the freedoms that are missing: its name, its type, and a type to take instead.
    pub instead: Option<Instead>,
}

/// A joint that could be of a type with more freedom.
#[derive(Clone, Debug, Serialize)]
pub struct Instead {
    /// The joint.
    pub joint: String,
    /// The type that it has.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The type that it could have.
    pub instead: &'static str,
}

/// Whatever may be part of a redundancy, joints first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    Joint(usize),
    Coupler(usize),
    Driver(usize),
}

/// All redundant constraints, those among the same parts together, in the order of the file.
pub(super) fn redundancy(model: &Model, topology: &Topology) -> Vec<RedundancyFact> {
    /// Where every joint is cut the sets are exact, but the search is cubic in six unknowns per body.
    const MOST_BODIES: usize = 50;
    let left_out = topology.redundant().count();
    if left_out == 0 {
        return Vec::new();
    }
    let all_cut = (model.bodies.len() - 1 <= MOST_BODIES)
        .then(|| Topology::of(model, Formulation::Absolute).ok())
        .flatten()
        .filter(|t| t.redundant().count() == left_out);
    let plan = all_cut.as_ref().unwrap_or(topology);
    let mut groups: BTreeMap<Vec<Part>, usize> = BTreeMap::new();
    for redundancy in plan.redundancies(model) {
        *groups.entry(parts(model, plan, &redundancy)).or_default() += 1;
    }
    let fact = |(parts, count): (Vec<Part>, usize)| {
        let of = |pick: fn(&Part) -> Option<usize>, name: &dyn Fn(usize) -> String| {
            parts.iter().filter_map(pick).map(name).collect::<Vec<_>>()
        };
        let joint = |p: &Part| if let Part::Joint(k) = p { Some(*k) } else { None };
        let coupler = |p: &Part| if let Part::Coupler(k) = p { Some(*k) } else { None };
        let driver = |p: &Part| if let Part::Driver(k) = p { Some(*k) } else { None };
        RedundancyFact {
            count,
            joints: of(joint, &|k| model.joints[k].name.clone()),
            couplers: of(coupler, &|k| model.couplers[k].name.clone()),
            drivers: of(driver, &|k| model.drivers[k].name.clone()),
            instead: instead(model, topology, &parts, count),
        }
    };
    groups.into_iter().map(fact).collect()
}

/// What the rows of a redundancy belong to. A row over a tree speaks for all joints around its loop.
fn parts(model: &Model, plan: &Topology, redundancy: &Redundancy) -> Vec<Part> {
    let mut parts = Vec::new();
    for &row in std::iter::once(&redundancy.row).chain(&redundancy.implied_by) {
        for (r, _) in plan.parts_of_row(row) {
            let closure = &plan.closures[plan.rows[r].closure];
            parts.push(match (closure.driver, closure.coupler) {
                (Some(d), _) => Part::Driver(d.0),
                (None, Some(c)) => Part::Coupler(c),
                (None, None) => Part::Joint(closure.joint.0),
            });
            let around = closure.links.iter().filter_map(|(link, _)| plan.links[*link].joint);
            parts.extend(around.map(|j| Part::Joint(j.0)));
        }
    }
    parts.retain(|p| !matches!(p, Part::Joint(j) if model.joints[*j].unnamed));
    parts.sort_unstable();
    parts.dedup();
    parts
}

/// The joint whose left-out rows are all the redundancy, if there is a type without them.
fn instead(model: &Model, topology: &Topology, parts: &[Part], redundant: usize) -> Option<Instead> {
    parts.iter().find_map(|part| {
        let Part::Joint(j) = *part else { return None };
        let rows: Vec<Row> = topology
            .redundant()
            .filter(|(c, _)| c.joint == JointId(j) && c.driver.is_none() && c.coupler.is_none())
            .map(|(_, row)| row)
            .collect();
        if rows.len() != redundant {
            return None;
        }
        let lengths = rows.iter().filter(|r| r.is_length()).count();
        let kind = model.joints[j].kind.name;
        let instead = match (kind, lengths, rows.len() - lengths) {
            ("revolute", 0, 2) | ("universal" | "constant_velocity", 0, 1) | ("fixed", 0, 3) => "spherical",
            ("revolute", 1, 0) | ("translational", 0, 1) => "cylindrical",
            ("revolute", 1, 2) | ("translational", 0, 3) | ("cylindrical", 0, 2) => "inline",
            ("planar", 0, 2) => "inplane",
            _ => return None,
        };
        Some(Instead { joint: joint_name(model, JointId(j)), kind, instead })
    })
}

impl RedundancyFact {
    /// `3 redundant constraints among \`A\`, \`B\` and \`C\`: ...`.
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
