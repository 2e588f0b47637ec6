//! A file that is deleted, cut, overwritten or replaced while it is read.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use sootlight::volume::{Limits, Watch, open_watched};

use crate::loading::{hostile, survives_a_render};

/// What happens to a file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Change {
    Deleted,
    Cut,
    Emptied,
    Overwritten,
    Replaced,
    Grown,
}

impl Change {
    const ALL: [Self; 6] = [
        Self::Deleted,
        Self::Cut,
        Self::Emptied,
        Self::Overwritten,
        Self::Replaced,
        Self::Grown,
    ];

    fn happen_to(self, path: &Path) {
        let length = fs::metadata(path).unwrap().len();
        let open = || fs::File::options().write(true).open(path).unwrap();
        match self {
            Self::Deleted => fs::remove_file(path).unwrap(),
            Self::Cut => open().set_len(length / 3).unwrap(),
            Self::Emptied => open().set_len(0).unwrap(),
            Self::Overwritten => {
                let bytes = vec![0xa5; length as usize];
                std::io::Write::write_all(&mut open(), &bytes).unwrap();
            }
            Self::Replaced => {
                let other = path.with_extension("other");
                fs::write(&other, "2 1 1\n1e-6 2e-6\n").unwrap();
                fs::rename(other, path).unwrap();
            }
            Self::Grown => open().set_len(2 * length).unwrap(),
        }
    }
}

/// Files of every format, each longer than what is read at once.
fn files(folder: &Path) -> Vec<PathBuf> {
    let side = 130;
    let count = side * side * side;
    let write = |name: &str, bytes: Vec<u8>| {
        let path = folder.join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let mut dense = format!("{side} {side} {side}\n").into_bytes();
    let mut sparse = format!("{side} {side} {side} {count} 0\n").into_bytes();
    let mut binary = i32::to_le_bytes(count).to_vec();
    for i in 0..count {
        let [x, y, z] = [i % side, i / side % side, i / (side * side)];
        dense.extend(format!("{}e-9\n", i % 1000).bytes());
        sparse.extend(format!("{x} {y} {z} {}e-9\n", i % 1000).bytes());
        binary.extend([x, y, z].iter().flat_map(|&c| i32::to_le_bytes(c)));
        binary.extend(
            [1e-9 * (i % 1000) as f64; 4]
                .iter()
                .flat_map(|c| c.to_le_bytes()),
        );
    }
    let vdb = fs::read(hostile("vdb_good.vdb")).unwrap();
    vec![
        write("dense.txt", dense),
        write("sparse.txt", sparse),
        write("soot.bin", binary),
        write("fire.vdb", vdb),
    ]
}

#[test]
fn a_file_that_changes_while_it_is_read_is_read_or_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let (mut read, mut refused) = (0, 0);
    for path in files(folder.path()) {
        let (good, name) = (fs::read(&path).unwrap(), path.display().to_string());
        for change in Change::ALL {
            for at in [0.02, 0.4] {
                fs::write(&path, &good).unwrap();
                let begun = Arc::new(AtomicBool::new(false));
                let (fuse, changed) = (Arc::clone(&begun), path.clone());
                let watch = Watch::with_listener(move |watch| {
                    if watch.share() >= at && !fuse.swap(true, Ordering::SeqCst) {
                        change.happen_to(&changed);
                    }
                });
                let opened = open_watched(std::slice::from_ref(&path), &Limits::default(), &watch);
                assert!(
                    begun.load(Ordering::SeqCst),
                    "{name}: {change:?} never happened"
                );
                match opened {
                    Ok(volume) => {
                        read += 1;
                        // What a reader has open on this system it can read to its end.
                        let whole = volume.grids.iter().all(|grid| grid.range().1.is_finite());
                        assert!(whole, "{name}, {change:?}");
                        if path.extension().is_some_and(|ending| ending == "vdb") {
                            survives_a_render(volume, &name);
                        }
                    }
                    Err(error) => {
                        refused += 1;
                        let words = error.to_string();
                        assert!(words.contains(&name), "{change:?}: {words}");
                    }
                }
                let _ = fs::remove_file(&path);
            }
        }
    }
    println!("files that changed while they were read: {read} read, {refused} refused");
    assert!(read > 0 && refused > 10, "{read} read, {refused} refused");
}
