//! Tables over drivers: the proved error holds at many positions, against closed forms and the solved motion.

use hardpoint::Analysis;
use hardpoint::model::Model;
use hardpoint::motion::StopKind;
use hardpoint::run::Run;
use hardpoint::topology::Formulation;
use hardpoint_file::parse;
use hardpoint_study::map::{
    ErrorScope, Interpolation, MapError, MapTable, Overrides, ProofError, Request, solve,
};

/// Positions at which errors are compared with their bounds; `HARDPOINT_MAP_POSITIONS` sets another number.
fn positions() -> usize {
    let number = std::env::var("HARDPOINT_MAP_POSITIONS").ok();
    number.map_or(20_000, |n| n.parse().expect("a number of positions"))
}

/// Round-off of a closed form or of a solved position, as a fraction of the size of the numbers: far below all bounds.
const ROUND_OFF: f64 = 1e-13;

fn model(text: &str) -> Model {
    parse(text, "mapped.toml").unwrap_or_else(|e| panic!("{e}")).model
}

fn gallery(name: &str) -> String {
    std::fs::read_to_string(format!("../../models/{name}.toml")).unwrap()
}

fn request(
    model: &Model,
    over: &[(&str, [f64; 2])],
    of: &[(&str, f64)],
    interpolation: Interpolation,
) -> Request {
    let overrides = Overrides {
        over: over.iter().map(|(name, range)| ((*name).to_owned(), *range)).collect(),
        of: of.iter().map(|(name, _)| (*name).to_owned()).collect(),
        errors: of.iter().map(|(name, error)| (ErrorScope::Output((*name).to_owned()), *error)).collect(),
        interpolation,
        intervals: None,
    };
    Request::of(model, overrides).unwrap_or_else(|e| panic!("{e}"))
}

fn table(
    model: &Model,
    over: &[(&str, [f64; 2])],
    of: &[(&str, f64)],
    interpolation: Interpolation,
) -> MapTable {
    let request = request(model, over, of, interpolation);
    let table = solve(model, Formulation::Relative, &request, &mut |_, _| true);
    let table = table.unwrap_or_else(|e| panic!("{e:?}"));
    for (column, (name, error)) in table.columns.iter().zip(of) {
        assert!(column.proved > 0.0 && column.proved <= *error, "{name}: {} of {error}", column.proved);
        assert!(column.numbers.iter().all(|x| x.is_finite()));
    }
    table
}

/// Deterministic numbers in [0, 1).
fn fractions(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Largest error of each column at random positions, in units of its proved bound.
fn worst(table: &MapTable, exact: &dyn Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let mut next = fractions(3);
    let mut worst = vec![0.0_f64; table.columns.len()];
    for _ in 0..positions() {
        let at: Vec<f64> =
            table.knots.iter().map(|knots| knots[0] + next() * (knots[knots.len() - 1] - knots[0])).collect();
        for (c, exact) in exact(&at).into_iter().enumerate() {
            let error = (table.value(c, &at) - exact).abs() - ROUND_OFF * (1.0 + exact.abs());
            worst[c] = worst[c].max(error / table.columns[c].proved);
        }
    }
    worst
}

const SLIDER_CRANK: &str = r#"
name = "slider-crank"
units = { length = "mm", angle = "deg" }
[hardpoints]
O = [0, 0, 0]
A = [50, 0, 0]
B = [200, 0, 0]
[bodies]
crank = {}
rod = {}
slider = {}
[joints]
bearing = { type = "revolute", bodies = ["ground", "crank"], at = "O", axis = "z" }
crank_pin = { type = "revolute", bodies = ["crank", "rod"], at = "A", axis = "z" }
slider_pin = { type = "revolute", bodies = ["rod", "slider"], at = "B", axis = "z" }
slide = { type = "translational", bodies = ["ground", "slider"], at = "B", axis = "x" }
[drivers]
motor = { joint = "bearing", law = "360*t" }
[points]
pin = { body = "slider", at = "B" }
[time]
end = 1
steps = 10
"#;

fn of_slider_crank(at: &[f64]) -> Vec<f64> {
    let (sin, cos) = at[0].sin_cos();
    vec![0.05 * cos + (0.15_f64.powi(2) - (0.05 * sin).powi(2)).sqrt()]
}

#[test]
fn the_error_of_a_slider_crank_is_below_its_bound_for_both_interpolations() {
    let model = model(SLIDER_CRANK);
    let range = [-2.0, 5.0];
    let mut cells = Vec::new();
    for interpolation in [Interpolation::Hermite, Interpolation::Linear] {
        let table = table(&model, &[("motor", range)], &[("pin.x", 1e-7)], interpolation);
        assert_eq!([table.knots[0][0], table.knots[0][table.cells()]], range);
        let [worst] = worst(&table, &of_slider_crank)[..] else { panic!("one output") };
        assert!(worst <= 1.0, "{interpolation:?}: {worst}");
        // The bound is of the size of the error, so that an error in a formula of either shows.
        assert!(worst > 0.2, "{interpolation:?}: the bound is {} times the error", 1.0 / worst);
        cells.push(table.cells());
    }
    assert!(20 * cells[0] < cells[1], "{cells:?}");
}

const FOUR_BAR: &str = r#"
name = "four-bar"
units = { length = "m", angle = "rad" }
[hardpoints]
A = [0, 0, 0]
B = [0.04, 0.2, 0]
C = [0.36, 0.6, 0]
D = [0.5, 0, 0]
[bodies]
crank = {}
rocker = {}
[joints]
bearing = { type = "revolute", bodies = ["ground", "crank"], at = "A", axis = "z" }
pivot = { type = "revolute", bodies = ["ground", "rocker"], at = "D", axis = "z" }
rod = { type = "distance", bodies = ["crank", "rocker"], at = ["B", "C"] }
[drivers]
motor = { joint = "bearing", law = "t" }
[points]
end = { body = "rocker", at = "C" }
[time]
end = 1
steps = 10
"#;

fn of_four_bar(at: &[f64]) -> Vec<f64> {
    let (sin, cos) = at[0].sin_cos();
    let b = [0.04 * cos - 0.2 * sin, 0.04 * sin + 0.2 * cos];
    // C is the intersection of the circles about B and D above the line from B to D.
    let rod = 0.32_f64.hypot(0.4);
    let rocker = 0.14_f64.hypot(0.6);
    let d = [0.5 - b[0], -b[1]];
    let far = d[0].hypot(d[1]);
    let along = (far * far + rod * rod - rocker * rocker) / (2.0 * far);
    let beside = (rod * rod - along * along).sqrt();
    let u = d.map(|x| x / far);
    vec![b[0] + along * u[0] - beside * u[1], b[1] + along * u[1] + beside * u[0]]
}

#[test]
fn the_error_of_a_four_bar_over_a_whole_turn_is_below_its_bound() {
    let model = model(FOUR_BAR);
    let of = [("end.x", 1e-6), ("end.y", 1e-6)];
    let table = table(&model, &[("motor", [-3.2, 3.2])], &of, Interpolation::Hermite);
    let worst = worst(&table, &of_four_bar);
    assert!(worst.iter().all(|x| *x <= 1.0) && worst.iter().any(|x| *x > 0.1), "{worst:?}");
}

/// Sets the law of a driver in a model's text.
fn with_law(text: &str, old: &str, new: &str) -> String {
    assert!(text.contains(old), "{old}");
    text.replace(old, new)
}

/// Largest errors along motions through the ranges, in units of the bounds. Per driver: the middle and the half of its
/// range in its unit, the number of units per SI unit, and its frequency and phase.
fn worst_along(
    table: &MapTable,
    names: &[&str],
    drivers: &[[f64; 5]],
    text_of: &dyn Fn(&[String], usize) -> String,
) -> Vec<f64> {
    const STEPS: usize = 20_000;
    let mut worst = vec![0.0_f64; names.len()];
    for run in 0..positions().div_ceil(STEPS) {
        let at = |t: f64| -> Vec<f64> {
            let value = |[middle, half, per_si, frequency, phase]: &[f64; 5]| {
                (middle + half * (frequency * t + phase + run as f64).sin()) / per_si
            };
            drivers.iter().map(value).collect()
        };
        let law = |[middle, half, _, frequency, phase]: &[f64; 5]| {
            format!("{middle:?} + {half:?}*sin({frequency:?}*t + {:?})", phase + run as f64)
        };
        let laws: Vec<String> = drivers.iter().map(law).collect();
        let model = model(&text_of(&laws, STEPS));
        let analysis = Analysis::new(&model).unwrap();
        let solution = analysis.solve(Run::new().without_sensitivities());
        assert!(solution.stop.is_none());
        for (k, t) in solution.motion.times.iter().enumerate() {
            let at = at(*t);
            for (c, name) in names.iter().enumerate() {
                let exact = solution.measured.value(k, solution.measured.index(name).unwrap())[0];
                let error = (table.value(c, &at) - exact).abs() - ROUND_OFF * 100.0;
                worst[c] = worst[c].max(error / table.columns[c].proved);
            }
        }
    }
    worst
}

fn wishbone(laws: &[String], steps: usize) -> String {
    let text = gallery("double_wishbone");
    let text = with_law(&text, "\"4 + 20*sin(2*pi*t)\"", &format!("{:?}", laws[0]));
    let text = with_law(&text, "\"12*sin(2*pi*0.5*t)\"", &format!("{:?}", laws[1]));
    let (before, after) = text.split_once("[time]\n").unwrap();
    let rest = after.split_once("\n[").map_or("", |(_, rest)| rest);
    let rest = if rest.is_empty() { String::new() } else { format!("\n[{rest}") };
    format!("{before}[time]\nend = 100\nsteps = {steps}\n{rest}")
}

#[test]
fn the_error_of_toe_over_bump_and_steering_is_below_its_bound() {
    let model = model(&gallery("double_wishbone"));
    let over = [("spring_drive", [-0.016, 0.024]), ("rack_drive", [-0.012, 0.012])];
    let of = [("toe", 1e-3_f64.to_radians()), ("camber", 1e-3_f64.to_radians())];
    let mut cells = Vec::new();
    for interpolation in [Interpolation::Hermite, Interpolation::Linear] {
        let table = table(&model, &over, &of, interpolation);
        let drivers = [[4.0, 20.0, 1000.0, 1.0, 0.0], [0.0, 12.0, 1000.0, std::f64::consts::SQRT_2, 0.0]];
        let worst = worst_along(&table, &["toe", "camber"], &drivers, &wishbone);
        assert!(worst.iter().all(|x| *x <= 1.0), "{interpolation:?}: {worst:?}");
        // Bounds over boxes of two drivers are about a hundred times the error; those of second derivatives less.
        assert!(worst.iter().any(|x| *x > 0.002), "{interpolation:?}: {worst:?}");
        cells.push(table.cells());
    }
    assert!(5 * cells[0] < cells[1], "{cells:?}");
}

fn axle(laws: &[String], steps: usize) -> String {
    let text = gallery("front_axle");
    let text = with_law(&text, "\"15*sin(2*pi*t)\"", &format!("{:?}", laws[0]));
    let text = with_law(&text, "\"60*sin(4*pi*t)\"", &format!("{:?}", laws[1]));
    let text = with_law(&text, "\"60*sin(6*pi*t)\"", &format!("{:?}", laws[2]));
    let (before, after) = text.split_once("[time]\n").unwrap();
    let rest = after.split_once("\n[").map_or(String::new(), |(_, rest)| format!("\n[{rest}"));
    format!("{before}[time]\nend = 100\nsteps = {steps}\n{rest}")
}

#[test]
fn the_error_of_a_map_over_three_drivers_is_below_its_bound() {
    let model = model(&gallery("front_axle"));
    let over = [("steering", [-2e-3, 3e-3]), ("left_bump", [-4e-3, 4e-3]), ("right_bump", [-4e-3, 2e-3])];
    let of = [("toe_difference", 1e-3_f64.to_radians())];
    let table = table(&model, &over, &of, Interpolation::Hermite);
    let drivers = [
        [0.5, 2.5, 1000.0, 1.0, 0.1],
        [0.0, 4.0, 1000.0, std::f64::consts::SQRT_2, 0.0],
        [-1.0, 3.0, 1000.0, std::f64::consts::E, 0.0],
    ];
    let worst = worst_along(&table, &["toe_difference"], &drivers, &axle);
    assert!(worst[0] <= 1.0, "{worst:?}");
}

/// Unknowns of the platform are in m and rad. In a norm of row sums without weights, a box had to be a few tenths of a
/// degree wide, and the range took a thousand of them.
#[test]
fn a_platform_with_unknowns_in_m_and_rad_takes_few_boxes() {
    let model = model(&gallery("delta"));
    let range = [-1.0_f64, 1.0].map(f64::to_radians);
    let over = ["motor_1", "motor_2", "motor_3"].map(|name| (name, range));
    let table = table(&model, &over, &[("z", 1e-4)], Interpolation::Hermite);
    assert_eq!(table.cells(), 1);
    assert!(table.boxes < 150, "{} boxes", table.boxes);
}

#[test]
fn a_map_reports_its_progress_and_can_be_ended() {
    let model = model(&gallery("three_rrr"));
    let over =
        [("motor_1", 0.0), ("motor_2", 0.0), ("motor_3", 0.0)].map(|(name, from)| (name, [from, 0.05]));
    let request = request(&model, &over, &[("x", 1e-5)], Interpolation::Hermite);
    let mut reports: Vec<[usize; 2]> = Vec::new();
    let table = solve(&model, Formulation::Relative, &request, &mut |proved, cells| {
        reports.push([proved, cells]);
        true
    });
    let table = table.unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(reports.last(), Some(&[table.cells(); 2]));
    let half = reports.len() / 2;
    let mut left = half;
    let ended = solve(&model, Formulation::Relative, &request, &mut |_, _| {
        left = left.saturating_sub(1);
        left > 0
    });
    assert!(matches!(ended, Err(MapError::Interrupted)), "{ended:?}");
}

fn refused(text: &str, over: &[(&str, [f64; 2])], of: &[(&str, f64)]) -> MapError {
    let model = model(text);
    let request = request(&model, over, of, Interpolation::Hermite);
    solve(&model, Formulation::Relative, &request, &mut |_, _| true)
        .map(|table| table.positions())
        .unwrap_err()
}

#[test]
fn positions_that_are_not_reached_are_named() {
    // A rod of 50 mm instead of 150 mm reaches its slide for -90 to 90 deg only.
    let text = SLIDER_CRANK.replace("B = [200, 0, 0]", "B = [90, 0, 0]");
    let error = refused(&text, &[("motor", [0.0, 2.0])], &[("pin.x", 1e-6)]);
    let MapError::NotReached { drivers, last, .. } = error else { panic!("{error:?}") };
    let limit = (40.0_f64 / 50.0).asin();
    assert_eq!(drivers, [2.0]);
    assert!((last[0] - limit).abs() < 1e-3, "{last:?} {limit}");
}

#[test]
fn of_several_drivers_the_one_that_moves_too_far_is_named() {
    let text = SLIDER_CRANK.replace(
        "[joints]",
        "[joints]\nwheel = { type = \"revolute\", bodies = [\"ground\", \"wheel\"], at = \"A\", axis = \"z\" }",
    );
    let text = text.replace("[bodies]", "[bodies]\nwheel = {}");
    let text = text.replace("[drivers]", "[drivers]\nspin = { joint = \"wheel\", law = \"t\" }");
    let text = text.replace("[points]", "[points]\nrim = { body = \"wheel\", at = [9, 0, 0] }");
    let of = [("rim.x", 1e-6)];
    for over in [
        &[("motor", [0.0, 0.1]), ("spin", [0.0, 1e9])][..],
        &[("spin", [0.0, 1e9])],
        &[("spin", [-1e300, 1e300])],
    ] {
        let model = model(&text);
        let MapError::NotReached { stop, .. } = refused(&text, over, &of) else { panic!("{over:?}") };
        let StopKind::TooFar { driver } = stop.kind else { panic!("{stop:?}") };
        assert_eq!(model.drivers[driver.0].name, "spin");
    }
}

#[test]
fn outputs_that_jump_or_have_a_kink_have_no_proved_error() {
    // The angle jumps from pi to -pi inside of the range.
    let angle = "[measures]\nangle = { type = \"coordinate\", joint = \"bearing\" }\n[time]";
    let text = SLIDER_CRANK.replace("[time]", angle);
    let error = refused(&text, &[("motor", [2.0, 4.1])], &[("angle", 1e-6)]);
    let MapError::NotProved { part, reason: ProofError::Output(0) } = error else { panic!("{error:?}") };
    assert!(part[0][0] <= std::f64::consts::PI && std::f64::consts::PI <= part[0][1], "{part:?}");
    let kink = "[measures]\nheight = { type = \"expression\", expression = \"abs(pin.x - 150)\" }\n[time]";
    let error = refused(&SLIDER_CRANK.replace("[time]", kink), &[("motor", [0.5, 2.1])], &[("height", 1e-6)]);
    assert!(matches!(error, MapError::NotProved { reason: ProofError::Output(0), .. }), "{error:?}");
}

/// Piecewise functions whose branch is the same for all positions of a cell are those of the branch; the pin moves
/// through 0 to 300 mm here.
#[test]
fn piecewise_expressions_have_the_bounds_of_their_branches() {
    let measures = r#"[measures]
plain = { type = "expression", expression = "2 * pin.x" }
most = { type = "expression", expression = "max(pin.x, -10) + max(-10, pin.x)" }
least = { type = "expression", expression = "min(pin.x, 1000) + min(1000, pin.x)" }
chosen = { type = "expression", expression = "if(pin.x > -10, 2 * pin.x, 1) + if(pin.x < -10, 1, 0)" }
low = { type = "expression", expression = "2 * pin.x + step(pin.x, 1000, 0, 1001, 5)" }
high = { type = "expression", expression = "2 * pin.x - 3 + step(pin.x, -11, 0, -10, 3)" }
[time]"#;
    let model = model(&SLIDER_CRANK.replace("[time]", measures));
    let names = ["plain", "most", "least", "chosen", "low", "high"].map(|name| (name, 1e-7));
    let table = table(&model, &[("motor", [0.5, 2.1])], &names, Interpolation::Hermite);
    let [plain, others @ ..] = &table.columns[..] else { panic!() };
    for (column, (name, _)) in others.iter().zip(&names[1..]) {
        for (found, expected) in column.numbers.iter().zip(&plain.numbers) {
            assert!((found - expected).abs() < ROUND_OFF, "{name}: {found} {expected}");
        }
    }
    let between = "[measures]\nheight = { type = \"expression\", expression = \"step(pin.x, 160, 0, 165, 3)\" }\n[time]";
    let error =
        refused(&SLIDER_CRANK.replace("[time]", between), &[("motor", [0.5, 2.1])], &[("height", 1e-9)]);
    assert!(matches!(error, MapError::NotProved { reason: ProofError::Output(0), .. }), "{error:?}");
}

#[test]
fn invalid_requests_name_the_fault_and_the_remedy() {
    let model = model(SLIDER_CRANK);
    let of = |over: &[(&str, [f64; 2])], of: &[&str], errors: Vec<(ErrorScope, f64)>| {
        let over = over.iter().map(|(name, range)| ((*name).to_owned(), *range)).collect();
        let of = of.iter().map(|name| (*name).to_owned()).collect();
        let overrides = Overrides { over, of, errors, ..Overrides::default() };
        Request::of(&model, overrides).unwrap_err().to_string()
    };
    let error = || vec![(ErrorScope::Output("pin.x".into()), 1e-6)];
    for (found, expected) in [
        (of(&[], &["pin.x"], error()), "one, two or three drivers"),
        (of(&[("moter", [0.0, 1.0])], &["pin.x"], error()), "did you mean `motor`?"),
        (of(&[("motor", [1.0, 1.0])], &["pin.x"], error()), "the range of `motor` is empty"),
        (of(&[("motor", [0.0, 1.0]), ("motor", [0.0, 1.0])], &["pin.x"], error()), "two ranges"),
        (of(&[("motor", [0.0, 1.0])], &["pin.w"], error()), "pin.x"),
        (of(&[("motor", [0.0, 1.0])], &["pin.x"], vec![]), "`pin.x` has no permitted error"),
        (of(&[("motor", [0.0, 1.0])], &["pin.y"], error()), "`pin.x` is not an output of the map"),
        (of(&[("motor", [0.0, 1.0])], &[], error()), "no measures of positions"),
        (
            of(&[("motor", [0.0, 1.0])], &["pin.x"], vec![(ErrorScope::Output("pin.x".into()), 1e-20)]),
            "round-off",
        ),
        (
            of(&[("motor", [0.0, 1.0])], &["pin.x"], [error(), error()].concat()),
            "`pin.x` has two permitted errors",
        ),
    ] {
        assert!(found.contains(expected), "{found}");
    }
}
