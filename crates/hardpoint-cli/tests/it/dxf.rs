//! `skeleton.dxf` as a DXF reader parses it. The Python tests compare every drawing with an independent reader.

use std::collections::HashSet;

use crate::bench::Bench;

/// Group codes and values in the order of the file.
type Groups = Vec<(i32, String)>;

struct Drawing(Groups);

impl Drawing {
    fn read(text: &str) -> Self {
        let lines: Vec<&str> = text.split("\r\n").collect();
        let (pairs, rest) = lines.as_chunks::<2>();
        assert_eq!(rest, [""], "lines come in pairs");
        let groups: Groups =
            pairs.iter().map(|[code, value]| (code.trim().parse().unwrap(), (*value).to_owned())).collect();
        assert_eq!(groups.last(), Some(&(0, "EOF".to_owned())));
        Self(groups)
    }

    /// Value of a header variable.
    fn header(&self, name: &str) -> &str {
        let at = self.0.iter().position(|(code, value)| *code == 9 && value == name).unwrap();
        &self.0[at + 1].1
    }

    /// Groups of every object of a kind: entities, records of tables.
    fn all(&self, kind: &str) -> Vec<&[(i32, String)]> {
        let starts: Vec<usize> = (0..self.0.len()).filter(|&k| self.0[k].0 == 0).collect();
        starts.windows(2).map(|w| &self.0[w[0]..w[1]]).filter(|object| object[0].1 == kind).collect()
    }
}

fn value(object: &[(i32, String)], code: i32) -> &str {
    &object.iter().find(|(c, _)| *c == code).unwrap_or_else(|| panic!("no group {code} in {object:?}")).1
}

fn point(object: &[(i32, String)], code: i32) -> [f64; 3] {
    [0, 10, 20].map(|k| value(object, code + k).parse().unwrap())
}

fn exported(bench: &Bench, model: &str) -> (Drawing, String) {
    let output = bench.run(&["export", model, "-o", "out.dxf"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    (Drawing::read(&bench.text("out.dxf")), String::from_utf8(output.stdout).unwrap())
}

/// End points of lines, with their layers.
fn lines(drawing: &Drawing) -> Vec<(String, [[f64; 3]; 2])> {
    drawing.all("LINE").iter().map(|l| (value(l, 8).to_owned(), [point(l, 10), point(l, 11)])).collect()
}

/// Names of the layers, in the order of their table.
fn layers(drawing: &Drawing) -> Vec<&str> {
    drawing.all("LAYER").iter().map(|l| value(l, 2)).collect()
}

#[test]
fn handles_are_unique_and_below_the_seed() {
    let bench = Bench::with(&["slider.toml"]);
    let (drawing, _) = exported(&bench, "slider.toml");
    // Code 5 of everything but header variables; dimension styles have theirs in code 105.
    let after_header = drawing.0.iter().position(|(code, value)| *code == 0 && value == "ENDSEC").unwrap();
    let handles = drawing.0[after_header..].iter().filter(|(code, _)| *code == 5 || *code == 105);
    let handles: Vec<u32> = handles.map(|(_, h)| u32::from_str_radix(h, 16).unwrap()).collect();
    let seed = u32::from_str_radix(drawing.header("$HANDSEED"), 16).unwrap();
    assert!(handles.iter().all(|h| *h < seed), "{handles:?} {seed}");
    assert_eq!(handles.iter().collect::<HashSet<_>>().len(), handles.len());
    // Every entity is on a layer of the table.
    let known = layers(&drawing);
    for kind in ["POINT", "TEXT", "LINE"] {
        assert!(!drawing.all(kind).is_empty());
        assert!(drawing.all(kind).iter().all(|e| known.contains(&value(e, 8))));
    }
}

#[test]
fn a_skeleton_has_the_hardpoints_by_name_and_lines_for_bodies() {
    /// Round-off of lengths of some hundred mm, converted to m and back.
    const ROUNDED: f64 = 1e-10;
    let bench = Bench::with(&["slider.toml"]);
    let (drawing, said) = exported(&bench, "slider.toml");
    assert_eq!(drawing.header("$INSUNITS"), "4");
    let texts = drawing.all("TEXT");
    let names = texts.iter().map(|t| (value(t, 1).to_owned(), point(t, 10)));
    let hardpoints = [("A", [0.0, 0.0, 0.0]), ("B", [30.0, 40.0, 0.0]), ("C", [150.0, 0.0, 0.0])];
    assert_eq!(names.collect::<Vec<_>>(), hardpoints.map(|(name, at)| (name.to_owned(), at)));
    let points: Vec<[f64; 3]> = drawing.all("POINT").iter().map(|p| point(p, 10)).collect();
    assert_eq!(points, hardpoints.map(|(_, at)| at));
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
        said.contains("body `slider`: it has a single point") && said.contains("driver `motor`"),
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
    assert_eq!(drawing.header("$INSUNITS"), "1");
    assert!(layers(&drawing).contains(&"crank_\\U+00E4"), "{:?}", layers(&drawing));
    let ends = lines(&drawing).into_iter().find(|(l, _)| l.starts_with("crank_")).unwrap().1;
    assert!(ends.iter().flatten().any(|x| (x - 40.0).abs() <= 1e-10), "{ends:?}");
    assert!(bench.text("out.dxf").contains("Lager \\U+00E4"));
}
