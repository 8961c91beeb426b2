//! Loads on the twists of frames.

use crate::space::{Real, Wrench};
use crate::topology::Topology;

/// Loads on the twists D = W + z of the frames in which unit twists and wrenches are fixed.
#[derive(Clone, Debug)]
pub(crate) struct Turning<T = f64> {
    /// Per link: on the twist of its parent's marker.
    pub starts: Vec<Wrench<T>>,
    /// Per closure: on the twists of markers i and j.
    pub ends: Vec<[Wrench<T>; 2]>,
    /// Per coordinate: on its speed S.
    pub pulls: Vec<T>,
}

impl<T: Real> Turning<T> {
    pub fn new(topology: &Topology) -> Self {
        Self {
            starts: vec![Wrench::zero(); topology.links.len()],
            ends: vec![[Wrench::zero(); 2]; topology.closures.len()],
            pulls: vec![T::zero(); topology.coordinates.len()],
        }
    }

    /// Adds `k` times the loads of `other`.
    pub fn add_times(&mut self, other: &Self, k: T) {
        let wrenches = self.starts.iter_mut().chain(self.ends.as_flattened_mut());
        let others = other.starts.iter().chain(other.ends.as_flattened());
        wrenches.zip(others).for_each(|(to, from)| *to = from.times_plus(k, *to));
        self.pulls.iter_mut().zip(&other.pulls).for_each(|(to, from)| *to = from.times_plus(k, *to));
    }
}
