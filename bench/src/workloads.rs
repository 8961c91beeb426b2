//! The workloads of the comparison with other systems (`docs/performance.md`), run and timed by Hardpoint on one
//! thread.

use std::cell::{Cell, RefCell};
use std::fmt;
use std::fs;
use std::hint::black_box;
use std::io;
use std::path::Path;
use std::str::FromStr;
use std::time::Duration;

use hardpoint::model::{BodyId, GROUND, Model, VariableId};
use hardpoint::motion::{BodyState, Motion};
use hardpoint::sensitivity::{BodySensitivity, Sensitivities};
use hardpoint::space::Vec3;
use hardpoint::{Analysis, Run, Sink, Solution, StreamSummary};

use crate::designs::{DESIGNS, designs};

/// Output times of W4.
const DESIGN_STEPS: usize = 101;
/// Designs of W4s that the floor keeps for comparison: the first ones.
const DESIGNS_COMPARED: usize = 8;
/// Hardpoint coordinates of W2.
const COORDINATES: usize = 24;
/// Numbers of a body's state in the files of the floor: r(3) A(9, row by row) v(3) omega(3) a(3) alpha(3).
const STATE: usize = 24;

/// Work to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Workload {
    /// A slider-crank, 2001 steps; with its 6 sensitivities or without.
    SliderCrank {
        /// True if with sensitivities: W1s.
        sensitivities: bool,
    },
    /// A MacPherson strut, 1001 steps; with its 24 sensitivities or without.
    Strut {
        /// True if with sensitivities: W2s.
        sensitivities: bool,
    },
    /// A chain of that many four-bars, 201 steps.
    Chain(usize),
    /// A thousand designs of the strut, 101 steps each; with 24 sensitivities each or without.
    Designs {
        /// True if with sensitivities: W4s.
        sensitivities: bool,
    },
}

impl Workload {
    /// All, in the order of the tables.
    pub const ALL: [Self; 10] = [
        Self::SliderCrank { sensitivities: false },
        Self::SliderCrank { sensitivities: true },
        Self::Strut { sensitivities: false },
        Self::Strut { sensitivities: true },
        Self::Chain(1),
        Self::Chain(10),
        Self::Chain(100),
        Self::Chain(1000),
        Self::Designs { sensitivities: false },
        Self::Designs { sensitivities: true },
    ];
}

impl fmt::Display for Workload {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (number, sensitivities) = match *self {
            Self::SliderCrank { sensitivities } => (1, sensitivities),
            Self::Strut { sensitivities } => (2, sensitivities),
            Self::Chain(loops) => return write!(f, "W3-{loops}"),
            Self::Designs { sensitivities } => (4, sensitivities),
        };
        write!(f, "W{number}{}", if sensitivities { "s" } else { "" })
    }
}

impl FromStr for Workload {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let names = Self::ALL.map(|w| w.to_string());
        let found = names.iter().position(|n| n == name);
        found
            .map(|k| Self::ALL[k])
            .ok_or_else(|| format!("no workload {name}; there are {}", names.join(" ")))
    }
}

/// Cost of a workload, and the difference of its results from the reference.
#[derive(Clone, Copy, Debug)]
pub struct Figures {
    /// Median CPU time of this thread per output time, us.
    pub us_per_step: f64,
    /// Largest deviations of position, velocity and acceleration, or of their sensitivities; SI units.
    pub errors: Option<[f64; 3]>,
}

impl Figures {
    /// One line of JSON, in the manner of the peers.
    pub fn json(&self, workload: Workload) -> String {
        let mut line = format!(
            r#"{{"peer": "hardpoint", "workload": "{workload}", "us_per_step": {}"#,
            self.us_per_step
        );
        if let Workload::Designs { .. } = workload {
            line += &format!(r#", "designs_steps_per_s": {:.4e}"#, 1e6 / self.us_per_step);
        }
        let sensitivities = workload.to_string().ends_with('s');
        for (error, level) in self.errors.iter().flatten().zip(["pos", "vel", "acc"]) {
            line += &format!(r#", "{}err_{level}": {error:.3e}"#, if sensitivities { "s" } else { "" });
        }
        line + "}"
    }
}

/// Runs a workload until the median of its time is trustworthy, or once only, and compares its results with the files
/// that the floor left in the folder `reference`. Chains are compared with their closed form, for which no folder is
/// needed.
///
/// # Errors
/// Where a file of the reference is missing or of another size.
///
/// # Panics
/// Where a mechanism does not run to its end.
pub fn measure(workload: Workload, reference: Option<&Path>, once: bool) -> io::Result<Figures> {
    let file =
        |name: &str, numbers: usize| reference.map(|folder| numbers_of(folder, name, numbers)).transpose();
    let (us_per_step, errors) = match workload {
        Workload::SliderCrank { sensitivities } => single("w1", "W1", sensitivities, file, once)?,
        Workload::Strut { sensitivities } => single("w2", "W2", sensitivities, file, once)?,
        Workload::Chain(loops) => {
            let model = Model::from_draft(&crate::chain(loops, 200)).expect("a valid chain");
            let analysis = crate::analysis(&model);
            let mut solution = Solution::default();
            let time =
                timed(once, || finished(&mut solution, |run| analysis.solve(run.without_sensitivities())));
            (per_step(time, model.times.len()), Some(chain_errors(&model, &solution.motion)))
        }
        Workload::Designs { sensitivities: false } => {
            let numbers = DESIGNS * DESIGN_STEPS * 4 * STATE;
            let (time, errors) = moved_designs(file("W4", numbers)?.as_deref(), once);
            (per_step(time, DESIGNS * DESIGN_STEPS), errors)
        }
        Workload::Designs { sensitivities: true } => {
            let numbers = DESIGNS_COMPARED * DESIGN_STEPS * 4 * STATE * COORDINATES;
            let (time, errors) = moved_designs_with_sensitivities(file("W4S", numbers)?.as_deref(), once);
            (per_step(time, DESIGNS * DESIGN_STEPS), errors)
        }
    };
    Ok(Figures { us_per_step, errors })
}

/// Milliseconds of CPU time that it takes to read and check the file of a chain of that many loops, and to plan its
/// solution.
///
/// # Panics
/// Where the file is refused.
pub fn plan_chain(loops: usize) -> [f64; 2] {
    let text = crate::text(&crate::chain(loops, 10));
    let read = || hardpoint_file::parse(&text, "chain.toml").unwrap_or_else(|e| panic!("{e}"));
    let reading = timed(false, || drop(black_box(read())));
    let file = read();
    let plan = || Analysis::new(&file.model).expect("a chain that can be driven").topology().unknowns();
    let planning = timed(false, || _ = black_box(plan()));
    [reading, planning].map(|time| 1e3 * time.as_secs_f64())
}

fn per_step(time: Duration, steps: usize) -> f64 {
    1e6 * time.as_secs_f64() / steps as f64
}

/// CPU time of this thread: other jobs on the machine do not count.
pub fn cpu_time() -> Duration {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(t.tv_sec as u64, t.tv_nsec as u32)
}

/// The median time of `f`, which writes its results where it wrote them before.
pub fn timed(once: bool, mut f: impl FnMut()) -> Duration {
    f(); // not counted: cold caches
    let mut times = Vec::new();
    let started = cpu_time();
    while times.is_empty() || !once && times.len() < 4000 {
        if times.len() >= 5 && cpu_time() - started > Duration::from_secs(2) {
            break;
        }
        let before = cpu_time();
        f();
        times.push(cpu_time() - before);
    }
    times.sort();
    times[times.len() / 2]
}

/// Runs the mechanism's bodies to its end, into the memory of a solution before.
///
/// # Panics
/// Where something stops it.
pub fn finished(solution: &mut Solution, solve: impl Fn(Run<'static>) -> Solution) {
    let memory = std::mem::take(black_box(&mut *solution));
    *solution = solve(Run::new().without_measures().reusing(memory));
    assert!(solution.stop.is_none(), "the mechanism stops: {:?}", solution.stop);
}

/// One design of a model of `models/`.
fn single(
    name: &str,
    reference: &str,
    sensitivities: bool,
    file: impl Fn(&str, usize) -> io::Result<Option<Vec<f64>>>,
    once: bool,
) -> io::Result<(f64, Option<[f64; 3]>)> {
    let model = crate::workload_model(name);
    let analysis = crate::analysis(&model);
    let states = model.times.len() * (model.bodies.len() - 1) * STATE;
    let mut solution = Solution::default();
    let (time, errors) = if sensitivities {
        let reference = file(&format!("{reference}S"), states * model.variables.len())?;
        let time = timed(once, || finished(&mut solution, |run| analysis.solve(run)));
        (time, reference.map(|r| sensitivity_errors(&solution.motion, &solution.sensitivities, &r)))
    } else {
        let reference = file(reference, states)?;
        let time = timed(once, || finished(&mut solution, |run| analysis.solve(run.without_sensitivities())));
        (time, reference.map(|r| motion_errors(&solution.motion, &r)))
    };
    Ok((per_step(time, model.times.len()), errors))
}

/// The strut with W4's output times and other hardpoints, as a person would write it.
fn strut(change: &[f64]) -> Model {
    let base = crate::workload_model("w2");
    let mut text = crate::workload_text("w2");
    for (point, d) in base.hardpoints.iter().zip(change.chunks(3)) {
        let line = text
            .lines()
            .find(|l| l.starts_with(&format!("{} = [", point.name)))
            .expect("the hardpoint")
            .to_owned();
        let [x, y, z] = point.position.to_array();
        let moved = format!("{} = [{:?}, {:?}, {:?}]", point.name, x + d[0], y + d[1], z + d[2]);
        text = text.replacen(&line, &moved, 1);
    }
    let text = text.replace("steps = 1000", "steps = 100");
    hardpoint_file::parse(&text, "w4.toml").unwrap_or_else(|e| panic!("{e}")).model
}

fn moved_designs(reference: Option<&[f64]>, once: bool) -> (Duration, Option<[f64; 3]>) {
    let model = strut(&[]);
    let analysis = crate::analysis(&model);
    let designs = designs();
    let run = |look: &mut (dyn FnMut(usize, &Solution) + Send)| {
        let motions = Run::new().without_sensitivities().without_measures();
        analysis.solve_designs(motions, &designs, |k, solution| {
            assert!(solution.stop.is_none(), "design {k} stops: {:?}", solution.stop);
            look(k, solution);
        });
    };
    let time = timed(once, || run(&mut |_, solution| _ = black_box(&solution.motion)));
    let errors = reference.map(|reference| {
        let mut worst = [0.0; 3];
        let each = reference.len() / DESIGNS;
        run(&mut |design, solution| {
            keep_larger(&mut worst, motion_errors(&solution.motion, &reference[design * each..][..each]));
        });
        worst
    });
    (time, errors)
}

/// Eight designs at a time, each into memory of its own for one step's results, which the next step overwrites.
fn moved_designs_with_sensitivities(reference: Option<&[f64]>, once: bool) -> (Duration, Option<[f64; 3]>) {
    let model = strut(&[]);
    let analysis = crate::analysis(&model);
    let designs = designs();
    let end = |design: usize, streamed: StreamSummary| {
        assert!(streamed.stop.is_none(), "design {design} stops: {:?}", streamed.stop);
    };
    let mut memory = Vec::new();
    let time = timed(once, || {
        let free = RefCell::new(std::mem::take(&mut memory));
        analysis.stream_designs(
            Run::new(),
            &designs,
            |_| free.borrow_mut().pop().unwrap_or_else(|| OneStep::of(&model)),
            |design, step, streamed| {
                end(design, streamed);
                free.borrow_mut().push(black_box(step));
            },
        );
        memory = free.into_inner();
    });
    let errors = reference.map(|reference| {
        let each = reference.len() / DESIGNS_COMPARED;
        let worst = Cell::new([0.0; 3]);
        let compared = |design: usize| Compared {
            step: OneStep::of(&model),
            reference: &reference[design * each..][..each],
            worst: &worst,
        };
        analysis.stream_designs(Run::new(), &designs[..DESIGNS_COMPARED], compared, |design, _, streamed| {
            end(design, streamed)
        });
        worst.get()
    });
    (time, errors)
}

/// One step's results, like the floor's reused buffer.
struct OneStep {
    states: Vec<BodyState>,
    sensitivities: Vec<BodySensitivity>,
}

impl OneStep {
    fn of(model: &Model) -> Self {
        let bodies = model.bodies.len();
        Self {
            states: vec![BodyState::at_design(model, GROUND); bodies],
            sensitivities: vec![BodySensitivity::ZERO; model.variables.len() * bodies],
        }
    }
}

impl Sink for OneStep {
    #[inline(always)]
    fn state(&mut self, _: usize, body: BodyId, state: &BodyState) {
        self.states[body.0] = *state;
    }

    #[inline(always)]
    fn sensitivity(&mut self, _: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity) {
        let bodies = self.states.len();
        self.sensitivities[variable.0 * bodies + body.0] = *derivatives;
    }
}

/// Holds every result against the reference.
struct Compared<'r> {
    step: OneStep,
    reference: &'r [f64],
    worst: &'r Cell<[f64; 3]>,
}

impl Sink for Compared<'_> {
    fn state(&mut self, k: usize, body: BodyId, state: &BodyState) {
        self.step.state(k, body, state);
    }

    fn sensitivity(&mut self, k: usize, variable: VariableId, body: BodyId, derivatives: &BodySensitivity) {
        let bodies = self.step.states.len() - 1;
        let found = sensitivity_layout(&self.step.states[body.0], derivatives);
        let first = (k * bodies + body.0 - 1) * STATE * COORDINATES + variable.0;
        let expected = self.reference[first..].iter().copied().step_by(COORDINATES).take(STATE);
        let mut worst = self.worst.get();
        keep_larger(&mut worst, deviations(&found, expected));
        self.worst.set(worst);
    }
}

// ---- comparison

fn numbers_of(folder: &Path, name: &str, numbers: usize) -> io::Result<Vec<f64>> {
    let path = folder.join(format!("ref_{name}.f64"));
    let bytes = fs::read(&path)?;
    if bytes.len() != 8 * numbers {
        let (found, path) = (bytes.len() / 8, path.display());
        return Err(io::Error::other(format!(
            "{path} holds {found} numbers, not {numbers}: run the floor again"
        )));
    }
    let (words, _) = bytes.as_chunks();
    Ok(words.iter().map(|w| f64::from_ne_bytes(*w)).collect())
}

/// A NaN is worst of all.
fn keep_larger(worst: &mut [f64; 3], errors: [f64; 3]) {
    for (w, e) in worst.iter_mut().zip(errors) {
        if !(e <= *w) {
            *w = e;
        }
    }
}

/// Deviations of a state in the layout of the floor: of position and orientation, velocities, accelerations.
fn deviations(state: &[f64; STATE], reference: impl Iterator<Item = f64>) -> [f64; 3] {
    let mut worst = [0.0; 3];
    for (k, (x, y)) in state.iter().zip(reference).enumerate() {
        let mut one = [0.0; 3];
        one[if k < 12 { 0 } else { (k - 6) / 6 }] = (x - y).abs();
        keep_larger(&mut worst, one);
    }
    worst
}

fn layout(r: Vec3, rows: [Vec3; 3], rest: [Vec3; 4]) -> [f64; STATE] {
    let mut out = [0.0; STATE];
    for (three, v) in out.chunks_exact_mut(3).zip([r].into_iter().chain(rows).chain(rest)) {
        three.copy_from_slice(&v.to_array());
    }
    out
}

fn rows(columns: [Vec3; 3]) -> [Vec3; 3] {
    let [f, g, h] = columns;
    [Vec3::new(f.x, g.x, h.x), Vec3::new(f.y, g.y, h.y), Vec3::new(f.z, g.z, h.z)]
}

fn state_layout(s: &BodyState) -> [f64; STATE] {
    layout(s.r, rows(s.rotation.cols), [s.v, s.omega, s.a, s.alpha])
}

/// The floor differentiates A, of which Hardpoint has the rotation vector: dA = skew(dpi) A.
fn sensitivity_layout(s: &BodyState, d: &BodySensitivity) -> [f64; STATE] {
    let turned = s.rotation.cols.map(|column| d.dpi.cross(column));
    layout(d.dr, rows(turned), [d.dv, d.domega, d.da, d.dalpha])
}

fn motion_errors(motion: &Motion, reference: &[f64]) -> [f64; 3] {
    let mut worst = [0.0; 3];
    let mut reference = reference.chunks_exact(STATE);
    for k in 0..motion.len() {
        for (state, expected) in motion.at(k).iter().skip(1).zip(reference.by_ref()) {
            keep_larger(&mut worst, deviations(&state_layout(&state), expected.iter().copied()));
        }
    }
    assert!(reference.next().is_none(), "the reference has more steps or bodies");
    worst
}

/// The reference holds, per time, body and number of the state, one derivative per variable.
fn sensitivity_errors(motion: &Motion, sensitivities: &Sensitivities, reference: &[f64]) -> [f64; 3] {
    let (variables, bodies) = (sensitivities.variables, motion.bodies - 1);
    assert_eq!(reference.len(), motion.len() * bodies * STATE * variables);
    let mut worst = [0.0; 3];
    for k in 0..motion.len() {
        for b in 0..variables {
            let derivatives = sensitivities.at(k, b).expect("a change that the mechanism can follow");
            for i in 0..bodies {
                let found = sensitivity_layout(&motion.at(k).body(i + 1), &derivatives.body(i + 1));
                let first = (k * bodies + i) * STATE * variables + b;
                let expected = reference[first..].iter().copied().step_by(variables).take(STATE);
                keep_larger(&mut worst, deviations(&found, expected));
            }
        }
    }
    worst
}

/// Every loop of a chain is a parallelogram: all bars turn like the first, the couplers do not turn.
fn chain_errors(model: &Model, motion: &Motion) -> [f64; 3] {
    let mut worst = [0.0; 3];
    let w = std::f64::consts::TAU;
    let o = Vec3::ZERO;
    for (k, t) in motion.times.iter().enumerate() {
        let (s, c) = (w * t).sin_cos();
        let (angle, rate, second) = (0.5 * s, 0.5 * w * c, -0.5 * w * w * s);
        let (s, c) = angle.sin_cos();
        // The top of a bar of unit length, from its pivot.
        let top = Vec3::new(-s, c, 0.0);
        let v = Vec3::new(-c, -s, 0.0) * rate;
        let a = Vec3::new(-c, -s, 0.0) * second - top * (rate * rate);
        let turned = [Vec3::new(c, -s, 0.0), Vec3::new(s, c, 0.0), Vec3::new(0.0, 0.0, 1.0)];
        let about = |x: f64| Vec3::new(0.0, 0.0, x);
        for (body, state) in model.bodies.iter().zip(motion.at(k).iter()).skip(1) {
            let expected = if let Some(pivot) = body.name.strip_prefix("bar") {
                let x: f64 = pivot.parse().expect("a number");
                let r = Vec3::new(x, 0.0, 0.0) + top * 0.5;
                layout(r, turned, [v * 0.5, about(rate), a * 0.5, about(second)])
            } else {
                let x: f64 = body.name.trim_start_matches("coupler").parse().expect("a number");
                layout(Vec3::new(x + 0.5, 0.0, 0.0) + top, Vec3::AXES, [v, o, a, o])
            };
            keep_larger(&mut worst, deviations(&state_layout(&state), expected.into_iter()));
        }
    }
    worst
}
