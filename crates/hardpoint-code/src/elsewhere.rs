//! Machines for which no code is made.

use hardpoint_tape::{Lanes, Program};

use crate::{Counts, Line, PARTS, Unsupported, Width};

/// There is none.
#[derive(Debug)]
pub enum Machine {}

pub fn widest() -> Result<Width, Unsupported> {
    Err(Unsupported::Target)
}

pub fn has(_: Width) -> bool {
    false
}

impl Machine {
    pub fn new(_: &Program, _: [usize; PARTS - 1], _: Width) -> Result<(Self, Counts), Unsupported> {
        Err(Unsupported::Target)
    }

    pub fn run(&self, _: &mut Vec<Line>, _: &[Lanes], _: &[f64], _: [&mut [Lanes]; PARTS]) {
        match *self {}
    }
}
