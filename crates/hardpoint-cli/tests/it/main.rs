//! The command as its users meet it: output, files and exit codes.

mod bench;
mod calibrate;
mod golden;
mod optimize;
mod results;
mod sweep;
mod tolerance;
mod whatif;
