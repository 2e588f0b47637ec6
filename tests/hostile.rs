//! Nothing bad gets in: mutations of every format, and bad files from many threads at once.

mod mutate;
mod mutations;
mod spoilt;
mod threads;
