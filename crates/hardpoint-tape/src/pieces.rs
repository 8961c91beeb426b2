//! Long programs, split into pieces that share their code.
//!
//! A chain of a thousand loops is recorded as a thousand times the same arithmetic with different numbers. As one
//! program it would be megabytes of code for every run. A program is therefore split by the pieces to which its inputs
//! belong: an instruction belongs to the last piece of any of its operands. Pieces with the same operations on
//! different operands share one program; its inputs are the numbers they read, and its uniforms are the constants that
//! differ.

use std::collections::{BTreeMap, HashMap};
use std::mem;
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
    /// Links of all pieces, one after the other: a run reads them in this order.
    links: Links,
    /// Number of stored values: those that no later piece reads are replaced.
    pub kept: usize,
}

/// Numbers that a piece reads and writes, apart from outputs that its program writes directly.
#[derive(Clone, Debug, Default, PartialEq)]
struct Links {
    /// Inputs: inputs of the whole program, or stored values, by index.
    inputs: Vec<Operand>,
    /// First uniforms: uniforms of the whole program.
    given: Vec<u32>,
    /// Further uniforms.
    uniforms: Vec<f64>,
    /// Outputs among the last stored values: area, and index in it.
    outputs: Vec<(u32, u32)>,
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
    /// Numbers of its inputs, of uniforms of the whole program, of further uniforms, and of outputs among its stored
    /// values.
    counts: [usize; 4],
    /// Range of its stored values; the outputs are the last ones.
    kept: Range<usize>,
    /// Outputs of the second and the third area that its program writes directly.
    pub areas: [Range<usize>; AREAS - 1],
}

impl Program {
    /// Splits the program. `piece_of` returns the piece of an input or uniform; `ends` are the ends of the output
    /// areas. Consecutive outputs of a piece in the second and the third area are written there directly.
    pub fn in_pieces(&self, piece_of: impl Fn(Operand) -> usize, ends: [usize; AREAS - 1]) -> Pieces {
        let cut = Assignment::of(self, piece_of, ends);
        let (mut pieces, mut links) = (Vec::new(), Vec::new());
        // Constants of every piece, by their index in its shape.
        let (mut shape_of, mut constants) = (HashMap::new(), Vec::new());
        let mut kept_at = vec![u32::MAX; self.instructions.len()];
        let mut memory = Memory::default();
        for (k, members) in cut.pieces.iter().enumerate().filter(|(_, members)| !members.is_empty()) {
            let (piece, own_links, form, own) = members.canonical(
                self,
                &cut,
                |size| memory.place(k, cut.last_readers[k], size),
                &mut kept_at,
            );
            let shapes = shape_of.len();
            let shape = *shape_of.entry(form).or_insert(shapes);
            pieces.push(Piece { shape, ..piece });
            links.push(own_links);
            constants.push(own);
        }
        let mut shapes = vec![Shape { program: Program::default(), ends: [0; AREAS - 1] }; shape_of.len()];
        for (form, shape) in shape_of {
            let same: Vec<usize> = (0..pieces.len()).filter(|k| pieces[*k].shape == shape).collect();
            shapes[shape] = form.shape(&same, &constants, &mut links);
        }
        let mut all = Links::default();
        for (piece, own) in pieces.iter_mut().zip(links) {
            piece.counts = [own.inputs.len(), own.given.len(), own.uniforms.len(), own.outputs.len()];
            all.inputs.extend(own.inputs);
            all.given.extend(own.given);
            all.uniforms.extend(own.uniforms);
            all.outputs.extend(own.outputs);
        }
        Pieces { shapes, pieces, links: all, kept: memory.size }
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
            let mut constants = self.links.uniforms.iter();
            for Piece { counts: [_, given, uniforms, _], .. } in &self.pieces {
                room.uniforms.resize(room.uniforms.len() + given, 0.0);
                room.uniforms.extend(constants.by_ref().take(*uniforms));
            }
        }
        let mut left = &mut room.uniforms[..];
        let (mut all_inputs, mut all_given) = (&self.links.inputs[..], &self.links.given[..]);
        let mut all_outputs = &self.links.outputs[..];
        for piece in &self.pieces {
            let [reads, given, constants, writes] = piece.counts;
            room.read.resize(reads, Line::default());
            for (to, from) in room.read.iter_mut().zip(first_of(&mut all_inputs, reads)) {
                match *from {
                    Operand::Value(k) => *to = room.kept[k as usize],
                    Operand::Input(k) => to.0 = inputs[k as usize],
                    Operand::Uniform(_) | Operand::Constant(_) => {
                        unreachable!("inputs of pieces are no such")
                    }
                }
            }
            let (own, others) = left.split_at_mut(given + constants);
            left = others;
            for (to, from) in own.iter_mut().zip(first_of(&mut all_given, given)) {
                *to = uniforms[*from as usize];
            }
            let kept = &mut room.kept[piece.kept.clone()];
            let [at_second, at_third] = piece.areas.clone();
            let parts = [bytemuck::cast_slice_mut(kept), &mut second[at_second], &mut third[at_third]];
            run(piece.shape, bytemuck::cast_slice(&room.read), own, parts);
            let own = &room.kept[piece.kept.end - writes..];
            for ((area, k), found) in first_of(&mut all_outputs, writes).iter().zip(own) {
                [&mut *first, &mut *second, &mut *third][*area as usize][*k as usize] = found.0;
            }
        }
    }
}

/// Removes the first items of a slice and returns them.
#[inline(always)]
fn first_of<'s, T>(slice: &mut &'s [T], count: usize) -> &'s [T] {
    let (first, rest) = slice.split_at(count);
    *slice = rest;
    first
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

/// Places of stored values while pieces are arranged.
#[derive(Default)]
struct Memory {
    size: usize,
    /// Starts of free ranges, by their sizes.
    free: BTreeMap<usize, Vec<usize>>,
    /// Ranges that later pieces read, by the last of these.
    in_use: BTreeMap<usize, Vec<Range<usize>>>,
}

impl Memory {
    /// Start of a range of this size for values of this piece. Inputs are read before a piece stores values: it may
    /// replace those that no later piece reads.
    fn place(&mut self, piece: usize, last_reader: usize, size: usize) -> usize {
        let later = self.in_use.split_off(&(piece + 1));
        for range in mem::replace(&mut self.in_use, later).into_values().flatten() {
            self.free.entry(range.len()).or_default().push(range.start);
        }
        let start = self.free.get_mut(&size).and_then(Vec::pop).unwrap_or(self.size);
        self.size = self.size.max(start + size);
        self.in_use.entry(last_reader).or_default().push(start..start + size);
        start
    }
}

/// Assignment of instructions to pieces.
struct Assignment {
    /// True if a later piece reads the value.
    is_read: Vec<bool>,
    /// Last piece that reads values of each piece.
    last_readers: Vec<usize>,
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
        let mut last_readers: Vec<usize> = (0..many).collect();
        for (k, instruction) in program.instructions.iter().enumerate() {
            let piece = piece_of_instruction[k];
            pieces[piece].instructions.push(k as u32);
            for operand in instruction.operands() {
                if let Operand::Value(v) = operand {
                    let source = piece_of_instruction[v as usize];
                    is_read[v as usize] |= source != piece;
                    last_readers[source] = last_readers[source].max(piece);
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
        Self { is_read, last_readers, pieces, ends }
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

    /// Returns the piece, its links, its common form, and its constants; `place` returns the index from which on this
    /// number of values is stored.
    fn canonical(
        &self,
        program: &Program,
        cut: &Assignment,
        place: impl FnOnce(usize) -> usize,
        kept_at: &mut [u32],
    ) -> (Piece, Links, Form, Vec<f64>) {
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
                _ => copied.extend(own.map(|k| (area as u32, k))),
            }
        }
        let copies = copied.iter().map(|(area, k)| k + begins[*area as usize] as u32);
        let given = copies.chain(written.iter().copied()).map(|k| program.outputs[k as usize]);
        let outputs = read.iter().map(|k| Operand::Value(*k)).chain(given);
        let outputs: Vec<Operand> = outputs.map(|operand| names.of(operand)).collect();
        let Names { inputs, given, constants, .. } = names;

        let all = read.len() + copied.len();
        let kept = place(all);
        for (line, k) in read.iter().enumerate() {
            kept_at[*k as usize] = (kept + line) as u32;
        }
        let form = Form {
            instructions,
            outputs,
            inputs: inputs.len(),
            given: given.len(),
            constants: constants.len(),
            ends: [all, all + areas[0].len()],
        };
        let piece = Piece { shape: 0, counts: [0; 4], kept: kept..kept + all, areas };
        (piece, Links { inputs, given, uniforms: Vec::new(), outputs: copied }, form, constants)
    }
}

impl Form {
    /// Returns the program of pieces of one shape; constants that differ become uniforms.
    fn shape(self, same: &[usize], constants: &[Vec<f64>], links: &mut [Links]) -> Shape {
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
                same.iter().for_each(|k| links[*k].uniforms.push(constants[*k][n]));
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
