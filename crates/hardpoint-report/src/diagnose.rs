//! Why a mechanism cannot be driven, a run ended early, or a variable has no sensitivity: as diagnostics of
//! the model file, in the user's names and units.

use hardpoint::joint::Quantity;
use hardpoint::model::{JointId, Section};
use hardpoint::motion::{Stop, StopKind};
use hardpoint::topology::TopologyFault;
use hardpoint_file::{Diagnostic, ModelFile, Severity};

use crate::facts::{Answer, Facts};
use crate::figures::{names, number, rounded, symbol, with_unit};

/// The mechanism cannot be driven as it is written.
pub fn topology_fault(file: &ModelFile, fault: &TopologyFault) -> Diagnostic {
    let place = match fault {
        // Where drivers meet, one of them has to go.
        TopologyFault::OverDriven { drivers, .. } if drivers.len() > 1 => {
            Some((Section::Drivers, drivers[0].0))
        }
        _ => fault.joints().first().map(|j| (Section::Joints, j.0)),
    };
    let d = file.diagnostic(Severity::Error, fault.code(), fault.to_string(), place);
    fault.notes().into_iter().fold(d, Diagnostic::note).help(fault.help())
}

/// A run ended before its last output time; `outputs` names what was written of the solved part.
pub fn stop(file: &ModelFile, stop: &Stop, solved: usize, outputs: Option<&str>) -> Diagnostic {
    let (model, units) = (&file.model, file.units);
    let joint_name = |j: &JointId| model.joints[j.0].name.as_str();
    let place = match stop.kind {
        StopKind::Locked { joint, .. } => Some((Section::Joints, joint.0)),
        StopKind::LawNotFinite { driver } => Some((Section::Drivers, driver.0)),
        StopKind::Interrupted => None,
        _ => stop.joints.first().map(|j| (Section::Joints, j.0)),
    };
    let severity = if stop.kind == StopKind::Interrupted { Severity::Warning } else { Severity::Error };
    let mut d = file.diagnostic(severity, stop.code(), stop.headline(model), place);
    d = d.note(match stop.last_time {
        Some(t) => format!("the last solved time is t = {} s{}", rounded(t, 7), driver_values(file, stop)),
        None => "not even the first output time was solved".into(),
    });
    if let StopKind::Locked { joint, residual, is_length } = stop.kind {
        let of = if is_length { Quantity::Length } else { Quantity::Angle };
        let open = with_unit(units.from_si(of, residual), symbol(units, of));
        d = d.note(format!("`{}` stays open by {open}", joint_name(&joint)));
    }
    if !stop.joints.is_empty() {
        d = d.note(format!("the loop consists of {}", names(stop.joints.iter().map(joint_name))));
    }
    if matches!(stop.kind, StopKind::Limit | StopKind::BranchChange) {
        d = d.note(format!(
            "its smallest pivot there is {} of the largest; 0 means a limit position",
            rounded(stop.pivot_ratio, 2)
        ));
    }
    let asked = model.times.len();
    d = d.note(match outputs {
        _ if solved == 0 => "nothing was solved, so there is nothing to write".into(),
        Some(outputs) => format!("{outputs} hold the part that was solved: {solved} of {asked} steps"),
        None => format!("{solved} of {asked} steps were solved"),
    });
    match stop.help() {
        Some(help) => d.help(help),
        None => d,
    }
}

/// `, with \`rack\` at 12.3 mm and ...`.
fn driver_values(file: &ModelFile, stop: &Stop) -> String {
    let (model, units) = (&file.model, file.units);
    let values: Vec<String> = model
        .drivers
        .iter()
        .zip(&stop.drivers)
        .map(|(driver, value)| {
            let quantity = model.driven(driver).quantity;
            let value = with_unit(units.from_si(quantity, *value), symbol(units, quantity));
            format!("`{}` at {value}", driver.name)
        })
        .collect();
    if values.is_empty() { String::new() } else { format!(", with {}", values.join(", ")) }
}

/// One warning for each design variable that the mechanism cannot follow.
pub fn variables(file: &ModelFile, facts: &Facts) -> Vec<Diagnostic> {
    let warn = |(k, v): (usize, &crate::facts::VariableFact)| {
        let message = format!("the mechanism cannot follow design variable `{}`", v.name);
        let mut d = file.diagnostic(Severity::Warning, "HP0501", message, Some((Section::Design, k)));
        for defect in &v.resists {
            let open = with_unit(defect.defect, &defect.unit);
            d = d.note(format!("`{}` would open by {open} ({})", defect.joint, defect.constraint));
        }
        if let Some(t) = v.time {
            d = d.note(format!(
                "the defect is largest at t = {} s; there is no sensitivity by this variable",
                number(t)
            ));
        }
        d.help("give a joint of this loop more freedom, or change the design so that the loop stays closed")
    };
    facts.variables.iter().enumerate().filter(|(_, v)| v.answer == Answer::CannotFollow).map(warn).collect()
}
