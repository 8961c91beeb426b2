//! Programs of kernels like those of mechanisms: written for space, run for planar motion.

use std::array::from_fn;

use hardpoint_tape::{Interpreter, Kinds, Number, Options, WIDE, record};

use crate::random::Random;
use crate::real::Real;

type Vector<T> = [T; 3];
type Matrix<T> = [Vector<T>; 3];

fn sum<T: Real>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    from_fn(|i| a[i] + b[i])
}

fn dot<T: Real>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn turned<T: Real>(m: Matrix<T>, v: Vector<T>) -> Vector<T> {
    m.map(|row| dot(row, v))
}

/// The rotation about a unit axis: `c I + s [axis] + (1 - c) axis axis^T`.
fn rotation<T: Real>(axis: Vector<T>, s: T, c: T) -> Matrix<T> {
    let [zero, one] = [0.0, 1.0].map(T::constant);
    let [x, y, z] = axis;
    let cross = [[zero, -z, y], [z, zero, -x], [-y, x, zero]];
    let along = one - c;
    from_fn(|i| {
        from_fn(|j| {
            let unit = if i == j { one } else { zero };
            c * unit + s * cross[i][j] + along * (axis[i] * axis[j])
        })
    })
}

/// Gap of the loop of a four-bar, for sines and cosines of the angles of its crank, coupler and rocker, and the lengths
/// of these and of the ground.
fn four_bar<T: Real>(turns: [[T; 2]; 3], lengths: [T; 4]) -> Vector<T> {
    let [zero, one] = [0.0, 1.0].map(T::constant);
    let z = [zero, zero, one];
    let along_x = |length: T| [length, zero, zero];
    let [crank, relative, rocker] = turns.map(|[s, c]| rotation(z, s, c));
    let columns = |m: Matrix<T>| -> Matrix<T> { from_fn(|j| from_fn(|i| m[i][j])) };
    let coupler = columns(columns(relative).map(|column| turned(crank, column)));
    let [a, b, c, ground] = lengths;
    let tip = sum(turned(crank, along_x(a)), turned(coupler, along_x(b)));
    let other = sum(along_x(ground), turned(rocker, along_x(c)));
    from_fn(|i| tip[i] - other[i])
}

#[test]
fn a_spatial_four_bar_has_the_formulas_of_a_planar_one() {
    let recording = record(|| {
        let lengths = [0.1, 0.4, 0.3, 0.45].map(Number::constant);
        four_bar(from_fn(|_| [0.6, 0.8].map(Number::input)), lengths)
    });
    let (program, counts) = recording.program(Options::default());
    // sin and cos of the coupler's turn 2 each; x: a c0 + b c01 - (g + c c2), y: a s0 + b s01 - c s2.
    let kinds = program.kinds();
    assert_eq!(kinds, Kinds { sums: 1, products: 4, fused: 6, ..Kinds::default() }, "{program:?}");
    // Recorded: three rotations of 58, 6 vectors turned at 15, 3 sums of three.
    assert_eq!(counts.recorded, 3 * 58 + 6 * 15 + 3 * 3);
    assert_eq!((counts.folded, counts.common, counts.dead, counts.fused), (243, 6, 7, 6));
    assert_eq!((counts.left, program.live()), (11, 2));
    assert_eq!(program.outputs[2], hardpoint_tape::Operand::Constant(4), "it does not leave the plane");

    let mut random = Random(1);
    let inputs: Vec<_> = (0..6 * WIDE / 8).map(|_| from_fn(|_| random.number())).collect();
    let mut outputs = [[0.0; 8]; 3 * WIDE / 8];
    Interpreter::new(&program).run(&inputs, &[], &mut outputs);
    for k in 0..WIDE {
        let at = |j: usize| inputs[k / 8 * 6 + j][k % 8];
        let turns = from_fn(|i| [at(2 * i), at(2 * i + 1)]);
        let expected: Vector<f64> = four_bar(turns, [0.1, 0.4, 0.3, 0.45]);
        for i in 0..3 {
            assert!((outputs[k / 8 * 3 + i][k % 8] - expected[i]).abs() < 1e-14);
        }
    }
}

/// Solves `m x = b` by elimination in the order of the rows.
fn solved<T: Real>(mut m: [[T; 4]; 4], mut b: [T; 4]) -> [T; 4] {
    for k in 0..4 {
        for i in k + 1..4 {
            let factor = m[i][k] / m[k][k];
            for j in k + 1..4 {
                m[i][j] = m[i][j] - factor * m[k][j];
            }
            b[i] = b[i] - factor * b[k];
        }
    }
    for k in (0..4).rev() {
        for j in k + 1..4 {
            b[k] = b[k] - m[k][j] * b[j];
        }
        b[k] = b[k] / m[k][k];
    }
    b
}

#[test]
fn sparse_elimination_takes_the_operations_of_its_pattern() {
    // An arrow: the diagonal, the last column and the last row.
    let filled = |i: usize, j: usize| i == j || i == 3 || j == 3;
    let sample = |i: usize, j: usize| if i == j { 4.0 + i as f64 } else { 1.0 + 0.1 * (i + 2 * j) as f64 };
    let recording = record(|| {
        let m = from_fn(|i| {
            from_fn(|j| if filled(i, j) { Number::input(sample(i, j)) } else { Number::constant(0.0) })
        });
        solved(m, [1.0, 2.0, 3.0, 4.0].map(Number::input))
    });
    let (program, counts) = recording.program(Options::default());
    // Three factors, with each one element and one right side; then four quotients and three products back.
    assert_eq!(program.kinds(), Kinds { quotients: 3 + 4, fused: 2 * 3 + 3, ..Kinds::default() });
    assert_eq!((counts.recorded, counts.left, counts.fused), (62, 16, 9));

    let mut inputs: Vec<f64> =
        (0..16).filter(|k| filled(k / 4, k % 4)).map(|k| sample(k / 4, k % 4)).collect();
    inputs.extend([1.0, 2.0, 3.0, 4.0]);
    let mut x = [0.0; 4];
    program.evaluate(&inputs, &[], &mut Vec::new(), &mut x);
    for i in 0..4 {
        let row: f64 = (0..4).filter(|j| filled(i, *j)).map(|j| sample(i, j) * x[j]).sum();
        assert!((row - (i + 1) as f64).abs() < 1e-14, "row {i}: {row}");
    }
}

#[test]
fn numbers_that_wait_for_the_end_are_computed_late() {
    // Recorded first are all products, then their sum: as recorded they would all be live at a time.
    let recording = record(|| {
        let x: [Number; 20] = from_fn(|k| Number::input(k as f64));
        let squares = x.map(|x| (x * x).sqrt());
        [squares.into_iter().reduce(|a, b| a + b).unwrap()]
    });
    let (program, _) = recording.program(Options::default());
    assert_eq!((program.instructions.len(), program.live()), (20 + 20 + 19, 2));
}
