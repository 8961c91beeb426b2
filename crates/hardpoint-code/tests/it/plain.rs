//! Interpretation of programs, one scalar at a time.

use hardpoint_code::PARTS;
use hardpoint_tape::{LANES, Lanes, Program};

use crate::random::{at, compute};

/// Outputs for groups of lanes, in the layout of code.
pub fn evaluate(program: &Program, groups: usize, inputs: &[Lanes], uniforms: &[f64]) -> Vec<Lanes> {
    let mut outputs = vec![[0.0; LANES]; groups * program.outputs.len()];
    let mut values = Vec::with_capacity(program.instructions.len());
    for g in 0..groups {
        let mine = &inputs[g * program.inputs..][..program.inputs];
        for lane in 0..LANES {
            let inputs: Vec<f64> = mine.iter().map(|x| x[lane]).collect();
            values.clear();
            for instruction in &program.instructions {
                values.push(compute(*instruction, |o| at(o, &values, &inputs, uniforms, &program.constants)));
            }
            for (j, o) in program.outputs.iter().enumerate() {
                outputs[g * program.outputs.len() + j][lane] =
                    at(*o, &values, &inputs, uniforms, &program.constants);
            }
        }
    }
    outputs
}

/// Outputs in the layout of code with outputs in parts.
pub fn parts(program: &Program, ends: [usize; PARTS - 1], outputs: &[Lanes]) -> [Vec<Lanes>; PARTS] {
    let count = program.outputs.len();
    let [first, second] = ends;
    [0..first, first..second, second..count]
        .map(|part| outputs.chunks(count.max(1)).flat_map(|group| &group[part.clone()]).copied().collect())
}
