//! Against the unbiased reference.
