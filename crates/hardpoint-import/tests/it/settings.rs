//! Settings that change masses, gravity, forces or positions of other elements: values of the source programs.

use std::f64::consts::PI;

use hardpoint::model::BodyId;
use hardpoint::space::{Mat3, Pose};
use hardpoint::{Analysis, Run};
use hardpoint_file::ModelFile;
use hardpoint_import::{Closing, ElementOutcome, ImportedModel, Options};

/// Tolerance of values printed with sixteen digits.
const SAME: f64 = 1e-12;
/// Residual of a solved position, m or rad.
const ASSEMBLED: f64 = 1e-9;

fn import_with(name: &str, text: &str, closings: &[&str]) -> ImportedModel {
    let closings: Vec<Closing> = closings.iter().map(|c| c.parse().unwrap()).collect();
    let imported = hardpoint_import::import_with(
        &Options { closings, ..Options::default() },
        text.as_bytes(),
        name,
        &|_| None,
    )
    .unwrap_or_else(|e| panic!("{name}:\n{e}\n{text}"));
    assert!(imported.fault.is_none(), "{}\n{}", imported.fault.unwrap(), imported.text);
    imported
}

fn import(name: &str, text: &str) -> ImportedModel {
    import_with(name, text, &[])
}

/// Kinds and names of the entries of one outcome.
fn entries(imported: &ImportedModel, fate: ElementOutcome) -> Vec<(&str, &str)> {
    imported.report.of(fate).map(|e| (e.kind.as_str(), e.name.as_str())).collect()
}

/// Mass of a body, its centre, and the entries xx, yy, zz, xy, yz, zx of its inertia matrix.
type Mass = (f64, [f64; 3], [f64; 6]);

fn mass_of(imported: &ImportedModel, body: &str) -> Mass {
    let table: toml_edit::DocumentMut = imported.text.parse().unwrap();
    let entry = table["masses"][body].as_inline_table().unwrap_or_else(|| panic!("{}", imported.text));
    let number = |key: &str| entry.get(key).and_then(|x| x.as_float()).unwrap_or(0.0);
    let at = entry["centre"].as_inline_table().unwrap()["at"].as_array().unwrap();
    let centre: Vec<f64> = at.iter().map(|x| x.as_float().unwrap()).collect();
    // Products of inertia are the negative entries of the matrix.
    let moments = ["ixx", "iyy", "izz"].map(number);
    let products = ["ixy", "iyz", "izx"].map(|key| -number(key));
    let inertia = [moments[0], moments[1], moments[2], products[0], products[1], products[2]];
    (number("mass"), centre.try_into().unwrap(), inertia)
}

fn assert_mass(found: Mass, wanted: Mass, what: &str) {
    let list = |(mass, centre, inertia): Mass| {
        let list: Vec<f64> = [mass].into_iter().chain(centre).chain(inertia).collect();
        list
    };
    let scale = wanted.0.max(1.0);
    for (x, wanted) in list(found).into_iter().zip(list(wanted)) {
        assert!((x - wanted).abs() < SAME * scale, "{what}: {x} instead of {wanted}\n{found:?}");
    }
}

fn ball(moment: f64) -> [f64; 6] {
    [moment, moment, moment, 0.0, 0.0, 0.0]
}

/// Force of the only driver at the first output time, with the driver moving at 0.4 per second.
fn driver_force(imported: &ImportedModel) -> f64 {
    let text = &imported.text;
    let driver = text.lines().find_map(|l| l.strip_prefix("[drivers.")).unwrap().trim_end_matches(']');
    let start = text.find("law = \"").unwrap();
    let end = start + text[start..].find('\n').unwrap();
    let measure = format!("[measures.force]\ntype = \"driver_force\"\ndriver = \"{driver}\"");
    let measured = format!("{}law = \"0.4*t\"{}\n{measure}\n", &text[..start], &text[end..]);
    let file = hardpoint_file::parse(&measured, "m.toml").unwrap_or_else(|e| panic!("{e}\n{measured}"));
    let run = Analysis::new(&file.model).unwrap().run();
    run.measured.value(0, run.measured.index("force").unwrap())[0]
}

/// Poses of two bodies at all output times.
fn poses(file: &ModelFile, names: [&str; 2]) -> Vec<[Pose; 2]> {
    let solution = Analysis::new(&file.model).unwrap().solve(Run::new().without_sensitivities());
    assert!(solution.stop.is_none(), "{:?}", solution.stop);
    let body = |name: &str| BodyId(file.model.bodies.iter().position(|b| b.name == name).unwrap());
    (0..solution.motion.len()).map(|k| names.map(|name| solution.body(k, body(name)).pose())).collect()
}

#[test]
fn settings_of_the_compiler_of_mujoco_change_masses() {
    let inertial = r#"<inertial pos="1 0 0" mass="5" diaginertia="1 2 2.5"/>"#;
    let cube = r#"<geom type="box" size="0.1 0.1 0.1" pos="0.5 0 0" mass="2"/>"#;
    let small = r#"<body pos="1 0 0"><geom size="0.1" mass="0.01"/></body>"#;
    let ball_3 = r#"<geom size="0.1" group="1" mass="3"/>"#;
    let turned = |moments: &str| {
        format!(r#"<inertial pos="1 0 0" mass="5" diaginertia="{moments}" euler="0.3 0.4 0.5"/>"#)
    };
    let x = [1.0, 0.0, 0.0];
    // Values of MuJoCo 4.0: `body_mass`, `xipos`, and `body_inertia` along the global axes.
    let cases: [(&str, String, Mass); 13] = [
        ("", inertial.to_owned() + cube, (5.0, x, [1.0, 2.0, 2.5, 0.0, 0.0, 0.0])),
        (
            r#"inertiafromgeom="true" settotalmass="20""#,
            inertial.to_owned() + cube,
            (20.0, [0.5, 0.0, 0.0], ball(0.133_333_333_333_333_33)),
        ),
        // Without geoms, or with geoms of other groups only, it remains.
        (r#"inertiafromgeom="true""#, inertial.to_owned(), (5.0, x, [1.0, 2.0, 2.5, 0.0, 0.0, 0.0])),
        (
            r#"inertiafromgeom="true" inertiagrouprange="1 2""#,
            inertial.to_owned() + cube,
            (5.0, x, [1.0, 2.0, 2.5, 0.0, 0.0, 0.0]),
        ),
        (r#"inertiagrouprange="1 2""#, cube.to_owned() + ball_3, (3.0, [0.0; 3], ball(0.012))),
        (r#"inertiafromgeom="false""#, inertial.to_owned() + cube, (5.0, x, [1.0, 2.0, 2.5, 0.0, 0.0, 0.0])),
        (
            r#"settotalmass="20""#,
            inertial.to_owned() + small,
            (
                19.960_079_840_319_36,
                x,
                [3.992_015_968_063_872_5, 7.984_031_936_127_745, 9.980_039_920_159_681, 0.0, 0.0, 0.0],
            ),
        ),
        (r#"boundmass="6""#, inertial.to_owned(), (6.0, x, [1.0, 2.0, 2.5, 0.0, 0.0, 0.0])),
        // A body without mass has its minimum at its origin.
        (r#"boundmass="1""#, small.to_owned(), (1.0, [0.0; 3], [0.0; 6])),
        (
            r#"settotalmass="20" boundmass="1" boundinertia="3""#,
            inertial.to_owned() + small,
            (16.666_666_666_666_668, x, ball(10.0)),
        ),
        (
            r#"boundinertia="2.2" angle="radian""#,
            turned("1 2 2.5"),
            (
                5.0,
                x,
                [
                    2.245_493_993_597_924,
                    2.222_226_567_555_005,
                    2.432_279_438_847_068,
                    -0.031_798_983_034_859_65,
                    -0.071_852_450_474_380_09,
                    0.102_797_467_399_922_96,
                ],
            ),
        ),
        (
            r#"balanceinertia="true" boundinertia="1.5""#,
            r#"<inertial pos="1 0 0" mass="5" diaginertia="1 2 7"/>"#.to_owned(),
            (5.0, x, ball(3.5)),
        ),
        // Between two ends, only the first size counts.
        (
            "",
            r#"<geom type="box" fromto="0 0 0 1 2 2" size="0.1 0.3" mass="2"/>"#.to_owned(),
            (
                2.0,
                [0.5, 1.0, 1.0],
                [
                    1.340_740_740_740_740_3,
                    0.842_962_962_962_962_9,
                    0.842_962_962_962_962_7,
                    -0.331_851_851_851_851_73,
                    -0.663_703_703_703_703_7,
                    -0.331_851_851_851_851_8,
                ],
            ),
        ),
    ];
    for (compiler, body, wanted) in cases {
        let text = format!(
            r#"<mujoco><compiler {compiler}/><worldbody><body name="a"><joint name="j" axis="0 1 0"/>{body}</body></worldbody></mujoco>"#
        );
        let imported = import("m.xml", &text);
        assert_mass(mass_of(&imported, "a"), wanted, &text);
        assert_eq!(entries(&imported, ElementOutcome::NotUnderstood), [], "{}", imported.report);
        assert_eq!(entries(&imported, ElementOutcome::Refused), [], "{}", imported.report);
    }
    // A total that cannot be reached, since the masses of meshes are not computed.
    let text = r#"<mujoco><compiler settotalmass="9"/><asset><mesh name="m" file="m.stl"/></asset><worldbody>
        <body name="a"><joint/><inertial pos="0 0 0" mass="2"/><body name="b"><joint/><geom type="mesh" mesh="m"/></body></body></worldbody></mujoco>"#;
    let imported = import("m.xml", text);
    assert!(
        entries(&imported, ElementOutcome::Refused).contains(&("compiler", "settotalmass")),
        "{}",
        imported.report
    );
    assert_mass(mass_of(&imported, "a"), (2.0, [0.0; 3], [0.0; 6]), text);
}

#[test]
fn masses_of_meshes_are_those_of_mujoco() {
    let corners = "0 0 0 1 0 0 0 1 0 0 0 1";
    let tetrahedron = format!(r#"vertex="{corners}""#);
    let cube = r#"vertex="-1 -1 -1 1 -1 -1 -1 1 -1 1 1 -1 -1 -1 1 1 -1 1 -1 1 1 1 1 1""#;
    // Of a tetrahedron with its corner at the origin: the centre (1, 1, 1)/4, and about it per unit of mass the
    // moments 3/40 and the entries 1/80 of the matrix.
    let own = |mass: f64| [[mass * 0.075; 3], [mass * 0.0125; 3]].concat().try_into().unwrap();
    // Points 0.2 further, with 1 kg at x = 0.1
    let both = {
        let (x, y) = (5.0 / 6.0 * 0.45 + 0.1 / 6.0, 5.0 / 6.0 * 0.25);
        let [dx, dy] = [0.35, 0.25];
        let part = 5.0 / 6.0;
        let ball = 0.4 * 0.05 * 0.05;
        let across = part * (dx * dx + dy * dy) + 0.375 + ball;
        let products = [0.0625 - part * dx * dy, 0.0625 - part * dy * dy, 0.0625 - part * dx * dy];
        let [xy, yz, zx] = products;
        (6.0, [x, y, y], [part * 2.0 * dy * dy + 0.375 + ball, across, across, xy, yz, zx])
    };
    let mesh = |mesh: &str, geom: &str| {
        (format!("<mesh name=\"m\" {mesh}/>"), format!(r#"<geom type="mesh" mesh="m" {geom}/>"#))
    };
    let cases: [((String, String), Mass); 7] = [
        (mesh(&tetrahedron, r#"density="60""#), (10.0, [0.25; 3], own(10.0))),
        (mesh(&tetrahedron, r#"mass="2" density="0""#), (2.0, [0.25; 3], own(2.0))),
        (mesh(r#"file="t.obj""#, r#"density="60""#), (10.0, [0.25; 3], own(10.0))),
        (mesh(r#"file="t.obj" inertia="exact" scale="-1 1 1""#, r#"density="60""#), {
            let [xx, yy, zz, xy, yz, zx] = own(10.0);
            (10.0, [-0.25, 0.25, 0.25], [xx, yy, zz, -xy, yz, -zx])
        }),
        // Facets of more than three corners are covered once.
        (mesh(cube, r#"density="0.5""#), (4.0, [0.0; 3], ball(4.0 * 2.0 / 3.0))),
        (
            mesh(&format!(r#"{cube} inertia="convex""#), r#"density="0.5""#),
            (4.0, [0.0; 3], ball(4.0 * 2.0 / 3.0)),
        ),
        (mesh(&tetrahedron, r#"mass="5" pos="0.2 0 0"/><geom size="0.05" mass="1" pos="0.1 0 0""#), both),
    ];
    let model = |assets: &str, geoms: &str| {
        format!(
            r#"<mujoco><asset>{assets}</asset><worldbody><body name="a"><joint axis="0 1 0"/>{geoms}</body></worldbody></mujoco>"#
        )
    };
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    let resolve = |path: &str| (path == "t.obj").then(|| obj.as_bytes().to_vec());
    for ((assets, geoms), wanted) in cases {
        let text = model(&assets, &geoms);
        let imported = hardpoint_import::import(text.as_bytes(), "m.xml", &resolve).unwrap();
        assert_mass(mass_of(&imported, "a"), wanted, &text);
        assert_eq!(entries(&imported, ElementOutcome::Refused), [], "{}", imported.report);
    }
    // A body whose mass is known in part only has none, and is named.
    let ball = r#"<geom size="0.05" mass="1"/>"#;
    for (asset, why) in [
        (r#"file="n.obj""#.to_owned(), "`n.obj`: the file does not exist"),
        (format!(r#"{tetrahedron} inertia="shell""#), "`inertia=\"shell\"`"),
        (format!(r#"vertex="{corners}" face="0 1 2 0 2 1" inertia="exact""#), "encloses no volume"),
    ] {
        let (assets, geoms) = mesh(&asset, "");
        let imported = import("m.xml", &model(&assets, &(geoms + ball)));
        assert!(!imported.text.contains("[masses"), "{}", imported.text);
        let refused: Vec<_> =
            imported.report.of(ElementOutcome::Refused).filter(|e| e.kind == "mass of geoms").collect();
        assert!(
            refused.len() == 1 && refused[0].name == "a" && refused[0].place.is_some(),
            "{}",
            imported.report
        );
        assert!(refused[0].why.contains(why), "{}", refused[0].why);
    }
}

/// Arm that turns about y at (0, 0, 1), a free body of 2 kg at x = 5, and further bodies.
fn welded(load: &str, others: &str, equalities: &str) -> String {
    format!(
        r#"<mujoco><worldbody><site name="w"/><body name="arm" pos="0 0 1"><joint name="pivot" axis="0 1 0"/></body>
        <body name="load" pos="5 0 1"><freejoint/>{load}<site name="s" pos="0 0 0.1"/></body>{others}</worldbody>
        <tendon><spatial name="t" stiffness="100"><site site="s"/><site site="w"/></spatial></tendon>
        <equality>{equalities}</equality></mujoco>"#
    )
}

#[test]
fn a_weld_moves_a_free_body_with_its_mass_and_its_tendons() {
    let weld =
        r#"<weld body1="arm" body2="load" relpose="0.3 0 0 0.7071067811865476 0.7071067811865476 0 0"/>"#;
    let explicit = r#"<inertial pos="0 0 0" mass="2" diaginertia="0.1 0.2 0.25"/>"#;
    // A box of 2 kg with the sides 0.2, 0.4 and 0.6 m: b^2 + c^2 by 6
    let geoms = r#"<geom type="box" size="0.1 0.2 0.3" mass="2"/>"#;
    let moments = |[b, c]: [f64; 2]| (b * b + c * c) / 6.0;
    let [ix, iy, iz] = [moments([0.4, 0.6]), moments([0.6, 0.2]), moments([0.2, 0.4])];
    for (load, inertia) in [(explicit, [0.1, 0.2, 0.25]), (geoms, [ix, iy, iz])] {
        let imported = import("m.xml", &welded(load, "", weld));
        assert!(imported.text.contains("load = { frame = { position = [0.3, 0.0, 1.0]"), "{}", imported.text);
        // Turned by 90 degrees about x
        let [xx, yy, zz] = inertia;
        assert_mass(mass_of(&imported, "load"), (2.0, [0.3, 0.0, 1.0], [xx, zz, yy, 0.0, 0.0, 0.0]), load);
        let table: toml_edit::DocumentMut = imported.text.parse().unwrap();
        let tendon = table["forces"]["t"].as_table_like().unwrap();
        let from = tendon.get("from").unwrap().as_table_like().unwrap();
        let at = from.get("at").unwrap().as_array().unwrap_or_else(|| panic!("{}", imported.text));
        let at: Vec<f64> = at.iter().map(|x| x.as_float().unwrap()).collect();
        assert!([0.3, -0.1, 1.0].iter().zip(&at).all(|(x, y)| (x - y).abs() < SAME), "{at:?}");
        // Its tension is zero at the length of the source, from (5, 0, 1.1) to the origin.
        let tension = tendon.get("preload").unwrap().as_float().unwrap();
        let wanted = 100.0 * (1.1_f64.sqrt() - 26.21_f64.sqrt());
        assert!((tension - wanted).abs() < 1e-10, "{tension} instead of {wanted}");
        let turned = Mat3::about([1.0, 0.0, 0.0].into(), PI / 2.0);
        for [arm, load] in poses(&crate::model(&imported), ["arm", "load"]) {
            let held = arm.compose(Pose { rot: turned, r: [0.3, 0.0, 0.0].into() });
            assert!((held.r - load.r).norm() + held.rot.angle_to(load.rot) < ASSEMBLED, "{load:?}");
        }
    }
}

#[test]
fn offsets_of_equalities_are_those_of_the_source_wherever_welds_place_bodies() {
    let body = |name: &str, at: &str| format!(r#"<body name="{name}" pos="{at}"><freejoint/></body>"#);
    let weld = r#"<weld body1="arm" body2="load" relpose="0.3 0 0 1 0 0 0"/>"#;
    let next = r#"<weld body1="load" body2="next"/>"#;
    let both = |[first, second]: [&str; 2]| [format!("{first}{second}"), format!("{second}{first}")];
    // Without `relpose` the second body is 1 m above the first.
    for equalities in both([weld, next]) {
        let imported = import("m.xml", &welded("", &body("next", "5 0 2"), &equalities));
        let file = crate::model(&imported);
        let next = file.model.bodies.iter().find(|b| b.name == "next").unwrap();
        assert!((next.frame.r - [0.3, 0.0, 2.0].into()).norm() < SAME, "{:?}", next.frame.r);
        assert_eq!(file.model.named_joints().filter(|(_, j)| j.kind.name == "fixed").count(), 2);
    }
    // The anchor is (4.9, 0.2, 1), 0.6 m behind the tip and 0.2 m beside it.
    let weld = r#"<weld body1="load" body2="arm" relpose="-0.3 0 0 1 0 0 0"/>"#;
    let connect = r#"<connect body1="load" body2="tip" anchor="0.2 0.1 0"/>"#;
    for equalities in both([weld, connect]) {
        let text = welded("", &body("tip", "5.5 0 1"), &equalities);
        let imported = import("m.xml", &text.replace(r#"pos="5 0 1""#, r#"pos="5 0 1" euler="0 0 90""#));
        let solved = poses(&crate::model(&imported), ["load", "tip"]);
        assert!((solved[0][0].r - [0.3, 0.0, 1.0].into()).norm() < ASSEMBLED, "{:?}", solved[0]);
        for [load, tip] in solved {
            let [a, b] = [load.point([0.2, 0.1, 0.0].into()), tip.point([-0.6, 0.2, 0.0].into())];
            assert!((a - b).norm() < ASSEMBLED, "{a:?} {b:?}");
        }
    }
}

#[test]
fn shells_of_mujoco_have_their_mass_at_their_surface() {
    // Values of MuJoCo 4.0 for a mass of 3 kg, and its masses for 100 kg/m^2.
    let shells = [
        (r#"type="sphere" size="0.2""#, [0.08; 3], 50.265_482_457_436_69),
        (
            r#"type="box" size="0.1 0.2 0.3""#,
            [0.184_545_454_545_454_54, 0.143_636_363_636_363_65, 0.082_727_272_727_272_75],
            88.0,
        ),
        (r#"type="capsule" size="0.1 0.3""#, [0.173_75, 0.173_75, 0.0275], 50.265_482_457_436_69),
        (
            r#"type="cylinder" size="0.1 0.3""#,
            [0.129_642_857_142_857_12, 0.129_642_857_142_857_12, 0.027_857_142_857_142_858],
            43.982_297_150_257_1,
        ),
    ];
    for (shape, [xx, yy, zz], of_density) in shells {
        let of = |mass: &str| {
            let text = format!(
                r#"<mujoco><worldbody><body name="a"><joint axis="0 1 0"/><geom {shape} shellinertia="true" {mass}/></body></worldbody></mujoco>"#
            );
            mass_of(&import("m.xml", &text), "a")
        };
        assert_mass(of(r#"mass="3""#), (3.0, [0.0; 3], [xx, yy, zz, 0.0, 0.0, 0.0]), shape);
        let (mass, _, inertia) = of(r#"density="100""#);
        assert!((mass - of_density).abs() < SAME * mass, "{shape}: {mass}");
        assert!((inertia[0] - xx * mass / 3.0).abs() < SAME, "{shape}: {inertia:?}");
    }
    // The formulas for an ellipsoid are approximations: MuJoCo uses finite differences for its inertia.
    let text = r#"<mujoco><worldbody><body name="a"><joint axis="0 1 0"/><geom type="ellipsoid" size="0.1 0.2 0.3" shellinertia="true" density="100"/></body></worldbody></mujoco>"#;
    let (mass, _, inertia) = mass_of(&import("m.xml", text), "a");
    assert!((mass - 48.971_933_33).abs() < 1e-8, "{mass}");
    let wanted = [1.807_517_488_254_243_2, 1.406_836_657_632_084, 0.810_268_093_679_042_1];
    assert!(inertia.iter().zip(wanted).all(|(x, y)| (x - y).abs() < 1e-5 * y), "{inertia:?}");
}

/// Pendulum of 2 kg at x = 1 m on a hinge about y, with a second one of 1 kg fixed to it there.
fn pendulum(option: &str, body: &str, joint: &str) -> String {
    format!(
        r#"<mujoco>{option}<worldbody><body name="a" {body}><joint name="j" axis="0 1 0" {joint}/><geom size="0.1" pos="1 0 0" mass="2" group="3"/>
        <body name="b" pos="1 0 0"><geom size="0.1" mass="1" group="3"/></body></body></worldbody></mujoco>"#
    )
}

#[test]
fn gravity_of_mujoco_can_be_disabled_or_compensated() {
    let off = r#"<option gravity="0 0 -5"><flag gravity="disable"/></option>"#;
    let cases = [
        ("", "", -3.0 * 9.81),
        (r#"<option gravity="0 0 -5"/>"#, "", -3.0 * 5.0),
        (off, "", 0.0),
        (off, r#"gravcomp="1""#, 0.0),
        // Later settings replace earlier ones.
        (&format!(r#"{off}<option><flag gravity="enable"/></option>"#), "", -3.0 * 5.0),
        // `mj_inverse` of MuJoCo 4.0: the compensation is that of the body alone.
        ("", r#"gravcomp="0.5""#, -19.62),
        (r#"<compiler settotalmass="6"/>"#, r#"gravcomp="0.5""#, -2.0 * 19.62),
    ];
    for (option, body, wanted) in cases {
        let imported = import("m.xml", &pendulum(option, body, ""));
        let found = driver_force(&imported);
        assert!((found - wanted).abs() < ASSEMBLED, "{option} {body}: {found} instead of {wanted}");
        assert_eq!(entries(&imported, ElementOutcome::Refused), [], "{}", imported.report);
    }
}

#[test]
fn flags_of_mujoco_disable_springs_limits_and_equalities() {
    let spring = r#"stiffness="7" springref="30" damping="0.5" range="-10 20""#;
    let flagged = |flag: &str| {
        let option =
            format!(r#"<option gravity="0 0 0"><flag {flag}/></option><compiler autolimits="true"/>"#);
        import("m.xml", &pendulum(&option, "", spring))
    };
    let [by_spring, by_damper] = [-7.0 * PI / 6.0, 0.5 * 0.4];
    let cases = [
        (r#"spring="enable""#, by_spring + by_damper, true),
        (r#"spring="disable""#, by_damper, true),
        (r#"damper="disable""#, by_spring, true),
        (r#"passive="disable""#, 0.0, true),
        (r#"limit="disable""#, by_spring + by_damper, false),
        (r#"constraint="disable""#, by_spring + by_damper, false),
    ];
    for (flag, wanted, is_limited) in cases {
        let imported = flagged(flag);
        let found = driver_force(&imported);
        assert!((found - wanted).abs() < ASSEMBLED, "{flag}: {found} instead of {wanted}");
        assert_eq!(imported.text.contains("limits ="), is_limited, "{flag}");
    }
    for (flag, constraints) in [("enable", 1), ("disable", 0)] {
        let text = format!(
            r#"<mujoco><option><flag equality="{flag}"/></option><worldbody><body name="a"><joint axis="0 1 0"/><geom size="1"/></body>
            <body name="b" pos="0 0 1"><joint axis="0 1 0"/><geom size="1"/></body></worldbody><equality><connect body1="a" body2="b" anchor="0 0 2"/></equality></mujoco>"#
        );
        let imported = import("m.xml", &text);
        let balls =
            crate::model(&imported).model.named_joints().filter(|(_, j)| j.kind.name == "spherical").count();
        assert_eq!(balls, constraints, "{}", imported.report);
        let refused = entries(&imported, ElementOutcome::Refused);
        assert_eq!(refused.contains(&("connect", "connect_1")), constraints == 0, "{refused:?}");
    }
}

#[test]
fn properties_without_equivalent_are_refused() {
    let mjcf = [
        (r#"<option density="1.2"/>"#, "", "", "option"),
        (r#"<option viscosity="1e-5"/>"#, "", "", "option"),
        ("", "", r#"armature="0.4""#, "armature"),
        (r#"<default><joint armature="0.4"/></default>"#, "", "", "armature"),
        ("", "", r#"springdamper="0.1 1""#, "springdamper"),
        ("", "", r#"springyield="1""#, "springyield"),
    ];
    for (option, body, joint, kind) in mjcf {
        let imported = import("m.xml", &pendulum(option, body, joint));
        let refused: Vec<&str> =
            entries(&imported, ElementOutcome::Refused).into_iter().map(|e| e.0).collect();
        assert_eq!(refused, [kind], "{}", imported.report);
    }
    // Of a free joint, too.
    let text = r#"<mujoco><worldbody><body name="a"><joint name="f" type="free" damping="3"/><geom size="1"/></body></worldbody></mujoco>"#;
    let imported = import("m.xml", text);
    assert_eq!(entries(&imported, ElementOutcome::Refused), [("spring", "f")], "{}", imported.report);
    // A geom that takes its size from a mesh has no known mass.
    let text = r#"<mujoco><asset><mesh name="m" file="m.stl"/></asset><worldbody><body name="a"><joint/><geom type="box" mesh="m"/></body></worldbody></mujoco>"#;
    let imported = import("m.xml", text);
    let refused = entries(&imported, ElementOutcome::Refused);
    assert!(refused.contains(&("geom", "a")) && refused.contains(&("mass of geoms", "a")), "{refused:?}");
}

/// Pendulum on a hinge about y.
fn link(content: &str, world: &str) -> String {
    format!(
        r#"<sdf version="1.11"><world name="w">{world}<model name="m"><link name="a">{content}</link>
        <joint name="j" type="revolute"><parent>world</parent><child>a</child><axis><xyz>0 1 0</xyz></axis></joint></model></world></sdf>"#
    )
}

fn collision(shape: &str, pose: &str, density: &str) -> String {
    format!(
        r#"<collision name="{}"><pose>{pose}</pose>{density}<geometry>{shape}</geometry></collision>"#,
        shape.len()
    )
}

#[test]
fn sdformat_computes_masses_from_collisions() {
    const AUTO: &str = r#"<inertial auto="true"/>"#;
    const TURNED: &str = "0.1 0.2 0.3 0.4 0.5 0.6";
    let of_1240 = r#"<inertial auto="true"><density>1240</density></inertial>"#;
    let rod = "<box><size>1 0.1 0.1</size></box>";
    let sphere = "<sphere><radius>0.2</radius></sphere>";
    let placed = |shape: &str| AUTO.to_owned() + &collision(shape, TURNED, "");
    let at = [0.1, 0.2, 0.3];
    // Values of Drake 1.51.1, which computes them by libsdformat.
    let cases: [(String, Mass); 8] = [
        (
            of_1240.to_owned() + &collision(rod, "", "<density>2700</density>"),
            (27.0, [0.0; 3], [0.045, 2.2725, 2.2725, 0.0, 0.0, 0.0]),
        ),
        (
            of_1240.to_owned() + &collision(rod, "", ""),
            (
                12.4,
                [0.0; 3],
                [0.020_666_666_666_666_61, 1.043_666_666_666_666_7, 1.043_666_666_666_666_7, 0.0, 0.0, 0.0],
            ),
        ),
        (placed(sphere), (33.510_321_638_291_13, at, ball(0.536_165_146_212_658_1))),
        (
            placed("<cylinder><radius>0.1</radius><length>0.6</length></cylinder>"),
            (
                18.849_555_921_538_76,
                at,
                [
                    0.435_617_568_397_881,
                    0.609_918_452_592_689_5,
                    0.273_932_893_517_142_3,
                    0.021_828_547_418_227_72,
                    0.030_195_350_599_672_866,
                    -0.244_833_774_674_527_13,
                ],
            ),
        ),
        (
            placed("<capsule><radius>0.1</radius><length>0.6</length></capsule>"),
            (
                23.038_346_126_325_152,
                at,
                [
                    0.762_708_900_844_469_4,
                    1.095_465_134_307_286_3,
                    0.454_038_157_890_331_8,
                    0.041_672_681_434_798_35,
                    0.057_645_669_326_648_33,
                    -0.467_409_933_469_551_9,
                ],
            ),
        ),
        (
            placed("<ellipsoid><radii>0.1 0.2 0.3</radii></ellipsoid>"),
            (
                25.132_741_228_718_345,
                at,
                [
                    0.495_949_466_615_705_55,
                    0.538_376_185_106_351_2,
                    0.373_107_857_086_170_6,
                    0.064_705_210_723_045_7,
                    -0.021_183_807_496_491_465,
                    -0.171_071_047_387_569_15,
                ],
            ),
        ),
        (
            AUTO.to_owned()
                + &collision(rod, "", "")
                + &collision(sphere, "0.5 0.1 0 0 0 0", "<density>300</density>"),
            (
                20.053_096_491_487_34,
                [0.250_661_948_785_688_6, 0.050_132_389_757_137_7, 0.0],
                [
                    0.227_648_600_287_601_7,
                    2.255_825_954_458_907_7,
                    2.305_958_344_216_045,
                    -0.250_661_948_785_688_6,
                    0.0,
                    0.0,
                ],
            ),
        ),
        // A mass scales what the shapes have.
        (
            r#"<inertial auto="true"><mass>5</mass></inertial>"#.to_owned() + &collision(rod, "", ""),
            (5.0, [0.0; 3], [0.045 * 5.0 / 27.0, 2.2725 * 5.0 / 27.0, 2.2725 * 5.0 / 27.0, 0.0, 0.0, 0.0]),
        ),
    ];
    for (content, wanted) in cases {
        let imported = import("m.sdf", &link(&content, ""));
        assert_mass(mass_of(&imported, "a"), wanted, &content);
        assert_eq!(entries(&imported, ElementOutcome::Ignored), [], "{}", imported.report);
    }
    // A cone, with its centre at a quarter of its height; Drake prints eight digits.
    let imported =
        import("m.sdf", &link(&placed("<cone><radius>0.1</radius><length>0.6</length></cone>"), ""));
    let (mass, centre, inertia) = mass_of(&imported, "a");
    assert!((mass - 2.0 * PI).abs() < SAME, "{mass}");
    assert!(centre.iter().zip([0.012_349_9, 0.210_809_89, 0.178_753_94]).all(|(x, y)| (x - y).abs() < 1e-8));
    assert!((inertia[0] - 0.068_503_343_381_929_61).abs() < SAME, "{inertia:?}");
    // Without the shapes there is no mass.
    for content in [
        AUTO.to_owned(),
        placed("<plane><normal>0 0 1</normal></plane>"),
        placed("<mesh><uri>m.stl</uri></mesh>"),
        placed("<box/>"),
    ] {
        let imported = import("m.sdf", &link(&content, ""));
        assert_eq!(entries(&imported, ElementOutcome::Refused), [("inertial", "a")], "{}", imported.report);
        assert!(!imported.text.contains("[masses"), "{}", imported.text);
    }
}

#[test]
fn links_of_sdformat_may_have_no_weight_and_gravity_may_be_in_the_physics() {
    let mass = "<inertial><pose>1 0 0 0 0 0</pose><mass>2</mass></inertial>";
    for (content, world, wanted) in [
        ("", "<gravity>0 0 -5</gravity>", -10.0),
        ("<gravity>true</gravity>", "<gravity>0 0 -5</gravity>", -10.0),
        ("<gravity>false</gravity>", "<gravity>0 0 -5</gravity>", 0.0),
        ("<gravity>0</gravity>", "<gravity>0 0 -5</gravity>", 0.0),
        ("", "<physics><gravity>0 0 -3</gravity></physics>", -6.0),
    ] {
        let found = driver_force(&import("m.sdf", &link(&format!("{mass}{content}"), world)));
        assert!((found - wanted).abs() < ASSEMBLED, "{content} {world}: {found} instead of {wanted}");
    }
    for unsupported in
        ["<velocity_decay><linear>0.1</linear></velocity_decay>", "<enable_wind>true</enable_wind>"]
    {
        let imported = import("m.sdf", &link(&format!("{mass}{unsupported}"), ""));
        assert_eq!(entries(&imported, ElementOutcome::Refused).len(), 1, "{}", imported.report);
    }
    let without = "<velocity_decay><linear>0</linear></velocity_decay><enable_wind>false</enable_wind>";
    let imported = import("m.sdf", &link(&format!("{mass}{without}"), ""));
    assert_eq!(entries(&imported, ElementOutcome::Refused), [], "{}", imported.report);
    // A link without mass is listed.
    let text = link(mass, "").replace("<joint", "<link name=\"b\"/><joint");
    let imported = import("m.sdf", &text);
    let added = imported.report.of(ElementOutcome::Approximated).find(|e| e.kind == "inertial");
    assert!(added.is_some_and(|e| e.why.contains("`b`")), "{}", imported.report);
}

#[test]
fn poses_of_sdformat_may_depend_on_frames_that_their_bodies_carry() {
    let base = r#"<link name="base"><pose>0.01 0.02 0.03 0.4 0.5 0.6</pose></link>"#;
    let fixed = r#"<joint name="jb" type="fixed"><parent>world</parent><child>base</child></joint>"#;
    let place = r#"<pose relative_to="base">0.2 0.3 0.1 0.1 -0.2 0.3</pose>"#;
    let hinge = |pose: &str, child: &str| {
        format!(
            r#"<joint name="J1" type="revolute">{pose}<parent>base</parent><child>{child}</child><axis><xyz>1 2 2</xyz></axis></joint>"#
        )
    };
    let graphs = [
        format!(r#"<link name="arm"><pose relative_to="J1"/></link>{}"#, hinge(place, "arm")),
        format!(
            r#"<frame name="f" attached_to="arm">{place}</frame><link name="arm"><pose relative_to="f"/></link>{}"#,
            hinge("", "arm")
        ),
        // Through a chain of frames.
        format!(
            r#"<frame name="g" attached_to="f">{place}</frame><frame name="f" attached_to="arm"/><link name="arm"><pose relative_to="g"/></link>{}"#,
            hinge("", "f")
        ),
    ];
    for graph in graphs {
        let text = format!(r#"<sdf version="1.11"><model name="m">{base}{graph}{fixed}</model></sdf>"#);
        let file = crate::model(&import("m.sdf", &text));
        let arm = file.model.bodies.iter().find(|b| b.name == "arm").unwrap();
        // Drake 1.51.1, printed with eight digits
        let wanted = [0.103_498_71, 0.371_577_95, 0.117_469_62];
        let off =
            arm.frame.r.to_array().into_iter().zip(wanted).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        assert!(off < 1e-8, "{graph}: {:?}", arm.frame.r);
    }
    // Frames that carry each other, or poses that depend on themselves, remain errors.
    for graph in [
        format!(
            r#"<frame name="f" attached_to="g">{place}</frame><frame name="g" attached_to="f">{place}</frame><link name="arm"/>{}"#,
            hinge("", "arm")
        ),
        format!(r#"<link name="arm"><pose relative_to="J1"/></link>{}"#, hinge("", "arm")),
    ] {
        let text = format!(r#"<sdf version="1.11"><model name="m">{base}{graph}{fixed}</model></sdf>"#);
        let errors = hardpoint_import::import(text.as_bytes(), "m.sdf", &|_| None).unwrap_err();
        assert!(errors.to_string().contains("HP0803"), "{errors}");
    }
}

#[test]
fn loops_of_every_type_are_closed_between_frames_that_are_apart() {
    // A four-bar with parallel hinges. Point (0.3, 0, 0) of b and (0, 0, 0.2) of c are 0.0215 m apart in the file.
    let linkage = r#"<robot name="cl"><link name="w"/><link name="a"/><link name="b"/><link name="c"/>
        <joint name="ja" type="continuous"><parent link="w"/><child link="a"/><origin rpy="0.3 0 0"/><axis xyz="0 1 0"/></joint>
        <joint name="jb" type="continuous"><parent link="a"/><child link="b"/><origin xyz="0.1 0 0" rpy="0 -0.7 0"/><axis xyz="0 1 0"/></joint>
        <joint name="jc" type="continuous"><parent link="w"/><child link="c"/><origin xyz="0.35 0 0" rpy="0.3 0 0"/><axis xyz="0 1 0"/></joint></robot>"#;
    for kind in ["spherical", "revolute:y", "cylindrical:y"] {
        let closing = format!("b@0.3,0,0=c@0,0,0.2:{kind}");
        let imported = import_with("cl.urdf", linkage, &[&closing]);
        assert!(imported.report.to_string().contains("assembled"), "{}", imported.report);
        let solved = poses(&crate::model(&imported), ["b", "c"]);
        // The triangle of the pivots 0.25 m apart: b and c meet 0.025 m behind the pivot of c, which is 0.2 m long.
        let turned = Mat3::about([1.0, 0.0, 0.0].into(), 0.3).transpose() * solved[0][1].rot;
        let angle = turned.cols[2].x.atan2(turned.cols[2].z);
        assert!((angle + 0.125_f64.asin()).abs() < ASSEMBLED, "{kind}: {angle}");
        for [b, c] in solved {
            let gap = b.point([0.3, 0.0, 0.0].into()) - c.point([0.0, 0.0, 0.2].into());
            assert!(gap.norm() < ASSEMBLED, "{kind}: {gap:?}");
        }
    }
    // A body on joints that leave one motion with the closing; the directions in which it does not slide, by the axes
    // of the crank.
    let carried = |carriers: &str| {
        let mut out = r#"<robot name="f"><link name="w"/><link name="crank"/><joint name="h" type="continuous"><parent link="w"/><child link="crank"/><axis xyz="0 1 0"/></joint>"#.to_owned();
        let mut parent = "w".to_owned();
        for (k, carrier) in carriers.split(' ').enumerate() {
            let is_last = k == carriers.split(' ').count() - 1;
            let child = if is_last { "tool".to_owned() } else { format!("t{k}") };
            let kind = if carrier.starts_with('r') { "continuous" } else { "prismatic" };
            let axis = match &carrier[1..] {
                "x" => "1 0 0",
                "y" => "0 1 0",
                _ => "0 0 1",
            };
            let origin = if k == 0 { "0.33 0.04 0.06" } else { "0 0 0" };
            out += &format!(
                r#"<link name="{child}"/><joint name="j{k}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{origin}"/><axis xyz="{axis}"/></joint>"#
            );
            parent = child;
        }
        out + "</robot>"
    };
    for (kind, carriers, held) in [
        ("spherical", "px py pz", &[0, 1, 2][..]),
        ("revolute:x", "px py pz ry rz", &[0, 1, 2]),
        ("cylindrical:x", "py pz ry rz", &[1, 2]),
        ("translational:x", "py pz rx ry rz", &[1, 2]),
        ("planar:z", "pz rx ry", &[2]),
    ] {
        let closing = format!("crank@0.3,0.01,0.02=tool:{kind}");
        let imported = import_with("f.urdf", &carried(carriers), &[&closing]);
        let solved = poses(&crate::model(&imported), ["crank", "tool"]);
        for [crank, tool] in &solved {
            let gap = crank.rot.transpose_mul(tool.r - crank.point([0.3, 0.01, 0.02].into()));
            for k in 0..3 {
                let is_zero = gap[k].abs() < ASSEMBLED;
                assert_eq!(is_zero, held.contains(&k), "{kind}: {gap:?}\n{}", imported.report);
            }
        }
        assert!(solved[0][0].rot.angle_to(solved[25][0].rot) > 0.1, "{kind}\n{}", imported.report);
    }
}

#[test]
fn markers_of_adams_that_are_apart_are_assembled_for_every_type() {
    let dataset = |statement: &str| {
        format!(
            "apart\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\nMARKER/1, PART=1, REULER=0D,-90D,0D\n\
             PART/2, QG=0,0,0\nMARKER/2, PART=2, REULER=0D,-90D,0D\nMARKER/22, PART=2, QP=100,0,0\nPART/3, QG=140,50,60\nMARKER/3, PART=3\n\
             JOINT/1, REVOLUTE, I=2, J=1\n{statement}, I=3, J=22\nEND\n"
        )
    };
    // The z axis of marker 22 is that of part 2.
    for (statement, held) in [
        ("JOINT/2, TRANSLATIONAL", &[0, 1][..]),
        ("JOINT/2, CYLINDRICAL", &[0, 1]),
        ("JOINT/2, SCREW, PITCH=10", &[0, 1]),
        ("JOINT/2, PLANAR", &[2]),
        ("JPRIM/2, INLINE", &[0, 1]),
        ("JPRIM/2, INPLANE", &[2]),
    ] {
        let imported = import("apart.adm", &dataset(statement));
        assert!(imported.report.to_string().contains("assembled"), "{}", imported.report);
        let solved = poses(&crate::model(&imported), ["PART_2", "PART_3"]);
        for [arm, part] in &solved {
            let gap = arm.rot.transpose_mul(part.r - arm.point([0.1, 0.0, 0.0].into()));
            assert!(
                held.iter().all(|k| gap[*k].abs() < ASSEMBLED),
                "{statement}: {gap:?}\n{}",
                imported.report
            );
        }
    }
}

#[test]
fn a_motion_of_adams_that_joints_prevent_is_named_although_other_bodies_are_free() {
    let text = "t\nUNITS/SYSTEM=MKS\nPART/1,GROUND\nPART/5,QG=0,6,0\nMARKER/15,PART=1,QP=0,6,0\nMARKER/51,PART=5\n\
                JPRIM/4,PARALLEL_AXES,I=51,J=15\nPART/6,QG=0,7,0\nMARKER/16,PART=1,QP=0,7,0\nMARKER/61,PART=6\n\
                JPRIM/5,ORIENTATION,I=61,J=16\nJPRIM/6,ATPOINT,I=61,J=16\nMOTION/8,I=61,J=16,X,DISPLACEMENT,FUNCTION=0.1*TIME\nEND\n";
    let imported = hardpoint_import::import(text.as_bytes(), "m.adm", &|_| None).unwrap();
    let fault = imported.fault.as_ref().expect("the motion contradicts the joints").list().next().unwrap();
    assert!(fault.code == "HP0302" && fault.notes.iter().any(|n| n.contains("`MOTION_8`")), "{fault:?}");
    // All motions of the free body have drivers.
    for name in ["JPRIM_4", "PART_5_along_x", "PART_5_along_y", "PART_5_along_z"] {
        assert!(imported.text.contains(&format!("[drivers.{name}_held]")), "{}", imported.text);
        assert!(entries(&imported, ElementOutcome::Approximated).contains(&("motion", name)));
    }
}

/// Pendulum of Adams with a spring, whose driver has a torque.
const SPRUNG: &str = "pendulum\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MILLIMETER, TIME=SECOND\nPART/1, GROUND\n\
    MARKER/1, PART=1, REULER=0D,-90D,0D\nMARKER/10, PART=1, QP=0,0,400\nPART/2, MASS=2, CM=21\nMARKER/21, PART=2, QP=100,50,0\n\
    MARKER/22, PART=2, QP=200,0,0\nMARKER/23, PART=2, REULER=0D,-90D,0D\nJOINT/1, REVOLUTE, I=23, J=1\n\
    ACCGRAV/KGRAV=-9806.65\nSPRINGDAMPER/1, I=22, J=10, TRANSLATION, K=3, C=0.2, LENGTH=300, FORCE=12\n\
    BUSHING/2, I=22, J=10, K=1,2,3, TORQUE=0,0,5\nSFORCE/3, I=22, J=10, TRANSLATION, FUNCTION=-2*(DM(22,10)-100)\n\
    SPLINE/4, X=1,2,3, Y=4,5,6\nEND\n";

#[test]
fn keywords_of_adams_may_be_abbreviated_as_far_as_they_are_unique() {
    let full = driver_force(&import("p.adm", SPRUNG));
    let short = SPRUNG
        .replace("SPRINGDAMPER/1, I=22, J=10, TRANSLATION", "SPR/1, I=22, J=10, T")
        .replace("LENGTH=300, FORCE=12", "L=300, F=12")
        .replace("KGRAV=", "KG=")
        .replace("REVOLUTE", "REV")
        .replace("TORQUE=", "T=")
        .replace("BUSHING/2", "BU/2")
        .replace("SFORCE/3, I=22, J=10, TRANSLATION, FUNCTION=", "SF/3, I=22, J=10, TR, FU=")
        .replace("PART/2, MASS=", "PART/2, MA=")
        .replace("CM=21", "C=21");
    let short = short.replace(", MA=2", ", MAS=2");
    let imported = import("p.adm", &short);
    assert_eq!(entries(&imported, ElementOutcome::NotUnderstood), [], "{}", imported.report);
    let found = driver_force(&imported);
    assert!((found - full).abs() < ASSEMBLED, "{found} instead of {full}");
    // A flag may follow a function.
    let behind =
        SPRUNG.replace("TRANSLATION, FUNCTION=-2*(DM(22,10)-100)", "FUNCTION=-2*(DM(22,10)-100), TRANS");
    let found = driver_force(&import("p.adm", &behind));
    assert!((found - full).abs() < ASSEMBLED, "{found} instead of {full}");
    // Ambiguous keys and statements are reported.
    for (from, to, kind, reason) in [
        ("PART/2, MASS=", "PART/2, MA=", "MA", "ambiguous: MASS, MATERIAL"),
        ("SPLINE/4", "SP/4", "SP", "unknown statement"),
    ] {
        let imported = import("p.adm", &SPRUNG.replace(from, to));
        let found: Vec<_> = imported.report.of(ElementOutcome::NotUnderstood).collect();
        assert!(
            found.len() == 1 && found[0].kind == kind && found[0].why.contains(reason),
            "{}",
            imported.report
        );
    }
}

#[test]
fn unsupported_splines_and_motions_of_adams_are_reported() {
    let surface = SPRUNG.replace("X=1,2,3, Y=4,5,6", "X=1,2,3, Y=0.5,4,5,6, Y=0.7,6,7,8");
    let imported = import("p.adm", &surface);
    assert!(
        entries(&imported, ElementOutcome::Refused).contains(&("SPLINE", "SPLINE_4")),
        "{}",
        imported.report
    );
    // A motion that is refused leaves its joint to the input.
    let driven = SPRUNG.replace("ACCGRAV", "MOTION/1, ROTATIONAL, JOINT=1, FUNCTION=INVPSD(TIME)\nACCGRAV");
    let report = import("p.adm", &driven).report.to_string();
    assert!(report.contains("the motion is not imported"), "{report}");
    assert!(
        report.contains("no imported motion drives it: as the only degree of freedom it is the input"),
        "{report}"
    );
    assert!(!report.contains("nothing drives it in the source"), "{report}");
}

#[test]
fn extensions_of_urdf_that_change_loads_are_read_or_refused() {
    let robot = |content: &str| {
        format!(
            r#"<robot name="r"><link name="world"/><link name="a"><inertial><origin xyz="1 0 0"/><mass value="2"/></inertial></link><link name="b"/>
            <joint name="j" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 1 0"/></joint>
            <joint name="f" type="fixed"><parent link="a"/><child link="b"/></joint>{content}</robot>"#
        )
    };
    let gazebo = |content: &str| robot(&format!(r#"<gazebo reference="a">{content}</gazebo>"#));
    for (content, weight) in [
        ("", 2.0),
        ("<gravity>true</gravity>", 2.0),
        ("<gravity>false</gravity>", 0.0),
        ("<gravity>0</gravity>", 0.0),
        ("<turnGravityOff>true</turnGravityOff>", 0.0),
        ("<turnGravityOff>false</turnGravityOff>", 2.0),
    ] {
        let found = driver_force(&import("r.urdf", &gazebo(content)));
        assert!((found + weight * 9.80665).abs() < ASSEMBLED, "{content}: {found}");
    }
    let loop_joint = |content: &str| {
        robot(&format!(
            r#"<link name="c"/><joint name="k" type="floating"><parent link="world"/><child link="c"/></joint>
            <loop_joint name="l" type="revolute"><link1 link="a"/><link2 link="c"/><axis xyz="0 1 0"/>{content}</loop_joint>"#
        ))
    };
    for (text, kind) in [
        (gazebo("<dampingFactor>0.1</dampingFactor>"), "dampingFactor"),
        (gazebo(r#"<plugin name="p" filename="gz-sim-buoyancy-system"/>"#), "plugin"),
        (loop_joint(r#"<limit lower="-1" upper="1"/>"#), "limit"),
        (loop_joint(r#"<dynamics damping="3"/>"#), "dynamics"),
        (
            robot(
                r#"<transmission name="t"><actuator name="m"><drake:rotor_inertia value="0.01"/></actuator></transmission>"#,
            ),
            "rotor_inertia",
        ),
        (robot(r#"<mujoco><compiler settotalmass="3"/></mujoco>"#), "compiler"),
        (robot(r#"<mujoco><option gravity="0 0 0"/></mujoco>"#), "option"),
    ] {
        let imported = import("r.urdf", &text);
        let refused: Vec<&str> =
            entries(&imported, ElementOutcome::Refused).into_iter().map(|e| e.0).collect();
        assert_eq!(refused, [kind], "{}", imported.report);
    }
    let without = loop_joint(r#"<limit effort="1" velocity="1"/><dynamics damping="0"/>"#);
    let without = without
        .replace("</robot>", r#"<transmission name="t"/><mujoco><compiler meshdir="m"/></mujoco></robot>"#);
    let imported = import("r.urdf", &without);
    assert_eq!(entries(&imported, ElementOutcome::Refused), [], "{}", imported.report);
}

#[test]
fn forces_of_adams_without_equivalent_are_refused() {
    for (statement, kind) in [
        ("CONTACT/7, IGEOM=1, JGEOM=2", "CONTACT"),
        ("FRICTION/7, JOINT=1, MU_DYNAMIC=0.3", "FRICTION"),
        ("TIRE/7, JOINT=1", "TIRE"),
    ] {
        let imported = import("p.adm", &SPRUNG.replace("END\n", &format!("{statement}\nEND\n")));
        assert_eq!(
            entries(&imported, ElementOutcome::Refused).last().unwrap().0,
            kind,
            "{}",
            imported.report
        );
    }
}

/// Crank of Adams with a Hooke joint, whose pins are x of marker 31 and y of marker 22.
fn hooke(angle: &str) -> String {
    format!(
        "hooke\nUNITS/FORCE=NEWTON, MASS=KILOGRAM, LENGTH=MM, TIME=SECOND\nPART/1, GROUND\nMARKER/11, PART=1\n\
         MARKER/12, PART=1, QP=0,0,100\nPART/2\nMARKER/21, PART=2\nMARKER/22, PART=2, QP=0,0,50\nPART/3\n\
         MARKER/31, PART=3, QP=0,0,50, REULER={angle},0,0\nMARKER/32, PART=3, QP=0,0,100\nJOINT/1, REVOLUTE, I=21, J=11\n\
         JOINT/2, HOOKE, I=31, J=22\nJOINT/3, CYLINDRICAL, I=32, J=12\nMOTION/1, JOINT=1, ROTATIONAL, FUNCTION=30D*TIME\nEND\n"
    )
}

#[test]
fn a_cross_of_adams_has_the_pins_that_the_source_names() {
    let exact = import("h.adm", &hooke("0D"));
    assert!(entries(&exact, ElementOutcome::Taken).contains(&("JOINT", "JOINT_2")), "{}", exact.report);
    // Pins that are parallel, or nearly so. Other axes of the markers would be perpendicular.
    for angle in ["90D", "89.9999D"] {
        let parallel = import("h.adm", &hooke(angle));
        assert_eq!(
            entries(&parallel, ElementOutcome::Refused),
            [("JOINT", "JOINT_2")],
            "{}",
            parallel.report
        );
        assert!(parallel.report.to_string().contains("its two axes are parallel"), "{}", parallel.report);
    }
    let turned = import("h.adm", &hooke("30D"));
    assert!(
        entries(&turned, ElementOutcome::Approximated).contains(&("JOINT", "JOINT_2")),
        "{}",
        turned.report
    );
}

#[test]
fn splines_of_adams_are_approximated_and_constraints_without_equivalent_are_named() {
    let driven = "SPLINE/5, X=0,0.5,1,1.5,2, Y=0,10,-10,20,0\nMOTION/1, JOINT=1, ROTATIONAL, FUNCTION=AKISPL(TIME,0,5)*1D\n";
    let imported = import("p.adm", &SPRUNG.replace("END\n", &format!("{driven}END\n")));
    // Akima's spline is at 8.281 deg after 0.25 s, the natural cubic one at 9.6875 deg.
    assert_eq!(
        entries(&imported, ElementOutcome::Approximated),
        [("MOTION", "MOTION_1")],
        "{}",
        imported.report
    );
    for (statement, reason) in [
        ("GCON/7, FUNCTION=DX(22,10)", "a constraint by an expression has no equivalent"),
        ("UCON/7, FUNCTION=USER(1)\\", "a constraint by a subroutine has no equivalent"),
        ("PTCV/7, MARKER=22, CURVE=1", "a point on a curve has no equivalent"),
    ] {
        let report = import("p.adm", &SPRUNG.replace("END\n", &format!("{driven}{statement}\nEND\n"))).report;
        let report = report.to_string();
        assert!(report.contains(reason) && !report.contains("a driver fixes the motion"), "{report}");
    }
}

#[test]
fn lines_after_the_end_of_a_dataset_of_adams_are_not_read() {
    let whole = import("p.adm", SPRUNG);
    let longer = import("p.adm", &format!("{SPRUNG}! remark\nMARKER/23, PART=2, QP=0,1,0\nEND\n"));
    assert_eq!(longer.text, whole.text);
    let refused = longer.report.of(ElementOutcome::Refused).last().unwrap();
    assert_eq!((refused.kind.as_str(), refused.place.as_ref().unwrap().line), ("END", 18));
    assert!(refused.why.contains("it is not read"), "{refused}");
    // A title may be missing, or be a statement.
    let untitled = SPRUNG.split_once('\n').unwrap().1;
    assert_eq!(import("p.adm", untitled).report.of(ElementOutcome::NotUnderstood).count(), 0);
}

#[test]
fn repeated_elements_of_urdf_and_sdformat_are_reported_and_not_read() {
    let urdf = r#"<robot name="r"><link name="a"/><link name="b"><inertial><mass value="1"/><mass value="2"/></inertial></link>
        <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><axis xyz="1 0 0"/>
        <limit lower="-1" upper="1" effort="1" velocity="1"/><origin xyz="1 0 0"/><origin xyz="2 0 0"/></joint></robot>"#;
    let sdf = r#"<sdf version="1.7"><model name="m"><pose>0 0 1 0 0 0</pose><pose>0 0 2 0 0 0</pose><link name="A"/>
        <link name="B"><pose>1 0 0 0 0 0</pose></link><joint name="j" type="revolute"><parent>A</parent><child>B</child><child>A</child>
        <axis><xyz>0 0 1</xyz><xyz>0 1 0</xyz><dynamics><damping>1</damping></dynamics><dynamics><damping>2</damping></dynamics></axis>
        </joint></model></sdf>"#;
    for (name, text, expected) in [
        ("r.urdf", urdf, &[("axis", "j"), ("mass", "b"), ("origin", "j")][..]),
        ("m.sdf", sdf, &[("child", "j"), ("dynamics", "j"), ("pose", "m"), ("xyz", "j")]),
    ] {
        let imported = import(name, text);
        let mut found = entries(&imported, ElementOutcome::Refused);
        found.sort_unstable();
        assert_eq!(found, expected, "{}", imported.report);
        let file = crate::model(&imported);
        let joint = file.model.named_joints().find(|(_, j)| j.name == "j").unwrap().1;
        assert!((joint.frames[0].cols[2].z.abs() - 1.0).abs() < ASSEMBLED, "{}", imported.text);
        let dampers = imported.text.matches("damping =").count();
        assert_eq!(dampers, usize::from(name == "m.sdf"), "{}", imported.text);
    }
}

#[test]
fn a_long_report_lists_every_kind_of_entry() {
    let joints: String = (0..50)
        .map(|k| format!(r#"<body name="b{k}"><joint axis="0 1 0" armature="1"/><geom size="1"/></body>"#))
        .collect();
    let text = format!(
        r#"<mujoco><asset><mesh name="m" file="m.stl"/></asset><worldbody>{joints}
        <body name="last"><joint axis="0 1 0"/><geom type="mesh" mesh="m" group="3"/></body></worldbody></mujoco>"#
    );
    let report = import("m.xml", &text).report.to_string();
    assert!(report.contains("mass of geoms `last`"), "{report}");
    assert!(report.contains("... and 11 more: 11 armature\n"), "{report}");
}

#[test]
fn variables_and_splines_that_motions_of_adams_use_are_imported() {
    let text = "p\nUNITS/SYSTEM=MKS\nPART/1,GROUND\nMARKER/1,PART=1\nPART/2\nMARKER/2,PART=2\nPART/3\nMARKER/3,PART=3\n\
                JOINT/1,REVOLUTE,I=2,J=1\nJOINT/2,REVOLUTE,I=3,J=1\nVARIABLE/1,FUNCTION=TIME\nVARIABLE/2,FUNCTION=TIME\n\
                SPLINE/1,X=0,1,2,3,Y=0,1,0,1\nSPLINE/2,X=0,1,2,3,Y=0,1,0,1\n\
                MOTION/1,ROTATION,JOINT=1,FUNCTION=0.5*VARVAL(2)\nMOTION/2,ROTATION,JOINT=2,FUNCTION=AKISPL(TIME,0,1)\nEND\n";
    let imported = import("p.adm", text);
    let of = |fate, kind: &str| imported.report.of(fate).filter(|e| e.kind == kind).count();
    for kind in ["VARIABLE", "SPLINE"] {
        let counts = [ElementOutcome::Taken, ElementOutcome::Ignored].map(|fate| of(fate, kind));
        assert_eq!(counts, [1, 1], "{kind}: {}", imported.report);
    }
}

#[test]
fn damping_of_bushings_of_adams_that_is_not_imported_is_named() {
    for (damping, expected) in [
        ("C=1,1,1", ""),
        ("C=1,1,1, CT=2,2,2", "its damping about its axes is not imported"),
        ("C=1,1,2", "its damping is not imported, since it is not the same along all axes"),
    ] {
        let imported = import("p.adm", &SPRUNG.replace("K=1,2,3,", &format!("K=1,2,3, {damping},")));
        let why: Vec<&str> =
            imported.report.entries.iter().filter(|e| e.kind == "BUSHING").map(|e| e.why.as_str()).collect();
        assert_eq!(why, [expected], "{}", imported.report);
    }
}
