//! The language of laws as a whole: its meaning, its errors and their messages.

use proptest::prelude::*;

use super::*;

const KNOWN: &str = "known are t, pi, sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, exp, ln, log10, sqrt, \
                     pow, hypot, abs, min, max, step, if";

fn law(text: &str) -> Law {
    Law::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn value(text: &str, t: f64) -> f64 {
    law(text).at(t).value()
}

#[test]
fn operators_bind_as_in_mathematics() {
    let at_three = [
        ("1 + 2*3", 7.0),
        ("(1 + 2)*3", 9.0),
        ("10 - 4 - 3", 3.0),
        ("10 - (4 - 3)", 9.0),
        ("24/4/2", 3.0),
        ("24/4*2", 12.0),
        ("2^3^2", 512.0),
        ("(2^3)^2", 64.0),
        ("-t^2", -9.0),
        ("(-t)^2", 9.0),
        ("2^-1", 0.5),
        ("t^-2^2", 1.0 / 81.0),
        ("-2*-t", 6.0),
        ("2--t", 5.0),
        ("+-+t", -3.0),
        ("2*t^2", 18.0),
        ("1 - t/3*2", -1.0),
    ];
    for (text, expected) in at_three {
        assert_eq!(value(text, 3.0), expected, "{text}");
    }
}

#[test]
fn numbers_and_names_mean_what_they_say() {
    let at_a_half = [
        ("1", 1.0),
        ("1.", 1.0),
        (".5", 0.5),
        ("1e-3", 1e-3),
        ("2.5E+2", 250.0),
        ("pi", std::f64::consts::PI),
        ("t", 0.5),
        (" \n\tt ", 0.5),
        ("sin(t)", 0.5_f64.sin()),
        ("cos(t)", 0.5_f64.cos()),
        ("tan(t)", 0.5_f64.tan()),
        ("asin(t)", 0.5_f64.asin()),
        ("acos(t)", 0.5_f64.acos()),
        ("atan(t)", 0.5_f64.atan()),
        ("atan2(t, -1)", 0.5_f64.atan2(-1.0)),
        ("sinh(t)", 0.5_f64.sinh()),
        ("cosh(t)", 0.5_f64.cosh()),
        ("tanh(t)", 0.5_f64.tanh()),
        ("exp(t)", 0.5_f64.exp()),
        ("ln(t)", 0.5_f64.ln()),
        ("log10(t)", 0.5_f64.log10()),
        ("sqrt(t)", 0.5_f64.sqrt()),
        ("pow(4, t)", 2.0),
        ("pow(t, 2)", 0.25),
        ("hypot(6*t, 8*t)", 5.0),
        ("abs(-t)", 0.5),
        ("min(3, t, 2)", 0.5),
        ("max(t, 3, 2)", 3.0),
        ("step(t, 0, 10, 1, 20)", 15.0),
        ("step(t, 1, 10, 2, 20)", 10.0),
        ("step(t, -1, 10, 0, 20)", 20.0),
        ("if(t < 0.5, 1, 2)", 2.0),
        ("if(t <= 0.5, 1, 2)", 1.0),
        ("if(t > 0.5, 1, 2)", 2.0),
        ("if(t >= 0.5, 1, 2)", 1.0),
        ("if(t < 1, if(t < 0.2, 1, 2), 3)", 2.0),
    ];
    for (text, expected) in at_a_half {
        assert_eq!(value(text, 0.5), expected, "{text}");
    }
}

/// Compares each derivative of each law with central differences of the preceding one: as the step is halved the error
/// falls by 4, until rounding dominates.
#[test]
fn derivatives_are_the_limits_of_central_differences() {
    let laws = [
        "0.03*sin(2*pi*t) + 0.1*t^2",
        "exp(-t)*cos(3*t)/(1 + t^2)",
        "atan2(sin(t), 2 + cos(t)) - sqrt(1 + t)",
        "step(t, 0, 5, 2, -3)*tanh(t)",
        "hypot(t, 1 + t^2)^t^1.5",
        "if(t < 2, max(t^5, -1), 0) + abs(ln(t)*min(t, 9)^3)",
    ];
    for text in laws {
        let law = law(text);
        let t = 0.7;
        let exact = law.at(t).derivatives();
        for order in 1..4 {
            assert!(exact[order].abs() > 1e-3, "{text}: derivative {order} says nothing, {exact:?}");
            let errors: Vec<f64> = (5..20)
                .map(|halvings| {
                    let h = 0.5_f64.powi(halvings);
                    let [after, before] = [t + h, t - h].map(|t| law.at(t).derivatives()[order - 1]);
                    ((after - before) / (2.0 * h) - exact[order]).abs() / exact[order].abs()
                })
                .collect();
            for pair in errors[..4].windows(2) {
                let ratio = pair[0] / pair[1];
                assert!((3.8..4.2).contains(&ratio), "{text}, derivative {order}: {ratio} in {errors:?}");
            }
            let best = errors.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(best < 1e-8, "{text}, derivative {order}: {errors:?}");
        }
    }
}

#[test]
fn what_does_not_depend_on_time_has_no_derivatives() {
    // The jets of these would have infinity times zero as derivatives.
    for text in ["sqrt(0)", "asin(1)", "0^0.5", "hypot(0, 0)", "abs(3 - 5)^1.5", "if(1 < 2, sqrt(0), 1)"] {
        assert_eq!(law(text).at(0.0).derivatives()[1..], [0.0; 3], "{text}");
    }
    // This one is different: its true derivative, 2, cannot be computed from three derivatives of t^4.
    assert!(law("sqrt(t^4)").at(0.0).dd().is_nan());
}

#[test]
fn undefined_values_are_returned_and_do_not_spread_into_the_other_branch() {
    assert!(value("sqrt(t)", -1.0).is_nan());
    assert_eq!(value("1/t", 0.0), f64::INFINITY);
    assert!(value("if(sqrt(t) < 1, 1, 2)", -1.0).is_nan());
    assert_eq!(law("if(t > 0, sqrt(t), 0)").at(-1.0), TimeJet::constant(0.0));
}

#[test]
fn scaling_multiplies_every_derivative_and_keeps_the_text() {
    let law = law("t^3");
    let scaled = law.clone().scaled(2.0).scaled(0.25);
    assert_eq!(scaled.at(2.0).derivatives(), [4.0, 6.0, 6.0, 3.0]);
    assert_eq!(scaled.to_string(), "t^3");
    assert_ne!(scaled, law);
    assert_eq!(scaled.scaled(2.0), law);
}

#[test]
fn a_constant_law_is_the_same_as_its_text_parsed() {
    for value in [0.0, -2.5, 1e300, 1e-12] {
        let law = Law::constant(value);
        assert_eq!(law.at(7.0), TimeJet::constant(value));
        assert_eq!(Law::parse(&law.to_string()), Ok(law));
    }
}

#[test]
fn debug_output_is_the_same_in_every_run() {
    assert_eq!(format!("{:?}", law("sin(t)")), "Law { text: \"sin(t)\", factor: 1.0, .. }");
}

#[test]
fn errors_name_the_place_and_the_remedy() {
    let empty_help = "write an expression in the time t, such as `0.1*sin(2*pi*t)`";
    let decimal_help = "write decimal numbers with a point, such as `0.5`";
    let comparison = "only the first argument of `if` can be a comparison";
    let comparison_help = "compare as in `if(t < 1, x, y)`";
    let nest_help = "nest a second `if` for a second comparison";
    let cases = [
        ("", 0..0, "the expression is empty", empty_help),
        ("  ", 0..2, "the expression is empty", empty_help),
        ("1 +", 2..3, "a value is missing after `+`", ""),
        ("* t", 0..1, "a value is missing before `*`", ""),
        ("2 + * t", 2..3, "a value is missing after `+`", ""),
        ("()", 0..1, "a value is missing after `(`", ""),
        ("sin(t", 3..4, "missing `)`: this `(` is not closed", ""),
        ("2*(t + (1)", 2..3, "missing `)`: this `(` is not closed", ""),
        ("(t))", 3..4, "this `)` has no opening `(`", ""),
        ("2t", 1..2, "an operator is missing between `2` and `t`", "for a product write `2*t`"),
        ("2(t + 1)", 1..2, "an operator is missing between `2` and `(`", "for a product write `2*(`"),
        ("t(1)", 1..2, "an operator is missing between `t` and `(`", "for a product write `t*(`"),
        ("1 000", 2..5, "an operator is missing between `1` and `000`", ""),
        ("1.2.3", 3..5, "an operator is missing between `1.2` and `.3`", ""),
        ("0,5*t", 1..2, "unexpected `,`", decimal_help),
        ("(0,5)", 2..3, "unexpected `,`", decimal_help),
        ("t**2", 1..3, "unexpected `**`", "for a power write `^`"),
        ("3·t", 1..3, "unexpected `·`", "for a product write `*`"),
        ("1 − t", 2..5, "unexpected `−`", "for minus write the plain `-`"),
        ("−t", 0..3, "unexpected `−`", "for minus write the plain `-`"),
        ("t²", 1..3, "unexpected `²`", "for a power write `^2` or `^3`"),
        ("2*[t]", 2..3, "unexpected `[`", "use round parentheses"),
        ("t # note", 2..3, "unexpected `#`", ""),
        ("t \u{7}", 2..3, "unexpected `\\u{7}`", ""),
        ("1e999*t", 0..5, "the number is too large", "the largest is 1.79e308"),
        ("sin t", 0..3, "`sin` is a function and needs parentheses", "write `sin(x)`"),
        ("sin()", 0..5, "`sin` takes 1 argument, not 0", "write `sin(x)`"),
        ("1 + cos(t, 2*t, 3)", 4..18, "`cos` takes 1 argument, not 3", "write `cos(x)`"),
        ("atan2(t)", 0..8, "`atan2` takes 2 arguments, not 1", "write `atan2(y, x)`"),
        ("min(t)", 0..6, "`min` takes 2 or more arguments, not 1", "write `min(a, b, ...)`"),
        ("max(t, )", 5..6, "a value is missing after `,`", ""),
        ("step(t, 0, 1)", 0..13, "`step` takes 5 arguments, not 3", "write `step(x, x0, h0, x1, h1)`"),
        (
            "step(t, 2, 0, 2*0.5, 5)",
            8..19,
            "`step` must rise from x0 to x1, but x0 = 2 and x1 = 1",
            "write `step(x, x0, h0, x1, h1)` with x0 < x1; h1 may be less than h0",
        ),
        ("t < 1", 2..3, comparison, comparison_help),
        ("max(t < 1, 2)", 6..7, comparison, comparison_help),
        (
            "if(t, 1, 2)",
            3..4,
            "the first argument of `if` must be a comparison",
            "compare with `<`, `<=`, `>` or `>=`, as in `if(t < 1, x, y)`",
        ),
        (
            "if(t",
            3..4,
            "the first argument of `if` must be a comparison",
            "compare with `<`, `<=`, `>` or `>=`, as in `if(t < 1, x, y)`",
        ),
        ("if(t < 1", 2..3, "missing `)`: this `(` is not closed", ""),
        ("if(t == 1, 1, 2)", 5..7, "a law cannot be compared with `==`", "use `<`, `<=`, `>` or `>=`"),
        ("if(0 < t < 1, 1, 2)", 9..10, "an `if` has one comparison only", nest_help),
        ("if(t < 1, 2)", 0..12, "`if` takes 3 arguments, not 2", "write `if(a < b, x, y)`"),
    ];
    for (text, span, message, help) in cases {
        let error = Law::parse(text).expect_err(text);
        assert_eq!((error.message.as_str(), error.help.as_deref().unwrap_or("")), (message, help), "{text}");
        assert_eq!(error.span, span, "{text}");
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn an_unknown_name_is_answered_with_the_known_ones() {
    let cases = [
        ("sinn(t)", 0..4, "did you mean `sin`? "),
        ("2*SIN(t)", 2..5, "did you mean `sin`? "),
        ("arctan(t)", 0..6, "did you mean `atan`? "),
        ("STEP(t,0,0,1,1)", 0..4, "did you mean `step`? "),
        ("1 + PI", 4..6, "did you mean `pi`? "),
        ("2*π", 2..4, "did you mean `pi`? "),
        ("2*T", 2..3, "did you mean `t`? "),
        ("2*time", 2..6, "the time is `t`; "),
        ("log(t)", 0..3, "write `ln` or `log10`; "),
        ("e^t", 0..1, "for Euler's number write `exp(1)`; "),
        ("omega*t", 0..5, ""),
    ];
    for (text, span, hint) in cases {
        let error = Law::parse(text).expect_err(text);
        assert_eq!(error.message, format!("unknown name `{}`", &text[span.clone()]));
        assert_eq!(error.help, Some(format!("{hint}{KNOWN}")), "{text}");
        assert_eq!(error.span, span, "{text}");
    }
}

#[test]
fn deep_nesting_is_an_error_and_no_stack_overflow() {
    let deep = 100_000;
    let texts = [
        "(".repeat(deep),
        "(".repeat(deep) + "t" + &")".repeat(deep),
        "sin(".repeat(deep),
        "t^".repeat(deep) + "t",
        "2^-".repeat(deep) + "t",
        "if(".repeat(deep),
        "if(t < 1, t, ".repeat(deep),
        "step(t, 0, 0, 1, 1 + 2*t^".repeat(60),
    ];
    for text in texts {
        let error = Law::parse(&text).unwrap_err();
        assert_eq!(error.message, "the expression is nested too deeply", "{}", &text[..10]);
        assert_eq!(error.help.as_deref(), Some("at most 64 parentheses and exponents may be open at once"));
    }

    let error = Law::parse(&"step(t, 0, 0, 1, 1 + 2*".repeat(60)).unwrap_err();
    assert_eq!(error.message, "the expression is nested too deeply");
    assert_eq!(error.help.as_deref(), Some("at most 256 operands may wait for their operator"));
}

#[test]
fn length_alone_is_no_limit() {
    let long = 100_000;
    assert_eq!(value(&("t".to_owned() + &"+t".repeat(long)), 1.0), 100_001.0);
    assert_eq!(value(&("-".repeat(long) + "t"), 1.0), 1.0);
    assert_eq!(value(&format!("max(t{})", ", 2*t".repeat(long)), 1.0), 2.0);
    assert_eq!(value(&("(".repeat(60) + "t" + &")".repeat(60)), 1.0), 1.0);
    // More operands than fit the small stack.
    assert_eq!(value(&("t + (2*t + ".repeat(30) + "t" + &")".repeat(30)), 1.0), 91.0);
}

/// Parsing may fail with an error inside the text; a parsed law can be evaluated.
fn check_any_text(text: &str) -> Result<(), TestCaseError> {
    match Law::parse(text) {
        Ok(law) => {
            law.at(0.3);
            prop_assert_eq!(law.to_string(), text);
        }
        Err(error) => {
            prop_assert!(text.get(error.span.clone()).is_some(), "{:?} is not in {:?}", error.span, text);
            prop_assert!(!error.message.is_empty());
        }
    }
    Ok(())
}

const VALID: &str =
    "step(t, 0, -1e-3, 2*pi, if(t^2 <= .5, max(1, t, 3), atan2(-t, 4.5))) - pow(t, 2)/(1 + sqrt(abs(t)))";

#[test]
fn the_text_to_mutate_is_valid() {
    assert!(law(VALID).at(0.3).is_finite());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_text_never_panics(text in any::<String>()) {
        check_any_text(&text)?;
    }

    #[test]
    fn arbitrary_strings_of_tokens_never_panic(
        tokens in prop::collection::vec(
            prop::sample::select(vec![
                "t", "pi", "1", "2.5e3", ".", "e", "+", "-", "*", "/", "^", "(", ")", ",", "<", ">=", "=", " ",
                "sin(", "min(", "step(", "if(", "if(t<1,", "pow(", "q", "\u{b2}", "step(t,0,0,1,1)",
            ]),
            0..24,
        ),
    ) {
        check_any_text(&tokens.concat())?;
    }

    #[test]
    fn mutated_valid_text_never_panics(
        edits in prop::collection::vec((any::<prop::sample::Index>(), prop::option::of(any::<char>()), 0_usize..3), 1..5),
    ) {
        let mut characters: Vec<char> = VALID.chars().collect();
        for (index, inserted, removed) in edits {
            let begin = index.index(characters.len() + 1);
            let end = (begin + removed).min(characters.len());
            characters.splice(begin..end, inserted);
        }
        check_any_text(&characters.into_iter().collect::<String>())?;
    }
}
