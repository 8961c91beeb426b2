//! Curves of results over output times, in the user's units, as the `f32` of the page.

use hardpoint::Solution;
use hardpoint::model::VariableId;
use hardpoint::sensitivity::BodySensitivity;
use hardpoint::space::Vec3;

/// Returns a number, or 0 if it is round-off.
pub fn settled(x: f64, round_off: f64) -> f64 {
    if x.abs() <= round_off { 0.0 } else { x }
}

/// Conversion of numbers from SI to the user's unit, without round-off.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Number of the user's units per SI unit.
    pub per_si: f64,
    /// Threshold below which a number is round-off and becomes 0, SI.
    pub round_off: f64,
}

impl Scale {
    /// Converts a number.
    pub fn shown(self, x: f64) -> f64 {
        settled(x, self.round_off) * self.per_si
    }
}

/// Derivatives of a body's origin by their order of time derivative.
pub const ORIGIN: [fn(&BodySensitivity) -> Vec3; 3] = [|s| s.dr, |s| s.dv, |s| s.da];

/// Derivative of output m, or of its time derivative of an order, by a variable.
pub fn of_output(
    solution: &Solution,
    steps: &[usize],
    (b, m, order): (VariableId, usize, usize),
    scale: Scale,
) -> Vec<f32> {
    let derivative = |&k: &usize| scale.shown(solution.measured.derivative(k, b, m, order)) as f32;
    steps.iter().map(derivative).collect()
}

/// Derivatives of x, y and z of a body's origin, or of their time derivatives of an order, by a variable; NaN if the
/// mechanism cannot follow the variable.
pub fn of_origin(
    solution: &Solution,
    steps: &[usize],
    (b, body, order): (VariableId, usize, usize),
    scale: Scale,
) -> [Vec<f32>; 3] {
    let mut curves = [(); 3].map(|()| Vec::with_capacity(steps.len()));
    for &k in steps {
        let of = solution.sensitivities.at(k, b.0).map(|s| ORIGIN[order](&s.body(body)).to_array());
        for (curve, x) in curves.iter_mut().zip(of.unwrap_or([f64::NAN; 3])) {
            curve.push(scale.shown(x) as f32);
        }
    }
    curves
}

/// Translation and rotation vector of a body per unit of a variable, at each step, SI; zeros if the mechanism cannot
/// follow the variable.
pub fn shifts(solution: &Solution, steps: &[usize], b: VariableId, body: usize) -> Vec<[f64; 6]> {
    let shift = |&k: &usize| {
        let of = solution.sensitivities.at(k, b.0).map_or(BodySensitivity::ZERO, |s| s.body(body));
        let [[x, y, z], [rx, ry, rz]] = [of.dr, of.dpi].map(Vec3::to_array);
        [x, y, z, rx, ry, rz]
    };
    steps.iter().map(shift).collect()
}

/// Shifts as one curve of six numbers per step.
pub fn of_shifts(shifts: &[[f64; 6]], [place, turn]: [Scale; 2]) -> Vec<f32> {
    let shown = |&[x, y, z, rx, ry, rz]: &[f64; 6]| {
        let [place, turn] = [[x, y, z].map(|x| place.shown(x)), [rx, ry, rz].map(|x| turn.shown(x))];
        place.into_iter().chain(turn).map(|x| x as f32)
    };
    shifts.iter().flat_map(shown).collect()
}
