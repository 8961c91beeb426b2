//! Clearances of a wishbone suspension, of the legs of a Stewart platform, and of a scissor lift, against positions and
//! distances that were computed without Hardpoint at 40 digits (`linkage_clearances.json`).

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint::run::{ClearanceMinimum, ClearanceProof, Clearances, MinimumPlace, PairClearance};
use hardpoint::topology::Formulation;
use hardpoint_file::parse;
use hardpoint_study::grid::{GridClearances, GridPlace};
use serde_json::Value;

/// Round-off of distances in mm, of times in s and of their derivatives, at values of 10 to 1000.
const EXACT: f64 = 1e-10;

fn model_of(text: &str) -> Model {
    parse(text, "linkage.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn gallery(name: &str) -> String {
    std::fs::read_to_string(format!("../../models/{name}.toml")).unwrap()
}

fn reference(key: &str) -> Value {
    let data: Value = serde_json::from_str(include_str!("linkage_clearances.json")).unwrap();
    data[key].clone()
}

fn number(value: &Value) -> f64 {
    value.as_str().unwrap().parse().unwrap()
}

fn pair<'c>(model: &'c Model, found: &'c Clearances, clearance: &str) -> &'c PairClearance {
    let clearance = model.clearances.iter().find(|c| c.name == clearance).unwrap();
    found.of(clearance).next().unwrap().1
}

fn assert_near(found: f64, expected: f64, what: &str) {
    let apart = (found - expected).abs();
    assert!(apart <= EXACT * expected.abs().max(1.0), "{what}: {found} instead of {expected}");
}

/// Derivatives by design variables; `name` is that of a variable of the model.
fn assert_derivatives(
    model: &Model,
    d: &[f64],
    by: &Value,
    (per, name): (f64, &dyn Fn(&str) -> String),
    what: &str,
) {
    for (v, expected) in by.as_object().unwrap() {
        let variable = model.variable(&name(v)).unwrap_or_else(|| panic!("{v} {:?}", model.variables));
        assert_near(d[variable.0] * per, number(expected), &format!("{what} by {v}"));
    }
}

/// Distances at some output times; `less` is what the reference leaves out, in mm.
fn assert_curve(pair: &PairClearance, expected: &Value, less: f64, what: &str) {
    for row in expected.as_array().unwrap() {
        let at = &pair.curve[row[0].as_u64().unwrap() as usize];
        assert_near(at.distance[0] * 1e3, number(&row[1]) - less, &format!("{what} at {}", at.time));
    }
}

fn minimum_at(pair: &PairClearance, time: f64) -> &ClearanceMinimum {
    let inside = pair.minima.iter().filter(|m| m.place == MinimumPlace::Inside);
    inside.min_by(|a, b| (a.at.time - time).abs().total_cmp(&(b.at.time - time).abs())).unwrap()
}

fn assert_minimum(
    model: &Model,
    pair: &PairClearance,
    expected: &Value,
    less: f64,
    name: &dyn Fn(&str) -> String,
    what: &str,
) {
    let found = minimum_at(pair, number(&expected["t"]));
    assert_near(found.at.time, number(&expected["t"]), what);
    assert_near(found.at.distance[0] * 1e3, number(&expected["value"]) - less, what);
    assert_near(found.at.distance[2] * 1e3, number(&expected["second_rate"]), what);
    assert_derivatives(model, &found.d, &expected["by"], (1.0, name), what);
}

fn assert_contacts(
    model: &Model,
    pair: &PairClearance,
    expected: &Value,
    name: &dyn Fn(&str) -> String,
    what: &str,
) {
    let expected = expected.as_array().unwrap();
    assert_eq!(pair.contacts.len(), expected.len(), "{what}");
    for (found, expected) in pair.contacts.iter().zip(expected) {
        let rate = number(&expected["rate"]);
        assert_near(found.at.time, number(&expected["t"]), what);
        assert_near(found.at.distance[1] * 1e3, rate, what);
        assert_eq!(found.begins, rate < 0.0, "{what}");
        assert_derivatives(model, &found.d, &expected["by"], (1e-3, name), what);
    }
}

#[test]
fn a_suspension_is_as_near_to_its_wheel_as_distances_of_its_points_show() {
    let model = model_of(&gallery("wheel_clearance"));
    let analysis = Analysis::new(&model).unwrap();
    let found = analysis.clearances(&[]);
    let mut prover = analysis.clearance_prover(&[]).unwrap();
    for (name, expected) in reference("wheel_clearance").as_object().unwrap() {
        let pair = pair(&model, &found, name);
        assert_curve(pair, &expected["curve"], 0.0, name);
        assert_minimum(&model, pair, expected, 0.0, &str::to_string, name);
        let least = pair.least().unwrap().at.distance[0];
        assert_near(least * 1e3, number(&expected["value"]), name);
        // Rods that reach into the ring of the rim, too.
        let proof = prover.prove(pair.shapes, least - 1e-12 * model.size());
        assert!(matches!(proof, ClearanceProof::Proved { .. }), "{name}: {proof:?}");
        let refused = prover.prove(pair.shapes, least + 1e-9);
        assert!(matches!(refused, ClearanceProof::NotProved { .. }), "{name}: {refused:?}");
    }
}

#[test]
fn a_tie_rod_touches_a_smaller_rim_at_the_times_at_which_its_distance_is_its_radii() {
    let text = gallery("wheel_clearance").replace("value = 122", "value = 104");
    let model = model_of(&text);
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let (pair, expected) = (pair(&model, &found, "rod_to_lip"), reference("touching"));
    assert_contacts(&model, pair, &expected["contacts"], &str::to_string, "rod_to_lip");
    let deepest = pair.least().unwrap().at;
    assert_near(deepest.time, number(&expected["t"]), "deepest");
    assert_near(deepest.distance[0] * 1e3, number(&expected["value"]), "deepest");
}

#[test]
fn a_suspension_over_travel_and_steering_is_nearest_at_an_edge_or_a_corner() {
    let model = model_of(&gallery("wheel_clearance"));
    let grid = &model.grids[0];
    let found = GridClearances::solve(&model, grid, Formulation::Relative, &[], &|| true).unwrap();
    let inside = ["rod_to_lip"];
    for (name, expected) in reference("map").as_object().unwrap() {
        let clearance = model.clearances.iter().find(|c| c.name == *name).unwrap();
        let pair = found.pairs.iter().find(|p| p.shapes == clearance.pairs[0].shapes).unwrap();
        let least = &pair.minima[0];
        let place = if inside.contains(&name.as_str()) { GridPlace::Edge } else { GridPlace::Corner };
        assert_eq!(least.place, place, "{name}");
        // Along the drivers the distance is stationary: their values are known to the root of its round-off.
        for (value, key) in least.drivers.iter().zip(["bump", "steering"]) {
            assert!((value * 1e3 - number(&expected[key])).abs() < 1e-6, "{name}: {key} {value}");
        }
        assert_near(least.at.distance[0] * 1e3, number(&expected["value"]), name);
        assert_derivatives(&model, &least.d, &expected["by"], (1.0, &str::to_string), name);
    }
}

/// The platform of the gallery with two legs that cross each other.
fn platform() -> String {
    let legs = gallery("stewart")
        .replace("base_6 = [492.404,", "base_6 = [430,")
        .replace("top_1 = [192.836, 229.813", "top_1 = [192.836, -229.813")
        .replace("top_6 = [192.836, -229.813", "top_6 = [192.836, 229.813");
    let variables = "base_6 = { move = \"base_6\", along = \"xyz\" }\n\
         top_1 = { move = \"top_1\", along = \"xyz\" }\n";
    let shapes = "[parameters]\nleg_radius = { value = 12.5, unit = \"length\" }\n\
         [shapes]\nleg_1 = { capsule = \"leg_1\", radius = \"leg_radius\" }\n\
         leg_6 = { capsule = \"leg_6\", radius = 12.5 }\n\
         [clearances]\nlegs = { between = [\"leg_1\", \"leg_6\"] }\n";
    let legs = legs.replace("top_1_z = { move = \"top_1\", along = \"z\" }\n", variables);
    format!("{legs}\n{shapes}")
}

#[test]
fn crossing_legs_of_a_platform_touch_at_the_times_at_which_their_distance_is_their_radii() {
    let model = model_of(&platform());
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let (pair, expected) = (pair(&model, &found, "legs"), reference("stewart"));
    assert_curve(pair, &expected["curve"], 25.0, "legs");
    for minimum in expected["minima"].as_array().unwrap() {
        assert_minimum(&model, pair, minimum, 25.0, &str::to_string, "legs");
        let time = number(&minimum["t"]);
        let radius = model.variable("leg_radius").unwrap().0;
        assert_near(minimum_at(pair, time).d[radius], -1.0, "legs by leg_radius");
    }
    assert_contacts(&model, pair, &expected["contacts"], &str::to_string, "legs");
}

/// The scissor lift of the gallery with its lowest bars in layers, and its cylinder beside a tube.
fn scissor() -> String {
    format!(
        "{}\n{}",
        gallery("scissor_lift"),
        "[shapes]\n\
         right_bar = { body = \"right_arm_1\", capsule = [[0, 0, 20], [960, 280, 20]], radius = 12 }\n\
         left_bar = { body = \"left_arm_1\", capsule = [[960, 0, -20], [0, 280, -20]], radius = 12 }\n\
         pump = { capsule = \"cylinder\", radius = 40 }\n\
         tube = { body = \"right_arm_1\", capsule = [[960, 280, -150], [960, 280, 150]], radius = 15 }\n\
         [clearances]\n\
         bars = { between = [\"right_bar\", \"left_bar\"] }\n\
         pump = { between = [\"pump\", \"tube\"] }\n"
    )
}

#[test]
fn the_cylinder_of_a_scissor_lift_is_nearest_to_a_tube_where_its_closed_form_is() {
    let model = model_of(&scissor());
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let (pump, expected) = (pair(&model, &found, "pump"), reference("scissor"));
    let name = |v: &str| format!("cylinder_{v}");
    assert_curve(pump, &expected["curve"], 55.0, "pump");
    for minimum in expected["minima"].as_array().unwrap() {
        assert_minimum(&model, pump, minimum, 55.0, &name, "pump");
    }
    // A larger cylinder touches at the times at which the cores are as far apart as both radii.
    let at_seven = pump.curve[35].distance[0] * 1e3 + 40.0;
    let larger = scissor().replace("radius = 40", &format!("radius = {at_seven}"));
    let model = model_of(&larger);
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    assert_contacts(&model, pair(&model, &found, "pump"), &expected["contacts"], &name, "pump");
    // Bars in layers are as far apart at all times, whatever their positions.
    let bars = pair(&model, &found, "bars");
    assert!(bars.is_constant);
    for at in &bars.curve {
        assert_near(at.distance[0] * 1e3, 16.0, "bars");
        assert!(at.distance[1].abs() < 1e-12, "{at:?}");
    }
}
