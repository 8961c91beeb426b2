//! First-order motion of bodies by the design variables, stored for runs with too many sensitivities to store
//! completely.
//!
//! The page draws a changed design from these six numbers per body and variable, as `f32`. Rates and accelerations
//! would triple their number and are omitted.

use hardpoint::Solution;
use hardpoint::model::{BodyId, VariableId};

/// Minimum number of output times for an animated changed design, unless the run has fewer.
const ENOUGH_ROWS: usize = 100;
/// Numbers per body and variable: translation and rotation vector.
const NUMBERS: usize = 6;

/// Translations and rotations of all bodies by all variables, to first order, at evenly spaced output times.
#[derive(Clone, Debug)]
pub(crate) struct Shifts {
    /// Memory limit in bytes.
    most: usize,
    /// Interval of the stored output times.
    stride: usize,
    bodies: usize,
    /// `places[b * bodies + i]`: offset of the numbers of body i by variable b in a row; `None` if b does not move it.
    places: Vec<Option<usize>>,
    width: usize,
    /// Stored rows with the indices of their output times.
    rows: Vec<(usize, Box<[f32]>)>,
}

impl Shifts {
    /// Empty collection with a memory limit in bytes.
    pub fn new(most: usize) -> Self {
        Self { most, stride: 1, bodies: 0, places: Vec::new(), width: 0, rows: Vec::new() }
    }

    /// Adds a window that begins with output time `first`; `stride` is that of the other stored results so far.
    pub fn add(&mut self, first: usize, window: &Solution, stride: usize) {
        let sensitivities = &window.sensitivities;
        if self.places.is_empty() {
            self.bodies = sensitivities.bodies;
            for b in 0..sensitivities.variables {
                for i in 0..self.bodies {
                    let moves = sensitivities.moves(VariableId(b), BodyId(i));
                    self.places.push(moves.then_some(self.width));
                    self.width += if moves { NUMBERS } else { 0 };
                }
            }
        }
        self.thin(usize::max(stride, self.stride));
        let most = self.most / (self.width * size_of::<f32>()).max(1);
        for k in 0..window.motion.len() {
            if (first + k).is_multiple_of(self.stride) {
                self.rows.push((first + k, self.row(window, k)));
                if self.rows.len() > most.max(1) {
                    self.thin(2 * self.stride);
                }
            }
        }
    }

    fn row(&self, window: &Solution, k: usize) -> Box<[f32]> {
        let mut row = vec![f32::NAN; self.width].into_boxed_slice();
        for (place, at) in self.places.iter().enumerate().filter_map(|(place, at)| Some((place, (*at)?))) {
            let Some(of) = window.sensitivities.at(k, place / self.bodies) else { continue };
            let shift = of.body(place % self.bodies);
            let numbers = [shift.dr, shift.dpi].map(|v| v.to_array().map(|x| x as f32));
            row[at..at + NUMBERS].copy_from_slice(numbers.as_flattened());
        }
        row
    }

    fn thin(&mut self, stride: usize) {
        self.stride = stride;
        self.rows.retain(|(time, _)| time.is_multiple_of(stride));
    }

    /// Stride of the stored output times; `None` if they are too few of the solved ones for an animation.
    pub fn stride(&self, solved: usize) -> Option<usize> {
        (self.bodies > 0 && self.rows.len() >= solved.min(ENOUGH_ROWS)).then_some(self.stride)
    }

    /// Translation and rotation vector of body i by variable b at a stored output time, SI.
    pub fn at(&self, time: usize, b: usize, i: usize) -> [f64; NUMBERS] {
        let Some(at) = self.places[b * self.bodies + i] else { return [0.0; NUMBERS] };
        let (_, row) = &self.rows[time / self.stride];
        std::array::from_fn(|k| f64::from(row[at + k]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use hardpoint::{Analysis, Run};

    /// Mechanism with variables that move some of its bodies, and one that it cannot follow.
    const MODEL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/slider_crank.toml");

    #[test]
    fn shifts_of_windows_are_those_of_the_whole_run_and_take_the_memory_they_may() {
        let mut file = hardpoint_file::read(MODEL.as_ref()).unwrap();
        file.model.times.truncate(203);
        let analysis = Analysis::new(&file.model).unwrap();
        let whole = analysis.run();
        let row = {
            let mut one = Shifts::new(usize::MAX);
            one.add(0, &whole, 1);
            assert_eq!((one.stride(203), one.rows.len()), (Some(1), 203));
            one.width * size_of::<f32>()
        };
        for (rows, beside, stride) in
            [(1000, 1, 1), (203, 1, 1), (202, 1, 2), (110, 1, 2), (1000, 2, 2), (52, 2, 4)]
        {
            let mut shifts = Shifts::new(rows * row);
            analysis.solve_in_windows(Run::new(), 1, |first, window| {
                // The other stored results are thinned during the run.
                shifts.add(first, window, if first < 100 { 1 } else { beside });
            });
            assert!(shifts.rows.len() <= rows);
            assert_eq!(shifts.stride(203), (203_usize.div_ceil(stride) >= ENOUGH_ROWS).then_some(stride));
            assert_eq!(shifts.stride, stride);
            for k in (0..203).step_by(stride) {
                for b in 0..whole.sensitivities.variables {
                    let Some(of) = whole.sensitivities.at(k, b) else { continue };
                    for i in 0..file.model.bodies.len() {
                        let [dr, dpi] = [of.body(i).dr, of.body(i).dpi].map(|v| v.to_array());
                        let exact: Vec<f64> =
                            [dr, dpi].as_flattened().iter().map(|x| f64::from(*x as f32)).collect();
                        assert_eq!(exact, shifts.at(k, b, i), "{k} {b} {i}");
                    }
                }
            }
        }
    }
}
