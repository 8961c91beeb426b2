//! `skeleton.dxf` as a reader of DXF finds it.

use dxf::Drawing;
use dxf::entities::EntityType;
use dxf::enums::Units;

use crate::bench::Bench;

fn exported(bench: &Bench, model: &str) -> (Drawing, String) {
    let output = bench.run(&["export", model, "-o", "out.dxf"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let drawing = Drawing::load(&mut bench.text("out.dxf").as_bytes()).unwrap();
    (drawing, String::from_utf8(output.stdout).unwrap())
}

/// Lines by their layer: their ends.
fn lines(drawing: &Drawing) -> Vec<(String, [[f64; 3]; 2])> {
    let line = |e: &dxf::entities::Entity| match &e.specific {
        EntityType::Line(l) => Some((e.common.layer.clone(), [&l.p1, &l.p2].map(|p| [p.x, p.y, p.z]))),
        _ => None,
    };
    drawing.entities().filter_map(line).collect()
}

#[test]
fn a_skeleton_has_the_hardpoints_by_name_and_lines_for_bodies() {
    /// Lengths of some hundred mm through m and back.
    const ROUNDED: f64 = 1e-10;
    let bench = Bench::with(&["slider.toml"]);
    let (drawing, said) = exported(&bench, "slider.toml");
    assert_eq!(drawing.header.default_drawing_units, Units::Millimeters);
    let names = drawing.entities().filter_map(|e| match &e.specific {
        EntityType::Text(t) => Some((t.value.clone(), [t.location.x, t.location.y, t.location.z])),
        _ => None,
    });
    let hardpoints = [("A", [0.0, 0.0, 0.0]), ("B", [30.0, 40.0, 0.0]), ("C", [150.0, 0.0, 0.0])];
    assert_eq!(names.collect::<Vec<_>>(), hardpoints.map(|(name, at)| (name.to_owned(), at)));
    let points = drawing.entities().filter_map(|e| match &e.specific {
        EntityType::ModelPoint(p) => Some([p.location.x, p.location.y, p.location.z]),
        _ => None,
    });
    assert_eq!(points.collect::<Vec<_>>(), hardpoints.map(|(_, at)| at));
    let lines = lines(&drawing);
    let of =
        |layer: &str| lines.iter().filter(|(l, _)| l == layer).map(|(_, ends)| *ends).collect::<Vec<_>>();
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ROUNDED);
    let [a, b, c, tip] = [[0.0; 3], [30.0, 40.0, 0.0], [150.0, 0.0, 0.0], [90.0, 60.0, 10.0]];
    let between = |layer: &str, p, q| {
        of(layer).iter().any(|[s, t]| near(*s, p) && near(*t, q) || near(*s, q) && near(*t, p))
    };
    assert!(between("crank", a, b) && of("crank").len() == 1);
    assert!(between("rod", b, c) && between("rod", c, tip) && between("rod", tip, b) && of("rod").len() == 3);
    assert_eq!(lines.len(), 4);
    assert!(
        said.contains("body `slider`: it has a single place") && said.contains("driver `motor`"),
        "{said}"
    );
}

#[test]
fn a_hinge_through_two_hardpoints_has_a_place_at_both() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml").replace("\nC = ", "\nA2 = [0, 0, 50]\nC = ");
    let axis = "at = \"A\", axis = { through = [\"A\", \"A2\"] }";
    bench.put("hinge.toml", &text.replace("at = \"A\", axis = \"z\"", axis));
    let (drawing, _) = exported(&bench, "hinge.toml");
    // Both bearings and the pin.
    assert_eq!(lines(&drawing).iter().filter(|(layer, _)| layer == "crank").count(), 3);
}

#[test]
fn a_skeleton_is_in_the_units_of_the_file_and_names_are_those_of_the_model() {
    let bench = Bench::with(&["slider.toml"]);
    let text = bench.text("slider.toml").replace("length = \"mm\"", "length = \"in\"");
    let text = text.replace("\"crank\"", "\"crank/ä\"").replace("crank = {}", "\"crank/ä\" = {}");
    bench.put(
        "odd.toml",
        &text.replace("\nA = ", "\n\"Lager ä\" = ").replace("at = \"A\"", "at = \"Lager ä\""),
    );
    let (drawing, _) = exported(&bench, "odd.toml");
    assert_eq!(drawing.header.default_drawing_units, Units::Inches);
    let layers: Vec<&str> = drawing.layers().map(|l| l.name.as_str()).collect();
    assert!(layers.contains(&"crank_\\U+00E4") || layers.contains(&"crank_ä"), "{layers:?}");
    let ends = lines(&drawing).into_iter().find(|(l, _)| l.starts_with("crank_")).unwrap().1;
    assert!(ends.iter().flatten().any(|x| (x - 40.0).abs() <= 1e-10), "{ends:?}");
    assert!(bench.text("out.dxf").contains("Lager \\U+00E4"));
}
