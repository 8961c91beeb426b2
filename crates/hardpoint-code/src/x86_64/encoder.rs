//! Encoder of machine instructions: the subset for straight-line programs, as VEX (AVX2) and EVEX (AVX-512).
//!
//! Encodings are those of Intel's manual, volume 2; the tests read them back with a decoder.

use crate::Width;

/// General-purpose register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gpr {
    Rax = 0,
    Rcx = 1,
    Rdx = 2,
    Rsp = 4,
    Rsi = 6,
    Rdi = 7,
    R8 = 8,
    R9 = 9,
    R10 = 10,
    R11 = 11,
}

/// Number in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory {
    pub base: Gpr,
    /// Offset, bytes.
    pub offset: i32,
    /// True for one scalar that is broadcast to all lanes: AVX-512 only.
    pub broadcast: bool,
}

/// Last operand of a vector instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    Register(u8),
    Memory(Memory),
}

/// Vector instruction on doubles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Opcode {
    /// Opcode map: 1 is 0F, 2 is 0F38, 3 is 0F3A.
    map: u8,
    code: u8,
    /// VEX.W; EVEX.W is always one.
    wide: bool,
    /// Immediate byte.
    immediate: Option<u8>,
    /// True if the operand in memory is one scalar.
    scalar: bool,
}

impl Opcode {
    const fn of(map: u8, code: u8) -> Self {
        Self { map, code, wide: map == 2, immediate: None, scalar: false }
    }

    pub const SQRT: Self = Self::of(1, 0x51);
    pub const AND: Self = Self::of(1, 0x54);
    pub const OR: Self = Self::of(1, 0x56);
    pub const XOR: Self = Self::of(1, 0x57);
    pub const ADD: Self = Self::of(1, 0x58);
    pub const MUL: Self = Self::of(1, 0x59);
    pub const SUB: Self = Self::of(1, 0x5c);
    pub const DIV: Self = Self::of(1, 0x5e);
    /// Maximum; the second operand if either is NaN or both are zero.
    pub const MAX: Self = Self::of(1, 0x5f);
    /// Rounding to the nearest integer, ties to even, independent of the rounding mode, without the inexact exception.
    pub const ROUND: Self = Self { immediate: Some(8), ..Self::of(3, 0x09) };
    /// Load from unaligned memory.
    const LOAD: Self = Self::of(1, 0x10);
    const STORE: Self = Self::of(1, 0x11);
    const MOVE: Self = Self::of(1, 0x28);
    const BROADCAST: Self = Self { wide: false, scalar: true, ..Self::of(2, 0x19) };

    /// `d = d s + a`.
    pub const fn fused_132(sign: Sign) -> Self {
        Self::of(2, 0x98 + sign as u8)
    }

    /// `d = a d + s`.
    pub const fn fused_213(sign: Sign) -> Self {
        Self::of(2, 0xa8 + sign as u8)
    }

    /// `d = a s + d`.
    pub const fn fused_231(sign: Sign) -> Self {
        Self::of(2, 0xb8 + sign as u8)
    }
}

/// Signs of a fused multiplication and addition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// `a b + c`.
    MulAdd = 0,
    /// `a b - c`.
    MulSub = 2,
    /// `c - a b`.
    NegMulAdd = 4,
    /// `-(a b) - c`.
    NegMulSub = 6,
}

/// Target of a jump: a position in the code.
#[derive(Clone, Copy, Debug)]
pub struct Label(usize);

/// Jump whose target is not known yet.
#[derive(Debug)]
#[must_use]
pub struct Forward(usize);

/// Condition of a jump.
#[derive(Clone, Copy, Debug)]
pub enum Condition {
    Zero = 4,
    NotZero = 5,
}

/// Assembler: code under construction.
#[derive(Debug)]
pub struct Assembler {
    width: Width,
    pub bytes: Vec<u8>,
    /// Number of instructions.
    pub count: usize,
}

impl Assembler {
    pub fn new(width: Width) -> Self {
        Self { width, bytes: Vec::new(), count: 0 }
    }

    /// Emits `d = a op s`. Instructions of one operand have `a` = 0.
    pub fn vector(&mut self, op: Opcode, d: u8, a: u8, s: Source) {
        match self.width {
            Width::Avx512 => self.evex(op, d, a, s),
            Width::Avx2 => self.vex(op, d, a, s),
        }
        self.bytes.extend(op.immediate);
        self.count += 1;
    }

    /// Emits a load from memory into a register; `broadcast` fills all lanes.
    pub fn load(&mut self, d: u8, m: Memory) {
        let op = if m.broadcast { Opcode::BROADCAST } else { Opcode::LOAD };
        self.vector(op, d, 0, Source::Memory(Memory { broadcast: false, ..m }));
    }

    pub fn store(&mut self, m: Memory, s: u8) {
        self.vector(Opcode::STORE, s, 0, Source::Memory(m));
    }

    /// Emits a copy from register to register.
    pub fn copy(&mut self, d: u8, s: u8) {
        self.vector(Opcode::MOVE, d, 0, Source::Register(s));
    }

    fn evex(&mut self, op: Opcode, d: u8, a: u8, s: Source) {
        assert!(d < 32 && a < 32, "there are 32 vector registers");
        let (x, b, broadcast) = match s {
            Source::Register(r) => {
                assert!(r < 32, "there are 32 vector registers");
                (r >> 4, r >> 3 & 1, false)
            }
            Source::Memory(m) => (0, m.base as u8 >> 3, m.broadcast),
        };
        // Extensions of register numbers are stored inverted; 1 in the second byte represents the prefix 66,
        // 10 in the last for 512 bits.
        let p0 = (!(d >> 3) & 1) << 7 | (!x & 1) << 6 | (!b & 1) << 5 | (!(d >> 4) & 1) << 4 | op.map;
        let p1 = 1 << 7 | (!a & 15) << 3 | 1 << 2 | 1;
        let p2 = 0b10 << 5 | u8::from(broadcast) << 4 | (!(a >> 4) & 1) << 3;
        self.bytes.extend([0x62, p0, p1, p2, op.code]);
        // Short offsets count in operands.
        self.operand(d & 7, s, if broadcast || op.scalar { 8 } else { 64 });
    }

    fn vex(&mut self, op: Opcode, d: u8, a: u8, s: Source) {
        assert!(d < 16 && a < 16, "there are 16 vector registers");
        let b = match s {
            Source::Register(r) => {
                assert!(r < 16, "there are 16 vector registers");
                r >> 3
            }
            Source::Memory(m) => {
                assert!(!m.broadcast, "AVX2 has no operands that are broadcast");
                m.base as u8 >> 3
            }
        };
        // 1 for 256 bits, 01 for the prefix 66.
        let last = (!a & 15) << 3 | 1 << 2 | 1;
        let r = (!(d >> 3) & 1) << 7;
        if b == 0 && op.map == 1 {
            self.bytes.extend([0xc5, r | last]);
        } else {
            self.bytes.extend([0xc4, r | 1 << 6 | (!b & 1) << 5 | op.map, u8::from(op.wide) << 7 | last]);
        }
        self.bytes.push(op.code);
        self.operand(d & 7, s, 1);
    }

    /// Emits the register or memory operand; offsets are short if they are small multiples of `unit`.
    fn operand(&mut self, reg: u8, s: Source, unit: i32) {
        match s {
            Source::Register(r) => self.bytes.push(0b11 << 6 | reg << 3 | r & 7),
            Source::Memory(m) => {
                let base = m.base as u8 & 7;
                assert!(base != 4, "rsp is no base of operands");
                match i8::try_from(m.offset / unit) {
                    Ok(short) if m.offset % unit == 0 => {
                        self.bytes.push(0b01 << 6 | reg << 3 | base);
                        self.bytes.push(short as u8);
                    }
                    _ => {
                        self.bytes.push(0b10 << 6 | reg << 3 | base);
                        self.bytes.extend(m.offset.to_le_bytes());
                    }
                }
            }
        }
    }

    /// Zeroes the upper halves of registers, so that code without AVX continues at full speed.
    pub fn zero_upper(&mut self) {
        self.raw(&[0xc5, 0xf8, 0x77]);
    }

    /// Emits `r += by`, with flags.
    pub fn add(&mut self, r: Gpr, by: i32) {
        let [a, b, c, d] = by.to_le_bytes();
        self.raw(&[0x48 | r as u8 >> 3, 0x81, 0b11 << 6 | r as u8 & 7, a, b, c, d]);
    }

    /// Emits `r += r`.
    pub fn double(&mut self, r: Gpr) {
        let (high, low) = (r as u8 >> 3, r as u8 & 7);
        self.raw(&[0x48 | high << 2 | high, 0x01, 0b11 << 6 | low << 3 | low]);
    }

    /// Emits `r -= 1`, with flags.
    pub fn decrement(&mut self, r: Gpr) {
        self.raw(&[0x48 | r as u8 >> 3, 0xff, 0b11 << 6 | 1 << 3 | r as u8 & 7]);
    }

    /// Emits a test of the last bit of `r`, with flags.
    pub fn test_odd(&mut self, r: Gpr) {
        self.raw(&[0x40 | r as u8 >> 3, 0xf6, 0b11 << 6 | r as u8 & 7, 1]);
    }

    pub fn push(&mut self, r: Gpr) {
        self.raw(&[0x40 | r as u8 >> 3, 0x50 | r as u8 & 7]);
    }

    pub fn pop(&mut self, r: Gpr) {
        self.raw(&[0x40 | r as u8 >> 3, 0x58 | r as u8 & 7]);
    }

    /// Emits `d` = the address `base + offset`.
    pub fn address(&mut self, d: Gpr, base: Gpr, offset: i32) {
        self.general(0x8d, d, base, offset);
    }

    /// Emits `d` = the word at `base + offset`.
    pub fn read(&mut self, d: Gpr, base: Gpr, offset: i32) {
        self.general(0x8b, d, base, offset);
    }

    /// Emits an instruction on `d` and memory at `base + offset`.
    fn general(&mut self, code: u8, d: Gpr, base: Gpr, offset: i32) {
        let (d, base) = (d as u8, base as u8);
        assert!(base & 7 != 4, "rsp is no base of operands");
        let [a, b, c, e] = offset.to_le_bytes();
        self.raw(&[0x48 | d >> 3 << 2 | base >> 3, code, 0b10 << 6 | (d & 7) << 3 | base & 7, a, b, c, e]);
    }

    pub fn set(&mut self, r: Gpr, to: u64) {
        let mut bytes = [0x48 | r as u8 >> 3, 0xb8 | r as u8 & 7, 0, 0, 0, 0, 0, 0, 0, 0];
        bytes[2..].copy_from_slice(&to.to_le_bytes());
        self.raw(&bytes);
    }

    /// Emits a call of the function at address `r`.
    pub fn call(&mut self, r: Gpr) {
        self.raw(&[0x40 | r as u8 >> 3, 0xff, 0b11 << 6 | 2 << 3 | r as u8 & 7]);
    }

    pub fn ret(&mut self) {
        self.raw(&[0xc3]);
    }

    /// Returns the current position.
    pub fn here(&self) -> Label {
        Label(self.bytes.len())
    }

    pub fn jump_back(&mut self, when: Condition, to: Label) {
        let Forward(at) = self.jump(when);
        self.patch_jump(at, to.0);
    }

    pub fn jump(&mut self, when: Condition) -> Forward {
        self.raw(&[0x0f, 0x80 | when as u8, 0, 0, 0, 0]);
        Forward(self.bytes.len())
    }

    /// Sets the target of a jump to the current position.
    pub fn bind(&mut self, Forward(at): Forward) {
        self.patch_jump(at, self.bytes.len());
    }

    /// Writes the distance of a jump: from its end, `at`, to its target.
    fn patch_jump(&mut self, at: usize, aim: usize) {
        let by = i32::try_from(aim as i64 - at as i64).expect("code is below 2 GB");
        self.bytes[at - 4..at].copy_from_slice(&by.to_le_bytes());
    }

    fn raw(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
        self.count += 1;
    }
}

#[cfg(test)]
mod tests;
