//! Nothing bad gets in: mutations of every format, small files that would grow large, and bad files from many threads at once.

mod mutate;
mod mutations;
mod spoilt;
mod threads;
mod trees;
