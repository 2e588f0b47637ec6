//! The pictures of a range: frames of a sequence, or views from all around one fire.

use std::path::{Path, PathBuf};

use super::target;
use crate::math::Aabb;
use crate::project::Project;
use crate::sequence::Sequence;

/// How many views a turntable may have: one alone does not turn, and the most are a tenth of a degree apart.
pub const VIEWS: [u32; 2] = [2, 3600];

/// Digits of a turntable's numbers at least: as many as programs that put pictures together expect.
const DIGITS: usize = 4;

/// One picture of a range.
#[derive(Debug, Clone, PartialEq)]
pub struct Shot {
    /// Its number.
    pub number: u64,
    /// The files of its fire; none for a built-in flame.
    pub paths: Vec<PathBuf>,
    /// How far the camera has gone round its target, degrees counter-clockwise seen from above.
    pub turn_deg: f64,
}

impl Shot {
    /// What is held over a range, seen as this picture sees it.
    pub(super) fn seen(&self, held: &Project) -> Project {
        let mut project = held.clone();
        let is_placed = held.camera.eye.is_some() && held.camera.target.is_some();
        if self.turn_deg != 0.0 && is_placed {
            let camera = held.camera(&Aabb::EMPTY, held.render.size);
            let turned = camera.orbited(self.turn_deg.to_radians(), 0.0);
            project.camera.look_with(&turned);
        }
        project
    }
}

/// The pictures of a range, in the order in which they are made.
#[derive(Debug, Clone, PartialEq)]
pub struct Shots {
    all: Vec<Shot>,
    padding: usize,
}

impl Shots {
    /// Frames of a sequence, each seen from the same place.
    pub fn frames(sequence: &Sequence, numbers: &[u64]) -> Self {
        let shot = |&number: &u64| Shot {
            number,
            paths: sequence.paths(number),
            turn_deg: 0.0,
        };
        Self {
            all: numbers.iter().map(shot).collect(),
            padding: sequence.padding(),
        }
    }

    /// So many views of one fire, evenly once around it: the one after the last would be the first, so that they loop.
    pub fn turntable(paths: &[PathBuf], views: u32) -> Self {
        let shot = |number| Shot {
            number: u64::from(number),
            paths: paths.to_vec(),
            turn_deg: 360.0 * f64::from(number - 1) / f64::from(views),
        };
        Self {
            all: (1..=views).map(shot).collect(),
            padding: DIGITS,
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &Shot> {
        self.all.iter()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The file of each picture, in their order; see [`target()`].
    pub fn targets(&self, output: &Path) -> impl Iterator<Item = PathBuf> {
        let target = |shot: &Shot| target(output, shot.number, self.padding);
        self.all.iter().map(target)
    }

    /// A number with as many digits as it has in its picture's name at least.
    pub fn padded(&self, number: u64) -> String {
        format!("{number:0width$}", width = self.padding)
    }

    /// Whether the camera goes round.
    pub(super) fn turns(&self) -> bool {
        self.all.iter().any(|shot| shot.turn_deg != 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turntable_goes_round_once_and_does_not_show_its_first_view_twice() {
        let shots = Shots::turntable(&["a.vdb".into()], 8);
        let turns: Vec<f64> = shots.iter().map(|shot| shot.turn_deg).collect();
        assert_eq!(turns, [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0]);
        let last = shots.targets(Path::new("turn.png")).last();
        assert_eq!(last, Some(PathBuf::from("turn_0008.png")));
    }
}
