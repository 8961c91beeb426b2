//! Singular positions: open design configurations with bars in line, grooves that turn back, change points; and laws
//! that count from zero with a length other than that of the design configuration.

use hardpoint::model::{Model, VariableId};
use hardpoint::motion::StopKind;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint_file::parse;

const BOTH: [Formulation; 2] = [Formulation::Relative, Formulation::Absolute];

fn model(text: &str) -> Model {
    parse(text, "singular.toml").unwrap_or_else(|e| panic!("{}", e.render(false))).model
}

fn run(model: &Model, formulation: Formulation) -> Solution {
    Analysis::with(model, formulation).unwrap().run()
}

fn value(solution: &Solution, k: usize, name: &str) -> f64 {
    solution.measured.value(k, solution.measured.index(name).unwrap())[0]
}

/// A leg in a guide, drawn at 100 mm, with the keys of the leg and of its driver.
fn leg(keys: &str, driver: &str) -> String {
    format!(
        r#"
name = "leg"
units = {{ length = "mm", angle = "deg" }}
parameters = {{ given = 110 }}
[hardpoints]
A = [0, 0, 0]
B = [100, 0, 0]
[bodies]
slide = {{}}
[joints]
guide = {{ type = "translational", bodies = ["ground", "slide"], at = "B", axis = "x" }}
leg = {{ type = "leg", bodies = ["ground", "slide"], at = ["A", "B"] {keys} }}
[drivers]
q = {{ joint = "leg", {driver} }}
[design]
B_x = {{ move = "B", along = "x" }}
B_kept = {{ move = "B", along = "x", fixed_length = true }}
[points]
B = {{ body = "slide", at = "B" }}
[measures]
real = {{ type = "distance", from = {{ body = "ground", at = "A" }}, to = {{ body = "slide", at = "B" }} }}
[time]
end = 1
steps = 1
"#
    )
}

#[test]
fn a_law_that_counts_from_zero_is_the_whole_length_in_every_design_configuration() {
    let zero = r#"counted_from = "zero", law = "120 + t""#;
    let drawing = r#"law = "20 + t""#;
    // Keys of the leg, the driver, the length at t = 0 and its derivatives by the end of the leg, made anew or kept.
    let cases = [
        ("", zero, 120.0, [0.0, 0.0]),
        (", length = 110", zero, 120.0, [0.0, 0.0]),
        (", length = \"given + 5\"", zero, 120.0, [0.0, 0.0]),
        ("", drawing, 120.0, [1.0, 0.0]),
        (", length = 110", drawing, 130.0, [0.0, 0.0]),
        (", length = \"given + 5\"", drawing, 135.0, [0.0, 0.0]),
    ];
    for (keys, driver, length, derivatives) in cases {
        let model = model(&leg(keys, driver));
        let variables = ["B_x", "B_kept"].map(|name| model.variable(name).unwrap());
        for formulation in BOTH {
            let solution = run(&model, formulation);
            assert!(solution.stop.is_none(), "{keys} {driver}: {:?}", solution.stop);
            for (k, more) in [0.0, 1.0].into_iter().enumerate() {
                let found = 1e3 * value(&solution, k, "real");
                assert!((found - length - more).abs() < 1e-9, "{keys} {driver}: {found}");
            }
            let m = solution.measured.index("real").unwrap();
            for (v, expected) in derivatives.into_iter().enumerate() {
                let found = solution.measured.d(1, variables[v], m)[0];
                assert!((found - expected).abs() < 1e-9, "{keys} {driver}, variable {v}: {found}");
            }
        }
        // Moved designs, solved anew, agree: 1 mm.
        let analysis = Analysis::new(&model).unwrap();
        for (v, derivative) in derivatives.into_iter().enumerate() {
            let mut design = vec![0.0; model.variables.len()];
            design[variables[v].0] = 1e-3;
            let moved = analysis.solve(hardpoint::Run::new().at(&design).without_sensitivities());
            let found = 1e3 * value(&moved, 0, "real");
            assert!((found - length - derivative).abs() < 1e-9, "{keys} {driver}, moved {v}: {found}");
        }
    }
}

/// Two bars on pivots at x = 0 and x = 0.3 that are to be pinned together, drawn with these tips.
fn two_bars(a: [f64; 2], b: [f64; 2]) -> String {
    format!(
        r#"
name = "two bars"
units = {{ length = "m", angle = "deg" }}
planar = "xy"
hardpoints = {{ L = [0, 0], R = [0.3, 0], a = {a:?}, b = {b:?} }}
[bodies]
left = {{}}
right = {{}}
[joints]
l = {{ type = "revolute", bodies = ["ground", "left"], at = "L" }}
r = {{ type = "revolute", bodies = ["ground", "right"], at = "R" }}
tip = {{ type = "revolute", bodies = ["left", "right"], at = ["a", "b"] }}
[points]
tip = {{ body = "left", at = "a" }}
other = {{ body = "right", at = "b" }}
[measures]
apart = {{ type = "distance", from = "tip", to = "other" }}
"#
    )
}

#[test]
fn bars_in_line_or_parallel_assemble_if_possible() {
    let cases = [
        ([0.0, -0.46], [0.3, -0.46]),
        ([0.0, 0.46], [0.3, 0.46]),
        ([0.46, 0.0], [0.76, 0.0]),
        ([-0.46, 0.0], [0.76, 0.0]),
        ([0.2, 0.0], [0.1, 0.0]),
        ([0.0, 0.2], [0.3, -0.2]),
    ];
    for (a, b) in cases {
        let model = model(&two_bars(a, b));
        let mut taken = Vec::new();
        for formulation in BOTH {
            let Ok(analysis) = Analysis::with(&model, formulation) else {
                panic!("{a:?} {b:?}: {:?}", Analysis::with(&model, formulation).err())
            };
            let solution = analysis.run();
            assert!(solution.stop.is_none(), "{a:?} {b:?}: {:?}", solution.stop);
            assert!(value(&solution, 0, "apart") < 1e-12, "{a:?} {b:?}");
            let assembly = solution.motion.assembly.as_ref().unwrap();
            taken.push((assembly.found_nearby, value(&solution, 0, "tip.x"), value(&solution, 0, "tip.y")));
        }
        let ([first, second], true) = (&taken[..], taken.len() == 2) else { panic!() };
        // Both formulations take the nearest.
        assert!(
            (first.1 - second.1).abs() < 1e-9 && (first.2 - second.2).abs() < 1e-9,
            "{a:?} {b:?}: {taken:?}"
        );
    }
}

#[test]
fn bars_that_are_too_short_stay_open_by_the_missing_length() {
    let model = model(&two_bars([0.0, -0.1], [0.3, -0.1]));
    for formulation in BOTH {
        let stop = run(&model, formulation).stop.unwrap();
        assert_eq!(stop.kind, StopKind::DoesNotAssemble);
        let open = stop.remains.first().unwrap_or_else(|| panic!("{stop:?}"));
        if formulation == Formulation::Relative {
            assert!((open.size - 0.1).abs() < 1e-6, "{open:?}");
        }
    }
}

/// A pin in a groove of a disc, led along y: its angle is s + b/n sin(n s), which turns back where 1 + b cos(n s) = 0.
fn groove(b: f64, n: f64, side: f64, steps: usize) -> String {
    let points: Vec<[f64; 3]> = (0..180)
        .map(|k| {
            let s = std::f64::consts::TAU * f64::from(k) / 180.0;
            let r = 50.0 + 6.0 * (2.0 * s).sin();
            let angle = std::f64::consts::FRAC_PI_2 + side * (s + b / n * (n * s).sin());
            [r * angle.cos(), r * angle.sin(), 0.0]
        })
        .collect();
    format!(
        r#"
name = "groove"
units = {{ length = "mm", angle = "deg" }}
[hardpoints]
O = [0, 0, 0]
P = {:?}
[bodies]
cam = {{}}
slide = {{}}
[joints]
b = {{ type = "revolute", bodies = ["ground", "cam"], at = "O", axis = "z" }}
c = {{ type = "point_on_curve", bodies = ["cam", "slide"], at = ["O", "P"], axis = "z", curve = {{ points = {points:?}, closed = true }} }}
g = {{ type = "translational", bodies = ["ground", "slide"], at = "P", axis = "y" }}
[drivers]
m = {{ joint = "b", law = "{}*t" }}
[time]
end = 1.0
steps = {steps}
"#,
        points[0],
        -360.0 * side
    )
}

#[test]
fn a_groove_that_turns_back_stops_the_motion_for_all_output_times() {
    for (b, n) in [(1.5, 6.0), (3.0, 12.0), (1.05, 3.0)] {
        for side in [1.0, -1.0] {
            let s = f64::acos(-1.0 / b) / n;
            let turns = (s + b / n * f64::sin(n * s)) / std::f64::consts::TAU;
            let mut times = Vec::new();
            for steps in [1, 3, 5, 10, 36, 200] {
                let stop = run(&model(&groove(b, n, side, steps)), Formulation::Relative).stop;
                let stop = stop.unwrap_or_else(|| panic!("{b} {n} {side}: {steps} steps cross the groove"));
                assert_eq!(stop.kind, StopKind::Limit);
                // The spline through the points deviates from the groove a little.
                assert!(
                    (stop.failed_time - turns).abs() < 2e-3,
                    "{b} {n} {side} in {steps}: {}",
                    stop.failed_time
                );
                times.push(stop.failed_time);
            }
            assert!(times.iter().all(|t| (t - times[0]).abs() < 1e-6), "{b} {n} {side}: {times:?}");
        }
    }
    // A groove that does not turn back is followed all around.
    assert!(run(&model(&groove(0.9, 6.0, 1.0, 7)), Formulation::Relative).stop.is_none());
}

/// A four-bar with its crank at A, driven by 360 deg/s, and what happens at its change points.
fn four_bar([b, c, d]: [[f64; 2]; 3], end: f64, steps: usize, at: &str) -> String {
    format!(
        r#"
name = "four-bar"
units = {{ length = "m", angle = "rad" }}
planar = "xy"
at_change_points = "{at}"
hardpoints = {{ A = [0, 0], B = {b:?}, C = {c:?}, D = {d:?} }}
bodies = {{ ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }}
drivers.motor = {{ joint = "A", law = "2*pi*t" }}
time = {{ end = {end:?}, steps = {steps} }}
measures.rocker = {{ type = "coordinate", joint = "D" }}
design.longer = {{ move = "C", along = "x" }}
"#
    )
}

#[test]
fn change_points_are_passed_on_request() {
    let parallelogram = [[0.0, 1.0], [3.0, 1.0], [3.0, 0.0]];
    // The same lengths, crossed: B and C on opposite sides of the ground.
    let crossed = {
        // tan(rocker / 2) tan(crank / 2) is constant: C is B mirrored at the perpendicular of BD, by lengths 3 and 1.
        let (dx, dy) = (3.0, -1.0);
        let (length, along) = (f64::hypot(dx, dy), 18.0 / (2.0 * f64::hypot(dx, dy)));
        let across = f64::sqrt(9.0 - along * along);
        [
            [0.0, 1.0],
            [(dx * along + dy * across) / length, 1.0 + (dy * along - dx * across) / length],
            [3.0, 0.0],
        ]
    };
    for formulation in BOTH {
        for steps in [1, 4, 7, 72, 500] {
            let stopped =
                run(&model(&four_bar(parallelogram, 1.0, steps, "stop")), formulation).stop.unwrap();
            assert_eq!(stopped.kind, StopKind::BranchChange);
            assert!(stopped.help().unwrap().contains("at_change_points = \"continue\""));
            let solution = run(&model(&four_bar(parallelogram, 1.0, steps, "continue")), formulation);
            assert!(solution.stop.is_none(), "{steps}: {:?}", solution.stop);
            for k in 0..solution.motion.len() {
                // The rocker turns like the crank.
                let ([angle, rate, acceleration], turn) = (
                    {
                        let m = solution.measured.index("rocker").unwrap();
                        solution.measured.value(k, m)
                    },
                    std::f64::consts::TAU,
                );
                assert!((angle - turn * solution.motion.times[k]).abs() < 1e-10, "{steps} at {k}: {angle}");
                assert!((rate - turn).abs() < 1e-8 * turn, "{steps} at {k}: {rate}");
                assert!(acceleration.abs() < 1e-7 * turn * turn, "{steps} at {k}: {acceleration}");
            }
            let solution = run(&model(&four_bar(crossed, 1.0, steps, "continue")), formulation);
            assert!(solution.stop.is_none(), "{steps}: {:?}", solution.stop);
            for k in 0..solution.motion.len() {
                // tan(crank / 2) tan(rocker / 2) = (3 - 1)/(3 + 1) of a crossed linkage, angles from the ground's
                // direction.
                let crank = std::f64::consts::FRAC_PI_2 + std::f64::consts::TAU * solution.motion.times[k];
                let drawn = f64::atan2(crossed[1][1], crossed[1][0] - 3.0);
                let rocker = drawn + value(&solution, k, "rocker");
                let [sine, cosine] = [f64::sin, f64::cos].map(|f| [f(0.5 * crank), f(0.5 * rocker)]);
                let first = sine[0] * sine[1] * 2.0 + cosine[0] * cosine[1];
                let second = sine[0] * cosine[1] * 2.0 + cosine[0] * sine[1];
                let third = sine[0] * cosine[1] + 2.0 * cosine[0] * sine[1];
                let fourth = sine[0] * sine[1] + 2.0 * cosine[0] * cosine[1];
                let least =
                    [first, second, third, fourth].map(f64::abs).into_iter().fold(f64::INFINITY, f64::min);
                assert!(least < 1e-8, "{steps} at {k}: {least}");
            }
        }
        // At the change point itself there is no sensitivity; on both sides there is one, and the variable can be
        // followed.
        let solution = run(&model(&four_bar(parallelogram, 1.0, 72, "continue")), formulation);
        let m = solution.measured.index("rocker").unwrap();
        let derivative = |k: usize| solution.measured.d(k, VariableId(0), m)[0];
        assert!(derivative(18).is_nan(), "{}", derivative(18));
        assert!([0, 16, 20, 30, 72].into_iter().all(|k| derivative(k).is_finite()));
        // After a whole turn the mechanism is in the design configuration again, with the sensitivities of that.
        assert!((derivative(72) - derivative(0)).abs() < 1e-8 * derivative(0).abs().max(1.0));
    }
}

#[test]
fn a_dead_point_is_not_a_change_point() {
    // A crank-rocker driven at its rocker reaches a limit, whatever the file says of change points.
    let rocker = [[0.0, 2.5], [1.0, 2.6], [3.0, 0.0]];
    let stop = run(&model(&four_bar(rocker, 1.0, 50, "continue")), Formulation::Relative).stop;
    assert_eq!(stop.map(|s| s.kind), Some(StopKind::Limit));
}

/// A parallelogram with a mass on its coupler, 1 m from the crank, driven by 360 deg/s: its bars are in line at t =
/// 0.25 and 0.75.
fn loaded_parallelogram(end: f64, steps: usize) -> String {
    format!(
        r#"
name = "parallelogram under gravity"
units = {{ length = "m", angle = "rad" }}
planar = "xy"
at_change_points = "continue"
hardpoints = {{ A = [0, 0], B = [0, 1], C = [3, 1], D = [3, 0], G = [1, 1] }}
bodies = {{ ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }}
drivers.motor = {{ joint = "A", law = "2*pi*t" }}
time = {{ end = {end:?}, steps = {steps} }}
gravity = {{ along = "-y", acceleration = 9.8 }}
points.G = {{ body = "coupler", at = "G" }}
masses.m = {{ type = "rigid", centre = "G", mass = 2 }}
[measures]
torque = {{ type = "driver_force", driver = "motor" }}
rocker_x = {{ type = "reaction", joint = "D", part = "force_x" }}
rocker_y = {{ type = "reaction", joint = "D", part = "force_y" }}
crank_y = {{ type = "reaction", joint = "A", part = "force_y" }}
"#
    )
}

#[test]
fn loads_are_right_beside_change_points_and_absent_at_them() {
    let ends = [(1.0, 4), (1.0, 8), (1.0, 73), (1.0, 400), (0.2507, 3), (0.26, 1)];
    // Last output times this little behind the change point are within the stretch that is crossed at once.
    let beside = [1e-9, 1e-7, 1e-5, 1e-4, 2e-4].map(|after| (0.25 + after, 2));
    for (end, steps) in ends.into_iter().chain(beside) {
        let model = model(&loaded_parallelogram(end, steps));
        for formulation in BOTH {
            let solution = run(&model, formulation);
            assert!(solution.stop.is_none(), "{end} in {steps}: {:?}", solution.stop);
            for (k, t) in solution.motion.times.iter().enumerate() {
                let found =
                    ["torque", "rocker_x", "rocker_y", "crank_y"].map(|name| value(&solution, k, name));
                let speed = std::f64::consts::TAU;
                let (sine, cosine) = (std::f64::consts::FRAC_PI_2 + speed * t).sin_cos();
                let nearest = f64::min((t - 0.25).abs(), (t - 0.75).abs());
                if nearest < 3e-4 {
                    assert!(found.iter().all(|x| x.is_nan()), "{t} of {end}: {found:?}");
                    continue;
                }
                // The coupler only translates, by -speed^2 (cos, sin). The rocker has no mass: its force is axial, by
                // moments about B 3 F sin = 2 (g - speed^2 sin); the driver lifts the weight.
                let lift = 2.0 * (9.8 - speed * speed * sine);
                let rocker = lift / (3.0 * sine);
                let expected = [
                    2.0 * 9.8 * cosine,
                    // The reaction of ground on the rocker is that of the rocker on the coupler.
                    rocker * cosine,
                    rocker * sine,
                    lift - rocker * sine,
                ];
                // Positions beside a change point lose digits with the distance from it, 6e-3 rad at least.
                let size = expected.iter().fold(20.0, |most: f64, x| most.max(x.abs()));
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < 1e-6 * size, "{t} of {end}: {found} for {expected}");
                }
            }
        }
    }
}

/// A linkage whose design configuration is open and singular, in the plane z = 0.
struct SingularDrawing {
    name: &'static str,
    /// Hardpoints; the last two are the places of the joint that is drawn open.
    points: &'static [(&'static str, [f64; 2])],
    /// Joints: name, type, bodies, and the axis, whose components turn with the drawing.
    joints: &'static [(&'static str, &'static str, [&'static str; 2], [f64; 3])],
    driver: &'static str,
    /// The gap that stays, m; none where it assembles.
    open: Option<f64>,
}

const Z: [f64; 3] = [0.0, 0.0, 1.0];
const FOUR_BAR: &[(&str, &str, [&str; 2], [f64; 3])] = &[
    ("A", "revolute", ["ground", "crank"], Z),
    ("B", "revolute", ["crank", "coupler"], Z),
    ("D", "revolute", ["ground", "rocker"], Z),
    ("tip", "revolute", ["coupler", "rocker"], Z),
];
const SLIDER: &[(&str, &str, [&str; 2], [f64; 3])] = &[
    ("A", "revolute", ["ground", "crank"], Z),
    ("B", "revolute", ["crank", "coupler"], Z),
    ("D", "translational", ["ground", "rocker"], [1.0, 0.0, 0.0]),
    ("tip", "revolute", ["coupler", "rocker"], Z),
];

impl SingularDrawing {
    const fn new(
        name: &'static str,
        points: &'static [(&'static str, [f64; 2])],
        joints: &'static [(&'static str, &'static str, [&'static str; 2], [f64; 3])],
        driver: &'static str,
        open: Option<f64>,
    ) -> Self {
        Self { name, points, joints, driver, open }
    }

    /// Returns its model, turned about z by an angle, then moved, then scaled.
    fn text(&self, angle: f64, [x, y]: [f64; 2], scale: f64) -> String {
        let (s, c) = angle.sin_cos();
        let (mut hardpoints, mut joints, mut bodies) = (String::new(), String::new(), Vec::<&str>::new());
        for (name, [px, py]) in self.points {
            let at = [scale * (c * px - s * py + x), scale * (s * px + c * py + y), 0.0];
            hardpoints += &format!("{name} = {at:?}\n");
        }
        for (name, kind, [i, j], [ax, ay, az]) in self.joints {
            let at = if *name == "tip" { r#"["tip_i", "tip_j"]"#.to_owned() } else { format!("{name:?}") };
            let axis = [c * ax - s * ay, s * ax + c * ay, *az];
            let axis = if *kind == "spherical" { String::new() } else { format!(", axis = {axis:?}") };
            joints += &format!("{name} = {{ type = {kind:?}, bodies = [{i:?}, {j:?}], at = {at}{axis} }}\n");
            bodies.extend([*i, *j].into_iter().filter(|b| *b != "ground"));
        }
        bodies.sort_unstable();
        bodies.dedup();
        let bodies: String = bodies.iter().map(|b| format!("{b} = {{}}\n")).collect();
        let driver = match self.driver {
            "" => String::new(),
            joint => format!("[drivers]\nmotor = {{ joint = {joint:?}, law = \"0\" }}\n"),
        };
        let [i, j] = self.joints.iter().find(|j| j.0 == "tip").unwrap().2;
        format!(
            r#"
name = {:?}
units = {{ length = "m", angle = "rad" }}
time = {{ end = 1, steps = 1 }}
[hardpoints]
{hardpoints}[bodies]
{bodies}[joints]
{joints}{driver}[points]
tip = {{ body = {i:?}, at = "tip_i" }}
other = {{ body = {j:?}, at = "tip_j" }}
[measures]
apart = {{ type = "distance", from = "tip", to = "other" }}
"#,
            self.name
        )
    }
}

const SINGULAR_DRAWINGS: &[SingularDrawing] = &[
    SingularDrawing::new(
        "a folded four-bar",
        &[("A", [0., 0.]), ("B", [2., 0.]), ("D", [3., 0.]), ("tip_i", [-1., 0.]), ("tip_j", [-0.7, 0.])],
        FOUR_BAR,
        "A",
        None,
    ),
    SingularDrawing::new(
        "a folded four-bar, its rocker held beyond reach",
        &[("A", [0., 0.]), ("B", [2., 0.]), ("D", [3., 0.]), ("tip_i", [-1., 0.]), ("tip_j", [-0.7, 0.])],
        FOUR_BAR,
        "D",
        Some(0.3),
    ),
    SingularDrawing::new(
        "a four-bar in line",
        &[("A", [0., 0.]), ("B", [1., 0.]), ("D", [2., 0.]), ("tip_i", [3., 0.]), ("tip_j", [3.3, 0.])],
        FOUR_BAR,
        "A",
        None,
    ),
    SingularDrawing::new(
        "a four-bar in line, open across",
        &[("A", [0., 0.]), ("B", [1., 0.]), ("D", [2., 0.]), ("tip_i", [3., 0.]), ("tip_j", [3., 0.3])],
        FOUR_BAR,
        "A",
        None,
    ),
    SingularDrawing::new(
        "a four-bar in line, open across, its rocker held beyond reach",
        &[("A", [0., 0.]), ("B", [1., 0.]), ("D", [2., 0.]), ("tip_i", [3., 0.]), ("tip_j", [3., 0.3])],
        FOUR_BAR,
        "D",
        // sqrt(9 + 0.09) - 3
        Some(0.014_962_688_704_276),
    ),
    SingularDrawing::new(
        "a flat parallelogram",
        &[("A", [0., 0.]), ("B", [1., 0.]), ("D", [3., 0.]), ("tip_i", [4., 0.]), ("tip_j", [4.2, 0.])],
        FOUR_BAR,
        "A",
        None,
    ),
    SingularDrawing::new(
        "a slider-crank at its dead point",
        &[("A", [0., 0.]), ("B", [1., 0.]), ("D", [2.8, 0.]), ("tip_i", [3., 0.]), ("tip_j", [2.8, 0.])],
        SLIDER,
        "D",
        None,
    ),
    SingularDrawing::new(
        "a folded slider-crank at its dead point",
        &[("A", [0., 0.]), ("B", [-1., 0.]), ("D", [1.3, 0.]), ("tip_i", [1., 0.]), ("tip_j", [1.3, 0.])],
        SLIDER,
        "D",
        None,
    ),
    SingularDrawing::new(
        "a slider-crank at its dead point, beyond reach",
        &[("A", [0., 0.]), ("B", [1., 0.]), ("D", [3.2, 0.]), ("tip_i", [3., 0.]), ("tip_j", [3.2, 0.])],
        SLIDER,
        "D",
        Some(0.2),
    ),
    SingularDrawing::new(
        "a slider-crank at its dead point, driven at its crank",
        &[("A", [0., 0.]), ("B", [1., 0.]), ("D", [3.2, 0.]), ("tip_i", [3., 0.]), ("tip_j", [3.2, 0.])],
        SLIDER,
        "A",
        None,
    ),
    SingularDrawing::new(
        "a flat spatial four-bar",
        &[("A", [0., 0.]), ("B", [1., -1.]), ("D", [3., 0.]), ("tip_i", [3., 1.]), ("tip_j", [3., 1.2])],
        &[
            ("A", "revolute", ["ground", "crank"], Z),
            ("B", "spherical", ["crank", "coupler"], Z),
            ("D", "revolute", ["ground", "rocker"], [1.0, 0.0, 0.0]),
            ("tip", "spherical", ["coupler", "rocker"], Z),
        ],
        "A",
        None,
    ),
    SingularDrawing::new(
        "two loops, the second in line",
        &[
            ("A", [0., 0.]),
            ("B", [0., 1.]),
            ("C", [2., 1.5]),
            ("D", [3., 0.]),
            ("E", [3., 1.2]),
            ("G", [6.8, 1.2]),
            ("tip_i", [5., 1.2]),
            ("tip_j", [4.8, 1.2]),
        ],
        &[
            ("A", "revolute", ["ground", "crank"], Z),
            ("B", "revolute", ["crank", "coupler"], Z),
            ("C", "revolute", ["coupler", "rocker"], Z),
            ("D", "revolute", ["ground", "rocker"], Z),
            ("E", "revolute", ["rocker", "left"], Z),
            ("G", "revolute", ["ground", "right"], Z),
            ("tip", "revolute", ["left", "right"], Z),
        ],
        "A",
        None,
    ),
    SingularDrawing::new(
        "two bars in line",
        &[("A", [0., 0.]), ("D", [0.3, 0.]), ("tip_i", [0., -0.46]), ("tip_j", [0.3, -0.46])],
        &[
            ("A", "revolute", ["ground", "left"], Z),
            ("D", "revolute", ["ground", "right"], Z),
            ("tip", "revolute", ["left", "right"], Z),
        ],
        "",
        None,
    ),
];

#[test]
fn singular_configurations_assemble_or_stay_open_by_the_missing_length() {
    let places = [
        (0.0, [0.0, 0.0], 1.0),
        (0.7, [0.0, 0.0], 1.0),
        (0.0, [5.0, -3.0], 1.0),
        (0.0, [0.0, 0.0], 1e-3),
        (0.0, [0.0, 0.0], 1e3),
        (2.1, [10.0, 20.0], 1e3),
    ];
    for drawing in SINGULAR_DRAWINGS {
        for (angle, by, scale) in places {
            let text = drawing.text(angle, by, scale);
            let model = model(&text);
            let mut assembled = Vec::new();
            // All places in one formulation, the first of small linkages in the other, whose searches take longer.
            let is_one = angle != 0.0 || by != [0.0; 2] || scale != 1.0 || drawing.joints.len() > 4;
            for formulation in BOTH.into_iter().filter(|f| *f == Formulation::Relative || !is_one) {
                let name = format!("{} at {angle}, {by:?}, {scale}, {formulation:?}", drawing.name);
                let solution = run(&model, formulation);
                let Some(open) = drawing.open else {
                    assert!(solution.stop.is_none(), "{name}: {:?}", solution.stop);
                    // Away from the origin coordinates have fewer digits.
                    assert!(value(&solution, 0, "apart") < 1e-11 * scale, "{name}");
                    let assembly = solution.motion.assembly.as_ref().unwrap();
                    // Only a mechanism that is not singular with this driver closes along the path.
                    let is_regular = drawing.name.contains("driven at its crank");
                    assert_eq!(assembly.found_nearby == 0, is_regular, "{name}: {assembly:?}");
                    let tip = |of: &Solution| ["tip.x", "tip.y", "tip.z"].map(|c| value(of, 0, c) / scale);
                    if formulation == Formulation::Relative {
                        // The same again, to the last bit.
                        assert_eq!(tip(&solution), tip(&run(&model, formulation)), "{name}");
                    }
                    assembled.push(tip(&solution));
                    continue;
                };
                let stop = solution.stop.unwrap_or_else(|| panic!("{name} assembles"));
                assert_eq!(stop.kind, StopKind::DoesNotAssemble, "{name}");
                assert!(stop.is_singular_drawing() && !stop.remains.is_empty(), "{name}: {stop:?}");
                if formulation == Formulation::Relative {
                    let found = stop.remains[0].size / scale;
                    assert!((found - open).abs() < 1e-6, "{name}: {found} stays open, not {open}");
                }
            }
            // Both formulations take the same assembly.
            for pair in assembled.windows(2) {
                let same = pair[0].iter().zip(&pair[1]).all(|(a, b)| (a - b).abs() < 1e-7);
                assert!(same, "{} at {angle}, {by:?}, {scale}: {assembled:?}", drawing.name);
            }
        }
    }
}
