//! Contents of the page for every model of the gallery: its drawing, its values, and what it opens on.

use std::path::{Path, PathBuf};

use hardpoint::Analysis;
use hardpoint_file::ModelFile;
use hardpoint_report::course::Course;
use hardpoint_report::page::{CouplerKind, Payload};
use hardpoint_report::payload::{Request, payload};
use hardpoint_report::summary::Summary;

fn gallery() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut models: Vec<PathBuf> = files.filter(|p| p.extension().is_some_and(|e| e == "toml")).collect();
    models.sort();
    assert!(models.len() > 30);
    models
}

fn model(name: &str) -> ModelFile {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    hardpoint_file::read(&folder.join(format!("{name}.toml"))).unwrap()
}

/// Page of a model in its motion.
pub fn page_of(file: &ModelFile) -> Payload {
    let analysis = Analysis::new(&file.model).unwrap();
    let solution = analysis.run();
    let course = Course::of(&file.model, &solution);
    let summary = Summary::new(file, &analysis, &course);
    payload(&Request::of(file, &analysis, &course, &summary))
}

fn close(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-9 * expected.abs().max(1.0)
}

/// The models of the gallery, each with its page.
fn pages() -> Vec<(String, ModelFile, Payload)> {
    let page = |path: PathBuf| {
        let file = hardpoint_file::read(&path).unwrap();
        let page = page_of(&file);
        (path.file_stem().unwrap().to_string_lossy().into_owned(), file, page)
    };
    gallery().into_iter().map(page).collect()
}

#[test]
fn facts_of_every_model_refer_to_items_on_its_page() {
    for (name, file, page) in pages() {
        let bodies = page.bodies.len();
        for body in &page.bodies {
            assert_eq!((body.skeleton.len(), body.skeleton.len()), (body.labels.len(), body.roles.len()));
        }
        for coupler in &page.couplers {
            assert!(coupler.terms.iter().all(|t| t.joint < page.joints.len()), "{name}: {}", coupler.name);
            assert!(coupler.terms.len() >= 2);
        }
        assert_eq!(page.drivers.len(), file.model.drivers.len());
        for (driver, of) in page.drivers.iter().zip(&file.model.drivers) {
            let driven = &file.model.joints[of.joint.0];
            match driver.joint {
                Some(joint) => assert_eq!(page.joints[joint].name, driven.name, "{name}"),
                None => assert!(driver.point.is_some_and(|p| p.body < bodies) && driver.along.is_some()),
            }
            assert_eq!(driver.travel.values().len(), page.times.values().len());
        }
        for joint in &page.joints {
            assert!(joint.body_i < bodies && joint.body_j < bodies);
            for direction in [joint.axis, joint.axis_j, joint.axis2].into_iter().flatten() {
                assert!(close(direction.iter().map(|x| x * x).sum(), 1.0), "{name}: {}", joint.name);
            }
            assert_eq!(joint.lead.is_some(), joint.kind == "screw", "{name}: {}", joint.name);
            assert_eq!(joint.curve.is_some(), joint.kind == "point_on_curve", "{name}: {}", joint.name);
        }
        assert_eq!(page.vehicle.is_some(), !file.model.wheels.is_empty());
        for value in &page.values {
            assert_eq!(value.sensitivities.len(), page.variables.len());
            assert!(value.quantity.is_some_and(|q| q < page.quantities.len()), "{name}: {}", value.name);
        }
        assert_eq!(page.values.len(), file.model.metrics.len() + file.model.measures.len(), "{name}");
    }
}

#[test]
fn every_model_opens_on_a_quantity_that_varies_and_follows_the_design() {
    for (name, file, page) in pages() {
        let first = page.first.unwrap_or_else(|| panic!("{name} opens on nothing"));
        let quantity = &page.quantities[first];
        assert_eq!(quantity.group, "measure", "{name}");
        let values = quantity.value.values();
        let [least, greatest] = [f32::min, f32::max].map(|of| values.iter().copied().reduce(of).unwrap());
        assert!(greatest - least > 1e-6 * greatest.abs().max(least.abs()), "{name}: {}", quantity.name);
        let moved = page.variables.iter().flat_map(|v| &v.sensitivities);
        let moved = moved.filter(|s| s.quantity == first).flat_map(|s| s.value.values());
        assert!(moved.map(|d| d.abs()).fold(0.0, f32::max) > 0.0, "{name}: {}", quantity.name);
        let in_metric = |q: &str| file.model.metrics.iter().any(|m| file.model.output_name(m.of) == q);
        if !file.model.metrics.is_empty() {
            assert!(
                in_metric(&quantity.name),
                "{name} opens on {} rather than what a metric is of",
                quantity.name
            );
        }
    }
}

#[test]
fn couplers_are_what_the_file_says_in_its_units() {
    let page = page_of(&model("gear_train"));
    let kinds: Vec<_> = page.couplers.iter().map(|c| (c.kind, c.sizes.clone())).collect();
    let near = |sizes: &[f64], expected: &[f64]| {
        sizes.len() == expected.len() && sizes.iter().zip(expected).all(|(x, y)| close(*x, *y))
    };
    let expected: [(CouplerKind, &[f64]); 6] = [
        (CouplerKind::Belt, &[40.0, 60.0]),
        (CouplerKind::Gear, &[20.0, 80.0]),
        (CouplerKind::Bevel, &[15.0, 45.0]),
        (CouplerKind::Rack, &[12.0]),
        (CouplerKind::Linear, &[]),
        (CouplerKind::Screw, &[4.0]),
    ];
    assert_eq!(kinds.len(), expected.len());
    for ((kind, sizes), (of, as_written)) in kinds.iter().zip(expected) {
        assert!(*kind == of && near(sizes, as_written), "{kind:?} {sizes:?}");
    }
    let rack = &page.couplers[3];
    assert_eq!(page.joints[rack.terms[0].joint].name, "quill");
    assert!(!rack.terms[0].turns && rack.terms[1].turns);
    // displacement in mm = 12 mm x angle in rad
    assert!(close(rack.terms[1].coefficient / rack.terms[0].coefficient, -12.0));
    let thread = page.joints.iter().find(|j| j.name == "thread").unwrap();
    assert!(close(thread.lead.unwrap(), 4.0));
    assert_eq!(page.drivers[0].law, "smooth step of degree 5 from 0 at 0 s to 3600 at 4 s deg");
}

#[test]
fn a_cam_s_curve_is_that_of_the_model_on_its_body() {
    let page = page_of(&model("cam"));
    let roller = page.joints.iter().find(|j| j.name == "roller").unwrap();
    let curve = roller.curve.as_ref().unwrap();
    assert!(curve.closed && curve.points.len() >= 200);
    let centre = roller.at_i;
    let radius = |p: &[f64; 3]| (p[0] - centre[0]).hypot(p[1] - centre[1]);
    let [least, most] = [f64::min, f64::max].map(|of| curve.points.iter().map(radius).reduce(of).unwrap());
    // A base circle of 45 mm and a rise of 20 mm.
    assert!((least - 45.0).abs() < 0.01 && (most - 65.0).abs() < 0.01, "{least} {most}");
    assert_eq!(curve.normal, [0.0, 0.0, 1.0]);
}

#[test]
fn a_wheel_is_where_the_model_has_it_and_its_centre_is_no_joint() {
    let page = page_of(&model("double_wishbone_4x4"));
    let [wheel] = &page.wheels[..] else { panic!("one wheel") };
    assert!(close(wheel.radius, 279.4) && wheel.kingpin.is_some());
    let body = &page.bodies[wheel.centre.body];
    let centre = body.labels.iter().position(|l| l.contains("wheel_centre")).unwrap();
    assert_eq!(body.skeleton[centre], wheel.centre.at);
    assert_eq!(serde_json::to_value(body.roles[centre]).unwrap(), "wheel");
    let vehicle = page.vehicle.unwrap();
    assert_eq!((vehicle.forward, vehicle.up), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    // The driven point is the wheel's centre, which moves upwards.
    let bump = page.drivers.iter().find(|d| d.name == "bump").unwrap();
    assert!(bump.joint.is_none() && bump.along.unwrap()[2] > 0.999);
    assert_eq!(bump.point.unwrap().body, wheel.centre.body);
}

#[test]
fn axes_of_a_universal_joint_are_on_the_bodies_that_carry_them() {
    let page = page_of(&model("hooke"));
    let cross = page.joints.iter().find(|j| j.name == "cross").unwrap();
    // The output fork's frame is turned by the quaternion [1, 0.1, 0, 0.2], of square 1.05: z of the world in it.
    let (w, x, z): (f64, f64, f64) = (1.0, 0.1, 0.2);
    let expected = [2.0 * x * z, 2.0 * w * x, w * w - x * x + z * z].map(|e| e / 1.05);
    let found = cross.axis2.unwrap();
    assert!((0..3).all(|k| close(found[k], expected[k])), "{found:?} {expected:?}");
    let hinge = page_of(&model("macpherson")).joints.into_iter().find(|j| j.name == "lca_pivot").unwrap();
    assert_eq!(hinge.hinge.unwrap()[0], hinge.at_i);
}

#[test]
fn static_values_are_those_of_the_design_configuration() {
    let page = page_of(&model("macpherson"));
    let value = |name: &str| page.values.iter().find(|v| v.name == name).unwrap();
    // The model's own static toe and camber: atan(0.0035), -asin(0.0175 / abs(axis)).
    let toe = value("toe");
    assert_eq!((toe.what.as_str(), toe.time), ("design configuration", Some(0.0)));
    assert!(close(toe.value.unwrap(), 0.0035_f64.atan().to_degrees()));
    assert!((value("camber").value.unwrap() + 1.0026).abs() < 1e-3);
    // Nothing moves a distance that a rod keeps, whatever the last digits.
    assert!(value("wheel_travel").value == Some(0.0));
    let starts = page_of(&model("excavator"));
    assert!(starts.values.iter().all(|v| v.what == "design configuration" || v.what == "at the start"));
}
