//! Sobol sequence: points that fill a cube of many dimensions evenly, addressable by number, with Owen scrambling.

/// Primitive polynomials and first direction numbers for 512 dimensions: the first lines of `new-joe-kuo-6.21201` of S.
/// Joe and F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30
/// (2008) 2635-2654, as published.
const JOE_KUO: &str = include_str!("joe_kuo.txt");
const BITS: usize = 32;

/// Sobol sequence of a number of dimensions.
#[derive(Clone, Debug)]
pub(super) struct Sobol {
    /// Direction numbers of each dimension, as fractions of 2^32.
    directions: Vec<[u32; BITS]>,
    /// Scrambling seed of each dimension.
    seeds: Vec<u32>,
}

impl Sobol {
    /// Maximum number of dimensions, limited by the table of direction numbers.
    pub(super) const MOST: usize = 512;

    /// Sequence of at most [`MOST`](Self::MOST) dimensions, scrambled by a seed.
    pub(super) fn new(dimensions: usize, seed: u64) -> Self {
        let first: [u32; BITS] = std::array::from_fn(|k| 1 << (BITS - 1 - k));
        let others = JOE_KUO.lines().skip(1).map(directions);
        Self {
            directions: std::iter::once(first).chain(others).take(dimensions).collect(),
            seeds: (0..dimensions).map(|d| mixed(&[seed, d as u64]) as u32).collect(),
        }
    }

    /// Coordinate `d` of a point, in the open interval from 0 to 1.
    pub(super) fn at(&self, number: usize, d: usize) -> f64 {
        let x = scrambled(self.exact(number, d), self.seeds[d]);
        (f64::from(x) + 0.5) / 2.0_f64.powi(BITS as i32)
    }

    /// Coordinate `d` before scrambling, as a fraction of 2^32.
    fn exact(&self, number: usize, d: usize) -> u32 {
        let bits = (0..BITS).filter(|k| number >> k & 1 == 1);
        bits.fold(0, |x, k| x ^ self.directions[d][k])
    }
}

/// Direction numbers of a line `d s a m_1 ... m_s` of the table.
///
/// ```text
/// v_k = m_k / 2^k for k <= s,    v_k = a_1 v_k-1 ^ ... ^ a_s-1 v_k-s+1 ^ v_k-s ^ v_k-s / 2^s
/// ```
fn directions(line: &str) -> [u32; BITS] {
    let numbers: Vec<u32> = line.split(' ').map(|n| n.parse().expect("a table of numbers")).collect();
    let (s, a, m) = (numbers[1] as usize, numbers[2], &numbers[3..]);
    let mut v = [0; BITS];
    for k in 0..BITS {
        v[k] = if k < s {
            m[k] << (BITS - 1 - k)
        } else {
            let others = (1..s).filter(|j| a >> (s - 1 - j) & 1 == 1);
            others.fold(v[k - s] ^ v[k - s] >> s, |x, j| x ^ v[k - j])
        };
    }
    v
}

/// Owen's nested scrambling by a hash: every bit is flipped or not depending on the bits above it (B. Burley,
/// "Practical Hash-based Owen Scrambling", JCGT 9 (2020) no. 4, with the hash of N. Vegdahl, 2021). It preserves the
/// even distribution of a point set.
fn scrambled(x: u32, seed: u32) -> u32 {
    let mut x = x.reverse_bits();
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x.reverse_bits()
}

/// Pseudo-random number determined by some others (the finaliser of SplitMix64, after each of them).
pub(super) fn mixed(of: &[u64]) -> u64 {
    of.iter().fold(0, |state, x| {
        let mut z = (state ^ x).wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_points_are_those_of_another_implementation() {
        // scipy.stats.qmc.Sobol(25, scramble=False) uses Gray-code order; dimensions 0, 1, 2, 3, 10, 20, 24.
        const DIMENSIONS: [usize; 7] = [0, 1, 2, 3, 10, 20, 24];
        const POINTS: [[f64; 7]; 8] = [
            [0.0; 7],
            [0.5; 7],
            [0.75, 0.25, 0.25, 0.25, 0.75, 0.25, 0.25],
            [0.25, 0.75, 0.75, 0.75, 0.25, 0.75, 0.75],
            [0.375, 0.375, 0.625, 0.875, 0.875, 0.125, 0.875],
            [0.875, 0.875, 0.125, 0.375, 0.375, 0.625, 0.375],
            [0.625, 0.125, 0.875, 0.625, 0.125, 0.375, 0.625],
            [0.125, 0.625, 0.375, 0.125, 0.625, 0.875, 0.125],
        ];
        let sobol = Sobol::new(25, 1);
        for (n, point) in POINTS.iter().enumerate() {
            for (d, x) in DIMENSIONS.into_iter().zip(point) {
                assert_eq!(f64::from(sobol.exact(n ^ n >> 1, d)) / 2.0_f64.powi(32), *x, "{n} {d}");
            }
        }
    }

    #[test]
    fn every_dimension_is_a_permutation_of_even_slices_and_the_first_two_of_even_boxes() {
        const N: usize = 256;
        for seed in [1, 2, 77] {
            let sobol = Sobol::new(Sobol::MOST, seed);
            for d in 0..Sobol::MOST {
                let mut slices: Vec<usize> = (0..N).map(|n| (sobol.at(n, d) * N as f64) as usize).collect();
                slices.sort_unstable();
                assert!(slices.into_iter().eq(0..N), "dimension {d}");
            }
            let mut boxes: Vec<[usize; 2]> =
                (0..N).map(|n| [0, 1].map(|d| (sobol.at(n, d) * 16.0) as usize)).collect();
            boxes.sort_unstable();
            boxes.dedup();
            assert_eq!(boxes.len(), N);
        }
        assert_ne!(Sobol::new(2, 1).at(5, 1), Sobol::new(2, 2).at(5, 1));
    }

    #[test]
    fn a_product_is_integrated_far_better_than_at_random() {
        // int prod (1 + (x_d - 1/2)) = 1 over 12 dimensions; at random the error is sqrt((1 + 1/12)^12 - 1) / sqrt(N) =
        // 0.02.
        const N: usize = 4096;
        const SEEDS: u64 = 16;
        const AT_RANDOM: f64 = 0.0198;
        let error = |seed| {
            let sobol = Sobol::new(12, seed);
            let value = |n| (0..12).map(|d| 0.5 + sobol.at(n, d)).product::<f64>();
            (0..N).map(value).sum::<f64>() / N as f64 - 1.0
        };
        let rms = ((0..SEEDS).map(|seed| error(seed).powi(2)).sum::<f64>() / SEEDS as f64).sqrt();
        assert!(rms < 0.15 * AT_RANDOM, "{rms}");
    }
}
