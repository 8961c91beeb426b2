//! Clearances: published data of a knee, shapes against samples, metamorphic checks.

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint::run::{Clearances, MinimumPlace, PairClearance};
use hardpoint_file::parse;
use serde_json::Value;

/// Round-off of distances in mm, and of times in s, at values of 10 to 100.
const EXACT: f64 = 1e-10;

fn model_of(text: &str) -> Model {
    parse(text, "clearance.toml").unwrap_or_else(|e| panic!("{e}\n{text}")).model
}

fn number(value: &Value) -> f64 {
    value.as_str().map_or_else(|| value.as_f64().unwrap(), |text| text.parse().unwrap())
}

fn pair<'c>(model: &'c Model, found: &'c Clearances, clearance: &str) -> &'c PairClearance {
    let clearance = model.clearances.iter().find(|c| c.name == clearance).unwrap();
    found.of(clearance).next().unwrap().1
}

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() <= EXACT * expected.abs().max(1.0),
        "{what}: {found} instead of {expected}"
    );
}

/// Four-bar with rods against screw heads: values at 50 digits, by other kinematics and by the formulas of
/// the design note.
const KNEE: &str = include_str!("knee.toml");

#[test]
fn minima_and_contacts_of_the_knee_are_those_of_the_published_data() {
    let data: Value = serde_json::from_str(include_str!("knee.json")).unwrap();
    let model = model_of(KNEE);
    let found = Analysis::new(&model).unwrap().clearances(&[]);
    let pairs = [("c1", "coupler-screw1"), ("c2", "coupler-screw2"), ("r1", "rocker-screw1")];
    let name = |v: &str| match v {
        "screw1_x" | "screw1_y" | "screw2_x" | "screw2_y" => v.replace('_', ".").replace('.', "_"),
        other => other.to_string(),
    };
    let derivatives = |d: &[f64], by: &Value, per: f64, what: &str| {
        for (v, expected) in by.as_object().unwrap() {
            let variable = model.variable(&name(v)).unwrap_or_else(|| panic!("{v} {:?}", model.variables));
            assert_near(d[variable.0] * per, number(expected), &format!("{what} by {v}"));
        }
    };
    for (clearance, key) in pairs {
        let expected = &data["pairs"][key];
        let pair = pair(&model, &found, clearance);
        for row in expected["curve"].as_array().unwrap() {
            let at = &pair.curve[row[0].as_u64().unwrap() as usize];
            for (order, x) in at.distance.iter().enumerate() {
                assert_near(
                    x * 1e3,
                    number(&row[order + 1]),
                    &format!("{key}, order {order} at {}", at.time),
                );
            }
        }
        let inside: Vec<_> = pair.minima.iter().filter(|m| m.place == MinimumPlace::Inside).collect();
        let minima = expected["minima"].as_array().unwrap();
        let minima: Vec<_> = minima
            .iter()
            .filter(|m| (0.0..1.0).contains(&number(&m["t"])) && number(&m["t"]) > 0.0)
            .collect();
        assert_eq!(inside.len(), minima.len(), "{key}");
        for (minimum, expected) in inside.iter().zip(minima) {
            assert_near(minimum.at.time, number(&expected["t"]), key);
            assert_near(minimum.at.distance[0] * 1e3, number(&expected["value"]), key);
            assert_near(minimum.at.distance[2] * 1e3, number(&expected["second_rate"]), key);
            derivatives(&minimum.d, &expected["by"], 1.0, key);
        }
        let contacts = expected["contacts"].as_array().unwrap();
        assert_eq!(pair.contacts.len(), contacts.len(), "{key}");
        for (contact, expected) in pair.contacts.iter().zip(contacts) {
            assert_near(contact.at.time, number(&expected["t"]), key);
            assert_eq!(contact.begins, expected["kind"] == "touches");
            assert_near(contact.at.distance[1] * 1e3, number(&expected["rate"]), key);
            derivatives(&contact.d, &expected["by"], 1e-3, key);
        }
    }
}

#[test]
fn the_least_of_several_pairs_is_a_metric() {
    let model = model_of(KNEE);
    let solution = Analysis::new(&model).unwrap().run();
    let values = hardpoint::run::metrics(&model, &solution);
    let of = |name: &str| {
        let k = model.metrics.iter().position(|m| m.name == name).unwrap();
        values[k].value.unwrap() * 1e3
    };
    assert_near(of("c1.min"), -0.2064275563667836, "c1");
    assert_near(of("c2.min"), 1.794967044519548, "c2");
    assert_near(of("r1.min"), 2.541030034433604, "r1");
    assert_near(of("all.min"), -0.2064275563667836, "all");
}
