//! What can go wrong on the command line, and with which exit code.

use std::process::ExitCode;

use thiserror::Error;

use crate::project::ProjectError;
use crate::project::file::SceneFileError;

/// Exit code of work that failed.
const FAILED: u8 = 1;
/// Exit code of a command that makes no sense.
pub(super) const USAGE: u8 = 2;

/// Why the program ends without having done its work.
#[derive(Debug, Error)]
pub(super) enum CliError {
    /// The command makes no sense; the words say how to mend it.
    #[error("{0}")]
    Usage(String),
    /// A key or value of the scene file or of `--set`.
    #[error("{what}")]
    WrongSetting {
        /// Where it was given.
        what: String,
        /// What is wrong with it.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The work failed.
    #[error("{what}")]
    Failed {
        /// What was being done.
        what: String,
        /// Why it failed.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// The work failed, and one sentence says it all.
    #[error("{0}")]
    Said(String),
}

impl CliError {
    /// Work that failed for a reason.
    pub(super) fn failed(
        what: impl Into<String>,
        source: impl Into<Box<dyn std::error::Error + Send + Sync>>,
    ) -> Self {
        Self::Failed {
            what: what.into(),
            source: source.into(),
        }
    }

    /// A setting that is wrong.
    pub(super) fn setting(
        what: impl Into<String>,
        source: impl Into<Box<dyn std::error::Error + Send + Sync>>,
    ) -> Self {
        Self::WrongSetting {
            what: what.into(),
            source: source.into(),
        }
    }

    /// A scene file that cannot be had.
    pub(super) fn scene(source: SceneFileError) -> Self {
        let what = "the scene file is not right";
        match source {
            SceneFileError::Read { .. } => Self::failed("the scene file cannot be used", source),
            _ => Self::setting(what, source),
        }
    }

    /// A project that cannot be rendered: what a person set is usage, what a file lacks is not.
    pub(super) fn project(source: ProjectError) -> Self {
        match source {
            ProjectError::NothingToRender { .. } => Self::Said(source.to_string()),
            ProjectError::Picture(_) => Self::failed("the backdrop cannot be shown", source),
            _ => Self::setting("this cannot be rendered as it is set", source),
        }
    }

    /// The program's exit code.
    pub(super) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Usage(_) | Self::WrongSetting { .. } => USAGE,
            Self::Failed { .. } | Self::Said(_) => FAILED,
        })
    }
}
