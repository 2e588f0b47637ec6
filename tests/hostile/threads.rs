//! Bad files from many threads at once.

use std::fs;
use std::path::PathBuf;

use sootlight::volume::{Limits, open};

use crate::loading::hostile;

const THREADS: usize = 8;

/// What opening a file comes to, in words.
fn told(path: &PathBuf) -> String {
    match open(std::slice::from_ref(path), &Limits::default()) {
        Ok(volume) => {
            let grids = volume.grids.iter();
            let grids = grids.map(|it| (&it.name, it.bounds(), it.range(), it.active_voxels()));
            format!("{:?} {:?}", grids.collect::<Vec<_>>(), volume.notes)
        }
        Err(error) => error.to_string(),
    }
}

#[test]
fn many_threads_that_open_bad_files_at_once_hear_what_one_hears() {
    let mut paths: Vec<PathBuf> = fs::read_dir(hostile(""))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|it| it != "rs"))
        .collect();
    paths.sort();
    assert!(paths.len() > 90);
    let alone: Vec<String> = paths.iter().map(told).collect();
    std::thread::scope(|scope| {
        for thread in 0..THREADS {
            let (paths, alone) = (&paths, &alone);
            scope.spawn(move || {
                // Each begins elsewhere, so that all kinds of files are open side by side.
                let first = thread * paths.len() / THREADS;
                for i in 0..paths.len() {
                    let at = (first + i) % paths.len();
                    assert_eq!(told(&paths[at]), alone[at], "{}", paths[at].display());
                }
            });
        }
    });
}
