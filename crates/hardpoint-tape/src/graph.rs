//! Conversion of a recording to a program, with simplification.
//!
//! A recording holds all operations of a kernel. Half of them have exact zeros and ones as operands, and many are
//! repeated. The graph takes the steps one by one, finds the node of each, and makes a new one only if none exists:
//!
//! - constants are folded: with each other as `f64` does, and `x * 0`, `x * 1`, `x + 0`, `0 / x`, `x / 1`, `x - x`;
//! - numbers have a sign, so that negations are free: `a - b` is the sum of `a` and `-b`;
//! - equal operations of equal operands are one node, in either order if the operation is commutative.
//!
//! Then dead nodes are removed, products are fused with sums, and the remaining nodes are written in an order with few
//! live values. All steps are linear in the size of the recording.

use crate::counts::Counts;
use crate::number::{Recording, Step};
use crate::program::{Call, Instruction, Operand, Program, larger};

/// Options of the conversion of a recording to a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// True if products are fused with sums, which rounds once instead of twice. If false, every operation rounds,
    /// including [`Number::times_plus`](crate::Number::times_plus), and results have the bits of plain `f64`.
    pub fuse: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { fuse: true }
    }
}

impl Recording {
    /// Returns the program that computes the outputs, and the statistics of the recorded operations.
    ///
    /// Without [`Options::fuse`] its results are bit for bit those of the same operations in `f64`, with these
    /// exceptions, which are due to folded exact zeros:
    ///
    /// - the sign of a zero may differ, and with it the sign of an infinity from a division by zero, and the half turn
    ///   of `atan2(0, x)` for negative x;
    /// - `x * 0`, `0 / x` and `x - x` are zero even if x is infinite or NaN, or zero in `0 / x`;
    /// - the sign and payload of NaN.
    pub fn program(&self, options: Options) -> (Program, Counts) {
        let mut graph = Graph::of(self);
        graph.mark_live();
        if options.fuse {
            graph.fuse();
        }
        let recorded: Vec<u32> = (0..graph.nodes.len() as u32).filter(|n| graph.is_instruction(*n)).collect();
        let needed = graph.order_by_need();
        let order = if graph.max_live_in(&needed) < graph.max_live_in(&recorded) { needed } else { recorded };
        graph.counts.recorded += self.folded;
        graph.counts.folded += self.folded;
        graph.emit(&order, self)
    }
}

/// Operation that computes a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Constant, not negative; its bits are in `a` and `b`.
    Constant,
    /// Number `a`.
    Input,
    /// Number `a`.
    Uniform,
    /// Sum of two signed numbers, the first positive.
    Add,
    /// Operation on two nodes without signs, in order.
    Mul,
    Div,
    Abs,
    Round,
    /// Operation on signed numbers, in order.
    Sqrt,
    Larger,
    Call(Call),
}

/// Node, with the operands of its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Node {
    kind: Kind,
    a: u32,
    b: u32,
}

/// Node or its negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Signed(u32);

impl Signed {
    fn new(node: u32, negative: bool) -> Self {
        Self(node << 1 | u32::from(negative))
    }
    fn node(self) -> u32 {
        self.0 >> 1
    }
    fn negative(self) -> bool {
        self.0 & 1 == 1
    }
    fn times(self, negative: bool) -> Self {
        Self(self.0 ^ u32::from(negative))
    }
    fn magnitude(self) -> Self {
        Self(self.0 & !1)
    }
}

/// Null index of nodes and instructions.
const NONE: u32 = u32::MAX;

/// Nodes of a recording. Operands come before the nodes that use them.
struct Graph {
    nodes: Vec<Node>,
    /// Hash table with open addressing: indices into `nodes`. Its length is a power of two, and at most half of it is
    /// used.
    table: Vec<u32>,
    outputs: Vec<Signed>,
    /// Number of reads of each node by live nodes and outputs; 0 is dead.
    uses: Vec<u32>,
    /// Product that is fused with a sum.
    fused: Vec<u32>,
    /// True for a product that is fused with all its uses and needs no instruction.
    absorbed: Vec<bool>,
    counts: Counts,
}

impl Graph {
    fn of(recording: &Recording) -> Self {
        let size = recording.steps.len();
        assert!(size < 1 << 29, "a recording of {size} steps is too long");
        let mut graph = Self {
            nodes: Vec::with_capacity(size),
            table: vec![NONE; (size + 16).next_power_of_two()],
            outputs: Vec::new(),
            uses: Vec::new(),
            fused: Vec::new(),
            absorbed: Vec::new(),
            counts: Counts::default(),
        };
        let mut place: Vec<Signed> = Vec::with_capacity(size);
        for step in &recording.steps {
            let at = |k: u32| place[k as usize];
            let signed = match *step {
                Step::Constant(x) => graph.constant(x),
                Step::Input(k) => graph.leaf(Node { kind: Kind::Input, a: k, b: 0 }),
                Step::Uniform(k) => graph.leaf(Node { kind: Kind::Uniform, a: k, b: 0 }),
                Step::Add(a, b) => graph.add(at(a), at(b)),
                Step::Sub(a, b) => graph.add(at(a), at(b).times(true)),
                Step::Mul(a, b) => graph.mul(at(a), at(b)),
                Step::Div(a, b) => graph.div(at(a), at(b)),
                Step::MulAdd(a, b, c) => {
                    let product = graph.mul(at(a), at(b));
                    graph.add(product, at(c))
                }
                Step::Neg(a) => graph.folded(at(a).times(true)),
                Step::Abs(a) => graph.abs(at(a)),
                Step::Round(a) => graph.round(at(a)),
                Step::Sqrt(a) => graph.function(Kind::Sqrt, at(a), at(a)),
                Step::Larger(a, b) if at(a) == at(b) => graph.folded(at(a)),
                Step::Larger(a, b) => graph.function(Kind::Larger, at(a).min(at(b)), at(a).max(at(b))),
                Step::Call(call, a, b) => graph.function(Kind::Call(call), at(a), at(b)),
            };
            place.push(signed);
        }
        graph.outputs = recording.outputs.iter().map(|k| place[*k as usize]).collect();
        graph
    }

    /// Returns the slot of a node in the table, or the first free slot.
    #[inline]
    fn find(&self, node: Node) -> usize {
        // The upper bits of a product depend on all bits of its factors, so they give the slot.
        const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;
        let kind = match node.kind {
            Kind::Constant => 0,
            Kind::Input => 1,
            Kind::Uniform => 2,
            Kind::Add => 3,
            Kind::Mul => 4,
            Kind::Div => 5,
            Kind::Abs => 6,
            Kind::Round => 7,
            Kind::Sqrt => 8,
            Kind::Larger => 9,
            Kind::Call(call) => 10 + call as u64,
        };
        let key = (u64::from(node.a) << 32 | u64::from(node.b)).wrapping_add(kind << 27);
        let mixed = (key ^ key >> 32).wrapping_mul(SPREAD);
        let hash = (mixed ^ mixed >> 29).wrapping_mul(SPREAD) >> 32;
        let mask = self.table.len() - 1;
        let mut place = hash as usize & mask;
        while self.table[place] != NONE && self.nodes[self.table[place] as usize] != node {
            place = (place + 1) & mask;
        }
        place
    }

    /// Returns the index of this node, and true if it is new.
    #[inline]
    fn place(&mut self, node: Node) -> (u32, bool) {
        let place = self.find(node);
        if self.table[place] != NONE {
            return (self.table[place], false);
        }
        let id = self.nodes.len() as u32;
        self.nodes.push(node);
        self.table[place] = id;
        if 2 * self.nodes.len() > self.table.len() {
            self.table = vec![NONE; 2 * self.table.len()];
            for id in 0..self.nodes.len() {
                let place = self.find(self.nodes[id]);
                self.table[place] = id as u32;
            }
        }
        (id, true)
    }

    fn leaf(&mut self, node: Node) -> Signed {
        Signed::new(self.place(node).0, false)
    }

    fn constant(&mut self, x: f64) -> Signed {
        let bits = x.abs().to_bits();
        let node = Node { kind: Kind::Constant, a: (bits >> 32) as u32, b: bits as u32 };
        self.leaf(node).times(x.is_sign_negative())
    }

    /// Returns the value of a constant.
    #[inline]
    fn known(&self, x: Signed) -> Option<f64> {
        let node = self.nodes[x.node() as usize];
        (node.kind == Kind::Constant).then(|| {
            let magnitude = f64::from_bits(u64::from(node.a) << 32 | u64::from(node.b));
            if x.negative() { -magnitude } else { magnitude }
        })
    }

    // Each function handles one recorded operation: it is folded, common, or a new node.

    fn folded(&mut self, x: Signed) -> Signed {
        self.counts.recorded += 1;
        self.counts.folded += 1;
        x
    }

    fn folded_to(&mut self, x: f64) -> Signed {
        let constant = self.constant(x);
        self.folded(constant)
    }

    fn operation(&mut self, kind: Kind, a: u32, b: u32) -> Signed {
        let (id, new) = self.place(Node { kind, a, b });
        self.counts.recorded += 1;
        self.counts.common += usize::from(!new);
        Signed::new(id, false)
    }

    fn add(&mut self, a: Signed, b: Signed) -> Signed {
        match (self.known(a), self.known(b)) {
            (Some(x), Some(y)) => return self.folded_to(x + y),
            (Some(0.0), None) => return self.folded(b),
            (None, Some(0.0)) => return self.folded(a),
            _ if a == b.times(true) => return self.folded_to(0.0),
            _ => {}
        }
        let (first, second) = (a.min(b), a.max(b));
        let negative = first.negative();
        self.operation(Kind::Add, first.times(negative).0, second.times(negative).0).times(negative)
    }

    fn mul(&mut self, a: Signed, b: Signed) -> Signed {
        let negative = a.negative() != b.negative();
        match (self.known(a), self.known(b)) {
            (Some(x), Some(y)) => return self.folded_to(x * y),
            (Some(0.0), None) | (None, Some(0.0)) => return self.folded_to(0.0),
            (Some(1.0 | -1.0), None) => return self.folded(b.magnitude().times(negative)),
            (None, Some(1.0 | -1.0)) => return self.folded(a.magnitude().times(negative)),
            _ => {}
        }
        let (first, second) = (a.node().min(b.node()), a.node().max(b.node()));
        self.operation(Kind::Mul, first, second).times(negative)
    }

    fn div(&mut self, a: Signed, b: Signed) -> Signed {
        let negative = a.negative() != b.negative();
        match (self.known(a), self.known(b)) {
            (Some(x), Some(y)) => return self.folded_to(x / y),
            (Some(0.0), None) => return self.folded_to(0.0),
            (None, Some(1.0 | -1.0)) => return self.folded(a.magnitude().times(negative)),
            (None, Some(y)) if is_power_of_two(y) => {
                // The inverse is exact, and a product is cheaper.
                let inverse = self.constant(1.0 / y);
                return self.mul(a, inverse);
            }
            _ => {}
        }
        self.operation(Kind::Div, a.node(), b.node()).times(negative)
    }

    fn abs(&mut self, a: Signed) -> Signed {
        match self.nodes[a.node() as usize].kind {
            Kind::Constant | Kind::Abs | Kind::Sqrt => self.folded(a.magnitude()),
            _ => self.operation(Kind::Abs, a.node(), a.node()),
        }
    }

    fn round(&mut self, a: Signed) -> Signed {
        match (self.known(a), self.nodes[a.node() as usize].kind) {
            (Some(x), _) => self.folded_to(x.round_ties_even()),
            (None, Kind::Round) => self.folded(a),
            _ => self.operation(Kind::Round, a.node(), a.node()).times(a.negative()),
        }
    }

    fn function(&mut self, kind: Kind, a: Signed, b: Signed) -> Signed {
        if let (Some(x), Some(y)) = (self.known(a), self.known(b)) {
            return self.folded_to(match kind {
                Kind::Sqrt => x.sqrt(),
                Kind::Call(call) => call.of(x, y),
                _ => larger(x, y),
            });
        }
        self.operation(kind, a.0, b.0)
    }

    /// Returns the operands of a node with their signs.
    #[inline]
    fn operands(&self, node: u32) -> ([Signed; 2], usize) {
        let Node { kind, a, b } = self.nodes[node as usize];
        match kind {
            Kind::Constant | Kind::Input | Kind::Uniform => ([Signed(0); 2], 0),
            Kind::Mul | Kind::Div => ([Signed::new(a, false), Signed::new(b, false)], 2),
            Kind::Abs | Kind::Round => ([Signed::new(a, false); 2], 1),
            Kind::Add | Kind::Larger => ([Signed(a), Signed(b)], 2),
            Kind::Sqrt => ([Signed(a); 2], 1),
            Kind::Call(call) => ([Signed(a), Signed(b)], 1 + usize::from(call.is_of_two())),
        }
    }

    fn is_leaf(&self, node: u32) -> bool {
        matches!(self.nodes[node as usize].kind, Kind::Constant | Kind::Input | Kind::Uniform)
    }

    /// True if the node has its own instruction.
    fn is_instruction(&self, node: u32) -> bool {
        self.uses[node as usize] > 0 && !self.absorbed[node as usize] && !self.is_leaf(node)
    }

    /// Counts the reads of all live nodes.
    fn mark_live(&mut self) {
        let size = self.nodes.len();
        self.uses = vec![0; size];
        self.fused = vec![NONE; size];
        self.absorbed = vec![false; size];
        for output in &self.outputs {
            self.uses[output.node() as usize] += 1;
        }
        for node in (0..size as u32).rev() {
            if self.uses[node as usize] == 0 {
                self.counts.dead += usize::from(!self.is_leaf(node));
                continue;
            }
            let (operands, many) = self.operands(node);
            for operand in &operands[..many] {
                self.uses[operand.node() as usize] += 1;
            }
        }
    }

    /// Fuses products with sums: first products that are read once, by a sum; then products that are read several
    /// times, only by sums without another fused product. A product that is fused with all of its sums needs no
    /// instruction.
    ///
    /// If a sum can take either of two products, it takes the one that depends on the later input, because values that
    /// depend on uniforms or on the first inputs alone may be computed elsewhere ([`Program::hoisted`],
    /// [`Program::staged`]). A product of uniforms alone is never fused with a sum that depends on inputs.
    fn fuse(&mut self) {
        let size = self.nodes.len();
        // 0: constants and uniforms; k + 1: inputs up to number k.
        let mut rank = vec![0u32; size];
        // Sums that read a product, as a linked list: the last one, and for each operand of a sum the previous one.
        let mut last = vec![NONE; size];
        let mut before = vec![NONE; 2 * size];
        // Number of readers of a product that are sums without a fused product.
        let mut willing = vec![0u32; size];
        for node in 0..size as u32 {
            let at = node as usize;
            if self.uses[at] == 0 {
                continue;
            }
            let (operands, many) = self.operands(node);
            rank[at] = match self.nodes[at].kind {
                Kind::Input => self.nodes[at].a + 1,
                _ => operands[..many].iter().map(|o| rank[o.node() as usize]).max().unwrap_or(0),
            };
            // The sum of a number and itself is not a product plus an addend.
            if self.nodes[at].kind != Kind::Add || operands[0].node() == operands[1].node() {
                continue;
            }
            for (side, operand) in operands.iter().enumerate() {
                let product = operand.node() as usize;
                if self.nodes[product].kind == Kind::Mul && (rank[product] > 0 || rank[at] == 0) {
                    willing[product] += 1;
                    before[2 * at + side] = last[product];
                    last[product] = 2 * node + side as u32;
                }
            }
            let takes = operands
                .map(Signed::node)
                .into_iter()
                .filter(|p| self.uses[*p as usize] == 1 && willing[*p as usize] == 1)
                .max_by_key(|p| (rank[*p as usize], *p));
            if let Some(product) = takes {
                self.fused[at] = product;
                self.absorbed[product as usize] = true;
            }
        }
        for product in (0..size).rev() {
            if self.absorbed[product] || willing[product] < 2 || willing[product] != self.uses[product] {
                continue;
            }
            let sums = |from: u32| {
                std::iter::successors((from != NONE).then_some(from), |link| {
                    Some(before[*link as usize]).filter(|next| *next != NONE)
                })
                .map(|link| (link / 2) as usize)
            };
            if sums(last[product]).all(|sum| self.fused[sum] == NONE) {
                sums(last[product]).for_each(|sum| self.fused[sum] = product as u32);
                self.absorbed[product] = true;
            }
        }
        self.counts.fused = self.absorbed.iter().filter(|a| **a).count();
    }

    /// Returns the nodes that the instruction of a node reads; a fused product is replaced by its factors.
    fn reads(&self, node: u32) -> ([u32; 3], usize) {
        let (operands, many) = self.operands(node);
        let product = self.fused[node as usize];
        if product == NONE {
            return ([operands[0].node(), operands[1].node(), NONE], many);
        }
        let other = if operands[0].node() == product { operands[1] } else { operands[0] };
        let Node { a, b, .. } = self.nodes[product as usize];
        ([a, b, other.node()], 3)
    }

    /// Returns an order from the outputs: the operands of each node just before it, operands that need the most values
    /// first (Sethi-Ullman numbers, which are optimal for trees and a good heuristic here).
    fn order_by_need(&self) -> Vec<u32> {
        let size = self.nodes.len();
        let mut need = vec![0u32; size];
        let ordered = |node: u32, need: &[u32]| {
            let (mut reads, many) = self.reads(node);
            // Stable insertion sort of two or three.
            for i in 1..many {
                for j in (1..=i).rev() {
                    if need[reads[j] as usize] > need[reads[j - 1] as usize] {
                        reads.swap(j, j - 1);
                    }
                }
            }
            (reads, many)
        };
        for node in 0..size as u32 {
            if self.is_instruction(node) {
                let (reads, many) = ordered(node, &need);
                need[node as usize] =
                    (0..many).map(|i| need[reads[i] as usize] + i as u32).max().unwrap_or(0).max(1);
            }
        }
        let mut order = Vec::with_capacity(size);
        let mut done = vec![false; size];
        let mut open = Vec::new();
        for output in &self.outputs {
            open.push(output.node());
            while let Some(&node) = open.last() {
                if done[node as usize] || self.is_leaf(node) {
                    open.pop();
                    continue;
                }
                let (reads, many) = ordered(node, &need);
                let missing = reads[..many].iter().find(|r| !done[**r as usize] && !self.is_leaf(**r));
                if let Some(read) = missing {
                    open.push(*read);
                } else {
                    done[node as usize] = true;
                    order.push(node);
                    open.pop();
                }
            }
        }
        order
    }

    /// Returns the maximum number of live values in this order.
    fn max_live_in(&self, order: &[u32]) -> usize {
        let mut last = vec![0u32; self.nodes.len()];
        for (k, node) in order.iter().enumerate() {
            let (reads, many) = self.reads(*node);
            for read in &reads[..many] {
                last[*read as usize] = k as u32 + 1;
            }
        }
        // Number of values that become live minus the number that end, by position.
        let mut change = vec![0i32; order.len() + 1];
        for (k, node) in order.iter().enumerate() {
            if last[*node as usize] > 0 {
                change[k] += 1;
                change[last[*node as usize] as usize - 1] -= 1;
            }
        }
        let mut now = 0;
        change
            .iter()
            .map(|c| {
                now += c;
                now
            })
            .max()
            .unwrap_or(0) as usize
    }

    /// Writes the program in this order.
    fn emit(mut self, order: &[u32], recording: &Recording) -> (Program, Counts) {
        let mut writer = Writer::new(&self, recording);
        for node in order {
            writer.instruction(*node);
        }
        for k in 0..self.outputs.len() {
            let output = writer.with_own_sign(self.outputs[k]);
            writer.program.outputs.push(output);
        }
        let Writer { program, negations, .. } = writer;
        self.counts.negations = negations;
        self.counts.left = program.instructions.len();
        (program, self.counts)
    }
}

/// True if division by it is exactly multiplication by its inverse.
fn is_power_of_two(y: f64) -> bool {
    y.is_normal() && (1.0 / y).is_normal() && y.to_bits() << 12 == 0
}

/// Program that is being written.
///
/// A node can be computed with the opposite sign if that is cheaper: `-(a - b)` is `b - a`.
struct Writer<'a> {
    graph: &'a Graph,
    program: Program,
    /// Instruction that computes a node, or index of a constant in the program; [`NONE`] before its first use.
    place: Vec<u32>,
    /// True if that instruction computes the node's negative.
    flipped: Vec<bool>,
    /// Instruction or constant that is the negative of `place`.
    opposite: Vec<u32>,
    /// True if a node is an output, and if its negative is one.
    given: Vec<[bool; 2]>,
    /// True if a reader requires the node's negative and cannot change signs for free.
    wanted: Vec<RequiredSign>,
    negations: usize,
}

/// Sign that readers require if they cannot use either sign.
#[derive(Clone, Copy, PartialEq, Eq)]
enum RequiredSign {
    Either,
    Negative,
    Positive,
}

/// Determines the required signs. If a node is required as its negative and that is not free, the requirement passes to
/// an operand without other readers.
fn required_signs(graph: &Graph) -> Vec<RequiredSign> {
    let mut wanted = vec![RequiredSign::Either; graph.nodes.len()];
    let want = |wanted: &mut [RequiredSign], x: Signed| {
        let w = &mut wanted[x.node() as usize];
        *w = if x.negative() && *w != RequiredSign::Positive {
            RequiredSign::Negative
        } else {
            RequiredSign::Positive
        };
    };
    for output in &graph.outputs {
        want(&mut wanted, *output);
    }
    for node in (0..graph.nodes.len() as u32).rev().filter(|n| graph.is_instruction(*n)) {
        let (operands, many) = graph.operands(node);
        let operands = &operands[..many];
        let is_negative = |wanted: &[RequiredSign], x: Signed| {
            x.negative() != (wanted[x.node() as usize] == RequiredSign::Negative)
        };
        match graph.nodes[node as usize].kind {
            Kind::Sqrt | Kind::Larger | Kind::Call(_) => operands.iter().for_each(|o| want(&mut wanted, *o)),
            Kind::Add | Kind::Mul | Kind::Div
                if wanted[node as usize] == RequiredSign::Negative
                    && graph.fused[node as usize] == NONE
                    && operands.iter().all(|o| graph.known(*o).is_none() && !is_negative(&wanted, *o)) =>
            {
                let alone = operands.iter().map(|o| o.node() as usize).find(|o| {
                    graph.uses[*o] == 1
                        && wanted[*o] == RequiredSign::Either
                        && graph.is_instruction(*o as u32)
                });
                if let Some(operand) = alone {
                    wanted[operand] = RequiredSign::Negative;
                }
            }
            _ => {}
        }
    }
    wanted
}

impl<'a> Writer<'a> {
    fn new(graph: &'a Graph, recording: &Recording) -> Self {
        let size = graph.nodes.len();
        let mut given = vec![[false; 2]; size];
        for output in &graph.outputs {
            given[output.node() as usize][usize::from(output.negative())] = true;
        }
        let program = Program {
            inputs: recording.inputs as usize,
            uniforms: recording.uniforms as usize,
            ..Program::default()
        };
        let [place, opposite] = [vec![NONE; size], vec![NONE; size]];
        Self {
            graph,
            program,
            place,
            flipped: vec![false; size],
            opposite,
            given,
            wanted: required_signs(graph),
            negations: 0,
        }
    }

    /// Returns the operand of constant `x`, the magnitude of a node or its negative; `slot` stores its index once it is
    /// used.
    fn constant(program: &mut Program, slot: &mut u32, x: f64) -> Operand {
        if *slot == NONE {
            *slot = program.constants.len() as u32;
            program.constants.push(x);
        }
        Operand::Constant(*slot)
    }

    /// Returns the operand of a number with either sign, and true if it is the number's negative.
    fn either(&mut self, x: Signed) -> (Operand, bool) {
        let at = x.node() as usize;
        let node = self.graph.nodes[at];
        let operand = match node.kind {
            Kind::Constant => {
                let magnitude = self.graph.known(x.magnitude()).expect("a constant is known");
                Self::constant(&mut self.program, &mut self.place[at], magnitude)
            }
            Kind::Input => Operand::Input(node.a),
            Kind::Uniform => Operand::Uniform(node.a),
            _ => Operand::Value(self.place[at]),
        };
        (operand, self.minus(x))
    }

    /// True if the instruction of a number computes its negative.
    fn minus(&self, x: Signed) -> bool {
        x.negative() != self.flipped[x.node() as usize]
    }

    /// Returns the operand of a number with its own sign, negated if necessary.
    fn with_own_sign(&mut self, x: Signed) -> Operand {
        let at = x.node() as usize;
        if let Some(value) = self.graph.known(x) {
            let slot = if x.negative() { &mut self.opposite[at] } else { &mut self.place[at] };
            return Self::constant(&mut self.program, slot, value);
        }
        let (operand, negative) = self.either(x);
        if !negative {
            return operand;
        }
        if self.opposite[at] == NONE {
            self.opposite[at] = self.program.instructions.len() as u32;
            self.program.instructions.push(Instruction::Neg(operand));
            self.negations += 1;
        }
        Operand::Value(self.opposite[at])
    }

    /// Writes the instruction of a node.
    fn instruction(&mut self, node: u32) {
        let at = node as usize;
        let Node { kind, .. } = self.graph.nodes[at];
        let ([a, b], _) = self.graph.operands(node);
        let negative = self.wanted[at] == RequiredSign::Negative;
        let (instruction, flipped) = match kind {
            Kind::Add => self.sum(node, negative),
            Kind::Mul => self.factors(Instruction::Mul, a, b, negative),
            Kind::Div => self.factors(Instruction::Div, a, b, negative),
            Kind::Abs => (Instruction::Abs(self.either(a).0), false),
            Kind::Round => {
                let (a, negative) = self.either(a);
                (Instruction::Round(a), negative)
            }
            Kind::Sqrt => (Instruction::Sqrt(self.with_own_sign(a)), false),
            Kind::Larger => (Instruction::Larger(self.with_own_sign(a), self.with_own_sign(b)), false),
            Kind::Call(call) => {
                (Instruction::Call(call, self.with_own_sign(a), self.with_own_sign(b)), false)
            }
            Kind::Constant | Kind::Input | Kind::Uniform => unreachable!("leaves are not computed"),
        };
        self.flipped[at] = flipped;
        self.place[at] = self.program.instructions.len() as u32;
        self.program.instructions.push(instruction);
        if self.given[at][usize::from(!flipped)] {
            // Negated immediately, so that the number is not live to the end.
            self.with_own_sign(Signed::new(node, !flipped));
        }
    }

    /// Returns the negative of a number if it is available: for a constant, or if already computed.
    fn available_negative(&mut self, x: Signed) -> Option<Operand> {
        let x = x.times(!self.minus(x));
        let at_hand = self.graph.known(x).is_some() || self.opposite[x.node() as usize] != NONE;
        at_hand.then(|| self.with_own_sign(x))
    }

    /// Writes a product or quotient with its sign; the sign is free if the negative of a factor is available.
    fn factors(
        &mut self,
        instruction: fn(Operand, Operand) -> Instruction,
        a: Signed,
        b: Signed,
        negative: bool,
    ) -> (Instruction, bool) {
        let flipped = self.minus(a) != self.minus(b);
        if flipped == negative {
            return (instruction(self.either(a).0, self.either(b).0), flipped);
        }
        if let Some(x) = self.available_negative(a) {
            return (instruction(x, self.either(b).0), negative);
        }
        if let Some(y) = self.available_negative(b) {
            return (instruction(self.either(a).0, y), negative);
        }
        (instruction(self.either(a).0, self.either(b).0), flipped)
    }

    /// Writes a sum of two numbers, or of a number and its fused product.
    fn sum(&mut self, node: u32, negative: bool) -> (Instruction, bool) {
        use Instruction::*;
        let ([a, b], _) = self.graph.operands(node);
        let product = self.graph.fused[node as usize];
        if product == NONE {
            let ((x, minus_x), (y, minus_y)) = (self.either(a), self.either(b));
            return match (minus_x != negative, minus_y != negative) {
                (false, false) => (Add(x, y), negative),
                (false, true) => (Sub(x, y), negative),
                (true, false) => (Sub(y, x), negative),
                (true, true) => match (self.available_negative(a), self.available_negative(b)) {
                    (Some(minus), _) => (Sub(minus, y), negative),
                    (None, Some(minus)) => (Sub(minus, x), negative),
                    (None, None) => (Add(x, y), !negative),
                },
            };
        }
        let (taken, other) = if a.node() == product { (a, b) } else { (b, a) };
        let ([x, y], _) = self.graph.operands(product);
        let ((x, minus_x), (y, minus_y), (c, minus_c)) = (self.either(x), self.either(y), self.either(other));
        let minus_product = taken.negative() != (minus_x != minus_y);
        let instruction = match (minus_product != negative, minus_c != negative) {
            (false, false) => MulAdd(x, y, c),
            (false, true) => MulSub(x, y, c),
            (true, false) => NegMulAdd(x, y, c),
            (true, true) => NegMulSub(x, y, c),
        };
        (instruction, negative)
    }
}
