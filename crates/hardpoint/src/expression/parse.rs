//! Parser of expressions.
//!
//! `winnow` splits the text into tokens. The grammar is a recursive descent with one token of lookahead, so that every
//! error knows what was expected:
//!
//! ```text
//! sum     = product (("+" | "-") product)*
//! product = signed (("*" | "/") signed)*
//! signed  = ("+" | "-")* power
//! power   = primary ("^" signed)?
//! primary = number | "t" | "pi" | parameter | function "(" arguments ")" | "(" sum ")"
//! ```
//!
//! A parameter is one of the given names. In a text that is not a law it is any other name, including one of two parts:
//! `ball.x`.

use std::collections::HashMap;
use std::ops::Range;

use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, eof, opt};
use winnow::error::EmptyError;
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{any, one_of, take_while};

use crate::number::Function;

use super::program::{MAX_WAITING, Operation, Program};
use super::term::{Binary, Relation};

/// Error in the text of a law or expression.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// Position of the error, as a range of bytes of the expression's text; on character boundaries.
    pub span: Range<usize>,
    /// Description of the error, as a complete phrase.
    pub message: String,
    /// Instruction to correct the error, if there is one.
    pub help: Option<String>,
}

/// Maximum number of nested parentheses, calls and exponents.
const MAX_NESTING: usize = 64;

/// Translation of a name with arguments into an operation.
#[derive(Clone, Copy)]
enum Call {
    One(Function),
    Two(Binary),
    /// Function of two or more arguments, applied to two at a time.
    Fold(Binary),
    Power,
    Step,
    If,
}

/// Functions with more than one argument: the preceding function of one argument in lists, the name, the signature, and
/// the call.
const OF_MORE: [(Function, &str, &str, Call); 7] = [
    (Function::Atan, "atan2", "atan2(y, x)", Call::Two(Binary::Atan2)),
    (Function::Sqrt, "pow", "pow(x, p)", Call::Power),
    (Function::Sqrt, "hypot", "hypot(x, y)", Call::Two(Binary::Hypot)),
    (Function::Abs, "min", "min(a, b, ...)", Call::Fold(Binary::Min)),
    (Function::Abs, "max", "max(a, b, ...)", Call::Fold(Binary::Max)),
    (Function::Abs, "step", "step(x, x0, h0, x1, h1)", Call::Step),
    (Function::Abs, "if", "if(a < b, x, y)", Call::If),
];

/// All functions in the order in which help lists them, each with its signature if that is not `name(x)`.
fn functions() -> impl Iterator<Item = (&'static str, Option<&'static str>, Call)> {
    Function::ALL.iter().flat_map(|&function| {
        let following = OF_MORE.iter().filter(move |(after, ..)| *after == function);
        let following = following.map(|&(_, name, signature, call)| (name, Some(signature), call));
        std::iter::once((function.name(), None, Call::One(function))).chain(following)
    })
}

/// Parses a law, with `parameters` as additional names.
pub(crate) fn parse(text: &str, parameters: &[&str]) -> Result<Program, ExpressionError> {
    let mut descent = Descent::new(text, parameters);
    descent.program = Program::of_time();
    let mut known = std::collections::BTreeSet::new();
    for name in parameters {
        descent.check_parameter(name, known.insert(name))?;
    }
    if descent.token == Token::End {
        let help = "write an expression in the time t, such as `0.1*sin(2*pi*t)`";
        return Err(error(0..text.len(), "the expression is empty", Some(help)));
    }
    descent.sum()?;
    match descent.token {
        Token::End => {}
        _ => return Err(descent.unexpected()),
    }
    match descent.is_used.iter().position(|is_used| !is_used) {
        Some(unused) => {
            let message = format!("the parameter `{}` is not used in the expression", parameters[unused]);
            Err(error(0..text.len(), message, Some("use it, or remove it")))
        }
        None => Ok(descent.program),
    }
}

/// Parses an expression without the time. Also returns the other names in it, in the order of their first use.
pub(crate) fn parse_open(text: &str) -> Result<(Program, Vec<&str>), ExpressionError> {
    let mut descent = Descent::new(text, &[]);
    descent.free = Some(Free::default());
    if descent.token == Token::End {
        let help = "write an expression, such as `2*width + 5`";
        return Err(error(0..text.len(), "the expression is empty", Some(help)));
    }
    descent.sum()?;
    match descent.token {
        Token::End => Ok((descent.program, descent.free.unwrap_or_default().names)),
        _ => Err(descent.unexpected()),
    }
}

/// Names in a text that are not built in, each once.
pub(crate) fn names(text: &str) -> Vec<&str> {
    let (mut descent, mut free) = (Descent::new(text, &[]), Free::default());
    while descent.token != Token::End {
        if let Token::Name(name) = descent.token
            && !is_taken(name)
        {
            free.number(name);
        }
        descent.advance();
    }
    free.names
}

/// Names in a text that are not declared in advance.
#[derive(Default)]
struct Free<'a> {
    names: Vec<&'a str>,
    /// Index of each name. Only used for lookups, never iterated.
    numbers: HashMap<&'a str, usize>,
}

impl<'a> Free<'a> {
    /// Index of a name; a new one gets the next index.
    fn number(&mut self, name: &'a str) -> usize {
        let next = self.names.len();
        let number = *self.numbers.entry(name).or_insert(next);
        if number == next {
            self.names.push(name);
        }
        number
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Symbol(&'a str),
    End,
}

type Input<'a> = LocatingSlice<&'a str>;

fn token<'a>(input: &mut Input<'a>) -> Result<Token<'a>, EmptyError> {
    alt((
        number.map(Token::Number),
        dotted.map(Token::Name),
        alt(("**", "<=", ">=", "==", "!=", "&&", "||")).map(Token::Symbol),
        any.take().map(Token::Symbol),
        eof.value(Token::End),
    ))
    .parse_next(input)
}

fn number(input: &mut Input<'_>) -> Result<f64, EmptyError> {
    let mantissa = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    (mantissa, opt(exponent)).take().parse_to().parse_next(input)
}

/// A name, or two names joined by a point.
fn dotted<'a>(input: &mut Input<'a>) -> Result<&'a str, EmptyError> {
    (name, opt(('.', name))).take().parse_next(input)
}

fn name<'a>(input: &mut Input<'a>) -> Result<&'a str, EmptyError> {
    let first = one_of(|c: char| c.is_alphabetic() || c == '_');
    let rest = take_while(0.., |c: char| c.is_alphabetic() || c.is_ascii_digit() || c == '_');
    (first, rest).take().parse_next(input)
}

/// Recursive descent; each rule leaves one operand in the program.
struct Descent<'a> {
    text: &'a str,
    parameters: &'a [&'a str],
    is_used: Vec<bool>,
    /// Names used so far, in a text that is not a law.
    free: Option<Free<'a>>,
    rest: Input<'a>,
    token: Token<'a>,
    span: Range<usize>,
    /// Span of the previous token; empty at the start.
    previous: Range<usize>,
    nesting: usize,
    program: Program,
}

impl<'a> Descent<'a> {
    fn new(text: &'a str, parameters: &'a [&'a str]) -> Self {
        let mut descent = Self {
            text,
            parameters,
            is_used: vec![false; parameters.len()],
            free: None,
            rest: LocatingSlice::new(text),
            token: Token::End,
            span: 0..0,
            previous: 0..0,
            nesting: 0,
            program: Program::default(),
        };
        descent.read();
        descent
    }

    /// Checks that the name of a parameter is valid and unique; `is_new` if it is not yet among the parameters.
    fn check_parameter(&self, name: &str, is_new: bool) -> Result<(), ExpressionError> {
        let is_known = is_taken(name);
        let (message, help) = if is_known {
            (
                format!("a parameter cannot be called `{name}`: the expression knows that name already"),
                "rename it",
            )
        } else if !is_new {
            (format!("two parameters are named `{name}`"), "rename one of them")
        } else if (self::name, eof).parse_next(&mut LocatingSlice::new(name)).is_err() {
            let help = "use letters, digits and `_`, and begin with a letter or `_`";
            (format!("`{}` cannot be the name of a parameter", name.escape_debug()), help)
        } else {
            return Ok(());
        };
        Err(error(0..self.text.len(), message, Some(help)))
    }

    fn sum(&mut self) -> Result<(), ExpressionError> {
        self.product()?;
        loop {
            let operator = match self.token {
                Token::Symbol("+") => Binary::Add,
                Token::Symbol("-") => Binary::Sub,
                _ => return Ok(()),
            };
            self.advance();
            self.product()?;
            self.program.emit(Operation::Two(operator));
        }
    }

    fn product(&mut self) -> Result<(), ExpressionError> {
        self.signed()?;
        loop {
            let operator = match self.token {
                Token::Symbol("*") => Binary::Mul,
                Token::Symbol("/") => Binary::Div,
                _ => return Ok(()),
            };
            self.advance();
            self.signed()?;
            self.program.emit(Operation::Two(operator));
        }
    }

    fn signed(&mut self) -> Result<(), ExpressionError> {
        let mut is_negative = false;
        while let Token::Symbol(sign @ ("+" | "-")) = self.token {
            is_negative ^= sign == "-";
            self.advance();
        }
        self.power()?;
        if is_negative {
            self.program.emit(Operation::Neg);
        }
        Ok(())
    }

    fn power(&mut self) -> Result<(), ExpressionError> {
        self.primary()?;
        if self.token == Token::Symbol("^") {
            self.advance();
            self.nested(Self::signed)?;
            self.program.emit_power();
        }
        Ok(())
    }

    fn primary(&mut self) -> Result<(), ExpressionError> {
        match self.token {
            Token::Number(value) if value.is_finite() => self.leaf(Operation::Constant(value)),
            Token::Number(_) => {
                Err(error(self.span.clone(), "the number is too large", Some("the largest is 1.79e308")))
            }
            Token::Name("t") if self.free.is_some() => {
                let help = "only laws of drivers depend on the time; rename the parameter if one is meant";
                Err(error(self.span.clone(), "`t` is the time, which has no meaning here", Some(help)))
            }
            Token::Name("t") => self.leaf(Operation::Time),
            Token::Name(PI) => self.leaf(Operation::Constant(std::f64::consts::PI)),
            Token::Name(name) if self.parameters.contains(&name) => {
                let parameter = self.parameters.iter().position(|known| *known == name).unwrap_or_default();
                self.is_used[parameter] = true;
                self.leaf(Operation::Parameter(parameter))
            }
            Token::Name(name) => match functions().find(|(known, ..)| *known == name) {
                Some((name, signature, function)) => {
                    let signature = signature.map_or_else(|| format!("{name}(x)"), str::to_owned);
                    self.call(name, &signature, function)
                }
                None => match &mut self.free {
                    Some(free) => {
                        let number = free.number(name);
                        self.leaf(Operation::Parameter(number))
                    }
                    None => Err(self.unknown_name(name)),
                },
            },
            Token::Symbol("(") => {
                let open = self.span.clone();
                self.advance();
                self.nested(Self::sum)?;
                self.close(open)
            }
            _ => Err(self.missing_value()),
        }
    }

    fn leaf(&mut self, operation: Operation) -> Result<(), ExpressionError> {
        if self.program.is_full() {
            return Err(self.too_deep(&format!("at most {MAX_WAITING} operands may wait for their operator")));
        }
        self.program.emit(operation);
        self.advance();
        Ok(())
    }

    fn call(&mut self, name: &str, signature: &str, function: Call) -> Result<(), ExpressionError> {
        let name_start = self.span.start;
        self.advance();
        if self.token != Token::Symbol("(") {
            let message = format!("`{name}` is a function and needs parentheses");
            return Err(error(self.previous.clone(), message, Some(&format!("write `{signature}`"))));
        }
        let open = self.span.clone();
        self.advance();

        let (fewest, most) = match function {
            Call::One(_) => (1, 1),
            Call::Two(_) | Call::Power => (2, 2),
            Call::Fold(_) => (2, usize::MAX),
            Call::If => (3, 3),
            Call::Step => (5, 5),
        };
        let mut comparison = Relation::Less;
        let mut arguments = Vec::new(); // where each begins in the program, and its span
        while self.token != Token::Symbol(")") || !arguments.is_empty() {
            let (first_operation, start) = (self.program.len(), self.span.start);
            if matches!(function, Call::If) && arguments.is_empty() {
                comparison = self.condition()?;
            } else {
                self.nested(Self::sum)?;
            }
            arguments.push((first_operation, start..self.previous.end));
            match function {
                Call::Fold(fold) if arguments.len() > 1 => self.program.emit(Operation::Two(fold)),
                // Counted only, for the error message.
                _ if arguments.len() > most => self.program.drop_operand(first_operation),
                _ => {}
            }
            if self.token != Token::Symbol(",") {
                break;
            }
            self.advance();
        }
        self.close(open)?;

        if arguments.len() < fewest || arguments.len() > most {
            let wanted = match function {
                Call::One(_) => "1 argument".to_owned(),
                Call::Fold(_) => "2 or more arguments".to_owned(),
                _ => format!("{fewest} arguments"),
            };
            let message = format!("`{name}` takes {wanted}, not {}", arguments.len());
            return Err(error(name_start..self.previous.end, message, Some(&format!("write `{signature}`"))));
        }
        match function {
            Call::One(function) => self.program.emit(Operation::One(function)),
            Call::Two(function) => self.program.emit(Operation::Two(function)),
            Call::Fold(_) => {} // emitted one by one above
            Call::Power => self.program.emit_power(),
            Call::If => self.program.emit(Operation::Select(comparison)),
            Call::Step => {
                self.check_step_order(&arguments)?;
                self.program.emit(Operation::Step);
            }
        }
        Ok(())
    }

    /// Parses `a < b`; leaves a and b in the program.
    fn condition(&mut self) -> Result<Relation, ExpressionError> {
        let start = self.span.start;
        self.nested(Self::sum)?;
        let comparison = match self.token {
            Token::Symbol("<") => Relation::Less,
            Token::Symbol("<=") => Relation::LessOrEqual,
            Token::Symbol(">") => Relation::Greater,
            Token::Symbol(">=") => Relation::GreaterOrEqual,
            Token::Symbol(symbol @ ("=" | "==" | "!=")) => {
                let message = format!("a law cannot be compared with `{symbol}`");
                return Err(error(self.span.clone(), message, Some("use `<`, `<=`, `>` or `>=`")));
            }
            Token::Symbol("," | ")") | Token::End => {
                let message = "the first argument of `if` must be a comparison";
                let help = "compare with `<`, `<=`, `>` or `>=`, as in `if(t < 1, x, y)`";
                return Err(error(start..self.previous.end, message, Some(help)));
            }
            _ => return Err(self.unexpected()),
        };
        self.advance();
        self.nested(Self::sum)?;
        if let Token::Symbol("<" | "<=" | ">" | ">=" | "=" | "==" | "!=" | "&&" | "||") = self.token {
            let message = "an `if` has one comparison only";
            return Err(error(
                self.span.clone(),
                message,
                Some("nest a second `if` for a second comparison"),
            ));
        }
        Ok(comparison)
    }

    /// Checks the order of the ends of a step if they are plain numbers: an error here prevents a NaN later.
    fn check_step_order(&self, arguments: &[(usize, Range<usize>)]) -> Result<(), ExpressionError> {
        let [_, x0, h0, x1, h1] = arguments else {
            return Ok(());
        };
        let number = |from: usize, to: usize| self.program.constant_at(from).filter(|_| to == from + 1);
        match (number(x0.0, h0.0), number(x1.0, h1.0)) {
            (Some(x0_value), Some(x1_value)) if x0_value >= x1_value => {
                let message =
                    format!("`step` must rise from x0 to x1, but x0 = {x0_value} and x1 = {x1_value}");
                let help = "write `step(x, x0, h0, x1, h1)` with x0 < x1; h1 may be less than h0";
                Err(error(x0.1.start..x1.1.end, message, Some(help)))
            }
            _ => Ok(()),
        }
    }

    fn close(&mut self, open: Range<usize>) -> Result<(), ExpressionError> {
        match self.token {
            Token::Symbol(")") => {
                self.advance();
                Ok(())
            }
            Token::End => Err(error(open, "missing `)`: this `(` is not closed", None)),
            _ => Err(self.unexpected()),
        }
    }

    fn nested<T>(
        &mut self,
        rule: impl FnOnce(&mut Self) -> Result<T, ExpressionError>,
    ) -> Result<T, ExpressionError> {
        if self.nesting == MAX_NESTING {
            let help = format!("at most {MAX_NESTING} parentheses and exponents may be open at once");
            return Err(self.too_deep(&help));
        }
        self.nesting += 1;
        let result = rule(self)?;
        self.nesting -= 1;
        Ok(result)
    }

    fn advance(&mut self) {
        self.previous = self.span.clone();
        self.read();
    }

    fn read(&mut self) {
        let end = self.text.len()..self.text.len();
        let spaces = take_while::<_, _, EmptyError>(0.., char::is_whitespace);
        (self.token, self.span) = (spaces, token.with_span())
            .map(|(_, token)| token)
            .parse_next(&mut self.rest)
            .unwrap_or((Token::End, end));
    }

    /// Error for a missing operand at the current token.
    fn missing_value(&self) -> ExpressionError {
        match self.token {
            Token::Symbol("*" | "/" | "^" | "**" | "<" | "<=" | ">" | ">=" | ")" | ",") | Token::End => {}
            _ => return self.unexpected(),
        }
        if self.previous.is_empty() {
            return error(
                self.span.clone(),
                format!("a value is missing before `{}`", self.shown(&self.span)),
                None,
            );
        }
        error(
            self.previous.clone(),
            format!("a value is missing after `{}`", self.shown(&self.previous)),
            None,
        )
    }

    /// Error for a token that cannot follow the preceding operand.
    fn unexpected(&self) -> ExpressionError {
        let (before, shown) = (self.shown(&self.previous), self.shown(&self.span));
        let (message, help) = match self.token {
            Token::Number(_) | Token::Name(_) | Token::Symbol("(") => {
                let is_plain_number = before.parse::<f64>().is_ok() && matches!(self.token, Token::Number(_));
                let help = (!is_plain_number).then(|| format!("for a product write `{before}*{shown}`"));
                (format!("an operator is missing between `{before}` and `{shown}`"), help)
            }
            Token::Symbol(")") => ("this `)` has no opening `(`".to_owned(), None),
            Token::Symbol("<" | "<=" | ">" | ">=" | "=" | "==" | "!=") => {
                let help = "compare as in `if(t < 1, x, y)`".to_owned();
                ("only the first argument of `if` can be a comparison".to_owned(), Some(help))
            }
            Token::Symbol(symbol) => {
                let help = match symbol {
                    "," => Some("write decimal numbers with a point, such as `0.5`"),
                    "**" => Some("for a power write `^`"),
                    "\u{b2}" | "\u{b3}" => Some("for a power write `^2` or `^3`"),
                    "\u{b7}" | "\u{d7}" => Some("for a product write `*`"),
                    "\u{f7}" | ":" => Some("for a quotient write `/`"),
                    "\u{2212}" | "\u{2013}" => Some("for minus write the plain `-`"),
                    "[" | "]" | "{" | "}" => Some("use round parentheses"),
                    "&&" | "||" => Some("nest a second `if` for a second comparison"),
                    _ => None,
                };
                (format!("unexpected `{shown}`"), help.map(str::to_owned))
            }
            Token::End => ("unexpected end".to_owned(), None),
        };
        ExpressionError { span: self.span.clone(), message, help }
    }

    fn unknown_name(&self, name: &str) -> ExpressionError {
        let functions: Vec<&str> = functions().map(|(known, ..)| known).collect();
        let lower = name.to_lowercase();
        let hint = match lower.as_str() {
            "e" => Some("for Euler's number write `exp(1)`; ".to_owned()),
            "log" => Some("write `ln` or `log10`; ".to_owned()),
            "time" => Some("the time is `t`; ".to_owned()),
            "\u{3c0}" => Some("did you mean `pi`? ".to_owned()),
            _ => ["t", PI]
                .iter()
                .chain(self.parameters)
                .chain(&functions)
                .map(|known| (strsim::jaro_winkler(&lower, known), known))
                .max_by(|a, b| a.0.total_cmp(&b.0))
                .filter(|(likeness, _)| *likeness > 0.8)
                .map(|(_, known)| format!("did you mean `{known}`? ")),
        };
        let known = [&["t", PI], self.parameters, &functions].concat().join(", ");
        let help = format!("{}known are {known}", hint.unwrap_or_default());
        error(self.span.clone(), format!("unknown name `{name}`"), Some(&help))
    }

    fn too_deep(&self, help: &str) -> ExpressionError {
        error(self.span.clone(), "the expression is nested too deeply", Some(help))
    }

    /// Text at `span`, with control characters escaped.
    fn shown(&self, span: &Range<usize>) -> String {
        self.text[span.clone()].escape_debug().to_string()
    }
}

/// Name of 3.14159...
pub(super) const PI: &str = "pi";

/// True if the name is built in.
fn is_taken(name: &str) -> bool {
    ["t", PI].contains(&name) || functions().any(|(known, ..)| known == name)
}

/// True if the name is valid in expressions and not built in.
pub(crate) fn is_free_name(name: &str) -> bool {
    !is_taken(name) && (self::name, eof).parse_next(&mut LocatingSlice::new(name)).is_ok()
}

fn error(span: Range<usize>, message: impl Into<String>, help: Option<&str>) -> ExpressionError {
    ExpressionError { span, message: message.into(), help: help.map(str::to_owned) }
}
