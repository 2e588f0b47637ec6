//! Steps that can be taken back and done again.

/// What was, and what was taken back.
#[derive(Debug)]
pub(super) struct History<T> {
    past: Vec<T>,
    future: Vec<T>,
    /// Whether the newest step still grows with the slider that is held.
    gesture: bool,
}

impl<T> Default for History<T> {
    fn default() -> Self {
        Self {
            past: Vec::new(),
            future: Vec::new(),
            gesture: false,
        }
    }
}

impl<T> History<T> {
    /// Makes `before` what the next undo brings back, as a step of its own. `keeps` is asked, newest first, which
    /// steps may stay: the first that may not takes all older ones with it.
    pub(super) fn push(&mut self, before: T, keeps: impl FnMut(&T) -> bool) {
        self.gesture = false;
        self.past.push(before);
        self.future.clear();
        let kept = self.past.iter().rev().map(keeps).take_while(|&kept| kept);
        let surplus = self.past.len() - kept.count();
        self.past.drain(..surplus);
    }

    /// Takes in that something changed since `before`, or that nothing did (`None`). While something is `held` all
    /// its changes are the same step.
    pub(super) fn follow(&mut self, before: Option<T>, held: bool, keeps: impl FnMut(&T) -> bool) {
        if let Some(before) = before {
            if !self.gesture {
                self.push(before, keeps);
            }
            self.future.clear();
            self.gesture = true;
        }
        self.gesture &= held;
    }

    /// The step before; `now` is what a redo brings back.
    pub(super) fn undo(&mut self, now: T) -> Option<T> {
        let before = self.past.pop()?;
        self.future.push(now);
        self.gesture = false;
        Some(before)
    }

    /// The step that was taken back last; `now` is what an undo brings back.
    pub(super) fn redo(&mut self, now: T) -> Option<T> {
        let after = self.future.pop()?;
        self.past.push(now);
        self.gesture = false;
        Some(after)
    }

    /// Visits every step, to be changed.
    pub(super) fn for_each(&mut self, visit: impl FnMut(&mut T)) {
        self.past.iter_mut().chain(&mut self.future).for_each(visit);
    }

    /// Whether there is something to take back.
    pub(super) fn can_undo(&self) -> bool {
        !self.past.is_empty()
    }

    /// Whether there is an undo to take back.
    pub(super) fn can_redo(&self) -> bool {
        !self.future.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_is_one_step_and_a_click_another() {
        let mut history = History::default();
        let mut now = 21;
        let mut set = |history: &mut History<i32>, to: i32, held: bool| {
            let before = (now != to).then_some(now);
            now = to;
            history.follow(before, held, |_| true);
        };
        for to in [30, 31, 32] {
            set(&mut history, to, true);
        }
        set(&mut history, 32, false);
        set(&mut history, 60, false);
        assert_eq!(history.undo(60), Some(32));
        assert_eq!(history.undo(32), Some(21));
        assert_eq!(history.undo(21), None);
        assert_eq!(history.redo(21), Some(32));
        now = 32;
        let before = Some(now);
        history.follow(before, false, |_| true);
        assert_eq!(
            history.redo(5),
            None,
            "a change ends what could be done again"
        );
        assert_eq!(history.undo(5), Some(32));
    }

    #[test]
    fn what_may_not_be_kept_takes_all_before_it_along() {
        let mut history = History::default();
        for step in 0..10 {
            let mut room = 3;
            history.push(step, |_| {
                room -= 1;
                room >= 0
            });
        }
        let back: Vec<i32> = std::iter::from_fn(|| history.undo(0)).collect();
        assert_eq!(back, [9, 8, 7]);
    }
}
