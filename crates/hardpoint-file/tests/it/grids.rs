//! Cases that sweep two drivers over a grid, against single runs.

use hardpoint::law::Law;
use hardpoint::model::{Case, CaseId, Model, VariableId};
use hardpoint::topology::Formulation;
use hardpoint::{Analysis, Solution};
use hardpoint_file::parse;
use hardpoint_study::grid::GridMap;

use crate::diagnostics::{VALID, snapshot};

/// The front axle with a map over left bump and steer.
fn front_axle(grid: &str) -> Model {
    let text = std::fs::read_to_string("../../models/front_axle.toml").unwrap();
    let text = format!("{text}\n[cases.map]\n{grid}\n");
    parse(&text, "front_axle.toml").unwrap_or_else(|e| panic!("{e}")).model
}

fn solved(model: &Model, design: &[f64]) -> GridMap {
    let [grid] = &model.grids[..] else { panic!("one grid") };
    GridMap::solve(model, grid, Formulation::Relative, design, &|| true).unwrap()
}

/// Straight from the drawing to one position, both drivers at once.
fn alone(model: &Model, map: &GridMap, [i, j]: [usize; 2]) -> Solution {
    let mut laws = vec![Some(Law::constant(0.0)); model.drivers.len()];
    for (k, place) in [i, j].into_iter().enumerate() {
        let position = map.grid.values[k][place];
        laws[map.grid.drivers[k].0] = Some(Law::parse(&format!("({position:?})*t")).unwrap());
    }
    let case = Case {
        name: "alone".into(),
        laws,
        formulas: Vec::new(),
        times: vec![0.0, 0.5, 1.0],
        force_laws: Vec::new(),
        load_mode: None,
    };
    let model = Model { cases: vec![case], ..model.clone() }.in_case(CaseId(0));
    Analysis::new(&model).unwrap().run()
}

#[test]
fn toe_over_travel_and_steer_is_that_of_single_runs_with_all_its_sensitivities() {
    let grid = "grid = { left_bump = { from = -60, to = 60, steps = 4 }, steering = { at = [-15, -4, 15] } }";
    let model = front_axle(grid);
    let map = solved(&model, &[]);
    assert_eq!(map.grid.name, "map");
    assert_eq!(map.grid.drivers.map(|d| model.drivers[d.0].name.as_str()), ["left_bump", "steering"]);
    let in_mm = |k: usize| map.grid.values[k].iter().map(|v| (v * 1e3).round()).collect::<Vec<_>>();
    assert_eq!([in_mm(0), in_mm(1)], [vec![-60.0, -30.0, 0.0, 30.0, 60.0], vec![-15.0, -4.0, 15.0]]);
    assert_eq!((map.solved(), map.stops.len(), map.interrupted()), (15, 0, false));
    // Each row has an upper and a lower half, and each half begins in the drawing.
    assert_eq!((map.cost.designs, map.cost.motions, map.cost.steps), (1, 6, 15 + 6));
    let toe = map.outputs.iter().position(|o| o.name == "left.toe").unwrap();
    let bump_steer = map.outputs.iter().position(|o| o.name == "left.bump_steer").unwrap();
    let (mut most, mut moved) = (0.0_f64, 0.0_f64);
    for place in map.places() {
        let single = alone(&model, &map, place);
        assert!(single.stop.is_none());
        for m in [toe, bump_steer] {
            let value = map.value(place, m).unwrap();
            assert!((value - single.measured.value(2, m)[0]).abs() < 1e-10, "{place:?}: {value}");
            most = most.max(value.abs());
            for v in (0..model.variables.len()).map(VariableId) {
                let (found, expected) = (map.d(place, v, m).unwrap(), single.measured.d(2, v, m)[0]);
                assert!((found - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{place:?} by {}", v.0);
                moved = moved.max(found.abs());
            }
        }
    }
    // What is measured of a motion has no number where there is none.
    let hop = map.outputs.iter().position(|o| o.name == "left_hop").unwrap();
    assert!(!map.has(hop) && map.has(toe) && map.has(bump_steer));
    assert!(map.places().all(|place| {
        map.is_solved(place) && map.value(place, hop).is_none() && map.d(place, VariableId(0), hop).is_none()
    }));
    // It is a map of something: the wheel steers by degrees, and the tie rod turns it by degrees per 10 mm.
    assert!(most > 0.1 && moved > 1.0, "{most} {moved}");
}

#[test]
fn sensitivities_of_a_map_are_those_of_resolved_maps() {
    let model = front_axle(
        "grid = { left_bump = { from = -40, to = 50, steps = 2 }, steering = { at = [-10, 10] } }",
    );
    let map = solved(&model, &[]);
    let toe = map.outputs.iter().position(|o| o.name == "left.toe").unwrap();
    for name in ["tie_rod_outer_z", "lower_ball_x", "uca_rear_z"] {
        let v = model.variable(name).unwrap();
        let h = 1e-4 * model.natural_step(v);
        let [more, less] = [h, -h].map(|b| {
            let mut design = vec![0.0; model.variables.len()];
            design[v.0] = b;
            solved(&model, &design)
        });
        for place in map.places() {
            let difference = (more.value(place, toe).unwrap() - less.value(place, toe).unwrap()) / (2.0 * h);
            let found = map.d(place, v, toe).unwrap();
            assert!((found - difference).abs() < 1e-5 * (1.0 + found.abs()), "{name}: {found} {difference}");
        }
    }
}

#[test]
fn only_unreachable_positions_are_gaps_and_have_a_reason() {
    let model = front_axle(
        "grid = { left_bump = { from = -60, to = 600, steps = 11 }, steering = { from = -15, to = 15, steps = 2 } }",
    );
    let map = solved(&model, &[]);
    let toe = map.outputs.iter().position(|o| o.name == "left.toe").unwrap();
    // Every row ends on its upper side; the lower one is whole.
    assert_eq!(map.stops.iter().map(|s| s.row).collect::<Vec<_>>(), [0, 1, 2]);
    assert!(!map.interrupted());
    for [i, j] in map.places() {
        let [bump, steer] = [map.grid.values[0][i], map.grid.values[1][j]];
        let stop = &map.stops[j];
        // Where the first driver stood is where the row ends, and the second stood in its place.
        assert!(
            stop.drivers[0] > 0.06 && stop.drivers[0] < 0.6 && stop.drivers[1] == steer,
            "{:?}",
            stop.drivers
        );
        let reached = bump < stop.drivers[0];
        assert_eq!(map.is_solved([i, j]), reached, "{bump} {:?}", stop.drivers);
        assert_eq!(map.value([i, j], toe).is_some(), reached);
        assert_eq!(map.d([i, j], VariableId(0), toe).is_some(), reached);
        assert_eq!(map.stop_index([i, j]).map(|s| map.stops[s].row), (!reached).then_some(j));
        if reached {
            let single = alone(&model, &map, [i, j]).measured.value(2, toe)[0];
            assert!((map.value([i, j], toe).unwrap() - single).abs() < 1e-9);
        }
    }
    assert!(map.solved() > 6 && map.solved() < 33, "{}", map.solved());
}

#[test]
fn an_interrupted_map_lists_the_positions_that_were_not_tried() {
    let model = front_axle("grid = { left_bump = { at = [-10, 10] }, steering = { at = [-1, 1] } }");
    let asked = std::sync::atomic::AtomicUsize::new(0);
    let more = || asked.fetch_add(1, std::sync::atomic::Ordering::SeqCst) < 8;
    let map = GridMap::solve(&model, &model.grids[0], Formulation::Relative, &[], &more).unwrap();
    assert!(map.interrupted() && map.solved() > 0 && map.solved() < 4 && map.stops.is_empty());
}

#[test]
fn a_map_among_cases_is_not_a_motion() {
    let model = front_axle(
        "grid = { left_bump = { at = [-10, 10] }, steering = { at = [-1, 1] } }\n[cases.steer]\nlaws = { steering = \"t\" }",
    );
    assert_eq!(model.motions().len(), 1);
    assert_eq!((model.cases.len(), model.grids.len()), (1, 1));
    let alone = front_axle("grid = { left_bump = { at = [-10, 10] }, steering = { at = [-1, 1] } }");
    assert_eq!((alone.motions().len(), alone.cases.len()), (1, 0));
}

#[test]
fn broken_grids() {
    let two = VALID
        .replacen("[bodies]\n", "[bodies]\nspare = {}\n", 1)
        .replacen("[time]", "[joints.J5]\ntype = \"revolute\"\nbodies = [\"ground\", \"spare\"]\nat = \"A\"\naxis = \"z\"\n\n[drivers.other]\njoint = \"J5\"\nlaw = \"t\"\n\n[time]", 1);
    let range = "{ from = -10, to = 10, steps = 4 }";
    let both = format!("turn = {range}, other = {range}");
    for (name, case) in [
        ("grid_of_one_driver", format!("grid = {{ turn = {range} }}")),
        ("grid_of_no_driver", "grid = {}".to_owned()),
        ("grid_of_an_unknown_driver", format!("grid = {{ turn = {range}, othr = {range} }}")),
        ("grid_with_laws", format!("grid = {{ {both} }}\nlaws = {{ turn = \"t\" }}")),
        ("grid_with_time", format!("grid = {{ {both} }}\ntime = {{ end = 1.0, steps = 10 }}")),
        ("grid_of_a_text", "grid = \"turn\"".to_owned()),
        ("grid_that_falls", format!("grid = {{ turn = {{ from = 10, to = -10, steps = 4 }}, other = {range} }}")),
        ("grid_without_steps", format!("grid = {{ turn = {{ from = -10, to = 10 }}, other = {range} }}")),
        ("grid_of_half_a_step", format!("grid = {{ turn = {{ from = -10, to = 10, steps = 0.5 }}, other = {range} }}")),
        ("grid_of_listed_places_that_fall", format!("grid = {{ turn = {{ at = [0, 2, 1] }}, other = {range} }}")),
        ("grid_of_one_place", format!("grid = {{ turn = {{ at = [0] }}, other = {range} }}")),
        ("grid_of_a_range_and_a_list", format!("grid = {{ turn = {{ at = [0, 1], to = 5 }}, other = {range} }}")),
        ("grid_with_misspelt_key", format!("grid = {{ turn = {{ form = -10, to = 10, steps = 4 }}, other = {range} }}")),
        ("grid_that_is_too_large", "grid = { turn = { from = -1, to = 1, steps = 9000 }, other = { from = -1, to = 1, steps = 9000 } }".to_owned()),
    ] {
        snapshot(name, &format!("{two}\n[cases.map]\n{case}\n"));
    }
    let without = two.replacen("joint = \"J5\"\nlaw = \"t\"\n", "joint = \"J5\"\n", 1);
    snapshot("grid_where_a_driver_has_no_law", &format!("{without}\n[cases.map]\ngrid = {{ {both} }}\n"));
    let metric = "[metrics.height]\nof = \"height\"\ntake = \"max\"\ncase = \"map\"\n";
    snapshot("metric_of_a_grid", &format!("{two}\n{metric}\n[cases.map]\ngrid = {{ {both} }}\n"));
}
