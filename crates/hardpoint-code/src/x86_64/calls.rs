//! Functions that machine code calls.

use hardpoint_tape::Call;

use crate::Width;

/// Arguments of a call, at the start of the scratch memory; the result replaces the first one.
type Cell<const N: usize> = [[f64; N]; 2];

/// Evaluates the function for every lane.
extern "sysv64" fn lane_by_lane<const N: usize>(cell: &mut Cell<N>, call: &Call) {
    let [a, b] = cell;
    for (a, b) in a.iter_mut().zip(b) {
        *a = call.of(*a, *b);
    }
}

/// Returns the address of the function that is called with the address of the cell and `which(call)`.
pub fn address(width: Width) -> u64 {
    let function = match width {
        Width::Avx2 => lane_by_lane::<4> as extern "sysv64" fn(&mut Cell<4>, &Call) as usize,
        Width::Avx512 => lane_by_lane::<8> as extern "sysv64" fn(&mut Cell<8>, &Call) as usize,
    };
    function as u64
}

/// Returns the address of the constant that identifies the function to the called code.
pub fn which(call: Call) -> u64 {
    let forever: &'static Call = Call::ALL.iter().find(|c| **c == call).expect("the list has all of them");
    std::ptr::from_ref(forever).expose_provenance() as u64
}
