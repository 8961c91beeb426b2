//! Splitting of a program in two: values that depend on few leaves are computed first, and once.

use crate::program::{Operand, Program};

impl Program {
    /// Splits off the operations that depend on constants and uniforms alone.
    ///
    /// The first program reads uniforms and has one output for each number that the second needs; the second has these
    /// as further uniforms after its own. Both keep the numbers of inputs and uniforms. Run the first once
    /// ([`Program::evaluate`]), the second for all lanes.
    pub fn hoisted(self) -> (Self, Self) {
        let uniforms = self.uniforms as u32;
        let (first, mut rest) =
            self.split(|operand| matches!(operand, Operand::Uniform(_)), |k| Operand::Uniform(uniforms + k));
        rest.uniforms += first.outputs.len();
        (first, rest)
    }

    /// Splits off the operations that depend only on constants and on those inputs and uniforms for which `first`
    /// returns true: values that are constant over many runs, like the geometry of a design over its motion.
    ///
    /// The first program has one output for each number that the second needs; the second has these as further inputs
    /// after its own. Both keep the numbers of inputs and uniforms, the first only up to the last that it reads.
    pub fn staged(self, first: impl Fn(Operand) -> bool) -> (Self, Self) {
        let inputs = self.inputs as u32;
        let (first, mut rest) = self.split(first, |k| Operand::Input(inputs + k));
        rest.inputs += first.outputs.len();
        (first, rest)
    }

    /// Splits the program into operations of `early` leaves, and the rest, which reads the k-th output of the first
    /// part as `joint(k)`.
    fn split(self, early: impl Fn(Operand) -> bool, joint: impl Fn(u32) -> Operand) -> (Self, Self) {
        /// Operand in the second part for each value of the whole program.
        #[derive(Clone, Copy)]
        enum Place {
            /// Value of the first part, by its index there; not an output so far.
            First(u32),
            Rest(Operand),
        }
        let mut parts = [Part::of(&self), Part::of(&self)];
        let mut places: Vec<Place> = Vec::with_capacity(self.instructions.len());
        let [first, rest] = &mut parts;
        let in_rest =
            |operand: Operand, places: &mut [Place], first: &mut Part, rest: &mut Part| match operand {
                Operand::Value(k) => match places[k as usize] {
                    Place::Rest(operand) => operand,
                    Place::First(value) => {
                        let operand = joint(first.program.outputs.len() as u32);
                        first.program.outputs.push(Operand::Value(value));
                        places[k as usize] = Place::Rest(operand);
                        operand
                    }
                },
                leaf => rest.leaf(leaf),
            };
        // A value that the rest reads is still a value of the first part.
        let mut value_in_first = vec![None; self.instructions.len()];
        for (k, instruction) in self.instructions.iter().enumerate() {
            let is_early = instruction.operands().all(|operand| match operand {
                Operand::Value(v) => value_in_first[v as usize].is_some(),
                Operand::Constant(_) => true,
                leaf => early(leaf),
            });
            if is_early {
                let value = first.program.instructions.len() as u32;
                let instruction = instruction.map(|operand| match operand {
                    Operand::Value(v) => {
                        Operand::Value(value_in_first[v as usize].expect("an early operand"))
                    }
                    leaf => first.leaf(leaf),
                });
                first.program.instructions.push(instruction);
                value_in_first[k] = Some(value);
                places.push(Place::First(value));
            } else {
                let instruction = instruction.map(|operand| in_rest(operand, &mut places, first, rest));
                places.push(Place::Rest(Operand::Value(rest.program.instructions.len() as u32)));
                rest.program.instructions.push(instruction);
            }
        }
        for output in &self.outputs {
            let operand = in_rest(*output, &mut places, first, rest);
            rest.program.outputs.push(operand);
        }
        let read = |operand: Operand| match operand {
            Operand::Input(k) => [k as usize + 1, 0],
            Operand::Uniform(k) => [0, k as usize + 1],
            Operand::Value(_) | Operand::Constant(_) => [0, 0],
        };
        let reads = first.program.instructions.iter().flat_map(|i| i.operands()).map(read);
        [first.program.inputs, first.program.uniforms] =
            reads.fold([0, 0], |[i, u], [input, uniform]| [i.max(input), u.max(uniform)]);
        parts.map(|part| part.program).into()
    }
}

/// Part that is being built, with the constants of the whole program that it uses.
struct Part<'a> {
    whole: &'a Program,
    program: Program,
    constants: Vec<Option<u32>>,
}

impl<'a> Part<'a> {
    fn of(whole: &'a Program) -> Self {
        let program = Program { inputs: whole.inputs, uniforms: whole.uniforms, ..Program::default() };
        Self { whole, program, constants: vec![None; whole.constants.len()] }
    }

    /// Returns the operand for a leaf of the whole program.
    fn leaf(&mut self, leaf: Operand) -> Operand {
        let Operand::Constant(k) = leaf else { return leaf };
        let place = *self.constants[k as usize].get_or_insert_with(|| {
            self.program.constants.push(self.whole.constants[k as usize]);
            self.program.constants.len() as u32 - 1
        });
        Operand::Constant(place)
    }
}
