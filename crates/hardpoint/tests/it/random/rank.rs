//! Counting freedoms without the library's plan: all rows of all joints over six coordinates per body.

use hardpoint::constraint::{MarkerPair, Row};
use hardpoint::model::*;
use hardpoint::space::{Mat3, Pose, Twist, Vec3};

/// A row that keeps less than this of its length beside the others depends on them: round-off is far below, and the
/// generator accepts no row that keeps less than a hundredth.
const DEPENDENT: f64 = 1e-6;

/// Rows that are independent of each other, made perpendicular to each other.
#[derive(Clone, Default)]
pub struct Basis {
    vectors: Vec<Vec<f64>>,
}

impl Basis {
    /// Number of independent rows.
    pub fn rank(&self) -> usize {
        self.vectors.len()
    }

    /// Adds a row; returns the part of its length that is perpendicular to those before. A dependent row is not added.
    pub fn add(&mut self, mut row: Vec<f64>) -> f64 {
        let norm = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
        let before = norm(&row);
        // Twice is enough for round-off.
        for _ in 0..2 {
            for v in &self.vectors {
                let dot: f64 = v.iter().zip(&row).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(v).for_each(|(x, v)| *x -= dot * v);
            }
        }
        let left = norm(&row);
        let part = if before > 0.0 { left / before } else { 0.0 };
        if part > DEPENDENT {
            row.iter_mut().for_each(|x| *x /= left);
            self.vectors.push(row);
        }
        part
    }

    /// Adds rows if each keeps at least this part beside the others, else nothing.
    pub fn add_all(&mut self, rows: Vec<Vec<f64>>, least: f64) -> bool {
        let mut longer = self.clone();
        let fits = rows.into_iter().all(|row| longer.add(row) >= least);
        if fits {
            *self = longer;
        }
        fits
    }
}

/// The constraints of a joint in the design configuration, lengths in sizes; a screw's coupler is one of them.
pub fn joint_rows(model: &Model, k: usize, size: f64) -> Vec<Vec<f64>> {
    let mut rows: Vec<Vec<f64>> =
        model.joints[k].kind.rows.iter().map(|&row| row_of(model, k, row, size)).collect();
    if model.joints[k].kind.name == "screw" {
        let own =
            model.couplers.iter().rposition(|c| c.name == model.joints[k].name).expect("a screw's coupler");
        rows.push(coupler_row(model, own, size));
    }
    rows
}

/// The constraint that a driver adds.
pub fn driver_row(model: &Model, d: usize, size: f64) -> Vec<f64> {
    let driver = &model.drivers[d];
    row_of(model, driver.joint.0, model.driven(driver).row, size)
}

/// The constraint that a coupler adds.
pub fn coupler_row(model: &Model, c: usize, size: f64) -> Vec<f64> {
    let mut sum = vec![0.0; 6 * (model.bodies.len() - 1)];
    for term in &model.couplers[c].terms {
        let row = model.coupled(term).row;
        let unit = if row.is_length() { size } else { 1.0 };
        let part = row_of(model, term.joint.0, row, size);
        sum.iter_mut().zip(part).for_each(|(s, x)| *s += unit * term.coefficient * x);
    }
    sum
}

/// Number of freedoms the joints and couplers leave, by their rows alone.
pub fn mobility(model: &Model) -> usize {
    let size = model.size();
    let mut basis = Basis::default();
    for k in 0..model.joints.len() {
        for row in model.joints[k].kind.rows {
            basis.add(row_of(model, k, *row, size));
        }
    }
    for c in 0..model.couplers.len() {
        basis.add(coupler_row(model, c, size));
    }
    6 * (model.bodies.len() - 1) - basis.rank()
}

fn row_of(model: &Model, k: usize, row: Row, size: f64) -> Vec<f64> {
    let joint = &model.joints[k];
    let marker = |e: usize| Pose { rot: joint.frames[e], r: model.hardpoints[joint.at[e].0].position };
    let mut ends = MarkerPair { i: marker(0), j: marker(1), axes: Mat3::IDENTITY };
    if let Some(curve) = &joint.curve {
        let [c, d, ..] = curve.at(curve.start());
        let x = Vec3::new(d[0], d[1], 0.0).unit().expect("a curve with a direction");
        let z = Vec3::new(0.0, 0.0, 1.0);
        let walking = Pose { rot: Mat3 { cols: [x, z.cross(x), z] }, r: Vec3::new(c[0], c[1], 0.0) };
        ends.i = ends.i.compose(walking);
    }
    let wrench = row.wrench(&ends);
    let scale = if row.is_length() { 1.0 / size } else { 1.0 };
    let mut out = vec![0.0; 6 * (model.bodies.len() - 1)];
    for (body, side) in joint.bodies.iter().zip([-scale, scale]) {
        if *body == GROUND {
            continue;
        }
        for (axis, e) in Vec3::AXES.into_iter().enumerate() {
            out[6 * (body.0 - 1) + axis] = side * wrench.on(Twist::turn(e, Vec3::ZERO));
            out[6 * (body.0 - 1) + 3 + axis] = side * size * wrench.on(Twist::slide(e));
        }
    }
    out
}
