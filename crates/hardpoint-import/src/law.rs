//! Translation of functions of the time from other programs to expressions of model files.

/// Language of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Adams/Solver: `30D` is an angle, `**` a power, names in any case.
    Adams,
    /// OndselSolver: `2.0d` is a number, `<n>` a line break, text in quotes a comment.
    Ondsel,
    /// FreeCAD's formulas of a simulation, similar to those of Ondsel.
    FreeCad,
}

/// Maximum depth of nested expressions.
const DEEPEST: usize = 60;
/// Maximum number of bytes of a translated expression: some functions of other programs repeat their arguments.
const LONGEST: usize = 4 << 20;
/// Maximum number of repetitions of an argument by a function, except for the sums over all further arguments.
const REPEATED: usize = 8;

/// Error for an expression that exceeds [`LONGEST`].
fn too_long() -> String {
    format!("its translation would be longer than {} MiB", LONGEST >> 20)
}

/// Translates a function to an expression of model files; angles in rad.
///
/// # Errors
/// Returns the reason why the function has no equivalent.
pub fn translate(text: &str, language: Language) -> Result<String, String> {
    translate_with(text, language, "t")
}

/// Translates a function; `time` is the expression of the source's time in terms of seconds.
///
/// # Errors
/// See [`translate`].
pub fn translate_with(text: &str, language: Language, time: &'static str) -> Result<String, String> {
    let parser = Parser {
        tokens: tokens(text, language)?,
        at: 0,
        depth: 0,
        language,
        time,
        measured: None,
        corners: Vec::new(),
    };
    Ok(parser.whole()?.text)
}

/// Translation of a function of the motion, like `DM(1, 2)`, with its arguments; `None` for any other function.
pub type MotionFunctions<'m> = dyn Fn(&str, &[String]) -> Option<Result<String, String>> + 'm;

/// Function of positions and velocities.
pub struct Characteristic {
    /// Expression of model files.
    pub text: String,
    /// Pairs of expressions; where both are equal, the slope of the function may jump.
    pub corners: Vec<[String; 2]>,
}

/// Translates a function of Adams of positions and velocities but not of the time.
///
/// # Errors
/// See [`translate`].
pub fn translate_characteristic(
    text: &str,
    measured: &MotionFunctions<'_>,
) -> Result<Characteristic, String> {
    let language = Language::Adams;
    let parser = Parser {
        tokens: tokens(text, language)?,
        at: 0,
        depth: 0,
        language,
        time: "t",
        measured: Some(measured),
        corners: Vec::new(),
    };
    parser.whole()
}

/// Returns the value of a translated expression that does not depend on the time.
pub fn constant(text: &str) -> Option<f64> {
    let law = hardpoint::law::Law::parse(text).ok()?;
    let [a, b] = [0.0, 0.7311].map(|t| law.at(t).0[0]);
    (a == b && a.is_finite()).then_some(a)
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(String),
    Name(String),
    Sign(&'static str),
}

impl Token {
    fn text(&self) -> &str {
        match self {
            Self::Number(s) | Self::Name(s) => s,
            Self::Sign(s) => s,
        }
    }
}

fn tokens(text: &str, language: Language) -> Result<Vec<Token>, String> {
    let bytes: Vec<char> = text.chars().collect();
    let (mut out, mut k) = (Vec::new(), 0);
    while k < bytes.len() {
        let c = bytes[k];
        let next = bytes.get(k + 1).copied().unwrap_or(' ');
        if c.is_whitespace() {
            k += 1;
        } else if language == Language::Ondsel && c == '"' {
            // A comment.
            let end = bytes[k + 1..].iter().position(|c| *c == '"');
            k += end.map_or(bytes.len() - k, |n| n + 2);
        } else if language == Language::Ondsel && bytes[k..].starts_with(&['<', 'n', '>']) {
            // A line break.
            k += 3;
        } else if c.is_ascii_digit() || (c == '.' && next.is_ascii_digit()) {
            let start = k;
            while k < bytes.len() && (bytes[k].is_ascii_digit() || bytes[k] == '.') {
                k += 1;
            }
            let mut number: String = bytes[start..k].iter().collect();
            // 1.5e-3, and Fortran's 1.5D-3
            let mark = bytes.get(k).map(char::to_ascii_lowercase);
            let sign = usize::from(matches!(bytes.get(k + 1), Some('+' | '-')));
            let digits = bytes.get(k + 1 + sign).is_some_and(char::is_ascii_digit);
            if matches!(mark, Some('e' | 'd')) && digits {
                let from = k + 1;
                k += 1 + sign;
                while bytes.get(k).is_some_and(char::is_ascii_digit) {
                    k += 1;
                }
                number.push('e');
                number.extend(&bytes[from..k]);
            }
            let value: f64 = number.parse().map_err(|_| format!("`{number}` is not a number"))?;
            if !value.is_finite() {
                return Err(format!("`{number}` is too large"));
            }
            let after = bytes.get(k + 1).is_some_and(|c| c.is_alphanumeric() || *c == '_');
            if mark_is(&bytes, k, 'd') && !after {
                k += 1;
                if language == Language::Adams {
                    number = format!("({number}*pi/180)");
                }
            }
            out.push(Token::Number(number));
        } else if c.is_alphabetic() || c == '_' {
            let start = k;
            while k < bytes.len() && (bytes[k].is_alphanumeric() || bytes[k] == '_') {
                k += 1;
            }
            out.push(Token::Name(bytes[start..k].iter().collect::<String>().to_lowercase()));
        } else {
            let sign = match (c, next) {
                ('*', '*') => {
                    k += 1;
                    "^"
                }
                ('+', _) => "+",
                ('-', _) => "-",
                ('*', _) => "*",
                ('/', _) => "/",
                ('^', _) => "^",
                ('(' | '{' | '[', _) => "(",
                (')' | '}' | ']', _) => ")",
                (',' | ';', _) => ",",
                (':', _) => ":",
                _ => return Err(format!("`{c}` is not expected here")),
            };
            k += 1;
            out.push(Token::Sign(sign));
        }
    }
    Ok(out)
}

fn mark_is(bytes: &[char], k: usize, letter: char) -> bool {
    bytes.get(k).is_some_and(|c| c.eq_ignore_ascii_case(&letter))
}

struct Parser<'m> {
    tokens: Vec<Token>,
    at: usize,
    depth: usize,
    language: Language,
    time: &'static str,
    /// Functions of the motion, of which the expression is a function instead of the time.
    measured: Option<&'m MotionFunctions<'m>>,
    corners: Vec<[String; 2]>,
}

impl Parser<'_> {
    /// Translates all tokens.
    fn whole(mut self) -> Result<Characteristic, String> {
        let text = self.sum()?;
        match self.tokens.get(self.at) {
            None => Ok(Characteristic { text, corners: self.corners }),
            Some(extra) => Err(format!("`{}` is not expected here", extra.text())),
        }
    }

    fn sign(&self) -> Option<&'static str> {
        match self.tokens.get(self.at) {
            Some(Token::Sign(s)) => Some(s),
            _ => None,
        }
    }

    fn take(&mut self, sign: &str) -> Result<(), String> {
        if self.sign() == Some(sign) {
            self.at += 1;
            return Ok(());
        }
        Err(match self.tokens.get(self.at) {
            Some(found) => format!("`{sign}` is expected instead of `{}`", found.text()),
            None => format!("`{sign}` is missing at the end"),
        })
    }

    fn sum(&mut self) -> Result<String, String> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err("it is nested too deep".into());
        }
        let mut out = self.product()?;
        while let Some(sign @ ("+" | "-")) = self.sign() {
            self.at += 1;
            let term = self.product()?;
            out.extend([" ", sign, " ", term.as_str()]);
            self.bounded(&out)?;
        }
        self.depth -= 1;
        Ok(out)
    }

    /// Checks the length of the translated text.
    fn bounded(&self, out: &str) -> Result<(), String> {
        if out.len() > LONGEST { Err(too_long()) } else { Ok(()) }
    }

    fn product(&mut self) -> Result<String, String> {
        let mut out = self.signed()?;
        while let Some(sign @ ("*" | "/")) = self.sign() {
            self.at += 1;
            let factor = self.signed()?;
            out.extend([sign, factor.as_str()]);
            self.bounded(&out)?;
        }
        Ok(out)
    }

    fn signed(&mut self) -> Result<String, String> {
        let mut minus = false;
        while let Some(sign @ ("+" | "-")) = self.sign() {
            self.at += 1;
            minus ^= sign == "-";
        }
        let out = self.power()?;
        Ok(if minus { format!("(-{out})") } else { out })
    }

    fn power(&mut self) -> Result<String, String> {
        let base = self.atom()?;
        if self.sign() != Some("^") {
            return Ok(base);
        }
        self.at += 1;
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err("it is nested too deep".into());
        }
        let exponent = self.signed()?;
        self.depth -= 1;
        Ok(format!("({base}^{exponent})"))
    }

    fn atom(&mut self) -> Result<String, String> {
        let Some(token) = self.tokens.get(self.at).cloned() else {
            return Err("a value is missing at the end".into());
        };
        self.at += 1;
        match token {
            Token::Number(n) => Ok(n),
            Token::Sign("(") => {
                let inner = self.sum()?;
                self.take(")")?;
                Ok(format!("({inner})"))
            }
            Token::Sign(s) => Err(format!("`{s}` is found where a value is expected")),
            Token::Name(name) if self.sign() == Some("(") => {
                self.at += 1;
                let mut arguments = Vec::new();
                if self.sign() != Some(")") {
                    loop {
                        arguments.push(self.sum()?);
                        // IF(e: a, b, c)
                        match self.sign() {
                            Some("," | ":") => self.at += 1,
                            _ => break,
                        }
                    }
                }
                self.take(")")?;
                self.call(&name, &arguments)
            }
            Token::Name(name) => match name.as_str() {
                "time" | "t" if self.measured.is_some() => Err("it depends on the time".into()),
                "time" | "t" => Ok(self.time.into()),
                "pi" => Ok("pi".into()),
                "dtor" => Ok("(pi/180)".into()),
                "rtod" => Ok("(180/pi)".into()),
                "e" if self.language != Language::Adams => Ok("exp(1)".into()),
                other => Err(format!("`{other}` is unknown, or depends on more than the time")),
            },
        }
    }

    /// Translates a function call.
    fn call(&mut self, name: &str, x: &[String]) -> Result<String, String> {
        if let Some(found) = self.measured.and_then(|measured| measured(name, x)) {
            return found;
        }
        let bounds: &[usize] = match (name, x.len()) {
            ("step" | "step5" | "havsin", 5) => &[1, 3],
            ("bistop", 8) => &[2, 3],
            ("impact", 7) => &[2],
            ("min" | "max" | "dim" | "sign", 2) => &[1],
            _ => &[],
        };
        if self.measured.is_some() {
            self.corners.extend(bounds.iter().map(|k| [x[0].clone(), x[*k].clone()]));
            if ["abs", "if"].contains(&name) && !x.is_empty() {
                self.corners.push([x[0].clone(), "0".into()]);
            }
        }
        let each: usize = x.iter().map(String::len).sum();
        let first: usize = x.iter().take(3).map(String::len).sum();
        if REPEATED * each + x.len() * first > LONGEST {
            return Err(too_long());
        }
        translated(name, x)
    }
}

/// Returns a function call in the words of the model file: one match, as each function has one case.
fn translated(name: &str, x: &[String]) -> Result<String, String> {
    let same = |to: &str, n: usize| {
        if x.len() == n {
            Ok(format!("{to}({})", x.join(", ")))
        } else {
            Err(format!("`{name}` requires {n} arguments, not {}", x.len()))
        }
    };
    // Fraction of the interval from x0 to x1 before x, limited to 0..1.
    let gone = |x: &[String]| format!("min(1, max(0, (({}) - ({}))/(({}) - ({}))))", x[0], x[1], x[3], x[1]);
    let degrees = |inner: &str| format!("{inner}(({})*pi/180)", x.first().map_or("0", String::as_str));
    match (name, x.len()) {
        (
            "sin" | "cos" | "tan" | "asin" | "acos" | "atan" | "sinh" | "cosh" | "tanh" | "exp" | "sqrt"
            | "abs" | "log10",
            _,
        ) => same(name, 1),
        ("arcsin", _) => same("asin", 1),
        ("arccos", _) => same("acos", 1),
        ("arctan", _) => same("atan", 1),
        ("log" | "ln", _) => same("ln", 1),
        ("dsin", 1) => Ok(degrees("sin")),
        ("dcos", 1) => Ok(degrees("cos")),
        ("dtan", 1) => Ok(degrees("tan")),
        ("atan2" | "arctan2" | "pow" | "power", 2) => same(
            match name {
                "arctan2" => "atan2",
                "power" => "pow",
                other => other,
            },
            2,
        ),
        ("min" | "max", 2) => same(name, 2),
        ("sign", 2) => Ok(format!("if(({}) < 0, -abs({}), abs({}))", x[1], x[0], x[0])),
        ("dim", 2) => Ok(format!("max(0, ({}) - ({}))", x[0], x[1])),
        ("step", 5) => same("step", 5),
        // h0 + (h1 - h0) u^3 (10 - 15 u + 6 u^2)
        ("step5", 5) => {
            let u = gone(x);
            Ok(format!("(({h0}) + (({h1}) - ({h0}))*{u}^3*(10 - 15*{u} + 6*{u}^2))", h0 = x[2], h1 = x[4]))
        }
        // Half a sine wave from h0 to h1.
        ("havsin", 5) => Ok(format!(
            "((({h0}) + ({h1}))/2 - (({h1}) - ({h0}))/2*cos(pi*{u}))",
            h0 = x[2],
            h1 = x[4],
            u = gone(x)
        )),
        // a sin(w (x - x0) - phi) + b
        ("shf", 5 | 6) => {
            let b = x.get(5).map_or("0", String::as_str);
            Ok(format!("(({})*sin(({})*(({}) - ({})) - ({})) + ({b}))", x[2], x[3], x[0], x[1], x[4]))
        }
        ("if", 4) => Ok(format!("if(({e}) < 0, {}, if(0 < ({e}), {}, {}))", x[1], x[3], x[2], e = x[0])),
        // A stop below x1 and one above x2: k (x1 - x)^e and -k (x - x2)^e, each with damping and without pull
        ("bistop", 8) => {
            let [below, above] = [stop(x, &x[2], false, &x[4..]), stop(x, &x[3], true, &x[4..])];
            Ok(format!("({below} - {above})"))
        }
        ("impact", 7) => Ok(stop(x, &x[2], false, &x[3..])),
        // a0 + a1 (x - x0) + a2 (x - x0)^2 + ...
        ("poly", 3..) => {
            let term = |(k, a): (usize, &String)| match k {
                0 => format!("({a})"),
                _ => format!("({a})*(({}) - ({}))^{k}", x[0], x[1]),
            };
            Ok(format!("({})", x[2..].iter().enumerate().map(term).collect::<Vec<_>>().join(" + ")))
        }
        // a0 + sum a_k sin (or cos) (k w (x - x0))
        ("forsin" | "forcos", 4..) => {
            let wave = if name == "forsin" { "sin" } else { "cos" };
            let term = |(k, a): (usize, &String)| match k {
                0 => format!("({a})"),
                _ => format!("({a})*{wave}({k}*({})*(({}) - ({})))", x[2], x[0], x[1]),
            };
            Ok(format!("({})", x[3..].iter().enumerate().map(term).collect::<Vec<_>>().join(" + ")))
        }
        // Chebyshev polynomials, expanded up to degree four.
        ("cheby", 3..=7) => {
            let u = format!("(({}) - ({}))", x[0], x[1]);
            let t = [
                "1".to_owned(),
                u.clone(),
                format!("(2*{u}^2 - 1)"),
                format!("(4*{u}^3 - 3*{u})"),
                format!("(8*{u}^4 - 8*{u}^2 + 1)"),
            ];
            let terms: Vec<String> = x[2..].iter().zip(&t).map(|(a, t)| format!("({a})*{t}")).collect();
            Ok(format!("({})", terms.join(" + ")))
        }
        _ => Err(format!("the function `{name}` with {} arguments has no equivalent", x.len())),
    }
}

/// Push of a one-sided stop at a bound, which a coordinate passes upwards or downwards. The first arguments are the
/// coordinate and its rate; the last ones are stiffness, exponent, largest damping and the depth where that is reached.
fn stop(x: &[String], bound: &str, upwards: bool, law: &[String]) -> String {
    let (at, rate) = (&x[0], &x[1]);
    let [k, e, c, d] = [0, 1, 2, 3].map(|n| &law[n]);
    let (depth, speed) = match upwards {
        true => (format!("(({at}) - ({bound}))"), format!("({rate})")),
        false => (format!("(({bound}) - ({at}))"), format!("(-({rate}))")),
    };
    let push = format!("({k})*max(0, {depth})^({e})");
    let damping = format!("({c})*{speed}*step({depth}, 0, 0, {d}, 1)");
    // At rest the depth of the damping, which may be zero, is irrelevant.
    let push = if constant(rate) == Some(0.0) { push } else { format!("{push} + {damping}") };
    format!("if({depth} < 0, 0, max(0, {push}))")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_of_other_programs_keep_their_values() {
        let at = |text: &str, language, t: f64| {
            let out = translate(text, language).unwrap();
            hardpoint::law::Law::parse(&out).unwrap_or_else(|e| panic!("{out}: {e:?}")).at(t).0[0]
        };
        let adams = |text, t| at(text, Language::Adams, t);
        assert!((adams("360.0D*TIME", 0.5) - std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(adams("2.0D+1*time**2", 0.5), 5.0);
        assert_eq!(adams("-2**2", 0.0), -4.0);
        assert_eq!(adams("STEP(TIME, 0, 0, 1, 8)", 0.5), 4.0);
        assert_eq!(adams("step5(time,0,1,2,3)", 1.0), 2.0);
        assert_eq!(adams("step5(time,0,1,2,3)", 9.0), 3.0);
        assert!((adams("HAVSIN(TIME, 0, -1, 1, 1)", 0.5)).abs() < 1e-15);
        assert!(
            (adams("SHF(TIME, 25D, PI, 360D, 0, 10)", 0.0)
                - (10.0
                    + std::f64::consts::PI * (-2.0 * std::f64::consts::PI * 25.0_f64.to_radians()).sin()))
            .abs()
                < 1e-12
        );
        assert_eq!(adams("IF(TIME-1: 10, 20, 30)", 0.0), 10.0);
        assert_eq!(adams("IF(TIME-1: 10, 20, 30)", 1.0), 20.0);
        assert_eq!(adams("IF(TIME-1: 10, 20, 30)", 2.0), 30.0);
        assert_eq!(adams("POLY(TIME, 1, 2, 3, 4)", 3.0), 2.0 + 6.0 + 16.0);
        assert_eq!(adams("CHEBY(TIME, 0, 1, 0, 1)", 2.0), 8.0);
        assert!((at("2.0d*pi*time", Language::Ondsel, 1.0) - 2.0 * std::f64::consts::PI).abs() < 1e-15);
        assert_eq!(at("\"2*T1\"<n>3*<n>time", Language::Ondsel, 2.0), 6.0);
        assert_eq!(constant(&translate("3*2", Language::Ondsel).unwrap()), Some(6.0));
        assert_eq!(constant("t"), None);
    }

    #[test]
    fn stops_push_from_one_or_both_sides() {
        let measured = |rate: &'static str| {
            move |name: &str, x: &[String]| match (name, x.join(" ").as_str()) {
                ("dm", "1 2") => Some(Ok("t".into())),
                ("vr", "1 2") => Some(Ok(rate.into())),
                _ => None,
            }
        };
        let at = |text: &str, rate, x: f64| {
            let out = translate_characteristic(text, &measured(rate)).unwrap();
            hardpoint::law::Law::parse(&out.text).unwrap_or_else(|e| panic!("{}: {e:?}", out.text)).at(x).0[0]
        };
        let both = "BISTOP(DM(1,2), VR(1,2), 100, 150, 20, 1.5, 3, 2)";
        for (x, rate, wanted) in [
            (96.0, "0", 160.0),
            (100.0, "0", 0.0),
            (130.0, "9", 0.0),
            (154.0, "0", -160.0),
            // Damping grows with the depth up to 2; a stop does not pull.
            (96.0, "(-7)", 160.0 + 21.0),
            (99.0, "(-7)", 20.0 + 0.5 * 21.0),
            (96.0, "700", 0.0),
            (154.0, "7", -181.0),
            (154.0, "(-700)", 0.0),
        ] {
            let found = at(both, rate, x);
            assert!(
                (found - wanted).abs() <= 1e-12 * wanted.abs(),
                "{x} {rate}: {found} instead of {wanted}"
            );
            let one = at("-IMPACT(DM(1,2), VR(1,2), 100, 20, 1.5, 3, 2)", rate, x);
            assert!((one + wanted.max(0.0)).abs() <= 1e-12 * wanted.abs(), "{x} {rate}: {one}");
        }
        let of = |text: &str| translate_characteristic(text, &measured("0"));
        let corners = of(both).ok().map(|c| c.corners.len());
        assert_eq!(corners, Some(2));
        assert!(of("TIME*DM(1,2)").err().is_some_and(|why| why.contains("time")));
        assert!(of("DM(1,3)").err().is_some_and(|why| why.contains("dm")));
    }

    #[test]
    fn functions_without_equivalent_are_reported() {
        for (text, word) in [
            ("DX(1,2)", "dx"),
            ("AKISPL(TIME", "`)`"),
            ("2*", "missing"),
            ("VARVAL", "varval"),
            ("2 3", "`3`"),
        ] {
            let why = translate(text, Language::Adams).unwrap_err();
            assert!(why.contains(word), "{why}");
        }
        // Nested functions that repeat their arguments grow exponentially.
        let steps = format!("{}time{}", "step5(".repeat(50), ", 0, 0, 1, 1)".repeat(50));
        assert!(translate(&steps, Language::Adams).unwrap_err().contains("longer"));
        let signs = format!("{}time{}", "sign(1, ".repeat(50), ")".repeat(50));
        assert!(translate(&signs, Language::Ondsel).is_ok());
        assert!(translate(&"(".repeat(10_000), Language::Adams).is_err());
        assert!(translate(&"2^".repeat(10_000), Language::Adams).is_err());
    }
}
