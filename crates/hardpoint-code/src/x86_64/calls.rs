//! Functions that machine code calls.

use hardpoint_tape::Call;

use crate::Width;

/// The arguments of a call, and in place of the first its result: the first thing in the scratch.
type Cell<const N: usize> = [[f64; N]; 2];

/// Evaluates the function for every lane.
extern "sysv64" fn lane_by_lane<const N: usize>(cell: &mut Cell<N>, call: &Call) {
    let [a, b] = cell;
    for (a, b) in a.iter_mut().zip(b) {
        *a = call.of(*a, *b);
    }
}

/// Address to call with the cell's address and `which(call)`.
pub fn address(width: Width) -> u64 {
    let function = match width {
        Width::Avx2 => lane_by_lane::<4> as extern "sysv64" fn(&mut Cell<4>, &Call) as usize,
        Width::Avx512 => lane_by_lane::<8> as extern "sysv64" fn(&mut Cell<8>, &Call) as usize,
    };
    function as u64
}

/// Address of the constant that identifies the function to the called code.
pub fn which(call: Call) -> u64 {
    let forever: &'static Call = Call::ALL.iter().find(|c| **c == call).expect("the list has all of them");
    std::ptr::from_ref(forever).expose_provenance() as u64
}
