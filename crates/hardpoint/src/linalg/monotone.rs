//! Shape-preserving cubic interpolation: curves that rise and fall only where their points do.

use crate::number::{Real, both};

/// Coefficients of a cubic, of 1, s, s^2 and s^3.
pub(crate) type Cubic<T> = [T; 4];

/// Piece between two points of a curve with a continuous slope and without overshoot: between two points the curve
/// stays between their values. Point k of the curve, with at least two points, is at `x[k]`, increasing, and has the
/// value `y(k)`. The piece is a polynomial in the distance from its first point.
///
/// The slope at a point is the weighted harmonic mean of the slopes of the adjacent chords, and zero if these have
/// opposite signs (F. N. Fritsch and J. Butland 1984). At the ends it is that of the parabola through three points,
/// limited to keep the curve monotone. So the curve is a smooth function of the values except where two adjacent ones
/// are equal, or where a slope at an end is at its limit.
pub(crate) fn monotone<T: Real>(x: &[f64], y: impl Fn(usize) -> T, piece: usize) -> Cubic<T> {
    let last = x.len() - 1;
    // Width and slope.
    let chord = |k: usize| {
        let width = x[k + 1] - x[k];
        (width, (y(k + 1) - y(k)) / T::constant(width))
    };
    let slope = |k: usize| match (k, last) {
        (_, 1) => chord(0).1,
        (0, _) => at_end(chord(0), chord(1)),
        (k, last) if k == last => at_end(chord(last - 1), chord(last - 2)),
        (k, _) => between(chord(k - 1), chord(k)),
    };
    let (h, d) = chord(piece);
    let [from, to] = both([piece, piece + 1], slope);
    [y(piece), from, (d * 3.0 - from * 2.0 - to) * (1.0 / h), (from + to - d * 2.0) * (1.0 / (h * h))]
}

/// Slope at the point between two chords.
fn between<T: Real>((h, d): (f64, T), (g, e): (f64, T)) -> T {
    if d.value() * e.value() <= 0.0 {
        return T::zero();
    }
    // (w1 + w2) / (w1/d + w2/e),    w1 = 2 g + h,  w2 = g + 2 h
    let (w1, w2) = (2.0 * g + h, g + 2.0 * h);
    T::constant(w1 + w2) / (T::constant(w1) / d + T::constant(w2) / e)
}

/// Slope at the outer end of a chord, given the next chord inwards.
fn at_end<T: Real>((h, d): (f64, T), (g, e): (f64, T)) -> T {
    // ((2 h + g) d - h e) / (h + g), limited to the sign of the chord and to three times its slope
    let slope = (d * (2.0 * h + g) - e * h) / T::constant(h + g);
    if slope.value() * d.value() <= 0.0 {
        T::zero()
    } else if d.value() * e.value() < 0.0 && slope.value().abs() > 3.0 * d.value().abs() {
        d * 3.0
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Dual;

    /// Accuracy of an evaluated cubic with values of about 1.
    const EXACT: f64 = 1e-14;

    fn pieces(points: &[[f64; 2]]) -> Vec<Cubic<f64>> {
        let x: Vec<f64> = points.iter().map(|p| p[0]).collect();
        (1..points.len()).map(|k| monotone(&x, |k| points[k][1], k - 1)).collect()
    }

    fn at(points: &[[f64; 2]], segments: &[Cubic<f64>], x: f64) -> [f64; 2] {
        let k = (1..segments.len()).rev().find(|k| points[*k][0] <= x).unwrap_or(0);
        let (s, c) = (x - points[k][0], segments[k]);
        [c[0] + s * (c[1] + s * (c[2] + s * c[3])), c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])]
    }

    #[test]
    fn it_passes_its_points_with_one_slope_and_never_overshoots() {
        let points = [[-1.0, 0.0], [0.0, 0.0], [0.1, 0.3], [0.5, 0.35], [0.6, 2.0], [1.0, 1.5]];
        let segments = pieces(&points);
        for (k, pair) in points.windows(2).enumerate() {
            let [low, high] = [pair[0][1].min(pair[1][1]), pair[0][1].max(pair[1][1])];
            for n in 0..=50 {
                let x = pair[0][0] + (pair[1][0] - pair[0][0]) * f64::from(n) / 50.0;
                let c = segments[k];
                let s = x - pair[0][0];
                let y = c[0] + s * (c[1] + s * (c[2] + s * c[3]));
                assert!(y >= low - EXACT && y <= high + EXACT, "{x} {y}");
            }
        }
        for p in &points[1..points.len() - 1] {
            // From both sides.
            let [below, above] = [-1e-9, 1e-9].map(|h| at(&points, &segments, p[0] + h));
            assert!((below[0] - p[1]).abs() < 1e-7 && (above[0] - p[1]).abs() < 1e-7);
            assert!((below[1] - above[1]).abs() < 1e-5, "{below:?} {above:?}");
        }
        // Flat before zero, so the slope is zero there; it rises immediately after.
        assert_eq!(at(&points, &segments, 0.0)[1], 0.0);
        assert!(at(&points, &segments, 0.05)[0] > 0.0);
    }

    #[test]
    fn points_on_a_line_make_the_line() {
        let points = [0.0, 0.2, 0.7, 1.0].map(|x| [x, 2.0 - 3.0 * x]);
        let segments = pieces(&points);
        for x in [0.0, 0.1, 0.2, 0.5, 0.9, 1.0] {
            let [y, slope] = at(&points, &segments, x);
            assert!((y - (2.0 - 3.0 * x)).abs() < EXACT && (slope + 3.0).abs() < 3.0 * EXACT);
        }
        assert_eq!(pieces(&points[..2]).len(), 1);
    }

    #[test]
    fn derivatives_by_values_are_differences() {
        type Second = Dual<Dual<f64>>;
        let x = [-1.0, -0.4, 0.1, 0.5, 0.6, 1.0];
        // With a peak, both limits of an end, and chords of both signs.
        let all = [
            [0.2, 0.5, 0.6, 2.0, 2.4, 3.5],
            [0.0, 3.0, 0.5, 0.7, 2.0, 1.4],
            [-3.0, -1.0, 0.4, 0.5, -2.0, 0.1],
        ];
        for y in all {
            for piece in 0..x.len() - 1 {
                for j in 0..y.len() {
                    let moved = |h: f64| monotone(&x, |k| if k == j { y[k] + h } else { y[k] }, piece);
                    let exact = monotone(
                        &x,
                        |k| {
                            let rate = if k == j { 1.0 } else { 0.0 };
                            Second { v: Dual { v: y[k], d: rate }, d: Dual { v: rate, d: 0.0 } }
                        },
                        piece,
                    );
                    let h = 1e-4;
                    let (below, here, above) = (moved(-h), moved(0.0), moved(h));
                    for c in 0..4 {
                        assert_eq!(exact[c].v.v, here[c]);
                        let first = (above[c] - below[c]) / (2.0 * h);
                        let second = (above[c] - 2.0 * here[c] + below[c]) / (h * h);
                        let scale = 1.0 + here[c].abs() + first.abs();
                        assert!((exact[c].d.v - first).abs() < 1e-5 * scale, "{y:?} {piece} {j} {c}");
                        assert!(
                            (exact[c].d.d - second).abs() < 1e-3 * (scale + second.abs()),
                            "{y:?} {piece} {j} {c}"
                        );
                    }
                }
            }
        }
    }
}
