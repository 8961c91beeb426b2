//! Straight-line programs as C functions of bounded length.

use std::fmt::Write;

use hardpoint_tape::{Call, Instruction, Operand, Program};

/// Number of instructions of a function: compilers take more than linear time for longer ones.
const LENGTH: usize = 400;

/// A program as a C function.
pub struct Function<'a> {
    pub name: &'a str,
    /// Name of the function that returns the larger of two numbers.
    pub larger: &'a str,
    pub program: &'a Program,
    /// Parameters: type and name, as in `const double *` and `x`. The last is `w`, working memory, which is followed
    /// by those that are written.
    pub parameters: &'a [(&'a str, &'a str)],
    /// Expression of every input.
    pub inputs: Vec<String>,
    /// Lvalue of every output; outputs without one are not computed.
    pub outputs: Vec<Option<String>>,
}

impl Function<'_> {
    /// Writes the function and returns the number of its working values.
    pub fn write(&self, out: &mut String) -> usize {
        let live = self.live();
        let kept: Vec<usize> = (0..live.len()).filter(|k| live[*k]).collect();
        let parts: Vec<&[usize]> = kept.chunks(LENGTH).collect();
        let mut part_of = vec![0; live.len()];
        for (p, part) in parts.iter().enumerate() {
            part.iter().for_each(|k| part_of[*k] = p);
        }
        let mut last_read = part_of.clone();
        for &k in &kept {
            for v in values(self.program.instructions[k]) {
                last_read[v] = last_read[v].max(part_of[k]);
            }
        }
        let mut slots = Slots { of: vec![None; live.len()], free: Vec::new(), count: 0 };
        let mut bodies: Vec<String> = Vec::new();
        for (p, part) in parts.iter().enumerate() {
            bodies.push(self.part(part, p, (&part_of, &last_read), &mut slots));
        }
        if bodies.is_empty() {
            bodies.push(String::new());
        }
        // Outputs that are no results of instructions.
        let last = bodies.last_mut().expect("at least one part");
        for (to, operand) in self.outputs.iter().zip(&self.program.outputs) {
            if let (Some(to), false) = (to, matches!(operand, Operand::Value(_))) {
                let _ = writeln!(last, "    {to} = {};", self.operand(*operand));
            }
        }
        self.write_parts(&bodies, out);
        slots.count
    }

    /// True for each instruction that an output depends on.
    fn live(&self) -> Vec<bool> {
        let mut live = vec![false; self.program.instructions.len()];
        for (to, operand) in self.outputs.iter().zip(&self.program.outputs) {
            if let (Some(_), Operand::Value(k)) = (to, operand) {
                live[*k as usize] = true;
            }
        }
        for k in (0..live.len()).rev().collect::<Vec<_>>() {
            if live[k] {
                values(self.program.instructions[k]).for_each(|v| live[v] = true);
            }
        }
        live
    }

    /// Statements of a part. Values that later parts read are written to working memory.
    fn part(
        &self,
        part: &[usize],
        p: usize,
        (part_of, last_read): (&[usize], &[usize]),
        slots: &mut Slots,
    ) -> String {
        let mut text = String::new();
        let reads = part.iter().flat_map(|k| values(self.program.instructions[*k]));
        let mut earlier: Vec<usize> = reads.filter(|v| part_of[*v] < p).collect();
        earlier.sort_unstable();
        earlier.dedup();
        for &v in &earlier {
            let slot = slots.of[v].expect("a value that a later part reads has a slot");
            let _ = writeln!(text, "    const double v{v} = w[{slot}];");
            if last_read[v] == p {
                slots.free.push(slot);
            }
        }
        let mut written: Vec<(usize, &str)> = Vec::new();
        for (to, operand) in self.outputs.iter().zip(&self.program.outputs) {
            if let (Some(to), Operand::Value(k)) = (to, operand)
                && part_of[*k as usize] == p
            {
                written.push((*k as usize, to));
            }
        }
        written.sort_unstable();
        let mut written = written.into_iter().peekable();
        for &k in part {
            let _ =
                writeln!(text, "    const double v{k} = {};", self.expression(self.program.instructions[k]));
            while let Some((_, to)) = written.next_if(|(value, _)| *value == k) {
                let _ = writeln!(text, "    {to} = v{k};");
            }
            if last_read[k] > p {
                let _ = writeln!(text, "    w[{}] = v{k};", slots.take(k));
            }
        }
        text
    }

    fn write_parts(&self, bodies: &[String], out: &mut String) {
        let parameters: Vec<String> =
            self.parameters.iter().map(|(of, name)| format!("{of}{name}")).collect();
        let parameters = parameters.join(", ");
        let names: Vec<String> = match bodies.len() {
            1 => vec![self.name.to_owned()],
            n => (0..n).map(|k| format!("{}_{k}", self.name)).collect(),
        };
        for (name, body) in names.iter().zip(bodies) {
            let _ = writeln!(out, "static void {name}({parameters})\n{{");
            out.push_str(body);
            for (_, parameter) in self.parameters {
                let uses = [format!("{parameter}["), format!("{parameter}->")];
                if !uses.iter().any(|used| has_word(body, used)) {
                    let _ = writeln!(out, "    (void)({parameter});");
                }
            }
            out.push_str("}\n\n");
        }
        if names.len() > 1 {
            let arguments: Vec<&str> = self.parameters.iter().map(|(_, name)| *name).collect();
            let arguments = arguments.join(", ");
            let _ = writeln!(out, "static void {}({parameters})\n{{", self.name);
            names.iter().for_each(|name| out.push_str(&format!("    {name}({arguments});\n")));
            out.push_str("}\n\n");
        }
    }

    fn operand(&self, operand: Operand) -> String {
        match operand {
            Operand::Value(k) => format!("v{k}"),
            Operand::Input(k) => self.inputs[k as usize].clone(),
            Operand::Constant(k) => literal(self.program.constants[k as usize]),
            Operand::Uniform(_) => unreachable!("steps of drivers have no uniforms"),
        }
    }

    fn expression(&self, instruction: Instruction) -> String {
        use Instruction::*;
        let x = |operand| self.operand(operand);
        match instruction {
            Add(a, b) => format!("{} + {}", x(a), x(b)),
            Sub(a, b) => format!("{} - {}", x(a), x(b)),
            Mul(a, b) => format!("{} * {}", x(a), x(b)),
            Div(a, b) => format!("{} / {}", x(a), x(b)),
            MulAdd(a, b, c) => format!("{} * {} + {}", x(a), x(b), x(c)),
            MulSub(a, b, c) => format!("{} * {} - {}", x(a), x(b), x(c)),
            NegMulAdd(a, b, c) => format!("{} - {} * {}", x(c), x(a), x(b)),
            NegMulSub(a, b, c) => format!("-({} * {}) - {}", x(a), x(b), x(c)),
            Neg(a) => format!("-{}", x(a)),
            Abs(a) => format!("fabs({})", x(a)),
            Sqrt(a) => format!("sqrt({})", x(a)),
            Round(a) => format!("rint({})", x(a)),
            Larger(a, b) => format!("{}({}, {})", self.larger, x(a), x(b)),
            Call(function, a, b) if function.is_of_two() => {
                format!("{}({}, {})", function_name(function), x(a), x(b))
            }
            Call(function, a, _) => format!("{}({})", function_name(function), x(a)),
        }
    }
}

/// True if a text contains this one as the beginning of a word.
fn has_word(text: &str, word: &str) -> bool {
    let inside = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '>' | '.');
    text.match_indices(word).any(|(at, _)| !text[..at].ends_with(inside))
}

/// Indices of the values that an instruction reads.
fn values(instruction: Instruction) -> impl Iterator<Item = usize> {
    instruction.operands().filter_map(|operand| match operand {
        Operand::Value(v) => Some(v as usize),
        Operand::Input(_) | Operand::Uniform(_) | Operand::Constant(_) => None,
    })
}

/// Name in `math.h`.
fn function_name(function: Call) -> &'static str {
    match function {
        Call::Tan => "tan",
        Call::Asin => "asin",
        Call::Acos => "acos",
        Call::Atan => "atan",
        Call::Sinh => "sinh",
        Call::Cosh => "cosh",
        Call::Tanh => "tanh",
        Call::Exp => "exp",
        Call::Ln => "log",
        Call::Atan2 => "atan2",
        Call::Pow => "pow",
    }
}

/// Numbers of a body, in the order of the programs: r, the columns of A, v, omega, a, alpha.
pub const BODY: usize = 24;

/// Text within a comment.
pub fn comment(text: &str) -> String {
    let plain = |c: char| if c.is_control() { ' ' } else { c };
    text.chars().map(plain).collect::<String>().replace("*/", "* /").replace("/*", "/ *").replace('@', "(at)")
}

/// A number with all its digits; a negative one in parentheses.
pub fn literal(x: f64) -> String {
    let magnitude = match x.abs() {
        m if m.is_nan() => return "NAN".to_owned(),
        m if m.is_infinite() => "INFINITY".to_owned(),
        m if (1e-3..1e6).contains(&m) || m == 0.0 => format!("{m:?}"),
        m => format!("{m:e}"),
    };
    if x < 0.0 { format!("(-{magnitude})") } else { magnitude }
}

/// Lvalue of number k of a body.
pub fn body_number(of: &str, body: usize, k: usize) -> String {
    let at = match k {
        0..3 => format!("r[{k}]"),
        3..12 => format!("axis[{}][{}]", (k - 3) / 3, k % 3),
        12..15 => format!("v[{}]", k % 3),
        15..18 => format!("omega[{}]", k % 3),
        18..21 => format!("a[{}]", k % 3),
        _ => format!("alpha[{}]", k % 3),
    };
    format!("{of}->body[{}].{at}", body - 1)
}

/// Places of values in working memory; those of values that are no longer read are used again.
struct Slots {
    of: Vec<Option<usize>>,
    free: Vec<usize>,
    count: usize,
}

impl Slots {
    fn take(&mut self, value: usize) -> usize {
        let slot = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        self.of[value] = Some(slot);
        slot
    }
}
