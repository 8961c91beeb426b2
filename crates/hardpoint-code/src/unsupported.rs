//! Unsupported machines.

use hardpoint_tape::{Lanes, Program};

use crate::{Counts, Line, PARTS, UnsupportedProgram, Width};

/// Uninhabited: no code exists on this machine.
#[derive(Debug)]
pub enum Machine {}

pub fn widest() -> Result<Width, UnsupportedProgram> {
    Err(UnsupportedProgram::Target)
}

pub fn has(_: Width) -> bool {
    false
}

impl Machine {
    pub fn new(_: &Program, _: [usize; PARTS - 1], _: Width) -> Result<(Self, Counts), UnsupportedProgram> {
        Err(UnsupportedProgram::Target)
    }

    pub fn run(&self, _: &mut Vec<Line>, _: &[Lanes], _: &[f64], _: [&mut [Lanes]; PARTS]) {
        match *self {}
    }
}
