//! Positions as functions of the drivers: the mechanism at rest, with every driver at a value of the caller's.

use hardpoint::model::{DriverId, ElementId, Model};

use crate::calibrate::posture_model;
use crate::grid::PHASE_ENDS;

/// Output times of the model of a position, s: the design configuration, the requested position, and the same at rest.
const TIMES: [f64; 3] = [PHASE_ENDS[0], PHASE_ENDS[1], 2.0 * PHASE_ENDS[1]];

/// Returns a model whose last output time is a position at rest, reached from the design configuration.
///
/// It has a further design variable for every driver, after those of the model and in the order of the drivers: the
/// driver's coordinate, m or rad, counted from the design configuration. Derivatives by these variables are those by
/// the drivers, with the design fixed. Loads are static, and `laws` replace laws of forces by constants. There are no
/// metrics.
///
/// ```
/// # use hardpoint::{draft::Draft, law::Law, Analysis, Run, model::VariableId};
/// let draft = Draft::new("arm")
///     .hardpoint("O", [0.0; 3])
///     .hardpoint("tip", [2.0, 0.0, 0.0])
///     .bodies(["arm"])
///     .revolute("O", ["ground", "arm"], "O", [0.0, 0.0, 1.0])
///     .driver("motor", "O", Law::parse("t").unwrap())
///     .point("tip", "arm", "tip")
///     .times([0.0, 0.5]);
/// let model = hardpoint::model::Model::from_draft(&draft).unwrap();
/// let arm = hardpoint_study::position_model(&model, &[]);
/// let solution = Analysis::new(&arm).unwrap().solve(Run::new().at(&[0.3]));
/// let last = solution.motion.len() - 1;
/// assert!((solution.measured.value(last, 1)[0] - 2.0 * 0.3_f64.sin()).abs() < 1e-12);
/// assert!((solution.measured.d(last, VariableId(0), 1)[0] - 2.0 * 0.3_f64.cos()).abs() < 1e-12);
/// assert_eq!(solution.measured.value(last, 1)[1], 0.0);
/// ```
pub fn position_model(model: &Model, laws: &[(ElementId, f64)]) -> Model {
    let drivers: Vec<DriverId> = (0..model.drivers.len()).map(DriverId).collect();
    let nominal: Vec<f64> = drivers.iter().map(|d| model.as_drawn(*d)).collect();
    let plain = Model { metrics: Vec::new(), ..model.clone() };
    let mut position = posture_model(&plain, &nominal, laws, &drivers);
    let own = model.variables.len();
    for (k, driver) in model.drivers.iter().enumerate() {
        let is_taken = position.variables[..own].iter().any(|v| v.name == driver.name);
        let name = if is_taken { format!("driver {}", driver.name) } else { driver.name.clone() };
        let variable = &mut position.variables[own + k];
        variable.name = name;
        variable.quantity = model.driven(driver).quantity;
    }
    position.times = TIMES.to_vec();
    position
}
