//! Loads of joints and drivers over a motion.

use hardpoint::joint::Quantity::Length;
use hardpoint::model::ElasticDirection;
use hardpoint::topology::Formulation;
use hardpoint_report::{diagnose, rigid};
use numpy::PyArrayMethods;
use pyo3::prelude::*;

use crate::array::{array, array1};
use crate::failure::{Failure, Kind};
use crate::model::Model;
use crate::watch::patiently;

/// Numbers of a joint: its point, force, moment, and force and moment in the axes of body j.
const JOINT: usize = 15;
/// Times, `[time, joint, 15]`, `[time, driver, 3]` and `[time, direction, 2]`.
type LoadArrays<'py> = [Bound<'py, PyAny>; 4];

#[pymethods]
impl Model {
    /// Loads of a design: times, `[time, joint, 15]` of the named joints, with NaN for undetermined components, and
    /// force, speed and power of the drivers, `[time, driver, 3]`, and deflection and force in each elastic direction.
    fn loads<'py>(&self, py: Python<'py>, case: usize, design: Vec<f64>) -> PyResult<LoadArrays<'py>> {
        let (file, analysis, changes) = (&self.cases[case], self.analysis(case)?, self.changes(&design)?);
        let (model, units) = (&file.model, file.units);
        if !model.has_loads() {
            let why = "the model has no masses and forces: its joints have no reactions and its drivers no forces; add `[masses]` or `[forces]`";
            return Err(Failure::Misunderstood(why.into()).into());
        }
        let found = patiently(py, None, |watch| watch.over(analysis).loads(&changes))?;
        if let Some(stop) = &found.stop {
            let diagnostic = diagnose::stop(file, stop, found.times.len(), None);
            return Err(Failure::of_model(Kind::Stopped, file, &diagnostic).into());
        }
        let (steps, named) = (found.times.len(), model.named_joints().count());
        let mut joints = Vec::with_capacity(steps * named * JOINT);
        let mut drivers = Vec::with_capacity(steps * model.drivers.len() * 3);
        let directions: Vec<_> =
            model.elastic_directions().into_iter().map(|(_, k)| ElasticDirection(k)).collect();
        let mut deflections = Vec::with_capacity(steps * directions.len() * 2);
        for k in 0..steps {
            for (direction, found) in directions.iter().zip(found.deflections_at(k)) {
                deflections.extend([units.from_si(direction.dimension(), found.displacement), found.force]);
            }
            for (_, load) in model.joints.iter().zip(found.joints_at(k)).filter(|(j, _)| !j.unnamed) {
                joints.extend(load.place.to_array().map(|x| units.from_si(Length, x)));
                let parts = [
                    (load.force, load.known[0]),
                    (load.moment, load.known[1]),
                    (load.in_body[0], load.known_in_body[0]),
                    (load.in_body[1], load.known_in_body[1]),
                ];
                for (wrench, known) in parts {
                    let numbers = wrench.to_array().into_iter().zip(known);
                    joints.extend(numbers.map(|(x, known)| if known { x } else { f64::NAN }));
                }
            }
            for (driver, load) in model.drivers.iter().zip(found.drivers_at(k)) {
                let speed = units.from_si(model.driven(driver).quantity, load.speed);
                drivers.extend([load.force, speed, load.force * load.speed]);
            }
        }
        Ok([
            array1(py, found.times).reshape([steps])?.into_any(),
            array(py, joints, [steps, named, JOINT])?,
            array(py, drivers, [steps, model.drivers.len(), 3])?,
            array(py, deflections, [steps, directions.len(), 2])?,
        ])
    }

    /// Values of all outputs of the rigid mechanism at these times, `[output, time]`: elastic joints closed, the same
    /// motion of the drivers; NaN for loads and compliances, and beyond its end. `None` without equilibrium.
    fn rigid<'py>(
        &self,
        py: Python<'py>,
        case: usize,
        design: Vec<f64>,
        times: Vec<f64>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (file, changes) = (&self.cases[case], self.changes(&design)?);
        let found = py.detach(|| rigid::solve_at(file, &changes, Formulation::Relative, &times));
        let Some(solved) = found.transpose().map_err(Failure::Misunderstood)? else { return Ok(None) };
        let (outputs, steps) = (&solved.measured.outputs, times.len());
        let mut numbers = vec![f64::NAN; outputs.len() * steps];
        for k in 0..solved.motion.len() {
            for (m, value) in rigid::values(&file.model, &solved, k).enumerate() {
                numbers[m * steps + k] = file.units.from_si(outputs[m].dimension, value);
            }
        }
        Ok(Some(array(py, numbers, [outputs.len(), steps])?))
    }
}
