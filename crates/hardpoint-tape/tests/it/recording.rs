//! Rules of recording.

use std::panic::catch_unwind;

use hardpoint_tape::{Call, Number, Options, record};

fn message(f: impl FnOnce() + std::panic::UnwindSafe) -> String {
    let payload = catch_unwind(f).expect_err("it panics");
    payload
        .downcast_ref::<&str>()
        .map_or_else(|| payload.downcast_ref::<String>().unwrap().clone(), |s| (*s).into())
}

#[test]
fn values_are_those_of_plain_arithmetic() {
    record(|| {
        let [x, y] = [Number::input(0.7), Number::uniform(-1.3)];
        let mut z = x.times_plus(y, Number::constant(2.0));
        assert_eq!(z.value(), 0.7 * -1.3 + 2.0);
        z += x;
        z -= y;
        assert_eq!(z.value(), 0.7 * -1.3 + 2.0 + 0.7 + 1.3);
        assert_eq!((-z / y).abs().sqrt().value(), (z.value() / 1.3).sqrt());
        assert_eq!((x.round().value(), Number::constant(2.5).round().value()), (1.0, 2.0));
        assert_eq!((x.larger(y).value(), y.larger(x).value()), (0.7, 0.7));
        assert_eq!((x.call(Call::Exp).value(), x.atan2(y).value()), (0.7f64.exp(), 0.7f64.atan2(-1.3)));
        assert_eq!(x.powf(y).value(), 0.7f64.powf(-1.3));
        assert_eq!((Number::constant(4.0).known(), x.known(), y.known()), (Some(4.0), None, None));
        [z]
    });
}

#[test]
fn numbers_belong_to_their_recording() {
    let mut kept = None;
    record(|| {
        kept = Some(Number::input(1.0));
        []
    });
    let kept = kept.unwrap();
    assert!(message(move || _ = kept + kept).contains("outside of a recording"));
    assert!(message(|| _ = Number::constant(1.0)).contains("outside of a recording"));
    assert!(message(move || _ = record(|| [Number::input(1.0) * kept])).contains("another recording"));
    assert!(message(move || _ = record(|| [kept])).contains("another recording"));
    assert!(
        message(|| _ = record(|| {
            record(|| []);
            []
        }))
        .contains("do not nest")
    );
    assert!(message(|| _ = record(|| [Number::input(1.0).call(Call::Pow)])).contains("of two numbers"));
    // A number of another thread is detected even if this thread has recorded the same number of times.
    let theirs = std::thread::spawn(|| {
        let mut theirs = None;
        record(|| {
            theirs = Some(Number::input(1.0));
            []
        });
        theirs.unwrap()
    })
    .join()
    .unwrap();
    assert!(message(move || _ = record(|| [Number::input(1.0) + theirs])).contains("another recording"));
    // After all this the thread records as before.
    let (program, _) = record(|| [Number::input(1.0) + Number::input(2.0)]).program(Options::default());
    assert_eq!((program.inputs, program.instructions.len()), (2, 1));
}

#[test]
fn nothing_at_all_is_a_program_too() {
    let (program, counts) = record(|| []).program(Options::default());
    assert_eq!((program.inputs, program.outputs.len(), counts.left), (0, 0, 0));
    hardpoint_tape::Interpreter::new(&program).run(&[], &[], &mut []);
}
