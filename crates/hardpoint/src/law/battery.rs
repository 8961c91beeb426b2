//! Properties of all kinds of laws: derivatives, change of unit, jumps.

use super::*;

fn table(times: &[f64], values: &[f64], degree: SplineDegree, ends: SplineEnds) -> Law {
    Law::table(&Table { times: times.to_vec(), values: values.to_vec(), degree, ends }).unwrap()
}

fn step(start: f64, end: f64, degree: u32) -> Law {
    Law::smooth_step(SmoothStep { from: 0.5, to: 3.0, start, end, degree }).unwrap()
}

const HARMONIC: Harmonic = Harmonic { amplitude: 2.5, frequency: 0.3, phase: 0.4, offset: -1.0 };

const CLAMPED: SplineEnds = SplineEnds::Clamped {
    start: SplineEndRates { speed: 0.7, acceleration: 0.0 },
    end: SplineEndRates { speed: -0.4, acceleration: 0.0 },
};

/// One law of every kind and variant, labelled by its text, all smooth at t = 0.7 s and t = 1.9 s.
fn every_kind() -> Vec<Law> {
    let (times, values) = ([0.0, 0.4, 1.1, 1.7, 2.2], [0.3, -0.5, 1.4, 0.9, 0.3]);
    let expression = "a*exp(-b*t)*sin(c*t + sqrt(a)) + t^b + step(t, b, c, 3 + b, a) + atan2(a, t)*hypot(b, t) + pow(c, t)";
    let mut laws = vec![
        Law::parse_with(expression, &[("a", 1.3), ("b", 0.6), ("c", 2.1)]).unwrap(),
        Law::harmonic(HARMONIC).unwrap(),
        Law::polynomial(&[0.3, -1.2, 0.8, 0.5, -0.1]).unwrap(),
        step(0.1, 2.6, 3),
        step(0.1, 2.6, 5),
        step(0.1, 2.6, 7),
        Law::trapezoid(Trapezoid { from: 0.5, to: 3.0, start: 0.1, end: 2.6, ramp: 0.9 }).unwrap(),
    ];
    for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
        for ends in [SplineEnds::Natural, CLAMPED, SplineEnds::Periodic] {
            laws.push(table(&times, &values, degree, ends));
        }
    }
    let pieces = |inner: Law| {
        vec![
            Piece::lasting(0.4, Law::harmonic(HARMONIC).unwrap().scaled(3.0)),
            Piece::lasting(0.6, inner),
            Piece::lasting(0.3, Law::polynomial(&[9.0, 1.0, 2.0]).unwrap()),
            Piece::open_ended(Law::parse_with("a*cos(t + a)", &[("a", 1.3)]).unwrap()),
        ]
    };
    let nested = Law::sequence(pieces(Law::parse_with("sin(t + k)", &[("k", 0.2)]).unwrap())).unwrap();
    let mut interrupted = pieces(nested.clone());
    interrupted[2].continued = false;
    laws.push(nested);
    laws.push(Law::sequence(interrupted).unwrap());
    laws.extend(laws.clone().into_iter().map(|law| law.scaled(-0.25)));
    laws.extend([0, 1, 4].map(|k| laws[k].clone().from_zero(0.3).reversed()));
    laws
}

/// Smallest error of central differences under halving of the step; the error must first fall by 4 each time.
fn difference_error(what: &str, f: impl Fn(f64) -> f64, at: f64, exact: f64, size: f64) -> f64 {
    let errors: Vec<f64> = (8..20)
        .map(|halvings| {
            let h = 0.5_f64.powi(halvings);
            ((f(at + h) - f(at - h)) / (2.0 * h) - exact).abs() / size
        })
        .collect();
    for pair in errors[..3].windows(2).filter(|pair| pair[1] > 1e-9) {
        let ratio = pair[0] / pair[1];
        assert!((3.5..4.5).contains(&ratio), "{what}: {ratio} in {errors:?}");
    }
    errors.into_iter().fold(f64::INFINITY, f64::min)
}

#[test]
fn time_derivatives_of_every_kind_are_the_limits_of_differences() {
    for law in every_kind() {
        for t in [0.7, 1.9] {
            let exact = law.at(t).derivatives();
            for order in 1..4 {
                let size = exact[order].abs().max(1.0);
                let f = |t| law.at(t).derivatives()[order - 1];
                let what = format!("{law}, derivative {order} at {t}");
                let error = difference_error(&what, f, t, exact[order], size);
                assert!(error < 1e-7, "{what}: {error}");
            }
            assert!(exact[1] != 0.0 && exact[2] != 0.0, "{law} says nothing: {exact:?}");
        }
    }
}

#[test]
fn parameter_derivatives_of_every_kind_are_the_limits_of_differences() {
    for law in every_kind() {
        let parameters = law.parameters();
        let mut is_used = vec![false; parameters.len()];
        for t in [0.7, 1.9] {
            for (k, parameter) in parameters.iter().enumerate() {
                let exact = law.derivative(k, t).derivatives();
                for order in 0..4 {
                    let size = exact[order].abs().max(1.0);
                    let f = |value| law.with_parameter(k, value).at(t).derivatives()[order];
                    let what = format!("{law}, derivative {order} at {t} by {}", parameter.name);
                    let error = difference_error(&what, f, parameter.value, exact[order], size);
                    assert!(error < 1e-7, "{what}: {error}");
                    is_used[k] |= exact[order] != 0.0;
                }
            }
        }
        // A piece of a sequence that is not continued only has its start shifted by the preceding ones.
        let is_sequence = matches!(law.kind, AnyLaw::Sequence(_));
        assert!(is_sequence || is_used.iter().all(|is_used| *is_used), "{law}: {is_used:?}");
    }
}

#[test]
fn parameters_are_named_valued_and_set_one_by_one() {
    for law in every_kind() {
        let parameters = law.parameters();
        // Of a law that counts from zero the last parameter is its value in the design configuration.
        let own = law.kind.parameter_count();
        assert_eq!(parameters.len(), own + usize::from(law.as_drawn().is_some()));
        for (k, parameter) in parameters.iter().enumerate() {
            assert_eq!(parameters.iter().filter(|other| other.name == parameter.name).count(), 1);
            if k < own {
                assert_eq!(parameter.kind, law.kind.parameter_kind(k), "{}", parameter.name);
            }
            assert_eq!(law.with_parameter(k, parameter.value).parameters()[k], *parameter);
            let changed = law.with_parameter(k, 7.5).parameters();
            assert_eq!(changed[k], Parameter { value: 7.5, ..parameter.clone() }, "{law}");
            for other in (0..parameters.len()).filter(|&other| other != k) {
                assert_eq!(changed[other], parameters[other]);
            }
        }
    }
    let names = |law: Law| law.parameters().into_iter().map(|parameter| parameter.name).collect::<Vec<_>>();
    assert_eq!(names(Law::harmonic(HARMONIC).unwrap()), ["amplitude", "frequency", "phase", "offset"]);
    assert_eq!(names(step(0.0, 1.0, 5)), ["from", "to", "start", "end"]);
    let points = |degree, ends| names(table(&[0.0, 1.0, 3.0], &[1.0, 2.0, 1.0], degree, ends));
    assert_eq!(points(SplineDegree::Cubic, SplineEnds::Periodic), ["f[0]", "f[1]"]);
    assert_eq!(points(SplineDegree::Cubic, CLAMPED), ["f[0]", "f[1]", "f[2]", "start_speed", "end_speed"]);
    let pieces = vec![
        Piece::lasting(1.0, Law::polynomial(&[0.0, 1.0]).unwrap()),
        Piece::open_ended(Law::constant(2.0)),
    ];
    assert_eq!(names(Law::sequence(pieces).unwrap()), ["piece[0].duration", "piece[0].c0", "piece[0].c1"]);
    assert!(Law::parse("3*t").unwrap().parameters().is_empty());
}

#[test]
#[should_panic(expected = "the law has 4 parameters, so none has the index 4")]
fn a_parameter_that_does_not_exist_is_a_bug_of_the_caller() {
    let _ = Law::harmonic(HARMONIC).unwrap().derivative(4, 0.0);
}

#[test]
fn scaling_multiplies_what_is_measured_in_the_unit_of_the_driver_only() {
    for law in every_kind() {
        let scaled = law.clone().scaled(4.0);
        assert_eq!(scaled.at(0.7), law.at(0.7) * 4.0);
        assert_eq!(scaled.to_string(), law.to_string());
        for (before, after) in law.parameters().iter().zip(scaled.parameters()) {
            let factor = if before.kind.is_in_driver_unit() { 4.0 } else { 1.0 };
            assert_eq!(after.value, before.value * factor);
        }
    }
}

#[test]
fn a_law_that_is_an_expression_shows_it() {
    let laws = [
        (Law::harmonic(HARMONIC).unwrap(), "-1 + 2.5*sin(2*pi*0.3*t + 0.4)"),
        (
            Law::harmonic(Harmonic { amplitude: -25.0, frequency: 1.5, phase: -0.2, offset: 0.0 }).unwrap(),
            "-25*sin(2*pi*1.5*t - 0.2)",
        ),
        (Law::polynomial(&[0.0, -1.0, 0.0, 2.5]).unwrap(), "-t + 2.5*t^3"),
        (Law::polynomial(&[0.0]).unwrap(), "0"),
        (Law::constant_speed(ConstantSpeed { speed: -3.0, offset: 1.0 }).unwrap(), "1 - 3*t"),
    ];
    for (law, text) in laws {
        assert_eq!(law.to_string(), text);
        let (ours, read) = (law.at(0.7).derivatives(), Law::parse(text).unwrap().at(0.7).derivatives());
        for order in 0..4 {
            assert!((ours[order] - read[order]).abs() <= 1e-14 * read[order].abs().max(1.0), "{text}");
        }
    }
}

#[test]
fn a_law_that_is_not_an_expression_displays_its_kind() {
    let shown = [
        (step(0.5, 2.0, 7), "smooth step of degree 7 from 0.5 at 0.5 s to 3 at 2 s"),
        (
            table(&[0.0, 1.0, 2.0], &[1.0, 0.0, 1.0], SplineDegree::Quintic, SplineEnds::Periodic),
            "periodic quintic spline through 3 points",
        ),
        (Law::parse_with("a*t/b", &[("b", 2.0), ("a", 1.5)]).unwrap(), "a*t/b with b = 2, a = 1.5"),
        (
            Law::sequence(vec![
                Piece::lasting(1.5, Law::parse("t^2").unwrap()),
                Piece::lasting(2.0, Law::constant(1.0)).not_continued(),
            ])
            .unwrap(),
            "t^2 for 1.5 s, then 1 for 2 s (not continued)",
        ),
    ];
    for (law, text) in shown {
        assert_eq!(law.to_string(), text);
    }
}

#[test]
fn parameters_of_an_expression_act_as_the_numbers_they_stand_for() {
    let with = Law::parse_with("a^2*t^n + sqrt(z)*sin(t)", &[("a", 3.0), ("n", 2.0), ("z", 0.0)]).unwrap();
    // t^2 has derivatives at t = 0; sqrt(0) has none.
    assert_eq!(with.at(0.0), Law::parse("3^2*t^2 + sqrt(0)*sin(t)").unwrap().at(0.0));
    assert_eq!(with.derivative(0, 1.0).value(), 6.0);
    assert_eq!(with.with_parameter(1, 3.0).at(2.0).value(), 72.0);

    let cases = [
        (
            "sin*t",
            "sin",
            "a parameter cannot be called `sin`: the expression knows that name already",
            "rename it",
        ),
        ("t", "t", "a parameter cannot be called `t`: the expression knows that name already", "rename it"),
        ("2*t", "a", "the parameter `a` is not used in the expression", "use it, or remove it"),
        (
            "t",
            "a b",
            "`a b` cannot be the name of a parameter",
            "use letters, digits and `_`, and begin with a letter or `_`",
        ),
    ];
    for (text, name, message, help) in cases {
        let error = Law::parse_with(text, &[(name, 1.0)]).unwrap_err();
        assert_eq!((error.message.as_str(), error.help.as_deref()), (message, Some(help)));
        assert_eq!(error.span, 0..text.len());
    }
    let error = Law::parse_with("a*t", &[("a", 1.0), ("a", 2.0)]).unwrap_err();
    assert_eq!(error.message, "two parameters are named `a`");
    let error = Law::parse_with("a*t", &[("a", f64::NAN)]).unwrap_err();
    assert_eq!(error.message, "the parameter `a` must be a finite number, not NaN");
    let error = Law::parse_with("amplitud*t", &[("amplitude", 1.0)]).unwrap_err();
    assert!(error.help.unwrap().starts_with("did you mean `amplitude`? known are t, pi, amplitude, sin,"));
}

#[test]
fn no_evaluation_allocates() {
    for law in every_kind() {
        let counted = allocation_counter::measure(|| {
            std::hint::black_box(law.at(0.7));
        });
        assert_eq!(counted.count_total, 0, "{law}");
    }
}

#[test]
fn outside_of_its_times_a_law_has_no_value_but_rounding_is_forgiven() {
    let law = table(&[1.0, 2.0, 3.0], &[0.0, 1.0, 0.0], SplineDegree::Cubic, SplineEnds::default());
    assert!(law.at(0.99).value().is_nan() && law.at(3.01).value().is_nan());
    assert!(law.at(3.0_f64.next_up()).is_finite() && law.at(1.0_f64.next_down()).is_finite());
    let tenths = (0..10).map(|_| Piece::lasting(0.1, Law::parse("t").unwrap())).collect();
    let law = Law::sequence(tenths).unwrap();
    assert!((law.at(1.0).value() - 1.0).abs() < 1e-15);
    assert!(law.at(1.01).value().is_nan() && law.at(-0.01).value().is_nan());
}

/// Laws whose pieces meet with kinks, at the times after them.
fn kinked() -> Vec<(Law, f64)> {
    let pieces = vec![
        Piece::lasting(0.9, Law::polynomial(&[0.2, 1.5]).unwrap()),
        Piece::open_ended(Law::polynomial(&[0.0, -0.5, 0.3]).unwrap()),
    ];
    let expression = |text: &str| Law::parse(text).unwrap();
    vec![
        (Law::sequence(pieces).unwrap(), 0.9),
        (expression("abs(sin(3*(t - 1.1)))*t"), 1.1),
        (expression("max(t, 2 - t)"), 1.0),
        (expression("min(t^2, 1)"), 1.0),
        (expression("if(t < 1.3, t^2, 1.69 + t - 1.3)"), 1.3),
    ]
}

#[test]
fn enclosures_contain_value_and_rates_at_all_times_and_converge() {
    let mut laws = every_kind();
    laws.extend(kinked().into_iter().map(|(law, _)| law));
    laws.push(Law::parse("2 + 0.4*t").unwrap().from_zero(2.0));
    laws.push(Law::parse("t^2.3 + hypot(t, 1) + tanh(t)/(1 + t) + asin(t/9) - log10(1 + t)").unwrap());
    for law in laws {
        let mut widths: Vec<[f64; 4]> = Vec::new();
        for (from, to) in [(0.05, 2.15), (0.4, 0.9), (0.9, 1.1), (1.2, 1.25), (1.9, 1.9001), (0.7, 0.7)] {
            let bounds = law.enclosure(Interval::between(from, to));
            widths.push(bounds.0.map(Interval::width));
            for k in 0..=200 {
                let t = from + (to - from) * f64::from(k) / 200.0;
                let exact = law.at(t).derivatives();
                for (n, (bounds, exact)) in bounds.0.iter().zip(exact).enumerate() {
                    // At the end, the law has the rates of the side after it.
                    if n > 0 && k == 200 && to > from {
                        continue;
                    }
                    // The value of the law is rounded in every operation.
                    let hair = 1e-12 * exact.abs().max(1.0);
                    let inside = bounds.low - hair <= exact && exact <= bounds.high + hair;
                    assert!(inside, "{law}, order {n} at {t}: {exact} is not in {bounds:?}");
                }
            }
        }
        // First order: from a twentieth of a second to a ten-thousandth.
        for n in 0..3 {
            let [wide, narrow, point] = [widths[3][n], widths[4][n], widths[5][n]];
            assert!(narrow < 0.05 * wide.max(0.02) && point < 1e-9, "{law}, order {n}: {widths:?}");
        }
    }
}

#[test]
fn rates_are_unbounded_where_the_speed_jumps_inside_and_bounded_up_to_there() {
    for (law, kink) in kinked() {
        let cuts = law.cuts(0.1, 2.0);
        assert!(cuts.iter().any(|cut| (cut - kink).abs() < 1e-9), "{law}: {cuts:?}");
        let [value, rate, second, _] =
            law.enclosure(Interval::between(kink - 1e-3, kink + 1e-3)).derivatives();
        assert!(value.width() < 0.02 && !rate.is_bounded() && !second.is_bounded(), "{law}");
        let [before, after] = [cuts[0], cuts[cuts.len() - 1]];
        for over in [Interval::between(before - 1e-3, before), Interval::between(after, after + 1e-3)] {
            let [value, ..] = law.enclosure(over).derivatives();
            assert!(value.is_bounded(), "{law}");
        }
    }
    // Exactly at the kink, where it is known exactly.
    for k in [0, 2, 4] {
        let (law, kink) = kinked().swap_remove(k);
        for over in [Interval::between(kink - 0.01, kink), Interval::between(kink, kink + 0.01)] {
            assert!(law.enclosure(over).dd().is_bounded(), "{law} over {over:?}");
        }
    }
}

#[test]
fn a_jump_of_the_value_is_enclosed() {
    let law = Law::parse("if(t < 1, 2, 5)").unwrap();
    let [value, rate, ..] = law.enclosure(Interval::between(0.9, 1.1)).derivatives();
    assert!(value.encloses(Interval::between(2.0, 5.0)) && value.width() < 3.0 + 1e-14 && !rate.is_bounded());
    assert!(!law.enclosure(Interval::between(0.9, f64::INFINITY)).d().is_bounded());
    let late = Law::table(&Table {
        times: vec![0.0, 1.0],
        values: vec![0.0, 1.0],
        degree: SplineDegree::Cubic,
        ends: SplineEnds::default(),
    });
    assert_eq!(late.unwrap().enclosure(Interval::between(0.5, 1.5)).value(), Interval::ENTIRE);
}
