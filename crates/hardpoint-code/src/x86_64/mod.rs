//! Code for x86-64, on systems that map memory as Unix does.

mod allocate;
mod calls;
mod check;
mod encoder;
mod frame;
mod lower;
mod machine;
mod memory;

pub use machine::{Machine, has, widest};

#[cfg(test)]
mod tests;
