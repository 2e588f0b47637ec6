//! What a disk said a moment ago.

use std::time::{Duration, Instant};

/// How long it is believed: a disk may be slow, and a window asks it for every picture that it draws.
const BELIEVED: Duration = Duration::from_secs(1);

/// What was found of something, for a while.
#[derive(Debug)]
pub(super) struct Believed<K, V> {
    found: Option<(K, V, Instant)>,
}

impl<K, V> Default for Believed<K, V> {
    fn default() -> Self {
        Self { found: None }
    }
}

impl<K: PartialEq, V> Believed<K, V> {
    /// What there is to be found of it; looked up once a second, or when it is asked of something else.
    pub(super) fn of(&mut self, what: K, look_up: impl FnOnce(&K) -> V) -> &V {
        let is_believed =
            |(known, _, at): &(K, V, Instant)| *known == what && at.elapsed() < BELIEVED;
        let found = match self.found.take() {
            Some(found) if is_believed(&found) => found,
            _ => {
                let found = look_up(&what);
                (what, found, Instant::now())
            }
        };
        &self.found.insert(found).1
    }

    /// The disk was changed: it is asked again.
    pub(super) fn forget(&mut self) {
        self.found = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disk_is_asked_once_until_something_else_is_wanted() {
        let mut asked = 0;
        let mut believed = Believed::default();
        for (what, expected) in [(1, 1), (1, 1), (2, 2), (2, 2), (1, 3)] {
            let found = believed.of(what, |_| {
                asked += 1;
                asked
            });
            assert_eq!(*found, expected);
        }
        believed.forget();
        assert_eq!(*believed.of(1, |_| 7), 7);
    }
}
