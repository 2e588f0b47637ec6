//! Faults of the machine: a full disk, a folder that may not be written to, files that change while they are read. What
//! there was survives, the message says what to do, no half file is left.
//!
//! Beside these: a worker that panics (`engine`), a window closed while it exports (`window::export`), a window that is
//! killed or loses its graphics device (`window::session`).

mod changed;
mod disk;
