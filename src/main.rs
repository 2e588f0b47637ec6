//! The `sootlight` program.

fn main() {}
