//! Files that were opened before, newest first.

use std::path::PathBuf;

/// How many are remembered.
const MOST: usize = 10;
/// Under which name they are stored.
const KEY: &str = "recent";

/// What was opened, each as the files that belong together.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Recent(Vec<Vec<PathBuf>>);

impl Recent {
    /// What an earlier window stored; nothing if there is nothing or it is not understood.
    pub(super) fn load(storage: Option<&dyn eframe::Storage>) -> Self {
        let stored = storage.and_then(|storage| eframe::get_value(storage, KEY));
        Self(stored.unwrap_or_default())
    }

    /// Stores it for the next window.
    pub(super) fn save(&self, storage: &mut dyn eframe::Storage) {
        // The storage holds text: a path that is none cannot be remembered.
        let text = |files: &&Vec<PathBuf>| files.iter().all(|path| path.to_str().is_some());
        let kept: Vec<_> = self.0.iter().filter(text).collect();
        eframe::set_value(storage, KEY, &kept);
    }

    /// Puts files first. They are remembered by their whole paths: the next window may start elsewhere.
    pub(super) fn add(&mut self, files: &[PathBuf]) {
        if files.is_empty() {
            return;
        }
        let files = whole(files);
        self.0.retain(|known| *known != files);
        self.0.insert(0, files);
        self.0.truncate(MOST);
    }

    /// The entry of these files, if they are remembered.
    pub(super) fn entry(&self, files: &[PathBuf]) -> Option<&[PathBuf]> {
        let files = whole(files);
        self.iter().find(|known| *known == files)
    }

    /// Newest first.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[PathBuf]> {
        self.0.iter().map(Vec::as_slice)
    }
}

/// The whole paths of files.
fn whole(files: &[PathBuf]) -> Vec<PathBuf> {
    let whole = |path: &PathBuf| std::path::absolute(path).unwrap_or_else(|_| path.clone());
    files.iter().map(whole).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// What a window remembers, without a disk.
    #[derive(Default)]
    pub(in crate::app) struct Memory(std::collections::HashMap<String, String>);

    impl eframe::Storage for Memory {
        fn get_string(&self, key: &str) -> Option<String> {
            self.0.get(key).cloned()
        }

        fn set_string(&mut self, key: &str, value: String) {
            self.0.insert(key.to_owned(), value);
        }

        fn remove_string(&mut self, key: &str) {
            self.0.remove(key);
        }

        fn flush(&mut self) {}
    }

    #[test]
    fn the_newest_comes_first_and_each_once_and_the_next_window_knows_them() {
        let mut recent = Recent::default();
        for i in 0..20 {
            recent.add(&[PathBuf::from(format!("/fire_{i}.vdb"))]);
        }
        recent.add(&["/a_density.txt".into(), "/a_temp.txt".into()]);
        recent.add(&["/fire_15.vdb".into()]);
        recent.add(&[]);
        let names: Vec<_> = recent.iter().collect();
        assert_eq!(names.len(), MOST);
        assert_eq!(names[0], [PathBuf::from("/fire_15.vdb")]);
        assert_eq!(names[1].len(), 2);
        assert_eq!(
            names.iter().filter(|files| ***files == *names[0]).count(),
            1
        );

        let mut storage = Memory::default();
        recent.save(&mut storage);
        assert_eq!(Recent::load(Some(&storage)), recent);
        assert_eq!(Recent::load(None), Recent::default());
    }
}
