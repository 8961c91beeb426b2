//! A program in pieces has the same results, and equal pieces share a program.

use hardpoint_tape::{
    AREAS, Interpreter, Lanes, Number, Operand, Options, Pieces, PiecesRoom, Program, Recording, record,
};

use crate::random::{Formula, Random};

/// Outputs of the whole program for these lanes.
fn whole(program: &Program, inputs: &[Lanes], uniforms: &[f64]) -> Vec<Lanes> {
    let mut outputs = vec![[0.0; 8]; program.outputs.len()];
    Interpreter::new(program).run(inputs, uniforms, &mut outputs);
    outputs
}

/// Outputs of its pieces.
fn in_pieces(pieces: &Pieces, inputs: &[Lanes], uniforms: &[f64], sizes: [usize; AREAS]) -> Vec<Lanes> {
    let mut interpreters: Vec<Interpreter> =
        pieces.shapes.iter().map(|shape| Interpreter::new(&shape.program)).collect();
    let mut areas = sizes.map(|size| vec![[f64::NAN; 8]; size]);
    let [first, second, third] = &mut areas;
    let mut room = PiecesRoom::default();
    pieces.run(&mut room, inputs, uniforms, [first, second, third], |shape, inputs, uniforms, outputs| {
        let mut found = vec![[0.0; 8]; pieces.shapes[shape].program.outputs.len()];
        interpreters[shape].run(inputs, uniforms, &mut found);
        let mut found = found.into_iter();
        outputs.into_iter().flatten().for_each(|to| *to = found.next().expect("one value per output"));
        assert_eq!(found.next(), None);
    });
    areas.concat()
}

fn bits(lanes: &[Lanes]) -> Vec<Option<u64>> {
    lanes.iter().flatten().map(|x| (!x.is_nan()).then_some(x.to_bits())).collect()
}

fn numbers(random: &mut Random, many: usize) -> Vec<Lanes> {
    (0..many).map(|_| std::array::from_fn(|_| random.number())).collect()
}

#[test]
fn pieces_of_random_formulas_give_the_bits_of_the_whole() {
    let (mut compared, mut several) = (0, 0);
    for seed in 0..2000 {
        let formula = Formula::random(seed);
        let mut random = Random(!seed);
        let (program, _) = formula.record(&mut random).program(Options::default());
        let many = program.outputs.len();
        let mut ends = [random.below(many + 1), random.below(many + 1)];
        ends.sort_unstable();
        let belongs: Vec<usize> = (0..5).map(|_| random.below(4)).collect();
        let piece_of = |operand| match operand {
            Operand::Input(k) | Operand::Uniform(k) => belongs[k as usize],
            _ => panic!("{operand:?} belongs to no piece"),
        };
        let pieces = program.in_pieces(piece_of, ends);
        compared += 1;
        several += usize::from(pieces.shapes.len() > 1);
        let inputs = numbers(&mut random, formula.inputs);
        let sizes = [ends[0], ends[1] - ends[0], many - ends[1]];
        let uniforms: Vec<f64> = (0..formula.uniforms).map(|_| random.number()).collect();
        let found = in_pieces(&pieces, &inputs, &uniforms, sizes);
        assert_eq!(bits(&found), bits(&whole(&program, &inputs, &uniforms)), "seed {seed}");
    }
    assert!(compared > 1000 && several > 500, "{compared} {several}: nothing was tested");
}

/// A chain: each link turns by an angle of its own, and has a length of its own.
fn chain(links: usize) -> Recording {
    record(|| {
        let (mut places, mut x, mut y) = (Vec::new(), Number::constant(0.0), Number::constant(0.0));
        let mut largest = Number::constant(0.0);
        for k in 0..links {
            let (angle, length) = (Number::input(0.1), Number::constant(1.0 + k as f64));
            let turned = angle * angle * Number::constant(0.5) + Number::constant(1.0);
            (x, y) = (x + turned * length, y + angle * length);
            largest = largest.larger(x.abs());
            places.extend([x, y, Number::constant(0.0)]);
        }
        [vec![largest], places].concat()
    })
}

/// Every input is a piece.
fn of_input(operand: Operand) -> usize {
    let Operand::Input(k) = operand else { panic!("{operand:?} is no input") };
    k as usize
}

#[test]
fn links_of_a_chain_share_their_code() {
    let links = 50;
    let (program, _) = chain(links).program(Options::default());
    let pieces = program.in_pieces(of_input, [1, 1 + 3 * links]);
    // The first has nothing before it, and the last is read by none.
    assert!(pieces.shapes.len() <= 4, "{}", pieces.shapes.len());
    assert_eq!(pieces.pieces.len(), links);
    assert!(10 * pieces.instructions() < program.instructions.len());
    // Each link reads the one before it alone, whose numbers the next one replaces.
    assert!(pieces.kept < 10, "{} values are stored", pieces.kept);
    let inputs = numbers(&mut Random(7), links);
    let found = in_pieces(&pieces, &inputs, &[], [1, 3 * links, 0]);
    assert_eq!(bits(&found), bits(&whole(&program, &inputs, &[])));
}

#[test]
fn outputs_go_to_their_place_at_once_where_they_follow_each_other() {
    let recording = record(|| {
        let [a, b] = [Number::input(1.0), Number::input(2.0)];
        [a * a, b * b, a + a]
    });
    let (program, _) = recording.program(Options::default());
    let inputs = [[3.0; 8], [4.0; 8]];
    for (ends, written) in [([3, 3], [0, 0]), ([0, 3], [0, 1]), ([1, 3], [1, 1]), ([0, 1], [2, 1])] {
        let pieces = program.in_pieces(of_input, ends);
        let at_once =
            |piece: &hardpoint_tape::Piece| piece.areas.iter().map(|area| area.len()).sum::<usize>();
        assert_eq!(pieces.pieces.iter().map(at_once).collect::<Vec<_>>(), written, "{ends:?}");
        let found = in_pieces(&pieces, &inputs, &[], [ends[0], ends[1] - ends[0], 3 - ends[1]]);
        assert_eq!(found, whole(&program, &inputs, &[]));
    }
}
