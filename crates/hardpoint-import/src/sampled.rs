//! Tables of springs that approximate a function of the length.

use hardpoint::model::SpringTable;

/// Accepted deviation from the function, as a fraction of the force at the same length.
const ACCURATE: f64 = 1e-3;
/// Fraction of the range beyond a corner at which the force defines the deviation that is accepted near that corner,
/// where forces begin at zero.
const NEAR: f64 = 0.01;
/// Maximum number of points.
const MOST_POINTS: usize = 300;
/// Number of intervals at the beginning.
const COARSE: usize = 16;
/// Number of lengths within an interval at which the table is compared with the function.
const COMPARED: usize = 8;

/// Table with its largest deviation from the function.
pub struct SampledForce {
    /// Points `[length, force]`.
    pub points: Vec<[f64; 2]>,
    /// Bound of the deviation within the range: this force plus this fraction of the function.
    pub deviation: [f64; 2],
}

impl SampledForce {
    /// Explanation for the report of an import: the largest length, and its unit.
    pub fn report(&self, to: f64, unit: &str) -> String {
        let [off, part] = self.deviation;
        format!(
            "a curve through {} points; up to a length of {to:.4} {unit} it deviates by up to {off:.3} N plus {:.3} % of the force",
            self.points.len(),
            100.0 * part
        )
    }

    /// The same function with its forces times a factor.
    pub fn times(mut self, factor: f64) -> Self {
        self.deviation[0] *= factor.abs();
        self.points.iter_mut().for_each(|p| p[1] *= factor);
        self
    }
}

/// Samples a function over a range of lengths; corners, where its slope jumps, are points of the table.
///
/// # Errors
/// Returns the length at which the function has no value.
pub fn sample(
    force: impl Fn(f64) -> f64,
    [from, to]: [f64; 2],
    corners: &[f64],
) -> Result<SampledForce, f64> {
    let range = to - from;
    let inside = |x: &f64| from < *x && *x < to;
    let steps = (0..=COARSE).map(|k| from + range * k as f64 / COARSE as f64);
    let mut lengths: Vec<f64> = steps.chain(corners.iter().copied().filter(inside)).collect();
    sort(&mut lengths);
    if let Some(x) = lengths.iter().find(|x| !force(**x).is_finite()) {
        return Err(*x);
    }
    let largest = lengths.iter().map(|x| force(*x).abs()).fold(0.0, f64::max);
    let beyond = |c: &f64| force(c - NEAR * range).abs().max(force(c + NEAR * range).abs());
    let beyond = corners.iter().filter(|x| inside(x)).map(beyond).filter(|f| *f > 0.0);
    let least = ACCURATE * beyond.fold(NEAR * largest, f64::min).max(f64::MIN_POSITIVE);
    let is_accurate = |[deviation, value]: [f64; 2]| deviation <= least + ACCURATE * value.abs();
    loop {
        let deviations = deviations(&lengths, &force)?;
        let poor: Vec<f64> = deviations
            .iter()
            .zip(lengths.windows(2))
            .filter(|(of, _)| !of.iter().all(|d| is_accurate(*d)))
            .map(|(_, w)| (w[0] + w[1]) / 2.0)
            .collect();
        if poor.is_empty() || lengths.len() + poor.len() > MOST_POINTS {
            break;
        }
        lengths.extend(poor);
        sort(&mut lengths);
    }
    // Points without which the table is accurate as well
    let mut k = 1;
    while k + 1 < lengths.len() {
        let mut fewer = lengths.clone();
        let left_out = fewer.remove(k);
        if !corners.contains(&left_out)
            && deviations(&fewer, &force)?.iter().flatten().all(|d| is_accurate(*d))
        {
            lengths = fewer;
        } else {
            k += 1;
        }
    }
    let beyond = |[deviation, value]: &[f64; 2]| {
        if *deviation > least { (deviation - least) / value.abs() } else { 0.0 }
    };
    let relative = deviations(&lengths, &force)?.iter().flatten().map(beyond).fold(0.0, f64::max);
    let deviation = [least, relative];
    Ok(SampledForce { points: lengths.iter().map(|x| [*x, force(*x)]).collect(), deviation })
}

fn sort(lengths: &mut Vec<f64>) {
    lengths.sort_by(f64::total_cmp);
    lengths.dedup();
}

/// Per interval and length within it: the deviation of the table from the function, and the function.
fn deviations(lengths: &[f64], force: &impl Fn(f64) -> f64) -> Result<Vec<[[f64; 2]; COMPARED]>, f64> {
    let points: Vec<[f64; 2]> = lengths.iter().map(|x| [*x, force(*x)]).collect();
    let table = SpringTable::new(&points).map_err(|_| lengths[0])?;
    let of = |w: &[f64]| {
        let mut out = [[0.0; 2]; COMPARED];
        for (k, out) in out.iter_mut().enumerate() {
            let x = w[0] + (w[1] - w[0]) * (k + 1) as f64 / (COMPARED + 1) as f64;
            let value = force(x);
            if !value.is_finite() {
                return Err(x);
            }
            *out = [(table.force(x) - value).abs(), value];
        }
        Ok(out)
    };
    lengths.windows(2).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_stops_deviate_by_a_thousandth() {
        for exponent in [1.0, 1.5, 2.2, 3.0] {
            let force = |x: f64| 80.0 * (40.0 - x).max(0.0).powf(exponent);
            let SampledForce { points, deviation } = sample(force, [0.0, 200.0], &[40.0]).unwrap();
            let table = SpringTable::new(&points).unwrap();
            // 2 mm into the stop its force defines what is accepted nearer to the corner.
            assert!(
                deviation[0] <= ACCURATE * force(38.0) && deviation[1] <= ACCURATE,
                "{exponent}: {deviation:?}"
            );
            for k in 0..=2000 {
                let x = 0.1 * f64::from(k);
                let off = (table.force(x) - force(x)).abs();
                // Lengths between those that were compared may deviate a little more.
                let accepted = 1.5 * (deviation[0] + ACCURATE * force(x));
                assert!(off <= accepted, "{exponent}: {off} at {x}, {} points", points.len());
                assert!(x < 40.0 || table.force(x) == 0.0, "{exponent}: {x}");
            }
            assert!(points.len() < 60, "{exponent}: {}", points.len());
        }
        assert_eq!(sample(|x| 1.0 / (x - 50.0), [0.0, 200.0], &[]).err(), Some(50.0));
    }
}
