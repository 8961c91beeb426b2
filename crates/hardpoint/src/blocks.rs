//! Storage of results: values of eight output times (or designs) in adjacent lanes, in the order of computation.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use hardpoint_tape::{LANES, Lanes};

use crate::order::sort_by_number;

/// Eight numbers, aligned for fast memory access.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct AlignedLanes(pub Lanes);

/// Views lines as arrays of lanes.
#[inline(always)]
pub(crate) fn lanes_of(lines: &mut [AlignedLanes]) -> &mut [Lanes] {
    bytemuck::cast_slice_mut(lines)
}

/// Lines of zeros.
pub(crate) fn zeros(length: usize) -> Vec<AlignedLanes> {
    let mut lines = Vec::with_capacity(length);
    lengthen(&mut lines, length);
    lines
}

/// Appends lines of zeros up to this length, in copies of many lines: `resize` writes one line after another.
fn lengthen(lines: &mut Vec<AlignedLanes>, length: usize) {
    static ZEROS: [AlignedLanes; 32] = [AlignedLanes([0.0; LANES]); 32];
    while lines.len() < length {
        let count = usize::min(ZEROS.len(), length - lines.len());
        lines.extend_from_slice(&ZEROS[..count]);
    }
}

/// Results of eight output times, or of eight designs, in adjacent lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ResultBlock<'b> {
    /// 24 numbers per body except ground: position (m), columns of the rotation matrix, velocity (m/s), angular
    /// velocity (rad/s), acceleration (m/s^2), angular acceleration (rad/s^2).
    pub states: &'b [[f64; 8]],
    /// 18 numbers per variable and per body that it moves: those of a `BodySensitivity` in the order of its fields.
    pub derivatives: &'b [[f64; 8]],
}

/// Storage of a fixed number of values per output time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    width: usize,
    place: BlockLayout,
}

/// Row of results that are merged from two storages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum MergedRow {
    Own(usize),
    Added(usize),
}

/// Rows of two storages in the order of their times. Of equal times, that of the own storage counts.
pub(crate) fn merged_rows(own: &[f64], added: &[f64]) -> Vec<MergedRow> {
    let time = |row: &MergedRow| match *row {
        MergedRow::Own(k) => own[k],
        MergedRow::Added(k) => added[k],
    };
    let all = (0..own.len()).map(MergedRow::Own).chain((0..added.len()).map(MergedRow::Added));
    let mut rows: Vec<MergedRow> = all.collect();
    sort_by_number(&mut rows, time);
    rows.dedup_by(|b, a| time(b) == time(a));
    rows
}

/// Rows that are added, each with its row in the storage that it is from.
pub(crate) fn added_rows(rows: &[MergedRow]) -> impl Iterator<Item = (usize, usize)> {
    rows.iter().enumerate().filter_map(|(k, row)| match *row {
        MergedRow::Own(_) => None,
        MergedRow::Added(from) => Some((k, from)),
    })
}

/// Values of two lists, `width` of them per row, in this order of rows.
pub(crate) fn merged<T: Copy>(own: &[T], added: &[T], width: usize, rows: &[MergedRow]) -> Vec<T> {
    let row = |row: &MergedRow| match *row {
        MergedRow::Own(k) => &own[k * width..][..width],
        MergedRow::Added(k) => &added[k * width..][..width],
    };
    rows.iter().flat_map(row).copied().collect()
}

/// Layout of the storage.
#[derive(Clone, Debug)]
enum BlockLayout {
    /// Output times 8n to 8n + 7 in adjacent lanes; the first value of all eight comes first.
    Times(Vec<AlignedLanes>),
    /// Designs in adjacent lanes, output time after output time; this storage is one of the lanes.
    Designs { lines: Arc<Vec<AlignedLanes>>, lane: usize },
}

impl Default for BlockLayout {
    fn default() -> Self {
        Self::Times(Vec::new())
    }
}

impl Blocks {
    /// Results of one design of a batch, with `width` values per output time.
    pub fn of_design(lines: Arc<Vec<AlignedLanes>>, width: usize, lane: usize) -> Self {
        Self { width, place: BlockLayout::Designs { lines, lane } }
    }

    /// Resizes to `width` values at each of `steps` output times, reusing memory. The contents are undefined, except
    /// for zeros that were never overwritten since the width changed.
    pub fn shape(&mut self, width: usize, steps: usize) {
        if self.width != width {
            self.place = BlockLayout::default();
            self.width = width;
        }
        let lines = self.times_mut();
        let wanted = width * steps.div_ceil(LANES);
        lines.reserve_exact(wanted.saturating_sub(lines.len()));
    }

    /// Lines of a storage by output times; replaces a storage by designs with an empty one.
    #[inline(always)]
    fn times_mut(&mut self) -> &mut Vec<AlignedLanes> {
        if let BlockLayout::Designs { .. } = self.place {
            self.place = BlockLayout::default();
        }
        match &mut self.place {
            BlockLayout::Times(lines) => lines,
            BlockLayout::Designs { .. } => unreachable!("replaced above"),
        }
    }

    /// Values at output time k.
    #[inline(always)]
    pub fn row(&self, k: usize) -> ResultRow<'_> {
        let (lines, line, lane) = match &self.place {
            BlockLayout::Times(lines) => (&lines[..], k / LANES, k % LANES),
            BlockLayout::Designs { lines, lane } => (&lines[..], k, *lane),
        };
        ResultRow { lines: &lines[line * self.width..][..self.width], lane }
    }

    /// Values of the block of eight output times that contains k.
    #[inline(always)]
    pub fn block_mut(&mut self, k: usize) -> &mut [Lanes] {
        let (width, first) = (self.width, k / LANES * self.width);
        let lines = self.times_mut();
        if lines.len() < first + width {
            lengthen(lines, first + width);
        }
        lanes_of(&mut lines[first..first + width])
    }

    /// Values of the block of eight output times that contains k; only for storage by output times.
    #[inline(always)]
    pub fn block(&self, k: usize) -> &[Lanes] {
        match &self.place {
            BlockLayout::Times(lines) => bytemuck::cast_slice(&lines[k / LANES * self.width..][..self.width]),
            BlockLayout::Designs { .. } => &[],
        }
    }

    /// Copies values, starting at `first`, of the eight output times of the block that contains k, as far as they
    /// exist.
    #[inline(always)]
    pub fn gather(&self, k: usize, first: usize, to: &mut [Lanes]) {
        let from = |line: usize| line * self.width + first;
        match &self.place {
            BlockLayout::Times(lines) => {
                to.copy_from_slice(bytemuck::cast_slice(&lines[from(k / LANES)..][..to.len()]));
            }
            BlockLayout::Designs { lines, lane } => {
                for time in 0..LANES {
                    let there = lines.get(from(k / LANES * LANES + time)..).unwrap_or_default();
                    to.iter_mut().zip(there).for_each(|(to, line)| to[time] = line.0[*lane]);
                }
            }
        }
    }

    /// Largest sum of the squares of three adjacent values, the first one of which is this, at the first `steps` output
    /// times.
    pub fn largest_square(&self, first: usize, steps: usize) -> f64 {
        let square = |k: usize| {
            let row = self.row(k);
            (0..3).map(|n| row.get(first + n).powi(2)).sum::<f64>()
        };
        let larger = |a: f64, b: f64| if b <= a { a } else { b };
        let whole = match &self.place {
            BlockLayout::Times(_) => steps / LANES * LANES,
            BlockLayout::Designs { .. } => 0,
        };
        let mut most = [0.0_f64; LANES];
        for k in (0..whole).step_by(LANES) {
            let [x, y, z] = [0, 1, 2].map(|n| &self.block(k)[first + n]);
            for lane in 0..LANES {
                most[lane] = larger(most[lane], x[lane] * x[lane] + y[lane] * y[lane] + z[lane] * z[lane]);
            }
        }
        (whole..steps).map(square).chain(most).fold(0.0, larger)
    }

    /// Writes values of output time k, starting at `first`.
    #[inline(always)]
    pub fn set(&mut self, k: usize, first: usize, numbers: impl IntoIterator<Item = f64>) {
        let (mut lines, lane) = (self.block_mut(k)[first..].iter_mut(), k % LANES);
        // Neither `zip` nor `enumerate`: the iterators of bodies and coordinates are not inlined into these.
        for x in numbers {
            let Some(lanes) = lines.next() else { return };
            lanes[lane] = x;
        }
    }

    /// Copies output time j of another storage with the same width to output time k.
    pub fn copy(&mut self, k: usize, from: &Self, j: usize) {
        self.width = from.width;
        self.set(k, 0, from.row(j).all());
    }

    /// Inserts values of another storage with the same width, in this order of rows.
    pub fn merge(&mut self, added: &Self, rows: &[MergedRow]) {
        self.spread(rows);
        for (k, from) in added_rows(rows) {
            self.set(k, 0, added.row(from).all());
        }
    }

    /// Moves the values of this storage to where they are in this order of rows; others are undefined.
    pub fn spread(&mut self, rows: &[MergedRow]) {
        let width = self.width;
        // The last ones first, since all move towards the end.
        for (k, row) in rows.iter().enumerate().rev() {
            let MergedRow::Own(from) = *row else { continue };
            if from == k {
                return;
            }
            self.block_mut(k);
            let lines = self.times_mut();
            for column in 0..width {
                let x = lines[from / LANES * width + column].0[from % LANES];
                lines[k / LANES * width + column].0[k % LANES] = x;
            }
        }
    }

    /// Keeps every second one of the first `steps` output times.
    pub fn thin(&mut self, steps: usize) {
        for k in 0..steps.div_ceil(2) {
            for column in 0..self.width {
                let x = self.row(2 * k).get(column);
                self.set(k, column, [x]);
            }
        }
    }
}

/// Values at one output time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ResultRow<'b> {
    lines: &'b [AlignedLanes],
    lane: usize,
}

impl<'b> ResultRow<'b> {
    #[inline(always)]
    pub fn get(self, column: usize) -> f64 {
        self.lines[column].0[self.lane]
    }

    pub fn all(self) -> impl Iterator<Item = f64> + 'b {
        self.lines.iter().map(move |line| line.0[self.lane])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_where_they_were_put_however_they_came() {
        let number = |k: usize, column: usize| (100 * k + column) as f64;
        let (mut one_by_one, mut by_eights) = (Blocks::default(), Blocks::default());
        one_by_one.shape(5, 20);
        by_eights.shape(5, 0);
        for k in 0..20 {
            one_by_one.set(k, 0, [number(k, 0)]);
            one_by_one.set(k, 1, (1..5).map(|column| number(k, column)));
            by_eights.block_mut(k).iter_mut().enumerate().for_each(|(c, lanes)| lanes[k % 8] = number(k, c));
        }
        for blocks in [&one_by_one, &by_eights] {
            for k in 0..20 {
                assert_eq!([2, 3, 4].map(|c| blocks.row(k).get(c)), [2, 3, 4].map(|c| number(k, c)));
            }
        }
        // Output times 3, 7 and 19 between 0, 1, 2 ...
        let rows = merged_rows(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0], &[0.0, 0.5, 4.5, 9.0]);
        let mut all = Blocks::default();
        all.shape(5, 8);
        (0..8).for_each(|k| all.copy(k, &one_by_one, k));
        let mut added = Blocks::default();
        added.shape(5, 4);
        [11, 3, 7, 19].into_iter().enumerate().for_each(|(k, of)| added.copy(k, &one_by_one, of));
        all.merge(&added, &rows);
        let expected = [0, 3, 1, 2, 3, 4, 7, 5, 6, 7, 19];
        assert_eq!(rows.len(), expected.len());
        assert!(expected.iter().enumerate().all(|(k, of)| all.row(k).get(4) == number(*of, 4)));
        let mut kept = Blocks::default();
        kept.shape(5, 3);
        (0..11).for_each(|k| kept.copy(k, &one_by_one, k + 9));
        kept.thin(11);
        assert!((0..6).all(|k| kept.row(k).get(4) == number(2 * k + 9, 4)));
        // The memory is reused.
        let memory = kept.block_mut(0).as_ptr();
        kept.shape(5, 16);
        kept.set(15, 0, [1.0]);
        assert_eq!((kept.row(15).get(0), kept.block_mut(0).as_ptr()), (1.0, memory));
        // Two values of eight designs at three output times.
        let lines = (0..6)
            .map(|n| AlignedLanes(std::array::from_fn(|lane| number(n / 2, n % 2) + lane as f64 / 8.0)));
        let mut design = Blocks::of_design(Arc::new(lines.collect()), 2, 3);
        assert_eq!(
            design.row(2).all().collect::<Vec<_>>(),
            [0.0, 1.0].map(|c| number(2, c as usize) + 0.375)
        );
        kept.shape(2, 1);
        kept.copy(0, &design, 1);
        assert_eq!(kept.row(0).get(1), number(1, 1) + 0.375);
        design.shape(2, 8);
        design.set(5, 0, [7.0]);
        assert_eq!(design.row(5).get(0), 7.0);
    }
}
