//! The threads that a command works with.

use rayon::{ThreadPool, ThreadPoolBuilder};

use super::error::CliError;

/// So many threads.
pub(super) fn pool(threads: usize) -> Result<ThreadPool, CliError> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| {
        CliError::failed(
            "the threads cannot be started; give fewer by --threads",
            error,
        )
    })
}
