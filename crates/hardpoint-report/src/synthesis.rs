//! Synthesis: the task of a task file, the models of its answers, and the results as facts and tables.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::io;

use hardpoint::joint::Quantity;
use hardpoint::{Analysis, Run};
use hardpoint_file::{Diagnostic, Diagnostics, ModelFile, TaskAim, TaskFile, TaskRegion, Units, parse};
use hardpoint_study::synthesis::defects::Defect;
use hardpoint_study::synthesis::linkage::{Guide, Linkage};
use hardpoint_study::synthesis::plane::{Complex, Pose};
use hardpoint_study::synthesis::{
    Aim, Answer, EngineDeviation, Region, Rejection, Synthesis, Tally, Task, TaskError, deviation_of_engine,
};

use crate::figures::{count, error, number, rounded, symbol, with_unit};
use crate::page::Table;
use crate::record::{Column, record, write_rows};

/// Digits of the numbers in models: round-off stays far below what is checked.
const DIGITS: usize = 13;
/// Largest deviation of a model's motion from its answer, relative to the size of the task, and in rad.
const FOLLOWED: f64 = 1e-9;
/// Uniform steps of a motion, besides its poses.
const STEPS: usize = 80;
/// Design variables of a model may move its joints by this part of the size of the task.
const BOUNDS: f64 = 0.05;
/// Status of a synthesis that the caller ended.
const INTERRUPTED: &str = "interrupted";
/// Status of a synthesis without an answer.
const NONE: &str = "none";
/// Name of the guided body in models.
const COUPLER: &str = "coupler";

fn at([x, y]: [f64; 2]) -> Complex {
    Complex { x, y }
}

/// Task of a file.
pub fn task_of(file: &TaskFile) -> Task {
    let region = |of: Option<TaskRegion>| of.map(|[x, y]| Region { x, y });
    let (aim, tolerance) = match &file.aim {
        TaskAim::Poses(poses) => {
            let poses = poses.iter().map(|[x, y, angle]| Pose { at: at([*x, *y]), angle: *angle });
            (Aim::Poses(poses.collect()), None)
        }
        TaskAim::Path { points, is_closed, crank_angles, tolerance } => {
            let turns = crank_angles.as_ref().map(|angles| angles.iter().map(|a| a - angles[0]).collect());
            let points = points.iter().copied().map(at).collect();
            (Aim::Path { points, is_closed: *is_closed, turns }, *tolerance)
        }
    };
    Task {
        four_bars: file.four_bars,
        slider_cranks: file.slider_cranks,
        fixed_region: region(file.fixed_region),
        moving_region: region(file.moving_region),
        fixed_pivots: file.fixed_pivots.iter().copied().map(at).collect(),
        full_turn: file.full_turn,
        any_order: file.any_order,
        tolerance: tolerance.unwrap_or(0.0),
        answers: file.answers,
        ..Task::new(aim)
    }
}

/// Diagnostics of a task that has no synthesis.
pub fn refusal(file: &TaskFile, error: &TaskError) -> Diagnostics {
    const COUNT: &str = "HP0901";
    const NOTHING: &str = "HP0902";
    let is_path = matches!(file.aim, TaskAim::Path { .. });
    let [one, list] = if is_path { ["point", "points"] } else { ["pose", "poses"] };
    let whole = |code, message: &str| file.error(code, message, None, None);
    let diagnostic: Diagnostic = match error {
        TaskError::Count(n) if is_path => whole(COUNT, &format!("a path requires three points, and there are {n}"))
            .help("give at least three points; up to nine can be met exactly"),
        TaskError::Count(n) if *n < 3 => {
            whole(COUNT, &format!("a linkage for {} is any of infinitely many", count(*n, "pose")))
                .help("give three to five poses")
        }
        TaskError::Count(n) => whole(COUNT, &format!("no linkage passes {n} given poses exactly"))
            .note("a crank and its pins have four free coordinates, and each pose after the first takes one")
            .help("keep the five poses that matter most, or give the path of a point as `points`, which is fitted"),
        TaskError::Coincide([a, b]) => {
            let message = format!("{list} {} and {} are the same", a + 1, b + 1);
            let d = file.error(NOTHING, &message, Some(*b), None);
            match is_path {
                true => d.help("remove one of the two; `closed = true` leads from the last point to the first"),
                false => d.help(format!("remove one of the two: a linkage that has a {one} has it again")),
            }
        }
        TaskError::Translation => whole(NOTHING, "the orientation is the same in all poses")
            .note("all cranks through them are parallel and of one length: a parallelogram, which has a dead point where it is flat")
            .help("use a slide or a parallelogram with a second crank, or change the angle of one pose"),
        TaskError::OnePole(pole) => {
            let place = shown_point(file.units, *pole);
            whole(NOTHING, &format!("all poses turn about one point, {place}"))
                .help(format!("a single pin at {place} guides the body: no linkage is needed"))
        }
        TaskError::Line => whole(NOTHING, "all points of the path lie on one line")
            .note("a slider follows it exactly; the nearest four-bars have infinitely long links")
            .help("use a slider, or move a point off the line by the tolerance that the path has"),
        TaskError::Turns(n) => {
            let message = format!("there are {n} `crank_angles` for {} points", places(&file.aim));
            file.error(COUNT, &message, None, Some("crank_angles")).help("give one angle for each point")
        }
        TaskError::TurnOrder(k) => {
            let message = format!("crank angle {} does not go on in the direction of those before", k + 1);
            file.error(NOTHING, &message, None, Some("crank_angles"))
                .help("let the angles increase, or decrease, within one turn")
        }
        TaskError::FixedPivots => file
            .error(NOTHING, "given fixed pivots fit three poses only", None, Some("fixed_pivots"))
            .note("four poses leave a curve of fixed pivots, and five leave at most four points")
            .help("use `fixed_region`, or give three poses"),
        TaskError::SamePivots([a, b]) => {
            let message = format!("fixed pivots {} and {} are the same", a + 1, b + 1);
            file.error(NOTHING, &message, None, Some("fixed_pivots"))
                .help("remove one of the two: each has one crank")
        }
        TaskError::NoType => file.error(COUNT, "no type of linkage is selected", None, Some("linkages")),
    };
    file.diagnostics(vec![diagnostic])
}

/// Number of the points or poses of a task.
fn places(aim: &TaskAim) -> usize {
    match aim {
        TaskAim::Path { points, .. } => points.len(),
        TaskAim::Poses(poses) => poses.len(),
    }
}

/// A point in the units of a file.
fn shown_point(units: Units, p: Complex) -> String {
    let [x, y] = [p.x, p.y].map(|x| number(units.from_si(Quantity::Length, x)));
    format!("({x}, {y}) {}", units.length.symbol())
}

/// Times of a motion, s, and those of its poses among them.
struct Schedule {
    /// Turn of the crank at the beginning, and over the whole motion of one second, rad.
    start: f64,
    turn: f64,
    times: Vec<f64>,
    /// Output time of each pose.
    steps: Vec<usize>,
}

impl Schedule {
    fn of(answer: &Answer) -> Self {
        // Times that are nearer are one.
        const SAME: f64 = 1e-9;
        let passage = &answer.passage;
        let (start, turn) = if passage.is_full {
            let back = passage.turns.last() < passage.turns.first();
            (0.0, if back { -TAU } else { TAU })
        } else {
            let [from, to] = passage.range();
            (from, to - from)
        };
        let of_poses: Vec<f64> = passage.turns.iter().map(|t| ((t - start) / turn).clamp(0.0, 1.0)).collect();
        let uniform = (0..=STEPS).map(|k| k as f64 / STEPS as f64);
        let apart = |t: &f64| of_poses.iter().all(|p| (p - t).abs() > SAME);
        let mut times: Vec<f64> = uniform.filter(apart).chain(of_poses.iter().copied()).collect();
        times.sort_by(f64::total_cmp);
        times.dedup_by(|a, b| (*a - *b).abs() <= SAME);
        let step = |p: &f64| times.iter().position(|t| (t - p).abs() <= SAME).expect("it is one of them");
        let steps = of_poses.iter().map(step).collect();
        Self { start, turn, times, steps }
    }
}

/// Model file of an answer, which runs by itself: the motion through all poses, and what it misses of them.
pub fn model_text(task: &TaskFile, answer: &Answer, rank: usize) -> String {
    let model = AnswerModel::of(task, answer);
    let sections = [
        model.head(rank),
        model.hardpoints(),
        model.bodies(),
        model.rail(),
        model.drivers(),
        model.points(),
        model.measures(),
        model.metrics(),
        model.design(),
        model.page(),
        model.goals(),
        model.time(),
    ];
    sections.concat()
}

/// The model of an answer, whose sections are written one by one.
struct AnswerModel<'a> {
    task: &'a TaskFile,
    answer: &'a Answer,
    schedule: Schedule,
    /// The poses or points.
    targets: Vec<[f64; 3]>,
    /// Point ahead of the guided point along x of the guided body, if it has poses.
    ahead: Option<Complex>,
}

impl<'a> AnswerModel<'a> {
    fn of(task: &'a TaskFile, answer: &'a Answer) -> Self {
        let linkage = &answer.linkage;
        let ahead = match &task.aim {
            TaskAim::Poses(poses) => {
                Some(linkage.p + Complex::unit(poses[0][2]).times(0.25 * linkage.extent()))
            }
            TaskAim::Path { .. } => None,
        };
        Self { task, answer, schedule: Schedule::of(answer), targets: targets(task), ahead }
    }

    fn length(&self, x: f64) -> f64 {
        self.task.units.from_si(Quantity::Length, x)
    }

    fn angle(&self, x: f64) -> String {
        rounded(self.task.units.from_si(Quantity::Angle, x), DIGITS)
    }

    fn place(&self, p: Complex) -> String {
        // Coordinates that round-off leaves are zero.
        let least = 1e-14 * self.answer.linkage.extent();
        let coordinate =
            |x: f64| if x.abs() < least { "0".to_owned() } else { rounded(self.length(x), DIGITS) };
        format!("[{}, {}]", coordinate(p.x), coordinate(p.y))
    }

    /// Measures that the targets give, with their columns in the targets.
    fn missed(&self) -> impl Iterator<Item = (&'static str, usize)> {
        [("x", 0), ("y", 1)].into_iter().chain(self.ahead.map(|_| ("angle", 2)))
    }

    fn head(&self, rank: usize) -> String {
        let (task, kind) = (self.task, self.answer.kind.name());
        let aims = match &task.aim {
            TaskAim::Poses(poses) => count(poses.len(), "pose"),
            TaskAim::Path { points, .. } => format!("a path of {}", count(points.len(), "point")),
        };
        let mut text = format!(
            "# Answer {rank} of `hardpoint synthesize` for {}: a {kind} for {aims}.\n#\n\
             #   hardpoint run FILE         the motion, its curves and sensitivities\n\
             #   hardpoint studio FILE      change it in the browser\n\
             #   hardpoint optimize FILE    meet changed targets as well as its joints can\n\n",
            task.file_name().replace(char::is_control, " ")
        );
        let quoted = |text: &str| serde_json::to_string(text).expect("a text is plain JSON");
        let [unit, angle_unit] = [task.units.length.symbol(), task.units.angle.symbol()];
        let mu = with_unit(task.units.from_si(Quantity::Angle, self.answer.passage.transmission), angle_unit);
        let description = format!("A {kind} for {aims}; least transmission angle {mu}");
        _ = writeln!(text, "name = {}", quoted(&format!("{} {rank}", task.name)));
        _ = writeln!(text, "description = {}", quoted(&description));
        _ = writeln!(text, "units = {{ length = \"{unit}\", angle = \"{angle_unit}\" }}\nplanar = \"xy\"\n");
        text
    }

    /// Joints, the guided point, and the poses or points at rest on the frame.
    fn hardpoints(&self) -> String {
        let Linkage { a, b, c, guide, p } = self.answer.linkage;
        let guided = match guide {
            Guide::Rocker(d) => {
                vec![("C", c, "coupler and rocker"), ("D", d, "rocker on the frame")]
            }
            Guide::Slider(_) => vec![("C", c, "coupler and slider")],
        };
        let cranked = [("A", a, "crank on the frame"), ("B", b, "crank and coupler")];
        let point = ("P", p, "the guided point of the coupler");
        let ahead = self.ahead.map(|ahead| ("X", ahead, "ahead of it along x of the guided body"));
        let mut text = "[hardpoints]\n".to_owned();
        for (name, at, what) in cranked.into_iter().chain(guided).chain([point]).chain(ahead) {
            _ = writeln!(text, "{name} = {:<44} # {what}", self.place(at));
        }
        for (k, [x, y, _]) in self.targets.iter().enumerate() {
            _ = writeln!(text, "target_{} = {}", k + 1, self.place(at([*x, *y])));
        }
        text
    }

    fn bodies(&self) -> String {
        let (fixed, follower) = match self.answer.linkage.guide {
            Guide::Rocker(_) => ("\"A\", \"D\"", "rocker = [\"C\", \"D\"]"),
            Guide::Slider(_) => ("\"A\"", "slider = [\"C\"]"),
        };
        let targets: String = (1..=self.targets.len()).map(|k| format!(", \"target_{k}\"")).collect();
        let ahead = if self.ahead.is_some() { ", \"X\"" } else { "" };
        format!(
            "\n[bodies]\nground = [{fixed}{targets}]\ncrank = [\"A\", \"B\"]\n\
             {COUPLER} = [\"B\", \"C\", \"P\"{ahead}]\n{follower}\n"
        )
    }

    /// Joint of a slider.
    fn rail(&self) -> String {
        match self.answer.linkage.guide {
            Guide::Rocker(_) => String::new(),
            Guide::Slider(along) => format!(
                "\n[joints]\nrail = {{ type = \"translational\", bodies = [\"ground\", \"slider\"], at = \"C\", axis = {} }}\n",
                direction(along)
            ),
        }
    }

    fn drivers(&self) -> String {
        let Schedule { start, turn, .. } = self.schedule;
        let start = if start == 0.0 { String::new() } else { format!("{} + ", self.angle(start)) };
        let per_second = if turn.abs() == TAU && self.task.units.angle.symbol() == "rad" {
            if turn < 0.0 { "-2*pi".to_owned() } else { "2*pi".to_owned() }
        } else {
            self.angle(turn)
        };
        format!("\n[drivers]\nmotor = {{ joint = \"A\", law = \"{start}{per_second}*t\" }}\n")
    }

    fn points(&self) -> String {
        let pivot = match self.answer.linkage.guide {
            Guide::Rocker(_) => "pivot = { body = \"rocker\", at = \"D\" }\n",
            Guide::Slider(_) => "",
        };
        format!(
            "\n[points]\ncrank_pin = {{ body = \"{COUPLER}\", at = \"B\" }}\n\
             coupler_pin = {{ body = \"{COUPLER}\", at = \"C\" }}\n{pivot}"
        )
    }

    fn measures(&self) -> String {
        let mut text = "\n[measures]\ncrank = { type = \"coordinate\", joint = \"A\" }\n".to_owned();
        for axis in ["x", "y"] {
            _ = writeln!(text, "{axis} = {{ type = \"position\", point = \"P\", along = \"{axis}\" }}");
        }
        if self.ahead.is_some() {
            text += "angle = { type = \"angle\", from = [1, 0], to = [\"P\", \"X\"] }\n";
        }
        let across = match self.answer.linkage.guide {
            Guide::Rocker(_) => "[\"pivot\", \"coupler_pin\"]".to_owned(),
            Guide::Slider(along) => direction(along.left()),
        };
        _ = writeln!(
            text,
            "transmission = {{ type = \"transmission_angle\", from = [\"crank_pin\", \"coupler_pin\"], to = {across} }}"
        );
        text
    }

    fn metrics(&self) -> String {
        let times: Vec<f64> = self.schedule.steps.iter().map(|step| self.schedule.times[*step]).collect();
        let mut in_time: Vec<usize> = (0..self.targets.len()).collect();
        in_time.sort_by(|i, j| times[*i].total_cmp(&times[*j]));
        let mut text =
            "\n# Distances from the targets, which are passed at these times.\n[metrics]\n".to_owned();
        for (measure, part) in self.missed() {
            let value = |x: f64| if part == 2 { self.angle(x) } else { rounded(self.length(x), DIGITS) };
            _ = writeln!(
                text,
                "missed_{measure} = {{ of = \"{measure}\", take = \"rms_at_points\", target = ["
            );
            for k in &in_time {
                let (time, target) = (rounded(times[*k], DIGITS), value(self.targets[*k][part]));
                _ = writeln!(text, "    [{time}, {target}],");
            }
            text += "] }\n";
        }
        text + "least_transmission = { of = \"transmission\", take = \"min\" }\n"
    }

    fn design(&self) -> String {
        let bound = number(self.length(BOUNDS * self.answer.linkage.extent()));
        let rocker = match self.answer.linkage.guide {
            Guide::Rocker(_) => Some("D"),
            Guide::Slider(_) => None,
        };
        let mut text = "\n# What may change, for searches and sweeps.\n[design]\n".to_owned();
        for name in ["A", "B", "C", "P"].into_iter().chain(rocker) {
            // The direction goes with its point, so that the body turns by the pins alone.
            let what = if name == "P" && self.ahead.is_some() {
                "[\"P\", \"X\"]".to_owned()
            } else {
                format!("\"{name}\"")
            };
            _ = writeln!(text, "{name} = {{ move = {what}, along = \"xy\", bounds = [-{bound}, {bound}] }}");
        }
        text
    }

    fn page(&self) -> String {
        let angle = if self.ahead.is_some() { ", { y = [\"angle\"], over = \"crank\" }" } else { "" };
        format!(
            "\n[page]\nplots = [{{ y = [\"x\", \"y\"], over = \"crank\" }}, \
             {{ y = [\"transmission\"], over = \"crank\" }}{angle}]\n"
        )
    }

    fn goals(&self) -> String {
        let goals: Vec<String> =
            self.missed().map(|(measure, _)| format!("missed_{measure} = {{}}")).collect();
        format!("\n[optimize]\ngoals = {{ {} }}\n", goals.join(", "))
    }

    fn time(&self) -> String {
        let mut text = "\n[time]\nat = [\n".to_owned();
        for row in self.schedule.times.chunks(8) {
            let row: Vec<String> = row.iter().map(|t| rounded(*t, DIGITS)).collect();
            _ = writeln!(text, "    {},", row.join(", "));
        }
        text + "]\n"
    }
}

/// Components of a unit vector.
fn direction(v: Complex) -> String {
    format!("[{}, {}]", rounded(v.x, DIGITS), rounded(v.y, DIGITS))
}

/// Picture of an answer as SVG: its links in the first pose, the path of its point, and the poses or points.
pub fn picture(task: &TaskFile, answer: &Answer) -> String {
    const WIDTH: f64 = 300.0;
    const HEIGHT: f64 = 200.0;
    const MARGIN: f64 = 12.0;
    let of = &answer.linkage;
    let [from, to] = if answer.passage.is_full { [0.0, TAU] } else { answer.passage.range() };
    let turn = |k: usize| from + (to - from) * k as f64 / STEPS as f64;
    let path: Vec<Complex> = (0..=STEPS).map(|k| of.point(turn(k))).collect();
    let targets: Vec<Complex> = targets(task).iter().map(|[x, y, _]| at([*x, *y])).collect();
    let all: Vec<Complex> = path.iter().chain(&targets).copied().chain(of.joints()).collect();
    let range = |part: fn(&Complex) -> f64| {
        let low = all.iter().map(part).fold(f64::INFINITY, f64::min);
        (low, all.iter().map(part).fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (bottom, top)) = (range(|p| p.x), range(|p| p.y));
    let per_metre = ((WIDTH - 2.0 * MARGIN) / (right - left)).min((HEIGHT - 2.0 * MARGIN) / (top - bottom));
    let shown = |p: Complex| {
        let x = 0.5 * WIDTH + (p.x - 0.5 * (left + right)) * per_metre;
        let y = 0.5 * HEIGHT - (p.y - 0.5 * (bottom + top)) * per_metre;
        format!("{x:.1},{y:.1}")
    };
    let line = |points: &[Complex]| points.iter().map(|p| shown(*p)).collect::<Vec<_>>().join(" ");
    let dot = |p: Complex, radius: f64, style: &str| {
        let (x, y) = shown(p).split_once(',').map(|(x, y)| (x.to_owned(), y.to_owned())).unwrap_or_default();
        format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {style}/>")
    };
    let mut svg = format!("<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"the linkage\">");
    _ = write!(svg, "<polyline points=\"{}\" fill=\"none\" stroke=\"var(--accent)\"/>", line(&path));
    let coupler = line(&[of.b, of.c, of.p]);
    svg += &format!(
        "<polygon points=\"{coupler}\" fill=\"var(--rule)\" stroke=\"currentColor\" stroke-width=\"1.5\"/>"
    );
    let (rest, far) = match of.guide {
        Guide::Rocker(d) => (d, d),
        Guide::Slider(along) => {
            let half = along.times(0.1 * of.extent());
            (of.c - half, of.c + half)
        }
    };
    for link in [[of.a, of.b], [if rest == far { of.c } else { rest }, far]] {
        let link = line(&link);
        svg += &format!("<polyline points=\"{link}\" stroke=\"currentColor\" stroke-width=\"3\"/>");
    }
    for pin in of.joints() {
        let fixed = pin == of.a || matches!(of.guide, Guide::Rocker(d) if d == pin);
        let fill = if fixed { "currentColor" } else { "var(--page)" };
        svg += &dot(pin, 4.0, &format!("fill=\"{fill}\" stroke=\"currentColor\""));
    }
    targets.iter().for_each(|p| svg += &dot(*p, 3.0, "fill=\"var(--accent)\""));
    svg + "</svg>\n"
}

/// Poses or points as x, y and angle, SI.
fn targets(task: &TaskFile) -> Vec<[f64; 3]> {
    match &task.aim {
        TaskAim::Poses(poses) => poses.clone(),
        TaskAim::Path { points, .. } => points.iter().map(|[x, y]| [*x, *y, 0.0]).collect(),
    }
}

/// Model of an answer, read back from its text, and its motion by the engine compared with the answer; `None` if the
/// motion ends early or misses the answer.
///
/// # Errors
/// Returns the diagnostics of the text, which is a fault of this program.
pub fn followed_model(
    answer: &Answer,
    text: &str,
    name: &str,
    size: f64,
) -> Result<(ModelFile, Option<EngineDeviation>), Diagnostics> {
    let file = parse(text, name)?;
    let schedule = Schedule::of(answer);
    let found = Analysis::new(&file.model).ok().and_then(|analysis| {
        let solution = analysis.solve(Run::new().without_sensitivities());
        deviation_of_engine(&file.model, &solution, answer, COUPLER, &schedule.steps)
    });
    let reach = size.max(answer.linkage.extent());
    Ok((file, found.filter(|f| f.distance <= FOLLOWED * reach && f.angle <= FOLLOWED)))
}

record! {
    /// Result of a synthesis, in the units of the task. Serialised as `summary.json` of `hardpoint synthesize`.
    pub SynthesisFacts::of(file: &TaskFile, task: &Task, found: &Synthesis) {
        let units = file.units;
        let length = |x: f64| units.from_si(Quantity::Length, x);
        let poses = match &task.aim {
            Aim::Poses(poses) => poses.len(),
            Aim::Path { points, .. } => points.len(),
        };
        let is_poses = matches!(task.aim, Aim::Poses(_));
        let dyads = |n: usize| is_poses.then_some(n);
    }
    /// Program and version.
    generator: String = crate::GENERATOR.into();
    /// Kind of study.
    study: &'static str = "synthesize";
    /// Name of the task.
    task: String = file.name.clone();
    /// Name of the task file.
    file: String = file.file_name().into();
    /// `found`, `none` if no linkage fulfils the task, or `interrupted`, with the answers so far.
    status: &'static str = match (found.is_interrupted, found.answers.is_empty()) {
        (true, _) => INTERRUPTED,
        (false, true) => NONE,
        (false, false) => "found",
    };
    /// Kind of aim: `poses` or `path`.
    aim: &'static str = if is_poses { "poses" } else { "path" };
    /// Number of poses or points.
    count: usize = poses;
    /// Unit of lengths.
    length_unit: &'static str = units.length.symbol();
    /// Unit of angles.
    angle_unit: &'static str = units.angle.symbol();
    /// Size of the task: the largest distance between two poses or points.
    size: f64 = length(found.size);
    /// Number of cranks through the poses; of three or four poses, of samples of their family. `null` for a path.
    cranks: Option<usize> = dyads(found.cranks.len());
    /// Number of sliders through the poses, alike.
    sliders: Option<usize> = dyads(found.sliders.len());
    /// Numbers of four-bars; `null` if none were looked for.
    four_bars: Option<TallyFact> = task.four_bars.then(|| TallyFact::of(&found.four_bars));
    /// Numbers of slider-cranks; `null` if none were looked for.
    slider_cranks: Option<TallyFact> = task.slider_cranks.then(|| TallyFact::of(&found.slider_cranks));
    /// Answers, best first.
    answers: Vec<AnswerFact> = Vec::new();
    /// Number of answers that the engine did not reproduce; they are left out.
    not_reproduced: usize = 0;
    /// Linkages with defects, the least first.
    rejected: Vec<RejectedFact> = found.rejections.iter().map(|r| RejectedFact::of(units, r)).collect();
    /// Written files.
    files: Vec<String> = Vec::new();
    /// Duration, s.
    seconds: f64 = 0.0;
}

record! {
    /// Numbers of linkages of one type by their outcome.
    TallyFact::of(tally: &Tally) {
        let with = |defect: Defect| tally.defects[defect as usize];
    }
    /// All that were made.
    made: usize = tally.made;
    /// Those that pass the poses in another order.
    order: usize = with(Defect::Order);
    /// Those that change branch between poses.
    branch: usize = with(Defect::Branch);
    /// Those with poses on separate circuits.
    circuit: usize = with(Defect::Circuit);
    /// Those that come within 1 deg of a dead point.
    dead_point: usize = with(Defect::Singular);
    /// Those with pivots or pins outside the regions.
    outside: usize = tally.outside;
    /// Those whose crank does not turn fully, as it must.
    rocking: usize = tally.rocking;
    /// All others.
    good: usize = tally.good;
}

record! {
    /// An answer.
    pub AnswerFact::of(units: Units, rank: usize, answer: &Answer, by_engine: &EngineDeviation) {
        let length = |x: f64| units.from_si(Quantity::Length, x);
        let angle = |x: f64| units.from_si(Quantity::Angle, x);
        let place = |p: Complex| [length(p.x), length(p.y)];
        let Linkage { a, b, c, guide, p } = answer.linkage;
        let links = answer.linkage.lengths();
        let (pivot, along) = match guide {
            Guide::Rocker(d) => (Some(place(d)), None),
            Guide::Slider(along) => (None, Some([along.x, along.y])),
        };
        let [from, to] = answer.passage.range();
    }
    /// Rank from 1.
    rank: usize = rank;
    /// Type.
    kind: &'static str = answer.kind.name();
    /// Fixed pivot of the crank.
    a: [f64; 2] = place(a);
    /// Pin of crank and coupler, at the first pose or point.
    b: [f64; 2] = place(b);
    /// Pin of coupler and rocker or slider, alike.
    c: [f64; 2] = place(c);
    /// Fixed pivot of the rocker; `null` for a slider.
    d: Option<[f64; 2]> = pivot;
    /// Direction of the slider's line through C; `null` for a rocker.
    along: Option<[f64; 2]> = along;
    /// Guided point, at the first pose or point.
    p: [f64; 2] = place(p);
    /// Length of the ground link, or distance of A from the slider's line.
    ground: f64 = length(links.ground);
    /// Length of the crank.
    crank: f64 = length(links.crank);
    /// Length of the coupler from B to C.
    coupler: f64 = length(links.coupler);
    /// Length of the rocker; `null` for a slider.
    rocker: Option<f64> = links.rocker.map(length);
    /// True if the crank turns fully.
    full_turn: bool = answer.passage.is_full;
    /// Turn of the crank from the first to the last pose or point.
    crank_turn: f64 = angle(to - from);
    /// Turns of the crank at the poses or points since the first.
    turns: Vec<f64> = answer.passage.turns.iter().map(|t| angle(*t)).collect();
    /// Minimum of the transmission angle over the motion.
    transmission: f64 = angle(answer.passage.transmission);
    /// Root mean square of the distances from the points of a path; 0 for poses.
    rms: f64 = length(answer.rms);
    /// Largest distance from a point of a path; for poses the largest change of a crank's length.
    largest: f64 = length(answer.largest);
    /// Largest distance of the motion by the engine from the answer, at the poses or points.
    engine_distance: f64 = length(by_engine.distance);
    /// Largest angle between them.
    engine_angle: f64 = angle(by_engine.angle);
    /// Largest distance between two of its points.
    extent: f64 = length(answer.linkage.extent());
    /// Score by which it is ranked.
    score: f64 = answer.score;
    /// Model file.
    model: Option<String> = None;
    /// Page.
    page: Option<String> = None;
}

record! {
    /// A linkage that has all poses and does not pass them.
    RejectedFact::of(units: Units, of: &Rejection) {
        let place = |p: &Complex| [p.x, p.y].map(|x| units.from_si(Quantity::Length, x));
    }
    /// Type.
    kind: &'static str = of.linkage.kind().name();
    /// Defect: `order`, `branch`, `circuit` or `dead_point`.
    defect: &'static str = word(of.defect);
    /// A, B, C, and D if there is a rocker, at the first pose.
    joints: Vec<[f64; 2]> = of.linkage.joints().iter().map(place).collect();
}

fn word(defect: Defect) -> &'static str {
    match defect {
        Defect::Order => "order",
        Defect::Branch => "branch",
        Defect::Circuit => "circuit",
        Defect::Singular => "dead_point",
    }
}

impl TallyFact {
    /// Numbers in words, after the number of all.
    fn sentence(&self, what: &str) -> Option<String> {
        if self.made == 0 {
            return None;
        }
        let defects = Defect::ALL.map(|d| {
            let n = match d {
                Defect::Order => self.order,
                Defect::Branch => self.branch,
                Defect::Circuit => self.circuit,
                Defect::Singular => self.dead_point,
            };
            (n, d.phrase())
        });
        let others = [
            (self.rocking, "with a crank that rocks"),
            (self.outside, "outside the regions"),
            (self.good, "good"),
        ];
        let parts: Vec<String> = defects
            .into_iter()
            .chain(others)
            .filter(|(n, phrase)| *n > 0 || *phrase == "good")
            .map(|(n, phrase)| format!("{n} {phrase}"))
            .collect();
        Some(format!("{}: {}", count(self.made, what), parts.join(", ")))
    }
}

impl SynthesisFacts {
    /// Lines of the summary.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let mut rows = vec![("task", format!("{} ({})", self.task, count(self.count, self.one())))];
        if self.is_interrupted() {
            let message = match self.answers.len() {
                0 => "interrupted before an answer was found".to_owned(),
                answers => format!("interrupted: {} so far", count(answers, "answer")),
            };
            rows.push(("result", message));
        }
        if let (Some(cranks), Some(sliders)) = (self.cranks, self.sliders) {
            let mut dyads = match self.count {
                5 => format!("{cranks} of the 4 cranks are real"),
                _ => format!("{} of a family", count(cranks, "crank")),
            };
            if sliders > 0 {
                dyads += &format!(", {}", count(sliders, "slider"));
            }
            rows.push(("dyads", dyads));
        }
        let tallies = [(&self.four_bars, "four-bar"), (&self.slider_cranks, "slider-crank")];
        for (tally, what) in tallies {
            rows.extend(tally.as_ref().and_then(|t| t.sentence(what)).map(|line| ("linkages", line)));
        }
        if self.not_reproduced > 0 {
            rows.push(("left out", format!("{} that the engine does not reproduce", self.not_reproduced)));
        }
        rows
    }

    fn one(&self) -> &'static str {
        if self.aim == "poses" { "pose" } else { "point" }
    }

    /// True if the caller ended the synthesis.
    pub fn is_interrupted(&self) -> bool {
        self.status == INTERRUPTED
    }

    /// Marks a synthesis that the caller ended after the search.
    pub fn interrupt(&mut self) {
        self.status = INTERRUPTED;
    }

    /// Counts the answers that the engine did not reproduce, once the others are added. Without others the task has
    /// none.
    pub fn leave_out(&mut self, count: usize) {
        self.not_reproduced = count;
        if self.answers.is_empty() && !self.is_interrupted() {
            self.status = NONE;
        }
    }

    /// The reason why there is no answer, with an instruction.
    pub fn advice(&self) -> Option<(String, String)> {
        if !self.answers.is_empty() || self.is_interrupted() {
            return None;
        }
        if self.not_reproduced > 0 {
            let verb = if self.not_reproduced == 1 { "passes" } else { "pass" };
            let linkages = count(self.not_reproduced, "linkage");
            let what = format!("{linkages} {verb} all {} without a defect", self.plural());
            let help = format!("change a {} a little, or use lengths of the size of a mechanism", self.one());
            return Some((format!("{what}, but the engine does not reproduce the motion"), help));
        }
        if self.aim == "poses" && self.cranks.unwrap_or(0) + self.sliders.unwrap_or(0) < 2 {
            let why = match self.count {
                5 => "these five poses have no two real dyads, so that no linkage has them all",
                _ => "no two dyads of these poses are inside the regions",
            };
            let help = "change a pose a little, leave one out (four poses have infinitely many dyads), or widen the regions";
            return Some((why.into(), help.into()));
        }
        let made = |t: &Option<TallyFact>| t.as_ref().map_or(0, |t| t.made);
        if made(&self.four_bars) + made(&self.slider_cranks) == 0 {
            let (why, help) = match self.aim {
                "poses" => (
                    "the dyads of these poses make no linkage of the requested type",
                    "allow the other type in `linkages`, widen the regions, or change a pose a little",
                ),
                _ => (
                    "no linkage of the atlas comes near the path",
                    "give more points where it bends, or fewer where it does not",
                ),
            };
            return Some((why.into(), help.into()));
        }
        let sum = |part: fn(&TallyFact) -> usize| {
            [&self.four_bars, &self.slider_cranks].into_iter().flatten().map(part).sum::<usize>()
        };
        let order = if sum(|t| t.order) > 0 { "allow another order (`any_order = true`), " } else { "" };
        let full = if sum(|t| t.rocking) > 0 { "allow cranks that rock (`full_turn = false`), " } else { "" };
        let regions = if sum(|t| t.outside) > 0 { "widen the regions, " } else { "" };
        let help = match self.aim {
            "poses" => format!("{order}{full}{regions}change a pose, or leave one out"),
            _ => format!("{order}{full}{regions}or give other points"),
        };
        Some((format!("no linkage passes all {} without a defect", self.plural()), help))
    }

    fn plural(&self) -> &'static str {
        if self.aim == "poses" { "poses" } else { "points" }
    }

    /// Tables: the answers, or else the linkages with defects.
    pub fn tables(&self) -> Vec<Table> {
        let (length, angle) = (self.length_unit, self.angle_unit);
        let lengths = |x: f64| with_unit(x, length);
        let links = |f: &AnswerFact| {
            let rocker = f.rocker.map_or(String::new(), |r| format!(", {}", number(r)));
            format!("{}, {}, {}{rocker} {length}", number(f.ground), number(f.crank), number(f.coupler))
        };
        let pivots = |f: &AnswerFact| {
            let place = |p: &[f64; 2]| format!("({}, {})", number(p[0]), number(p[1]));
            std::iter::once(&f.a).chain(&f.d).map(place).collect::<Vec<_>>().join(" ")
        };
        let columns: [Column<'_, AnswerFact>; 9] = [
            ("answer", &|f| f.rank.to_string()),
            ("type", &|f| f.kind.to_owned()),
            ("ground, crank, coupler, rocker", &links),
            ("fixed pivots", &pivots),
            ("least transmission angle", &|f| with_unit(f.transmission, angle)),
            ("crank turns by", &|f| with_unit(f.crank_turn, angle)),
            ("engine", &|f| error(f.engine_distance / self.size)),
            ("rms distance", &|f| lengths(f.rms)),
            ("largest", &|f| lengths(f.largest)),
        ];
        // Poses are met exactly.
        let shown = if self.aim == "path" { &columns[..] } else { &columns[..7] };
        let note =
            "engine: largest distance of the solved motion from the answer, relative to the size of the task";
        let answers = Table::of("Answers", note, shown, self.answers.iter().cloned()).if_any();
        // With answers, those of poses with defects are only counted.
        let rejected = if answers.is_none() || self.aim == "path" { self.rejected_table() } else { None };
        answers.into_iter().chain(rejected).collect()
    }

    fn rejected_table(&self) -> Option<Table> {
        let place = |p: &[f64; 2]| format!("({}, {})", number(p[0]), number(p[1]));
        let columns: [Column<'_, RejectedFact>; 3] = [
            ("type", &|f| f.kind.to_owned()),
            ("defect", &|f| f.defect.replace('_', " ")),
            ("joints", &|f| f.joints.iter().map(place).collect::<Vec<_>>().join(" ")),
        ];
        let title = if self.aim == "path" { "Exact linkages with defects" } else { "Linkages with defects" };
        Table::of(title, "", &columns, self.rejected.iter().cloned()).if_any()
    }

    /// Writes the answers as a CSV table.
    ///
    /// # Errors
    /// If `out` cannot be written.
    pub fn write_answers(&self, out: impl io::Write, units: Units) -> csv::Result<()> {
        let [length, angle] = [Quantity::Length, Quantity::Angle].map(|q| symbol(units, q));
        let titles: Vec<String> = ["A.x", "A.y", "B.x", "B.y", "C.x", "C.y", "D.x", "D.y", "P.x", "P.y"]
            .iter()
            .map(|t| format!("{t} [{length}]"))
            .collect();
        let some = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
        let coordinate = |k: usize| {
            move |f: &AnswerFact| {
                let points = [Some(f.a), Some(f.b), Some(f.c), f.d, Some(f.p)];
                some(points[k / 2].map(|p| p[k % 2]))
            }
        };
        let coordinates: [_; 10] = std::array::from_fn(coordinate);
        let [transmission, turn] = ["transmission", "crank_turn"].map(|t| format!("{t} [{angle}]"));
        let [rms, largest] = ["rms", "largest"].map(|t| format!("{t} [{length}]"));
        let mut columns: Vec<Column<'_, AnswerFact>> =
            vec![("answer", &|f| f.rank.to_string()), ("type", &|f| f.kind.to_owned())];
        for (title, cell) in titles.iter().zip(&coordinates) {
            columns.push((title, cell));
        }
        let along = |k: usize| move |f: &AnswerFact| some(f.along.map(|a| a[k]));
        let (along_x, along_y) = (along(0), along(1));
        columns.push(("along.x", &along_x));
        columns.push(("along.y", &along_y));
        columns.push((&transmission, &|f| f.transmission.to_string()));
        columns.push((&turn, &|f| f.crank_turn.to_string()));
        columns.push((&rms, &|f| f.rms.to_string()));
        columns.push((&largest, &|f| f.largest.to_string()));
        columns.push(("score", &|f| f.score.to_string()));
        write_rows(out, &columns, self.answers.iter().cloned())
    }
}
