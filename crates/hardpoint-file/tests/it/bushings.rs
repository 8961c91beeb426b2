//! Bodies held by bushings: a five-link suspension on its subframe without any ideal joint, and a block on a bushing
//! with a coupled stiffness matrix in closed form.

use hardpoint::model::{Model, VariableId};
use hardpoint::space::{Mat3, Vec3};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Run, Solution};
use hardpoint_file::{Severity, parse};

use crate::equilibrium::{Beside, verify_all};

/// Round-off of elastic forces, relative to the largest.
const EQUILIBRIUM: f64 = 1e-11;
/// Round-off of the virtual work along travel, relative to that of the driver.
const WORK: f64 = 1e-12;
/// Positions and forces of the same model in another place or unit, relative.
const SAME: f64 = 1e-9;
/// Fourth-order differences of solved designs, relative to the derivative.
const DIFFERENCES: f64 = 1e-6;

fn model_of(text: &str) -> Model {
    parse(text, "bushings.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn solve(model: &Model, formulation: Formulation) -> Solution {
    let solution = Analysis::with(model, formulation).unwrap().run();
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    solution
}

fn value(solution: &Solution, k: usize, name: &str) -> f64 {
    let m = solution.measured.index(name).unwrap_or_else(|| panic!("{name}"));
    solution.measured.value(k, m)[0]
}

/// Place and units in which the suspension is written.
#[derive(Clone, Copy)]
struct Written {
    rot: Mat3,
    shift: Vec3,
    /// Units of length per metre, and of angle per radian, with their names.
    length: (f64, &'static str),
    angle: (f64, &'static str),
    times: &'static str,
}

const PLAIN: Written = Written {
    rot: Mat3::IDENTITY,
    shift: Vec3::ZERO,
    length: (1.0, "m"),
    angle: (1.0, "rad"),
    times: "[0, 0.1, 0.2, 0.25]",
};

/// Inner and outer ends of the rods, m.
const RODS: [(&str, [f64; 3], [f64; 3]); 5] = [
    ("upper_front", [0.15, 0.35, 0.16], [0.03, 0.66, 0.14]),
    ("upper_rear", [-0.10, 0.36, 0.17], [-0.02, 0.67, 0.15]),
    ("lower_front", [0.25, 0.30, -0.05], [0.05, 0.68, -0.10]),
    ("lower_rear", [-0.12, 0.25, -0.07], [-0.03, 0.69, -0.11]),
    ("toe", [-0.22, 0.32, 0.0], [-0.15, 0.68, -0.01]),
];
const MOUNTS: [(&str, [f64; 3]); 4] = [
    ("mount_a", [0.35, 0.15, 0.12]),
    ("mount_b", [-0.35, 0.15, 0.12]),
    ("mount_c", [0.35, -0.45, 0.12]),
    ("mount_d", [-0.35, -0.45, 0.12]),
];
const SPRING: [[f64; 3]; 2] = [[-0.05, 0.5, 0.35], [-0.06, 0.5, -0.09]];
const CENTRE: [f64; 3] = [0.0, 0.75, 0.0];
const CONTACT: [f64; 3] = [0.0, 0.75, -0.31];
const SPRING_RATE: f64 = 90_000.0;
const SPRING_PRELOAD: f64 = -4000.0;
const SIDE: f64 = 1500.0;
const BRAKE: f64 = 1000.0;

/// Stiffnesses of a bushing, N/m and N m/rad, and its preload along x, N.
struct Bushing {
    name: String,
    bodies: [String; 2],
    at: String,
    /// Hardpoints of its z and x axes; the global ones without.
    axes: Option<[[String; 2]; 2]>,
    stiffness: [f64; 6],
    preload: f64,
}

fn bushings() -> Vec<Bushing> {
    let mut all: Vec<Bushing> = MOUNTS
        .iter()
        .enumerate()
        .map(|(k, (name, _))| Bushing {
            name: format!("{name}_bush"),
            bodies: ["ground".into(), "subframe".into()],
            at: (*name).into(),
            axes: None,
            stiffness: [2.0e6, 3.0e6, 1.5e6 + 1e5 * k as f64, 300.0, 300.0, 400.0],
            preload: 0.0,
        })
        .collect();
    for (k, (rod, ..)) in RODS.iter().enumerate() {
        for (end, inner) in [("inner", true), ("outer", false)] {
            let bodies =
                if inner { ["subframe".into(), (*rod).into()] } else { [(*rod).into(), "knuckle".into()] };
            let radial = 6e6 + 1e6 * k as f64;
            all.push(Bushing {
                name: format!("{rod}_{end}_bush"),
                bodies,
                at: format!("{rod}_{end}"),
                // The bolt, and the rod.
                axes: Some([
                    [format!("{rod}_{end}"), format!("{rod}_bolt")],
                    [format!("{rod}_inner"), format!("{rod}_outer")],
                ]),
                stiffness: [radial, 0.8 * radial, 7e5, 900.0, 1100.0, 60.0],
                preload: if inner { 40.0 } else { 0.0 },
            });
        }
    }
    all
}

/// Hardpoints of the suspension, m, in its own axes.
fn hardpoints() -> Vec<(String, Vec3)> {
    let mut all: Vec<(String, Vec3)> =
        MOUNTS.iter().map(|(n, p)| ((*n).to_owned(), Vec3::from(*p))).collect();
    for (rod, inner, outer) in RODS {
        let [inner, outer] = [inner, outer].map(Vec3::from);
        all.push((format!("{rod}_inner"), inner));
        all.push((format!("{rod}_outer"), outer));
        // Bolts of both ends point at a common point, so that their axes are not parallel to rods.
        all.push((format!("{rod}_bolt"), (inner + outer) * 0.5 + Vec3::new(0.9, 0.1, 0.15)));
    }
    let others =
        [("spring_top", SPRING[0]), ("spring_foot", SPRING[1]), ("centre", CENTRE), ("contact", CONTACT)];
    all.extend(others.map(|(n, p)| (n.to_owned(), Vec3::from(p))));
    all
}

fn list(v: Vec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

fn five_link(how: &Written) -> String {
    let Written { rot, shift, length: (per_metre, length), angle: (per_radian, angle), times } = *how;
    let [x, y, z] = Vec3::AXES.map(|axis| list(rot * axis));
    let points: String = hardpoints()
        .iter()
        .map(|(name, p)| format!("{name} = {}\n", list((rot * *p + shift) * per_metre)))
        .collect();
    let rods: String = RODS.iter().map(|(rod, ..)| format!("{rod} = {{}}\n")).collect();
    let mut forces = String::new();
    for b in bushings() {
        let Bushing { name, bodies: [i, j], at, axes, stiffness, preload } = b;
        let through = |[a, b]: &[String; 2]| format!("{{ through = [\"{a}\", \"{b}\"] }}");
        let [axis, axis2] = match &axes {
            Some(axes) => [through(&axes[0]), through(&axes[1])],
            None => [z.clone(), x.clone()],
        };
        let [k_x, k_y, k_z] = [0, 1, 2].map(|k| format!("{:?}", stiffness[k] / per_metre));
        let [about_x, about_y, about_z] = [3, 4, 5].map(|k| format!("{:?}", stiffness[k] / per_radian));
        // Two numbers follow parameters, in the units of the text.
        let k_z = if name == "toe_inner_bush" { "\"soft\"".into() } else { k_z };
        let preload =
            if name == "lower_front_inner_bush" { "\"push\"".into() } else { format!("{preload:?}") };
        forces += &format!(
            "{name} = {{ type = \"bushing\", from = {{ body = \"{i}\", at = \"{at}\" }}, to = {{ body = \"{j}\", at = \"{at}\" }}, \
             axis = {axis}, axis2 = {axis2}, x = {k_x}, y = {k_y}, z = {k_z}, about_x = {about_x}, about_y = {about_y}, \
             about_z = {about_z}, preload_x = {preload} }}\n"
        );
    }
    let moves =
        |name: &str, at: &str, along: &str| format!("{name} = {{ move = \"{at}\", along = {along} }}\n");
    let design = moves("rod_end_z", "lower_front_inner", &z)
        + &moves("toe_y", "toe_outer", &y)
        + &moves("bolt_z", "upper_front_bolt", &z)
        + &moves("mount_x", "mount_b", &x);
    let measures: String = ["centre", "contact"]
        .iter()
        .flat_map(|p| {
            [("x", &x), ("y", &y), ("z", &z)].map(|(name, along)| {
                format!("{p}_{name} = {{ type = \"position\", point = \"{p}\", along = {along} }}\n")
            })
        })
        .collect();
    let (soft, rate) = (7e5 / per_metre, SPRING_RATE / per_metre);
    let bump = 0.04 * per_metre;
    format!(
        r#"
name = "five links on a subframe"
units = {{ length = "{length}", angle = "{angle}" }}
[parameters]
soft = {soft:?}
push = 40.0
[hardpoints]
{points}
[bodies]
subframe = {{}}
knuckle = {{}}
{rods}
[points]
centre = {{ body = "knuckle", at = "centre" }}
contact = {{ body = "knuckle", at = "contact" }}
[drivers]
bump = {{ point = "centre", along = {z}, law = "{bump:?}*sin(2*pi*t)" }}
[forces]
spring = {{ type = "spring", from = {{ body = "ground", at = "spring_top" }}, to = {{ body = "lower_rear", at = "spring_foot" }}, stiffness = {rate:?}, preload = {SPRING_PRELOAD:?} }}
side = {{ type = "force", at = "contact", force = {SIDE:?}, along = {y} }}
brake = {{ type = "force", at = "contact", force = {BRAKE:?}, along = {back} }}
{forces}
[equilibrium]
[design]
{design}
[measures]
bump_force = {{ type = "driver_force", driver = "bump" }}
{measures}
[time]
at = {times}
"#,
        back = list(rot * Vec3::new(-1.0, 0.0, 0.0)),
    )
}

/// Wrench on a body about its moving reference point: force, N, and moment, N m.
type Load = [Vec3; 2];

/// Solves `m . a_k = s_k` for a moment m and three axes a_k.
fn moment_of(axes: [Vec3; 3], work: [f64; 3]) -> Vec3 {
    let [a, b, c] = axes;
    let volume = a.dot(b.cross(c));
    (b.cross(c) * work[0] + c.cross(a) * work[1] + a.cross(b) * work[2]) * (1.0 / volume)
}

/// Loads on all bodies of the plain suspension at output time k, from the poses alone, without the driver; with the
/// largest force among them.
fn loads_on(model: &Model, solution: &Solution, k: usize) -> (Vec<Load>, f64) {
    let at = |name: &str| hardpoints().into_iter().find(|(n, _)| n == name).unwrap().1;
    let index = |name: &str| model.bodies.iter().position(|b| b.name == name).unwrap();
    let pose = |body: usize| {
        let state = solution.motion.at(k).body(body);
        if body == 0 { (Mat3::IDENTITY, Vec3::ZERO) } else { (state.rotation, state.r) }
    };
    let place = |body: usize, p: Vec3| {
        let (rot, r) = pose(body);
        r + rot * (p - model.bodies[body].frame.r)
    };
    let mut loads = vec![[Vec3::ZERO; 2]; model.bodies.len()];
    let mut largest = 0.0_f64;
    let mut push = |body: usize, at: Vec3, force: Vec3, moment: Vec3| {
        loads[body][0] += force;
        loads[body][1] += moment + (at - pose(body).1).cross(force);
        largest = largest.max(force.norm());
    };
    for b in bushings() {
        let [i, j] = [0, 1].map(|e| index(&b.bodies[e]));
        let frame = match &b.axes {
            None => Mat3::IDENTITY,
            Some([z, x]) => {
                let [z, x] = [z, x].map(|[a, b]| (at(b) - at(a)).unit().unwrap());
                let x = (x - z * z.dot(x)).unit().unwrap();
                Mat3 { cols: [x, z.cross(x), z] }
            }
        };
        let [a_i, a_j] = [i, j].map(|body| pose(body).0 * frame);
        let [p_i, p_j] = [i, j].map(|body| place(body, at(&b.at)));
        let d = a_i.transpose_mul(p_j - p_i);
        let m = |r: usize, c: usize| a_i.cols[r].dot(a_j.cols[c]);
        let (alpha, beta, gamma) = ((-m(1, 2)).atan2(m(2, 2)), m(0, 2).asin(), (-m(0, 1)).atan2(m(0, 0)));
        let s: Vec<f64> =
            [d.x, d.y, d.z, alpha, beta, gamma].iter().zip(b.stiffness).map(|(e, k)| -k * e).collect();
        let [x, y, z] = a_i.cols;
        let force = x * (s[0] + b.preload) + y * s[1] + z * s[2];
        // The moment does the work of s on alpha, beta and gamma, whose axes are x, y' and z''.
        let second = y * alpha.cos() + z * alpha.sin();
        let moment = moment_of([x, second, a_j.cols[2]], [s[3], s[4], s[5]]);
        push(j, p_j, force, moment);
        push(i, p_j, -force, -moment);
    }
    let foot = index("lower_rear");
    let (top, now) = (at("spring_top"), place(foot, at("spring_foot")));
    let (length, drawn) = ((top - now).norm(), (top - at("spring_foot")).norm());
    let tension = SPRING_PRELOAD + SPRING_RATE * (length - drawn);
    push(foot, now, (top - now) * (tension / length), Vec3::ZERO);
    let knuckle = index("knuckle");
    push(knuckle, place(knuckle, at("contact")), Vec3::new(-BRAKE, SIDE, 0.0), Vec3::ZERO);
    push(
        knuckle,
        place(knuckle, at("centre")),
        Vec3::new(0.0, 0.0, value(solution, k, "bump_force")),
        Vec3::ZERO,
    );
    (loads, largest)
}

#[test]
fn a_suspension_on_bushings_alone_is_in_equilibrium() {
    let model = model_of(&five_link(&PLAIN));
    assert!(model.joints.iter().all(|j| j.unnamed), "there is no joint besides that of the driver");
    let first = solve(&model_of(&five_link(&Written { times: "[0]", ..PLAIN })), Formulation::Relative);
    let iterations = first.motion.effort.equilibrium_iterations;
    assert!(iterations <= 8, "{iterations} iterations at the first position");
    let solution = solve(&model, Formulation::Relative);
    for k in 0..solution.motion.len() {
        let (loads, largest) = loads_on(&model, &solution, k);
        for (body, [force, moment]) in loads.iter().enumerate().skip(1) {
            let name = &model.bodies[body].name;
            let rest = force.norm().max(moment.norm());
            assert!(rest <= EQUILIBRIUM * largest, "{name} at {k}: {force:?} {moment:?} of {largest}");
        }
    }
    // Along the travel from one output time to the next, all forces together do no work.
    for k in 1..solution.motion.len() {
        let (loads, _) = loads_on(&model, &solution, k);
        let [before, now] = [k - 1, k].map(|k| solution.motion.at(k));
        let mut work = 0.0;
        for (body, [force, moment]) in loads.iter().enumerate().skip(1) {
            let ([a, b], turn) = ([before.body(body), now.body(body)], now.body(body).rotation);
            let difference =
                (0..3).fold(Vec3::ZERO, |sum, c| sum + a.rotation.cols[c].cross(turn.cols[c]) * 0.5);
            work += force.dot(b.r - a.r) + moment.dot(difference);
        }
        let travel = value(&solution, k, "centre_z") - value(&solution, k - 1, "centre_z");
        let of_driver = value(&solution, k, "bump_force") * travel;
        assert!(work.abs() <= WORK * of_driver.abs(), "{k}: {work} of {of_driver}");
    }
}

#[test]
fn sensitivities_of_a_suspension_on_bushings_are_those_of_solved_designs() {
    let model = model_of(&five_link(&Written { times: "[0.1]", ..PLAIN }));
    let analysis = Analysis::new(&model).unwrap();
    let here = analysis.run();
    assert_eq!(model.variables.len(), 6);
    for (v, variable) in model.variables.iter().enumerate() {
        let step = match variable.name.as_str() {
            "soft" => 2000.0,
            "push" => 2.0,
            _ => 1e-4,
        };
        let designs = Beside::new(VariableId(v), step, |design| {
            analysis.solve(Run::new().at(design).without_sensitivities())
        });
        for (m, output) in here.measured.outputs.iter().enumerate() {
            let of = |s: &Solution| s.measured.value(0, m)[0];
            let difference = designs.difference(of);
            let exact = here.measured.d(0, VariableId(v), m)[0];
            let round_off = 1e-12 * of(&here).abs() / step;
            assert!(
                (exact - difference).abs() <= DIFFERENCES * difference.abs() + round_off,
                "d {} / d {}: {exact} {difference}",
                output.name,
                variable.name
            );
        }
    }
    verify_all(&model);
}

#[test]
fn place_units_and_formulation_do_not_matter() {
    let plain = model_of(&five_link(&PLAIN));
    let here = solve(&plain, Formulation::Relative);
    let (s, c) = 0.7_f64.sin_cos();
    let about_x = Mat3 { cols: [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, c, s), Vec3::new(0.0, -s, c)] };
    let about_z = Mat3 { cols: [Vec3::new(s, c, 0.0), Vec3::new(-c, s, 0.0), Vec3::new(0.0, 0.0, 1.0)] };
    let moved = Written { rot: about_z * about_x, shift: Vec3::new(0.4, -0.3, 0.9), ..PLAIN };
    let in_mm = Written { length: (1000.0, "mm"), angle: (180.0 / std::f64::consts::PI, "deg"), ..PLAIN };
    let others = [
        ("absolute", PLAIN, Formulation::Absolute),
        ("moved", moved, Formulation::Relative),
        ("mm and deg", in_mm, Formulation::Relative),
    ];
    for (what, how, formulation) in others {
        let other = solve(&model_of(&five_link(&how)), formulation);
        for (m, output) in here.measured.outputs.iter().enumerate() {
            // Components of points and global positions differ; changes along the suspension's own axes do not.
            if output.name.contains('.') {
                continue;
            }
            let m_there = other.measured.index(&output.name).unwrap();
            for k in 0..here.motion.len() {
                let force = output.name == "bump_force";
                let change = |s: &Solution, m: usize| {
                    s.measured.value(k, m)[0] - if force { 0.0 } else { s.measured.value(0, m)[0] }
                };
                let (a, b) = (change(&here, m), change(&other, m_there));
                assert!((a - b).abs() <= SAME * (1.0 + a.abs()), "{what}: {} {a} {b}", output.name);
            }
        }
    }
}

/// Symmetric stiffness matrix with every coupling, N/m, N/rad and N m/rad.
const MATRIX: [[f64; 6]; 6] = [
    [4.0e5, 3.0e4, -2.0e4, 900.0, -2500.0, 700.0],
    [3.0e4, 3.0e5, 1.0e4, 2000.0, 600.0, -400.0],
    [-2.0e4, 1.0e4, 2.0e5, -300.0, 800.0, 1200.0],
    [900.0, 2000.0, -300.0, 150.0, 8.0, -6.0],
    [-2500.0, 600.0, 800.0, 8.0, 120.0, 5.0],
    [700.0, -400.0, 1200.0, -6.0, 5.0, 90.0],
];

/// A block on a bushing or elastic joint with coupled stiffnesses, under a force at the place of the bushing.
fn block(holds: &str, matrix: &str) -> String {
    let (joint, element) = match holds {
        "bushing" => (
            "",
            "type = \"bushing\", from = { body = \"ground\", at = \"o\" }, to = { body = \"block\", at = \"o\" }, x = 5e4, y = 0, z = 0",
        ),
        _ => (
            "hold = { type = \"fixed\", bodies = [\"ground\", \"block\"], at = \"o\" }",
            "type = \"elastic_joint\", joint = \"hold\", x = 5e4",
        ),
    };
    format!(
        r#"
name = "block"
units = {{ length = "m", angle = "rad" }}
[parameters]
couple = -2500.0
push = 1.0
[hardpoints]
o = [0.1, 0.2, 0.3]
p = [0.5, 0.1, 0.2]
[bodies]
block = {{}}
[points]
o = {{ body = "block", at = "o" }}
p = {{ body = "block", at = "p" }}
[joints]
{joint}
[forces]
holds = {{ {element}, matrix = {matrix} }}
fx = {{ type = "force", at = "o", force = "2000*push", along = "x" }}
fy = {{ type = "force", at = "o", force = "-1500*push", along = "y" }}
fz = {{ type = "force", at = "o", force = "900*push", along = "z" }}
[equilibrium]
[measures]
a = {{ type = "orientation", body = "block", angle = "cardan_1" }}
b = {{ type = "orientation", body = "block", angle = "cardan_2" }}
c = {{ type = "orientation", body = "block", angle = "cardan_3" }}
per_x = {{ type = "compliance", of = "p.y", force = "fx" }}
[time]
at = [0]
"#
    )
}

/// Rows of the matrix as text, with a parameter in the place of one coupling.
fn matrix_text() -> String {
    let entry = |r: usize, c: usize| match (r.min(c), r.max(c)) {
        (0, 4) => "\"couple\"".to_owned(),
        _ => format!("{:?}", MATRIX[r][c]),
    };
    let row = |r: usize| format!("[{}]", (0..6).map(|c| entry(r, c)).collect::<Vec<_>>().join(", "));
    format!("[{}]", (0..6).map(row).collect::<Vec<_>>().join(", "))
}

#[test]
fn a_coupled_stiffness_matrix_has_its_closed_form() {
    // A force at the bushing works on displacements alone: K e = (F, 0).
    let mut k: Vec<Vec<f64>> = MATRIX.iter().map(|row| row.to_vec()).collect();
    k[0][0] += 5e4;
    let mut e = vec![2000.0, -1500.0, 900.0, 0.0, 0.0, 0.0];
    for pivot in 0..6 {
        let (above, below) = k.split_at_mut(pivot + 1);
        for (n, row) in below.iter_mut().enumerate() {
            let factor = row[pivot] / above[pivot][pivot];
            (0..6).for_each(|c| row[c] -= factor * above[pivot][c]);
            e[pivot + 1 + n] -= factor * e[pivot];
        }
    }
    for row in (0..6).rev() {
        let known: f64 = (row + 1..6).map(|c| k[row][c] * e[c]).sum();
        e[row] = (e[row] - known) / k[row][row];
    }
    assert!(e[3..].iter().all(|turn| turn.abs() > 1e-3), "{e:?}");
    for holds in ["bushing", "elastic_joint"] {
        let model = model_of(&block(holds, &matrix_text()));
        for formulation in [Formulation::Relative, Formulation::Absolute] {
            let solution = solve(&model, formulation);
            let at = [0.1, 0.2, 0.3];
            for (n, name) in ["o.x", "o.y", "o.z", "a", "b", "c"].iter().enumerate() {
                let expected = e[n] + at.get(n).copied().unwrap_or(0.0);
                let found = value(&solution, 0, name);
                assert!(
                    (found - expected).abs() <= 1e-13,
                    "{holds}: {name} is {found} instead of {expected}"
                );
            }
        }
        assert_eq!(model.variables.len(), 2);
        verify_all(&model);
    }
}

#[test]
fn compliance_of_a_coupled_joint_is_the_same_with_and_without_equilibrium() {
    let text = block("elastic_joint", &matrix_text());
    let without_force = text.replace("push = 1.0", "push = 0.0");
    let rigid =
        without_force.replace("[equilibrium]", "").replace("force = \"fx\" }", "at = \"o\", along = \"x\" }");
    let found = [rigid, without_force.replace("2000*push", "1e-9 + push")].map(|text| {
        let solution = solve(&model_of(&text), Formulation::Relative);
        value(&solution, 0, "per_x")
    });
    assert!((found[0] - found[1]).abs() <= 1e-9 * found[0].abs(), "{found:?}");
}

#[test]
fn faults_are_reported() {
    let texts = [
        // Not symmetric
        block("bushing", &matrix_text().replacen("30000.0", "30001.0", 1)),
        // Five rows, and a row of five
        block("bushing", &matrix_text().replacen(", 700.0", "", 1)),
        block("bushing", "[[1, 0, 0, 0, 0, 0]]"),
        // Not positive definite
        block("elastic_joint", &matrix_text().replacen("30000.0", "900000.0", 2)),
        // A body on a bushing without equilibrium
        block("bushing", &matrix_text()).replace("[equilibrium]", "").replace("per_x", "#per_x"),
        // A body on nothing
        block("bushing", &matrix_text()).replace("[bodies]", "[bodies]\nloose = {}"),
    ];
    let found: Vec<String> = texts
        .iter()
        .map(|text| parse(text, "block.toml").err().map_or("none".into(), |e| e.to_string()))
        .collect();
    snapshot_all("bushing_faults", &found);
}

/// Takes a snapshot of diagnostics.
pub(crate) fn snapshot_all(name: &str, found: &[String]) {
    assert!(found.iter().all(|f| f != "none"), "{found:?}");
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!(name, found.join("\n\n"));
    });
}

/// An arm on two coaxial joints under a load and a spring beside their axis. Each end is a type of joint with the
/// directions in which it gives; `cut` requests that joint to be cut.
fn arm([front, rear]: [(&str, &str); 2], is_turned: bool, cut: Option<&str>) -> String {
    let axis = |kind: &str| match kind {
        "spherical" => "",
        _ => ", axis = { through = [\"f\", \"r\"] }",
    };
    let joint = |(name, at, (kind, _)): (&str, &str, (&str, &str))| {
        let cut = if cut == Some(name) { ", cut = true" } else { "" };
        let axis = axis(kind);
        format!(
            "{name} = {{ type = \"{kind}\", bodies = [\"ground\", \"arm\"], at = \"{at}\"{axis}{cut} }}\n"
        )
    };
    let elastic = |(name, (_, gives)): (&str, (&str, &str))| match gives {
        "" => String::new(),
        gives => format!("e{name} = {{ type = \"elastic_joint\", joint = \"{name}\", {gives} }}\n"),
    };
    let mut joints = [("jf", "f", front), ("jr", "r", rear)].map(joint);
    if is_turned {
        joints.reverse();
    }
    format!(
        "name = \"arm\"\nunits = {{ length = \"mm\", angle = \"deg\" }}\n\
         [hardpoints]\nf = [150, 0, 0]\nr = [-150, 0, 20]\nt = [0, 350, -10]\ns = [0, 200, 0]\nu = [0, 180, 300]\n\
         [bodies]\narm = {{}}\n[joints]\n{}[points]\nt = {{ body = \"arm\", at = \"t\" }}\n[forces]\n{}{}\
         sp = {{ type = \"spring\", from = {{ body = \"ground\", at = \"u\" }}, to = {{ body = \"arm\", at = \"s\" }}, \
         stiffness = 40 }}\n\
         l = {{ type = \"force\", at = \"t\", force = 2000, along = [-1, 0.8, 0.6] }}\n[equilibrium]\n[time]\nat = [0]\n",
        joints.concat(),
        elastic(("jf", front)),
        elastic(("jr", rear)),
    )
}

#[test]
fn an_arm_turns_about_its_joints_whichever_are_elastic_first_or_cut() {
    const ALONG: &str = "x = 5000, y = 5000, z = 600";
    const ALL: &str = "x = 5000, y = 5000, z = 600, about_x = 30, about_y = 30";
    // Places of `t`, mm, where the potential energy is least in rotations and translations that the joints leave:
    // 1/2 sum k u^2 of the joints, 1/2 40 (L - L0)^2 of the spring, and -F . (t - t0).
    let cases = [
        ([("spherical", ALONG), ("spherical", ALONG)], Some([2.41669, 349.34241, 40.38341])),
        ([("revolute", ALONG), ("spherical", ALONG)], Some([3.09968, 349.37124, 40.18129])),
        ([("revolute", ALONG), ("spherical", "")], Some([3.34396, 349.25524, 40.15944])),
        ([("revolute", ALL), ("spherical", "")], None),
        ([("revolute", ALL), ("revolute", "")], Some([3.34396, 349.25524, 40.15944])),
        ([("revolute", ALL), ("cylindrical", "")], Some([1.010589, 349.276548, 40.068009])),
    ];
    // Digits of the places above, mm.
    const DIGITS: f64 = 1e-5;
    for (joints, expected) in cases {
        let mut first: Option<[f64; 3]> = None;
        for is_turned in [false, true] {
            for cut in [None, Some("jf"), Some("jr")] {
                for formulation in [Formulation::Relative, Formulation::Absolute] {
                    let text = arm(joints, is_turned, cut);
                    let solution = solve(&model_of(&text), formulation);
                    let place = ["t.x", "t.y", "t.z"].map(|of| 1e3 * value(&solution, 0, of));
                    for (x, expected) in place.iter().zip(expected.into_iter().flatten()) {
                        assert!((x - expected).abs() < DIGITS, "{place:?}\n{text}");
                    }
                    let first = *first.get_or_insert(place);
                    for (x, first) in place.iter().zip(first) {
                        assert!((x - first).abs() <= SAME * 350.0, "{place:?} {first:?}\n{text}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_bushing_between_two_places_is_reported() {
    let text = |to: &str| {
        format!(
            r#"
name = "apart"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ b = {{}} }}
[masses]
m = {{ type = "rigid", centre = {{ body = "b", at = [10, 0, 0] }}, mass = 1 }}
[forces]
s = {{ type = "spring", from = {{ body = "ground", at = [0, 9, 0] }}, to = {{ body = "b", at = [10, 0, 0] }}, stiffness = 1 }}
u = {{ type = "bushing", from = {{ body = "ground", at = [0, 0, 0] }}, to = {{ body = "b", at = {to} }}, x = 100, y = 100, z = 100, about_x = 10, about_y = 10, about_z = 10 }}
[equilibrium]
[points]
p = {{ body = "b", at = [10, 0, 0] }}
[time]
at = [0, 1]
"#
        )
    };
    let file = |to: &str| parse(&text(to), "apart.toml").unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(file("[0, 0, 0]").remarks, []);
    assert_eq!(file("[1e-6, 0, 0]").remarks, []);
    let apart = file("[5, 0, 0]");
    let [warning] = &apart.remarks[..] else { panic!("{:?}", apart.remarks) };
    assert_eq!((warning.code, warning.severity), ("HP0256", Severity::Warning));
    assert_eq!(warning.message, "the two points of bushing `u` are 5 mm apart");
    assert!(apart.render(warning, false).contains("apart.toml:9:1"), "{}", apart.render(warning, false));
}

#[test]
fn stiffnesses_of_bushings_and_elastic_joints_have_one_rule() {
    let text = |force: &str| {
        format!(
            r#"
name = "stiffnesses"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ arm = {{}} }}
joints.A = {{ type = "spherical", bodies = ["ground", "arm"], at = [0, 0, 0] }}
forces.f = {force}
drivers = {{ x = {{ body = "arm", about = "x", law = "0" }}, y = {{ body = "arm", about = "y", law = "0" }}, z = {{ body = "arm", about = "z", law = "0" }} }}
time = {{ at = [0, 1] }}
"#
        )
    };
    let bushing = |keys: &str| {
        text(&format!(
            "{{ type = \"bushing\", from = {{ body = \"ground\", at = [0, 0, 0] }}, to = {{ body = \"arm\", at = [0, 0, 0] }}, {keys} }}"
        ))
    };
    let joint = |keys: &str| text(&format!("{{ type = \"elastic_joint\", joint = \"A\", {keys} }}"));
    let error = |text: &str| {
        let errors = parse(text, "stiffnesses.toml").err().unwrap_or_else(|| panic!("{text}"));
        let [error] = errors.list() else { panic!("{errors}") };
        assert_eq!(error.code, "HP0252");
        error.message.clone()
    };
    let coupled = |k: f64| {
        let row = |r: usize| match r {
            0 => format!("[0, {k}, 0, 0, 0, 0]"),
            1 => format!("[{k}, 0, 0, 0, 0, 0]"),
            _ => "[0, 0, 0, 0, 0, 0]".into(),
        };
        format!("x = 100, y = 100, z = 100, matrix = [{}]", [0, 1, 2, 3, 4, 5].map(row).join(", "))
    };
    for keys in ["x = -1, y = 1, z = 1", "x = 1, y = 1, z = 1, about_y = -2"] {
        let key = if keys.contains("about_y") { "about_y" } else { "x" };
        assert_eq!(error(&bushing(keys)), format!("stiffness `{key}` of `f` is negative"));
        assert_eq!(error(&joint(keys)), format!("stiffness `{key}` of `f` is not positive"));
    }
    assert_eq!(error(&bushing(&coupled(101.0))), "the stiffness matrix of `f` is not positive semidefinite");
    assert_eq!(error(&joint(&coupled(101.0))), "the stiffness matrix of `f` is not positive definite");
    // A bushing may be free in a direction.
    for keys in ["x = 0, y = 1, z = 0, about_y = 0".to_owned(), coupled(100.0), coupled(-99.0)] {
        assert!(parse(&bushing(&keys), "stiffnesses.toml").is_ok(), "{keys}");
    }
}

#[test]
fn a_compliance_without_a_value_has_no_derivatives() {
    let model = model_of(
        r#"
name = "door"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [0, 0, 500], C = [400, 0, 250] }
bodies = { door = {} }
joints.lower = { type = "revolute", bodies = ["ground", "door"], at = "A", axis = "z" }
joints.upper = { type = "revolute", bodies = ["ground", "door"], at = "B", axis = "z" }
drivers.turn = { joint = "lower", law = "30*t" }
forces.e = { type = "elastic_joint", joint = "lower", x = 100, y = 100, z = 50 }
forces.f = { type = "elastic_joint", joint = "upper", x = 100, y = 100, z = 50 }
points.c = { body = "door", at = "C" }
measures.compliance = { type = "compliance", of = "c.z", at = "c", along = "z" }
design.C = { move = "C", along = "z" }
time = { at = [0, 1] }
"#,
    );
    let solution = Analysis::new(&model).unwrap().run();
    let m = solution.measured.index("compliance").unwrap();
    for k in 0..2 {
        assert!(solution.measured.value(k, m)[0].is_nan());
        assert!(solution.measured.d(k, VariableId(0), m)[0].is_nan());
    }
}
