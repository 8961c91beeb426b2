//! Answers of a synthesis: their models are read, followed by the engine, and say what they miss.

use std::path::{Path, PathBuf};

use hardpoint::run::metrics;
use hardpoint::{Analysis, Run};
use hardpoint_file::{Severity, TaskFile};
use hardpoint_report::synthesis::{
    AnswerFact, SynthesisFacts, followed_model, model_text, picture, refusal, task_of,
};
use hardpoint_study::synthesis::{Synthesis, Task, synthesize};

fn tasks() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/tasks")
}

fn read(name: &str) -> (TaskFile, Task, Synthesis) {
    let file = TaskFile::read(&tasks().join(format!("{name}.toml"))).unwrap_or_else(|e| panic!("{e}"));
    let task = task_of(&file);
    let found = synthesize(&task, &|| true).unwrap_or_else(|e| panic!("{e:?}"));
    (file, task, found)
}

fn parsed(body: &str) -> TaskFile {
    let text = format!("name = \"t\"\nunits = {{ length = \"in\", angle = \"rad\" }}\n{body}");
    TaskFile::parse(&text, "t.toml").unwrap_or_else(|e| panic!("{e}"))
}

/// Models of all answers of a task: read, followed, and their metrics as in the answer.
fn follow(file: &TaskFile, found: &Synthesis) -> Vec<AnswerFact> {
    assert!(!found.answers.is_empty(), "{}", file.name);
    let each = |(k, answer)| {
        let text = model_text(file, answer, k + 1);
        let (model, by_engine) =
            followed_model(answer, &text, "model.toml", found.size).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let by_engine = by_engine.unwrap_or_else(|| panic!("the engine misses it:\n{text}"));
        let warnings = model.remarks.iter().filter(|d| d.severity != Severity::Note).count();
        assert_eq!(warnings, 0, "{:?}", model.remarks);
        // The metrics are the distances from the targets, found by the engine alone.
        let analysis = Analysis::new(&model.model).unwrap();
        let solution = analysis.solve(Run::new());
        assert!(solution.stop.is_none());
        let values = metrics(&model.model, &solution);
        let of = |name: &str| {
            values[model.model.metrics.iter().position(|m| m.name == name).unwrap()].value.unwrap()
        };
        let missed = of("missed_x").hypot(of("missed_y"));
        assert!((missed - answer.rms).abs() <= 1e-9 * found.size, "{missed:e} {:e}\n{text}", answer.rms);
        let least = of("least_transmission");
        assert!(least >= answer.passage.transmission - 1e-9, "{least} {}", answer.passage.transmission);
        assert!(least < answer.passage.transmission + 0.02, "{least} {}", answer.passage.transmission);
        let svg = picture(file, answer);
        assert!(svg.starts_with("<svg") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{svg}");
        AnswerFact::of(file.units, k + 1, answer, &by_engine)
    };
    found.answers.iter().enumerate().map(each).collect()
}

#[test]
fn the_answers_of_every_task_are_models_that_pass_it() {
    for name in ["tailgate", "gripper", "foot"] {
        let (file, task, found) = read(name);
        let mut facts = SynthesisFacts::of(&file, &task, &found);
        facts.answers = follow(&file, &found);
        assert!(facts.advice().is_none());
        let tables = facts.tables();
        assert_eq!(tables[0].rows.len(), found.answers.len());
        let mut csv = Vec::new();
        facts.write_answers(&mut csv, file.units).unwrap();
        let csv = String::from_utf8(csv).unwrap();
        assert_eq!(csv.lines().count(), found.answers.len() + 1);
        assert!(csv.starts_with("answer,type,A.x [mm],"), "{csv}");
    }
}

#[test]
fn the_numbers_of_linkages_are_in_words() {
    let (file, task, found) = read("gripper");
    let facts = SynthesisFacts::of(&file, &task, &found);
    let rows = facts.rows();
    let line = |label: &str| &rows.iter().find(|r| r.0 == label).unwrap().1;
    assert_eq!(line("dyads"), "4 of the 4 cranks are real");
    assert_eq!(line("linkages"), "6 four-bars: 1 with a change of branch, 1 on separate circuits, 4 good");
}

#[test]
fn answers_in_inches_and_radians_and_of_sliders_are_models_too() {
    let body =
        "poses = [[0, 0, 0.1], [1, 0.5, 0.5], [2.5, 0.6, 1.1]]\nlinkages = [\"slider_crank\"]\nanswers = 3";
    let file = parsed(body);
    let found = synthesize(&task_of(&file), &|| true).unwrap();
    let facts = follow(&file, &found);
    assert!(facts.iter().all(|f| f.along.is_some() && f.rocker.is_none()));
    // One with a crank that turns fully, and poses in any order
    let file = parsed(&format!("{body}\nfull_turn = true\nany_order = true"));
    let found = synthesize(&task_of(&file), &|| true).unwrap();
    assert!(follow(&file, &found).iter().all(|f| f.full_turn));
}

#[test]
fn tasks_without_a_synthesis_are_explained() {
    for (body, code, part) in [
        ("poses = [[0, 0, 0], [1, 1, 1]]", "HP0901", "2 poses"),
        ("points = [[0, 0], [1, 1]]", "HP0901", "three points"),
        ("poses = [[0, 0, 0], [1, 1, 1], [0, 0, 0]]", "HP0902", "poses 1 and 3"),
        ("poses = [[0, 0, 0], [1, 1, 0], [2, 0, 0]]", "HP0902", "orientation"),
        (
            "poses = [[1, 0, 0], [0, 1, 1.5707963267948966], [-1, 0, 3.141592653589793]]",
            "HP0902",
            "(0, 0) in",
        ),
        ("points = [[0, 0], [1, 1], [2, 2]]", "HP0902", "one line"),
        ("points = [[0, 0], [1, 1], [2, 0]]\ncrank_angles = [0, 1]", "HP0901", "2 `crank_angles`"),
        ("points = [[0, 0], [1, 1], [2, 0]]\ncrank_angles = [0, 1, 0.5]", "HP0902", "crank angle 3"),
        (
            "poses = [[0, 0, 0], [1, 1, 1], [2, 0, 2], [3, 1, 1]]\nfixed_pivots = [[0, 0]]",
            "HP0902",
            "three poses only",
        ),
        (
            "poses = [[0, 0, 0], [2, 1, 30], [3, 2, 70]]\nfixed_pivots = [[1, -1], [2, 0], [1, -1]]",
            "HP0902",
            "fixed pivots 1 and 3",
        ),
    ] {
        let file = parsed(body);
        let error = synthesize(&task_of(&file), &|| true).expect_err(body);
        let found = refusal(&file, &error);
        let [d] = found.list() else { panic!("{found}") };
        assert!(d.code == code && d.message.contains(part), "{body}: {found}");
        assert!(d.help.is_some() && d.line.is_some(), "{found}");
    }
}

#[test]
fn poses_without_an_answer_have_an_advice() {
    let file = parsed(
        "poses = [[0, 0, 0], [40, 70, 2.8], [2, 3, -0.7], [-100, 3, 1.3], [30, -30, 0.2]]\nfull_turn = true",
    );
    let task = task_of(&file);
    let found = synthesize(&task, &|| true).unwrap();
    assert!(found.answers.is_empty());
    let facts = SynthesisFacts::of(&file, &task, &found);
    let (why, help) = facts.advice().unwrap();
    assert!(!why.is_empty() && help.contains("pose"), "{why} {help}");
    assert_eq!(facts.status, "none");
}

#[test]
fn a_task_whose_answers_the_engine_does_not_reproduce_has_none() {
    let (file, task, found) = read("gripper");
    let mut facts = SynthesisFacts::of(&file, &task, &found);
    facts.leave_out(4);
    assert_eq!(facts.status, "none");
    let (why, help) = facts.advice().unwrap();
    let expected = "4 linkages pass all poses without a defect, but the engine does not reproduce the motion";
    assert!(why == expected && help.contains("lengths"), "{why}; {help}");
    // With another answer there is one.
    let mut facts = SynthesisFacts::of(&file, &task, &found);
    facts.answers = follow(&file, &found);
    facts.leave_out(1);
    assert!(facts.status == "found" && facts.advice().is_none());
}

/// Change of a coordinate of a synthesised model, m: far below its bounds of a tenth of the size of the task.
const SHIFT: f64 = 1e-5;

#[test]
fn synthesised_models_are_saved_with_every_coordinate_at_another_place() {
    let (file, _, found) = read("tailgate");
    for (k, answer) in found.answers.iter().enumerate() {
        let text = model_text(&file, answer, k + 1);
        let (model, _) =
            followed_model(answer, &text, "model.toml", found.size).unwrap_or_else(|e| panic!("{e}"));
        let design: Vec<f64> = (1..=model.model.variables.len()).map(|k| SHIFT * k as f64).collect();
        let saved = model.edit(&design).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let again = hardpoint_file::parse(&saved, "model.toml").unwrap_or_else(|e| panic!("{e}\n{saved}"));
        let of = |file: &hardpoint_file::ModelFile, design: &[f64]| -> Vec<f64> {
            let analysis = Analysis::new(&file.model).unwrap();
            let solution = analysis.solve(Run::new().at(design).without_sensitivities());
            metrics(&file.model, &solution).into_iter().map(|m| m.value.unwrap()).collect()
        };
        let (before, after) = (of(&model, &design), of(&again, &[]));
        assert!(before.len() >= 3 && before.iter().zip(of(&model, &[])).any(|(a, b)| (a - b).abs() > SHIFT));
        for (a, b) in before.iter().zip(after) {
            assert!((a - b).abs() <= 1e-9, "{a} {b}\n{saved}");
        }
        let names = |file: &hardpoint_file::ModelFile| -> Vec<String> {
            file.model.variables.iter().map(|v| v.name.clone()).collect()
        };
        assert_eq!(names(&model), names(&again));
    }
}

#[test]
fn poses_without_linkages_are_not_explained_by_a_path() {
    let file = parsed(
        "poses = [[0, 0, 0], [1, 0, 0.3], [2, 0.5, 0.8]]\nlinkages = [\"slider_crank\"]\nmoving_region = { x = [50, 51], y = [50, 51] }\n",
    );
    let found = synthesize(&task_of(&file), &|| true).unwrap();
    let mut facts = SynthesisFacts::of(&file, &task_of(&file), &found);
    facts.cranks = Some(3);
    facts.sliders = Some(0);
    let (why, help) = facts.advice().unwrap();
    assert!(!why.contains("path") && why.contains("poses") && !help.contains("bends"), "{why}; {help}");
}
