//! The command line: arguments, commands and exit codes.
//!
//! Only here are files, the clock and the terminal touched. Exit codes: 0 everything passed our own checks, 1 something is
//! wrong with the scene or its files, 2 wrong usage, 3 built and checked, but something
//! does not hold that a build promises.

mod args;
mod commands;
mod ending;
mod figures;
mod files;
mod load;
mod messages;
mod plan;
mod progress;
mod write;

use clap::Parser;
use std::process::ExitCode;

/// Parses the arguments and runs the command.
pub(crate) fn main() -> ExitCode {
    let cli = args::Cli::parse();
    ExitCode::from(commands::run(&cli))
}
