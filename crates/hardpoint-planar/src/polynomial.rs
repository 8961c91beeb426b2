//! Real roots of polynomials of low degree.

/// A value at an extreme point below this fraction of the sum of its terms is a double root.
const TOUCHES: f64 = 1e-12;
/// Bisections of one interval: all digits of a double.
const BISECTIONS: usize = 200;

/// All real roots of a polynomial by its coefficients from the constant, in increasing order; double roots once. They
/// lie between the roots of its derivative, which are found alike.
pub fn real_roots(coefficients: &[f64]) -> Vec<f64> {
    let largest = coefficients.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
    let significant = |c: &f64| c.abs() > f64::EPSILON * largest;
    let Some(degree) = coefficients.iter().rposition(significant).filter(|d| *d > 0) else {
        return Vec::new();
    };
    let p = &coefficients[..=degree];
    let at = |x: f64| p.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let terms = |x: f64| p.iter().rev().fold(0.0, |sum, c| sum * x.abs() + c.abs());
    if degree == 1 {
        return vec![-p[0] / p[1]];
    }
    // Cauchy's bound of all roots
    let bound = 1.0 + p[..degree].iter().fold(0.0_f64, |m, c| m.max((c / p[degree]).abs()));
    let derivative: Vec<f64> = (1..=degree).map(|k| p[k] * k as f64).collect();
    let extremes = real_roots(&derivative).into_iter().filter(|x| x.abs() < bound);
    let ends: Vec<f64> = std::iter::once(-bound).chain(extremes).chain([bound]).collect();
    let touches: Vec<bool> =
        ends.iter().map(|x| x.abs() < bound && at(*x).abs() <= TOUCHES * terms(*x)).collect();
    let mut roots: Vec<f64> = Vec::new();
    for k in 1..ends.len() {
        let [a, b] = [ends[k - 1], ends[k]];
        if touches[k - 1] {
            roots.push(a);
        } else if !touches[k] && at(a).signum() != at(b).signum() {
            roots.push(bisected(&at, a, b));
        }
    }
    roots
}

fn bisected(at: &impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let sign = at(a).signum();
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            break;
        }
        if at(middle).signum() == sign { a = middle } else { b = middle }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::real_roots;

    fn product(roots: &[f64], others: &[[f64; 2]]) -> Vec<f64> {
        let factors =
            roots.iter().map(|r| vec![-r, 1.0]).chain(others.iter().map(|[b, c]| vec![*c, *b, 1.0]));
        factors.fold(vec![1.0], |p, factor| {
            let mut out = vec![0.0; p.len() + factor.len() - 1];
            for (i, a) in p.iter().enumerate() {
                factor.iter().enumerate().for_each(|(j, b)| out[i + j] += a * b);
            }
            out
        })
    }

    #[test]
    fn real_roots_are_those_of_the_factors() {
        let check = |roots: &[f64], others: &[[f64; 2]], expected: &[f64]| {
            let found = real_roots(&product(roots, others));
            assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
            // Half of the digits of a double root are lost.
            found
                .iter()
                .zip(expected)
                .for_each(|(a, b)| assert!((a - b).abs() < 1e-7, "{found:?} {expected:?}"));
        };
        check(&[-3.0, 0.5, 1.0, 40.0], &[], &[-3.0, 0.5, 1.0, 40.0]);
        check(&[0.25, -2.0], &[[1.0, 5.0]], &[-2.0, 0.25]);
        check(&[], &[[0.1, 2.0], [-1.0, 3.0]], &[]);
        check(&[1.5, 1.5, 4.0], &[], &[1.5, 4.0]);
        check(&[7.0], &[], &[7.0]);
        assert!(real_roots(&[3.0]).is_empty() && real_roots(&[0.0; 5]).is_empty());
        // A leading coefficient that round-off has left
        assert_eq!(real_roots(&[-2.0, 1.0, 1e-18]), [2.0]);
    }
}
