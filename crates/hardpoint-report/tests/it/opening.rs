//! Opening of the page: plots and named designs of the model file, and the types of quantities.

use hardpoint::Analysis;
use hardpoint_report::course::Course;
use hardpoint_report::page::{Admissibility, NamedChange, NamedDesign, Payload, Plot};
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;

fn page(text: &str) -> Payload {
    let file = hardpoint_file::parse(text, "models.toml").unwrap_or_else(|e| panic!("{e}"));
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(&file, analysis.topology(), &course);
    payload(&Request::of(&file, &analysis, &course, &summary))
}

const STRUT: &str = include_str!("../../../../models/macpherson.toml");
const AXLE: &str = include_str!("../../../../models/front_axle.toml");

#[test]
fn plots_of_the_file_are_those_of_the_page() {
    let plots = "\n[page]\nplots = [{ y = [\"camber\", \"toe\"], over = \"wheel_travel\" }, { y = [\"contact_point.y\"] }]\n";
    let page = page(&format!("{STRUT}{plots}"));
    let of = |name: &str| page.quantities.iter().position(|q| q.name == name).unwrap();
    let expected = [
        Plot { y: vec![of("camber"), of("toe")], over: Some(of("wheel_travel")) },
        Plot { y: vec![of("contact_point.y")], over: None },
    ];
    assert_eq!(page.plots, expected);
    assert_eq!(self::page(STRUT).plots, []);
}

#[test]
fn named_designs_have_changes_in_the_units_of_the_file() {
    let page = page(&format!("{STRUT}\n[designs.higher]\ntie_rod_outer_z = 2.5\nlca_tilt = -0.5\n"));
    let by = |design: &NamedDesign, name: &str| {
        design.changes.iter().find(|c: &&NamedChange| c.name == name).map(|c| c.by).unwrap()
    };
    let [higher] = &page.named_designs[..] else { panic!("{:?}", page.named_designs) };
    assert_eq!(higher.name, "higher");
    assert!((by(higher, "tie_rod_outer_z") - 2.5).abs() < 1e-12);
    assert!((by(higher, "lca_tilt") + 0.5).abs() < 1e-12);
}

#[test]
fn quantities_have_the_types_of_their_measures() {
    let page = page(AXLE);
    let kind = |name: &str| page.quantities.iter().find(|q| q.name == name).unwrap().kind.as_str();
    for (name, expected) in [
        ("left.toe", "toe"),
        ("left.wheel_travel", "wheel_travel"),
        ("front.ackermann_error", "ackermann_error"),
        ("left_motion_ratio", "slope"),
        ("left_hop", "acceleration"),
        ("left_wheel_centre.x", "position"),
        ("left_knuckle.z", "position"),
    ] {
        assert_eq!(kind(name), expected, "{name}");
    }
}

#[test]
fn a_variable_that_opens_a_joint_by_rounded_coordinates_is_not_called_a_reassembly() {
    let admissibility =
        |text: &str, name: &str| page(text).variables.iter().find(|v| v.name == name).unwrap().admissibility;
    // 2.8e-7 mm per mm.
    let cam = include_str!("../../../../models/cam.toml");
    assert_eq!(admissibility(cam, "camshaft_x"), Admissibility::Admissible);
    // 0.99 mm per mm.
    let rack = include_str!("../../../../models/double_wishbone.toml");
    assert_eq!(admissibility(rack, "tie_rod_outer_y_fixed_length"), Admissibility::Reassembled);
}
