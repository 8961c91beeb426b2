//! The designs of W4: what NumPy's `default_rng(20240101).uniform(-0.005, 0.005, (1000, 24))` draws, bit by bit, so
//! that Hardpoint, the floor and the peers in Python move their hardpoints alike without sharing a file.
//!
//! The generator is PCG XSL RR 128/64 (O'Neill 2014), seeded through NumPy's `SeedSequence`.

use std::array::from_fn;

/// Number of designs.
pub const DESIGNS: usize = 1000;

/// Changes of the 24 coordinates, m, design by design.
pub fn designs() -> Vec<Vec<f64>> {
    let mut generator = Pcg64::seeded(20_240_101);
    (0..DESIGNS).map(|_| (0..24).map(|_| -0.005 + 0.01 * generator.unit()).collect()).collect()
}

struct Pcg64 {
    state: u128,
    increment: u128,
}

impl Pcg64 {
    fn seeded(seed: u32) -> Self {
        let [state, increment] = seed_sequence(seed);
        let mut generator = Self { state: 0, increment: increment << 1 | 1 };
        generator.step();
        generator.state = generator.state.wrapping_add(state);
        generator.step();
        generator
    }

    fn step(&mut self) {
        const MULTIPLIER: u128 = 2_549_297_995_355_413_924 << 64 | 4_865_540_595_714_422_341;
        self.state = self.state.wrapping_mul(MULTIPLIER).wrapping_add(self.increment);
    }

    /// Uniform in [0, 1), 53 bits.
    fn unit(&mut self) -> f64 {
        self.step();
        let folded = (self.state >> 64) as u64 ^ self.state as u64;
        let bits = folded.rotate_right((self.state >> 122) as u32);
        (bits >> 11) as f64 * (-53f64).exp2()
    }
}

/// One step of `SeedSequence`'s hash: a multiplier that changes from word to word.
fn hash(value: u32, constant: &mut u32, factor: u32) -> u32 {
    let mut x = value ^ *constant;
    *constant = constant.wrapping_mul(factor);
    x = x.wrapping_mul(*constant);
    x ^ x >> 16
}

/// Two numbers of 128 bits from a seed of one word.
fn seed_sequence(seed: u32) -> [u128; 2] {
    let mut constant = 0x43b0_d7e5;
    let mut pool: [u32; 4] = from_fn(|k| hash(if k == 0 { seed } else { 0 }, &mut constant, 0x931e_8875));
    for from in 0..4 {
        for to in (0..4).filter(|to| *to != from) {
            let mixed = hash(pool[from], &mut constant, 0x931e_8875);
            let x = pool[to].wrapping_mul(0xca01_f9dd).wrapping_sub(mixed.wrapping_mul(0x4973_f715));
            pool[to] = x ^ x >> 16;
        }
    }
    let mut constant = 0x8b51_f9dd;
    let words: [u128; 8] = from_fn(|k| hash(pool[k % 4], &mut constant, 0x58f3_8ded).into());
    // Words of 32 bits pair up low first, those of 64 bits high first.
    from_fn(|k| {
        let [a, b, c, d] = from_fn(|i| words[4 * k + i]);
        (b << 32 | a) << 64 | d << 32 | c
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_designs_are_those_that_numpy_draws() {
        let designs = designs();
        assert_eq!(designs[0][..2], [0.000_907_578_032_345_906_4, -0.004_015_362_913_239_629_5]);
        assert_eq!(designs[DESIGNS - 1][23], -0.004_379_341_101_333_922);
    }
}
