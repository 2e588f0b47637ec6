//! Which frames are meant: `A-B`, `A`, or `A-B:step`.

use std::fmt;
use std::str::FromStr;

use super::Sequence;

/// Frames from a first to a last one, every `step`th.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frames {
    /// The first.
    pub first: u64,
    /// The last at most; not below the first.
    pub last: u64,
    /// At least 1.
    pub step: u64,
}

impl Frames {
    /// Whether a number is meant.
    pub fn holds(self, number: u64) -> bool {
        (self.first..=self.last).contains(&number)
            && (number - self.first).is_multiple_of(self.step)
    }

    /// Those of a sequence that are meant, lowest first.
    pub fn of(self, sequence: &Sequence) -> Vec<u64> {
        sequence.numbers().filter(|&it| self.holds(it)).collect()
    }

    /// Those that are meant and that a sequence lacks, as first and last of each gap, lowest first.
    pub fn gaps(self, sequence: &Sequence) -> Vec<[u64; 2]> {
        let mut gaps = Vec::new();
        let mut next = Some(self.first);
        for number in self.of(sequence) {
            if let Some(first) = next.filter(|&first| first < number) {
                gaps.push([first, number - self.step]);
            }
            next = number.checked_add(self.step);
        }
        let end = self.last - (self.last - self.first) % self.step;
        if let Some(first) = next.filter(|&first| first <= end) {
            gaps.push([first, end]);
        }
        gaps
    }
}

impl FromStr for Frames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "expected frames such as 1-120, 7, or 1-120:2 for every second".to_owned();
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong());
        let (ends, step) = match text.split_once(':') {
            Some((ends, step)) => (ends, number(step)?),
            None => (text, 1),
        };
        let (first, last) = match ends.split_once(['-', '–']) {
            Some((first, last)) => (number(first)?, number(last)?),
            None => (number(ends)?, number(ends)?),
        };
        if step == 0 {
            return Err("every 0th frame is none: the step must be 1 or more".to_owned());
        }
        if last < first {
            return Err(format!(
                "the last frame, {last}, comes before the first, {first}: name the lower one first"
            ));
        }
        Ok(Self { first, last, step })
    }
}

impl fmt::Display for Frames {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.first == self.last {
            return write!(out, "{}", self.first);
        }
        write!(out, "{}-{}", self.first, self.last)?;
        if self.step > 1 {
            write!(out, ":{}", self.step)?;
        }
        Ok(())
    }
}
