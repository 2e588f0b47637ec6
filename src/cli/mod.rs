//! The command line: what was typed (`args`), what it means (`command`), and doing it.
//!
//! Exit codes: 0 done, 1 failed, 2 wrong usage (an unknown flag, key, value or file ending).

mod accuracy;
mod args;
mod command;
mod error;
mod frames;
mod info;
mod json;
mod load;
mod output;
mod pictures;
mod plan;
mod pool;
mod render;
mod spectrum;
mod stats;
mod study;
mod table;
mod window;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser as _;

use args::Args;
use command::Command;
use error::CliError;

/// Runs the program with its arguments, its own name first, and says how it went.
pub fn run(arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>) -> ExitCode {
    let done = match Args::try_parse_from(arguments) {
        Ok(args) => Command::new(args).and_then(Command::run),
        Err(answer) => {
            // Help and version are answers, not errors; clap knows which stream they go to.
            let _ = answer.print();
            return if answer.use_stderr() {
                ExitCode::from(error::USAGE)
            } else {
                ExitCode::SUCCESS
            };
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            output::error(&error);
            error.exit_code()
        }
    }
}

impl Command {
    fn run(self) -> Result<(), CliError> {
        match self {
            Self::Window(window) => window.run(),
            Self::Render(render) => render.run(),
            Self::Study(study) => study.run(),
            Self::Info(info) => info.run(),
            Self::Spectrum(spectrum) => spectrum.run(),
        }
    }
}
