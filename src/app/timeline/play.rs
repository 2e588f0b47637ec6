//! Which frame comes next.

use crate::sequence::Sequence;

/// The frames that there are, and which of them play.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Range {
    numbers: Vec<u64>,
    /// First and last that play; both are there.
    ends: [u64; 2],
}

impl Range {
    /// All frames of a sequence.
    pub(super) fn of(sequence: &Sequence) -> Self {
        Self {
            numbers: sequence.numbers().collect(),
            ends: sequence.ends(),
        }
    }

    /// The numbers that play, lowest first.
    pub(super) fn numbers(&self) -> &[u64] {
        let [first, last] = self.ends;
        let from = self.numbers.partition_point(|&it| it < first);
        let to = self.numbers.partition_point(|&it| it <= last);
        &self.numbers[from..to]
    }

    /// First and last that play.
    pub(super) fn ends(&self) -> [u64; 2] {
        self.ends
    }

    /// The frame that is nearest to a number, the lower of two.
    pub(super) fn nearest(&self, number: u64) -> Option<u64> {
        let distance = |it: &u64| it.abs_diff(number);
        self.numbers.iter().copied().min_by_key(distance)
    }

    /// Lets the first frame that plays be the nearest to this.
    pub(super) fn set_in(&mut self, number: u64) {
        if let Some(number) = self.nearest(number) {
            self.ends = [number, self.ends[1].max(number)];
        }
    }

    /// Lets the last frame that plays be the nearest to this.
    pub(super) fn set_out(&mut self, number: u64) {
        if let Some(number) = self.nearest(number) {
            self.ends = [self.ends[0].min(number), number];
        }
    }

    /// The frame after one, or before it, that plays and is not passed over; from the other end again if it `loops`.
    pub(super) fn next(
        &self,
        from: u64,
        forth: bool,
        loops: bool,
        is_passed_over: impl Fn(u64) -> bool,
    ) -> Option<u64> {
        let numbers = self.numbers();
        let mut ordered: Vec<u64> = if forth {
            numbers.to_vec()
        } else {
            numbers.iter().rev().copied().collect()
        };
        let comes_after = |number: u64| if forth { number > from } else { number < from };
        let at = ordered.iter().position(|&it| comes_after(it));
        let at = at.unwrap_or(ordered.len());
        if loops {
            ordered.rotate_left(at);
        } else {
            ordered.drain(..at);
        }
        ordered
            .into_iter()
            .find(|&number| number != from && !is_passed_over(number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range() -> Range {
        Range {
            numbers: vec![3, 4, 7, 9],
            ends: [3, 9],
        }
    }

    #[test]
    fn frames_follow_each_other_over_gaps_and_bad_ones_and_around_the_end() {
        let range = range();
        let next = |from, forth, loops| range.next(from, forth, loops, |number| number == 7);
        assert_eq!(next(3, true, false), Some(4));
        assert_eq!(next(4, true, false), Some(9));
        assert_eq!(next(9, true, false), None);
        assert_eq!(next(9, true, true), Some(3));
        assert_eq!(next(9, false, false), Some(4));
        assert_eq!(next(3, false, false), None);
        assert_eq!(next(3, false, true), Some(9));
        assert_eq!(range.next(3, true, true, |_| true), None);
    }

    #[test]
    fn in_and_out_bound_what_plays_and_stay_in_order() {
        let mut range = range();
        range.set_in(5);
        range.set_out(8);
        assert_eq!(range.ends(), [4, 7]);
        assert_eq!(range.numbers(), [4, 7]);
        assert_eq!(range.next(7, true, true, |_| false), Some(4));
        // From outside the way leads in.
        assert_eq!(range.next(9, true, true, |_| false), Some(4));
        range.set_in(9);
        assert_eq!(range.ends(), [9, 9]);
        range.set_out(0);
        assert_eq!(range.ends(), [3, 3]);
        assert_eq!(range.next(3, true, true, |_| false), None);
    }
}
