//! Accidental properties that the page does not depend on: units, names, number of output times, and parts that a model
//! leaves out.

use hardpoint::Analysis;
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::page::{Curve, Payload, html};
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;

fn parsed(text: &str) -> ModelFile {
    hardpoint_file::parse(text, "accidents.toml").unwrap_or_else(|e| panic!("{}", e.render(false)))
}

/// The page of a run, which must become a file.
fn page(file: &ModelFile) -> Payload {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(file, &analysis, &course);
    let page = payload(&Request::of(file, &analysis, &course, &summary));
    assert!(html(&page).unwrap().len() > 100_000);
    page
}

/// Every curve that has a value has one at each output time, or at each of its marks.
fn assert_whole(page: &Payload) {
    let steps = page.times.values().len();
    let whole = |curve: &Curve, parts: usize| {
        let values = curve.values();
        assert!(values.len() == parts * steps && values.iter().all(|x| x.is_finite()));
    };
    page.bodies.iter().for_each(|b| whole(&b.poses, 7));
    page.drivers.iter().for_each(|d| whole(&d.travel, 1));
    for q in &page.quantities {
        [&q.value, &q.rate, &q.accel]
            .into_iter()
            .filter(|c| !c.values().is_empty())
            .for_each(|c| whole(c, 1));
    }
    for v in &page.variables {
        v.shifts.iter().for_each(|s| whole(s, 6));
        for s in &v.sensitivities {
            [&s.value, &s.rate, &s.accel]
                .into_iter()
                .filter(|c| !c.values().is_empty())
                .for_each(|c| whole(c, 1));
        }
    }
}

/// A slider-crank in a unit of length and one of angle; `per` of that length are a metre, and `turn` of that angle a
/// full turn.
fn slider_crank(length: &str, per: f64, angle: &str, turn: f64) -> String {
    let place = |x: f64, y: f64| format!("[{}, {}, 0]", x * per, y * per);
    let (crank, rod) = (place(0.03, 0.04), place(0.18, 0.0));
    format!(
        "name = \"slider-crank\"
units = {{ length = \"{length}\", angle = \"{angle}\" }}
[hardpoints]
O = [0, 0, 0]
A = {crank}
B = {rod}
[bodies]
crank = {{}}
rod = {{}}
slider = {{}}
[joints]
bearing = {{ type = \"revolute\", bodies = [\"ground\", \"crank\"], at = \"O\", axis = \"z\" }}
pin = {{ type = \"revolute\", bodies = [\"crank\", \"rod\"], at = \"A\", axis = \"z\" }}
wrist = {{ type = \"revolute\", bodies = [\"rod\", \"slider\"], at = \"B\", axis = \"z\" }}
guide = {{ type = \"translational\", bodies = [\"ground\", \"slider\"], at = \"B\", axis = \"x\" }}
[drivers]
motor = {{ joint = \"bearing\", law = \"{turn}*t\" }}
[design]
A_x = {{ move = \"A\", along = \"x\" }}
B_y = {{ move = \"B\", along = \"y\" }}
guide_tilt = {{ tilt = \"guide\", about = \"z\" }}
[measures]
stroke = {{ type = \"coordinate\", joint = \"guide\" }}
angle = {{ type = \"coordinate\", joint = \"wrist\" }}
[metrics.way]
of = \"stroke\"
take = \"range\"
[time]
end = 1
steps = 60
"
    )
}

/// Tolerance of two pages, relative to a curve's largest value: the page holds `f32`.
const SINGLE: f64 = 1e-6;

/// Asserts that one curve is the other one times a factor.
fn assert_scaled(what: &str, a: &Curve, b: &Curve, factor: f64) {
    let most = a.values().iter().fold(0.0_f64, |most, x| most.max(f64::from(x.abs())));
    assert_eq!(a.values().len(), b.values().len(), "{what}");
    for (k, (a, b)) in a.values().iter().zip(b.values()).enumerate() {
        let off = (f64::from(*b) / factor - f64::from(*a)).abs();
        assert!(off <= SINGLE * most, "{what} at {k}: {a} {b}");
    }
}

#[test]
fn units_change_numbers_by_their_factor_alone() {
    let si = page(&parsed(&slider_crank("m", 1.0, "rad", 2.0 * std::f64::consts::PI)));
    for (length, per) in [("m", 1.0), ("mm", 1e3), ("cm", 1e2), ("in", 1.0 / 0.0254)] {
        for (angle, turn) in [("rad", 2.0 * std::f64::consts::PI), ("deg", 360.0)] {
            let other = page(&parsed(&slider_crank(length, per, angle, turn)));
            let what = |name: &str| format!("{name} in {length} and {angle}");
            assert_whole(&other);
            let degree = turn / (2.0 * std::f64::consts::PI);
            let factor = |unit: &str| match unit {
                "m" => per,
                "rad" => degree,
                _ => panic!("{unit}"),
            };
            assert_eq!(si.first, other.first);
            assert_eq!(si.quantities.len(), other.quantities.len());
            for (a, b) in si.quantities.iter().zip(&other.quantities) {
                for (a, b, unit) in [
                    (&a.value, &b.value, &a.unit),
                    (&a.rate, &b.rate, &a.unit),
                    (&a.accel, &b.accel, &a.unit),
                ] {
                    assert_scaled(&what(unit), a, b, factor(unit));
                }
            }
            for (a, b) in si.values.iter().zip(&other.values) {
                let (x, y) = (a.value.unwrap(), b.value.unwrap());
                assert!((y / factor(&a.unit) - x).abs() <= 1e-9 * (1.0 + x.abs()), "{}", what(&a.name));
            }
            for (a, b) in si.variables.iter().zip(&other.variables) {
                let by = factor(&a.unit);
                for (k, (a, b)) in a.sensitivities.iter().zip(&b.sensitivities).enumerate() {
                    let of = factor(&si.quantities[k].unit) / by;
                    assert_scaled(&what(&si.quantities[k].name), &a.value, &b.value, of);
                    assert_scaled(&what(&si.quantities[k].name), &a.accel, &b.accel, of);
                }
                assert_eq!(a.shifts.len(), b.shifts.len());
            }
            for (a, b) in si.bodies.iter().zip(&other.bodies) {
                let turns = |poses: &Curve| {
                    poses
                        .values()
                        .chunks(7)
                        .flat_map(|p| p[3..].iter().map(|x| f64::from(*x)))
                        .collect::<Curve>()
                };
                let places = |poses: &Curve| {
                    poses
                        .values()
                        .chunks(7)
                        .flat_map(|p| p[..3].iter().map(|x| f64::from(*x)))
                        .collect::<Curve>()
                };
                assert_scaled(&what(&a.name), &turns(&a.poses), &turns(&b.poses), 1.0);
                assert_scaled(&what(&a.name), &places(&a.poses), &places(&b.poses), per);
            }
        }
    }
}

#[test]
fn one_output_time_or_ten_thousand_are_a_page() {
    let text = slider_crank("mm", 1e3, "deg", 360.0);
    let whole = page(&parsed(&text));
    for (times, shown) in [
        ("at = [0]\n", 1),
        ("end = 1\nsteps = 1\n", 2),
        ("end = 1\nsteps = 2\n", 3),
        ("end = 1\nsteps = 10000\n", 910),
    ] {
        let page = page(&parsed(&text.replace("end = 1\nsteps = 60\n", times)));
        assert_whole(&page);
        assert_eq!(page.times.values().len(), shown, "{times}");
        assert!(page.status.complete);
        // The start is independent of the number of output times.
        for (a, b) in page.quantities.iter().zip(&whole.quantities) {
            let (x, y) = (a.value.values()[0], b.value.values()[0]);
            assert!((x - y).abs() <= 1e-5 * (1.0 + y.abs()), "{} {x} {y}", a.name);
        }
    }
}

#[test]
fn names_are_escaped_as_text() {
    /// The address of a server, the data, the engine, the code and its loader.
    const SCRIPTS: usize = 5;
    for name in [
        "a b",
        "O'Brien",
        "ä→ß 車",
        "</script><script>alert(1)</script>",
        "{{payload}} & \\u0022",
        "<!--",
        "%%\u{2028}",
    ] {
        let plain = slider_crank("mm", 1e3, "deg", 360.0);
        let quoted = serde_json::to_string(name).unwrap();
        let text =
            plain.replace("name = \"slider-crank\"", &format!("name = {quoted}\ndescription = {quoted}"));
        let text = text
            .replace("stroke = {", &format!("{quoted} = {{"))
            .replace("of = \"stroke\"", &format!("of = {quoted}"));
        let file = hardpoint_file::parse(&text, &format!("{name}.toml"));
        let Ok(file) = file else { panic!("{name}: {}", file.unwrap_err().render(false)) };
        let page = page(&file);
        assert_eq!(page.title, name);
        assert!(page.quantities.iter().any(|q| q.name == name) && page.values.iter().any(|v| v.name == name));
        let html = html(&page).unwrap();
        // Only the page's own elements, whatever names the model contains.
        assert_eq!(html.matches("<script").count(), SCRIPTS, "{name}");
        assert_eq!(html.matches("</script>").count(), SCRIPTS, "{name}");
    }
}

#[test]
fn a_model_without_variables_or_measures_is_a_page() {
    let text = slider_crank("mm", 1e3, "deg", 360.0);
    let cut = |text: &str, from: &str, to: &str| {
        let (a, b) = (text.find(from).unwrap(), text.find(to).unwrap());
        [&text[..a], &text[b..]].concat()
    };
    let whole = page(&parsed(&text));
    let fixed = page(&parsed(&cut(&text, "[design]", "[measures]")));
    assert_whole(&fixed);
    assert!(fixed.variables.is_empty() && fixed.first == whole.first);
    let digits = |page: &Payload| {
        page.quantities.iter().map(|q| format!("{:?}", q.value.values())).collect::<Vec<_>>()
    };
    assert_eq!(digits(&fixed), digits(&whole));
    let bare = page(&parsed(&cut(&text, "[measures]", "[time]")));
    assert_whole(&bare);
    assert!(bare.values.is_empty() && bare.quantities.iter().all(|q| q.group == "body"));
    assert_eq!(bare.variables.len(), 3);
    let nothing = page(&parsed(&cut(&text, "[design]", "[time]")));
    assert_whole(&nothing);
    assert!(nothing.values.is_empty() && nothing.variables.is_empty());
}

#[test]
fn a_motion_that_stops_at_once_has_a_page_of_its_results() {
    let text = slider_crank("mm", 1e3, "deg", 360.0);
    // Stretched, crank and rod reach 25 mm farther than in the design configuration.
    let pulled = |law: &str| {
        text.replace("joint = \"bearing\", law = \"360*t\"", &format!("joint = \"guide\", law = \"{law}\""))
    };
    for (law, solved) in [("3000*t", 1), ("1000*t", 2), ("400", 0)] {
        let file = parsed(&pulled(law));
        let page = page(&file);
        assert_whole(&page);
        assert_eq!(page.times.values().len(), solved, "{law}");
        assert!(!page.status.complete);
        assert!(
            page.status.message.contains(&format!("Solved {solved} of 61 steps; then the mechanism")),
            "{}",
            page.status.message
        );
        // Without contents there is no first quantity and no single value.
        assert!(solved > 0 || page.first.is_none() && page.values.iter().all(|v| v.value.is_none()));
    }
}
