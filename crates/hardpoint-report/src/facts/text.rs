//! Facts in words: lines, sentences, and tables for the terminal and the page.

use hardpoint::model::JointId;
use hardpoint_file::ModelFile;

use crate::figures::{count, number, rounded, some_of, with_unit};
use crate::page::Table;

use super::{
    CouplerFact, DefectFact, DriverFact, Facts, VariableAdmissibility, VariableFact, couplers, drivers,
    fixed_spins, joints_on, written_kind,
};

/// Maximum number of conditions that are all listed; above it only violated ones are.
const MOST_CONDITIONS: usize = 400;

impl Facts {
    /// Line on the variables: `12 (1 admissible, 11 re-assembled)`, `12, all admissible`.
    pub fn variables_line(&self) -> String {
        let wordings = [
            (VariableAdmissibility::Admissible, "admissible", "all admissible"),
            (VariableAdmissibility::Reassembled, "re-assembled", "all re-assembled"),
            (VariableAdmissibility::CannotFollow, "cannot be followed", "none can be followed"),
            (VariableAdmissibility::Unknown, "not examined", "not examined"),
        ];
        let n = self.variables.len();
        if let Some((_, one, all)) =
            wordings.iter().find(|(a, ..)| n > 0 && self.count_admissibility(*a) == n)
        {
            return format!("{n}, {}", if n == 1 { one } else { all });
        }
        let found = wordings.iter().filter(|(a, ..)| self.count_admissibility(*a) > 0);
        let parts: Vec<String> =
            found.map(|(a, words, _)| format!("{} {words}", self.count_admissibility(*a))).collect();
        if parts.is_empty() { "none".into() } else { format!("{n} ({})", parts.join(", ")) }
    }

    /// Line on the degrees of freedom: `2, prescribed by 2 drivers`.
    pub fn freedom_line(&self) -> String {
        match self.counts.mobility {
            0 => "0 (nothing can move)".into(),
            n => format!("{n}, prescribed by {}", count(self.counts.drivers, "driver")),
        }
    }

    /// Line on the loops: `2, solved in 1 block of 5 unknowns`.
    pub fn loops_line(&self) -> String {
        let solved = match self.blocks.len() {
            0 => "no unknowns".into(),
            1 => format!("solved in 1 block of {}", count(self.counts.unknowns, "unknown")),
            n => {
                let size = |b: usize| self.blocks[b].unknowns;
                if (1..n).all(|b| size(b) == size(0)) {
                    format!("solved in {n} blocks of {} each", count(size(0), "unknown"))
                } else {
                    let sizes: Vec<String> = (0..n).map(|b| size(b).to_string()).collect();
                    format!("solved in {n} blocks of {} unknowns", some_of(&sizes, " + "))
                }
            }
        };
        format!("{}, {solved}", self.counts.loops)
    }

    /// Numbers of joints and couplers: `4 joints, 1 coupler`.
    pub fn joints_text(&self) -> String {
        let joints = count(self.counts.joints, "joint");
        match self.counts.couplers {
            0 => joints,
            n => format!("{joints}, {}", count(n, "coupler")),
        }
    }

    /// Line on the constraints: `20 in joints, 1 in a coupler; 5 written out at cuts, 3 of them redundant`.
    pub fn constraints_line(&self) -> String {
        let c = &self.counts;
        let redundant = match c.redundant_constraints {
            0 => String::new(),
            n => format!(", {n} of them redundant"),
        };
        let couplers = match c.couplers {
            0 => String::new(),
            1 => ", 1 in a coupler".into(),
            n => format!(", {n} in couplers"),
        };
        let (joints, cut) = (c.joint_constraints, c.cut_constraints);
        format!("{joints} in joints{couplers}; {cut} written out at cuts{redundant}")
    }

    /// All notes, each a sentence without a full stop.
    pub fn all_notes(&self) -> Vec<String> {
        const SHOWN: usize = 6;
        let groups = self.redundancy.iter().take(SHOWN).map(super::RedundancyFact::note);
        let left: usize = self.redundancy.iter().skip(SHOWN).map(|r| r.count).sum();
        let more =
            (left > 0).then(|| format!("{} among other joints", count(left, "more redundant constraint")));
        groups.chain(more).chain(self.notes.iter().cloned()).collect()
    }

    /// All facts as tables, for the terminal and the page.
    pub fn tables(&self) -> Vec<Table> {
        let mut tables = vec![self.body_table(), self.joint_table()];
        tables.extend(coupler_table(&self.couplers));
        tables.extend(driver_table(&self.drivers));
        tables.push(self.block_table());
        tables.extend(self.redundant_table());
        tables.extend(self.variable_table());
        tables.extend(self.condition_table());
        tables.extend(self.measure_table());
        tables
    }

    fn body_table(&self) -> Table {
        let rows = self.bodies.iter().map(|b| {
            let by = b.placed_by.clone().unwrap_or_else(|| "its six coordinates".into());
            vec![b.name.clone(), by, b.carried_by.clone(), b.joints.join(", ")]
        });
        table("Bodies", "", ["body", "placed by", "from", "joints on it"], rows)
    }

    fn joint_table(&self) -> Table {
        let rows = self.joints.iter().map(|j| {
            let bodies = format!("{} – {}", j.bodies[0], j.bodies[1]);
            let kind = if j.holds_spin { format!("{}, holds a spin", j.kind) } else { j.kind.into() };
            vec![j.name.clone(), kind, bodies, j.role.into(), j.why.clone(), j.constraints.to_string()]
        });
        table(
            "Joints",
            "A joint of the tree places a body; a cut joint closes a loop by its constraints.",
            ["joint", "type", "bodies", "role", "why", "constraints"],
            rows,
        )
    }

    fn block_table(&self) -> Table {
        let rows = self.blocks.iter().map(|b| {
            vec![
                b.number.to_string(),
                b.unknowns.to_string(),
                b.joints.join(", "),
                b.closes.join(", "),
                b.places.join(", "),
                if b.redundant == 0 { String::new() } else { b.redundant.to_string() },
            ]
        });
        table(
            "Blocks",
            "Independent loops in the order of solution; bodies placed by drivers alone come first.",
            ["block", "unknowns", "in joints", "closes", "places", "redundant"],
            rows,
        )
    }

    fn redundant_table(&self) -> Option<Table> {
        let rows: Vec<Vec<String>> = self
            .redundant
            .iter()
            .map(|r| {
                let whose = match (&r.driver, &r.coupler) {
                    (Some(driver), _) if *driver == r.joint => format!("driver {driver}"),
                    (Some(driver), _) => format!("{} (driver {driver})", r.joint),
                    (None, Some(coupler)) => format!("coupler {coupler}"),
                    (None, None) => r.joint.clone(),
                };
                vec![whose, r.constraint.clone()]
            })
            .collect();
        (!rows.is_empty()).then(|| {
            table(
                "Redundant constraints",
                "The others imply them; they are left out of the solution and monitored at every step.",
                ["joint", "constraint"],
                rows,
            )
        })
    }

    fn variable_table(&self) -> Option<Table> {
        let rows: Vec<Vec<String>> = self
            .variables
            .iter()
            .map(|v| {
                let at_design = if v.opens_at_design.is_empty() { "closed" } else { "opens" };
                let unit = if v.unit == "1" { String::new() } else { v.unit.clone() };
                vec![
                    v.name.clone(),
                    unit,
                    v.change.clone(),
                    at_design.into(),
                    v.admissibility_text().into(),
                    v.defects_text(),
                ]
            })
            .collect();
        (!rows.is_empty()).then(|| {
            table(
                "Design variables",
                "Admissible: every joint stays closed with all bodies fixed. Re-assembled: joints open and \
                 the mechanism closes them by moving. Cannot follow: no motion closes them, so there is no number. \
                 A defect is per unit of the variable.",
                ["variable", "unit", "change", "at design", "over the motion", "joints and their defect"],
                rows,
            )
        })
    }

    fn condition_table(&self) -> Option<Table> {
        let mut rows: Vec<Vec<String>> = Vec::new();
        let mut before = "";
        let all = self.conditions.len() <= MOST_CONDITIONS;
        for c in self.conditions.iter().filter(|c| all || !c.opened_by.is_empty()) {
            let opened =
                c.opened_by.iter().map(|o| format!("{} {} {}", o.variable, rounded(o.defect, 3), o.unit));
            let opened: Vec<String> = opened.collect();
            let joint = if c.joint == before { String::new() } else { c.joint.clone() };
            before = &c.joint;
            let defect = if opened.is_empty() { "0".into() } else { some_of(&opened, "; ") };
            rows.push(vec![joint, c.constraint.clone(), defect]);
        }
        (!rows.is_empty()).then(|| {
            table(
                "Conditions of admissibility",
                "Conditions on a design change under which each joint stays closed with all bodies fixed; d is the line between its two points. Each defect is per unit of the named variable.",
                ["joint", "condition", "defect"],
                rows,
            )
        })
    }

    fn measure_table(&self) -> Option<Table> {
        let rows: Vec<Vec<String>> =
            self.measures.iter().map(|m| vec![m.name.clone(), m.unit.clone(), m.what.clone()]).collect();
        (!rows.is_empty()).then(|| table("Measures", "", ["measure", "unit", "what"], rows))
    }
}

/// Tables of a mechanism that cannot be analysed: bodies, joints, couplers and drivers.
pub fn outline(file: &ModelFile) -> Vec<Table> {
    let (model, units) = (&file.model, file.units);
    let body = |(b, joints): (usize, Vec<String>)| vec![model.bodies[b].name.clone(), joints.join(", ")];
    let spins = fixed_spins(model);
    let joint = |(id, j): (JointId, &hardpoint::model::Joint)| {
        let [i, k] = j.bodies.map(|b| model.bodies[b.0].name.as_str());
        let kind = written_kind(j, spins.contains(&id)).to_owned();
        vec![j.name.clone(), kind, format!("{i} – {k}"), j.kind.rows.len().to_string()]
    };
    let bodies = table(
        "Bodies",
        "",
        ["body", "joints on it"],
        joints_on(model).into_iter().enumerate().skip(1).map(body),
    );
    let header = ["joint", "type", "bodies", "constraints"];
    let mut tables = vec![bodies, table("Joints", "", header, model.named_joints().map(joint))];
    tables.extend(coupler_table(&couplers(model, units)));
    tables.extend(driver_table(&drivers(model, units)));
    tables
}

fn coupler_table(couplers: &[CouplerFact]) -> Option<Table> {
    let row = |c: &CouplerFact| {
        let mut units: Vec<&str> = c.terms.iter().map(|t| t.unit).collect();
        units.sort_unstable();
        units.dedup();
        vec![c.name.clone(), c.relation.clone(), units.join(", ")]
    };
    (!couplers.is_empty()).then(|| {
        table(
            "Couplers",
            "Each is one constraint. Coordinates count from the design configuration, angles through whole turns.",
            ["coupler", "relation", "unit"],
            couplers.iter().map(row),
        )
    })
}

fn driver_table(drivers: &[DriverFact]) -> Option<Table> {
    let row = |d: &DriverFact| vec![d.name.clone(), d.drives.clone(), d.law.clone(), d.unit.into()];
    let header = ["driver", "drives", "law", "unit"];
    (!drivers.is_empty()).then(|| table("Drivers", "", header, drivers.iter().map(row)))
}

impl VariableFact {
    /// Admissibility in words.
    pub fn admissibility_text(&self) -> &'static str {
        match self.answer {
            VariableAdmissibility::Admissible => "admissible",
            VariableAdmissibility::Reassembled => "re-assembled",
            VariableAdmissibility::CannotFollow => "cannot follow",
            VariableAdmissibility::Unknown => "not examined",
        }
    }

    /// Joints concerned, with their defects; empty if every joint stays closed.
    pub fn defects_text(&self) -> String {
        let (list, time) = match self.answer {
            VariableAdmissibility::CannotFollow => (&self.resists, self.time),
            _ => (&self.opens_at_design, None),
        };
        let mut text = list.iter().map(DefectFact::text).collect::<Vec<_>>().join(", ");
        if let Some(t) = time {
            text += &format!(", at t = {} s", number(t));
        }
        text
    }

    /// Sentence on the effect of the variable on the joints; empty for an admissible variable.
    pub fn note(&self) -> String {
        let defects = |list: &[DefectFact]| {
            let parts: Vec<String> =
                list.iter().map(|d| format!("`{}` by {}", d.joint, with_unit(d.defect, &d.unit))).collect();
            parts.join(", ")
        };
        match self.answer {
            VariableAdmissibility::Admissible | VariableAdmissibility::Unknown => String::new(),
            VariableAdmissibility::Reassembled => {
                format!("The mechanism re-assembles: the variable opens {}.", defects(&self.opens_at_design))
            }
            VariableAdmissibility::CannotFollow => {
                let time = self.time.map_or(String::new(), |t| format!(" (at t = {} s)", number(t)));
                format!("Not possible: no motion closes {}{time}.", defects(&self.resists))
            }
        }
    }
}

impl DefectFact {
    fn text(&self) -> String {
        format!("{} {}", self.joint, with_unit(self.defect, &self.unit))
    }
}

pub(crate) fn table<const N: usize>(
    title: &str,
    note: &str,
    header: [&str; N],
    rows: impl IntoIterator<Item = Vec<String>>,
) -> Table {
    Table {
        title: title.into(),
        note: note.into(),
        header: header.map(String::from).to_vec(),
        rows: rows.into_iter().collect(),
    }
}
