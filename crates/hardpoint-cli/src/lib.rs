//! The `hardpoint` command: arguments, progress, exit codes and printing. It computes nothing itself. The program of
//! this name and `python -m hardpoint` call [`main`].

mod args;
mod calibrate;
mod check;
mod clearance;
mod compare;
mod compile;
mod envelope;
mod export;
mod folder;
mod import;
mod journal;
mod lsp;
mod map;
mod maps;
mod mcp;
mod meter;
mod new;
mod optimize;
mod outcome;
mod pages;
mod rpc;
mod run;
mod session;
mod site;
mod studio;
mod sweep;
mod synthesize;
mod tables;
mod text;
mod tolerance;
mod trade_off;
mod verify;
mod whatif;

use std::ffi::OsString;
use std::io::Write;

use clap::{CommandFactory, FromArgMatches};

use args::{Arguments, Command};
use outcome::Outcome;
use session::Session;

/// Arguments of a command line. A negative number after an option is its value, so that the message is about its range.
fn parse_arguments(arguments: impl IntoIterator<Item = OsString>) -> Result<Arguments, clap::Error> {
    let mut command = Arguments::command().mut_subcommands(|one| {
        one.mut_args(|arg| {
            let has_value = arg.get_long().is_some() && arg.get_action().takes_values();
            arg.allow_negative_numbers(has_value)
        })
    });
    let matches = command.try_get_matches_from_mut(arguments)?;
    Arguments::from_arg_matches(&matches).map_err(|error| error.format(&mut command))
}

/// Runs the command and returns its exit code. The first argument is the name of the program.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments = match parse_arguments(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are results, everything else is an error.
            if let Err(failure) = error.print().and_then(|()| std::io::stdout().flush()) {
                text::note_failure(failure);
            }
            let outcome = if error.use_stderr() { Outcome::Misunderstood } else { Outcome::Done };
            return Session::not_printed(outcome) as u8;
        }
    };
    let outcome = match arguments.command {
        Command::New(options) => new::run(&options),
        Command::Synthesize(options) => synthesize::run(&options),
        Command::Run(options) => run::run(&options),
        Command::Check(options) => check::check(&options),
        Command::Clearance(options) => clearance::run(&options),
        Command::Envelope(options) => envelope::run(&options),
        Command::Map(options) => map::run(&options),
        Command::Export(options) => export::export(&options),
        Command::Import(options) => import::import(&options),
        Command::Verify(options) => verify::verify(&options),
        Command::Whatif(options) => whatif::whatif(&options),
        Command::Compare(options) => compare::compare(&options),
        Command::Optimize(options) => optimize::run(&options),
        Command::TradeOff(options) => trade_off::run(&options),
        Command::Tolerance(options) => tolerance::run(&options),
        Command::Calibrate(options) => calibrate::run(&options),
        Command::Sweep(options) => sweep::run(&options),
        Command::Studio(options) => studio::run(&options),
        Command::Site(options) => site::run(&options),
        Command::Mcp => mcp::run(),
        Command::Lsp(_) => lsp::run(),
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
    Session::not_printed(outcome) as u8
}
