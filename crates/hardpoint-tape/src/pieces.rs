//! Long programs, split into pieces that share their code.
//!
//! A chain of a thousand loops is recorded as a thousand times the same arithmetic with different numbers. As one
//! program it would be megabytes of code for every run. A program is therefore split by the pieces to which its inputs
//! belong: an instruction belongs to the last piece of any of its operands. Pieces with the same operations on
//! different operands share one program; its inputs are the numbers they read, and its uniforms are the constants that
//! differ.

use std::collections::HashMap;
use std::ops::Range;

use bytemuck::{Pod, Zeroable};

use crate::program::{Instruction, LANES, Lanes, Operand, Program};

/// Number of memory areas of outputs.
pub const AREAS: usize = 3;

/// Program that is split into pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// Programs of the pieces.
    pub shapes: Vec<Shape>,
    /// Pieces, in the order of execution.
    pub pieces: Vec<Piece>,
    /// Number of values that are stored during a run.
    pub kept: usize,
}

/// Shared program of several pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Program; its outputs are the stored values, then the outputs in the second and in the third area.
    pub program: Program,
    /// End of the stored outputs, and of those in the second area.
    pub ends: [usize; AREAS - 1],
}

/// Piece of a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Index of its shape.
    pub shape: usize,
    /// Inputs: inputs of the whole program, or stored values, by index.
    pub inputs: Vec<Operand>,
    /// First uniforms: uniforms of the whole program.
    pub given: Vec<u32>,
    /// Further uniforms.
    pub uniforms: Vec<f64>,
    /// Range of its stored values.
    pub kept: Range<usize>,
    /// Outputs among the last of these: area, and index in it.
    pub outputs: Vec<(usize, u32)>,
    /// Outputs of the second and the third area that its program writes directly.
    pub areas: [Range<usize>; AREAS - 1],
}

impl Program {
    /// Splits the program. `piece_of` returns the piece of an input or uniform; `ends` are the ends of the output
    /// areas. Consecutive outputs of a piece in the second and the third area are written there directly.
    pub fn in_pieces(&self, piece_of: impl Fn(Operand) -> usize, ends: [usize; AREAS - 1]) -> Pieces {
        let cut = Assignment::of(self, piece_of, ends);
        let mut whole = Pieces { shapes: Vec::new(), pieces: Vec::new(), kept: 0 };
        // Constants of every piece, by their index in its shape.
        let (mut shape_of, mut constants) = (HashMap::new(), Vec::new());
        let mut kept_at = vec![u32::MAX; self.instructions.len()];
        for members in cut.pieces.iter().filter(|members| !members.is_empty()) {
            let (piece, form, own) = members.canonical(self, &cut, whole.kept, &mut kept_at);
            whole.kept = piece.kept.end;
            let shapes = shape_of.len();
            let shape = *shape_of.entry(form).or_insert(shapes);
            whole.pieces.push(Piece { shape, ..piece });
            constants.push(own);
        }
        whole.shapes = vec![Shape { program: Program::default(), ends: [0; AREAS - 1] }; shape_of.len()];
        for (form, shape) in shape_of {
            let same: Vec<usize> =
                (0..whole.pieces.len()).filter(|k| whole.pieces[*k].shape == shape).collect();
            whole.shapes[shape] = form.shape(&same, &constants, &mut whole.pieces);
        }
        whole
    }
}

impl Pieces {
    /// Returns the number of instructions of all shapes.
    pub fn instructions(&self) -> usize {
        self.shapes.iter().map(|shape| shape.program.instructions.len()).sum()
    }

    /// Runs one piece after the other for one group of lanes. `run` gets the index of a shape, the inputs and uniforms
    /// of its program, and its outputs. The outputs of the whole program are written to their areas.
    ///
    /// # Panics
    ///
    /// If there are fewer inputs, uniforms or outputs than in the whole program.
    #[inline(always)]
    pub fn run(
        &self,
        room: &mut PiecesRoom,
        inputs: &[Lanes],
        uniforms: &[f64],
        [first, second, third]: [&mut [Lanes]; AREAS],
        mut run: impl FnMut(usize, &[Lanes], &[f64], [&mut [Lanes]; AREAS]),
    ) {
        room.kept.resize(self.kept, Line::default());
        if room.uniforms.is_empty() {
            let of = |piece: &Piece| [vec![0.0; piece.given.len()], piece.uniforms.clone()].concat();
            room.uniforms = self.pieces.iter().flat_map(of).collect();
        }
        let mut left = &mut room.uniforms[..];
        for piece in &self.pieces {
            room.read.resize(piece.inputs.len(), Line::default());
            for (to, from) in room.read.iter_mut().zip(&piece.inputs) {
                match *from {
                    Operand::Value(k) => *to = room.kept[k as usize],
                    Operand::Input(k) => to.0 = inputs[k as usize],
                    Operand::Uniform(_) | Operand::Constant(_) => {
                        unreachable!("inputs of pieces are no such")
                    }
                }
            }
            let (own, others) = left.split_at_mut(piece.given.len() + piece.uniforms.len());
            left = others;
            for (to, from) in own.iter_mut().zip(&piece.given) {
                *to = uniforms[*from as usize];
            }
            let kept = &mut room.kept[piece.kept.clone()];
            let [at_second, at_third] = piece.areas.clone();
            let parts = [bytemuck::cast_slice_mut(kept), &mut second[at_second], &mut third[at_third]];
            run(piece.shape, bytemuck::cast_slice(&room.read), own, parts);
            let own = &room.kept[piece.kept.end - piece.outputs.len()..];
            for ((area, k), found) in piece.outputs.iter().zip(own) {
                [&mut *first, &mut *second, &mut *third][*area][*k as usize] = found.0;
            }
        }
    }
}

/// Working memory of the pieces of one program.
#[derive(Clone, Debug, Default)]
pub struct PiecesRoom {
    kept: Vec<Line>,
    read: Vec<Line>,
    /// Uniforms of all pieces, one after the other.
    uniforms: Vec<f64>,
}

/// Lanes of one number, aligned to a cache line.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C, align(64))]
struct Line(Lanes);

const _: () = assert!(size_of::<Line>() == LANES * size_of::<f64>());

/// Assignment of instructions to pieces.
struct Assignment {
    /// True if a later piece reads the value.
    is_read: Vec<bool>,
    pieces: Vec<Members>,
    ends: [usize; AREAS - 1],
}

/// Instructions of a piece, and its outputs in every area.
#[derive(Clone, Default)]
struct Members {
    instructions: Vec<u32>,
    outputs: [Vec<u32>; AREAS],
}

impl Assignment {
    fn of(program: &Program, piece_of: impl Fn(Operand) -> usize, ends: [usize; AREAS - 1]) -> Self {
        let mut piece_of_instruction = Vec::with_capacity(program.instructions.len());
        let mut is_read = vec![false; program.instructions.len()];
        for instruction in &program.instructions {
            let pieces = instruction.operands().map(|operand| match operand {
                Operand::Value(v) => piece_of_instruction[v as usize],
                Operand::Constant(_) => 0,
                given => piece_of(given),
            });
            piece_of_instruction.push(pieces.max().unwrap_or(0));
        }
        let many = piece_of_instruction.iter().max().map_or(1, |last| last + 1);
        let mut pieces = vec![Members::default(); many];
        for (k, instruction) in program.instructions.iter().enumerate() {
            let piece = piece_of_instruction[k];
            pieces[piece].instructions.push(k as u32);
            for operand in instruction.operands() {
                if let Operand::Value(v) = operand {
                    is_read[v as usize] |= piece_of_instruction[v as usize] != piece;
                }
            }
        }
        // Outputs that no piece computes are assigned to the piece of their neighbours.
        let area_of = |k: usize| ends.iter().filter(|end| k >= **end).count();
        let computed = |k: usize| match program.outputs[k] {
            Operand::Value(v) => Some(piece_of_instruction[v as usize]),
            _ => None,
        };
        let (mut piece, mut area) = (0, AREAS);
        for k in 0..program.outputs.len() {
            if area_of(k) != area {
                area = area_of(k);
                let same = (k..program.outputs.len()).take_while(|k| area_of(*k) == area);
                piece = same.filter_map(computed).next().unwrap_or(0);
            }
            piece = computed(k).unwrap_or(piece);
            pieces[piece].outputs[area].push(k as u32);
        }
        Self { is_read, pieces, ends }
    }
}

/// Common form of the pieces of one shape: operands are numbered in the order of their first use.
#[derive(PartialEq, Eq, Hash)]
struct Form {
    instructions: Vec<Instruction>,
    outputs: Vec<Operand>,
    inputs: usize,
    given: usize,
    constants: usize,
    ends: [usize; AREAS - 1],
}

/// Numbering of operands in the order of their first use.
struct Names<'a> {
    program: &'a Program,
    kept_at: &'a [u32],
    /// Instructions of the piece that are numbered so far.
    own: HashMap<u32, u32>,
    leaves: HashMap<Operand, u32>,
    inputs: Vec<Operand>,
    given: Vec<u32>,
    constants: Vec<f64>,
}

impl Names<'_> {
    fn of(&mut self, operand: Operand) -> Operand {
        if let Operand::Value(v) = operand
            && let Some(own) = self.own.get(&v)
        {
            return Operand::Value(*own);
        }
        if let Operand::Constant(c) = operand {
            let next = self.constants.len() as u32;
            let number = *self.leaves.entry(operand).or_insert(next);
            if number == next {
                self.constants.push(self.program.constants[c as usize]);
            }
            return Operand::Constant(number);
        }
        if let Operand::Uniform(u) = operand {
            let next = self.given.len() as u32;
            let number = *self.leaves.entry(operand).or_insert(next);
            if number == next {
                self.given.push(u);
            }
            return Operand::Uniform(number);
        }
        let next = self.inputs.len() as u32;
        let number = *self.leaves.entry(operand).or_insert(next);
        if number == next {
            self.inputs.push(match operand {
                Operand::Value(v) => Operand::Value(self.kept_at[v as usize]),
                leaf => leaf,
            });
        }
        Operand::Input(number)
    }
}

impl Members {
    fn is_empty(&self) -> bool {
        self.instructions.is_empty() && self.outputs.iter().all(Vec::is_empty)
    }

    /// Returns the piece, its common form, and its constants; its values are stored from index `kept` on.
    fn canonical(
        &self,
        program: &Program,
        cut: &Assignment,
        kept: usize,
        kept_at: &mut [u32],
    ) -> (Piece, Form, Vec<f64>) {
        let mut names = Names {
            program,
            kept_at,
            own: HashMap::with_capacity(self.instructions.len()),
            leaves: HashMap::new(),
            inputs: Vec::new(),
            given: Vec::new(),
            constants: Vec::new(),
        };
        let mut instructions = Vec::with_capacity(self.instructions.len());
        for (number, k) in self.instructions.iter().enumerate() {
            instructions.push(program.instructions[*k as usize].map(|operand| names.of(operand)));
            names.own.insert(*k, number as u32);
        }
        let read: Vec<u32> = self.instructions.iter().copied().filter(|k| cut.is_read[*k as usize]).collect();
        // Outputs that are written directly come last; those of the first area never are.
        let begins = [0, cut.ends[0], cut.ends[1]];
        let mut areas = [0..0, 0..0];
        let (mut copied, mut written) = (Vec::new(), Vec::new());
        for (area, (outputs, begin)) in self.outputs.iter().zip(begins).enumerate() {
            let own = outputs.iter().map(|k| k - begin as u32);
            match outputs[..] {
                [first, .., last] | [first @ last]
                    if area > 0 && (last - first) as usize + 1 == outputs.len() =>
                {
                    areas[area - 1] = first as usize - begin..last as usize + 1 - begin;
                    written.extend(outputs);
                }
                _ => copied.extend(own.map(|k| (area, k))),
            }
        }
        let copies = copied.iter().map(|(area, k)| k + begins[*area] as u32);
        let given = copies.chain(written.iter().copied()).map(|k| program.outputs[k as usize]);
        let outputs = read.iter().map(|k| Operand::Value(*k)).chain(given);
        let outputs: Vec<Operand> = outputs.map(|operand| names.of(operand)).collect();
        let Names { inputs, given, constants, .. } = names;

        for (line, k) in read.iter().enumerate() {
            kept_at[*k as usize] = (kept + line) as u32;
        }
        let all = read.len() + copied.len();
        let form = Form {
            instructions,
            outputs,
            inputs: inputs.len(),
            given: given.len(),
            constants: constants.len(),
            ends: [all, all + areas[0].len()],
        };
        let piece = Piece {
            shape: 0,
            inputs,
            given,
            uniforms: Vec::new(),
            kept: kept..kept + all,
            outputs: copied,
            areas,
        };
        (piece, form, constants)
    }
}

impl Form {
    /// Returns the program of pieces of one shape; constants that differ become uniforms.
    fn shape(self, same: &[usize], constants: &[Vec<f64>], pieces: &mut [Piece]) -> Shape {
        let of = |k: usize, n: usize| constants[k][n].to_bits();
        let mut program = Program { inputs: self.inputs, uniforms: self.given, ..Program::default() };
        let mut places = Vec::with_capacity(self.constants);
        for n in 0..self.constants {
            if same.iter().all(|k| of(*k, n) == of(same[0], n)) {
                places.push(Operand::Constant(program.constants.len() as u32));
                program.constants.push(constants[same[0]][n]);
            } else {
                places.push(Operand::Uniform(program.uniforms as u32));
                program.uniforms += 1;
                same.iter().for_each(|k| pieces[*k].uniforms.push(constants[*k][n]));
            }
        }
        let place = |operand| match operand {
            Operand::Constant(n) => places[n as usize],
            other => other,
        };
        program.instructions = self.instructions.into_iter().map(|i| i.map(place)).collect();
        program.outputs = self.outputs.into_iter().map(place).collect();
        Shape { program, ends: self.ends }
    }
}
