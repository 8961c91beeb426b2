//! Linear range of sensitivities, from the second derivatives along each variable.

use hardpoint::model::VariableId;
use hardpoint::run::{Analysis, Solution};

use hardpoint_difference::Magnitude;

/// Largest ratio of the second-order to the first-order part at which a linear prediction is trusted.
const LINEAR: f64 = 0.05;
/// A second-order part over a natural step below this fraction of the first-order part is round-off: the output is
/// linear in the variable. Second derivatives are accurate to about 1e-13 of the terms that cancel in them, and these
/// may be a thousand times larger than the first-order part. Real curvature of a mechanism is far larger.
const ROUND_OFF: f64 = 1e-10;
/// A variable that moves an output by less than this fraction of the most influential one is not considered: relative
/// to a negligible effect, any curvature is large.
const SLIGHT: f64 = 1e-2;
/// Maximum size of the second derivatives in memory at once, in bytes; the work can be ended between such parts.
const MOST_BYTES: usize = 8 << 20;

/// Linear range of the sensitivities by one design variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Validity {
    /// Per output, the change of the variable, m, rad or plain, at which the largest second-order part over the motion
    /// is 5 % of the largest first-order part; infinite if the output is exactly linear, `None` if it has no
    /// significant sensitivity or no second derivative
    /// ([`KnownOrders::by_position`](hardpoint::model::KnownOrders::by_position)).
    pub linear_up_to: Vec<Option<f64>>,
}

/// Factor by which a change can be scaled until its second-order part is 5 % of its first-order part; infinite if it is
/// exactly linear. Both parts are those of a natural step.
pub(super) fn linear_up_to(first: f64, second: f64) -> f64 {
    // y(b + s) = y + y_b s + y_bb s^2 / 2: abs(y_bb s^2 / 2) = 0.05 abs(y_b s) at s = 0.05 abs(y_b) / abs(y_bb / 2)
    // (34)
    if second <= ROUND_OFF * first { f64::INFINITY } else { LINEAR * first / second }
}

/// Linear ranges of the sensitivities of a solution of the nominal design, variable by variable, without variables that
/// the mechanism cannot follow. `more` is called before every part of the work; if it returns false, the study ends.
pub fn validity(
    analysis: &Analysis<'_>,
    solution: &Solution,
    mut more: impl FnMut(usize) -> bool,
) -> Vec<Validity> {
    let (model, measured) = (analysis.model(), &solution.measured);
    let (variables, outputs) = (model.variables.len(), measured.outputs.len());
    let mut found = vec![Validity { linear_up_to: vec![None; outputs] }; variables];
    if solution.sensitivities.variables == 0 || solution.motion.is_empty() {
        return found;
    }
    let followed: Vec<usize> =
        (0..variables).filter(|v| solution.sensitivities.at(0, *v).is_some()).collect();
    // The largest sensitivity of each output over the motion, and how far that takes it with a natural step of the
    // variable. max over the motion of abs(y_b)
    let first = |v: usize, m: usize| measured.largest_derivative(VariableId(v), m, 0);
    let firsts: Vec<Vec<f64>> = (0..variables).map(|v| (0..outputs).map(|m| first(v, m)).collect()).collect();
    let natural: Vec<f64> = (0..variables).map(|v| model.natural_step(VariableId(v))).collect();
    let strongest = |m: usize| followed.iter().map(|&v| firsts[v][m] * natural[v]).fold(0.0, f64::max);
    let strongest: Vec<f64> = (0..outputs).map(strongest).collect();
    let magnitude = Magnitude::of_motion(model, &solution.motion);
    let per_variable = solution.motion.len() * (8 * outputs + 48 * model.bodies.len());
    for (part, group) in followed.chunks((MOST_BYTES / per_variable).max(1)).enumerate() {
        if !more(part) {
            break;
        }
        let directions: Vec<Vec<f64>> = group.iter().map(|v| model.alone(VariableId(*v), 1.0)).collect();
        let pairs: Vec<[usize; 2]> = (0..group.len()).map(|p| [p, p]).collect();
        let second = analysis.second(&[], &directions, &pairs);
        let steps = usize::min(second.times.len(), measured.len());
        for (p, &v) in group.iter().enumerate() {
            for (m, output) in measured.outputs.iter().enumerate().filter(|(_, o)| o.known.by_position) {
                // max over the motion of abs(y_bb) / 2
                let bend = 0.5 * (0..steps).map(|k| second.value(k, p, m).abs()).fold(0.0, f64::max);
                let first = firsts[v][m] * natural[v];
                if first > f64::max(magnitude.round_off(output.dimension, 0), SLIGHT * strongest[m]) {
                    found[v].linear_up_to[m] =
                        Some(natural[v] * linear_up_to(first, bend * natural[v].powi(2)));
                }
            }
        }
    }
    found
}
