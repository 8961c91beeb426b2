//! Dyads that guide a body through poses: a crank with two pins, or a slider with a pin.
//!
//! A pin of the body is at z in the first pose and at `W_k = e_k z + s_k` in pose k, with e_k the rotation and s_k the
//! shift since the first. A crank about the fixed pivot g keeps its length. Theory (67):
//!
//! ```text
//! |W_k - g|^2 = |z - g|^2,    Re(conj(z) (conj(e_k) s_k + (1 - conj(e_k)) g))  =  Re(conj(s_k) g) - |s_k|^2 / 2
//! ```
//!
//! One equation per further pose, linear in g for a given z and in z for a given g. With `u = u0 z`, `v = u0 g`,
//! `s = conj(v) z` it is linear in eight homogeneous unknowns (68), and what remains is `u0 s = conj(v) u`: two
//! quadrics. Five equations leave a plane, in which two conics meet in four points: all the dyads of five poses.

use hardpoint::linalg::least_squares;

use hardpoint_search::singular;

use crate::plane::{Complex, Displacement};
use crate::polynomial::real_roots;

/// A dyad, in the first pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Dyad {
    /// A crank about a fixed pivot, with a pin on the body.
    Crank {
        /// Fixed pivot, m.
        pivot: Complex,
        /// Pin on the body, m.
        pin: Complex,
    },
    /// A slider on a fixed line through its pin on the body.
    Slider {
        /// Pin on the body, m.
        pin: Complex,
        /// Unit vector along the line.
        along: Complex,
    },
}

impl Dyad {
    /// Pin on the body in the first pose, m.
    pub fn pin(&self) -> Complex {
        match self {
            Self::Crank { pin, .. } | Self::Slider { pin, .. } => *pin,
        }
    }

    /// Largest change of its length, or distance from its line, over all poses, m.
    pub fn misfit(&self, moves: &[Displacement]) -> f64 {
        let of = |m: &Displacement| match *self {
            Self::Crank { pivot, pin } => (m.of(pin) - pivot).norm() - (pin - pivot).norm(),
            Self::Slider { pin, along } => along.cross(m.of(pin) - pin),
        };
        moves.iter().map(|m| of(m).abs()).fold(0.0, f64::max)
    }

    /// The dyad after a displacement with a change of length.
    pub fn moved(&self, by: impl Fn(Complex) -> Complex, turned: impl Fn(Complex) -> Complex) -> Self {
        match *self {
            Self::Crank { pivot, pin } => Self::Crank { pivot: by(pivot), pin: by(pin) },
            Self::Slider { pin, along } => Self::Slider { pin: by(pin), along: turned(along) },
        }
    }
}

/// Misfit of a dyad, relative to the size of the task, below which it passes all poses: round-off leaves less.
const EXACT: f64 = 1e-10;
/// Pins and pivots farther away than this, in sizes of the task, are those of a slider or a slot.
const FARTHEST: f64 = 1e4;
/// Cranks shorter than this, in sizes of the task, are poles.
const SHORTEST: f64 = 1e-6;
/// Dyads nearer than this to another, in sizes of the task, are the same.
const SAME: f64 = 1e-7;
/// Newton's steps of one dyad; three or four suffice.
const STEPS: usize = 30;
/// A singular value below this fraction of the largest is zero: poses are given with digits far beyond.
const RANK: f64 = 1e-9;
/// Part of the mean squared length of the projected axes of a space, above which an axis is taken for its basis.
const NEARLY: f64 = 0.7;

/// Cranks through the displacements, which are those of a task of size 1, whose pivots lie on the given lines
/// `normal . g = distance`: four with five poses and no line, or four poses and one line, those that are real.
pub fn cranks(moves: &[Displacement], lines: &[(Complex, f64)]) -> Vec<Dyad> {
    // u0, u.x, u.y, v.x, v.y, s.x, s.y, constant
    let row = |m: &Displacement| {
        let back = m.shift.conjugate() * m.turn;
        vec![
            m.shift.square(),
            2.0 * back.x,
            -2.0 * back.y,
            -2.0 * m.shift.x,
            -2.0 * m.shift.y,
            -2.0 * m.turn.x,
            2.0 * m.turn.y,
            1.0,
        ]
    };
    let mut rows: Vec<Vec<f64>> = moves.iter().map(row).collect();
    rows.extend(lines.iter().map(|(n, d)| vec![-d, 0.0, 0.0, n.x, n.y, 0.0, 0.0, 0.0]));
    let kernel = kernel(&rows, 8, 3);
    let part = |k: usize| kernel.iter().map(move |n| n[k]).collect::<Vec<f64>>();
    let [u0, ux, uy, vx, vy, sx, sy] = [0, 1, 2, 3, 4, 5, 6].map(part);
    // u0 s = conj(v) u, by its components
    let conics = [quadric(&[(&u0, &sx, 1.0), (&vx, &ux, -1.0), (&vy, &uy, -1.0)]), {
        quadric(&[(&u0, &sy, 1.0), (&vx, &uy, -1.0), (&vy, &ux, 1.0)])
    }];
    let mut found: Vec<Dyad> = Vec::new();
    for at in common_points(&conics) {
        let of = |k: usize| kernel.iter().zip(at).map(|(n, x)| n[k] * x).sum::<f64>();
        let per = 1.0 / of(0);
        let [pin, pivot] = [[1, 2], [3, 4]].map(|[x, y]| Complex::new(of(x) * per, of(y) * per));
        let Some(dyad) = polished(moves, lines, pivot, pin) else { continue };
        if !found.iter().any(|other| is_same(other, &dyad)) {
            found.push(dyad);
        }
    }
    found
}

/// Crank about a given pivot through three poses.
pub fn crank_about(moves: &[Displacement], pivot: Complex) -> Option<Dyad> {
    let rows: Vec<([f64; 2], f64)> = moves
        .iter()
        .map(|m| {
            let back = m.turn.conjugate();
            let a = back * m.shift + (Complex::new(1.0, 0.0) - back) * pivot;
            ([a.x, a.y], m.shift.dot(pivot) - 0.5 * m.shift.square())
        })
        .collect();
    let right = rows.iter().map(|r| r.1).collect();
    let solved = least_squares([rows.len(), 2], |r, c| rows[r].0[c], &[right]);
    usable(moves, pivot, Complex::new(solved[0][0], solved[0][1]))
}

/// Sliders through the displacements. Four poses have one, three a family, of which `samples` are returned, and five
/// have none unless they are special.
pub fn sliders(moves: &[Displacement], samples: usize) -> Vec<Dyad> {
    // The pin stays on a line with the normal n: Re(conj(n) (e_k z + s_k)) = c, with s = conj(n) z.
    let row = |m: &Displacement| vec![m.shift.x, m.shift.y, m.turn.x, -m.turn.y, -1.0];
    let rows: Vec<Vec<f64>> = moves.iter().map(row).collect();
    let least = 5_usize.saturating_sub(rows.len());
    let kernel = if least == 0 { exact_kernel(&rows, 5) } else { kernel(&rows, 5, least) };
    let of = |v: Vec<f64>| {
        let (normal, s) = (Complex::new(v[0], v[1]), Complex::new(v[2], v[3]));
        let length = normal.norm();
        let pin = s.over(normal.conjugate());
        let dyad = Dyad::Slider { pin, along: normal.left().times(1.0 / length) };
        let near = length.is_normal() && pin.norm() < FARTHEST;
        (near && dyad.misfit(moves) < EXACT * (1.0 + pin.norm())).then_some(dyad)
    };
    match &kernel[..] {
        [] => Vec::new(),
        [one] => of(one.clone()).into_iter().collect(),
        [a, b, ..] => {
            let mixed = |k: usize| {
                let turn = Complex::<f64>::unit(std::f64::consts::PI * (k as f64 + 0.5) / samples as f64);
                of(a.iter().zip(b).map(|(a, b)| turn.x * a + turn.y * b).collect())
            };
            (0..samples).filter_map(mixed).collect()
        }
    }
}

/// The `n` directions of `width` unknowns that the rows change least.
fn kernel(rows: &[Vec<f64>], width: usize, n: usize) -> Vec<Vec<f64>> {
    let found = singular(rows, width);
    canonical(&found.directions[width - n..], width)
}

/// Directions that the rows do not change.
fn exact_kernel(rows: &[Vec<f64>], width: usize) -> Vec<Vec<f64>> {
    let found = singular(rows, width);
    let zero = found.values.iter().position(|v| *v <= RANK * found.values[0]).unwrap_or(width);
    canonical(&found.directions[zero..], width)
}

/// Orthonormal basis of the space of another one, which depends on the space alone: round-off chooses among the
/// singular vectors of equal singular values. Each vector is the projection of an axis on what is left of the space.
fn canonical(basis: &[Vec<f64>], width: usize) -> Vec<Vec<f64>> {
    let mut projection: Vec<Vec<f64>> =
        (0..width).map(|i| (0..width).map(|j| basis.iter().map(|v| v[i] * v[j]).sum()).collect()).collect();
    let of = |left: usize| {
        // The squared lengths of the projected axes have the sum `left`. The first axis that is nearly as long as their
        // mean does not depend on round-off.
        let long = NEARLY * left as f64 / width as f64;
        let axis = (0..width).find(|k| projection[*k][*k] >= long).unwrap_or_default();
        let length = projection[axis][axis].sqrt();
        let vector: Vec<f64> = projection[axis].iter().map(|x| x / length).collect();
        for (row, x) in projection.iter_mut().zip(&vector) {
            row.iter_mut().zip(&vector).for_each(|(p, y)| *p -= x * y);
        }
        vector
    };
    (1..=basis.len()).rev().map(of).collect()
}

/// A conic of three homogeneous unknowns: coefficients of xx, yy, zz, yz, zx, xy.
type Conic = [f64; 6];

/// Sum of products of two linear forms.
fn quadric(terms: &[(&Vec<f64>, &Vec<f64>, f64)]) -> Conic {
    let both = |i: usize, j: usize| {
        let product = |(a, b, by): &(&Vec<f64>, &Vec<f64>, f64)| match i == j {
            true => by * a[i] * b[i],
            false => by * (a[i] * b[j] + a[j] * b[i]),
        };
        terms.iter().map(product).sum::<f64>()
    };
    [both(0, 0), both(1, 1), both(2, 2), both(1, 2), both(2, 0), both(0, 1)]
}

fn value(q: &Conic, [x, y, z]: [f64; 3]) -> f64 {
    q[0] * x * x + q[1] * y * y + q[2] * z * z + q[3] * y * z + q[4] * z * x + q[5] * x * y
}

/// A rotation of the unknowns without round numbers, after which common points of special conics are neither at
/// infinity nor above one another.
fn general(at: [f64; 3]) -> [f64; 3] {
    let turn = |a: f64, b: f64, by: f64| (a * by.cos() - b * by.sin(), a * by.sin() + b * by.cos());
    let [x, y, z] = at;
    let (x, y) = turn(x, y, 0.613);
    let (y, z) = turn(y, z, 1.127);
    let (x, y) = turn(x, y, -0.371);
    [x, y, z]
}

/// Real common points of two conics, at most four, as homogeneous unit vectors.
fn common_points(conics: &[Conic; 2]) -> Vec<[f64; 3]> {
    let turned = conics.each_ref().map(|q| {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(general);
        let both = |i: usize, j: usize| {
            let sum = [0, 1, 2].map(|k| axes[i][k] + axes[j][k]);
            value(q, sum) - value(q, axes[i]) - value(q, axes[j])
        };
        let own = |i: usize| value(q, axes[i]);
        let raw = [own(0), own(1), own(2), both(1, 2), both(2, 0), both(0, 1)];
        let largest = raw.iter().fold(f64::MIN_POSITIVE, |m, x| x.abs().max(m));
        raw.map(|x| x / largest)
    });
    // With z = 1 each is a y^2 + b(x) y + c(x), and y is common where
    //   (a1 c2 - a2 c1)^2 = (a1 b2 - a2 b1) (b1 c2 - b2 c1)
    let parts = turned.map(|q| (q[1], [q[3], q[5]], [q[2], q[4], q[0]]));
    let [(a1, b1, c1), (a2, b2, c2)] = parts;
    let ac: [f64; 3] = std::array::from_fn(|k| a1 * c2[k] - a2 * c1[k]);
    let ab: [f64; 2] = std::array::from_fn(|k| a1 * b2[k] - a2 * b1[k]);
    let mut bc = [0.0; 4];
    let mut resultant = [0.0; 5];
    for i in 0..2 {
        for j in 0..3 {
            bc[i + j] += b1[i] * c2[j] - b2[i] * c1[j];
        }
    }
    for i in 0..3 {
        for j in 0..3 {
            resultant[i + j] += ac[i] * ac[j];
        }
    }
    for i in 0..2 {
        for j in 0..4 {
            resultant[i + j] -= ab[i] * bc[j];
        }
    }
    let mut points = Vec::new();
    for x in real_roots(&resultant) {
        let at = |p: &[f64]| p.iter().rev().fold(0.0, |sum, c| sum * x + c);
        // y from the difference of the two, and from each of them, of which the best is taken
        let mut candidates = vec![-at(&ac) / at(&ab)];
        for (a, b, c) in [(a1, at(&b1), at(&c1)), (a2, at(&b2), at(&c2))] {
            let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
            let q = -0.5 * (b + root.copysign(b));
            candidates.extend([q / a, c / q]);
        }
        let misfit = |y: f64| turned.iter().map(|q| value(q, [x, y, 1.0]).abs()).sum::<f64>() / (1.0 + y * y);
        let best =
            candidates.into_iter().filter(|y| y.is_finite()).min_by(|a, b| misfit(*a).total_cmp(&misfit(*b)));
        let Some(y) = best else { continue };
        let back = {
            // The rotation is orthogonal: the point in the unknowns before is the sum of the turned axes.
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(general);
            [0, 1, 2].map(|k| axes[0][k] * x + axes[1][k] * y + axes[2][k])
        };
        points.push(back);
    }
    points
}

/// Newton's method for the equations of the crank; `None` if it does not end at a crank through all poses.
fn polished(
    moves: &[Displacement],
    lines: &[(Complex, f64)],
    mut pivot: Complex,
    mut pin: Complex,
) -> Option<Dyad> {
    let one = Complex::new(1.0, 0.0);
    for _ in 0..STEPS {
        if !(pivot.norm() < FARTHEST && pin.norm() < FARTHEST) {
            return None;
        }
        let mut rows: Vec<[f64; 4]> = Vec::new();
        let mut right = Vec::new();
        for m in moves {
            let back = m.turn.conjugate();
            // d/dz and d/dg of Re(conj(z) (conj(e) s + (1 - conj(e)) g)) - Re(conj(s) g) + |s|^2 / 2
            let by_pin = back * m.shift + (one - back) * pivot;
            let by_pivot = (one - m.turn) * pin - m.shift;
            rows.push([by_pin.x, by_pin.y, by_pivot.x, by_pivot.y]);
            right.push(m.shift.dot(pivot) - 0.5 * m.shift.square() - pin.dot(by_pin));
        }
        for (n, d) in lines {
            rows.push([0.0, 0.0, n.x, n.y]);
            right.push(d - n.dot(pivot));
        }
        let step = &least_squares([rows.len(), 4], |r, c| rows[r][c], &[right])[0];
        pin = pin + Complex::new(step[0], step[1]);
        pivot = pivot + Complex::new(step[2], step[3]);
        let far = step.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if far <= 4.0 * f64::EPSILON * (1.0 + pin.norm() + pivot.norm()) {
            break;
        }
    }
    usable(moves, pivot, pin)
}

/// The crank, if it passes all poses, has a length, and is near.
fn usable(moves: &[Displacement], pivot: Complex, pin: Complex) -> Option<Dyad> {
    let dyad = Dyad::Crank { pivot, pin };
    let reach = 1.0 + pin.norm() + pivot.norm();
    let is_near = reach < FARTHEST && (pin - pivot).norm() > SHORTEST;
    (is_near && dyad.misfit(moves) < EXACT * reach).then_some(dyad)
}

fn is_same(a: &Dyad, b: &Dyad) -> bool {
    match (a, b) {
        (Dyad::Crank { pivot: p, pin: z }, Dyad::Crank { pivot: q, pin: w }) => {
            (*p - *q).norm() + (*z - *w).norm() < SAME * (1.0 + p.norm() + z.norm())
        }
        (Dyad::Slider { pin: z, along: n }, Dyad::Slider { pin: w, along: m }) => {
            (*z - *w).norm() + n.cross(*m).abs() < SAME * (1.0 + z.norm())
        }
        (Dyad::Crank { .. }, Dyad::Slider { .. }) | (Dyad::Slider { .. }, Dyad::Crank { .. }) => false,
    }
}
