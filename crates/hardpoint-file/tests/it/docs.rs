//! The documents agree with the code: every example is read, every code is listed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use hardpoint_file::{parse, read, schema};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn document(name: &str) -> String {
    std::fs::read_to_string(root().join("docs").join(name)).unwrap()
}

/// The fenced TOML blocks of a document.
fn examples(text: &str) -> Vec<&str> {
    text.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect()
}

#[test]
fn examples_of_the_format_are_one_valid_model() {
    let text = document("file-format.md");
    let pieces = examples(&text);
    // The last two are alternatives.
    let folder = tempfile::tempdir().unwrap();
    let data = text.split("```csv\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    std::fs::write(folder.path().join("travel.csv"), data).unwrap();
    let path = folder.path().join("model.toml");
    let (alternatives, common) = (&pieces[pieces.len() - 2..], &pieces[..pieces.len() - 2]);
    assert!(alternatives.iter().all(|p| p.starts_with("[time]")), "{alternatives:?}");
    let validator = jsonschema::validator_for(&serde_json::from_str(&schema()).unwrap()).unwrap();
    for time in alternatives {
        let model = format!("{}\n{time}", common.join("\n"));
        std::fs::write(&path, &model).unwrap();
        let file = read(&path).unwrap_or_else(|e| panic!("{e}"));
        assert!(file.model.joints.len() >= 15 && file.model.measures.len() >= 6);
        assert!(file.model.couplers.len() >= 5 && file.model.drivers.len() >= 10);
        let value: serde_json::Value = toml::from_str(&model).unwrap();
        let errors: Vec<String> =
            validator.iter_errors(&value).map(|e| format!("{} at {}", e, e.instance_path())).collect();
        assert!(errors.is_empty(), "{errors:#?}");
    }
}

#[test]
fn the_anti_roll_bar_of_the_document_works() {
    const ROUND_OFF: f64 = 1e-9;
    let text = document("loads.md");
    let [example] = examples(&text)[..] else { panic!("one example") };
    let model = parse(example, "bar.toml").unwrap_or_else(|e| panic!("{e}")).model;
    let [heave, roll] = ["heave", "roll"].map(|case| {
        let in_case = model.in_case(model.case(case).unwrap());
        let solution = hardpoint::Analysis::new(&in_case).unwrap().run();
        assert!(solution.stop.is_none(), "{case}");
        solution
    });
    let of =
        |s: &hardpoint::Solution, k: usize, name: &str| s.measured.value(k, s.measured.index(name).unwrap());
    let stiffness = 12.0_f64.to_degrees();
    for k in 0..roll.motion.len() {
        assert!(
            of(&heave, k, "twist")[0].abs() < ROUND_OFF && of(&heave, k, "left_load")[0].abs() < ROUND_OFF
        );
        let [left, right] = ["left_load", "right_load"].map(|name| of(&roll, k, name)[0]);
        assert!((left + right).abs() < 0.1 * left.abs().max(1.0), "{left} {right}");
        // Power of both wheels: k twist twist'
        let power = of(&roll, k, "left_power")[0] + of(&roll, k, "right_power")[0];
        let [twist, rate, _] = of(&roll, k, "twist");
        assert!((power - stiffness * twist * rate).abs() < ROUND_OFF * (1.0 + power.abs()), "{power} at {k}");
    }
    assert!((0..roll.motion.len()).any(|k| of(&roll, k, "left_load")[0] > 100.0));
}

#[test]
fn every_key_of_the_schema_is_documented() {
    let text = document("file-format.md");
    let schema: serde_json::Value = serde_json::from_str(&schema()).unwrap();
    let mut keys = BTreeSet::new();
    collect_keys(&schema, &mut keys);
    assert!(keys.len() > 30, "{keys:?}");
    let shown = |key: &str| {
        ["`{}`", "`[{}]`", "`[{}.NAME]`", "`units.{}`"].iter().any(|p| text.contains(&p.replace("{}", key)))
            || text.contains(&format!("{key} = "))
    };
    let missing: Vec<_> = keys.iter().filter(|k| !shown(k)).collect();
    assert!(missing.is_empty(), "not in docs/file-format.md: {missing:?}");
}

fn collect_keys(schema: &serde_json::Value, keys: &mut BTreeSet<String>) {
    match schema {
        serde_json::Value::Object(map) => {
            for (name, value) in map {
                if let (true, Some(properties)) = (name == "properties", value.as_object()) {
                    keys.extend(properties.keys().cloned());
                }
                collect_keys(value, keys);
            }
        }
        serde_json::Value::Array(list) => list.iter().for_each(|v| collect_keys(v, keys)),
        _ => {}
    }
}

#[test]
fn every_joint_type_and_coordinate_is_documented() {
    let text = document("file-format.md");
    for t in hardpoint::joint::ALL {
        let row = text.lines().find(|l| l.starts_with(&format!("| `{}` |", t.name)));
        let row = row.unwrap_or_else(|| panic!("no row for {}", t.name));
        for c in t.coordinates {
            assert!(row.contains(&format!("`{}`", c.name)), "{row}");
        }
        for alias in t.aliases {
            assert!(row.contains(&format!("`{alias}`")), "{alias}: {row}");
        }
        if let Some(free) = t.freedom_count() {
            let free = free - t.tree_rows.len() - usize::from(t.name == "screw");
            assert!(row.contains(&format!("| {free} |")), "{free}: {row}");
        }
        assert!(row.contains(&format!("| {} |", t.places)), "{row}");
    }
}

#[test]
fn every_code_in_the_source_is_documented() {
    let text = document("diagnostics.md");
    let found = codes_in_the_source();
    assert!(found.len() > 20, "{found:?}");
    let missing: Vec<_> = found.iter().filter(|c| !text.contains(&format!("| {c} |"))).collect();
    assert!(missing.is_empty(), "not in docs/diagnostics.md: {missing:?}");
}

#[test]
fn every_documented_code_is_in_the_source() {
    let text = document("diagnostics.md");
    let found = codes_in_the_source();
    let listed = text.lines().filter_map(|l| l.strip_prefix("| HP")).map(|l| format!("HP{}", &l[..4]));
    for code in listed {
        assert!(found.contains(&code), "{code} is documented and nowhere used");
    }
}

/// All codes of the crates with diagnostics.
fn codes_in_the_source() -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let crates = [
        "hardpoint",
        "hardpoint-file",
        "hardpoint-import",
        "hardpoint-report",
        "hardpoint-studio",
        "hardpoint-cli",
    ];
    for name in crates {
        codes_below(&root().join("crates").join(name).join("src"), &mut found);
    }
    found
}

/// All `"HP...."` text constants of the Rust files below a folder.
fn codes_below(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            codes_below(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            let text = std::fs::read_to_string(&path).unwrap();
            // Doc comments may show made-up codes.
            for line in text.lines().filter(|l| !l.trim_start().starts_with("//")) {
                for (k, _) in line.match_indices("\"HP") {
                    let code = line[k + 1..].split('"').next().unwrap_or_default();
                    if code.len() == 6 && code[2..].bytes().all(|b| b.is_ascii_digit()) {
                        found.insert(code.to_owned());
                    }
                }
            }
        }
    }
}

#[test]
fn the_model_in_the_readme_runs() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    let text =
        readme.split("```toml\n").nth(1).and_then(|t| t.split("```").next()).expect("a model in the README");
    let file = parse(text, "README.md").unwrap_or_else(|e| panic!("{e}"));
    let solution = hardpoint::Analysis::new(&file.model).unwrap().run();
    assert!(solution.stop.is_none());
    assert_eq!(solution.motion.len(), 401);
}
