//! Task files of synthesis: what is read, and the diagnostics.

use std::path::{Path, PathBuf};

use hardpoint_file::{TaskAim, TaskFile};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

const HEAD: &str = "name = \"t\"\nunits = { length = \"mm\", angle = \"deg\" }\n";

fn codes(body: &str) -> Vec<(&'static str, Option<usize>)> {
    let error = TaskFile::parse(&format!("{HEAD}{body}"), "t.toml").expect_err("refused");
    assert!(error.list().iter().all(|d| d.help.is_some()), "{error}");
    error.list().iter().map(|d| (d.code, d.line)).collect()
}

#[test]
fn every_task_of_the_repository_and_every_example_is_read() {
    let tasks: Vec<PathBuf> =
        std::fs::read_dir(root().join("models/tasks")).unwrap().map(|e| e.unwrap().path()).collect();
    assert_eq!(tasks.len(), 3, "{tasks:?}");
    for path in tasks {
        let task = TaskFile::read(&path).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(Some(task.name.as_str()), path.file_stem().and_then(|s| s.to_str()));
    }
    let document = std::fs::read_to_string(root().join("docs/synthesis.md")).unwrap();
    let examples: Vec<&str> =
        document.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    assert_eq!(examples.len(), 2);
    examples.iter().for_each(|text| drop(TaskFile::parse(text, "e.toml").unwrap_or_else(|e| panic!("{e}"))));
}

#[test]
fn numbers_are_converted_and_defaults_are_those_of_the_document() {
    let text = format!(
        "{HEAD}poses = [[0, 0, 0], [1000, 2, 90], [3, 4, 5]]\nfixed_region = {{ x = [-1, 1], y = [0, 2] }}"
    );
    let task = TaskFile::parse(&text, "t.toml").unwrap();
    let TaskAim::Poses(poses) = &task.aim else { panic!("poses") };
    assert_eq!(poses[1], [1.0, 0.002, std::f64::consts::FRAC_PI_2]);
    assert_eq!(task.fixed_region, Some([[-0.001, 0.001], [0.0, 0.002]]));
    assert!(task.four_bars && task.slider_cranks && !task.full_turn && !task.any_order);
    assert_eq!((task.answers, task.moving_region), (10, None));
}

#[test]
fn points_may_be_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let read = |csv: &str| {
        std::fs::write(folder.path().join("p.csv"), csv).unwrap();
        let path = folder.path().join("t.toml");
        std::fs::write(&path, format!("{HEAD}points = \"p.csv\"\nclosed = true\nlinkages = [\"four_bar\"]"))
            .unwrap();
        TaskFile::read(&path).map_err(|e| Box::new(e.diagnostics().list()[0].clone()))
    };
    for csv in [
        "x,y\n0,0\n10,5\n20,0\n",
        "0;0\n10;5\n20;0\n",
        "\u{feff}\"x [mm]\",\"y [mm]\"\n0,0\n10,5\n20,0",
        "# of a drawing\ny,x\n0,0\n5,10\n0,20\n",
        "Y [cm];X [m]\n0;0\n0.5;0.01\n0;0.02\n",
    ] {
        let task = read(csv).unwrap();
        let expected = vec![[0.0, 0.0], [0.01, 0.005], [0.02, 0.0]];
        let aim = TaskAim::Path { points: expected, is_closed: true, crank_angles: None, tolerance: None };
        assert_eq!(task.aim, aim, "{csv:?}");
        assert!(task.four_bars && !task.slider_cranks);
    }
    for (csv, part) in [
        ("x,y\n0,0\n1\n", "line 3, column 2 (`y`) is missing"),
        ("0,0,0\n", "line 1 has 3 columns"),
        ("x,y\n0,a\n", "`a` is not a number"),
        ("x,y\n", "is empty"),
        ("x,z\n0,0\n", "`z` is not a column"),
        ("x\n0\n", "has no column `y`"),
        ("x,y,x\n0,0,0\n", "`x` is the title of two columns"),
        ("x,y [deg]\n0,0\n", "`y` is in `deg`, and it is a length"),
        ("x [banana],y\n0,0\n", "`x` is in `banana`"),
    ] {
        let d = read(csv).unwrap_err();
        assert!(d.code == "HP0112" && d.message.contains(part), "{csv:?}: {}", d.message);
    }
}

#[test]
fn columns_of_poses_are_found_by_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.toml");
    std::fs::write(folder.path().join("p.csv"), "angle [rad],y,x [cm]\n0,0,0\n1.5,2,100\n0.5,4,0.3\n")
        .unwrap();
    std::fs::write(&path, format!("{HEAD}poses = \"p.csv\"")).unwrap();
    let task = TaskFile::read(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(task.aim, TaskAim::Poses(vec![[0.0; 3], [1.0, 0.002, 1.5], [0.003, 0.004, 0.5]]));
}

#[test]
fn errors_are_reported_at_their_places() {
    for (body, expected) in [
        ("", vec![("HP0104", None)]),
        ("poses = 3", vec![("HP0105", Some(3))]),
        ("poses = [[0, 0, 0], [1, 2]]", vec![("HP0105", Some(3))]),
        ("points = [[0, 0], [1, inf]]", vec![("HP0109", Some(3))]),
        ("poses = [[0, 0, 0]]\npoints = [[0, 0]]", vec![("HP0107", Some(4))]),
        ("poses = [[0, 0, 0]]\nclosed = true", vec![("HP0107", Some(4))]),
        ("points = [[0, 0]]\ntolerance = -1", vec![("HP0109", Some(4))]),
        ("points = [[0, 0]]\nlinkages = [\"fourbar\"]", vec![("HP0106", Some(4))]),
        ("points = [[0, 0]]\nlinkages = []", vec![("HP0109", Some(4))]),
        ("points = [[0, 0]]\nfixed_region = { x = [1, 0], y = [0, 1] }", vec![("HP0109", Some(4))]),
        ("points = [[0, 0]]\nfixed_region = { x = [0, 1] }", vec![("HP0104", Some(4))]),
        ("points = [[0, 0]]\nanswers = 0", vec![("HP0109", Some(4))]),
        ("points = [[0, 0]]\nfull_turns = true", vec![("HP0103", Some(4))]),
        ("points = [[0, 0]", vec![("HP0102", Some(3))]),
        ("points = \"p.csv\"", vec![("HP0111", Some(3))]),
    ] {
        assert_eq!(codes(body), expected, "{body}");
    }
    let none = TaskFile::parse("points = [[0, 0]]", "t.toml").expect_err("refused");
    assert_eq!(none.list().len(), 2, "{none}");
}
