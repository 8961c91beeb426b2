//! Random deviations, and the moments of their distributions. A deviation of `m` coordinates of one point scatters
//! alike in all directions, in a disc or a sphere (`docs/theory.md`, section on tolerances).

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal, StandardUniform};

use hardpoint::model::Scatter;

/// A truncated normal with fewer standard deviations than this is drawn by rejection from its support, otherwise from
/// the normal: at least a third of the trials are accepted in either case.
const NARROW: f64 = 1.5;
/// Terms of the series for even narrower truncation: each is less than `k^2 / 2 / j` of the one before.
const TERMS: i32 = 60;

/// Moments of one coordinate of a deviation with zero mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Standard deviation, in the unit of the reach.
    pub sigma: f64,
    /// Kurtosis: the mean fourth power divided by the squared mean square; 3 for a normal distribution.
    pub kurtosis: f64,
}

/// Moments of each of `m` coordinates that scatter alike within a reach.
///
/// ```text
/// s^2 = E[r^2] / m,    kurtosis = 3 m E[r^4] / ((m + 2) E[r^2]^2)
/// uniform: E[r^2] = t^2 m / (m + 2),  E[r^4] = t^4 m / (m + 4);    truncated: E[r^p] = I(m-1+p) / I(m-1),  I(n) = int_0^k r^n exp(-r^2/2) dr
/// ```
pub fn moments(scatter: Scatter, m: usize, reach: f64) -> Moments {
    let n = m as f64;
    let of_radius = |second: f64, fourth: f64, unit: f64| Moments {
        sigma: unit * (second / n).sqrt(),
        kurtosis: 3.0 * n * fourth / ((n + 2.0) * second * second),
    };
    match scatter {
        Scatter::Normal { sigmas } => Moments { sigma: reach / sigmas, kurtosis: 3.0 },
        Scatter::Uniform => of_radius(n / (n + 2.0), n / (n + 4.0), reach),
        Scatter::Truncated { sigmas } => {
            let [zeroth, second, fourth] = [0, 2, 4].map(|p| radial(m - 1 + p, sigmas));
            of_radius(second / zeroth, fourth / zeroth, reach / sigmas)
        }
    }
}

/// `int_0^k r^n exp(-r^2/2) dr`, as the series `exp(-k^2/2) k^(n+1) (1/(n+1) + k^2/((n+1)(n+3)) + ...)`, whose terms
/// are all positive; for a large `k` by parts from the first two.
fn radial(n: usize, k: f64) -> f64 {
    let end = (-0.5 * k * k).exp();
    if k < 5.0 {
        let mut term = end * k.powi(n as i32 + 1) / (n + 1) as f64;
        let mut sum = 0.0;
        for j in 1..=TERMS {
            sum += term;
            term *= k * k / (n as f64 + 1.0 + 2.0 * f64::from(j));
        }
        return sum;
    }
    // I(n) = (n - 1) I(n-2) - k^(n-1) exp(-k^2/2)
    match n {
        0 => (0.5 * std::f64::consts::PI).sqrt() * libm::erf(k / std::f64::consts::SQRT_2),
        1 => 1.0 - end,
        _ => (n - 1) as f64 * radial(n - 2, k) - k.powi(n as i32 - 1) * end,
    }
}

/// Random stream of the design with a number. Each number has its own stream, so that a design depends neither on the
/// designs drawn before it nor on the thread.
pub fn design_stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    stream.set_stream(number);
    stream
}

/// Draws a deviation into `to`, one coordinate per entry.
pub fn draw(scatter: Scatter, reach: f64, stream: &mut ChaCha8Rng, to: &mut [f64]) {
    let m = to.len();
    let normal = |to: &mut [f64], stream: &mut ChaCha8Rng| {
        to.iter_mut().for_each(|x| *x = StandardNormal.sample(stream));
    };
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let even = |stream: &mut ChaCha8Rng| -> f64 { StandardUniform.sample(stream) };
    // Uniform in the unit sphere: any direction, and a radius whose m-th power is uniform.
    let in_sphere = |to: &mut [f64], stream: &mut ChaCha8Rng| {
        normal(to, stream);
        let by = even(stream).powf(1.0 / m as f64) / norm(to);
        to.iter_mut().for_each(|x| *x *= by);
    };
    let scale = match scatter {
        Scatter::Uniform => {
            in_sphere(to, stream);
            reach
        }
        Scatter::Normal { sigmas } => {
            normal(to, stream);
            reach / sigmas
        }
        Scatter::Truncated { sigmas } if sigmas < NARROW => loop {
            in_sphere(to, stream);
            let r = sigmas * norm(to);
            if even(stream) < (-0.5 * r * r).exp() {
                break reach;
            }
        },
        Scatter::Truncated { sigmas } => loop {
            normal(to, stream);
            if norm(to) <= sigmas {
                break reach / sigmas;
            }
        },
    };
    to.iter_mut().for_each(|x| *x *= scale);
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Scatter; 5] = [
        Scatter::Uniform,
        Scatter::Normal { sigmas: 3.0 },
        Scatter::Truncated { sigmas: 0.5 },
        Scatter::Truncated { sigmas: 2.0 },
        Scatter::Truncated { sigmas: 6.0 },
    ];

    #[test]
    fn moments_are_those_of_textbooks() {
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        let Moments { sigma, kurtosis } = moments(Scatter::Uniform, 1, 2.0);
        near(sigma, 2.0 / 3.0_f64.sqrt());
        near(kurtosis, 1.8);
        near(moments(Scatter::Uniform, 3, 1.0).sigma, 0.2_f64.sqrt());
        // Cut off at 2: 1 - 2 k phi / (2 Phi - 1).
        let phi = (-2.0_f64).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let part = libm::erf(2.0_f64.sqrt());
        near(moments(Scatter::Truncated { sigmas: 2.0 }, 1, 2.0).sigma, (1.0 - 4.0 * phi / part).sqrt());
        // Far truncation leaves a normal distribution, near truncation a uniform one.
        for m in 1..=3 {
            let far = moments(Scatter::Truncated { sigmas: 12.0 }, m, 12.0);
            near(far.sigma, 1.0);
            near(far.kurtosis, 3.0);
            let close = moments(Scatter::Truncated { sigmas: 1e-7 }, m, 1.0);
            near(close.sigma, moments(Scatter::Uniform, m, 1.0).sigma);
        }
        // Both integration methods agree at the switch.
        for n in 0..8 {
            near(radial(n, 5.0 - 1e-14), radial(n, 5.0));
        }
    }

    #[test]
    fn what_is_drawn_has_the_moments() {
        const DRAWS: u64 = 40_000;
        for scatter in ALL {
            for m in 1..=3 {
                let expected = moments(scatter, m, 2.0);
                let (mut second, mut fourth, mut farthest) = (0.0, 0.0, 0.0_f64);
                for k in 0..DRAWS {
                    let mut x = vec![0.0; m];
                    draw(scatter, 2.0, &mut design_stream(7, k), &mut x);
                    second += x[0].powi(2) / DRAWS as f64;
                    fourth += x[0].powi(4) / DRAWS as f64;
                    farthest = farthest.max(x.iter().map(|x| x * x).sum::<f64>().sqrt());
                }
                // Five standard errors of a variance.
                let error = 5.0 * ((expected.kurtosis - 1.0) / DRAWS as f64).sqrt();
                let variance = expected.sigma.powi(2);
                assert!((second / variance - 1.0).abs() < error, "{scatter:?} {m}: {second} {variance}");
                let kurtosis = fourth / variance.powi(2);
                assert!((kurtosis / expected.kurtosis - 1.0).abs() < 0.1, "{scatter:?} {m}: {kurtosis}");
                let cut_off = !matches!(scatter, Scatter::Normal { .. });
                assert!(
                    !cut_off
                        || farthest <= 2.0 && farthest > 1.5
                        || matches!(scatter, Scatter::Truncated { sigmas } if sigmas > 5.0),
                    "{farthest}"
                );
            }
        }
    }

    #[test]
    fn a_design_does_not_depend_on_those_before_it() {
        let one = |number| {
            let mut x = [0.0; 3];
            draw(Scatter::Uniform, 1.0, &mut design_stream(3, number), &mut x);
            x
        };
        let both = [one(4), one(5)];
        assert_eq!([one(5), one(4)], [both[1], both[0]]);
        assert_ne!(both[0], both[1]);
    }
}
