//! Curves of the report page as compact *tracks* of integers.
//!
//! A curve is one or more tracks: a curve with several numbers per step, such as the seven of a pose, has a track for
//! each. Curves that the page computes with keep every bit of their `f32`. Curves that it only draws and ranks, the
//! sensitivities, are accurate to [`ERROR`] of the track's own range. In both cases a track is a list of integers.
//! Curves are smooth, so differences of first to fourth order are small. The order with the smallest differences is
//! written byte by byte (all lowest bytes first), which deflate compresses to about half a byte per value. Zeros and
//! gaps are exact; a constant takes no values; equal tracks are written once.

use std::collections::HashMap;

/// Maximum error of a value that is only drawn, relative to the range of its track.
pub const ERROR: f64 = 1e-5;
/// Number of grid steps within the range: half a step is 0.83e-5 of it, which leaves a part of [`ERROR`] for the
/// rounding to `f32`.
const STEPS: f64 = 60_000.0;
/// Maximum size of values, in ranges: above it the rounding to `f32` would use up the rest of [`ERROR`].
const LARGEST: f64 = 25.0;
/// Maximum order of differences: beyond it rounding grows faster than the differences of the curve decrease.
const MOST_DIFFERENCES: u8 = 4;
/// Integers below this are exact as `f32`.
const WHOLE: f32 = 16_777_216.0;
const CONSTANT: u8 = 0;
const SCALED: u8 = 8;
const BITS: u8 = 16;

/// Precision of a curve's values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Every bit of the `f32`.
    Full,
    /// Within [`ERROR`] of the range.
    Approximate,
}

/// Distinct tracks of a block.
#[derive(Default)]
pub struct Tracks {
    list: Vec<Track>,
    known: HashMap<Track, u32>,
}

impl Tracks {
    /// Adds the tracks of a curve with `parts` numbers per step, and returns their indices.
    pub fn add(&mut self, values: &[f32], precision: Precision, parts: usize) -> Vec<u32> {
        if values.is_empty() {
            return Vec::new();
        }
        let part = |k: usize| values.iter().skip(k).step_by(parts).copied().collect::<Vec<f32>>();
        (0..parts).map(|k| self.index(Track::of(&part(k), precision))).collect()
    }

    fn index(&mut self, track: Track) -> u32 {
        let next = u32::try_from(self.list.len()).expect("fewer than 2^32 tracks");
        let list = &mut self.list;
        *self.known.entry(track).or_insert_with_key(|track| {
            list.push(track.clone());
            next
        })
    }

    /// Bytes of the block: `json`, then all tracks.
    ///
    /// Layout, little-endian:
    ///
    /// | content | type | number |
    /// |---|---|---|
    /// | bytes of the JSON, tracks `t`, gaps `g`, residuals `r` | u32 | 4 |
    /// | JSON | UTF-8 | |
    /// | form: 0 constant, 8 + order for numbers times the scale, 16 + order for bits of `f32` | u8 | t |
    /// | length, including gaps | u32 | t |
    /// | scale, or the constant | f32 | t |
    /// | number of gaps | u32 | t |
    /// | first step and length of each gap | u32 | 2 g |
    /// | residuals: signs folded in (0, -1, 1, -2, ...), lowest bytes of all first | u8 | 4 r |
    pub fn block(&self, json: &[u8]) -> Vec<u8> {
        let list = &self.list;
        let gaps: Vec<[u32; 2]> = list.iter().flat_map(|t| &t.gaps).copied().collect();
        let residuals: Vec<u32> = list.iter().flat_map(|t| &t.residuals).copied().collect();
        let counts = [json.len(), list.len(), gaps.len(), residuals.len()];
        let mut bytes = Vec::with_capacity(json.len() + 16 * list.len() + 4 * residuals.len());
        bytes.extend(counts.map(|n| n as u32).iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend(json);
        bytes.extend(list.iter().map(|t| t.form));
        bytes.extend(list.iter().flat_map(|t| t.length.to_le_bytes()));
        bytes.extend(list.iter().flat_map(|t| t.scale.to_le_bytes()));
        bytes.extend(list.iter().flat_map(|t| (t.gaps.len() as u32).to_le_bytes()));
        bytes.extend(gaps.iter().flatten().flat_map(|n| n.to_le_bytes()));
        for byte in 0..4 {
            bytes.extend(residuals.iter().map(|r| r.to_le_bytes()[byte]));
        }
        bytes
    }
}

/// Encoded track: one number per step.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Track {
    form: u8,
    length: u32,
    /// Bits of the `f32`.
    scale: u32,
    /// First step and length of each gap.
    gaps: Vec<[u32; 2]>,
    residuals: Vec<u32>,
}

impl Track {
    fn of(values: &[f32], precision: Precision) -> Self {
        let length = values.len() as u32;
        let known: Vec<f32> = values.iter().copied().filter(|v| !v.is_nan()).collect();
        let constant = known.first().copied().unwrap_or(f32::NAN);
        let gaps = if known.is_empty() { Vec::new() } else { gaps(values) };
        if known.iter().all(|v| *v == constant) {
            return Self { form: CONSTANT, length, scale: constant.to_bits(), gaps, residuals: Vec::new() };
        }
        let (kind, scale, numbers) = match scale(&known, precision) {
            Some(scale) => (SCALED, scale, known.iter().map(|v| multiple(*v, scale)).collect()),
            None => (BITS, 0.0, known.iter().map(|v| in_order(*v)).collect()),
        };
        let (order, residuals) = differences(numbers);
        Self { form: kind + order, length, scale: scale.to_bits(), gaps, residuals }
    }
}

/// Runs of steps without a value.
fn gaps(values: &[f32]) -> Vec<[u32; 2]> {
    let mut gaps: Vec<[u32; 2]> = Vec::new();
    for k in (0..values.len()).filter(|k| values[*k].is_nan()).map(|k| k as u32) {
        match gaps.last_mut() {
            Some([first, length]) if *first + *length == k => *length += 1,
            _ => gaps.push([k, 1]),
        }
    }
    gaps
}

/// Step of which all values are near multiples; `None` if the bits have to be stored.
fn scale(values: &[f32], precision: Precision) -> Option<f32> {
    if values.iter().all(|v| v.fract() == 0.0 && v.abs() < WHOLE) {
        return Some(1.0);
    }
    let least = values.iter().copied().fold(f32::INFINITY, f32::min);
    let most = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let range = f64::from(most) - f64::from(least);
    let scale = (range / STEPS) as f32;
    let near = f64::from(most.max(-least)) <= LARGEST * range;
    (precision == Precision::Approximate && near && scale.is_normal()).then_some(scale)
}

fn multiple(value: f32, scale: f32) -> i32 {
    (f64::from(value) / f64::from(scale)).round() as i32
}

/// Bits of a number, mapped to an integer that increases with it.
fn in_order(value: f32) -> i32 {
    let bits = value.to_bits() as i32;
    if bits < 0 { -(bits & i32::MAX) } else { bits }
}

/// Differences of the order with the smallest numbers, with signs folded in; the first ones start from zero.
fn differences(mut numbers: Vec<i32>) -> (u8, Vec<u32>) {
    let folded = |r: i32| ((r << 1) ^ (r >> 31)) as u32;
    let (mut least, mut best, mut residuals) = (u64::MAX, 0, Vec::new());
    for order in 0..=MOST_DIFFERENCES {
        // The bits of a floating-point number grow like its logarithm.
        let cost = numbers.iter().map(|r| (f64::from(folded(*r)) + 1.0).to_bits() >> 32).sum();
        if cost < least {
            (least, best) = (cost, order);
            residuals.clear();
            residuals.extend(numbers.iter().map(|r| folded(*r)));
        }
        let mut before = 0;
        for r in &mut numbers {
            before = std::mem::replace(r, r.wrapping_sub(before));
        }
    }
    (best, residuals)
}

#[cfg(test)]
mod tests {
    use super::*;

    use proptest::prelude::*;

    /// Decodes a track as the page does.
    fn read(track: &Track) -> Vec<f32> {
        let missing = |k: u32| track.gaps.iter().any(|[first, length]| (*first..first + length).contains(&k));
        let mut numbers: Vec<i32> =
            track.residuals.iter().map(|r| (r >> 1) as i32 ^ -((r & 1) as i32)).collect();
        for _ in 0..track.form % 8 {
            for k in 1..numbers.len() {
                numbers[k] = numbers[k].wrapping_add(numbers[k - 1]);
            }
        }
        let mut numbers = numbers.into_iter();
        let scale = f32::from_bits(track.scale);
        let mut next = || match track.form & !7 {
            CONSTANT => scale,
            SCALED => (f64::from(numbers.next().unwrap()) * f64::from(scale)) as f32,
            _ => {
                let n = numbers.next().unwrap();
                f32::from_bits(if n < 0 { n.wrapping_neg() as u32 | 1 << 31 } else { n as u32 })
            }
        };
        (0..track.length).map(|k| if missing(k) { f32::NAN } else { next() }).collect()
    }

    fn same(a: f32, b: f32) -> bool {
        a == b || a.is_nan() && b.is_nan()
    }

    fn any_values() -> impl Strategy<Value = Vec<f32>> {
        let value = prop_oneof![
            8 => -1e3f32..1e3,
            1 => any::<f32>(),
            2 => Just(0.0f32),
            2 => Just(f32::NAN),
        ];
        (prop::collection::vec(value, 1..60), -1e4f32..1e4, prop::bool::ANY).prop_map(
            |(values, offset, moved)| {
                values.into_iter().map(|v| if moved { v + offset } else { v }).collect()
            },
        )
    }

    proptest! {
        #[test]
        fn full_precision_comes_back_to_the_bit(values in any_values()) {
            let back = read(&Track::of(&values, Precision::Full));
            prop_assert!(back.len() == values.len() && values.iter().zip(&back).all(|(a, b)| same(*a, *b)));
        }

        #[test]
        fn what_is_drawn_comes_back_within_its_error(values in any_values()) {
            let back = read(&Track::of(&values, Precision::Approximate));
            let known = || values.iter().copied().filter(|v| !v.is_nan()).map(f64::from);
            let range = known().fold(f64::NEG_INFINITY, f64::max) - known().fold(f64::INFINITY, f64::min);
            prop_assert_eq!(values.len(), back.len());
            for (a, b) in values.iter().zip(&back) {
                prop_assert_eq!(a.is_nan(), b.is_nan());
                prop_assert!(*a != 0.0 || *b == 0.0, "zero became {}", b);
                prop_assert!(same(*a, *b) || (f64::from(*a) - f64::from(*b)).abs() <= ERROR * range, "{} {}", a, b);
            }
        }
    }

    #[test]
    fn a_smooth_curve_takes_a_byte_a_value_and_a_constant_none() {
        let wave: Vec<f32> = (0..400).map(|k| (k as f32 * 0.02).sin()).collect();
        let track = Track::of(&wave, Precision::Approximate);
        assert!(track.residuals[4..].iter().all(|r| *r < 256), "{track:?}");
        let constant = Track::of(&[f32::NAN, 2.5, 2.5], Precision::Approximate);
        assert!(constant.residuals.is_empty() && constant.gaps == [[0, 1]]);
    }

    #[test]
    fn equal_tracks_are_written_once() {
        let mut tracks = Tracks::default();
        let wave: Vec<f32> = (0..9).map(|k| (k as f32).cos()).collect();
        assert_eq!(tracks.add(&wave, Precision::Full, 1), [0]);
        let twice: Vec<f32> = wave.iter().flat_map(|v| [*v, 3.0]).collect();
        assert_eq!(tracks.add(&twice, Precision::Full, 2), [0, 1]);
        assert!(tracks.add(&[], Precision::Full, 7).is_empty());
    }
}
