//! The `pillarforest` command: arguments in, files and messages out. All the work is in the library.
#![forbid(unsafe_code)]

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
