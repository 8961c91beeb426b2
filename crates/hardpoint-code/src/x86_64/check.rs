//! Conditions on a program under which its code reads and writes only the given memory.

use hardpoint_tape::{Operand, Program};

use crate::{MOST, PARTS, UnsupportedProgram};

/// Checks that every offset fits into an instruction.
pub fn size(program: &Program) -> Result<(), UnsupportedProgram> {
    let all = [
        ("inputs", program.inputs),
        ("uniforms", program.uniforms),
        ("constants", program.constants.len()),
        ("instructions", program.instructions.len()),
        ("outputs", program.outputs.len()),
    ];
    match all.into_iter().find(|(_, count)| *count > MOST) {
        Some((what, count)) => Err(UnsupportedProgram::Size { what, count }),
        None => Ok(()),
    }
}

/// Checks that every operand exists, and that values are computed before they are read.
pub fn operands(program: &Program) {
    let check = |operand, values: usize, what: &dyn Fn() -> String| {
        let (k, count) = match operand {
            Operand::Value(k) => (k, values),
            Operand::Input(k) => (k, program.inputs),
            Operand::Uniform(k) => (k, program.uniforms),
            Operand::Constant(k) => (k, program.constants.len()),
        };
        assert!((k as usize) < count, "{} reads {operand:?}, but only {count} of these exist", what());
    };
    for (i, instruction) in program.instructions.iter().enumerate() {
        for operand in instruction.operands() {
            check(operand, i, &|| format!("instruction {i}"));
        }
    }
    for (j, operand) in program.outputs.iter().enumerate() {
        check(*operand, program.instructions.len(), &|| format!("output {j}"));
    }
}

/// Returns the number of outputs of each part.
pub fn parts(program: &Program, ends: [usize; PARTS - 1]) -> [usize; PARTS] {
    let count = program.outputs.len();
    let [first, second] = ends;
    assert!(
        first <= second && second <= count,
        "parts of {count} outputs end at {first} and {second}: the ends must ascend and not exceed the number of outputs"
    );
    [first, second - first, count - second]
}
