//! The `hardpoint` command: arguments, progress, exit codes and printing. It computes nothing itself.

mod args;
mod check;
mod folder;
mod outcome;
mod run;
mod session;
mod text;
mod verify;
mod whatif;

use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use args::{Arguments, Command};
use outcome::Outcome;

fn main() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Run(options) => run::run(&options),
        Command::Check(options) => check::check(&options),
        Command::Verify(options) => verify::verify(&options),
        Command::Whatif(options) => whatif::whatif(&options),
        Command::Schema => {
            text::print(&hardpoint_file::schema());
            Outcome::Done
        }
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "hardpoint", &mut script);
            text::print(&String::from_utf8_lossy(&script));
            Outcome::Done
        }
    };
    outcome.into()
}
