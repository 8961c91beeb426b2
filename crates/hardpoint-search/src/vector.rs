//! Vectors as slices.

/// Dot product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

/// Length.
pub fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

/// Rows with less than this part independent of those before them are dependent.
const DEPENDENT: f64 = 1e-9;

/// For each of some rows: true if it is independent of those before it, by orthogonalisation.
pub fn independent(rows: Vec<Vec<f64>>) -> Vec<bool> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let is_new = |mut row: Vec<f64>| {
        let length = norm(&row);
        // Once more against round-off of the first pass.
        for _ in 0..2 {
            for unit in &basis {
                let along = dot(unit, &row);
                row.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
            }
        }
        let rest = norm(&row);
        let is_new = rest > DEPENDENT * length;
        if is_new {
            basis.push(row.iter().map(|x| x / rest).collect());
        }
        is_new
    };
    rows.into_iter().map(is_new).collect()
}
