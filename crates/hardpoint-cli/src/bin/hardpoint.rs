//! The `hardpoint` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(hardpoint_cli::main(std::env::args_os()))
}
