//! Diagnostics for mistakes in couplers, drivers, laws, data files and rare joints: the full texts are in
//! `tests/snapshots`. And the meaning of valid entries.

use hardpoint::joint::Quantity;
use hardpoint::model::{Change, Model, change};
use hardpoint_file::{parse, read};

/// Every kind of coupler, driver, law and rare joint once.
const VALID: &str = include_str!("../models/press.toml");

fn snapshot(name: &str, shown: &str) {
    assert_eq!(shown.matches("error[HP").count(), shown.matches("= help: ").count(), "{name}: {shown}");
    insta::with_settings!({ snapshot_path => "../snapshots", prepend_module_to_snapshot => false, omit_expression => true, description => name }, {
        insta::assert_snapshot!(name, shown);
    });
}

fn changed(name: &str, replacements: &[(&str, &str)]) -> String {
    let mut text = VALID.to_owned();
    for (old, new) in replacements {
        assert!(text.contains(old), "{name}: {old}");
        text = text.replacen(old, new, 1);
    }
    text
}

/// The valid model with some of its text replaced.
fn broken(name: &str, replacements: &[(&str, &str)]) {
    let error = parse(&changed(name, replacements), "press.toml").expect_err(name);
    assert!(!error.list().is_empty(), "{name}");
    snapshot(name, &error.to_string());
}

fn valid(replacements: &[(&str, &str)]) -> Model {
    parse(&changed("valid", replacements), "press.toml").unwrap_or_else(|e| panic!("{e}")).model
}

#[test]
fn joints() {
    broken("length_of_a_hinge", &[("at = \"A\"\naxis = \"z\"\n", "at = \"A\"\naxis = \"z\"\nlength = 20\n")]);
    broken("length_not_positive", &[("length = 50.5", "length = -50.5")]);
    broken("length_with_unit", &[("length = 50.5", "length = \"50.5 mm\"")]);
    broken("screw_without_lead", &[("lead = 5\n", "")]);
    broken("lead_of_zero", &[("lead = 5", "lead = 0")]);
    broken("lead_of_a_hinge", &[("at = \"B\"\naxis = \"z\"", "at = \"B\"\naxis = \"z\"\nlead = 5")]);
    broken("place_of_a_direction", &[("\"float\"]\n", "\"float\"]\nat = [\"A\", \"B\"]\n")]);
    broken("curve_misspelt", &[("closed = true", "close = true")]);
    broken("curve_without_points", &[("points = [[50, 0, 0], [0, 50, 0], [-50, 0, 0], [0, -50, 0]], ", "")]);
    broken("curve_of_a_number", &[("[-50, 0, 0]", "-50")]);
    broken("curve_of_two_points", &[("[0, 50, 0], [-50, 0, 0], ", "")]);
    broken("curve_at_no_hardpoint", &[("[-50, 0, 0]", "\"Q\"")]);
    broken("curve_of_a_rod", &[("length = 50.5", "curve = { points = [\"A\", \"B\", \"C\"] }")]);
}

#[test]
fn couplers() {
    broken("unknown_coupler_type", &[("type = \"gear\"", "type = \"gears\"")]);
    broken("coupler_without_type", &[("type = \"belt\"\n", "")]);
    broken("coupler_is_a_list", &[("[couplers.belt]", "[[couplers.belt]]")]);
    broken("key_of_another_coupler", &[("teeth = [20, 40]", "radii = [20, 40]")]);
    broken(
        "gear_of_three",
        &[("joints = [\"J1\", \"J2\"]\nteeth", "joints = [\"J1\", \"J2\", \"J1\"]\nteeth")],
    );
    broken("gear_with_one_number", &[("teeth = [20, 40]", "teeth = 2")]);
    broken("gear_without_teeth", &[("teeth = [20, 40]", "teeth = [20, 0]")]);
    broken("gear_on_a_slide", &[("joints = [\"J1\", \"J2\"]\nteeth", "joints = [\"J1\", \"slide\"]\nteeth")]);
    broken("gear_on_itself", &[("joints = [\"J1\", \"J2\"]\nteeth", "joints = [\"J1\", \"J1\"]\nteeth")]);
    broken("rack_on_unknown_joint", &[("pinion = \"J2\"", "pinion = \"J22\"")]);
    broken(
        "rack_the_wrong_way_round",
        &[("rack = \"slide\"\npinion = \"J2\"", "rack = \"J2\"\npinion = \"slide\"")],
    );
    broken("belt_with_a_word", &[("radii = [10, 20]", "radii = [10, 20]\ncrossed = \"yes\"")]);
    broken("linear_with_open_coordinate", &[("coordinate = \"angle\", ", "")]);
    broken("linear_of_one_term", &[(", { joint = \"slide\", coefficient = -3 }", "")]);
    broken("linear_without_coefficient", &[(", coefficient = -3", "")]);
    broken("linear_of_words", &[("{ joint = \"slide\", coefficient = -3 }", "\"slide\"")]);
}

#[test]
fn drivers() {
    broken("driver_of_nothing", &[("point = \"P\"\nalong = \"z\"\n", "")]);
    broken(
        "driver_of_two_forms",
        &[(
            "point = \"P\"\nalong = \"z\"\n",
            "point = \"P\"\nalong = \"z\"\nbody = \"arm\"\nabout = \"z\"\n",
        )],
    );
    broken("driver_with_a_stray_key", &[("joint = \"J1\"\nlaw", "joint = \"J1\"\nalong = \"z\"\nlaw")]);
    broken("driver_without_direction", &[("along = \"z\"\n", "")]);
    broken("driver_with_one_end", &[("from = { body = \"ground\", at = \"A\" }\n", "")]);
    broken(
        "driver_of_a_point_to_itself",
        &[("from = { body = \"ground\", at = \"A\" }", "from = { body = \"ground\", at = \"D\" }")],
    );
    broken("driver_of_unknown_point", &[("point = \"P\"", "point = \"PP\"")]);
    broken("driver_of_unknown_body", &[("relative_to = \"wheel\"", "relative_to = \"weel\"")]);
    broken("driver_of_a_body_to_itself", &[("relative_to = \"wheel\"", "relative_to = \"float\"")]);
    broken("driver_about_nothing", &[("about = \"x\"", "about = \"roll\"")]);
    broken(
        "driver_point_incomplete",
        &[("from = { body = \"ground\", at = \"A\" }", "from = { body = \"ground\" }")],
    );
}

#[test]
fn laws() {
    broken("law_of_unknown_type", &[("type = \"harmonic\"", "type = \"sine\"")]);
    broken("law_without_type", &[("type = \"harmonic\", ", "")]);
    broken(
        "law_is_a_list",
        &[("law = { type = \"polynomial\", coefficients = [0, 1, 2] }", "law = [0, 1, 2]")],
    );
    broken("harmonic_without_frequency", &[("frequency = 1.5, ", "")]);
    broken("harmonic_with_stray_key", &[("phase = 90", "speed = 90")]);
    broken("constant_speed_in_words", &[("speed = 10", "speed = \"10 deg/s\"")]);
    broken("polynomial_of_nothing", &[("coefficients = [0, 1, 2]", "coefficients = []")]);
    broken("polynomial_of_words", &[("coefficients = [0, 1, 2]", "coefficients = [0, \"t\", 2]")]);
    broken("step_that_ends_before_it_starts", &[("end = 1.5", "end = 0.25")]);
    broken("step_of_degree_four", &[("end = 1.5", "end = 1.5, degree = 4")]);
    broken("table_of_one_point", &[(", [1, 5], [3, 2]", "")]);
    broken("table_out_of_order", &[("[1, 5], [3, 2]", "[3, 2], [1, 5]")]);
    broken("table_of_triples", &[("[1, 5]", "[1, 5, 0]")]);
    broken("table_without_points", &[(", points = [[0, 0], [1, 5], [3, 2]]", "")]);
    broken("table_given_twice", &[("[3, 2]]", "[3, 2]], file = \"travel.csv\"")]);
    broken("table_of_unknown_spline", &[("[3, 2]]", "[3, 2]], spline = \"cubik\"")]);
    broken("table_of_unknown_ends", &[("[3, 2]]", "[3, 2]], ends = \"free\"")]);
    broken("table_not_periodic", &[("[3, 2]]", "[3, 2]], ends = \"periodic\"")]);
    broken("table_natural_with_speed", &[("[3, 2]]", "[3, 2]], ends = \"natural\", start_speed = 2")]);
    broken("cubic_with_acceleration", &[("[3, 2]]", "[3, 2]], end_acceleration = 2")]);
    broken("table_too_short_for_the_times", &[("[3, 2]]", "[0.5, 2]]"), ("[1, 5], ", "")]);
    broken("piece_without_duration", &[("duration = 1, ", "")]);
    broken("piece_of_no_duration", &[("duration = 1", "duration = 0")]);
    broken("piece_with_a_bad_law", &[("5*t^2", "5*t^^2")]);
    broken("piece_with_a_bad_kind", &[("speed = 10 }", "spede = \"x\" }")]);
    broken(
        "sequence_of_nothing",
        &[(
            "pieces = [{ duration = 1, law = \"5*t^2\" }, { law = { type = \"constant_speed\", speed = 10 } }]",
            "pieces = []",
        )],
    );
    broken("expression_with_unknown_name", &[("sin(w*t)", "sin(omega*t)")]);
    broken("expression_with_unused_parameter", &[("w = 1.25", "w = 1.25, b = 1")]);
    broken("expression_with_parameter_of_text", &[("w = 1.25", "w = \"1.25 rad/s\"")]);
    broken("expression_without_law", &[("law = \"a*sin(w*t)\", ", "")]);
    broken("expression_with_parameter_t", &[("w = 1.25", "w = 1.25, t = 1")]);
}

#[test]
fn design() {
    broken("length_of_a_rod_without", &[("length = 50.5\n", "")]);
    broken("length_and_driver", &[("length = \"rod\"", "length = \"rod\"\ndriver = \"turn\"")]);
    broken("length_of_unknown_rod", &[("length = \"rod\"", "length = \"rodd\"")]);
    broken("parameter_missing", &[("parameter = \"amplitude\"\n", "")]);
    broken("parameter_without_driver", &[("length = \"rod\"", "length = \"rod\"\nparameter = \"speed\"")]);
    broken("parameter_unknown", &[("parameter = \"amplitude\"", "parameter = \"amplitud\"")]);
    broken("parameter_of_unknown_driver", &[("driver = \"turn\"", "driver = \"trun\"")]);
}

/// A model that names a data file, read from a folder with these files; the folder's name is left out of the text.
fn with_file(law: &str, files: &[(&str, &str)]) -> Result<Model, String> {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("models");
    std::fs::create_dir_all(folder.join("data")).unwrap();
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let path = folder.join("press.toml");
    let table = "{ type = \"table\", points = [[0, 0], [1, 5], [3, 2]] }";
    std::fs::write(&path, changed("file", &[(table, law)])).unwrap();
    let shown = |e: hardpoint_file::ReadError| e.to_string().replace(&folder.display().to_string(), "DIR");
    read(&path).map(|f| f.model).map_err(shown)
}

#[test]
fn data_files() {
    let law = |rest: &str| format!("{{ type = \"table\", file = \"travel.csv\"{rest} }}");
    let refused = |name: &str, law: &str, text: &str| {
        snapshot(name, &with_file(law, &[("travel.csv", text)]).expect_err(name));
    };
    let rows = "time, travel\n0, 0\n1, 5\n";
    broken("file_of_a_text", &[("points = [[0, 0], [1, 5], [3, 2]]", "file = \"travel.csv\"")]);
    refused("file_missing", &law("").replace("travel.csv", "data/travel.csv"), rows);
    refused("file_misspelt", &law("").replace("travel", "travle"), rows);
    refused("file_above", &law("").replace("travel.csv", "../travel.csv"), rows);
    refused("file_above_in_disguise", &law("").replace("travel.csv", "data/../../travel.csv"), rows);
    refused("file_absolute", &law("").replace("travel.csv", "/etc/hosts"), rows);
    refused("file_on_a_drive", &law("").replace("travel.csv", "C:/travel.csv"), rows);
    refused("file_with_backslash", &law("").replace("travel.csv", "data\\\\travel.csv"), rows);
    refused("file_is_a_folder", &law("").replace("travel.csv", "data"), rows);
    refused("file_without_name", &law("").replace("travel.csv", ""), rows);
    refused("file_empty", &law(""), "# nothing yet\n");
    refused("file_with_a_word", &law(""), "time, travel\n0, 0\n# a remark\n1, five\n");
    refused("file_with_decimal_commas", &law(""), "time; travel\n0,0; 0,0\n1,0; 5,5\n");
    refused("file_with_a_short_row", &law(""), "0, 0\n1\n2, 3\n");
    refused("file_with_an_empty_field", &law(""), "0, 0\n1,\n2, 3\n");
    refused("file_not_finite", &law(""), "0, 0\n1, NaN\n2, 3\n");
    refused("file_out_of_order", &law(""), "0, 0\n2, 5\n1, 3\n");
    refused("file_of_one_column", &law(""), "0\n1\n");
    refused("file_without_that_name", &law(", columns = [\"time\", \"travle\"]"), rows);
    let twice = "time, travel, travel\n0, 0, 1\n1, 5, 6\n";
    refused("file_with_a_name_twice", &law(", columns = [\"time\", \"travel\"]"), twice);
    refused("file_with_one_column_for_both", &law(", columns = [2, 2]"), rows);
    refused("file_without_names", &law(", columns = [\"time\", \"travel\"]"), "0, 0\n1, 5\n");
    refused("file_without_that_column", &law(", columns = [1, 3]"), rows);
    refused("file_with_one_column_named", &law(", columns = \"travel\""), rows);
    refused("file_with_column_zero", &law(", columns = [0, 1]"), rows);
    refused("file_in_milliseconds", &law(""), "time [ms], travel\n0, 0\n1000, 5\n");
    refused("file_of_one_row", &law(""), "0, 0\n");
    refused(
        "columns_without_file",
        "{ type = \"table\", points = [[0, 0], [1, 5]], columns = [1, 2] }",
        rows,
    );
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_folder_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("models");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(dir.path().join("secret.csv"), "0, 0\n1, 1\n").unwrap();
    std::os::unix::fs::symlink(dir.path().join("secret.csv"), folder.join("travel.csv")).unwrap();
    let path = folder.join("press.toml");
    let points = "points = [[0, 0], [1, 5], [3, 2]]";
    std::fs::write(&path, changed("link", &[(points, "file = \"travel.csv\"")])).unwrap();
    let error = read(&path).unwrap_err().to_string();
    assert!(error.contains("HP0111") && error.contains("it is a link to a place outside"), "{error}");
}

#[test]
fn a_data_file_means_the_same_however_it_is_written() {
    let law = |rest: &str| format!("{{ type = \"table\", file = \"travel.csv\"{rest} }}");
    let expected = valid(&[]).drivers[2].law.clone();
    for (rest, text) in [
        ("", "0, 0\n1, 5\n3, 2\n"),
        ("", "\u{feff}# bench\ntime,travel\r\n0,0\r\n\r\n# a remark\r\n1,5\r\n3,2"),
        ("", "time;travel\n0;0\n1;5\n3;2\n"),
        ("", "0\t0\n1\t5\n3\t2\n"),
        (", columns = [2, 1]", "0, 0\n5, 1\n2, 3\n"),
        (", columns = [\"time\", \"travel\"]", "\"travel\", v, \"time\"\n0, 9, 0\n5e0, 9, 1\n2, 9, 3.0\n"),
        (", columns = [\"time\", 1]", "travel, time\n0, 0\n5, 1\n2, 3\n"),
        ("", "time [s], travel [cm]\n0, 0\n1, 0.5\n3, 0.2\n"),
        (
            ", columns = [\"time\", \"travel\"]",
            "travel [mm], v [km/h], time [s]\n0, 9, 0\n5, 9, 1\n2, 9, 3\n",
        ),
        (", spline = \"cubic\", ends = \"clamped\", start_speed = 0", "0, 0\n1, 5\n3, 2\n"),
    ] {
        let model = with_file(&law(rest), &[("travel.csv", text)]).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(model.drivers[2].law, expected, "{text}");
    }
    for (title, words) in [
        ("travel [kN]", "`travel` of `travel.csv` is in `kN`, and the model file has mm, deg, 1"),
        ("travel [deg]", "`travel` of the table is in `deg`, and the law is in mm"),
        ("travel [furlong]", "`travel` of `travel.csv` is in `furlong`, which is not a known unit"),
    ] {
        let text = format!("time [s], {title}\n0, 0\n1, 5\n3, 2\n");
        let error = with_file(&law(""), &[("travel.csv", &text)]).unwrap_err().to_string();
        assert!(error.contains("HP0112") && error.contains(words), "{error}");
    }
    let below = law("").replace("travel.csv", "./data/travel.csv");
    let model = with_file(&below, &[("data/travel.csv", "0, 0\n1, 5\n3, 2\n")]).unwrap();
    assert_eq!(model.drivers[2].law, expected);
}

#[test]
fn laws_are_in_the_units_of_the_driven_quantity() {
    let m = valid(&[]);
    let value = |k: usize, t: f64| m.drivers[k].law.at(t).value();
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    // 10 + 25 sin(2 pi 1.5 t + 90 deg) deg.
    near(value(0, 0.0), 35f64.to_radians());
    near(value(0, 1.0 / 3.0), -15f64.to_radians());
    // Half of the step, mm; the same with degree 5 said.
    near(value(1, 1.0), 0.020);
    near(value(2, 3.0), 0.002);
    // 5 deg after a second, and 10 deg/s from there.
    near(value(3, 3.0), 25f64.to_radians());
    near(value(4, 0.25), 25f64.to_radians() * (1.25f64 * 0.25).sin());
    near(value(5, 2.0), 0.010);
}

#[test]
fn couplers_satisfy_the_documented_relations() {
    let m = valid(&[("teeth = [20, 40]", "teeth = [20, 40]\ninternal = true")]);
    let ratio = |k: usize| {
        let terms = &m.couplers[k].terms;
        -terms[0].coefficient / terms[1].coefficient
    };
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    near(ratio(0), 0.5); // internal: the larger turns the same way, half as fast
    near(1.0 / ratio(1), 0.0125); // m per rad
    near(ratio(2), 0.5);
    // 2 deg of the spindle and -3 mm of the slide: per degree 2/3 mm.
    near(ratio(3), 2.0 / 3.0 * 1e-3 * 180.0 / std::f64::consts::PI);
    let crossed = valid(&[("radii = [10, 20]", "radii = [10, 20]\ncrossed = true")]);
    assert!(crossed.couplers[2].terms.iter().all(|t| t.coefficient > 0.0));
    // The screw's own coupler comes last: 5 mm a turn.
    near(1.0 / ratio(4), 0.005 / std::f64::consts::TAU);
    for (one, other) in
        [("type = \"gear\"", "type = \"bevel\""), ("type = \"rack\"", "type = \"rack_and_pinion\"")]
    {
        assert_eq!(valid(&[(one, other)]).couplers.len(), m.couplers.len());
    }
}

#[test]
fn variables_are_in_the_units_of_the_changed_quantity() {
    for (driver, parameter, quantity, rate) in [
        ("turn", "amplitude", Quantity::Angle, 1.0),
        ("turn", "offset", Quantity::Angle, 1.0),
        ("turn", "phase", Quantity::Angle, 1.0),
        ("turn", "frequency", Quantity::Number, 1.0),
        ("lift", "to", Quantity::Length, 1.0),
        ("lift", "start", Quantity::Number, 1.0),
        ("stroke", "f[1]", Quantity::Length, 1.0),
        ("stroke", "start_speed", Quantity::Number, 1e-3),
        ("lean", "piece[0].duration", Quantity::Number, 1.0),
        ("lean", "piece[1].speed", Quantity::Number, 1f64.to_radians()),
        ("wave", "w", Quantity::Number, 1.0),
        ("creep", "c0", Quantity::Length, 1.0),
        ("creep", "c2", Quantity::Number, 1e-3),
    ] {
        let new = format!("driver = \"{driver}\"\nparameter = \"{parameter}\"");
        let m = valid(&[("driver = \"turn\"\nparameter = \"amplitude\"", &new)]);
        let v = &m.variables[1];
        let Change::Law(found) = &v.changes[0] else { panic!("{v:?}") };
        assert_eq!((v.quantity, found.rate), (quantity, rate), "{parameter}");
    }
    let m = valid(&[]);
    assert_eq!(m.variables[0].quantity, Quantity::Length);
    assert!(matches!(m.variables[0].changes[0], Change::Length(change::Length { rate: 1.0, .. })));
    assert_eq!(m.joints.iter().find(|j| j.name == "rod").unwrap().length, Some(0.0505));
}

/// Consequences of another problem are not reported.
#[test]
fn consequences_are_not_reported() {
    for (old, new) in [
        ("length = 50.5", "length = true"),
        ("lead = 5", "lead = \"5\""),
        ("closed = true", "closed = 1"),
        ("teeth = [20, 40]", "teeth = [20]"),
        ("amplitude = 25", "amplitude = \"25\""),
        ("joint = \"J1\"\nlaw", "joint = 1\nlaw"),
        ("body = \"float\"\nabout", "body = 1\nabout"),
        ("at = \"A\" }\nto", "at = 1 }\nto"),
        ("A = [0, 0, 0]", "A = [0, 0]"),
        ("steps = 10", "steps = 0.5"),
        ("type = \"cam\"", "type = \"camm\""),
    ] {
        let error = parse(&changed("consequences", &[(old, new)]), "x.toml").unwrap_err();
        assert_eq!(error.list().len(), 1, "{new}: {error}");
    }
}

#[test]
fn the_model_fits_the_schema() {
    let validator =
        jsonschema::validator_for(&serde_json::from_str(&hardpoint_file::schema()).unwrap()).unwrap();
    let fits = |replacements: &[(&str, &str)]| {
        let value: serde_json::Value = toml::from_str(&changed("schema", replacements)).unwrap();
        validator.is_valid(&value)
    };
    assert!(fits(&[]));
    for (old, new) in [
        ("type = \"gear\"", "type = \"gears\""),
        ("teeth = [20, 40]", "radii = [20, 40]"),
        ("teeth = [20, 40]", "teeth = [20, 40]\nratio = 2"),
        ("point = \"P\"\nalong", "joint = \"J1\"\npoint = \"P\"\nalong"),
        ("frequency = 1.5", "frequency = \"1.5 Hz\""),
        ("end = 1.5", "end = 1.5, degree = 4"),
        ("type = \"rod\"", "type = \"bar\""),
        ("length = \"rod\"", "length = 3"),
    ] {
        assert!(!fits(&[(old, new)]), "{new}");
    }
}
