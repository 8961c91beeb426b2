//! Diagnostics of a run: why a mechanism cannot be driven, a run ended early, or a variable has no sensitivity. Names
//! and units are those of the model file.

use std::cell::OnceCell;

use hardpoint::Analysis;
use hardpoint::joint::Quantity;
use hardpoint::load::Loads;
use hardpoint::model::element::ActsOn;
use hardpoint::motion::{Closing, Motion, Stop, StopKind};
use hardpoint::topology::TopologyError;
use hardpoint::{
    draft::Section,
    model::{
        CaseId, ChangePointPolicy, DesignVariable, ENDS_MEET, ElementKind, JointId, MeasureKind, Model,
        OutputSource, Target,
    },
};
use hardpoint_file::{Diagnostic, Diagnostics, ModelFile, Severity};
use hardpoint_study::envelope::EnvelopeStop;

use crate::assembly::GapFact;
use crate::clearance::drivers;
use crate::course::Course;
use crate::deflection::ends_of_curves;
use crate::facts::{Facts, VariableAdmissibility};
use crate::figures::{names, number, quoted, rounded, some_in_words, symbol, unit, variable_unit, with_unit};
use crate::joint_limits::JointLimitFact;
use crate::margin::{MarginFact, named};
use crate::summary::{Summary, driver_values};

/// Maximum number of remaining gaps that are reported one by one.
const MOST_GAPS: usize = 5;

/// All diagnostics of a run, warnings first; `outputs` names the files written of a motion that stopped.
pub fn all(file: &ModelFile, summary: &Summary, course: &Course, outputs: Option<&str>) -> Vec<Diagnostic> {
    let ended = &course.kept.stop;
    let mut list = file.remarks.clone();
    list.extend(rigid(file, &summary.model));
    list.extend(variables(file, &summary.model));
    list.extend(ambiguous_assembly(file, course));
    // Before a limit position the margin falls to zero, which the stop reports already.
    if ended.as_ref().is_none_or(|s| s.kind == StopKind::Interrupted) {
        list.extend(summary.margin.as_ref().and_then(|m| margin(file, m)));
    }
    list.extend(JointLimitFact::warnings(&summary.joint_limits, file));
    list.extend(ends_of_curves(file));
    list.extend(residual(file, &summary.model, summary.effort.worst_residual_si));
    list.extend(loads(file, course));
    list.extend(ended.as_ref().map(|s| stop(file, s, course.steps, outputs)));
    list
}

/// Diagnostics of a model text that was read: its errors, or its remarks with the error of a mechanism that cannot be
/// driven. A file with cases is checked in its first case.
pub fn of_text(read: Result<ModelFile, Diagnostics>) -> (Option<ModelFile>, Vec<Diagnostic>) {
    let file = match read {
        Ok(file) => file,
        Err(errors) => return (None, errors.list().to_vec()),
    };
    let first = (!file.model.cases.is_empty()).then(|| file.in_case(CaseId(0)));
    let shown = first.as_ref().unwrap_or(&file);
    let mut list = shown.remarks.clone();
    list.extend(Analysis::new(&shown.model).err().map(|fault| topology_fault(shown, &fault)));
    (Some(file), list)
}

/// Diagnostic of a mechanism that cannot be driven as defined.
pub fn topology_fault(file: &ModelFile, fault: &TopologyError) -> Diagnostic {
    let place = match fault {
        // If drivers conflict, remove one of them.
        TopologyError::OverDriven { drivers, .. } if drivers.len() > 1 => {
            Some((Section::Drivers, drivers[0].0))
        }
        _ => fault.joints().first().map(|j| (Section::Joints, j.0)),
    };
    let d = file.diagnostic(Severity::Error, fault.code(), fault.to_string(), place);
    fault.notes().into_iter().fold(d, Diagnostic::note).help(fault.help())
}

/// Diagnostic of a run that ended before its last output time; `outputs` names the files of the solved part.
pub fn stop(file: &ModelFile, stop: &Stop, solved: usize, outputs: Option<&str>) -> Diagnostic {
    let asked = file.model.times.len();
    let left = match outputs {
        _ if solved == 0 => "no output time was solved, so no files were written".into(),
        Some(outputs) => format!("{outputs} hold the part that was solved: {solved} of {asked} steps"),
        None => format!("{solved} of {asked} steps were solved"),
    };
    ended(file, stop, "", partial(stop, left))
}

/// Diagnostic of a nominal design whose motion ended before its last output time, of a study that requires all of it.
pub fn stop_of_nominal(file: &ModelFile, stop: &Stop) -> Diagnostic {
    let (times, at) = (&file.model.times, rounded(stop.failed_time, 7));
    let last = times.last().map_or(String::new(), |t| format!(", t = {} s", number(*t)));
    let left = format!(
        "the study was not made: the motion of the nominal design ends at t = {at} s, before its last output time{last}"
    );
    let mut d = ended(file, stop, "", vec![left]);
    d.severity = Severity::Error;
    let begins = stop.last_time.zip(times.first()).is_some_and(|(last, first)| last > *first);
    if begins && let Some(help) = &mut d.help {
        *help += &format!("; or end `[time]` before t = {at} s");
    }
    d
}

/// Diagnostic of a motion of an envelope that ended before its last position.
pub fn stop_of_envelope(file: &ModelFile, EnvelopeStop { stop, end }: &EnvelopeStop) -> Diagnostic {
    let left = match end {
        Some(end) => format!("the envelope has the motion up to t = {} s", rounded(*end, 7)),
        None => "the envelope has the positions that were reached".into(),
    };
    ended(file, stop, "", vec![left])
}

/// Diagnostic of a changed design whose motion ended before its last output time.
pub fn stop_of_changed(file: &ModelFile, stop: &Stop, solved: usize) -> Diagnostic {
    let asked = file.model.times.len();
    let left = format!("{solved} of {asked} steps of the changed design were solved");
    ended(file, stop, "the changed design: ", partial(stop, left))
}

/// Notes on the results up to a stop.
fn partial(stop: &Stop, left: String) -> Vec<String> {
    let at_limit = matches!(stop.kind, StopKind::JointLimit { begins_beyond: false, .. });
    let cover =
        "curves and metrics cover the output times up to there; limits and clearances all of the motion";
    at_limit.then(|| cover.to_owned()).into_iter().chain([left]).collect()
}

fn ended(file: &ModelFile, stop: &Stop, who: &str, left: Vec<String>) -> Diagnostic {
    let (model, units) = (&file.model, file.units);
    let joint_name = |j: &JointId| model.joints[j.0].name.as_str();
    let place = match stop.kind {
        StopKind::Locked { joint, .. } | StopKind::CurveEnd { joint } => Some((Section::Joints, joint.0)),
        StopKind::LawNotFinite { driver } => Some((Section::Drivers, driver.0)),
        StopKind::LoadNotFinite { force } => {
            // The elements are the masses, then the forces.
            let masses = model.elements.iter().filter(|e| e.kind.has_mass()).count();
            Some((Section::Forces, force.0 - masses))
        }
        StopKind::FormulaNotFinite { formula } => match model.formulas[formula].of {
            Target::Parameter(p) => Some((Section::Parameters, p.0)),
            Target::Coordinate(h, _) if model.hardpoints[h.0].unnamed => {
                let point = model.points.iter().position(|p| !p.unnamed && p.at == h);
                point.map(|k| (Section::Points, k))
            }
            Target::Coordinate(h, _) => Some((Section::Hardpoints, h.0)),
            Target::Length(j) => Some((Section::Joints, j.0)),
            Target::Law(d, _) => Some((Section::Drivers, d.0)),
            Target::Number(_) => None,
        },
        StopKind::Interrupted => None,
        StopKind::JointLimit { limit, .. } => Some((Section::JointLimits, limit)),
        StopKind::DoesNotAssemble => stop.remains.first().map(|gap| match gap.of {
            Closing::Joint(j) => (Section::Joints, j.0),
            Closing::Driver(d) => (Section::Drivers, d.0),
            Closing::Coupler(c) => (Section::Couplers, c),
        }),
        StopKind::Limit
        | StopKind::BranchChange
        | StopKind::TooFar { .. }
        | StopKind::NothingHolds { .. }
        | StopKind::LimitLoad { .. }
        | StopKind::NoEquilibrium
        | StopKind::Unstable { .. }
        | StopKind::TooStiff { .. } => stop.joints.first().map(|j| (Section::Joints, j.0)),
    };
    // An end stop ends a motion as the user wants.
    let is_requested =
        matches!(stop.kind, StopKind::Interrupted | StopKind::JointLimit { begins_beyond: false, .. });
    let severity = if is_requested { Severity::Warning } else { Severity::Error };
    let mut headline = who.to_owned() + &stop.headline(model);
    if let (StopKind::DoesNotAssemble, Some(gap)) = (stop.kind, stop.remains.first()) {
        headline += &format!(" by {} at best", GapFact::new(model, units, gap).size_text());
    }
    let mut d = file.diagnostic(severity, stop.code(), headline, place);
    if let StopKind::JointLimit { limit, end, .. } = stop.kind {
        let limit = &model.joint_limits[limit];
        let of = model.dimension(OutputSource::Measure(limit.measure));
        let bound = with_unit(units.from_si(of, limit.end(end).unwrap_or(f64::NAN)), &unit(units, of));
        let there = drivers(model, units, stop.failed_time);
        let there = if there.is_empty() { String::new() } else { format!(", with {there}") };
        d = d.note(format!(
            "its {} is {bound}; it is reached at t = {} s{there}",
            end.noun(),
            rounded(stop.failed_time, 7)
        ));
    }
    if let Some(closed) = stop.closed {
        d = gap_notes(file, stop, closed).into_iter().fold(d, Diagnostic::note);
    } else {
        let values = driver_values(file, stop);
        d = d.note(match stop.last_time {
            Some(t) => format!("the last solved time is t = {} s{values}", rounded(t, 7)),
            None if values.is_empty() => "not even the first output time was solved".into(),
            None => format!(
                "not even the first output time was solved: the path there from the design configuration ends{}",
                values.trim_start_matches(',')
            ),
        });
    }
    if let StopKind::Locked { joint, residual, quantity: of } = stop.kind {
        let open = with_unit(units.from_si(of, residual), symbol(units, of));
        d = d.note(format!("`{}` stays open by {open}", joint_name(&joint)));
    }
    if !stop.joints.is_empty() {
        d = d.note(format!("the loop consists of {}", parts(model, &stop.joints)));
    }
    // A loop with one unknown has one pivot.
    if matches!(stop.kind, StopKind::Limit | StopKind::BranchChange) && stop.pivot_ratio < 1.0 {
        d = d.note(format!(
            "its smallest pivot there is {} of the largest; 0 means a limit position",
            rounded(stop.pivot_ratio, 2)
        ));
    }
    d = left.into_iter().fold(d, Diagnostic::note);
    match stop.help() {
        Some(help) => d.help(help),
        None => d.help("run it again for the rest"),
    }
}

/// Notes on the gaps that remain if a mechanism does not assemble.
fn gap_notes(file: &ModelFile, stop: &Stop, closed: f64) -> Vec<String> {
    let gaps: Vec<GapFact> = stop.remains.iter().map(|g| GapFact::new(&file.model, file.units, g)).collect();
    let at_best = |g: &GapFact| format!("{} `{}` stays open by {} at best", g.kind, g.name, g.size_text());
    // The headline already contains the largest gap.
    let in_headline = usize::from(stop.kind == StopKind::DoesNotAssemble);
    let mut notes: Vec<String> = gaps.iter().take(MOST_GAPS).skip(in_headline).map(at_best).collect();
    if gaps.len() > MOST_GAPS {
        notes.push(format!("{} more stay open by less", gaps.len() - MOST_GAPS));
    }
    notes.push(if stop.is_singular_drawing() {
        "in the design configuration the mechanism is open, in or next to a singular position, and no assembly was found around it, with every driver at zero"
            .into()
    } else {
        format!(
            "in the design configuration the mechanism is open; {} % of the gaps could be closed together, with every driver at zero",
            rounded(100.0 * closed, 2)
        )
    });
    notes
}

/// Joints of a loop, and drivers in it that act on a point or orientation instead of a joint.
fn parts(model: &Model, joints: &[JointId]) -> String {
    let unnamed = joints.iter().map(|j| &model.joints[j.0]).filter(|j| j.unnamed);
    let drivers: Vec<String> = unnamed.map(|j| j.name.clone()).collect();
    let joints = named(model, joints);
    let parts = joints.iter().map(|j| format!("`{j}`")).chain(quoted("driver", &drivers));
    some_in_words(&parts.collect::<Vec<_>>())
}

/// A residual above this fraction of the shortest distance between joints is visible in the motion: results are
/// unreliable.
const VISIBLE: f64 = 1e-3;
/// Residuals of directions up to this, rad, count as closed: they do not affect lengths noticeably.
const LEAST_VISIBLE: f64 = 1e-5;

/// Joints with redundant constraints, each once.
fn redundant_joints(facts: &Facts) -> Vec<&str> {
    let mut list: Vec<&str> = Vec::new();
    for name in facts.redundancy.iter().flat_map(|r| &r.joints) {
        if !list.contains(&name.as_str()) {
            list.push(name);
        }
    }
    list
}

/// Warning if the joints leave no degree of freedom: the run shows only the assembled position.
fn rigid(file: &ModelFile, facts: &Facts) -> Option<Diagnostic> {
    if facts.counts.mobility > 0 || facts.counts.joints == 0 {
        return None;
    }
    let redundant = redundant_joints(facts);
    let first = redundant.first().and_then(|name| file.model.joints.iter().position(|j| j.name == *name));
    let place = Some((Section::Joints, first.unwrap_or(0)));
    let message = "nothing can move: the joints leave 0 degrees of freedom".to_owned();
    let d = file.diagnostic(Severity::Warning, "HP0305", message, place);
    Some(if redundant.is_empty() {
        d.note("it is solved as a structure: nothing changes over time")
            .help("if it is meant to move, give a joint more freedom, and add a driver on that joint")
    } else {
        d.note(format!(
            "{} have redundant constraints: if axes are not exactly parallel, or do not exactly intersect, these constraints prevent the motion",
            names(redundant.into_iter())
        ))
        .help(
            "if it is meant to move, make its axes exactly parallel or give one of these joints more freedom, and add a driver",
        )
    })
}

/// Warning if several assemblies are equally near to a singular design configuration, so that it does not decide.
fn ambiguous_assembly(file: &ModelFile, course: &Course) -> Option<Diagnostic> {
    let assembly = course.kept.motion.assembly.as_ref().filter(|assembly| assembly.equally_near > 1)?;
    let place = assembly.gaps.iter().find_map(|gap| match gap.of {
        Closing::Joint(j) => Some((Section::Joints, j.0)),
        Closing::Driver(_) | Closing::Coupler(_) => None,
    });
    let message = format!(
        "the design configuration does not decide between {} assemblies that are equally near",
        assembly.equally_near
    );
    let moved = assembly.moved.iter().map(|m| file.model.bodies[m.body.0].name.as_str());
    let d = file.diagnostic(Severity::Warning, "HP0413", message, place);
    Some(
        d.note(format!(
            "in the design configuration the mechanism is open and in a singular position, such as bars in line; {} may move to either side",
            names(moved)
        ))
        .note("one of them is taken; which one depends on how the model lies in the global axes")
        .help("move a hardpoint a little out of the line, to the side that you mean, or write a `[start]`"),
    )
}

/// Warning if constraint residuals are too large for the dimensions of the mechanism.
fn residual(file: &ModelFile, facts: &Facts, residual: f64) -> Option<Diagnostic> {
    let model = &file.model;
    let (shortest, size) = (model.shortest(), model.size());
    // NaN is reported.
    if residual <= (VISIBLE * shortest).max(LEAST_VISIBLE) {
        return None;
    }
    let length =
        |x: f64| with_unit(file.units.from_si(Quantity::Length, x), symbol(file.units, Quantity::Length));
    let message = format!("the joints stay open by up to {}: the results are unreliable", length(residual));
    let d = file.diagnostic(Severity::Warning, "HP0410", message, None).note(format!(
        "the shortest distance between joints is {}, the size of the mechanism is {}",
        length(shortest),
        length(size)
    ));
    let redundant = redundant_joints(facts);
    Some(if redundant.is_empty() {
        d.note("16 digits do not resolve both")
            .help("move the joints closer together: a point on an axis may be moved along it")
    } else {
        d.note(format!(
            "redundant constraints of {} agree to within {} of the mechanism's size only, which is large for the shortest distance",
            names(redundant.into_iter()),
            rounded(residual / size, 2)
        ))
        .help("make axes that should be parallel exactly parallel, or give one of these joints more freedom")
    })
}

/// Warning for each load without a value at some output time.
fn loads(file: &ModelFile, course: &Course) -> Vec<Diagnostic> {
    let (model, found) = (&file.model, &course.kept);
    let has_none = |m: usize| (0..found.measured.len()).find(|k| found.measured.value(*k, m)[0].is_nan());
    // Computed only once, and only if needed.
    let solved = OnceCell::new();
    let solved = || {
        solved.get_or_init(|| Analysis::new(model).map(|analysis| analysis.loads(&[])).unwrap_or_default())
    };
    let mut list = Vec::new();
    for (m, measure) in model.measures.iter().enumerate() {
        let is_compliance = measure.kind.is_compliance();
        if !measure.kind.is_load() && !is_compliance {
            continue;
        }
        let output = found.measured.outputs.iter().position(|o| o.source == OutputSource::Measure(m));
        let Some(k) = output.and_then(has_none) else { continue };
        let t = number(found.motion.times[k]);
        let message = format!("`{}` has no value at t = {t} s", measure.name);
        let d = file.diagnostic(Severity::Warning, "HP0409", message, Some((Section::Measures, m)));
        let without_length =
            model.elements.iter().filter(|e| has_no_length(model, &found.motion, k, &e.kind));
        let without_length: Vec<String> = without_length.map(|e| e.name.clone()).collect();
        let with_friction = || model.elements.iter().enumerate().filter(|(_, e)| e.kind.has_friction(model));
        let has_friction = with_friction().next().is_some();
        // Where friction is determined, it is not the reason.
        let friction_is_known = || {
            let Loads { times, friction_known, .. } = solved();
            times.iter().zip(friction_known).any(|(at, known)| *at == found.motion.times[k] && *known)
        };
        let names = |kinds: &dyn Fn(usize) -> bool| -> Vec<String> {
            with_friction().filter(|(e, _)| kinds(*e)).map(|(_, element)| element.name.clone()).collect()
        };
        list.push(if found.motion.margins.get(k).is_some_and(|margin| margin.value == 0.0) {
            d.note("the mechanism is at a change point there, where its equilibrium is singular")
                .help("read it at output times away from this one, or drive another joint of the loop")
        } else if !without_length.is_empty() {
            d.note(format!("both ends of {} coincide there: a spring of zero length has no direction", names_of(&without_length)))
                .help("move one of its ends, or use a `bushing`")
        } else if let Some(force) = force_without_size(model, &measure.kind) {
            d.note(format!("the size of `{force}` is zero: such a force has no direction"))
                .help("give it a size, such as 1: the compliance is per unit of force, whatever the size, and its `law` may be zero")
        } else if is_compliance {
            d.note("compliant elements need a support, and redundant constraints support one another")
                .help("release only drivers that something else supports, and remove redundant constraints: `check` names them")
        } else if !has_friction || friction_is_known() {
            d.note("redundant constraints share it, depending on their stiffness")
                .help("measure what is not shared (in a plane `radial` of a hinge, or of a slide `force_x`, `force_y` or `force_z` in the plane), or remove a redundant constraint: `check` names them")
        } else {
            let Loads { shared_friction: shared, ambiguous_friction: ambiguous, .. } = solved();
            if !ambiguous.is_empty() {
                let of = names(&|e| ambiguous.iter().any(|s| s.0 == e));
                d.note(format!("the friction of {} has two solutions there: it is so large that it generates the normal forces it needs", names_of(&of)))
                    .help("reduce the friction, or use thinner pins or longer guides")
            } else if shared.is_empty() {
                d.note(format!("{} jams there: friction is so large that no force moves it", names_of(&names(&|_| true))))
                    .help("reduce the friction, or use thinner pins or longer guides")
            } else {
                let of = names(&|e| shared.iter().any(|s| s.0 == e));
                d.note(format!("redundant constraints share the normal force of {}, depending on their stiffness", names_of(&of)))
                    .help("remove a redundant constraint: `check` names them, or remove the friction")
            }
        });
    }
    list
}

/// True if both ends of a spring or damper coincide at an output time.
fn has_no_length(model: &Model, motion: &Motion, k: usize, kind: &ElementKind) -> bool {
    let Some(force) = kind.force(model) else { return false };
    let ActsOn::Line(ends) = force.acts_on else { return false };
    let [p, q] = ends.map(|p| {
        let point = &model.points[p.0];
        let as_drawn = model.hardpoints[point.at.0].position;
        let in_body = model.bodies[point.body.0].frame.inverse().point(as_drawn);
        let state = motion.at(k).body(point.body.0);
        state.r + state.rotation * in_body
    });
    (q - p).norm() <= ENDS_MEET * model.size()
}

/// Name of the given force of a compliance, if all its components are zero in the design configuration.
fn force_without_size<'m>(model: &'m Model, kind: &MeasureKind) -> Option<&'m str> {
    let MeasureKind::Compliance { force: Some(force), .. } = kind else { return None };
    let name = &model.elements[force.0].name;
    let mut components = model.numbers.iter().filter(|number| number.owner == *name);
    components.all(|number| number.value == 0.0).then_some(name)
}

/// Names in backticks.
fn names_of(list: &[String]) -> String {
    names(list.iter().map(String::as_str))
}

/// Warning if the motion comes so close to a singular position that its velocities are unreliable.
pub fn margin(file: &ModelFile, margin: &MarginFact) -> Option<Diagnostic> {
    if !margin.is_thin() {
        return None;
    }
    let t = number(margin.time);
    let message = format!("the mechanism comes close to a singular position at t = {t} s");
    let first = margin.joints.first().and_then(|name| file.model.joints.iter().position(|j| j.name == *name));
    let d = file.diagnostic(Severity::Warning, "HP0407", message, first.map(|j| (Section::Joints, j)));
    let d = d.note(format!(
        "the margin there is {}: about {} of 16 digits of velocities and sensitivities are lost",
        rounded(margin.least, 2),
        rounded(margin.digits_lost.min(16.0).round(), 2)
    ));
    let d = d.note(format!("the loop consists of {}", names(margin.joints.iter().map(String::as_str))));
    Some(d.help(match file.model.at_change_points {
        ChangePointPolicy::Stop => {
            "drive another joint of this loop, or move its hardpoints away from this position"
        }
        ChangePointPolicy::Continue => {
            "the motion may pass a change point, as `at_change_points = \"continue\"` allows; read velocities, loads and sensitivities at \
             output times away from this one, or drive another joint of this loop"
        }
    }))
}

/// Part of the range of a variable by which a value at its bound may be beyond it.
const BOUND_KEPT: f64 = 1e-12;

/// Warning for each design variable that a change moves out of its bounds.
pub fn out_of_bounds(file: &ModelFile, change: &[f64]) -> Vec<Diagnostic> {
    let warn = |(k, (v, by)): (usize, (&DesignVariable, &f64))| {
        // A value at a bound may be beyond it by round-off.
        let slack = |[low, high]: &[f64; 2]| BOUND_KEPT * (high - low);
        let [low, high] = v.bounds.filter(|b| !(b[0] - slack(b) <= *by && *by <= b[1] + slack(b)))?;
        let shown =
            |x: f64| with_unit(file.units.from_si(v.quantity, x), &variable_unit(&file.model, file.units, v));
        let message = format!("the change of `{}` by {} is outside its bounds", v.name, shown(*by));
        let d = file.diagnostic(Severity::Warning, "HP0504", message, Some((Section::Design, k)));
        let d = d.note(format!(
            "they allow changes of {} to {}; it is solved all the same",
            shown(low),
            shown(high)
        ));
        Some(d.help("change it by less, or widen its `bounds`"))
    };
    file.model.variables.iter().zip(change).enumerate().filter_map(warn).collect()
}

/// Warning for each design variable that the mechanism cannot follow, or that has no effect.
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
    let resisted =
        facts.variables.iter().enumerate().filter(|(_, v)| v.answer == VariableAdmissibility::CannotFollow);
    let idle = file.model.without_effect().into_iter().map(|v| {
        let message = format!("design variable `{}` changes nothing", file.model.variables[v.0].name);
        let d = file.diagnostic(Severity::Warning, "HP0502", message, Some((Section::Design, v.0)));
        let d = d.note("no joint, point, measure or law depends on it: its sensitivities are zero");
        d.help("use it, remove it, or write `design = false` if it is a parameter")
    });
    resisted.map(warn).chain(idle).collect()
}
