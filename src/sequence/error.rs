//! Why files are no sequence, in words for the person who named them.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// Why files are no sequence.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SequenceError {
    /// No path was given.
    #[error("no file was given: name one frame of a sequence, or the folder that it is in")]
    NoFiles,
    /// The name has nothing to count by.
    #[error("{path}: its name has no number: expected one such as fire_0001.vdb; rename it, or open it by itself", path = path.display())]
    NoNumber {
        /// The file.
        path: PathBuf,
    },
    /// There are no other frames.
    #[error("{path}: it is alone: expected others that are called {pattern} beside it; open it by itself", path = path.display())]
    Alone {
        /// The file.
        path: PathBuf,
        /// What its siblings would be called.
        pattern: String,
    },
    /// The system refused to list a folder.
    #[error("{folder}: its files cannot be listed: {source}", folder = folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// Nothing in a folder is numbered.
    #[error("{folder}: no sequence is in this folder: expected files such as fire_0001.vdb and fire_0002.vdb", folder = folder.display())]
    NoneInFolder {
        /// The folder.
        folder: PathBuf,
    },
    /// More than one could be meant.
    #[error("{folder}: several sequences are in this folder: {found}; name one file of the one that is meant, or one of each that belong together", folder = folder.display(), found = found.join(", "))]
    SeveralInFolder {
        /// The folder.
        folder: PathBuf,
        /// What each is called.
        found: Vec<String>,
    },
}
