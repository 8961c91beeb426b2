//! Execution of straight-line programs: by machine code or an interpreter, whole or in pieces that share their code.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, Mutex};

use hardpoint_code::{Code, PARTS, Scratch, Width};
use hardpoint_tape::{Interpreter, LANES, Lanes, Operand, Pieces, PiecesRoom, Program, Shape};

use crate::blocks::{AlignedLanes, lanes_of};

/// Number of instructions above which a program exceeds the cache of a core; identical pieces then share their code.
const LONG: usize = 10_000;
/// Factor by which sharing must shorten the program.
const SHORTER: usize = 2;

/// Solver of smooth steps: the kernel, which traverses the plan, or a straight-line program recorded from it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Execution {
    /// Fastest method: programs if there are enough steps, as machine code if the machine supports it.
    #[default]
    Fastest,
    /// The kernel alone.
    Kernel,
    /// Interpreted programs, from the first step on.
    Interpreted,
    /// Programs as machine code, from the first step on; interpreted if the machine does not support it.
    Compiled,
}

impl Execution {
    /// Execution by its name in `HARDPOINT_PATH`: `scalar`, `tape` or `code`.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "scalar" => Some(Self::Kernel),
            "tape" => Some(Self::Interpreted),
            "code" => Some(Self::Compiled),
            _ => None,
        }
    }
}

/// Method that solves the smooth steps of a motion, eight output times at once or one by one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StepMethod {
    /// Programs as machine code.
    Code(Width),
    /// Interpreted programs, with the reason why there is no machine code.
    Interpreter(String),
    /// The kernel, one by one, with the reason.
    Kernel(String),
}

impl fmt::Display for StepMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Code(width) => write!(f, "machine code ({width}), eight output times at once"),
            Self::Interpreter(why) => write!(f, "an interpreted program, eight output times at once: {why}"),
            Self::Kernel(why) => write!(f, "the kernel, one by one: {why}"),
        }
    }
}

/// Programs, each recorded on first use; `None` for those that cannot be recorded.
#[derive(Debug)]
pub(crate) struct Cache<K, P>(Mutex<BTreeMap<K, Option<Arc<P>>>>);

impl<K, P> Default for Cache<K, P> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Ord, P> Cache<K, P> {
    /// Returns the program for this key; `record` makes it on first use.
    pub fn get(&self, key: K, record: impl FnOnce(&K) -> Option<P>) -> Option<Arc<P>> {
        let mut programs = self.0.lock().expect("no one panics while recording");
        programs.entry(key).or_insert_with_key(|key| record(key).map(Arc::new)).clone()
    }
}

/// A program, as machine code if possible; a long one in pieces that share their code.
#[derive(Debug)]
pub(crate) struct Runnable {
    inputs: usize,
    sizes: [usize; PARTS],
    form: Form,
}

#[derive(Debug)]
enum Form {
    Whole(Executable),
    Pieces(Pieces, Vec<Executable>),
}

/// An executable program with its outputs in parts.
#[derive(Debug)]
struct Executable {
    program: Program,
    code: Option<Code>,
}

impl Executable {
    fn new(program: Program, ends: [usize; PARTS - 1], execution: Execution) -> Self {
        let code =
            if execution == Execution::Interpreted { None } else { Code::in_parts(&program, ends).ok() };
        Self { program, code }
    }

    #[inline(always)]
    fn run(
        &self,
        (scratch, interpreter): (&mut Scratch, &mut Option<Interpreter>),
        found: &mut Vec<Lanes>,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: [&mut [Lanes]; PARTS],
    ) {
        match &self.code {
            Some(code) => code.run_in_parts(scratch, inputs, uniforms, outputs),
            None => {
                let interpreter = interpreter.get_or_insert_with(|| Interpreter::new(&self.program));
                found.resize(self.program.outputs.len(), [0.0; LANES]);
                interpreter.run(inputs, uniforms, found);
                let mut rest = &found[..];
                for to in outputs {
                    let (part, others) = rest.split_at(to.len());
                    to.copy_from_slice(part);
                    rest = others;
                }
            }
        }
    }
}

impl Runnable {
    /// Makes a program executable, with outputs in parts that end there.
    pub fn new(program: Program, ends: [usize; PARTS - 1], execution: Execution) -> Self {
        Self::in_pieces(program, ends, execution, |_| 0)
    }

    /// Makes a program executable in pieces; `piece_of` returns the piece of a long program for an input or uniform.
    pub fn in_pieces(
        program: Program,
        ends @ [first, second]: [usize; PARTS - 1],
        execution: Execution,
        piece_of: impl Fn(Operand) -> usize,
    ) -> Self {
        let (inputs, long) = (program.inputs, program.instructions.len());
        let sizes = [first, second - first, program.outputs.len() - second];
        let pieces = (long > LONG).then(|| program.in_pieces(piece_of, ends));
        let form = match pieces.filter(|pieces| SHORTER * pieces.instructions() <= long) {
            Some(pieces) => {
                let executable =
                    |shape: &Shape| Executable::new(shape.program.clone(), shape.ends, execution);
                let shapes = pieces.shapes.iter().map(executable).collect();
                Form::Pieces(pieces, shapes)
            }
            None => Form::Whole(Executable::new(program, ends, execution)),
        };
        Self { inputs, sizes, form }
    }

    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Number of outputs in every part.
    pub fn sizes(&self) -> [usize; PARTS] {
        self.sizes
    }
}

/// A program in two parts: one that depends on the design alone and runs once per design, and the rest.
#[derive(Debug)]
pub(crate) struct Staged {
    design: Runnable,
    pub step: Runnable,
}

impl Staged {
    /// Splits a program; inputs from `design_at` on are those of the design. `runnable` makes the second part
    /// executable.
    pub fn new(
        program: Program,
        design_at: usize,
        execution: Execution,
        runnable: impl FnOnce(Program) -> Runnable,
    ) -> Self {
        let (design, step) = program.staged(|operand| match operand {
            Operand::Input(k) => k as usize >= design_at,
            _ => false,
        });
        let all = design.outputs.len();
        Self { design: Runnable::new(design, [all; PARTS - 1], execution), step: runnable(step) }
    }

    /// Computes the inputs of the second part that depend on the design alone, and stores them behind the others.
    pub fn take_design(&self, inputs: &mut [AlignedLanes]) {
        let (given, found) = inputs.split_at_mut(inputs.len() - self.design.sizes[0]);
        let given = &lanes_of(given)[..self.design.inputs];
        ProgramMemory::default().run(&self.design, given, &[], [lanes_of(found), &mut [], &mut []]);
    }
}

/// Working memory of a program.
#[derive(Debug, Default)]
pub(crate) struct ProgramMemory {
    scratch: Scratch,
    /// One for every program.
    interpreters: Vec<Option<Interpreter>>,
    /// Outputs of the program.
    outputs: Vec<Lanes>,
    pieces: PiecesRoom,
}

impl ProgramMemory {
    #[inline(always)]
    pub fn run(
        &mut self,
        runnable: &Runnable,
        inputs: &[Lanes],
        uniforms: &[f64],
        outputs: [&mut [Lanes]; PARTS],
    ) {
        let Self { scratch, interpreters, outputs: found, pieces: room } = self;
        match &runnable.form {
            Form::Whole(executable) => {
                if interpreters.len() != 1 {
                    interpreters.resize(1, None);
                }
                executable.run((scratch, &mut interpreters[0]), found, inputs, uniforms, outputs);
            }
            Form::Pieces(pieces, shapes) => {
                if interpreters.len() != shapes.len() {
                    interpreters.resize(shapes.len(), None);
                }
                pieces.run(room, inputs, uniforms, outputs, |shape, inputs, uniforms, outputs| {
                    let with = (&mut *scratch, &mut interpreters[shape]);
                    shapes[shape].run(with, found, inputs, uniforms, outputs);
                });
            }
        }
    }
}
