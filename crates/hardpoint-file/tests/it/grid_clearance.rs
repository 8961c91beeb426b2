//! Least distances of shapes over a grid of two drivers: against dense grids and re-solved designs.

use hardpoint::model::{Grid, Model, VariableId};
use hardpoint::topology::Formulation;
use hardpoint_file::parse;
use hardpoint_study::grid::{GridClearances, GridMap, GridPlace};

/// Strut over travel and steer with a ball on the knuckle beside three balls and a plane of the frame: the nearest
/// position is inside the grid, at the end of one range, and at the ends of both.
fn strut() -> Model {
    let text = std::fs::read_to_string("../../models/studies/strut_map.toml").unwrap();
    // The drivers fix travel and steer, so that the tie rod has no influence.
    let text = text.replace(
        "[design]\n",
        "[design]\nball_y = { move = \"ball_joint\", along = \"y\" }\ntop_x = { move = \"strut_top\", along = \"x\" }\n",
    );
    let shapes = "
[shapes]
ball = { body = \"knuckle\", sphere = [-200, 700, 0], radius = 12 }
tyre = { wheel = \"front_left\", width = 190, round = 25 }
near = { body = \"ground\", sphere = [-195, 645, 10], radius = 5 }
high = { body = \"ground\", sphere = [-205, 665, 140], radius = 5 }
floor = { body = \"ground\", plane = [0, 0, -70], normal = [0.3, 0.2, 1] }
arch = { body = \"ground\", plane = [0, 0, 500], normal = [0, 0, -1] }
[clearances.inside]
between = [\"ball\", \"near\"]
[clearances.edge]
between = [\"ball\", \"high\"]
[clearances.corner]
between = [\"ball\", \"floor\"]
[clearances.wheel]
between = [\"tyre\", \"arch\"]
";
    parse(&format!("{text}{shapes}"), "strut_map.toml").unwrap_or_else(|e| panic!("{e}")).model
}

fn located(model: &Model, grid: &Grid, design: &[f64]) -> GridClearances {
    GridClearances::solve(model, grid, Formulation::Relative, design, &|| true).unwrap()
}

/// The same grid with `steps` steps per driver between these values, m or rad.
fn dense(grid: &Grid, ranges: [[f64; 2]; 2], steps: usize) -> Grid {
    let values =
        ranges.map(|[from, to]| (0..=steps).map(|k| from + (to - from) * k as f64 / steps as f64).collect());
    Grid { values, ..grid.clone() }
}

/// Index of the clearance measure of that name in a map.
fn output(map: &GridMap, name: &str) -> usize {
    map.outputs.iter().position(|o| o.name == name).unwrap()
}

#[test]
fn minima_over_a_grid_are_located_and_never_above_a_dense_grid() {
    let model = strut();
    let grid = &model.grids[0];
    let found = located(&model, grid, &[]);
    assert_eq!(found.solved, 143);
    let places = [
        ("inside", GridPlace::Inside),
        ("edge", GridPlace::Edge),
        ("corner", GridPlace::Corner),
        ("wheel", GridPlace::Corner),
    ];
    // Half a step of the grid to each side, within the range.
    let around = |at: [f64; 2]| {
        [0, 1].map(|k| {
            let v = &grid.values[k];
            let (low, high) = (v[0], v[v.len() - 1]);
            let half = 0.5 * (high - low) / (v.len() - 1) as f64;
            let from = (at[k] - half).max(low);
            [from, (from + 2.0 * half).min(high)]
        })
    };
    for (name, place) in places {
        let clearance = model.clearances.iter().find(|c| c.name == name).unwrap();
        let pair = found.pairs.iter().find(|p| p.shapes == clearance.pairs[0].shapes).unwrap();
        let least = &pair.minima[0];
        assert!(least.is_located, "{name}");
        assert_eq!(least.place, place, "{name}");
        let whole = [0, 1].map(|k| {
            let v = &grid.values[k];
            [v[0], v[v.len() - 1]]
        });
        for ranges in [whole, around(least.drivers)] {
            let map = GridMap::solve(&model, &dense(grid, ranges, 40), Formulation::Relative, &[], &|| true)
                .unwrap();
            let m = output(&map, name);
            let lowest = map.places().filter_map(|at| map.value(at, m)).fold(f64::INFINITY, f64::min);
            // Positions are solved to 1e-12 of the mechanism's size.
            assert!(least.at.distance[0] <= lowest + 1e-12 * model.size(), "{name}");
            // Spacing of the dense grid: a third of a millimetre of the ball's way at most.
            let near = if ranges == whole { 2e-3 } else { 3e-5 };
            assert!(lowest - least.at.distance[0] < near, "{name}: {} {lowest}", least.at.distance[0]);
        }
    }
}

#[test]
fn least_distances_over_a_grid_change_with_the_design_like_resolved_ones() {
    let model = strut();
    let grid = &model.grids[0];
    let at = |design: &[f64]| -> Vec<f64> {
        located(&model, grid, design).pairs.iter().map(|p| p.minima[0].at.distance[0]).collect()
    };
    let found = located(&model, grid, &[]);
    let h = 1e-5;
    let mut largest = 0.0_f64;
    for b in 0..model.variables.len() {
        let moved = |sign: f64| {
            let mut design = vec![0.0; model.variables.len()];
            design[VariableId(b).0] = sign * h;
            at(&design)
        };
        let (up, down) = (moved(1.0), moved(-1.0));
        for (p, pair) in found.pairs.iter().enumerate() {
            let quotient = (up[p] - down[p]) / (2.0 * h);
            let d = pair.minima[0].d[b];
            // Of second order in h, and round-off over h.
            assert!((d - quotient).abs() < 1e-6, "pair {p}, variable {b}: {d} {quotient}");
            largest = largest.max(d.abs());
        }
    }
    assert!(largest > 0.01, "{largest}");
}

#[test]
fn the_spacing_of_a_grid_does_not_change_its_least_distances() {
    let model = strut();
    let grid = &model.grids[0];
    let ends = [0, 1].map(|k| [grid.values[k][0], grid.values[k][grid.values[k].len() - 1]]);
    let of = |steps| located(&model, &dense(grid, ends, steps), &[]);
    let (coarse, fine) = (of(5), of(17));
    for (a, b) in coarse.pairs.iter().zip(&fine.pairs) {
        let [a, b] = [a, b].map(|pair| &pair.minima[0]);
        assert!((a.at.distance[0] - b.at.distance[0]).abs() < 1e-12 * model.size());
        // A place is known to the root of that.
        assert!((0..2).all(|k| (a.drivers[k] - b.drivers[k]).abs() < 1e-6), "{a:?} {b:?}");
    }
}
