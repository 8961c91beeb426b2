//! Views of mechanisms, as snapshots: couplers, drivers on points, idle rotations, redundancy, margins, assemblies,
//! jumps, and design variables of every kind.

use std::fmt::Write;

use hardpoint::law::{ConstantSpeed, Harmonic, Law};
use hardpoint::motion::SingularityKind;
use hardpoint::space::Vec3;
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint::{draft::*, model::*};
use hardpoint_file::{Diagnostic, ModelFile, Severity};
use hardpoint_report::course::Course;
use hardpoint_report::diagnose;
use hardpoint_report::facts::outline;
use hardpoint_report::page::Table;
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;
use hardpoint_report::tolerance::nominal_stop;
use hardpoint_study::{Motions, StudyCost};

/// Model in mm and degrees.
const FRAME: &str = r#"
name = "frame"
units = { length = "mm", angle = "deg" }
hardpoints = { pivot = [0, 0, 0] }
bodies = { arm = {} }
joints.hinge = { type = "revolute", bodies = ["ground", "arm"], at = "pivot", axis = "y" }
time = { end = 1.0, steps = 10 }
"#;

fn file(draft: &Draft) -> ModelFile {
    let mut file = hardpoint_file::parse(FRAME, "drawn.toml").unwrap();
    file.model = Model::from_draft(draft).unwrap();
    file
}

/// The page's payload is made too: it must not fail for any mechanism.
fn solved(file: &ModelFile) -> (Solution, Summary) {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(file, &analysis, &course);
    let page = payload(&Request::of(file, &analysis, &course, &summary));
    assert_eq!(page.margin.is_some(), summary.margin.is_some());
    (solution, summary)
}

fn body(name: &str) -> BodyDraft {
    BodyDraft::new(name)
}

fn joint(name: &str, kind: &str, bodies: [&str; 2], at: &[[f64; 3]], axis: Option<[f64; 3]>) -> JointDraft {
    let joint = JointDraft { axis: axis.map(DirectionDraft::from), ..JointDraft::new(name, kind, bodies) };
    at.iter().fold(joint, |joint, place| joint.at(*place))
}

fn driver(name: &str, joint: &str, law: Law) -> DriverDraft {
    DriverDraft::new(name, joint, law)
}

fn law(text: &str) -> Law {
    Law::parse(text).unwrap()
}

fn variable(name: &str, change: ChangeDraft) -> VariableDraft {
    VariableDraft::new(name, [change])
}

fn text(tables: &[Table], titles: &[&str]) -> String {
    let mut out = String::new();
    for table in tables.iter().filter(|t| titles.contains(&t.title.as_str())) {
        writeln!(out, "{}\n  {}", table.title, table.header.join(" | ")).unwrap();
        for row in &table.rows {
            writeln!(out, "  {}", row.join(" | ")).unwrap();
        }
    }
    out
}

fn listing(list: &[Diagnostic]) -> String {
    let mut out = String::new();
    for d in list {
        writeln!(out, "[{}] {}", d.code, d.message).unwrap();
        d.notes.iter().for_each(|n| writeln!(out, "  note: {n}").unwrap());
        d.help.iter().for_each(|h| writeln!(out, "  help: {h}").unwrap());
    }
    out
}

const Y: Option<[f64; 3]> = Some([0.0, 1.0, 0.0]);
const Z: Option<[f64; 3]> = Some([0.0, 0.0, 1.0]);

/// A pinion that drives a wheel and a rack.
fn gears() -> Draft {
    let pair = ["pinion_axle", "wheel_axle"].map(String::from);
    Draft {
        name: "gears".into(),
        bodies: ["pinion", "wheel", "rack"].map(body).into(),
        joints: vec![
            joint("pinion_axle", "revolute", ["ground", "pinion"], &[[0.0; 3]], Z),
            joint("wheel_axle", "revolute", ["ground", "wheel"], &[[0.06, 0.0, 0.0]], Z),
            joint("way", "translational", ["ground", "rack"], &[[0.0, -0.02, 0.0]], Some([1.0, 0.0, 0.0])),
        ],
        couplers: vec![
            CouplerDraft {
                name: "mesh".into(),
                kind: CouplerKindDraft::Pair {
                    by: Transmission::Gears { teeth: [20.0, 40.0], internal: false, bevel: false },
                    joints: pair,
                },
                constant: 0.0,
            },
            CouplerDraft {
                name: "teeth".into(),
                kind: CouplerKindDraft::Pair {
                    by: Transmission::Rack { radius: 0.02 },
                    joints: ["way", "pinion_axle"].map(String::from),
                },
                constant: 0.0,
            },
        ],
        drivers: vec![driver("motor", "pinion_axle", law("t"))],
        times: vec![0.0, 1.0],
        ..Draft::default()
    }
}

#[test]
fn couplers_are_written_out_in_the_users_units_and_counted() {
    let file = file(&gears());
    let (_, summary) = solved(&file);
    let facts = &summary.model;
    let tables = text(&facts.tables(), &["Couplers", "Blocks"]);
    insta::assert_snapshot!(format!("{}\n{}\n{tables}", facts.joints_text(), facts.constraints_line()));
    // 20 mm of radius make 20 * pi / 180 mm per degree.
    let rack = &facts.couplers[1];
    assert_eq!((rack.terms[0].unit, rack.terms[1].unit), ("mm", "deg"));
    let ratio = rack.terms[1].coefficient / rack.terms[0].coefficient;
    assert!((ratio.abs() - 20.0_f64.to_radians()).abs() < 1e-12, "{ratio}");
}

#[test]
fn the_constant_of_a_coupler_is_in_its_relation() {
    let linear = |constant: &str| {
        let text = FRAME.replace("arm = {}", "arm = {}, sled = {}")
            + r#"
joints.slide = { type = "translational", bodies = ["ground", "sled"], at = [0, 100, 0], axis = "x" }
drivers.motor = { joint = "hinge", law = "10*t" }
[couplers.k]
type = "linear"
terms = [{ joint = "slide", coefficient = 1 }, { joint = "hinge", coefficient = -2 }]
"# + constant;
        let file = hardpoint_file::parse(&text, "slide.toml").unwrap();
        let (_, summary) = solved(&file);
        summary.model.couplers[0].clone()
    };
    // In mm and degrees, as in the file.
    let fact = linear("constant = 5");
    assert_eq!((fact.relation.as_str(), fact.constant), ("slide.displacement - 2 hinge.angle = 5", 5.0));
    assert_eq!(linear("constant = -0.25").relation, "slide.displacement - 2 hinge.angle = -0.25");
    assert_eq!(linear("").relation, "slide.displacement - 2 hinge.angle = 0");
}

/// Three arms that rotate about y, each driven differently.
fn arms() -> Draft {
    let at = |x: f64, y: f64| LocationDraft::At(Vec3::new(x, y, 0.0));
    let arm = |k: usize| {
        let name = format!("arm_{k}");
        joint(&format!("hinge_{k}"), "revolute", ["ground", &name], &[[0.0, 0.1 * k as f64, 0.0]], Y)
    };
    let drives = |name: &str, drives| DriverDraft::new(name, drives, law("0.01*t"));
    Draft {
        name: "arms".into(),
        hardpoints: vec![HardpointDraft::new("tip", Vec3::new(0.1, 0.2, 0.0))],
        bodies: ["arm_1", "arm_2", "arm_3"].map(body).into(),
        joints: (1..=3).map(arm).collect(),
        drivers: vec![
            drives(
                "lift",
                DrivenDraft::Position {
                    point: PointRef::On { body: "arm_1".into(), at: at(0.1, 0.1) },
                    along: DirectionDraft::Along(Vec3::new(0.0, 0.0, 1.0)),
                },
            ),
            drives(
                "jack",
                DrivenDraft::Distance {
                    from: PointRef::On {
                        body: "ground".into(),
                        at: LocationDraft::At(Vec3::new(0.1, 0.2, -0.1)),
                    },
                    to: PointRef::On { body: "arm_2".into(), at: LocationDraft::Hardpoint("tip".into()) },
                },
            ),
            drives(
                "roll",
                DrivenDraft::Orientation {
                    body: "arm_3".into(),
                    relative_to: None,
                    about: DirectionDraft::Along(Vec3::new(0.0, 1.0, 0.0)),
                    axis2: None,
                },
            ),
        ],
        times: vec![0.0, 1.0],
        ..Draft::default()
    }
}

#[test]
fn drivers_without_a_joint_are_described_and_add_no_joint() {
    let file = file(&arms());
    let (_, summary) = solved(&file);
    let facts = &summary.model;
    assert_eq!((facts.counts.joints, facts.joints.len(), facts.counts.loops), (3, 3, 0));
    assert!(facts.bodies.iter().all(|b| b.joints.len() == 1));
    insta::assert_snapshot!(text(&facts.tables(), &["Joints", "Drivers", "Blocks"]));
    assert!(facts.drivers.iter().all(|d| d.joint.is_none()));
}

#[test]
fn a_mechanism_that_cannot_be_driven_still_has_an_outline() {
    let mut draft = gears();
    draft.drivers.clear();
    let file = file(&draft);
    assert!(Analysis::new(&file.model).is_err());
    insta::assert_snapshot!(text(&outline(&file), &["Bodies", "Joints", "Couplers", "Drivers"]));
}

/// A spatial four-bar whose rod hangs between two balls.
fn with_an_idle_rod() -> Draft {
    Draft {
        name: "idle rod".into(),
        bodies: ["crank", "rod", "rocker"].map(body).into(),
        joints: vec![
            joint("A", "revolute", ["ground", "crank"], &[[0.0; 3]], Z),
            joint("B", "spherical", ["crank", "rod"], &[[0.0, 0.1, 0.0]], None),
            joint("C", "spherical", ["rod", "rocker"], &[[0.3, 0.25, 0.05]], None),
            joint("D", "revolute", ["ground", "rocker"], &[[0.3, 0.0, 0.0]], Some([0.0, 0.2, 1.0])),
        ],
        drivers: vec![driver("motor", "A", law("0.5*sin(t)"))],
        times: (0..=10).map(|k| 0.1 * f64::from(k)).collect(),
        ..Draft::default()
    }
}

#[test]
fn an_idle_spin_is_a_note() {
    let file = file(&with_an_idle_rod());
    let (_, summary) = solved(&file);
    let notes = summary.model.all_notes().join("\n");
    insta::assert_snapshot!(format!("{notes}\n{}", text(&summary.model.tables(), &["Joints"])));
}

/// Four hinges about z; three constraints are redundant. Two such loops share no joint.
fn four_bars() -> Draft {
    let loop_of = |tag: &str, y: f64| {
        let n = |name: &str| format!("{name}{tag}");
        let (crank, coupler, rocker) = (n("crank"), n("coupler"), n("rocker"));
        vec![
            joint(&n("A"), "revolute", ["ground", &crank], &[[0.0, y, 0.0]], Z),
            joint(&n("B"), "revolute", [&crank, &coupler], &[[0.0, y + 0.1, 0.0]], Z),
            joint(&n("C"), "revolute", [&coupler, &rocker], &[[0.3, y + 0.25, 0.0]], Z),
            joint(&n("D"), "revolute", ["ground", &rocker], &[[0.3, y, 0.0]], Z),
        ]
    };
    Draft {
        name: "two four-bars".into(),
        bodies: ["crank1", "coupler1", "rocker1", "crank2", "coupler2", "rocker2"].map(body).into(),
        joints: [loop_of("1", 0.0), loop_of("2", 1.0)].concat(),
        drivers: vec![driver("one", "A1", law("0.5*sin(t)")), driver("two", "A2", law("0.5*sin(t)"))],
        times: (0..=10).map(|k| 0.1 * f64::from(k)).collect(),
        ..Draft::default()
    }
}

#[test]
fn redundant_constraints_are_named_by_loop() {
    let file = file(&four_bars());
    let (_, summary) = solved(&file);
    insta::assert_snapshot!(summary.model.all_notes().join("\n"));
    assert_eq!(summary.model.redundancy.iter().map(|r| r.count).collect::<Vec<_>>(), [3, 3]);
}

#[test]
fn the_margin_is_reported_in_digits_with_its_loop() {
    let file = file(&with_an_idle_rod());
    let (solution, summary) = solved(&file);
    let margin = summary.margin.as_ref().unwrap();
    assert_eq!(margin.series.len(), solution.motion.len());
    insta::assert_snapshot!(format!("{}\n{}", margin.line_from_start(), margin.sentence()));
}

/// One four-bar, whose crank's pin B, and pin C as given, and the angle by which its crank turns until coupler and
/// rocker are in line.
fn one_four_bar(pin: Vec3, law_of: impl Fn(f64) -> String) -> ModelFile {
    let mut draft = four_bars();
    draft.joints.truncate(4);
    draft.bodies.truncate(3);
    draft.drivers.truncate(1);
    draft.joints[2].at = vec![LocationDraft::At(pin)];
    // Coupler and rocker are in line where the crank's pin is as far from D as both are long.
    let (crank, coupler, rocker, base) = (0.1_f64, 0.2_f64, 0.02_f64.sqrt(), 0.3_f64);
    let cosine = (crank.powi(2) + base.powi(2) - (coupler + rocker).powi(2)) / (2.0 * crank * base);
    let angle = cosine.acos() - std::f64::consts::FRAC_PI_2;
    draft.drivers[0].law = law(&law_of(angle));
    file(&draft)
}

#[test]
fn a_singular_position_just_beyond_the_end_is_reported() {
    let file = one_four_bar(Vec3::new(0.2, 0.1, 0.0), |angle| format!("{:.17} * t", angle * (1.0 - 1e-5)));
    let (solution, summary) = solved(&file);
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let margin = summary.margin.as_ref().unwrap();
    assert!((margin.singular_after.unwrap() - 1e-5).abs() < 1e-8, "{margin:?}");
    assert_eq!(margin.singular_kind, Some(SingularityKind::Limit));
    let ahead = margin.ahead().unwrap();
    assert!(ahead.starts_with("A singular position is estimated to lie about 1e-5 s ("), "{ahead}");
    assert!(ahead.ends_with("beyond the end; its loop cannot be closed any further"), "{ahead}");
}

#[test]
fn a_motion_to_a_singular_position_stops_there() {
    let file = one_four_bar(Vec3::new(0.2, 0.1, 0.0), |angle| format!("{:.17} * t", angle * (1.0 - 1e-13)));
    let (solution, _) = solved(&file);
    let stop = solution.stop.unwrap();
    assert_eq!(stop.code(), "HP0401");
    assert!((stop.failed_time - 1.0).abs() < 1e-7, "{stop:?}");
}

#[test]
fn a_mechanism_next_to_a_singular_position_is_warned_of() {
    // In the design configuration, coupler and rocker are in line to within 0.1 um.
    let file = one_four_bar(Vec3::new(0.18, 0.04 + 1e-7, 0.0), |_| "0 * t".into());
    let (solution, summary) = solved(&file);
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let margin = summary.margin.as_ref().unwrap();
    assert!(margin.is_thin(), "{margin:?}");
    let shown = listing(&diagnose::all(&file, &summary, &Course::of(&file.model, &solution), None));
    assert!(
        shown.starts_with("[HP0407] the mechanism comes close to a singular position at t = "),
        "{shown}"
    );
    assert!(shown.contains("the loop consists of `B1`, `C1` and `D1`"), "{shown}");
}

/// A four-bar whose coupler is a rod of a given length; in the design configuration it would be 335.4 mm.
fn with_a_rod_of(length: f64) -> Draft {
    let mut rod = joint("rod", "distance", ["crank", "rocker"], &[[0.0, 0.1, 0.0], [0.3, 0.25, 0.0]], None);
    rod.length = Some(length);
    let harmonic = Harmonic { amplitude: 0.5, frequency: 0.2, phase: 0.0, offset: 0.0 };
    let law_of =
        |parameter: &str| ChangeDraft::Law { driver: "motor".into(), parameter: parameter.into(), rate: 1.0 };
    Draft {
        name: "four-bar with a rod".into(),
        bodies: ["crank", "rocker"].map(body).into(),
        joints: vec![
            joint("A", "revolute", ["ground", "crank"], &[[0.0; 3]], Z),
            joint("D", "revolute", ["ground", "rocker"], &[[0.3, 0.0, 0.0]], Z),
            rod,
        ],
        drivers: vec![driver("motor", "A", Law::harmonic(harmonic).unwrap())],
        design: vec![
            variable("longer", ChangeDraft::Length { joint: "rod".into(), rate: 1.0 }),
            variable("shorter", ChangeDraft::Length { joint: "rod".into(), rate: -2.0 }),
            variable("swing", law_of("amplitude")),
            variable("frequency", law_of("frequency")),
        ],
        measures: vec![MeasureDraft::new("rocker", "D")],
        times: (0..=20).map(|k| 0.1 * f64::from(k)).collect(),
        ..Draft::default()
    }
}

#[test]
fn an_assembly_is_shown_with_gaps_and_moves() {
    let file = file(&with_a_rod_of(0.4));
    let (_, summary) = solved(&file);
    let assembly = summary.assembly.as_ref().unwrap();
    insta::assert_snapshot!(text(&assembly.tables(), &["Assembled", "Moved by the assembly"]));
    // Constraints that are closed in the design configuration are not reported.
    let (_, fits) = solved(&self::file(&with_a_rod_of(0.1125_f64.sqrt())));
    assert!(fits.assembly.is_none());
}

#[test]
fn a_mechanism_that_does_not_assemble_reports_its_gaps() {
    let file = file(&with_a_rod_of(0.7));
    let (solution, summary) = solved(&file);
    insta::assert_snapshot!(listing(&diagnose::all(
        &file,
        &summary,
        &Course::of(&file.model, &solution),
        None
    )));
    let stop = summary.stop.as_ref().unwrap();
    assert_eq!((stop.remains[0].kind, stop.remains[0].unit), ("joint", "mm"));
    // The rod reaches from B past D by the rocker's 250 mm.
    assert!((stop.remains[0].size - (700.0 - 100.0 * 10.0_f64.sqrt() - 250.0)).abs() < 1e-3);
}

#[test]
fn variables_of_lengths_and_laws_are_described_with_their_units() {
    let mut draft = with_a_rod_of(0.1125_f64.sqrt());
    let file_ = file(&draft);
    let (_, summary) = solved(&file_);
    let shown = |s: &Summary| -> String {
        let row =
            |v: &hardpoint_report::facts::VariableFact| format!("{} [{}] {}\n", v.name, v.unit, v.change);
        s.model.variables.iter().map(row).collect()
    };
    let mut out = shown(&summary);
    // One of the variable is 1 deg/s where the change says so, and 1 rad/s where it says that.
    draft.drivers[0].law = Law::constant_speed(ConstantSpeed { speed: 0.2, offset: 0.0 }).unwrap();
    let speed = |name: &str, rate: f64| {
        let change = ChangeDraft::Law { driver: "motor".into(), parameter: "speed".into(), rate };
        variable(name, change)
    };
    draft.design =
        vec![speed("in_degrees", 1.0_f64.to_radians()), speed("in_si", 1.0), speed("in_neither", 0.3)];
    let (_, summary) = solved(&file(&draft));
    out += &shown(&summary);
    let ranked = &summary.sensitivities[0].largest;
    out += &ranked.iter().map(|r| format!("{} in {}\n", r.variable, r.unit)).collect::<String>();
    insta::assert_snapshot!(out);
}

#[test]
fn jumps_of_laws_are_notes_that_name_time_size_and_consequence() {
    let arm = |law: Law| Draft {
        name: "arm".into(),
        bodies: vec![body("arm")],
        joints: vec![joint("hinge", "revolute", ["ground", "arm"], &[[0.0; 3]], Y)],
        drivers: vec![driver("lift", "hinge", law)],
        points: vec![PointDraft::new("tip", "arm", [0.1, 0.0, 0.0])],
        times: (0..=10).map(|k| 0.1 * f64::from(k)).collect(),
        ..Draft::default()
    };
    let laws = [
        "if(t < 0.35, 0.1, 0.1 + (t - 0.35)^2)",
        "abs(t - 0.25)",
        "if(t < 0.45, 0, 0.5)",
        "abs(sin(20*t))",
        "sin(t)",
    ];
    let notes = laws.map(|text| {
        let (_, summary) = solved(&file(&arm(law(text))));
        format!("{text}\n  {}\n", summary.model.all_notes().join("\n  "))
    });
    insta::assert_snapshot!(notes.concat());
}

#[test]
fn a_variable_without_effect_is_reported() {
    let mut draft = four_bars();
    draft.hardpoints.push(HardpointDraft::new("spare", Vec3::ZERO));
    let velocity = Vec3::AXES[0];
    let changes = vec![ChangeDraft::Move { hardpoint: "spare".into(), velocity }];
    draft.design.push(VariableDraft::new("unused", changes));
    let file = file(&draft);
    let (solution, summary) = solved(&file);
    insta::assert_snapshot!(listing(&diagnose::all(
        &file,
        &summary,
        &Course::of(&file.model, &solution),
        None
    )));
}

#[test]
fn loads_without_a_number_at_a_change_point_name_it() {
    let text = r#"
name = "parallelogram under gravity"
units = { length = "m", angle = "rad" }
planar = "xy"
at_change_points = "continue"
hardpoints = { A = [0, 0], B = [0, 1], C = [3, 1], D = [3, 0], G = [1, 1] }
bodies = { ground = ["A", "D"], crank = ["A", "B"], coupler = ["B", "C"], rocker = ["C", "D"] }
drivers.motor = { joint = "A", law = "2*pi*t" }
time = { end = 1, steps = 8 }
gravity = { along = "-y" }
points.G = { body = "coupler", at = "G" }
masses.m = { type = "rigid", centre = "G", mass = 2 }
measures.rocker = { type = "reaction", joint = "D", part = "radial" }
"#;
    let file = hardpoint_file::parse(text, "drawn.toml").unwrap();
    let (solution, summary) = solved(&file);
    let shown = listing(&diagnose::all(&file, &summary, &Course::of(&file.model, &solution), None));
    insta::assert_snapshot!(shown);
}

/// Two long bars on a short coupler; the rocker's axis is tilted by so much.
fn long_bars(tilt: f64) -> String {
    format!(
        r#"
name = "long bars"
units = {{ length = "m", angle = "rad" }}
hardpoints = {{ A = [0, 0, 0], B = [0, 1000, 0], C = [0.1, 1000, 0], D = [0.1, 0, 0] }}
bodies = {{ crank = {{}}, coupler = {{}}, rocker = {{}} }}
drivers.motor = {{ joint = "A", law = "t" }}
time = {{ end = 1, steps = 20 }}
[joints]
A = {{ type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z" }}
B = {{ type = "revolute", bodies = ["crank", "coupler"], at = "B", axis = "z" }}
C = {{ type = "revolute", bodies = ["coupler", "rocker"], at = "C", axis = "z" }}
D = {{ type = "revolute", bodies = ["ground", "rocker"], at = "D", axis = [0, {tilt:?}, 1] }}
"#
    )
}

#[test]
fn joints_that_stay_open_visibly_are_warned_of() {
    let residual_and_text = |tilt: f64| {
        let file = hardpoint_file::parse(&long_bars(tilt), "drawn.toml").unwrap();
        let (solution, summary) = solved(&file);
        assert!(solution.stop.is_none(), "{:?}", solution.stop);
        let shown = listing(&diagnose::all(&file, &summary, &Course::of(&file.model, &solution), None));
        (summary.effort.worst_residual_si, shown)
    };
    // The coupler's end rises by 460 m per rad of tilt; a thousandth of its length is 0.1 mm.
    for (tilt, warns) in [(0.0, false), (1e-7, false), (1e-6, true), (1e-5, true)] {
        let (residual, shown) = residual_and_text(tilt);
        assert!((residual - 459.7 * tilt).abs() <= 1e-3 * residual + 1e-12, "{tilt}: {residual}");
        assert_eq!(shown.contains("HP0410"), warns, "{tilt}: {shown}");
    }
    insta::assert_snapshot!(residual_and_text(5e-6).1);
}

#[test]
fn mirror_images_of_bars_in_line_are_warned_of() {
    // Crank, rod and rocker in one line, the rod longer than drawn; the second model lies upside down.
    let text = |sign: f64, off_line: f64| {
        format!(
            r#"
name = "flat"
units = {{ length = "mm", angle = "deg" }}
bodies = {{ crank = {{}}, rocker = {{}} }}
drivers.motor = {{ joint = "A", law = "10*t" }}
time = {{ end = 1, steps = 2 }}
[joints]
A = {{ type = "revolute", bodies = ["ground", "crank"], at = [0, 0, 0], axis = "z" }}
D = {{ type = "revolute", bodies = ["ground", "rocker"], at = [{:?}, 0, 0], axis = "z" }}
rod = {{ type = "rod", bodies = ["crank", "rocker"], at = [[{:?}, 0, 0], [{:?}, {off_line:?}, 0]], length = 170 }}
"#,
            300.0 * sign,
            100.0 * sign,
            250.0 * sign
        )
    };
    for sign in [1.0, -1.0] {
        for (off_line, warns) in [(0.0, true), (1.0, false)] {
            let file = hardpoint_file::parse(&text(sign, off_line), "flat.toml").unwrap();
            let (solution, summary) = solved(&file);
            assert!(solution.stop.is_none(), "{:?}", solution.stop);
            let shown = listing(&diagnose::all(&file, &summary, &Course::of(&file.model, &solution), None));
            assert_eq!(shown.contains("HP0413"), warns, "{sign} {off_line}: {shown}");
            assert_eq!(shown.contains("`rocker` may move to either side"), warns, "{shown}");
        }
    }
}

#[test]
fn bodies_that_cannot_move_are_warnings_with_a_fix() {
    let frame = |joints: &str| {
        format!(
            r#"
name = "rigid"
units = {{ length = "m", angle = "rad" }}
hardpoints = {{ A = [0, 0, 0], B = [0, 1, 0], C = [2, 2, 0], D = [3, 0, 0] }}
bodies = {{ a = {{}}, b = {{}}, c = {{}} }}
time = {{ end = 1, steps = 4 }}
[joints]
{joints}"#
        )
    };
    let hinge = |name: &str, bodies: &str, axis: &str| {
        format!("{name} = {{ type = \"revolute\", bodies = {bodies}, at = \"{name}\", axis = {axis} }}\n")
    };
    let held = |name: &str, body: &str| {
        format!("{name} = {{ type = \"fixed\", bodies = [\"ground\", \"{body}\"], at = \"{name}\" }}\n")
    };
    let fixed = ["a", "b", "c"].map(|b| held(&b.to_uppercase(), b)).concat();
    // A triangle of pins on ground, and a fixed body.
    let truss = hinge("A", r#"["ground", "a"]"#, "\"z\"")
        + &hinge("D", r#"["ground", "b"]"#, "\"z\"")
        + &hinge("C", r#"["a", "b"]"#, "\"z\"")
        + &held("B", "c");
    // A four-bar whose axes are turned against each other.
    let skew = hinge("A", r#"["ground", "a"]"#, "[0.1, 0, 1]")
        + &hinge("B", r#"["a", "b"]"#, "\"z\"")
        + &hinge("C", r#"["b", "c"]"#, "[0, 0.1, 1]")
        + &hinge("D", r#"["ground", "c"]"#, "\"z\"");
    let mut all = String::new();
    for joints in [&fixed, &truss, &skew] {
        let file = hardpoint_file::parse(&frame(joints), "drawn.toml").unwrap();
        let (solution, summary) = solved(&file);
        assert_eq!(summary.model.freedom_line(), "0 (nothing can move)");
        all += &listing(&diagnose::all(&file, &summary, &Course::of(&file.model, &solution), None));
        all += "\n";
    }
    insta::assert_snapshot!(all);
    // Mechanisms that a driver fixes are not among these.
    let moves = frame(&skew).replace("[0.1, 0, 1]", "\"z\"").replace("[0, 0.1, 1]", "\"z\"")
        + "[drivers]\nm = { joint = \"A\", law = \"0\" }\n";
    let file = hardpoint_file::parse(&moves, "drawn.toml").unwrap();
    let (solution, summary) = solved(&file);
    let shown = listing(&diagnose::all(&file, &summary, &Course::of(&file.model, &solution), None));
    assert!(!shown.contains("HP0305"), "{shown}");
}

/// A flap that is turned by this law up to an end stop.
fn flap(most: u32, law: &str, steps: u32, more: &str) -> String {
    format!(
        r#"
name = "flap"
units = {{ length = "mm", angle = "deg" }}
hardpoints = {{ A = [0, 0, 0] }}
bodies = {{ arm = {{}} }}
joints.hinge.type = "revolute"
joints.hinge.bodies = ["ground", "arm"]
joints.hinge.at = "A"
joints.hinge.axis = "y"
joints.hinge.limits.angle = {{ max = {most}, stop = true }}
drivers.turn = {{ joint = "hinge", law = "{law}" }}
time = {{ end = 1, steps = {steps} }}
{more}"#
    )
}

/// The driver of a flap is released; a spring holds it against a force that grows.
const RELEASED: &str = r#"
equilibrium = { released = ["turn"] }
[forces]
spring = { type = "torsion_spring", joint = "hinge", stiffness = 1 }
pull = { type = "force", at = { body = "arm", at = [100, 0, 0] }, force = 200, along = "-z", law = "t" }
"#;

#[test]
fn a_released_driver_at_an_end_stop_has_its_coordinate_and_not_its_law() {
    // The hinge is at its limit of 12 deg there, in either sense of the driver; the law is at 1.9 deg.
    let flap = flap(12, "3*t", 5, RELEASED);
    for (sense, value) in [("", "12 deg"), (", reversed = true", "-12 deg")] {
        let text = flap.replace("law = \"3*t\"", &format!("law = \"3*t\"{sense}"));
        let file = hardpoint_file::parse(&text, "drawn.toml").unwrap();
        let (solution, summary) = solved(&file);
        let stop = diagnose::stop(&file, solution.stop.as_ref().unwrap(), solution.motion.len(), None);
        let notes = stop.notes.join("\n");
        assert!(notes.contains(&format!("`turn` at {value}\n")), "{notes}");
        assert!(!notes.contains("with turn "), "{notes}");
        assert!(
            summary.joint_limits.iter().all(|limit| limit.crossings.iter().all(|c| c.drivers.is_empty()))
        );
    }
    // With all of the force at the start it begins beyond the stop.
    let beyond = flap.replace("law = \"t\" }", "law = \"1 + t\" }");
    let file = hardpoint_file::parse(&beyond, "drawn.toml").unwrap();
    let (solution, _) = solved(&file);
    let stop = solution.stop.as_ref().unwrap();
    assert_eq!(stop.code(), "HP0267");
    // k angle = F L cos(angle)
    let angle = stop.drivers[0];
    assert!((angle.to_degrees() - 20.0 * angle.cos()).abs() < 1e-6 && angle > 0.2, "{angle}");
}

#[test]
fn a_study_of_a_nominal_motion_that_ends_early_was_not_made() {
    let text = flap(85, "90*t", 20, "");
    let file = hardpoint_file::parse(&text, "drawn.toml").unwrap();
    let models = file.model.motions();
    let motions = Motions::of(&models, Formulation::Relative).unwrap();
    let stopped = motions.evaluate(&[], &mut StudyCost::default(), &|| true).unwrap_err();
    let (_, diagnostic) = nominal_stop(&file, &motions, &[0], &stopped);
    assert_eq!(diagnostic.severity, Severity::Error);
    insta::assert_snapshot!(listing(&[diagnostic]));
}

#[test]
fn a_reaction_that_redundant_constraints_share_is_not_blamed_on_friction() {
    // The radial force of a prismatic joint in a plane has a component across it, which the constraints share.
    let text = |coefficient: f64| {
        format!(
            r#"
name = "gate on a strut"
units = {{ length = "mm", angle = "deg" }}
planar = "xy"
loads = "static"
hardpoints = {{ H = [0, 0], G = [520, -180], S = [95, -260], T = [430, -30], M = [200, -190] }}
bodies = {{ gate = ["H", "T", "G"], tube = ["S", "M"], rod = ["T", "M"] }}
drivers.open = {{ joint = "H", law = "80*sin(pi*t/2)" }}
gravity = {{ along = "-y" }}
points.G = {{ body = "gate", at = "G" }}
masses.gate = {{ type = "rigid", centre = "G", mass = 28 }}
measures.mr = {{ type = "reaction", joint = "M", part = "radial" }}
time = {{ at = [0.1, 0.5] }}
[joints]
H = {{ type = "revolute", bodies = ["ground", "gate"], at = "H" }}
S = {{ type = "revolute", bodies = ["ground", "tube"], at = "S" }}
M = {{ type = "translational", bodies = ["tube", "rod"], at = "M", axis = {{ through = ["S", "T"] }} }}
[forces]
gas = {{ type = "joint_spring", joint = "M", stiffness = 1.2, equilibrium = 750 }}
pin = {{ type = "friction", joint = "H", coefficient = {coefficient}, radius = 8 }}
"#
        )
    };
    let shown = |coefficient: f64| {
        let file = hardpoint_file::parse(&text(coefficient), "drawn.toml").unwrap();
        let (solution, summary) = solved(&file);
        listing(&diagnose::all(&file, &summary, &Course::of(&file.model, &solution), None))
    };
    let mild = shown(0.2);
    assert!(mild.contains("HP0409") && mild.contains("redundant constraints share it"), "{mild}");
    assert!(!mild.contains("jams"), "{mild}");
    // `radial` of a slide, which is measured here, is no remedy.
    assert!(mild.contains("`radial` of a hinge, or of a slide `force_x`"), "{mild}");
}

#[test]
fn bodies_that_are_connected_with_one_another_only_are_not_connected_to_ground() {
    let text = r#"
name = "loose pair"
units = { length = "mm", angle = "deg" }
hardpoints = { A = [0, 0, 0], B = [40, 200, 0] }
bodies = { arm = {}, one = {}, two = {} }
drivers.turn = { joint = "hinge", law = "90*t" }
time = { end = 1, steps = 4 }
[joints]
hinge = { type = "revolute", bodies = ["ground", "arm"], at = "A", axis = "z" }
pair = { type = "revolute", bodies = ["one", "two"], at = "B", axis = "z" }
"#;
    let shown = |text: &str| {
        let file = hardpoint_file::parse(text, "drawn.toml").unwrap();
        listing(&[diagnose::topology_fault(&file, &Analysis::new(&file.model).unwrap_err())])
    };
    // Of the arm without its driver one motion remains besides.
    let undriven: Vec<&str> = text.lines().filter(|line| !line.starts_with("drivers")).collect();
    insta::assert_snapshot!(shown(text) + "\n" + &shown(&undriven.join("\n")));
}
