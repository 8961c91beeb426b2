//! What holds for laws of every kind: derivatives, change of unit, jumps.

use super::*;

fn table(times: &[f64], values: &[f64], degree: SplineDegree, ends: Ends) -> Law {
    Law::table(&Table { times: times.to_vec(), values: values.to_vec(), degree, ends }).unwrap()
}

fn step(start: f64, end: f64, degree: u32) -> Law {
    Law::smooth_step(SmoothStep { from: 0.5, to: 3.0, start, end, degree }).unwrap()
}

const HARMONIC: Harmonic = Harmonic { amplitude: 2.5, frequency: 0.3, phase: 0.4, offset: -1.0 };

const CLAMPED: Ends = Ends::Clamped {
    start: EndRates { speed: 0.7, acceleration: 0.0 },
    end: EndRates { speed: -0.4, acceleration: 0.0 },
};

/// One law of every kind and variant, named by its text, all smooth about t = 0.7 s and t = 1.9 s.
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
    ];
    for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
        for ends in [Ends::Natural, CLAMPED, Ends::Periodic] {
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
    laws
}

/// The smallest error of central differences as the step is halved, which first falls by 4 each time.
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
        // Where a sequence starts anew, what went before only shifts the time.
        let is_sequence = matches!(law.kind, Kind::Sequence(_));
        assert!(is_sequence || is_used.iter().all(|is_used| *is_used), "{law}: {is_used:?}");
    }
}

#[test]
fn parameters_are_named_valued_and_set_one_by_one() {
    for law in every_kind() {
        let parameters = law.parameters();
        assert_eq!(parameters.len(), law.kind.parameter_count());
        for (k, parameter) in parameters.iter().enumerate() {
            assert_eq!(parameters.iter().filter(|other| other.name == parameter.name).count(), 1);
            assert_eq!(parameter.kind, law.kind.parameter_kind(k), "{}", parameter.name);
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
    assert_eq!(points(SplineDegree::Cubic, Ends::Periodic), ["f[0]", "f[1]"]);
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
fn a_law_that_is_no_expression_says_what_it_is() {
    let shown = [
        (step(0.5, 2.0, 7), "smooth step of degree 7 from 0.5 at 0.5 s to 3 at 2 s"),
        (
            table(&[0.0, 1.0, 2.0], &[1.0, 0.0, 1.0], SplineDegree::Quintic, Ends::Periodic),
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
    // t^2 has derivatives at t = 0, and sqrt(0) has none.
    assert_eq!(with.at(0.0), Law::parse("3^2*t^2 + sqrt(0)*sin(t)").unwrap().at(0.0));
    assert_eq!(with.derivative(0, 1.0).value(), 6.0);
    assert_eq!(with.with_parameter(1, 3.0).at(2.0).value(), 72.0);

    let cases = [
        (
            "sin*t",
            "sin",
            "a parameter can not be called `sin`: the expression knows that name already",
            "rename it",
        ),
        ("t", "t", "a parameter can not be called `t`: the expression knows that name already", "rename it"),
        ("2*t", "a", "the parameter `a` is not used in the expression", "use it, or remove it"),
        (
            "t",
            "a b",
            "`a b` can not be the name of a parameter",
            "use letters, digits and `_`, and begin with a letter or `_`",
        ),
    ];
    for (text, name, message, help) in cases {
        let error = Law::parse_with(text, &[(name, 1.0)]).unwrap_err();
        assert_eq!((error.message.as_str(), error.help.as_deref()), (message, Some(help)));
        assert_eq!(error.span, 0..text.len());
    }
    let error = Law::parse_with("a*t", &[("a", 1.0), ("a", 2.0)]).unwrap_err();
    assert_eq!(error.message, "two parameters are called `a`");
    let error = Law::parse_with("a*t", &[("a", f64::NAN)]).unwrap_err();
    assert_eq!(error.message, "the a of a law must be a finite number, not NaN");
    let error = Law::parse_with("amplitud*t", &[("amplitude", 1.0)]).unwrap_err();
    assert!(error.help.unwrap().starts_with("did you mean `amplitude`? known are t, pi, amplitude, sin,"));
}

#[test]
fn jumps_are_found_where_they_are() {
    let expression = |text: &str| Law::parse(text).unwrap();
    let interrupted = vec![
        Piece::lasting(0.3, expression("5*t")),
        Piece::lasting(0.4, expression("abs(t - 0.1)")),
        Piece::open_ended(Law::constant(9.0)).not_continued(),
    ];
    let cases: [(Law, &[(f64, usize, f64)]); 12] = [
        (expression("if(t < 0.503, 1, 3)"), &[(0.503, 0, 2.0)]),
        (expression("if(t <= 1, t, 2 - t)"), &[(1.0, 1, -2.0)]),
        (expression("abs(t - 0.1)*(t - 0.1)"), &[(0.1, 2, 4.0)]),
        (expression("min(t, 1, 3 - t)"), &[(1.0, 1, -1.0), (2.0, 1, -1.0)]),
        (expression("step(t, 0.5, 0, 0.5001, 1)"), &[(0.5, 2, 6e8), (0.5001, 2, 6e8)]),
        (expression("atan2(sin(t), cos(t))"), &[(std::f64::consts::PI, 0, -std::f64::consts::TAU)]),
        (expression("max(0, t) + max(0, t - 4)"), &[(0.0, 1, 1.0), (4.0, 1, 1.0)]),
        (step(0.5, 1.5, 3), &[(0.5, 2, 15.0), (1.5, 2, 15.0)]),
        (step(0.5, 1.5, 3).scaled(-2.0), &[(0.5, 2, -30.0), (1.5, 2, -30.0)]),
        (Law::sequence(interrupted).unwrap(), &[(0.3, 1, -6.0), (0.4, 1, 2.0), (0.7, 0, 7.3)]),
        (
            Law::sequence(vec![
                Piece::lasting(
                    0.1,
                    Law::smooth_step(SmoothStep { from: 0.0, to: 1.0, start: 0.0, end: 0.1, degree: 3 })
                        .unwrap(),
                ),
                Piece::open_ended(Law::constant(0.0)),
            ])
            .unwrap(),
            &[(0.1, 2, 600.0)],
        ),
        (
            Law::sequence(vec![Piece::lasting(1.0, expression("t^2")), Piece::open_ended(expression("2*t"))])
                .unwrap(),
            &[(1.0, 2, -2.0)],
        ),
    ];
    for (law, expected) in cases {
        let found = law.jumps(0.0, 4.0);
        assert_eq!(found.len(), expected.len(), "{law}: {found:?}");
        for (jump, &(time, order, size)) in found.iter().zip(expected) {
            assert!((jump.time - time).abs() <= 1e-12, "{law}: {jump:?}");
            assert_eq!(jump.order, order, "{law}: {jump:?}");
            assert!((jump.size - size).abs() <= 1e-6 * size.abs(), "{law}: {jump:?} is not {size}");
        }
    }
}

#[test]
fn smooth_laws_have_no_jumps() {
    let smooth = [
        "abs(t - 1)^3",
        "max(sin(3*t)^2 + cos(3*t)^2, 1)",
        "if(t < 1, t^3, 1 + 3*(t - 1) + 3*(t - 1)^2 + (t - 1)^3)",
        "abs(2 + t)",
        "if(t > 9, 1, 2)",
        "atan2(t - 1, 1 + t)",
        "sqrt(t - 1)",
    ];
    let mut laws: Vec<Law> = smooth.iter().map(|text| Law::parse(text).unwrap()).collect();
    laws.extend([step(0.5, 1.5, 5), step(0.5, 1.5, 7), step(7.0, 8.0, 3)]);
    let points = |degree, ends| table(&[0.0, 0.4, 1.0, 3.0], &[1.0, 3.0, -2.0, 1.0], degree, ends);
    laws.extend([points(SplineDegree::Cubic, Ends::Periodic), points(SplineDegree::Quintic, Ends::Natural)]);
    let cosine = Law::parse("cos(t)").unwrap();
    laws.push(
        Law::sequence(vec![
            Piece::lasting(0.3, cosine.clone()),
            Piece::open_ended(Law::parse("cos(t + 0.3)").unwrap()),
        ])
        .unwrap(),
    );
    for law in laws {
        assert_eq!(law.jumps(0.0, 4.0), [], "{law}");
    }
    assert_eq!(Law::parse("abs(t)").unwrap().jumps(1.0, -1.0), [], "no time between");
    assert_eq!(Law::parse("abs(t)").unwrap().jumps(0.0, f64::INFINITY), [], "no such time");
}

#[test]
fn splines_reproduce_polynomials_of_their_degree() {
    let times = [0.0, 0.3, 1.1, 1.6, 2.5, 2.6];
    let cubic = Law::polynomial(&[1.0, -2.0, 0.5, 0.7]).unwrap();
    let quintic = Law::polynomial(&[1.0, -2.0, 0.5, 0.7, -0.9, 0.2]).unwrap();
    let parabola = Law::polynomial(&[1.0, -2.0, 0.5]).unwrap();
    let line = Law::polynomial(&[1.0, -2.0]).unwrap();
    let rates = |law: &Law, t, is_quintic| {
        let at = law.at(t);
        EndRates { speed: at.d(), acceleration: if is_quintic { at.dd() } else { 0.0 } }
    };
    let clamped = |law: &Law, is_quintic| Ends::Clamped {
        start: rates(law, times[0], is_quintic),
        end: rates(law, times[5], is_quintic),
    };
    let cases = [
        (&cubic, SplineDegree::Cubic, clamped(&cubic, false)),
        (&quintic, SplineDegree::Quintic, clamped(&quintic, true)),
        (&line, SplineDegree::Cubic, Ends::Natural),
        (&parabola, SplineDegree::Quintic, Ends::Natural),
    ];
    for (law, degree, ends) in cases {
        let spline = table(&times, &times.map(|t| law.at(t).value()), degree, ends);
        for k in 0..=26 {
            let t = 0.1 * f64::from(k);
            let (ours, exact) = (spline.at(t).derivatives(), law.at(t).derivatives());
            for order in 0..4 {
                assert!((ours[order] - exact[order]).abs() < 1e-9, "{law} at {t}: {ours:?} is not {exact:?}");
            }
        }
    }
}

#[test]
fn a_periodic_spline_of_a_sine_is_smooth_over_its_seam_and_repeats() {
    let times: Vec<f64> = (0..=16).map(|k| f64::from(k) / 16.0 + 0.2).collect();
    let mut values: Vec<f64> = times.iter().map(|t| (std::f64::consts::TAU * t).sin()).collect();
    values[16] = values[0];
    for (degree, continuous, accuracy) in [(SplineDegree::Cubic, 2, 2e-4), (SplineDegree::Quintic, 3, 2e-6)] {
        let law = table(&times, &values, degree, Ends::Periodic);
        let (before, after) = (law.at(1.2 - 1e-10).derivatives(), law.at(1.2 + 1e-10).derivatives());
        for order in 0..=continuous {
            assert!((after[order] - before[order]).abs() < 1e-4, "{law}, {order}: {before:?}, {after:?}");
        }
        for t in [-3.33, 0.21, 0.7, 1.19, 7.77] {
            assert!((law.at(t).value() - (std::f64::consts::TAU * t).sin()).abs() < accuracy, "{law} at {t}");
        }
    }
}

#[test]
fn splines_of_many_points_stay_accurate() {
    let times: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 1e-3 + 2e-4 * f64::from(k % 3)).collect();
    let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
    let end = times[2000];
    let rate = |t: f64| EndRates { speed: t.cos(), acceleration: -t.sin() };
    let law =
        table(&times, &values, SplineDegree::Quintic, Ends::Clamped { start: rate(0.0), end: rate(end) });
    let at = law.at(1.23456);
    assert!((at.value() - 1.23456_f64.sin()).abs() < 1e-13);
    assert!((at.d() - 1.23456_f64.cos()).abs() < 1e-10);
    assert!((at.dd() + 1.23456_f64.sin()).abs() < 1e-6);
}

#[test]
fn outside_of_its_times_a_law_has_no_value_but_rounding_is_forgiven() {
    let law = table(&[1.0, 2.0, 3.0], &[0.0, 1.0, 0.0], SplineDegree::Cubic, Ends::default());
    assert!(law.at(0.99).value().is_nan() && law.at(3.01).value().is_nan());
    assert!(law.at(3.0_f64.next_up()).is_finite() && law.at(1.0_f64.next_down()).is_finite());
    let tenths = (0..10).map(|_| Piece::lasting(0.1, Law::parse("t").unwrap())).collect();
    let law = Law::sequence(tenths).unwrap();
    assert!((law.at(1.0).value() - 1.0).abs() < 1e-15);
    assert!(law.at(1.01).value().is_nan() && law.at(-0.01).value().is_nan());
}

#[test]
fn a_later_piece_follows_what_the_earlier_ones_become() {
    let speed = |speed| Law::constant_speed(ConstantSpeed { speed, offset: 4.0 }).unwrap();
    let law = Law::sequence(vec![Piece::lasting(2.0, speed(3.0)), Piece::open_ended(speed(5.0))]).unwrap();
    let names: Vec<String> = law.parameters().into_iter().map(|parameter| parameter.name).collect();
    assert_eq!(
        names,
        ["piece[0].duration", "piece[0].speed", "piece[0].offset", "piece[1].speed", "piece[1].offset"]
    );
    assert_eq!(law.at(3.0).value(), 15.0); // 4 + 2 s at 3 + 1 s at 5
    // By the duration 3 - 5, by the speeds the durations; the first offset counts and the second does not.
    assert_eq!([0, 1, 2, 3, 4].map(|k| law.derivative(k, 3.0).value()), [-2.0, 2.0, 1.0, 1.0, 0.0]);
    assert!(law.with_parameter(0, -1.0).at(3.0).value().is_nan());
}

#[test]
fn tables_and_sequences_are_refused_with_the_reason() {
    use SplineDegree::{Cubic, Quintic};
    let at_end = EndRates { speed: 0.0, acceleration: 1.0 };
    let rising = Ends::Clamped { start: EndRates::default(), end: at_end };
    type Case<'a> = (&'a [f64], &'a [f64], SplineDegree, Ends, &'a str, &'a str);
    let cases: [Case<'_>; 9] = [
        (
            &[0.0, 1.0],
            &[0.0],
            Cubic,
            Ends::default(),
            "a table has 2 times but 1 values",
            "give one value for every time",
        ),
        (
            &[0.0],
            &[0.0],
            Cubic,
            Ends::default(),
            "a table needs at least 2 points, not 1",
            "add points, or write the law as a polynomial",
        ),
        (
            &[0.0, 1.0],
            &[0.0, 0.0],
            Quintic,
            Ends::Natural,
            "a quintic table with natural ends needs at least 3 points, not 2",
            "add points, or write the law as a polynomial",
        ),
        (
            &[0.0, 1.0],
            &[0.0, 0.0],
            Cubic,
            Ends::Periodic,
            "a periodic table needs at least 3 points, not 2",
            "the last point counts: it repeats the first one period later",
        ),
        (
            &[0.0, 1.0],
            &[0.0, f64::NAN],
            Cubic,
            Ends::default(),
            "the value of a table's point 1 is NaN, not a finite number",
            "points are counted from 0",
        ),
        (
            &[0.0, 2.0, 1.0],
            &[0.0; 3],
            Cubic,
            Ends::default(),
            "the times of a table must increase, but 1 s follows 2 s (points 1 and 2)",
            "sort the points by time",
        ),
        (
            &[0.0, 2.0, 2.0],
            &[0.0; 3],
            Cubic,
            Ends::default(),
            "the times of a table must increase, but 2 s follows 2 s (points 1 and 2)",
            "remove one of the two points",
        ),
        (
            &[0.0, 1.0, 2.0],
            &[0.0, 1.0, 2.0],
            Cubic,
            Ends::Periodic,
            "a periodic table must end with the value it begins with, but 2 is not 0",
            "add a last point, one period after the first, with the first one's value",
        ),
        (
            &[0.0, 1.0],
            &[0.0; 2],
            Cubic,
            rising,
            "the acceleration at the ends of a cubic table can not be chosen",
            "make the table quintic, or leave the acceleration out",
        ),
    ];
    for (times, values, degree, ends, message, help) in cases {
        let error =
            Law::table(&Table { times: times.into(), values: values.into(), degree, ends }).unwrap_err();
        assert_eq!((error.message.as_str(), error.help.as_deref()), (message, Some(help)));
    }

    let speed = || Law::parse("t").unwrap();
    let late = table(&[1.0, 2.0], &[0.0, 1.0], Cubic, Ends::default());
    let sequences = [
        (vec![], "a sequence has no pieces", "give at least one"),
        (
            vec![Piece::open_ended(speed()), Piece::open_ended(speed())],
            "piece 0 of a sequence has no duration, but is not the last",
            "only the last piece may be without end",
        ),
        (
            vec![Piece::lasting(0.0, speed())],
            "piece 0 of a sequence lasts 0 s",
            "a duration is a finite number greater than zero",
        ),
        (
            vec![Piece::lasting(1.0, speed()), Piece::lasting(2.0, late)],
            "the law of piece 1 of a sequence has no finite value at the piece's start",
            "the law's own time starts at 0 when the piece does, and ends with its duration",
        ),
    ];
    for (pieces, message, help) in sequences {
        let error = Law::sequence(pieces).unwrap_err();
        assert_eq!((error.message.as_str(), error.help.as_deref()), (message, Some(help)));
    }
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
