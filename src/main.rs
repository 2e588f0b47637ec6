//! The `sootlight` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    sootlight::cli::run(std::env::args_os())
}
