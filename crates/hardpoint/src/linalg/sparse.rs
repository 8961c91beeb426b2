//! Sparse factors of a large block: the order of elimination is chosen once, then straight loops run over index lists.

use std::ops::Range;

use crate::number::{self, Function, Real};

use super::matrix::{Factored, MOST_GROWTH, Watched};

/// Minimum size of a pivot relative to the largest remaining entry of its column. The entries of L are then at most 2,
/// and a change of the values may double them before [`MOST_GROWTH`] requires another order. With 0.9, chains of
/// scissors have a tenth more fill, and no better accuracy.
const IN_COLUMN: f64 = 0.5;
/// Minimum size of a pivot relative to the largest remaining entry of its row: a small pivot is not chosen while a
/// large one is available.
const IN_ROW: f64 = 0.1;
/// Number of the shortest rows and columns searched for a pivot; a longer search reduces fill very little, and takes
/// more time.
const LOOKED_AT: usize = 4;
/// Number of pivots multiplied before the logarithm is taken: each may change by a factor of 2^30 after the order was
/// chosen.
const MULTIPLIED: usize = 32;
/// No row or column.
const NONE: u32 = u32::MAX;

/// LU factors of a sparse square matrix with a fixed pattern.
///
/// With rows and columns in pivot order, `A = L U`, `l_ii = 1`. Row by row,
///
/// ```text
/// l_ik = (a_ik - sum l_im u_mk) / u_kk    m < k,    for k < i
/// u_ij =  a_ij - sum l_im u_mj            m < i,    for j >= i
/// ```
///
/// over the entries of the pattern. The order is chosen by the values of the first factorisation ([`Choice`]) and
/// monitored by the size of the factors: it hardly ever changes from one step to the next. Until it does, nothing is
/// allocated.
#[derive(Clone, Debug)]
pub(crate) struct SparseLu<T> {
    /// By row: the columns of its entries, in the order in which they are filled.
    columns: Lists,
    /// Entries in this order, and their positions in pivot order.
    values: Vec<T>,
    places: Vec<u32>,
    order: Order,
    /// l_ik, u_ij without the diagonal, and 1 / u_ii.
    lower: Vec<T>,
    upper: Vec<T>,
    inverse: Vec<T>,
    /// One row, by column; zero between rows.
    work: Vec<T>,
}

/// The order of elimination, and the pattern of its factors.
#[derive(Clone, Debug, Default)]
struct Order {
    /// Rows and columns of the pivots; empty if the matrix was singular.
    rows: Vec<u32>,
    columns: Vec<u32>,
    /// True if the two permutations together are even.
    even: bool,
    /// By pivot: the k of its l_ik, and the j of its u_ij, in ascending order.
    lower: Lists,
    upper: Lists,
    /// By pivot: a power of two that scales it to about 1 at the time the order was chosen; and the logarithm of the
    /// product of the scales removed.
    units: Vec<f64>,
    logarithm: f64,
}

/// Lists stored one after another.
#[derive(Clone, Debug, Default)]
struct Lists {
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Lists {
    fn of(lists: impl Iterator<Item = Vec<u32>>) -> Self {
        let mut this = Self { starts: vec![0], items: Vec::new() };
        for list in lists {
            this.items.extend(list);
            this.starts.push(this.items.len());
        }
        this
    }

    /// By item below n: the lists that contain it, in ascending order.
    fn transposed(&self, n: usize) -> Self {
        let mut starts = vec![0; n + 1];
        self.items.iter().for_each(|&item| starts[item as usize + 1] += 1);
        (0..n).for_each(|k| starts[k + 1] += starts[k]);
        let (mut next, mut items) = (starts.clone(), vec![0; self.items.len()]);
        for k in 0..self.starts.len() - 1 {
            for &item in &self.items[self.range(k)] {
                items[next[item as usize]] = index(k);
                next[item as usize] += 1;
            }
        }
        Self { starts, items }
    }

    /// Range of list k.
    #[inline(always)]
    fn range(&self, k: usize) -> Range<usize> {
        self.starts[k]..self.starts[k + 1]
    }

    /// The items of list k, each with its number.
    #[inline(always)]
    fn with<'a, T: Copy>(&'a self, k: usize, numbers: &'a [T]) -> impl Iterator<Item = (usize, T)> {
        let range = self.range(k);
        self.items[range.clone()].iter().zip(&numbers[range]).map(
            #[inline(always)]
            |(&item, &x)| (item as usize, x),
        )
    }
}

impl<T: Real> SparseLu<T> {
    /// Factors of the n x n matrix with entries in these columns of its rows, each column at most once.
    pub fn new(rows: &[Vec<usize>]) -> Self {
        let columns = Lists::of(rows.iter().map(|row| row.iter().map(|&c| index(c)).collect()));
        let zero = T::zero();
        Self {
            values: vec![zero; columns.items.len()],
            places: vec![0; columns.items.len()],
            columns,
            order: Order::default(),
            lower: Vec::new(),
            upper: Vec::new(),
            inverse: vec![zero; rows.len()],
            work: vec![zero; rows.len()],
        }
    }

    /// Fills row r with its entries, in the order of the columns given to [`SparseLu::new`].
    #[inline(always)]
    pub fn set_row(&mut self, r: usize, entries: impl Iterator<Item = T>) {
        for (to, x) in self.values[self.columns.range(r)].iter_mut().zip(entries) {
            *to = x;
        }
    }

    /// Factorises the matrix of the present rows.
    #[inline(never)]
    pub fn factor(&mut self) -> Factored<T> {
        if self.is_ordered() {
            let found = self.eliminate();
            // NaN also selects the order again.
            if found.watched.growth.decisive() <= MOST_GROWTH {
                return found;
            }
        }
        self.choose_order();
        if self.is_ordered() {
            return self.eliminate();
        }
        let determinant = T::constant(f64::NEG_INFINITY);
        Factored { pivot_ratio: 0.0, positive: true, determinant, watched: Watched::zero() }
    }

    /// Number of multiplications of a factorisation in the present order.
    pub fn multiplications(&self) -> usize {
        let Order { lower, upper, .. } = &self.order;
        lower.items.iter().map(|&k| upper.range(k as usize).len()).sum()
    }

    fn is_ordered(&self) -> bool {
        self.order.rows.len() == self.inverse.len()
    }

    /// Eliminates in the present order.
    fn eliminate(&mut self) -> Factored<T> {
        let (zero, one) = (T::zero(), T::one());
        let Order { rows, even, lower, upper, units, .. } = &self.order;
        let n = rows.len();
        let (work, inverse) = (&mut self.work[..n], &mut self.inverse[..n]);
        let mut logarithm = T::constant(self.order.logarithm);
        // Sign of the determinant, product of some pivots, largest pivot, largest inverse, largest factor.
        let (mut sign, mut product, mut most, mut least, mut growth) = (one, one, zero, zero, zero);
        for i in 0..n {
            let row = self.columns.range(rows[i] as usize);
            for (&place, &x) in self.places[row.clone()].iter().zip(&self.values[row]) {
                work[place as usize] = x;
            }
            for at in lower.range(i) {
                let k = lower.items[at] as usize;
                // l_ik = (row i so far)_k / u_kk; then row i <- row i - l_ik u_k
                let l = work[k] * inverse[k];
                (self.lower[at], work[k]) = (l, zero);
                growth = growth.larger(l.abs());
                for (j, u) in upper.with(k, &self.upper) {
                    work[j] = (-l).times_plus(u, work[j]);
                }
            }
            for at in upper.range(i) {
                let j = upper.items[at] as usize;
                (self.upper[at], work[j]) = (work[j], zero);
            }
            let pivot = work[i];
            (inverse[i], work[i]) = (one / pivot, zero);
            most = most.larger(pivot.abs());
            least = least.larger(inverse[i].abs());
            // abs(det) = prod abs(u_ii) = e^logarithm prod abs(u_ii units_i), with factors of about 1, so that no
            // product overflows or underflows
            product = product * (pivot * units[i]);
            if i % MULTIPLIED == MULTIPLIED - 1 || i + 1 == n {
                let size = product.abs();
                logarithm += size.map(Function::Ln);
                // NaN, which a pivot of zero produces, has no sign either.
                (sign, product) = (sign * (product / size), one);
            }
        }
        let watched = Watched { product: sign, most, least, growth };
        let (pivot_ratio, positive) = if n == 0 { (1.0, *even) } else { watched.verdict() };
        Factored { pivot_ratio, positive: positive == *even, determinant: logarithm, watched }
    }

    /// Chooses the pivot order by the present values.
    #[inline(never)]
    fn choose_order(&mut self) {
        let (n, zero) = (self.inverse.len(), T::zero());
        let row = |r| self.columns.with(r, &self.values).map(|(c, x)| (index(c), x.decisive())).collect();
        let Some(Choice { pivots, below, beside, .. }) = Choice::of((0..n).map(row).collect()) else {
            self.order = Order::default();
            return;
        };
        let (rows, columns): (Vec<u32>, Vec<u32>) = pivots.iter().map(|p| (p.row, p.column)).unzip();
        let [row_places, column_places] = number::both([&rows, &columns], |order| inverse(order));
        for (to, &c) in self.places.iter_mut().zip(&self.columns.items) {
            *to = column_places[c as usize];
        }
        let placed = |lists: Vec<Vec<u32>>, places: &[u32]| {
            Lists::of(lists.into_iter().map(|list| list.into_iter().map(|k| places[k as usize]).collect()))
        };
        let lower = placed(below, &row_places).transposed(n);
        // Transposing twice sorts the lists in ascending order.
        let upper = placed(beside, &column_places).transposed(n).transposed(n);
        (self.lower, self.upper) = (vec![zero; lower.items.len()], vec![zero; upper.items.len()]);
        // units_i = 2^-round(log2 abs(u_ii)),    logarithm = sum round(log2 abs(u_ii)) ln 2
        let exponents = || pivots.iter().map(|p| p.size.log2().round());
        self.order = Order {
            even: is_odd(&rows) == is_odd(&columns),
            units: exponents().map(|e| (-e).exp2()).collect(),
            logarithm: exponents().sum::<f64>() * std::f64::consts::LN_2,
            rows,
            columns,
            lower,
            upper,
        };
    }

    /// Replaces the right-hand side by the solution, NaN if there is none.
    #[inline(never)]
    pub fn solve(&mut self, b: &mut [T]) {
        if !self.is_ordered() {
            return b[..self.inverse.len()].fill(T::constant(f64::NAN));
        }
        let Order { rows, columns, lower, upper, .. } = &self.order;
        let x = &mut self.work[..rows.len()];
        for i in 0..rows.len() {
            // L y = P b
            let mut s = b[rows[i] as usize];
            for (k, l) in lower.with(i, &self.lower) {
                s = (-l).times_plus(x[k], s);
            }
            x[i] = s;
        }
        for i in (0..rows.len()).rev() {
            // U z = y, x = Q z
            let mut s = x[i];
            for (j, u) in upper.with(i, &self.upper) {
                s = (-u).times_plus(x[j], s);
            }
            x[i] = s * self.inverse[i];
        }
        for (&c, x) in columns.iter().zip(x) {
            (b[c as usize], *x) = (*x, T::zero());
        }
    }

    /// Replaces the right-hand side by the solution with the transposed matrix, NaN if there is none.
    ///
    /// With `P A Q = L U`: `U^T y = Q^T b`, `L^T z = y`, `P x = z`.
    #[inline(never)]
    pub fn solve_transposed(&mut self, b: &mut [T]) {
        if !self.is_ordered() {
            return b[..self.inverse.len()].fill(T::constant(f64::NAN));
        }
        let Order { rows, columns, lower, upper, .. } = &self.order;
        let x = &mut self.work[..rows.len()];
        for (&c, x) in columns.iter().zip(&mut *x) {
            *x = b[c as usize];
        }
        for i in 0..rows.len() {
            // U^T y = Q^T b
            let s = x[i] * self.inverse[i];
            x[i] = s;
            for (j, u) in upper.with(i, &self.upper) {
                x[j] = (-u).times_plus(s, x[j]);
            }
        }
        for i in (0..rows.len()).rev() {
            let s = x[i];
            // L^T z = y likewise, from the last pivot on, and x = P^T z
            for (k, l) in lower.with(i, &self.lower) {
                x[k] = (-l).times_plus(s, x[k]);
            }
        }
        for (&r, x) in rows.iter().zip(x) {
            (b[r as usize], *x) = (*x, T::zero());
        }
    }
}

/// Row or column number as stored in lists.
fn index(k: usize) -> u32 {
    u32::try_from(k).expect("a block has fewer unknowns than 2^32")
}

/// Inverse of a permutation.
fn inverse(permutation: &[u32]) -> Vec<u32> {
    let mut inverse = vec![0; permutation.len()];
    for (k, &item) in permutation.iter().enumerate() {
        inverse[item as usize] = index(k);
    }
    inverse
}

/// True if a permutation is odd: each cycle of even length flips the parity.
fn is_odd(permutation: &[u32]) -> bool {
    let mut seen = vec![false; permutation.len()];
    let mut odd = false;
    for start in 0..permutation.len() {
        let mut at = start;
        while !seen[at] {
            seen[at] = true;
            at = permutation[at] as usize;
            // The return to the start of the cycle is not an exchange.
            odd ^= at != start;
        }
    }
    odd
}

/// Choice of the pivot order: each pivot is one that causes little fill (Markowitz's rule: the number of other entries
/// in its row times that in its column) among those that are large enough in both.
///
/// Entries that happen to be zero remain in the pattern, since other values may appear there.
struct Choice {
    /// Remaining rows: column and value of their entries.
    rows: Vec<Vec<(u32, f64)>>,
    /// By column: the rows with an entry in it.
    columns: Vec<Vec<u32>>,
    /// Rows and columns by their number of entries.
    short_rows: ByLength,
    short_columns: ByLength,
    /// By column: the largest entry; negative if it must be found again.
    largest: Vec<f64>,
    /// Positions of the entries of the current row, by column; out of date for all other columns.
    places: Vec<u32>,
    pivots: Vec<Pivot>,
    /// By pivot: the rows below it with an entry in its column, and the other columns of its row.
    below: Vec<Vec<u32>>,
    beside: Vec<Vec<u32>>,
}

/// An entry chosen as a pivot.
#[derive(Clone, Copy)]
struct Pivot {
    row: u32,
    column: u32,
    size: f64,
    /// Maximum number of entries that it may fill.
    cost: usize,
}

impl Choice {
    /// Chooses the order for a matrix with these rows; `None` if it is singular or not finite.
    fn of(rows: Vec<Vec<(u32, f64)>>) -> Option<Self> {
        let n = rows.len();
        let by_row = Lists::of(rows.iter().map(|row| row.iter().map(|e| e.0).collect()));
        let by_column = by_row.transposed(n);
        let columns: Vec<Vec<u32>> = (0..n).map(|c| by_column.items[by_column.range(c)].to_vec()).collect();
        let mut this = Self {
            short_rows: ByLength::new(rows.iter().map(Vec::len)),
            short_columns: ByLength::new(columns.iter().map(Vec::len)),
            rows,
            columns,
            largest: vec![-1.0; n],
            places: vec![NONE; n],
            pivots: Vec::with_capacity(n),
            below: Vec::with_capacity(n),
            beside: Vec::with_capacity(n),
        };
        for _ in 0..n {
            let pivot = this.next()?;
            this.eliminate(pivot);
        }
        Some(this)
    }

    /// Returns the next pivot. The largest of all entries would always qualify, so if no pivot is found, only zeros and
    /// NaN are left.
    fn next(&mut self) -> Option<Pivot> {
        let mut best: Option<Pivot> = None;
        let mut looked_at = 0;
        for length in 1..=self.rows.len() {
            // Longer rows and columns cost at least this, whatever they cross.
            // (r - 1) (c - 1) >= (length - 1) (crossed - 1) for r >= length, c >= crossed
            let is_least = |best: &Pivot, crossed: usize| best.cost <= (length - 1) * (crossed - 1);
            if best.is_some_and(|best| is_least(&best, length)) {
                break;
            }
            let mut c = self.short_columns.first[length];
            while c != NONE {
                for k in 0..length {
                    self.consider(self.columns[c as usize][k], c, &mut best);
                }
                looked_at += 1;
                if best.is_some() && looked_at >= LOOKED_AT {
                    return best;
                }
                c = self.short_columns.next[c as usize];
            }
            if best.is_some_and(|best| is_least(&best, length + 1)) {
                break;
            }
            let mut r = self.short_rows.first[length];
            while r != NONE {
                for k in 0..length {
                    self.consider(r, self.rows[r as usize][k].0, &mut best);
                }
                looked_at += 1;
                if best.is_some() && looked_at >= LOOKED_AT {
                    return best;
                }
                r = self.short_rows.next[r as usize];
            }
        }
        best
    }

    /// Makes this entry the best pivot if it is cheaper, and large enough.
    fn consider(&mut self, row: u32, column: u32, best: &mut Option<Pivot>) {
        // Markowitz: (entries of the row - 1) (entries of the column - 1), the maximum fill of this pivot
        let cost = (self.rows[row as usize].len() - 1) * (self.columns[column as usize].len() - 1);
        if best.is_some_and(|best| cost >= best.cost) {
            return;
        }
        let size = self.size(row, column);
        // NaN is never a pivot.
        // abs(l) <= 1 / IN_COLUMN = 2
        if !(size > 0.0 && size >= IN_COLUMN * self.largest(column)) {
            return;
        }
        let in_row = self.rows[row as usize].iter().fold(0.0, |most: f64, e| most.max(e.1.abs()));
        if size >= IN_ROW * in_row {
            *best = Some(Pivot { row, column, size, cost });
        }
    }

    fn size(&self, r: u32, c: u32) -> f64 {
        self.rows[r as usize].iter().find(|e| e.0 == c).map_or(0.0, |e| e.1.abs())
    }

    /// Largest entry of a column.
    fn largest(&mut self, c: u32) -> f64 {
        if self.largest[c as usize] < 0.0 {
            let rows = self.columns[c as usize].iter();
            self.largest[c as usize] = rows.fold(0.0, |most, &r| most.max(self.size(r, c)));
        }
        self.largest[c as usize]
    }

    /// Eliminates the pivot's column from all remaining rows, with its row.
    fn eliminate(&mut self, pivot: Pivot) {
        let Pivot { row: r, column: c, .. } = pivot;
        let mut pivot_row = std::mem::take(&mut self.rows[r as usize]);
        let at = place_of(&pivot_row, |e| e.0 == c);
        let inverse = 1.0 / pivot_row.swap_remove(at).1;
        self.short_rows.take(r);
        self.short_columns.take(c);
        for &(j, _) in &pivot_row {
            let column = &mut self.columns[j as usize];
            column.swap_remove(place_of(column, |other| *other == r));
            self.short_columns.take(j);
            self.largest[j as usize] = -1.0;
        }
        let mut below = std::mem::take(&mut self.columns[c as usize]);
        below.swap_remove(place_of(&below, |other| *other == r));
        for &i in &below {
            self.short_rows.take(i);
            let row = &mut self.rows[i as usize];
            let at = place_of(row, |e| e.0 == c);
            let factor = row.swap_remove(at).1 * inverse;
            for (at, e) in row.iter().enumerate() {
                self.places[e.0 as usize] = index(at);
            }
            for &(j, x) in &pivot_row {
                let at = self.places[j as usize] as usize;
                match row.get_mut(at) {
                    Some(e) if e.0 == j => e.1 -= factor * x,
                    _ => {
                        row.push((j, -factor * x));
                        self.columns[j as usize].push(i);
                    }
                }
            }
            self.short_rows.put(i, row.len());
        }
        for &(j, _) in &pivot_row {
            self.short_columns.put(j, self.columns[j as usize].len());
        }
        self.pivots.push(pivot);
        self.below.push(below);
        self.beside.push(pivot_row.into_iter().map(|e| e.0).collect());
    }
}

fn place_of<E>(entries: &[E], is_it: impl Fn(&E) -> bool) -> usize {
    entries.iter().position(is_it).expect("rows and columns list the same entries")
}

/// Rows or columns by their number of entries: a doubly linked list for each length.
struct ByLength {
    first: Vec<u32>,
    next: Vec<u32>,
    before: Vec<u32>,
    length: Vec<usize>,
}

impl ByLength {
    fn new(lengths: impl DoubleEndedIterator<Item = usize> + ExactSizeIterator) -> Self {
        let n = lengths.len();
        let none = vec![NONE; n];
        let mut this =
            Self { first: vec![NONE; n + 1], next: none.clone(), before: none, length: vec![0; n] };
        for (k, length) in lengths.enumerate().rev() {
            this.put(index(k), length);
        }
        this
    }

    /// Inserts row k at the head of the list of this length.
    fn put(&mut self, k: u32, length: usize) {
        let next = std::mem::replace(&mut self.first[length], k);
        let at = k as usize;
        (self.length[at], self.next[at], self.before[at]) = (length, next, NONE);
        if next != NONE {
            self.before[next as usize] = k;
        }
    }

    /// Removes row k.
    fn take(&mut self, k: u32) {
        let (before, next) = (self.before[k as usize], self.next[k as usize]);
        match before {
            NONE => self.first[self.length[k as usize]] = next,
            _ => self.next[before as usize] = next,
        }
        if next != NONE {
            self.before[next as usize] = before;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::linalg::Elimination;

    /// Column and value of the entries of each row.
    type Rows = Vec<Vec<(usize, f64)>>;

    fn filled(rows: &Rows) -> SparseLu<f64> {
        let columns: Vec<Vec<usize>> = rows.iter().map(|row| row.iter().map(|e| e.0).collect()).collect();
        let mut lu = SparseLu::new(&columns);
        fill(&mut lu, rows);
        lu
    }

    fn fill(lu: &mut SparseLu<f64>, rows: &Rows) {
        rows.iter().enumerate().for_each(|(r, row)| lu.set_row(r, row.iter().map(|e| e.1)));
    }

    fn dense(rows: &Rows) -> Elimination<f64> {
        let mut lu = Elimination::new(rows.len());
        for (r, row) in rows.iter().enumerate() {
            row.iter().for_each(|&(c, x)| lu.row_mut(r)[c] = x);
        }
        lu
    }

    /// Relative residuals of x: over all equations, relative to the magnitude that the sum of such an equation can
    /// have; and of the worst equation, relative to its own terms.
    fn residual(rows: &Rows, x: &[f64], b: &[f64]) -> [f64; 2] {
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(f64::abs).fold(0.0, Real::larger);
        let terms = |row: &Vec<(usize, f64)>| row.iter().map(|&(c, a)| a * x[c]).collect::<Vec<_>>();
        let missed = |(row, b): (&Vec<(usize, f64)>, &f64)| terms(row).iter().sum::<f64>() - b;
        let most = largest(&mut rows.iter().flatten().map(|e| e.1)) * largest(&mut x.iter().copied());
        let each = rows
            .iter()
            .zip(b)
            .map(|(row, b)| missed((row, b)) / (terms(row).iter().map(|x| x.abs()).sum::<f64>() + b.abs()));
        let all = largest(&mut rows.iter().zip(b).map(missed)) / (most + largest(&mut b.iter().copied()));
        [all, largest(&mut each.into_iter())]
    }

    fn transposed(rows: &Rows) -> Rows {
        let mut out = vec![Vec::new(); rows.len()];
        for (r, row) in rows.iter().enumerate() {
            row.iter().for_each(|&(c, x)| out[c].push((r, x)));
        }
        out
    }

    /// The larger residuals of a solution and of one with the transposed matrix.
    fn residuals(lu: &mut SparseLu<f64>, rows: &Rows) -> [f64; 2] {
        let b: Vec<f64> = (0..rows.len()).map(|r| (1.0 + r as f64).cos()).collect();
        let [mut x, mut y] = [b.clone(), b.clone()];
        lu.solve(&mut x);
        lu.solve_transposed(&mut y);
        let (found, transposed) = (residual(rows, &x, &b), residual(&transposed(rows), &y, &b));
        std::array::from_fn(|k| found[k].larger(transposed[k]))
    }

    /// Row r: a band, two far entries, and a weak diagonal.
    fn row(r: usize, n: usize, seed: f64) -> Vec<(usize, f64)> {
        let x = |c: usize| (1.0 + seed + (r * 7 + c * 13) as f64).sin();
        let mut columns = vec![(r + 1) % n, r, (r + 5) % n, (r * r + 3) % n];
        columns.sort_unstable();
        columns.dedup();
        columns.rotate_left(1); // rows need not be sorted
        columns.into_iter().map(|c| (c, if c == r { 1e-3 * x(c) } else { 2.0 * x(c) })).collect()
    }

    #[test]
    fn sparse_and_dense_factors_agree_in_solution_and_determinant() {
        for n in [1, 2, 3, 10, 41, 42, 43, 44, 120] {
            for seed in [0.0, 1.0, 5.0] {
                let rows: Rows = (0..n).map(|r| row(r, n, seed)).collect();
                let (mut sparse, mut dense) = (filled(&rows), dense(&rows));
                let (found, want) = (sparse.factor(), dense.factor());
                assert_eq!(found.positive, want.positive, "n {n}, seed {seed}");
                assert!((found.determinant - want.determinant.ln()).abs() < 1e-9, "n {n}, seed {seed}");
                let b: Vec<f64> = (0..n).map(|r| (r as f64).cos()).collect();
                let same = |a: &[f64], b: &[f64]| {
                    let scale = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9 * scale)
                };
                let (mut found, mut want) = (b.clone(), b.clone());
                sparse.solve(&mut found);
                dense.solve(&mut want);
                assert!(same(&found, &want), "n {n}, seed {seed}");
                let (mut found, mut want) = (b.clone(), b);
                sparse.solve_transposed(&mut found);
                dense.solve_transposed(&mut want);
                assert!(same(&found, &want), "n {n}, seed {seed}, transposed");
            }
        }
    }

    /// A matrix that changes from step to step: entries at the places of a permutation and some more, with rows and
    /// columns scaled by up to 10^6 in either direction.
    fn changing() -> impl Strategy<Value = Vec<Rows>> {
        (1_usize..40).prop_flat_map(|n| {
            let order = Just((0..n).collect::<Vec<_>>()).prop_shuffle();
            let more = prop::collection::vec((0..n, 0..n), 0..3 * n);
            let exponents = || prop::collection::vec(-6.0..6.0_f64, n);
            let phases = prop::collection::vec(1_u16..10_000, 4 * n);
            let speed = 0.0..0.5_f64;
            let all = (order, more, exponents(), exponents(), phases, speed);
            all.prop_map(move |(order, more, rows, columns, phases, speed)| {
                let mut places: Vec<(usize, usize)> = order.into_iter().enumerate().chain(more).collect();
                places.sort_unstable();
                places.dedup();
                let step = |k: usize| {
                    let mut out = vec![Vec::new(); n];
                    for (e, &(r, c)) in places.iter().enumerate() {
                        let phase = f64::from(phases[e]) + speed * (k * (1 + e % 7)) as f64;
                        out[r].push((c, phase.sin() * 10_f64.powf(rows[r] + columns[c])));
                    }
                    out
                };
                (0..8).map(step).collect()
            })
        })
    }

    proptest! {
        #[test]
        fn equations_are_solved_whatever_the_pattern_the_scales_and_the_changes(steps in changing()) {
            let mut kept = filled(&steps[0]);
            for rows in &steps {
                fill(&mut kept, rows);
                let mut anew = filled(rows);
                let (found, want) = (kept.factor(), anew.factor());
                // Equal rows may occur.
                if found.pivot_ratio == 0.0 {
                    continue;
                }
                prop_assert!(found.watched.growth <= MOST_GROWTH);
                let [all, each] = residuals(&mut kept, rows);
                prop_assert!(all < 1e-14, "{all:e}");
                if found.pivot_ratio > 1e-6 {
                    prop_assert!(each < 1e-12, "{each:e}");
                    prop_assert_eq!(found.positive, want.positive);
                    let (now, then) = (found.determinant, want.determinant);
                    prop_assert!((now - then).abs() < 1e-8, "{} {}", now, then);
                }
            }
        }
    }

    #[test]
    fn another_order_is_chosen_when_a_pivot_vanishes_and_nothing_is_allocated_until_then() {
        let rows = |a: f64| vec![vec![(0, a), (1, 1.0)], vec![(0, 1.0), (1, a)]];
        let mut lu = filled(&rows(1.5));
        assert!((lu.factor().determinant - 1.25_f64.ln()).abs() < 1e-15);
        let order = |lu: &SparseLu<f64>| (lu.order.rows.clone(), lu.order.columns.clone());
        let first = order(&lu);
        let later = [1.4, 0.3, 0.9].map(|a| (a, rows(a)));
        let steps = allocation_counter::measure(|| {
            for (a, rows) in &later {
                fill(&mut lu, rows);
                let found = lu.factor();
                assert!((found.determinant - (1.0 - a * a).abs().ln()).abs() < 1e-14, "{a}");
                assert_eq!(found.positive, *a > 1.0);
                let mut b = [1.0 + a; 2];
                lu.solve(&mut b);
                assert!(b.iter().all(|x| (x - 1.0).abs() < 1e-14), "{b:?}");
            }
        });
        assert_eq!((steps.count_total, order(&lu)), (0, first.clone()));
        fill(&mut lu, &rows(0.0));
        let found = lu.factor();
        assert!(found.pivot_ratio == 1.0 && !found.positive && found.determinant == 0.0);
        assert_ne!(order(&lu), first);
    }

    #[test]
    fn singular_and_not_finite_matrices_are_found_out() {
        let columns = vec![vec![0, 1], vec![0, 1]];
        let mut lu = SparseLu::new(&columns);
        let nan = f64::NAN;
        for (values, good) in [
            ([1.0, 2.0, 2.0, 4.0], false),
            ([1.0, 2.0, 2.0, 5.0], true),
            ([nan; 4], false),
            ([1.0, nan, 2.0, 5.0], false),
            ([1.0, 2.0, 2.0, f64::INFINITY], false),
            ([0.0; 4], false),
            ([0.0, 2.0, 2.0, 0.0], true),
        ] {
            lu.set_row(0, values[..2].iter().copied());
            lu.set_row(1, values[2..].iter().copied());
            assert_eq!(lu.factor().pivot_ratio > 1e-12, good, "{values:?}");
            let mut b = [1.0, 1.0];
            lu.solve(&mut b);
            assert!(!good || b.iter().all(|x| x.is_finite()), "{values:?}");
        }
        // An empty column.
        let mut lu = filled(&vec![vec![(0, 1.0)], vec![(0, 2.0)]]);
        assert_eq!(lu.factor().pivot_ratio, 0.0);
        let mut nothing = filled(&Vec::new());
        let found = nothing.factor();
        assert!(found.pivot_ratio == 1.0 && found.positive && found.determinant == 0.0);
    }

    #[test]
    fn factors_of_bands_grids_and_arrows_have_hardly_more_entries() {
        let count = |rows: Rows| {
            let mut lu = filled(&rows);
            assert!(lu.factor().pivot_ratio > 1e-6);
            lu.lower.len() + lu.upper.len() + rows.len()
        };
        let x = |r: usize, c: usize| (1.0 + (r * r * 31 + c * c * 17 + r * c) as f64).sin();
        let band =
            |n: usize| (0..n).map(|r| (r.max(3) - 3..n.min(r + 4)).map(|c| (c, x(r, c))).collect()).collect();
        assert!(count(band(1000)) < 9000, "{} of 7000", count(band(1000)));
        let arrow = (0..200)
            .map(|r| if r == 0 { (0..200).map(|c| (c, 1.0)).collect() } else { vec![(0, 1.0), (r, 2.0)] });
        assert_eq!(count(arrow.collect()), 598);
        let n = 40_usize;
        let cell = |k: usize| {
            let mut row = vec![(k, 4.0)];
            let (i, j) = (k / n, k % n);
            let beside = [
                (i > 0, k.wrapping_sub(n)),
                (i + 1 < n, k + n),
                (j > 0, k.wrapping_sub(1)),
                (j + 1 < n, k + 1),
            ];
            row.extend(beside.into_iter().filter(|b| b.0).map(|b| (b.1, x(k, b.1))));
            row
        };
        let grid = count((0..n * n).map(cell).collect());
        assert!(grid < 45_000, "{grid}");
    }
}
