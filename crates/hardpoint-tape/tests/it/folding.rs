//! Folding, common subexpressions, dead code, signs and fused products.

use hardpoint_tape::{Call, Counts, Instruction, Number, Operand, Options, Program, record};

use Instruction::*;
use Operand::{Constant, Input, Value};

/// The program of a formula of three inputs, at 2, 3 and 5.
fn of(f: impl FnOnce([Number; 3]) -> Vec<Number>, fuse: bool) -> (Program, Counts) {
    record(|| f([2.0, 3.0, 5.0].map(Number::input))).program(Options { fuse })
}

/// A formula of one number, and its name.
type Named = (&'static str, fn(Number) -> Number);

fn unfused(f: impl FnOnce([Number; 3]) -> Number) -> Program {
    of(|x| vec![f(x)], false).0
}

fn c(x: f64) -> Number {
    Number::constant(x)
}

#[test]
fn exact_zeros_and_ones_leave_nothing_to_compute() {
    let input: [Named; 13] = [
        ("x * 1", |x| x * c(1.0)),
        ("1 * x", |x| c(1.0) * x),
        ("x * -1 * -1", |x| x * c(-1.0) * c(-1.0)),
        ("x + 0", |x| x + c(0.0)),
        ("0 + x", |x| c(-0.0) + x),
        ("x - 0", |x| x - c(0.0)),
        ("0 - (0 - x)", |x| c(0.0) - (c(0.0) - x)),
        ("x / 1", |x| x / c(1.0)),
        ("-(x / -1)", |x| -(x / c(-1.0))),
        ("--x", |x| -(-x)),
        ("x + (y - y)", |x| x + (x - x)),
        ("x + x * 0", |x| x.times_plus(c(0.0), x)),
        ("larger(x, x)", |x| x.larger(x)),
    ];
    for (name, f) in input {
        let program = unfused(|[x, ..]| f(x));
        assert_eq!((program.instructions.len(), &program.outputs[..]), (0, &[Input(0)][..]), "{name}");
        assert!(program.constants.is_empty(), "{name}");
    }
    let zero: [Named; 6] = [
        ("x * 0", |x| x * c(0.0)),
        ("0 * x", |x| c(0.0) * x),
        ("0 / x", |x| c(0.0) / x),
        ("x - x", |x| x - x),
        ("-x + x", |x| -x + x),
        ("(x + 1) - (1 + x)", |x| (x + c(1.0)) - (c(1.0) + x)),
    ];
    for (name, f) in zero {
        let program = unfused(|[x, ..]| f(x));
        assert_eq!((program.instructions.len(), &program.outputs[..]), (0, &[Constant(0)][..]), "{name}");
        assert_eq!(program.constants, [0.0], "{name}");
    }
}

#[test]
fn constants_are_computed_as_scalars_are() {
    let program = of(
        |_| {
            let [a, b] = [c(0.1), c(-0.3)];
            vec![
                a + b,
                a * b,
                a / b,
                a.times_plus(b, a),
                b.abs().sqrt(),
                c(2.5).round(),
                a.larger(b),
                b.larger(c(f64::NAN)),
                a.call(Call::Exp),
                b.atan2(a),
                a / c(0.0) - c(1.0),
            ]
        },
        false,
    )
    .0;
    assert!(program.instructions.is_empty());
    let expected = [
        0.1 + -0.3,
        0.1 * -0.3,
        0.1 / -0.3,
        0.1 * -0.3 + 0.1,
        0.3f64.sqrt(),
        2.0,
        0.1,
        f64::NAN,
        0.1f64.exp(),
        (-0.3f64).atan2(0.1),
        f64::INFINITY,
    ];
    let mut found = [0.0; 11];
    program.evaluate(&[0.0; 3], &[], &mut Vec::new(), &mut found);
    assert_eq!(found.map(f64::to_bits), expected.map(f64::to_bits));
}

#[test]
fn division_by_a_power_of_two_is_a_product_and_no_other_is() {
    assert_eq!(unfused(|[x, ..]| x / c(-8.0)).instructions, [Mul(Input(0), Constant(0))]);
    assert_eq!(unfused(|[x, ..]| x / c(-8.0)).constants, [-0.125]);
    assert_eq!(unfused(|[x, ..]| x / c(3.0)).instructions, [Div(Input(0), Constant(0))]);
    // Its inverse is not normal: half a bit of it would be lost.
    assert_eq!(unfused(|[x, ..]| x / c(2f64.powi(1023))).instructions, [Div(Input(0), Constant(0))]);
    assert_eq!(unfused(|[x, ..]| x / c(f64::INFINITY)).instructions, [Div(Input(0), Constant(0))]);
}

#[test]
fn magnitudes_and_roots_are_taken_once() {
    assert_eq!(unfused(|[x, ..]| (-x).abs().abs()).instructions, [Abs(Input(0))]);
    assert_eq!(unfused(|[x, ..]| x.sqrt().abs()).instructions, [Sqrt(Input(0))]);
    assert_eq!(unfused(|[x, ..]| x.round().round()).instructions, [Round(Input(0))]);
}

#[test]
fn signs_cost_nothing_but_before_outputs_and_functions() {
    let (x, y, z) = (Input(0), Input(1), Input(2));
    assert_eq!(unfused(|[x, y, _]| x + -y).instructions, [Sub(x, y)]);
    assert_eq!(unfused(|[x, y, _]| -(x - y)).instructions, [Sub(y, x)]);
    assert_eq!(unfused(|[x, y, _]| -x * -y).instructions, [Mul(x, y)]);
    assert_eq!(unfused(|[x, y, z]| z + -x * y).instructions, [Mul(x, y), Sub(z, Value(0))]);
    assert_eq!(unfused(|[x, y, z]| z - (-x - y)).instructions, [Add(x, y), Add(z, Value(0))]);
    assert_eq!(unfused(|[x, y, _]| -x.round() - y / -x).instructions.last(), Some(&Sub(Value(1), Value(0))));
    // A constant factor takes the sign.
    let program = unfused(|[x, ..]| -(x * c(3.0)));
    assert_eq!(
        (&program.instructions[..], &program.constants[..]),
        (&[Mul(x, Constant(0))][..], &[-3.0][..])
    );
    // No sign is free: one negation for all readers.
    let program = of(|[x, y, _]| vec![-(x * y), (-(x * y)).sqrt(), (x * y).larger(-x)], false).0;
    assert_eq!(
        program.instructions,
        [Mul(x, y), Neg(Value(0)), Sqrt(Value(1)), Neg(x), Larger(Value(3), Value(0))]
    );
    assert_eq!(program.outputs, [Value(1), Value(2), Value(4)]);
    // A difference that is read with both signs is computed once.
    let program = of(|[x, y, _]| vec![y - x, (x - y) * x], false).0;
    assert_eq!(program.instructions, [Sub(y, x), Mul(x, Value(0)), Neg(Value(1))]);
}

#[test]
fn the_same_is_computed_once() {
    let (program, counts) = of(
        |[x, y, z]| {
            let [a, b] = [x * y + z, z - y * -x];
            let [c, d] = [(x - y).sqrt(), (-(y - x)).sqrt()];
            vec![a * b, a / b, c - d, x.larger(y) - y.larger(x), x.atan2(y) - y.atan2(x)]
        },
        false,
    );
    assert_eq!(
        program.instructions,
        [
            Mul(Input(0), Input(1)),
            Add(Input(2), Value(0)),
            Mul(Value(1), Value(1)),
            Div(Value(1), Value(1)),
            Call(Call::Atan2, Input(0), Input(1)),
            Call(Call::Atan2, Input(1), Input(0)),
            Sub(Value(4), Value(5)),
        ]
    );
    assert_eq!(program.outputs[2..4], [Constant(0); 2]);
    assert_eq!(counts.common, 5);
}

#[test]
fn unused_operations_are_left_out() {
    let (program, counts) = of(
        |[x, y, z]| {
            let unread = (x * y + z).sqrt();
            let _ = unread / x;
            vec![x + y]
        },
        true,
    );
    assert_eq!(program.instructions, [Add(Input(0), Input(1))]);
    assert_eq!(counts, Counts { recorded: 5, dead: 4, left: 1, ..Counts::default() });
    assert_eq!(program.inputs, 3, "inputs keep their numbers");
}

#[test]
fn products_are_fused_with_the_sums_that_take_them() {
    let fused = |f: fn([Number; 3]) -> Number| of(|x| vec![f(x)], true).0.instructions;
    let (x, y, z) = (Input(0), Input(1), Input(2));
    assert_eq!(fused(|[x, y, z]| x * y + z), [MulAdd(x, y, z)]);
    assert_eq!(fused(|[x, y, z]| x * y - z), [MulSub(x, y, z)]);
    assert_eq!(fused(|[x, y, z]| z - x * y), [NegMulAdd(x, y, z)]);
    assert_eq!(fused(|[x, y, z]| -(x * y) - z), [NegMulSub(x, y, z)]);
    assert_eq!(fused(|[x, y, z]| -(x * y + z)), [NegMulSub(x, y, z)]);
    assert_eq!(fused(|[x, y, z]| (-x).times_plus(y, z)), [NegMulAdd(x, y, z)]);
    assert_eq!(fused(|[x, y, z]| x * y + y * z), [Mul(x, y), MulAdd(y, z, Value(0))]);
    // No sum of a product and itself, and none where the product is needed anyway.
    assert_eq!(fused(|[x, y, _]| x * y + x * y), [Mul(x, y), Add(Value(0), Value(0))]);
    let program = of(|[x, y, z]| vec![x * y + z, x * y], true).0;
    assert_eq!(program.instructions, [Mul(x, y), Add(z, Value(0))]);
    // Two sums take the same two products: one of them goes into both.
    let (program, counts) = of(|[x, y, z]| vec![x * y + y * z, x * y - y * z], true);
    assert_eq!(program.instructions, [Mul(x, y), MulAdd(y, z, Value(0)), NegMulAdd(y, z, Value(0))]);
    assert_eq!((counts.recorded, counts.common, counts.fused, counts.left), (6, 2, 1, 3));
    // Without fusing, not even where it was recorded so.
    assert_eq!(unfused(|[x, y, z]| x.times_plus(y, z)).instructions, [Mul(x, y), Add(z, Value(0))]);
}
