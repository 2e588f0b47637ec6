//! How far a picture is, and how long the rest of it takes.

use std::time::Duration;

use crate::render::costs::Cost;
use crate::render::plan::Decision;
use crate::render::{Facts, Flaws, Pass};

/// Share of the fine passes up to which nothing can be told of the rest: what one tile takes says too little.
const TOO_EARLY: f64 = 0.03;

/// How far a job is.
#[derive(Debug, Clone, Default)]
pub struct Progress {
    /// Its passes.
    pub passes: Vec<Pass>,
    /// Passes that are whole.
    pub done: usize,
    /// Rays of the running pass that are on the film.
    pub rays_in_pass: u64,
    /// Rays of the running pass altogether.
    pub rays_of_pass: u64,
    /// Share of the running pass's work that is on the film, 0 to 1: tiles weigh what the pass before took there, so that it is
    /// as true after the dark corners as after the fire.
    pub share_of_pass: f64,
    /// Time from the submit to the first ray of each pass that has begun.
    pub begun: Vec<Duration>,
    /// All rays so far.
    pub rays: u64,
    /// All samples of the medium so far.
    pub samples: u64,
    /// Time from the submit to the first whole pass.
    pub first_picture: Option<Duration>,
    /// Time from the submit to the last whole pass.
    pub elapsed: Duration,
    /// Whether every pass is whole.
    pub finished: bool,
    /// What the settings cannot show faithfully.
    pub flaws: Flaws,
    /// Which effects are computed, and why.
    pub decisions: Vec<Decision>,
    /// What has been found out about the picture so far.
    pub facts: Facts,
    /// What effects cost, once that is measured.
    pub costs: Option<Vec<Cost>>,
    /// What went wrong, if something did.
    pub failure: Option<String>,
}

impl Progress {
    /// Whether the running pass has not begun: light from all sides is worked out before its first ray.
    pub fn prepares(&self) -> bool {
        !self.finished && !self.passes.is_empty() && self.begun.len() <= self.done
    }

    /// The finished share of all passes, 0 to 1, a step of a ray like any other.
    pub fn share(&self) -> f64 {
        if self.finished {
            return 1.0;
        }
        let weight = |pass: &Pass| 1.0 / (f64::from(pass.stride * pass.stride) * pass.step_voxels);
        let all: f64 = self.passes.iter().map(weight).sum();
        let done: f64 = self.passes.iter().take(self.done).map(weight).sum();
        let running = self.passes.get(self.done).map_or(0.0, weight);
        if all > 0.0 {
            (done + running * self.share_of_pass) / all
        } else {
            0.0
        }
    }

    /// How long the rest takes so long after the submit, if it goes on as the fine passes went so far, each of which takes as
    /// long as another; `None` while that cannot be told.
    pub fn left(&self, since_submit: Duration) -> Option<Duration> {
        let coarse = self
            .passes
            .iter()
            .take_while(|pass| pass.stride > 1)
            .count();
        let begun = self.begun.get(coarse)?;
        let done = self.done.checked_sub(coarse)? as f64 + self.share_of_pass;
        if done < TOO_EARLY {
            return None;
        }
        let all = (self.passes.len() - coarse) as f64;
        let took = since_submit.saturating_sub(*begun);
        Some(took.mul_f64(((all - done) / done).max(0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::pass::Audience;

    /// Three coarse passes and two fine ones.
    fn ladder(done: usize, share_of_pass: f64) -> Progress {
        let passes = [(8, 2.0), (4, 2.0), (2, 2.0), (1, 1.0), (1, 1.0)]
            .map(|(stride, step_voxels)| Pass {
                stride,
                sample: 0,
                samples: 1,
                step_voxels,
                region: None,
                audience: Audience::Window,
            })
            .to_vec();
        Progress {
            passes,
            done,
            share_of_pass,
            begun: [1, 2, 3, 10, 20].map(Duration::from_secs)[..=done].to_vec(),
            ..Progress::default()
        }
    }

    #[test]
    fn the_share_counts_steps_and_ends_at_one() {
        let coarse = 0.5 * (1.0 / 64.0 + 1.0 / 16.0 + 0.25);
        let mut progress = ladder(3, 0.5);
        let expected = (coarse + 0.5) / (coarse + 2.0);
        assert!((progress.share() - expected).abs() < 1e-12);
        progress.finished = true;
        assert_eq!(progress.share(), 1.0);
        assert_eq!(Progress::default().share(), 0.0);
    }

    #[test]
    fn the_rest_takes_as_long_as_the_fine_passes_took_so_far() {
        let left = |progress: &Progress, s| progress.left(Duration::from_secs(s));
        // A quarter of the two fine passes took 5 s since 10 s; what was before does not count.
        assert_eq!(left(&ladder(3, 0.5), 15), Some(Duration::from_secs(15)));
        assert_eq!(left(&ladder(4, 0.5), 25), Some(Duration::from_secs(5)));
        assert_eq!(left(&ladder(4, 1.0), 30), Some(Duration::ZERO));
        assert_eq!(left(&ladder(2, 0.9), 9), None);
        assert_eq!(left(&ladder(3, 0.01), 11), None);
        assert_eq!(left(&Progress::default(), 1), None);
    }

    #[test]
    fn a_pass_is_prepared_until_its_first_ray() {
        let mut progress = ladder(3, 0.0);
        assert!(!progress.prepares());
        progress.begun.pop();
        assert!(progress.prepares());
        progress.finished = true;
        assert!(!progress.prepares() && !Progress::default().prepares());
    }
}
