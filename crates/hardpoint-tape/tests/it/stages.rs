//! A program in two parts has the same results.

use hardpoint_tape::{Number, Operand, Options, Program, record};

use crate::random::{Formula, Random};

/// Outputs of the program for these scalars.
fn evaluate(program: &Program, inputs: &[f64], uniforms: &[f64]) -> Vec<f64> {
    let mut outputs = vec![0.0; program.outputs.len()];
    program.evaluate(inputs, uniforms, &mut Vec::new(), &mut outputs);
    outputs
}

fn bits(numbers: &[f64]) -> Vec<Option<u64>> {
    numbers.iter().map(|x| (!x.is_nan()).then_some(x.to_bits())).collect()
}

/// True if the first part gives every number once.
fn gives_once(first: &Program) -> bool {
    let mut outputs = first.outputs.clone();
    outputs.sort_unstable();
    outputs.windows(2).all(|pair| pair[0] != pair[1])
}

/// True if some instruction reads nothing but these leaves.
fn reads_only(program: &Program, early: impl Fn(Operand) -> bool) -> bool {
    program.instructions.iter().any(|i| i.operands().all(&early))
}

#[test]
fn hoisted_programs_give_the_bits_of_the_whole() {
    let mut hoisted = 0;
    for seed in 0..2000 {
        let formula = Formula::random(seed);
        let mut random = Random(!seed);
        let (whole, _) = formula.record(&mut random).program(Options::default());
        let (first, rest) = whole.clone().hoisted();
        assert_eq!(first.inputs, 0);
        assert!(gives_once(&first), "seed {seed}: {first:?}");
        assert_eq!((rest.inputs, rest.uniforms), (whole.inputs, whole.uniforms + first.outputs.len()));
        assert_eq!(first.instructions.len() + rest.instructions.len(), whole.instructions.len());
        assert!(
            !reads_only(&rest, |o| matches!(o, Operand::Uniform(_) | Operand::Constant(_))),
            "seed {seed}"
        );
        hoisted += first.instructions.len();
        let [inputs, uniforms]: [Vec<f64>; 2] =
            [formula.inputs, formula.uniforms].map(|n| (0..n).map(|_| random.number()).collect());
        let further = evaluate(&first, &[], &uniforms);
        let found = evaluate(&rest, &inputs, &[uniforms.clone(), further].concat());
        assert_eq!(bits(&found), bits(&evaluate(&whole, &inputs, &uniforms)), "seed {seed}");
    }
    assert!(hoisted > 1000, "only {hoisted} instructions were hoisted: nothing was tested");
}

#[test]
fn staged_programs_give_the_bits_of_the_whole() {
    let mut early = 0;
    for seed in 0..2000 {
        let formula = Formula::random(seed);
        let mut random = Random(!seed);
        let (whole, _) = formula.record(&mut random).program(Options::default());
        let chosen = random.below(1 << 5);
        let is_first = |k: u32| chosen >> k & 1 == 1;
        let (first, rest) = whole.clone().staged(|o| match o {
            Operand::Input(k) => is_first(k),
            _ => true,
        });
        let of_the_first = |o| match o {
            Operand::Input(k) => is_first(k),
            Operand::Uniform(_) | Operand::Constant(_) => true,
            Operand::Value(_) => false,
        };
        assert!(
            first
                .instructions
                .iter()
                .flat_map(|i| i.operands())
                .all(|o| of_the_first(o) || matches!(o, Operand::Value(_)))
        );
        assert!(!reads_only(&rest, of_the_first), "seed {seed}");
        assert_eq!((rest.inputs, rest.uniforms), (whole.inputs + first.outputs.len(), whole.uniforms));
        assert!(gives_once(&first), "seed {seed}: {first:?}");
        early += first.instructions.len();
        let [inputs, uniforms]: [Vec<f64>; 2] =
            [formula.inputs, formula.uniforms].map(|n| (0..n).map(|_| random.number()).collect());
        // Other inputs must not affect the first part.
        let given: Vec<f64> =
            (0..first.inputs).map(|k| if is_first(k as u32) { inputs[k] } else { f64::NAN }).collect();
        let further = evaluate(&first, &given, &uniforms);
        let found = evaluate(&rest, &[inputs.clone(), further].concat(), &uniforms);
        assert_eq!(bits(&found), bits(&evaluate(&whole, &inputs, &uniforms)), "seed {seed}");
    }
    assert!(early > 3000, "only {early} instructions came first: nothing was tested");
}

#[test]
fn a_product_of_uniforms_is_computed_once_and_not_within_a_sum() {
    let recording = record(|| {
        let [length, scale] = [Number::uniform(2.0), Number::uniform(3.0)];
        let x = Number::input(5.0);
        [length * scale + x]
    });
    let (first, rest) = recording.program(Options::default()).0.hoisted();
    assert_eq!((first.kinds().products, first.outputs.len()), (1, 1));
    assert_eq!((rest.kinds().sums, rest.kinds().total()), (1, 1));
    assert_eq!(evaluate(&rest, &[5.0], &[2.0, 3.0, 6.0]), [11.0]);
}
