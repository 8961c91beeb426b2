//! Laws that hold for every mechanism that is solved.

use std::collections::{BTreeMap, BTreeSet};

use hardpoint::motion::{Execution, StopKind};
use hardpoint::sensitivity::Admissibility;
use hardpoint::space::{Pose, Vec3};
use hardpoint::topology::{Formulation, JointRole, SetBy};
use hardpoint::{Analysis, Run, Solution};
use hardpoint::{draft::*, model::*};
use hardpoint_study::Comparison;
use hardpoint_study::difference::{DifferenceScheme, finite_differences};

use super::draw::Rng;
use super::rank;

/// Two ways to the same numbers agree to this, over a power of the margin that grows with the order: round-off enters a
/// position once, a velocity through one more solution with the Jacobian, an acceleration through two, and each
/// solution may lose 1 / margin of its digits. 1e-13 is some hundred roundings of bodies several joints away from
/// ground.
const AGREE: f64 = 1e-12;
/// The best that central differences over a sweep of decades can do is some 1e-10 of a well-conditioned sensitivity; a
/// coarse sweep finds a tenth of that, and each order loses digits to the margin.
const DIFFERENCE: f64 = 1e-7;
/// Differences over time, of fourth order with steps of 5e-4 and 1e-4 of the run.
const RATE: f64 = 1e-6;
/// Below this nothing is left of an acceleration's sensitivity, and nothing is compared.
const LEAST_MARGIN: f64 = 1e-5;
/// Rows hold to this part of the size, or as angles and cosines to this.
const CLOSED: f64 = 1e-11;
/// More steps than this between a handful of output times are a walk that gets nowhere.
const MOST_SUBSTEPS: usize = 200_000;

/// Promise of a family.
#[derive(Clone, Copy)]
pub struct Promise {
    /// No row is redundant, so that any change of the design can be followed.
    pub exact: bool,
    /// Closed in the design configuration.
    pub closed: bool,
}

/// Results of cases.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pub drawn: usize,
    pub solved: usize,
    pub stops: BTreeMap<String, usize>,
    pub faults: BTreeMap<String, usize>,
    /// Joint types, in the tree and cut; coordinates, driven in the tree and across a cut, coupled and measured;
    /// drivers.
    pub used: BTreeSet<String>,
    pub admissible: usize,
    pub reassembled: usize,
    pub cannot_follow: usize,
    pub idle: usize,
    /// Per law, the worst deviation over what is allowed, with the case.
    pub worst: BTreeMap<&'static str, (f64, u64)>,
    pub failures: Vec<String>,
}

impl Tally {
    fn note(&mut self, law: &'static str, part: f64, case: u64) -> bool {
        let worst = self.worst.entry(law).or_insert((0.0, case));
        if !(part <= worst.0) {
            *worst = (part, case);
        }
        part <= 1.0
    }
}

impl Tally {
    /// The figures in a few lines.
    pub fn summary(&self, family: &str) -> String {
        let worst: Vec<String> =
            self.worst.iter().map(|(law, (part, case))| format!("{law} {part:.1e} (case {case})")).collect();
        format!(
            "{family}: {} drawn, {} solved, stops {:?}, faults {:?}; variables: {} admissible, {} reassembled, {} not \
             followed; {} with idle spins; worst parts of what is allowed: {}; {} failures",
            self.drawn,
            self.solved,
            self.stops,
            self.faults,
            self.admissible,
            self.reassembled,
            self.cannot_follow,
            self.idle,
            worst.join(", "),
            self.failures.len()
        )
    }
}

/// Features that a draft uses, if it runs to its end.
pub fn used_where_solved(draft: &Draft) -> BTreeSet<String> {
    let mut tally = Tally::default();
    let model = Model::from_draft(draft).unwrap_or_else(|f| panic!("{f:?}"));
    if let Ok(analysis) = Analysis::new(&model)
        && analysis.solve(Run::new().without_sensitivities()).stop.is_none()
    {
        Case { seed: 0, draft, tally: &mut tally }.use_of(&analysis);
    }
    tally.used
}

/// Every case is solved in one of these ways.
const EXECUTIONS: [Execution; 3] = [Execution::Kernel, Execution::Interpreted, Execution::Compiled];

/// A case under examination.
pub struct Case<'a> {
    pub seed: u64,
    pub draft: &'a Draft,
    pub tally: &'a mut Tally,
}

impl Case<'_> {
    fn fail(&mut self, what: impl Into<String>) {
        let text = format!("case {}: {}\n{}", self.seed, what.into(), describe(self.draft));
        self.tally.failures.push(text);
    }

    /// Notes a deviation as a part of what is allowed.
    fn allow(&mut self, law: &'static str, deviation: f64, limit: f64, what: impl FnOnce() -> String) {
        if !self.tally.note(law, deviation / limit, self.seed) {
            let text = format!("{law}: {deviation:e}, allowed {limit:e}: {}", what());
            self.fail(text);
        }
    }

    /// All laws.
    pub fn examine(&mut self, promise: Promise, rng: &mut Rng) {
        self.tally.drawn += 1;
        let model = match Model::from_draft(self.draft) {
            Ok(model) => model,
            Err(faults) => return self.fail(format!("a sound draft has faults: {faults:?}")),
        };
        let mobility = rank::mobility(&model);
        let by = EXECUTIONS[self.seed as usize % EXECUTIONS.len()];
        let both = [Formulation::Relative, Formulation::Absolute]
            .map(|f| Analysis::with(&model, f).map(|a| a.executed(by)));
        let [relative, absolute] = match both {
            [Ok(relative), Ok(absolute)] => [relative, absolute],
            [Err(a), Err(b)] => {
                *self.tally.faults.entry(a.code().into()).or_default() += 1;
                if promise.exact || a.code() != b.code() {
                    self.fail(format!(
                        "freedoms {mobility}, drivers {}: {a}; absolute: {b}",
                        model.drivers.len()
                    ));
                }
                return;
            }
            [a, b] => {
                let text = [a.err(), b.err()].map(|e| e.map(|e| e.to_string()));
                return self.fail(format!("freedoms {mobility}, drivers {}: {text:?}", model.drivers.len()));
            }
        };
        for analysis in [&relative, &absolute] {
            if analysis.topology().mobility != mobility {
                let says = analysis.topology().mobility;
                self.fail(format!(
                    "{says} freedoms ({:?}), by rank {mobility}",
                    analysis.topology().formulation
                ));
            }
            if promise.exact && analysis.topology().redundant().count() != 0 {
                self.fail("a redundant row");
            }
        }
        let (a, b) = (relative.run(), absolute.run());
        for s in [&a, &b] {
            self.is_finite(s);
            self.is_closed(&model, s);
        }
        self.stop_alike(&a, &b);
        // That an overconstrained mechanism cannot follow a variable shows on its way, not in the design configuration
        // alone.
        let least_times = if promise.exact { 1 } else { 3 };
        if a.motion.len().min(b.motion.len()) < least_times {
            return;
        }
        let margin = |s: &Solution| s.motion.least_margin().map_or(0.0, |m| m.1.value);
        let least = margin(&a).min(margin(&b));
        if least < LEAST_MARGIN {
            return;
        }
        self.agree("formulations", (&model, &a), (&model, &b), least, None);
        if a.stop.is_some() {
            return;
        }
        self.tally.solved += 1;
        self.tally.idle += usize::from(!model.idle.is_empty());
        self.follows(&model, &a, promise);
        self.differences(&relative, &a, least, rng);
        self.rates(&a, least, rng);
        if model.idle.is_empty() {
            self.variations(&model, &a, least, rng);
        }
    }

    /// Faults, or a solution as far as it goes, without a panic and without a number that is none.
    pub fn survive(&mut self) {
        self.tally.drawn += 1;
        let model = match Model::from_draft(self.draft) {
            Ok(model) => model,
            Err(faults) => {
                *self.tally.faults.entry(faults[0].code.into()).or_default() += 1;
                return;
            }
        };
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            match Analysis::with(&model, formulation).map(|a| a.run()) {
                Err(fault) => *self.tally.faults.entry(fault.code().into()).or_default() += 1,
                Ok(s) => {
                    match &s.stop {
                        Some(stop) => *self.tally.stops.entry(stop.code().into()).or_default() += 1,
                        None => self.tally.solved += 1,
                    }
                    self.is_finite(&s);
                }
            }
        }
    }

    /// Nothing that is given out is NaN or infinite.
    pub fn is_finite(&mut self, s: &Solution) {
        let states = s
            .motion
            .states()
            .flat_map(|s| [s.r, s.v, s.omega, s.a, s.alpha].into_iter().chain(s.rotation.cols));
        let mut bad = Vec::new();
        // A distance of zero has no rate.
        let vanishes = |m: usize| {
            (0..s.motion.len()).any(|k| {
                !(s.measured.value(k, m)[0].abs() > f64::MIN_POSITIVE)
                    && s.measured.outputs[m].dimension == Dimension::LENGTH
            })
        };
        if !states.into_iter().all(Vec3::is_finite) {
            bad.push("a body's state".to_string());
        }
        if !(0..s.motion.len()).all(|k| s.motion.coordinates(k).all(f64::is_finite))
            || !s.motion.margins.iter().all(|m| m.value.is_finite())
        {
            bad.push("a coordinate or margin".into());
        }
        for k in 0..s.motion.len() {
            for v in 0..s.sensitivities.variables {
                let Some(bodies) = s.sensitivities.at(k, v) else { continue };
                let all = bodies.iter().flat_map(|d| [d.dr, d.dpi, d.dv, d.domega, d.da, d.dalpha]);
                if !all.into_iter().all(Vec3::is_finite) {
                    bad.push(format!("a sensitivity by variable {v}"));
                }
                for (m, output) in s.measured.outputs.iter().enumerate().filter(|(m, _)| !vanishes(*m)) {
                    if !s.measured.d(k, VariableId(v), m)[..output.known.orders].iter().all(|x| x.is_finite())
                    {
                        bad.push(format!("the sensitivity of {} by variable {v}", output.name));
                    }
                }
            }
            for (m, output) in s.measured.outputs.iter().enumerate() {
                if vanishes(m) {
                    continue;
                }
                if !s.measured.value(k, m)[..output.known.orders].iter().all(|x| x.is_finite()) {
                    bad.push(output.name.clone());
                }
            }
        }
        bad.dedup();
        if !bad.is_empty() {
            self.fail(format!("not finite: {}", bad.join(", ")));
        }
        if s.motion.effort.substeps > MOST_SUBSTEPS {
            self.fail(format!("{} steps", s.motion.effort.substeps));
        }
    }

    fn is_closed(&mut self, model: &Model, s: &Solution) {
        let worst = s.motion.effort.worst_residual;
        self.allow("residual", worst, CLOSED * model.size().max(1.0), || format!("{:?}", s.stop));
    }

    /// Both formulations reach the same end, within a step.
    fn stop_alike(&mut self, a: &Solution, b: &Solution) {
        let kind = |s: &Solution| s.stop.as_ref().map(|s| s.code().to_string());
        if let Some(code) = kind(a) {
            *self.tally.stops.entry(code).or_default() += 1;
        }
        let apart = a.motion.len().abs_diff(b.motion.len());
        let step = |s: &Solution| s.stop.as_ref().map(|s| (s.failed_time, s.last_time));
        if apart > 1 || a.stop.is_some() != b.stop.is_some() {
            self.fail(format!(
                "relative ends after {} times: {:?}, {:?}; absolute after {}: {:?}, {:?}",
                a.motion.len(),
                kind(a),
                step(a),
                b.motion.len(),
                kind(b),
                step(b)
            ));
        }
        for s in [a, b] {
            if let Some(StopKind::LawNotFinite { .. } | StopKind::Interrupted) =
                s.stop.as_ref().map(|s| s.kind)
            {
                self.fail("an odd stop");
            }
        }
    }

    /// Two solutions agree in all that is compared.
    fn agree(
        &mut self,
        law: &'static str,
        a: (&Model, &Solution),
        b: (&Model, &Solution),
        margin: f64,
        to: Option<Pose>,
    ) {
        let size = a.0.size();
        let (x, y) = (flat(a.0, a.1, size, None, to.is_some()), flat(b.0, b.1, size, to, to.is_some()));
        if x.len() != y.len() {
            let said =
                |s: &Solution| format!("{} times, {:?}", s.motion.len(), s.sensitivities.admissibility);
            return self.fail(format!("{law}: not the same numbers: {}; {}", said(a.1), said(b.1)));
        }
        let times = a.1.motion.len().min(b.1.motion.len());
        let mut worst = (0.0_f64, String::new(), 0.0, 0.0);
        for (x, y) in x.iter().zip(&y) {
            assert_eq!(x.name, y.name);
            let per_time = x.values.len() / a.1.motion.len();
            let n = per_time * times;
            let most = x.values[..n].iter().map(|x| x.abs()).fold(x.floor, f64::max);
            // Across a cut turns are counted from the first output time and by the rates since, in the tree from the
            // design.
            let whole = if x.counts_turns { std::f64::consts::TAU } else { f64::INFINITY };
            let apart = x.values[..n].iter().zip(&y.values[..n]).map(|(x, y)| {
                let d = x - y;
                if whole.is_finite() { (d - whole * (d / whole).round()).abs() } else { d.abs() }
            });
            let apart = apart.fold(0.0, |m: f64, d| if d <= m { m } else { d }) / most;
            let limit = AGREE / margin.powi(x.order + 1);
            if !(apart / limit <= worst.0) {
                worst = (apart / limit, x.name.clone(), apart, limit);
            }
        }
        self.allow(law, worst.2, if worst.3 > 0.0 { worst.3 } else { 1.0 }, || {
            format!("{}, margin {margin:e}", worst.1)
        });
    }

    /// Features of the library that were used.
    fn use_of(&mut self, analysis: &Analysis<'_>) {
        let (model, topology) = (analysis.model(), analysis.topology());
        let used = &mut self.tally.used;
        for (k, joint) in model.joints.iter().enumerate().filter(|(_, j)| !j.unnamed) {
            let place = if matches!(topology.roles[k], JointRole::Tree { .. }) { "tree" } else { "cut" };
            used.insert(format!("{} {place}", joint.kind.name));
        }
        for d in &model.drivers {
            let (joint, c) = (&model.joints[d.joint.0], model.driven(d));
            if joint.unnamed {
                used.insert(format!("driver {}", joint.kind.name));
                continue;
            }
            let in_tree = topology
                .coordinates
                .iter()
                .any(|x| matches!(x.set_by, SetBy::Driver(id) if model.drivers[id.0].name == d.name));
            let place = if in_tree { "tree" } else { "cut" };
            used.insert(format!("{}.{} driven {place}", joint.kind.name, c.name));
        }
        for t in model.couplers.iter().flat_map(|c| &c.terms) {
            used.insert(format!("{}.{} coupled", model.joints[t.joint.0].kind.name, model.coupled(t).name));
        }
        for m in &model.measures {
            if let MeasureKind::Coordinate { joint, coordinate } = m.kind {
                let kind = model.joints[joint.0].kind;
                used.insert(format!("{}.{} measured", kind.name, kind.coordinates[coordinate].name));
            }
        }
        for change in self.draft.design.iter().flat_map(|v| &v.changes) {
            used.insert(match change {
                ChangeDraft::Move { .. } => "move".into(),
                ChangeDraft::Tilt { .. } => "tilt".into(),
                ChangeDraft::Play { .. } => "play".into(),
                ChangeDraft::Marker { .. } => "marker".into(),
                ChangeDraft::Length { .. } => "length".into(),
                ChangeDraft::Law { .. } => "law".into(),
                ChangeDraft::Field { .. } => "field".into(),
                ChangeDraft::Shape { .. } => "shape".into(),
                ChangeDraft::Parameter { .. } => "parameter".into(),
            });
        }
    }

    /// Admissible variables leave all bodies where they are while all drivers are zero; an exactly determined mechanism
    /// follows every variable.
    fn follows(&mut self, model: &Model, s: &Solution, promise: Promise) {
        for (v, admissibility) in s.sensitivities.admissibility.iter().enumerate() {
            match admissibility {
                Admissibility::Admissible => self.tally.admissible += 1,
                Admissibility::Reassembled { .. } => self.tally.reassembled += 1,
                Admissibility::CannotFollow { .. } => self.tally.cannot_follow += 1,
                Admissibility::Unknown => self.fail("a variable of a solved motion is unknown"),
            }
            if promise.exact && matches!(admissibility, Admissibility::CannotFollow { .. }) {
                self.fail(format!("{}: {admissibility:?}", model.variables[v].name));
            }
            let at_rest = s.motion.times[0] == 0.0 && promise.closed;
            if at_rest && *admissibility == Admissibility::Admissible {
                let moved = s.sensitivities.at(0, v).into_iter().flat_map(|d| d.iter());
                let moved = moved.map(|d| (d.dr.norm() / model.size()).max(d.dpi.norm())).fold(0.0, f64::max);
                let moved = moved * model.natural_step(VariableId(v));
                let margin = s.motion.margins[0].value;
                // Typed velocities count as admissible up to 1e-7.
                self.allow("admissible", moved, 1e-11 / margin, || model.variables[v].name.clone());
            }
        }
    }

    /// Sensitivities match re-solved designs, for two variables.
    fn differences(&mut self, analysis: &Analysis<'_>, s: &Solution, margin: f64, rng: &mut Rng) {
        let model = analysis.model();
        let mut variables: Vec<usize> =
            (0..model.variables.len()).filter(|&v| s.sensitivities.at(0, v).is_some()).collect();
        rng.shuffle(&mut variables);
        for v in variables.into_iter().take(2).map(VariableId) {
            let natural = model.natural_step(v);
            // Near a singular position the motion changes within steps of the margin.
            let part =
                [3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6].map(|part| (v, part * natural * margin.sqrt()));
            let mut best = Comparison::default();
            for d in finite_differences(analysis, s, DifferenceScheme::Central, &part).into_iter().flatten() {
                best.keep_better(Comparison::of(model, s, &d));
            }
            let Some(worst) = best.worst() else {
                self.fail(format!("no design near {} could be solved", model.variables[v.0].name));
                continue;
            };
            let limit = DIFFERENCE / margin;
            self.allow("re-solved designs", worst.error, limit, || {
                format!("{}: {}, margin {margin:e}", model.variables[v.0].name, worst.quantity)
            });
        }
    }

    /// Velocities and accelerations, also of sensitivities, are rates over time.
    fn rates(&mut self, coarse: &Solution, margin: f64, rng: &mut Rng) {
        let times = &coarse.motion.times;
        let t = times[1 + rng.below(times.len() - 2)];
        let span = times[times.len() - 1] - times[0];
        let mut best: Vec<(f64, String)> = Vec::new();
        for h in [5e-4 * span, 1e-4 * span] {
            let mut draft = self.draft.clone();
            draft.times = vec![times[0], t - 2.0 * h, t - h, t, t + h, t + 2.0 * h];
            let model = Model::from_draft(&draft).expect("other times");
            let Ok(analysis) = Analysis::new(&model) else { return self.fail("other times, no plan") };
            let s = analysis.run();
            if s.stop.is_some() {
                return self.fail(format!("stops where it did not on the way: {:?}", s.stop));
            }
            let slope = |f: &dyn Fn(usize) -> f64| (f(1) - 8.0 * f(2) + 8.0 * f(4) - f(5)) / (12.0 * h);
            let mut errors = Vec::new();
            let scale = |f: &dyn Fn(usize) -> f64| (0..6).map(|k| f(k).abs()).fold(0.0, f64::max);
            let unit = |of: Dimension| model.size().powi(of.length.into());
            let mut push =
                |name: String, floor: f64, value: &dyn Fn(usize) -> f64, rate: &dyn Fn(usize) -> f64| {
                    let all = scale(rate).max(scale(value)).max(floor);
                    errors.push(((slope(value) - rate(3)).abs() / all, name));
                };
            for b in 1..s.motion.bodies {
                let state = |k: usize| s.motion.at(k).body(b);
                for axis in 0..3 {
                    let name = |what: &str| format!("{what} of {}", model.bodies[b].name);
                    let size = model.size();
                    push(name("velocity"), size, &|k| state(k).r[axis], &|k| state(k).v[axis]);
                    push(name("acceleration"), size, &|k| state(k).v[axis], &|k| state(k).a[axis]);
                    push(name("angular acceleration"), 1.0, &|k| state(k).omega[axis], &|k| {
                        state(k).alpha[axis]
                    });
                    for c in 0..2 {
                        let turning = |k: usize| state(k).omega.cross(state(k).rotation.cols[c])[axis];
                        push(name("angular velocity"), 1.0, &|k| state(k).rotation.cols[c][axis], &turning);
                    }
                }
            }
            for (m, output) in s.measured.outputs.iter().enumerate() {
                for order in 0..output.known.orders - 1 {
                    let floor = unit(output.dimension);
                    push(
                        format!("rate {} of {}", order + 1, output.name),
                        floor,
                        &|k| s.measured.value(k, m)[order],
                        &|k| s.measured.value(k, m)[order + 1],
                    );
                    for v in (0..model.variables.len()).filter(|&v| s.sensitivities.at(0, v).is_some()) {
                        let floor = floor / model.natural_step(VariableId(v));
                        let name =
                            format!("rate {} of {} by {}", order + 1, output.name, model.variables[v].name);
                        push(name, floor, &|k| s.measured.d(k, VariableId(v), m)[order], &|k| {
                            s.measured.d(k, VariableId(v), m)[order + 1]
                        });
                    }
                }
            }
            if best.is_empty() {
                best = errors;
            } else {
                best.iter_mut().zip(errors).for_each(|(b, e)| b.0 = if e.0 < b.0 { e.0 } else { b.0 });
            }
        }
        let worst = best.iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("bodies");
        self.allow("rates over time", worst.0, RATE / margin, || {
            format!("{} at t = {t}, margin {margin:e}", worst.1)
        });
    }

    /// The same mechanism somewhere else, in another order, and with another cut.
    fn variations(&mut self, model: &Model, s: &Solution, margin: f64, rng: &mut Rng) {
        let solve = |case: &mut Self, what: &'static str, draft: &Draft, to: Option<Pose>| {
            let other = match Model::from_draft(draft) {
                Ok(other) => other,
                Err(faults) => return case.fail(format!("{what}: {faults:?}")),
            };
            match Analysis::new(&other).map(|a| a.run()) {
                Err(fault) => case.fail(format!("{what}: {fault}")),
                Ok(t) if t.stop.is_some() => case.fail(format!("{what}: {:?}", t.stop)),
                Ok(t) => {
                    let least = t.motion.least_margin().map_or(0.0, |m| m.1.value).min(margin);
                    if least >= LEAST_MARGIN {
                        case.agree(what, (model, s), (&other, &t), least, to);
                    }
                }
            }
        };
        // The direction whose rotation an orientation driver measures is perpendicular to `about`, but otherwise
        // derived from the global axes. So such a driver has a different meaning after the mechanism is rotated. The
        // same is true of the Euler angles of a marker without a given x axis.
        let turns = self.draft.drivers.iter().any(|d| matches!(d.drives, DrivenDraft::Orientation { .. }))
            || self
                .draft
                .design
                .iter()
                .flat_map(|v| &v.changes)
                .any(|c| matches!(c, ChangeDraft::Field { .. }));
        let to = rng.pose(2.0 * model.size());
        let to = if turns { Pose { rot: Pose::IDENTITY.rot, ..to } } else { to };
        let moved = moved(self.draft, to);
        solve(self, "moved and turned", &moved, Some(to));
        let mut shuffled = self.draft.clone();
        rng.shuffle(&mut shuffled.hardpoints);
        rng.shuffle(&mut shuffled.bodies);
        rng.shuffle(&mut shuffled.joints);
        rng.shuffle(&mut shuffled.couplers);
        rng.shuffle(&mut shuffled.drivers);
        rng.shuffle(&mut shuffled.design);
        rng.shuffle(&mut shuffled.measures);
        rng.shuffle(&mut shuffled.points);
        solve(self, "another order", &shuffled, None);
        let mut cut = self.draft.clone();
        let k = rng.below(cut.joints.len());
        cut.joints[k].cut = !cut.joints[k].cut;
        solve(self, "another cut", &cut, None);
    }
}

/// Numbers of one kind over all times.
struct Group {
    name: String,
    /// 0 for positions, 1 for velocities, 2 for accelerations.
    order: i32,
    /// A deviation counts as a part of the largest of the numbers, but at least of this.
    floor: f64,
    values: Vec<f64>,
    /// True if it is an angle that is counted through whole turns.
    counts_turns: bool,
}

/// All numbers of a solution, lengths in sizes, by names in alphabetical order; those of a moved mechanism are moved
/// back, and with `anywhere` those left out that depend on where it is.
fn flat(model: &Model, s: &Solution, size: f64, moved: Option<Pose>, anywhere: bool) -> Vec<Group> {
    let times = s.motion.len();
    let by_name = |names: Vec<&str>| {
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by_key(|&k| names[k]);
        order
    };
    let bodies = by_name(model.bodies.iter().map(|b| b.name.as_str()).collect());
    let bodies: Vec<usize> = bodies.into_iter().filter(|&b| b != 0).collect();
    let outputs = by_name(s.measured.outputs.iter().map(|o| o.name.as_str()).collect());
    let variables = by_name(model.variables.iter().map(|v| v.name.as_str()).collect());
    let back = |v: Vec3| moved.map_or(v, |to| to.rot.transpose_mul(v));
    let place = |v: Vec3| moved.map_or(v, |to| to.inverse().point(v));
    let mut groups: Vec<Group> = Vec::new();
    let vectors = |of: &dyn Fn(usize, usize) -> [Vec3; 2]| -> Vec<f64> {
        let all = (0..times).flat_map(|k| bodies.iter().map(move |&b| (k, b)));
        all.flat_map(|(k, b)| of(k, b)).flat_map(|v| v.to_array()).collect()
    };
    let zero = Vec3::ZERO;
    let of_states: [&dyn Fn(usize, usize) -> [Vec3; 2]; 3] = [
        &|k, b| [place(s.motion.at(k).body(b).r) * (1.0 / size), zero],
        &|k, b| [back(s.motion.at(k).body(b).v) * (1.0 / size), back(s.motion.at(k).body(b).omega)],
        &|k, b| [back(s.motion.at(k).body(b).a) * (1.0 / size), back(s.motion.at(k).body(b).alpha)],
    ];
    let states = of_states.map(vectors);
    let largest = |x: &[f64]| x.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let speeds = [1.0, largest(&states[1]).max(1e-3), largest(&states[2]).max(1e-3)];
    for (order, values) in states.into_iter().enumerate() {
        let name = format!("states of order {order}");
        groups.push(Group { name, order: order as i32, floor: speeds[order], values, counts_turns: false });
    }
    for &v in variables.iter().filter(|&&v| s.sensitivities.at(0, v).is_some()) {
        let natural = model.natural_step(VariableId(v));
        let at = |k: usize, b: usize| s.sensitivities.at(k, v).expect("followed").body(b);
        let of: [&dyn Fn(usize, usize) -> [Vec3; 2]; 3] = [
            &|k, b| [back(at(k, b).dr) * (1.0 / size), back(at(k, b).dpi)],
            &|k, b| [back(at(k, b).dv) * (1.0 / size), back(at(k, b).domega)],
            &|k, b| [back(at(k, b).da) * (1.0 / size), back(at(k, b).dalpha)],
        ];
        for (order, values) in of.map(vectors).into_iter().enumerate() {
            let name = format!("sensitivities of order {order} by {}", model.variables[v].name);
            // One order more: a sensitivity is one more solution with the Jacobian.
            groups.push(Group {
                name,
                order: order as i32 + 1,
                floor: speeds[order] / natural,
                values,
                counts_turns: false,
            });
        }
    }
    for &m in &outputs {
        let output = &s.measured.outputs[m];
        let unit = size.powi(output.dimension.length.into());
        let global = output.name.contains('.');
        let mut depends = global;
        if let Some(
            MeasureKind::Coordinates { .. }
            | MeasureKind::Toe { .. }
            | MeasureKind::Camber { .. }
            | MeasureKind::Velocity { .. }
            | MeasureKind::Acceleration { .. }
            | MeasureKind::Slope { .. }
            | MeasureKind::Dexterity { .. },
        ) = model.measures.iter().find(|x| x.name == output.name).map(|x| &x.kind)
        {
            depends = true;
        }
        if depends && anywhere {
            continue;
        }
        for order in 0..output.known.orders {
            let values = (0..times).map(|k| s.measured.value(k, m)[order]).collect();
            let floor = speeds[(order as i8 - output.dimension.time) as usize] * unit;
            let counts_turns = order == 0 && output.dimension == Dimension::ANGLE;
            groups.push(Group {
                name: format!("{} order {order}", output.name),
                order: order as i32,
                floor,
                values,
                counts_turns,
            });
            for &v in variables.iter().filter(|&&v| s.sensitivities.at(0, v).is_some()) {
                let values = (0..times).map(|k| s.measured.d(k, VariableId(v), m)[order]).collect();
                let name = format!("{} order {order} by {}", output.name, model.variables[v].name);
                let floor = floor / model.natural_step(VariableId(v));
                groups.push(Group { name, order: order as i32 + 1, floor, values, counts_turns: false });
            }
        }
    }
    groups
}

/// The mechanism with everything in it moved and turned.
fn moved(draft: &Draft, to: Pose) -> Draft {
    let mut d = draft.clone();
    let place = |p: &mut LocationDraft| {
        if let LocationDraft::At(v) = p {
            *v = to.point(*v);
        }
    };
    let line = |l: &mut DirectionDraft| {
        if let DirectionDraft::Along(v) = l {
            *v = to.rot * *v;
        }
    };
    let point = |p: &mut PointRef| {
        if let PointRef::On { at, .. } = p {
            place(at);
        }
    };
    for h in &mut d.hardpoints {
        h.position = to.point(h.position);
    }
    for b in &mut d.bodies {
        if let FrameDraft::Pose(p) = &mut b.frame {
            *p = to.compose(*p);
        }
    }
    for j in &mut d.joints {
        j.at.iter_mut().for_each(place);
        j.axis.iter_mut().chain(&mut j.axis2).for_each(line);
        j.curve.iter_mut().for_each(|c| c.points.iter_mut().for_each(place));
    }
    for change in d.design.iter_mut().flat_map(|v| &mut v.changes) {
        match change {
            ChangeDraft::Move { velocity, .. } => *velocity = to.rot * *velocity,
            ChangeDraft::Tilt { about, .. } => line(about),
            ChangeDraft::Marker { position, rotation, .. } => {
                (*position, *rotation) = (to.rot * *position, to.rot * *rotation);
            }
            ChangeDraft::Shape { .. } => unreachable!("random mechanisms have no shapes"),
            // In a body's own frame, which is drawn along.
            ChangeDraft::Field { .. }
            | ChangeDraft::Play { .. }
            | ChangeDraft::Length { .. }
            | ChangeDraft::Parameter { .. }
            | ChangeDraft::Law { .. } => {}
        }
    }
    d.points.iter_mut().for_each(|p| place(&mut p.at));
    for driver in &mut d.drivers {
        match &mut driver.drives {
            DrivenDraft::Coordinate { .. }
            | DrivenDraft::Measure(_)
            | DrivenDraft::Contact(_)
            | DrivenDraft::Unread => {}
            DrivenDraft::Position { point: p, along } => {
                point(p);
                line(along);
            }
            DrivenDraft::Distance { from, to } => {
                point(from);
                point(to);
            }
            DrivenDraft::Orientation { about, .. } => line(about),
        }
    }
    for m in &mut d.measures {
        match &mut m.kind {
            MeasureKindDraft::Coordinate { .. } | MeasureKindDraft::Unread => {}
            MeasureKindDraft::Articulation { axis, .. } => axis.iter_mut().for_each(&line),
            MeasureKindDraft::Distance { from, to } => {
                point(from);
                point(to);
            }
            MeasureKindDraft::Coordinates { point: p, along } => {
                point(p);
                *along = to.rot * *along;
            }
            MeasureKindDraft::Toe { spin_axis, .. } | MeasureKindDraft::Camber { spin_axis, .. } => {
                line(spin_axis)
            }
            MeasureKindDraft::Angle { from, to: last, .. }
            | MeasureKindDraft::TransmissionAngle { from, to: last } => {
                for ray in [from, last] {
                    match ray {
                        RayDraft::Between(points) => points.iter_mut().for_each(&point),
                        RayDraft::Fixed { axis, .. } => line(axis),
                    }
                }
                if let MeasureKindDraft::Angle { about: Some(n), .. } = &mut m.kind {
                    *n = to.rot * *n;
                }
            }
            MeasureKindDraft::Velocity { point: p, along }
            | MeasureKindDraft::Acceleration { point: p, along }
            | MeasureKindDraft::Curvature { point: p, about: along } => {
                point(p);
                *along = along.map(|v| to.rot * v);
            }
            MeasureKindDraft::AngularVelocity { along, .. } => *along = along.map(|v| to.rot * v),
            MeasureKindDraft::Dexterity { points, .. } => points.iter_mut().for_each(&point),
            MeasureKindDraft::Rate { .. }
            | MeasureKindDraft::Slope { .. }
            | MeasureKindDraft::Clearance { .. }
            | MeasureKindDraft::Combination { .. } => {}
            // Of two bodies, whose frames are drawn along.
            MeasureKindDraft::Orientation { .. } => {}
            MeasureKindDraft::DriverForce { .. }
            | MeasureKindDraft::DriverPower { .. }
            | MeasureKindDraft::Reaction { .. }
            | MeasureKindDraft::SpringForce { .. }
            | MeasureKindDraft::Deflection { .. }
            | MeasureKindDraft::KineticEnergy { .. }
            | MeasureKindDraft::ShakingForce { .. }
            | MeasureKindDraft::ShakingMoment { .. }
            | MeasureKindDraft::Compliance { .. } => unreachable!("random mechanisms have no masses"),
            // Its wheels would have to stay upright.
            MeasureKindDraft::Wheel { .. } | MeasureKindDraft::Axle { .. } => {
                unreachable!("random mechanisms have no wheels")
            }
        }
    }
    d
}

/// A draft in a few lines.
pub fn describe(d: &Draft) -> String {
    let joints = d.joints.iter().map(|j| {
        let more = [(j.cut, " cut"), (j.length.is_some(), " length"), (j.at.len() == 2, " 2 places")];
        let more: String = more.iter().filter(|m| m.0).map(|m| m.1).collect();
        format!("{} {} {}-{}{more}", j.name, j.kind, j.bodies[0], j.bodies[1])
    });
    let couplers = d.couplers.iter().map(|c| match &c.kind {
        CouplerKindDraft::Linear(terms) => {
            let terms =
                terms.iter().map(|t| format!("{}.{}", t.joint, t.coordinate.as_deref().unwrap_or("")));
            format!("{} linear {}", c.name, terms.collect::<Vec<_>>().join(" "))
        }
        CouplerKindDraft::Pair { by, joints } => format!("{} {} {joints:?}", c.name, by.name()),
    });
    let drivers = d.drivers.iter().map(|x| match &x.drives {
        DrivenDraft::Coordinate { joint, coordinate } => {
            format!("{} {joint}.{}", x.name, coordinate.as_deref().unwrap_or(""))
        }
        DrivenDraft::Position { point, .. } => format!("{} position {point:?}", x.name),
        DrivenDraft::Distance { from, to } => format!("{} distance {from:?} {to:?}", x.name),
        DrivenDraft::Orientation { body, relative_to, .. } => {
            format!("{} orientation {body} {relative_to:?}", x.name)
        }
        DrivenDraft::Measure(measure) => format!("{} measure {measure}", x.name),
        DrivenDraft::Contact(wheel) => format!("{} contact {wheel}", x.name),
        DrivenDraft::Unread => format!("{} unread", x.name),
    });
    let changes = d.design.iter().map(|v| {
        let keeps = if v.fixed_length { " fixed length" } else { "" };
        format!("{} {:?}{keeps}", v.name, v.changes)
    });
    let list = |items: &mut dyn Iterator<Item = String>| items.collect::<Vec<_>>().join("; ");
    format!(
        "  {} bodies, times {:?}\n  joints: {}\n  couplers: {}\n  drivers: {}\n  design: {}",
        d.bodies.len(),
        d.times,
        list(&mut joints.into_iter()),
        list(&mut couplers.into_iter()),
        list(&mut drivers.into_iter()),
        list(&mut changes.into_iter())
    ) + &format!("\n  measures: {:?}", d.measures)
}
