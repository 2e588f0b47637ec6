//! All integration tests in one binary, because linking is slow. Each module is one kind of test.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a skipped test says so in print"
)]

mod architecture;
mod bounds;
mod cli;
mod common;
mod engine;
mod extremes;
mod faults;
mod golden;
mod ground_truth;
mod hard_cases;
mod hostile;
mod loading;
mod properties;
mod render;
mod screenshots;
mod study;
mod time_left;
#[cfg(feature = "window")]
mod window;
