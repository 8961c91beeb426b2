//! Shape-preserving cubic interpolation: curves that rise and fall only where their points do.

use super::Segment;
use super::spline::hermite;

/// Piecewise cubic through these points (at least two, x increasing), with a continuous slope and without overshoot:
/// between two points the curve stays between their values. Segments are polynomials in the distance from their first
/// point.
///
/// The slope at a point is the weighted harmonic mean of the slopes of the adjacent chords, and zero if these have
/// opposite signs (F. N. Fritsch and J. Butland 1984). At the ends it is that of the parabola through three points,
/// limited to keep the curve monotone.
pub(crate) fn monotone(points: &[[f64; 2]]) -> Vec<Segment> {
    let chords: Vec<[f64; 2]> = points.windows(2).map(|p| [p[1][0] - p[0][0], p[1][1] - p[0][1]]).collect();
    let last = chords.len();
    let slope = |k: usize| match (k, last) {
        (_, 1) => chords[0][1] / chords[0][0],
        (0, _) => at_end(chords[0], chords[1]),
        (k, last) if k == last => at_end(chords[last - 1], chords[last - 2]),
        (k, _) => between(chords[k - 1], chords[k]),
    };
    let slopes: Vec<f64> = (0..points.len()).map(slope).collect();
    let at = |k: usize, order: usize| if order == 0 { points[k][1] } else { slopes[k] };
    (0..last).map(|k| hermite(chords[k][0], 1, |end, order| at(k + end, order))).collect()
}

/// Slope at the point between two chords.
fn between([h, rise]: [f64; 2], [g, next]: [f64; 2]) -> f64 {
    let (d, e) = (rise / h, next / g);
    if d * e <= 0.0 {
        return 0.0;
    }
    // (w1 + w2) / (w1/d + w2/e),    w1 = 2 g + h,  w2 = g + 2 h
    let (w1, w2) = (2.0 * g + h, g + 2.0 * h);
    (w1 + w2) / (w1 / d + w2 / e)
}

/// Slope at the outer end of a chord, given the next chord inwards.
fn at_end([h, rise]: [f64; 2], [g, next]: [f64; 2]) -> f64 {
    let (d, e) = (rise / h, next / g);
    // ((2 h + g) d - h e) / (h + g), limited to the sign of the chord and to three times its slope
    let slope = ((2.0 * h + g) * d - h * e) / (h + g);
    if slope * d <= 0.0 {
        0.0
    } else if d * e < 0.0 && slope.abs() > 3.0 * d.abs() {
        3.0 * d
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Accuracy of an evaluated cubic with values of about 1.
    const EXACT: f64 = 1e-14;

    fn at(points: &[[f64; 2]], segments: &[Segment], x: f64) -> [f64; 2] {
        let k = (1..segments.len()).rev().find(|k| points[*k][0] <= x).unwrap_or(0);
        let (s, c) = (x - points[k][0], segments[k]);
        [c[0] + s * (c[1] + s * (c[2] + s * c[3])), c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])]
    }

    #[test]
    fn it_passes_its_points_with_one_slope_and_never_overshoots() {
        let points = [[-1.0, 0.0], [0.0, 0.0], [0.1, 0.3], [0.5, 0.35], [0.6, 2.0], [1.0, 1.5]];
        let segments = monotone(&points);
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
        let segments = monotone(&points);
        for x in [0.0, 0.1, 0.2, 0.5, 0.9, 1.0] {
            let [y, slope] = at(&points, &segments, x);
            assert!((y - (2.0 - 3.0 * x)).abs() < EXACT && (slope + 3.0).abs() < 3.0 * EXACT);
        }
        assert_eq!(monotone(&points[..2]).len(), 1);
    }
}
