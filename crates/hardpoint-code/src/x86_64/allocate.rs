//! Register allocation and instruction selection.
//!
//! Linear scan in the order of the program. If no register is free, the number whose next read is furthest ahead is
//! evicted. Numbers with a location in memory (inputs, uniforms, constants, stored outputs, spilled values) are read
//! there and never stored again; other values are spilled to a slot of the scratch memory when they are evicted.

use super::calls;
use super::encoder::{Assembler, Gpr, Memory, Opcode, Sign, Source};
use super::frame::{self, Frame};
use super::lower::{Action, LoweredProgram, NEVER, Name, Step};
use crate::Counts;

/// No register.
const NO_REGISTER: u8 = u8::MAX;

/// Number of instructions by which the next read of a number with a location in memory counts as later: its eviction
/// needs no store.
const CLEAN: u32 = 50;

/// Contents of a register.
#[derive(Clone, Copy, Debug)]
struct Holder {
    name: Name,
    /// Next instruction that reads it.
    next: u32,
}

/// State of registers and memory after the instructions so far.
#[derive(Debug)]
pub struct Allocator<'l> {
    lowered: &'l LoweredProgram,
    frame: Frame,
    assembler: Assembler,
    counts: Counts,
    holders: Vec<Holder>,
    /// Free registers, as bits.
    free: u32,
    /// Register of each name.
    register: Vec<u8>,
    /// Location in memory of each name.
    home: Vec<Option<Memory>>,
    slots: usize,
    /// Free slots.
    free_slots: Vec<Memory>,
    /// Slots that this instruction reads for the last time; they are free for the next one.
    last_read: Vec<Memory>,
    /// Number of value outputs stored so far.
    stored: usize,
}

impl<'l> Allocator<'l> {
    pub fn new(lowered: &'l LoweredProgram, frame: Frame, assembler: Assembler) -> Self {
        let registers = frame.registers();
        let home = (0..lowered.names.len() as Name).map(|n| frame.home(n)).collect();
        Self {
            lowered,
            frame,
            assembler,
            counts: Counts::default(),
            holders: vec![Holder { name: 0, next: NEVER }; registers],
            free: (u64::MAX >> (64 - registers)) as u32,
            register: vec![NO_REGISTER; lowered.names.len()],
            home,
            slots: 0,
            free_slots: Vec::new(),
            last_read: Vec::new(),
            stored: 0,
        }
    }

    /// Emits all instructions and the stores of all outputs.
    pub fn run(mut self) -> (Assembler, Counts) {
        let lowered = self.lowered;
        for (i, step) in lowered.steps.iter().enumerate().filter(|(_, s)| s.needed) {
            for (name, next) in step.operands().iter().zip(step.next()) {
                if let Some(r) = self.register(*name) {
                    self.holders[usize::from(r)].next = *next;
                }
            }
            let result = match step.action {
                Action::Unary(op) => self.unary(op, step),
                Action::Binary(op) => self.binary(op, step, false),
                Action::Commuting(op) => self.binary(op, step, true),
                Action::Fused(sign) => self.fused(sign, step),
                Action::Larger => self.larger(step),
                Action::Call(call) => self.call(call, step),
            };
            self.finish(i as Name, result);
        }
        for (name, j) in lowered.outputs.iter().zip(0..) {
            if !lowered.names.is_value(*name) {
                let home = self.home[*name as usize].expect("what is no value has a home");
                self.load(0, home);
                self.assembler.store(self.frame.output(j), 0);
            }
        }
        self.counts.slots = self.slots;
        (self.assembler, self.counts)
    }

    fn unary(&mut self, op: Opcode, step: &Step) -> u8 {
        let s = self.source(step.operands()[0]);
        self.free_last_reads(step);
        let d = self.take(0);
        self.assembler.vector(op, d, 0, s);
        d
    }

    fn binary(&mut self, op: Opcode, step: &Step, commutes: bool) -> u8 {
        let &[mut a, mut b] = step.operands() else { unreachable!("two operands") };
        let &[next_a, next_b] = step.next() else { unreachable!("two operands") };
        let mut next = next_a;
        let swap = match (self.register(a), self.register(b)) {
            (None, Some(_)) => true,
            // The loaded number remains in its register for a while.
            (None, None) => next_b < next_a,
            _ => false,
        };
        if commutes && swap {
            (a, b, next) = (b, a, next_b);
        }
        let r = self.ensure_register(a, next, self.bits(&[b]));
        let s = self.source(b);
        self.free_last_reads(step);
        let d = self.take(0);
        self.assembler.vector(op, d, r, s);
        d
    }

    /// Emits a fused instruction. The result replaces one operand; one of the others can be in memory.
    fn fused(&mut self, sign: Sign, step: &Step) -> u8 {
        let &[a, b, c] = step.operands() else { unreachable!("three operands") };
        let names = [a, b, c];
        let next: [u32; 3] = step.next().try_into().expect("three operands");
        let (k, d) = self.destination_operand(names, next);

        // Other operands: two factors, or a factor and the addend.
        let others = match k {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        let place = |all: &Self, o: usize| match names[o] == names[k] {
            true => Source::Register(d),
            false => all.source(names[o]),
        };
        let in_memory = |s: Source| matches!(s, Source::Memory(_));
        if others.iter().all(|o| in_memory(place(self, *o))) {
            // The operand that is read again sooner is loaded into a register.
            let sooner = if next[others[1]] < next[others[0]] { others[1] } else { others[0] };
            self.ensure_register(names[sooner], next[sooner], 1 << d);
        }
        let [x, y] = others.map(|o| place(self, o));
        self.free_last_reads(step);
        let (form, first, last) = match (x, y) {
            (Source::Register(x), y) => {
                (if k == 2 { Opcode::fused_231(sign) } else { Opcode::fused_213(sign) }, x, y)
            }
            (x, Source::Register(y)) => {
                (if k == 2 { Opcode::fused_231(sign) } else { Opcode::fused_132(sign) }, y, x)
            }
            _ => unreachable!("one of the two was loaded"),
        };
        self.assembler.vector(form, d, first, last);
        d
    }

    /// Returns the operand that the result replaces, in a register that no other number uses.
    fn destination_operand(&mut self, names: [Name; 3], next: [u32; 3]) -> (usize, u8) {
        let found = |all: &Self, k: usize| all.register(names[k]);
        // An operand that is read for the last time, or that is also in memory.
        let dying = [2, 0, 1].into_iter().find(|&k| next[k] == NEVER && found(self, k).is_some());
        let clean = || {
            let clean = |k: &usize| found(self, *k).is_some() && self.home[names[*k] as usize].is_some();
            [2, 0, 1].into_iter().filter(clean).max_by_key(|&k| next[k])
        };
        if let Some(k) = dying.or_else(clean) {
            let r = self.register(names[k]).expect("it is in a register");
            self.register[names[k] as usize] = NO_REGISTER;
            return (k, r);
        }
        // Otherwise a copy of an operand in memory, or of the addend.
        let k = [2, 0, 1].into_iter().filter(|&k| found(self, k).is_none()).max_by_key(|&k| next[k]);
        let d = self.take(self.bits(&names));
        match k {
            Some(k) => {
                let home = self.home[names[k] as usize].expect("what is in no register is in memory");
                self.load(d, home);
            }
            None => {
                let r = self.register(names[2]).expect("all are in registers");
                self.assembler.copy(d, r);
                self.counts.copies += 1;
            }
        }
        (k.unwrap_or(2), d)
    }

    /// The machine's maximum returns its second operand if either is NaN. In both orders the result is NaN at least
    /// once, and NaN ORed with any bits is NaN. Equal numbers differ only for zeros, and ORed they are -0.
    fn larger(&mut self, step: &Step) -> u8 {
        let &[a, b] = step.operands() else { unreachable!("two operands") };
        let a = self.ensure_register(a, step.next()[0], self.bits(&[b]));
        let b = self.ensure_register(b, step.next()[1], 1 << a);
        let other = self.take(1 << a | 1 << b);
        self.free_last_reads(step);
        let d = self.take(1 << other);
        self.assembler.vector(Opcode::MAX, other, a, Source::Register(b));
        self.assembler.vector(Opcode::MAX, d, b, Source::Register(a));
        self.assembler.vector(Opcode::OR, d, d, Source::Register(other));
        self.free |= 1 << other;
        d
    }

    /// Emits a call. A call changes all registers: numbers that are read later are stored before.
    fn call(&mut self, call: hardpoint_tape::Call, step: &Step) -> u8 {
        let cells = [self.frame.scratch(0), self.frame.scratch(self.frame.vector_bytes())];
        // Operands in registers first, because loading the others takes a register.
        for (name, cell) in step.operands().iter().zip(cells) {
            if let Some(r) = self.register(*name) {
                self.assembler.store(cell, r);
            }
        }
        let absent: Vec<(Memory, Memory)> = (step.operands().iter().zip(cells))
            .filter_map(|(name, cell)| match self.source(*name) {
                Source::Register(_) => None,
                Source::Memory(home) => Some((home, cell)),
            })
            .collect();
        self.free_last_reads(step);
        for r in 0..self.holders.len() as u8 {
            if self.free & 1 << r == 0 {
                self.evict(r);
                self.free |= 1 << r;
            }
        }
        for (home, cell) in absent {
            self.load(0, home);
            self.assembler.store(cell, 0);
        }
        frame::call(&mut self.assembler, cells[0], calls::which(call), calls::address(self.frame.width()));
        let d = self.take(0);
        self.load(d, cells[0]);
        d
    }

    /// Records that the result of an instruction is in this register, and stores its outputs.
    fn finish(&mut self, value: Name, r: u8) {
        let lowered = self.lowered;
        self.register[value as usize] = r;
        self.holders[usize::from(r)] = Holder { name: value, next: lowered.first[value as usize] };
        for (_, j) in lowered.outputs_of(value, &mut self.stored) {
            let at = self.frame.output(*j);
            self.assembler.store(at, r);
            self.home[value as usize].get_or_insert(at);
        }
        if lowered.first[value as usize] == NEVER {
            self.register[value as usize] = NO_REGISTER;
            self.free |= 1 << r;
        }
        self.free_slots.append(&mut self.last_read);
    }

    /// Frees the registers and slots of operands that are read for the last time.
    fn free_last_reads(&mut self, step: &Step) {
        for (name, next) in step.operands().iter().zip(step.next()) {
            if *next != NEVER {
                continue;
            }
            if let Some(r) = self.register(*name) {
                self.free |= 1 << r;
                self.register[*name as usize] = NO_REGISTER;
            }
            let spilled = |m: &mut Memory| self.lowered.names.is_value(*name) && m.base == Gpr::Rcx;
            if let Some(slot) = self.home[*name as usize].take_if(spilled) {
                self.last_read.push(slot);
            }
        }
    }

    fn register(&self, name: Name) -> Option<u8> {
        Some(self.register[name as usize]).filter(|r| *r != NO_REGISTER)
    }

    fn source(&self, name: Name) -> Source {
        match self.register(name) {
            Some(r) => Source::Register(r),
            None => Source::Memory(self.home[name as usize].expect("what is in no register is in memory")),
        }
    }

    /// Returns the registers of these numbers, as bits.
    fn bits(&self, names: &[Name]) -> u32 {
        names.iter().filter_map(|n| self.register(*n)).fold(0, |bits, r| bits | 1 << r)
    }

    /// Returns a register with the number, loaded if necessary, without changing those in `keep`.
    fn ensure_register(&mut self, name: Name, next: u32, keep: u32) -> u8 {
        if let Some(r) = self.register(name) {
            return r;
        }
        let home = self.home[name as usize].expect("what is in no register is in memory");
        let r = self.take(keep);
        self.load(r, home);
        self.register[name as usize] = r;
        self.holders[usize::from(r)] = Holder { name, next };
        r
    }

    fn load(&mut self, r: u8, from: Memory) {
        self.assembler.load(r, from);
        self.counts.loads += 1;
    }

    /// Returns a free register that is not in `keep`, after eviction if necessary.
    fn take(&mut self, keep: u32) -> u8 {
        let free = self.free & !keep;
        let r = if free != 0 {
            free.trailing_zeros() as u8
        } else {
            let r = (0..self.holders.len() as u8)
                .filter(|r| keep & 1 << r == 0)
                .max_by_key(|&r| {
                    let Holder { name, next } = self.holders[usize::from(r)];
                    next.saturating_add(if self.home[name as usize].is_some() { CLEAN } else { 0 })
                })
                .expect("an instruction has fewer operands than there are registers");
            self.evict(r);
            r
        };
        self.free &= !(1 << r);
        r
    }

    /// Evicts a number from a register, with a store if it has no location in memory.
    fn evict(&mut self, r: u8) {
        let name = self.holders[usize::from(r)].name;
        if self.home[name as usize].is_none() {
            let slot = self.free_slots.pop().unwrap_or_else(|| {
                self.slots += 1;
                self.frame.slot(self.slots - 1)
            });
            self.assembler.store(slot, r);
            self.counts.spills += 1;
            self.home[name as usize] = Some(slot);
        }
        self.register[name as usize] = NO_REGISTER;
    }
}
