//! The command line: arguments, commands and exit codes.
//!
//! Only here are files, the clock and the terminal touched. Exit codes: 0 everything passed our own checks, 1 something is
//! wrong with the scene or its files, 2 wrong usage (of arguments, or of a place to write to), 3 built and checked, but something
//! does not hold that a build promises, 4 the program failed, or the system did under it (a full disk).

mod args;
mod bench;
mod case_builder;
mod commands;
mod ending;
mod fault;
mod figures;
mod files;
mod init;
mod inspect;
mod load;
mod messages;
mod plan;
mod progress;
mod signals;
mod staging;
mod threads;
mod write;

use clap::Parser;
use clap::error::ErrorKind;
use std::process::ExitCode;

/// Parses the arguments and runs the command.
pub(crate) fn main() -> ExitCode {
    let code = match args::Cli::try_parse() {
        Ok(cli) => {
            let messages = messages::Messages::new(&cli.global);
            fault::caught(&messages, || commands::run(&cli, &messages))
        }
        Err(asked) => told(&asked),
    };
    ExitCode::from(code)
}

/// Prints the help that was asked for, or what is wrong with the arguments.
fn told(asked: &clap::Error) -> u8 {
    // What goes to standard output must get there; standard error may be closed.
    match asked.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            use std::io::IsTerminal;
            let text = asked.render();
            match std::io::stdout().is_terminal() && messages::colours_wanted() {
                true => ending::say(&text.ansi().to_string()),
                false => ending::say(&text.to_string()),
            }
        }
        _ => {
            let _ = asked.print();
            ending::WRONG_USAGE
        }
    }
}
