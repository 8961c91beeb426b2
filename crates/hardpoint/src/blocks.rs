//! Results in one stream: eight output times side by side, number by number, in the order in which they are found.

use bytemuck::{Pod, Zeroable};
use hardpoint_tape::{LANES, Lanes};

/// Eight numbers where memory is read and written fastest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(64))]
pub(crate) struct Line(pub Lanes);

/// Lines as the lanes that they are.
#[inline(always)]
pub(crate) fn lanes_of(lines: &mut [Line]) -> &mut [Lanes] {
    bytemuck::cast_slice_mut(lines)
}

/// So many numbers per output time. Output times 8n to 8n + 7 stand side by side, the first numbers of all eight first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    width: usize,
    lines: Vec<Line>,
}

impl Blocks {
    /// Room for so many numbers at each of so many output times, in the memory that there is; what stands in it means nothing, but zeros
    /// where nothing was written since it had another width.
    pub fn shape(&mut self, width: usize, steps: usize) {
        if self.width != width {
            self.lines.clear();
            self.width = width;
        }
        let lines = width * steps.div_ceil(LANES);
        self.lines.reserve_exact(lines.saturating_sub(self.lines.len()));
    }

    /// The numbers at output time k.
    #[inline(always)]
    pub fn row(&self, k: usize) -> Row<'_> {
        let first = k / LANES * self.width;
        Row { lines: &self.lines[first..first + self.width], lane: k % LANES }
    }

    /// Of the eight output times that k is one of.
    #[inline(always)]
    pub fn block_mut(&mut self, k: usize) -> &mut [Lanes] {
        let first = k / LANES * self.width;
        if self.lines.len() < first + self.width {
            self.lines.resize(first + self.width, Line::default());
        }
        lanes_of(&mut self.lines[first..first + self.width])
    }

    /// The same, to be read.
    #[inline(always)]
    pub fn block(&self, k: usize) -> &[Lanes] {
        let first = k / LANES * self.width;
        bytemuck::cast_slice(&self.lines[first..first + self.width])
    }

    /// Writes some numbers of output time k, from this one on.
    #[inline(always)]
    pub fn set(&mut self, k: usize, first: usize, numbers: impl IntoIterator<Item = f64>) {
        for (lanes, x) in self.block_mut(k)[first..].iter_mut().zip(numbers) {
            lanes[k % LANES] = x;
        }
    }

    /// Takes over output time j of another one, which has as many numbers, as its own output time k.
    pub fn copy(&mut self, k: usize, from: &Self, j: usize) {
        self.width = from.width;
        self.set(k, 0, from.row(j).all());
    }

    /// Of so many output times, every second is dropped.
    pub fn thin(&mut self, steps: usize) {
        for k in 0..steps.div_ceil(2) {
            for column in 0..self.width {
                let x = self.row(2 * k).get(column);
                self.set(k, column, [x]);
            }
        }
    }
}

/// The numbers at one output time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row<'b> {
    lines: &'b [Line],
    lane: usize,
}

impl<'b> Row<'b> {
    #[inline(always)]
    pub fn get(self, column: usize) -> f64 {
        self.lines[column].0[self.lane]
    }

    pub fn all(self) -> impl Iterator<Item = f64> + 'b {
        self.lines.iter().map(move |line| line.0[self.lane])
    }
}

/// Turns what lies side by side by design, output time by output time, into what lies side by side by output time: number by
/// number, those of eight designs.
#[inline(always)]
pub(crate) fn turned(times: [&[Lanes]; LANES], mut out: impl FnMut(usize, &[Lanes; LANES])) {
    let width = times.iter().map(|lanes| lanes.len()).min().unwrap_or(0);
    let times = times.map(|lanes| &lanes[..width]);
    for column in 0..width {
        out(column, &transposed(times.map(|lanes| &lanes[column])));
    }
}

/// By blocks of two by two, which a register of two numbers turns.
#[inline(always)]
fn transposed(rows: [&Lanes; LANES]) -> [Lanes; LANES] {
    let mut columns = [[0.0; LANES]; LANES];
    for i in (0..LANES).step_by(2) {
        for j in (0..LANES).step_by(2) {
            let [[a, b], [c, d]] = [[rows[i][j], rows[i][j + 1]], [rows[i + 1][j], rows[i + 1][j + 1]]];
            ([columns[j][i], columns[j][i + 1]], [columns[j + 1][i], columns[j + 1][i + 1]]) =
                ([a, c], [b, d]);
        }
    }
    columns
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
        let mut kept = Blocks::default();
        kept.shape(5, 3);
        (0..11).for_each(|k| kept.copy(k, &one_by_one, k + 9));
        kept.thin(11);
        assert!((0..6).all(|k| kept.row(k).get(4) == number(2 * k + 9, 4)));
        // Memory is used again.
        let memory = kept.lines.as_ptr();
        kept.shape(5, 16);
        kept.set(15, 0, [1.0]);
        assert_eq!((kept.row(15).get(0), kept.lines.as_ptr()), (1.0, memory));
    }
}
