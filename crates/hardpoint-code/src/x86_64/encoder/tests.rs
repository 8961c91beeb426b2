//! Every instruction is read back by a decoder.

use iced_x86::{Decoder, DecoderOptions, Formatter, IntelFormatter};

use super::*;

/// The text of the code, an instruction a line.
fn text(assembler: &Assembler) -> Vec<String> {
    let mut formatter = IntelFormatter::new();
    formatter.options_mut().set_space_after_operand_separator(false);
    formatter.options_mut().set_branch_leading_zeros(false);
    let lines: Vec<String> = Decoder::with_ip(64, &assembler.bytes, 0, DecoderOptions::NONE)
        .into_iter()
        .map(|i| {
            let mut line = String::new();
            formatter.format(&i, &mut line);
            line
        })
        .collect();
    assert_eq!(lines.len(), assembler.count, "instructions are counted");
    lines
}

/// All vector instructions: name, opcode, operands, and what follows the operands.
fn all() -> Vec<(String, Opcode, usize, &'static str)> {
    let mut all: Vec<(String, Opcode, usize, &str)> = vec![
        ("vsqrtpd".into(), Opcode::SQRT, 2, ""),
        ("vandpd".into(), Opcode::AND, 3, ""),
        ("vorpd".into(), Opcode::OR, 3, ""),
        ("vxorpd".into(), Opcode::XOR, 3, ""),
        ("vaddpd".into(), Opcode::ADD, 3, ""),
        ("vmulpd".into(), Opcode::MUL, 3, ""),
        ("vsubpd".into(), Opcode::SUB, 3, ""),
        ("vdivpd".into(), Opcode::DIV, 3, ""),
        ("vmaxpd".into(), Opcode::MAX, 3, ""),
        ("vroundpd".into(), Opcode::ROUND, 2, ",8"),
    ];
    for (name, sign) in [
        ("vfmadd", Sign::MulAdd),
        ("vfmsub", Sign::MulSub),
        ("vfnmadd", Sign::NegMulAdd),
        ("vfnmsub", Sign::NegMulSub),
    ] {
        all.push((format!("{name}132pd"), Opcode::fused_132(sign), 3, ""));
        all.push((format!("{name}213pd"), Opcode::fused_213(sign), 3, ""));
        all.push((format!("{name}231pd"), Opcode::fused_231(sign), 3, ""));
    }
    all
}

const BASES: [(Gpr, &str); 9] = [
    (Gpr::Rax, "rax"),
    (Gpr::Rcx, "rcx"),
    (Gpr::Rdx, "rdx"),
    (Gpr::Rsi, "rsi"),
    (Gpr::Rdi, "rdi"),
    (Gpr::R8, "r8"),
    (Gpr::R9, "r9"),
    (Gpr::R10, "r10"),
    (Gpr::R11, "r11"),
];

/// At and around the ends of short offsets, counted in bytes, scalars and vectors.
const OFFSETS: [i32; 22] = [
    0,
    1,
    8,
    32,
    64,
    127,
    128,
    1016,
    1024,
    8128,
    8192,
    -1,
    -8,
    -64,
    -128,
    -129,
    -136,
    -1024,
    -1032,
    -8192,
    -8256,
    0x1234_5678,
];

fn offset(offset: i32) -> String {
    match offset {
        0 => String::new(),
        o if o < 0 => format!("-{}", hex(o.unsigned_abs())),
        o => format!("+{}", hex(o as u32)),
    }
}

fn hex(n: u32) -> String {
    match format!("{n:X}") {
        short if n < 10 => short,
        long if long.starts_with(|c: char| c.is_ascii_digit()) => format!("{long}h"),
        long => format!("0{long}h"),
    }
}

#[test]
fn vector_instructions_are_what_a_decoder_reads() {
    for (width, r, size, registers) in
        [(Width::Avx2, "ymm", "ymmword", 16), (Width::Avx512, "zmm", "zmmword", 32)]
    {
        let mut assembler = Assembler::new(width);
        let mut expected = Vec::new();
        for (name, op, operands, rest) in all() {
            let name = match width {
                Width::Avx512 => name.replace("vroundpd", "vrndscalepd"),
                Width::Avx2 => name,
            };
            for k in 0..registers {
                // Every register in every position, each with different others.
                let (d, a, s) =
                    (k, if operands == 3 { (k * 7 + 3) % registers } else { 0 }, (k * 5 + 1) % registers);
                let a_text = if operands == 3 { format!("{r}{a},") } else { String::new() };
                assembler.vector(op, d, a, Source::Register(s));
                expected.push(format!("{name} {r}{d},{a_text}{r}{s}{rest}"));
                let (base, base_name) = BASES[usize::from(k) % BASES.len()];
                for o in OFFSETS {
                    let at = Memory { base, offset: o, broadcast: false };
                    assembler.vector(op, d, a, Source::Memory(at));
                    expected.push(format!("{name} {r}{d},{a_text}[{base_name}{}]{rest}", offset(o)));
                    if width == Width::Avx512 {
                        assembler.vector(op, d, a, Source::Memory(Memory { broadcast: true, ..at }));
                        expected
                            .push(format!("{name} {r}{d},{a_text}[{base_name}{}]{{1to8}}{rest}", offset(o)));
                    }
                }
            }
        }
        for k in 0..registers {
            let s = (k * 5 + 1) % registers;
            assembler.copy(k, s);
            expected.push(format!("vmovapd {r}{k},{r}{s}"));
            for (base, name) in BASES {
                for o in OFFSETS {
                    let at = Memory { base, offset: o, broadcast: false };
                    let place = format!("[{name}{}]", offset(o));
                    assembler.load(k, at);
                    expected.push(format!("vmovupd {r}{k},{place}"));
                    assembler.load(k, Memory { broadcast: true, ..at });
                    expected.push(format!("vbroadcastsd {r}{k},{place}"));
                    assembler.store(at, k);
                    expected.push(format!("vmovupd {place},{r}{k}"));
                }
            }
        }
        let read: Vec<String> = text(&assembler)
            .into_iter()
            .map(|l| l.replace(&format!("{size} ptr "), "").replace("qword ptr ", "").replace(",8h", ",8"))
            .collect();
        for (read, expected) in read.iter().zip(&expected) {
            assert_eq!(read, expected);
        }
        assert_eq!(read.len(), expected.len());
    }
}

#[test]
fn other_instructions_are_what_a_decoder_reads() {
    let mut a = Assembler::new(Width::Avx512);
    let back = a.here();
    for (r, _) in BASES {
        a.add(r, -0x123);
        a.double(r);
        a.decrement(r);
        a.test_odd(r);
        a.push(r);
        a.pop(r);
        a.address(r, Gpr::Rcx, -0x2000);
        a.address(Gpr::Rdi, r, 0x10);
        a.read(r, Gpr::Rdx, 8);
        a.read(Gpr::R11, r, -0x10);
        a.set(r, 0x0123_4567_89ab_cdef);
        a.call(r);
    }
    a.add(Gpr::Rsp, 8);
    let length = a.bytes.len();
    let forward = a.jump(Condition::Zero);
    a.zero_upper();
    a.jump_back(Condition::NotZero, back);
    a.bind(forward);
    a.ret();
    let mut expected = Vec::new();
    for (r, name) in BASES {
        let low = match r {
            Gpr::Rsi => "sil".to_string(),
            Gpr::Rdi => "dil".to_string(),
            Gpr::R8 | Gpr::R9 | Gpr::R10 | Gpr::R11 => format!("{name}b"),
            _ => format!("{}l", &name[1..2]),
        };
        expected.push(format!("add {name},0FFFFFFFFFFFFFEDDh"));
        expected.push(format!("add {name},{name}"));
        expected.push(format!("dec {name}"));
        expected.push(format!("test {low},1"));
        expected.push(format!("push {name}"));
        expected.push(format!("pop {name}"));
        expected.push(format!("lea {name},[rcx-2000h]"));
        expected.push(format!("lea rdi,[{name}+10h]"));
        expected.push(format!("mov {name},[rdx+8]"));
        expected.push(format!("mov r11,[{name}-10h]"));
        expected.push(format!("mov {name},123456789ABCDEFh"));
        expected.push(format!("call {name}"));
    }
    expected.push("add rsp,8".into());
    expected.push(format!("je {:X}h", length + 6 + 3 + 6));
    expected.push("vzeroupper".into());
    expected.push("jne 0".into());
    expected.push("ret".into());
    assert_eq!(text(&a), expected);
}

#[test]
#[should_panic(expected = "16 vector registers")]
fn avx2_has_sixteen_registers() {
    Assembler::new(Width::Avx2).copy(16, 0);
}

#[test]
#[should_panic(expected = "no operands that are broadcast")]
fn avx2_broadcasts_no_operands() {
    let at = Memory { base: Gpr::Rdi, offset: 0, broadcast: true };
    Assembler::new(Width::Avx2).vector(Opcode::ADD, 0, 0, Source::Memory(at));
}

#[test]
fn short_offsets_are_used_where_they_reach() {
    let length = |width, broadcast, offset| {
        let mut a = Assembler::new(width);
        a.vector(Opcode::ADD, 1, 2, Source::Memory(Memory { base: Gpr::Rdi, offset, broadcast }));
        a.bytes.len()
    };
    for (width, broadcast, unit, short) in
        [(Width::Avx2, false, 1, 5), (Width::Avx512, false, 64, 7), (Width::Avx512, true, 8, 7)]
    {
        assert_eq!([-128, 127].map(|n| length(width, broadcast, n * unit)), [short; 2]);
        assert_eq!([-129, 128].map(|n| length(width, broadcast, n * unit)), [short + 3; 2]);
    }
}
