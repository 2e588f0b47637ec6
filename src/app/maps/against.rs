//! The picture on show against the reference of its scene, which is rendered behind it as soon as somebody wants to know.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::About;
use crate::app::accuracy::view_of;
use crate::app::background::{Ended, Rank, Running, Wake};
use crate::engine::Picture;
use crate::project::Job;
use crate::render::{Film, Tile};
use crate::study::{self, Choice, Error};

/// The reference, as far as it is, and what the comparison with the picture has found.
pub(super) struct Against {
    wake: Wake,
    reference: Option<Reference>,
    comparing: Option<Running<Found>>,
    found: Option<Found>,
    /// The picture that is compared, and which state of it: as long as it does not change it is not copied again.
    compares: Option<(u64, Arc<Film>)>,
    /// Whether nothing is to be seen in the scene.
    sees_nothing: bool,
    /// When the last comparison began.
    compared: Option<Instant>,
    /// Rises with what was found.
    version: u64,
}

/// While the reference comes in, the picture is compared with it this often.
const AGAIN: Duration = Duration::from_millis(500);

struct Reference {
    /// What it shows, whatever its numbers.
    view: Job,
    film: Arc<Film>,
    /// Which of its pixels are there, row by row.
    known: Arc<Vec<bool>>,
    pixels: usize,
    /// How far it is itself from the finest there is.
    own: Error,
    rendering: Option<Running<Tile>>,
    /// Whether it ended before it was whole.
    failed: bool,
}

impl Reference {
    fn is_whole(&self) -> bool {
        self.pixels == self.known.len()
    }

    fn take(&mut self, tile: &Tile) {
        let width = self.film.size()[0] as usize;
        let known = Arc::make_mut(&mut self.known);
        let [left, top] = tile.origin.map(|side| side as usize);
        let [across, down] = tile.size.map(|side| side as usize);
        for row in known.chunks_mut(width).skip(top).take(down) {
            row[left..left + across].fill(true);
        }
        self.pixels += tile.pixels.len();
        Arc::make_mut(&mut self.film).merge(tile);
    }
}

/// A comparison.
struct Found {
    of: Compared,
    /// ΔE of each pixel.
    apart: Vec<f32>,
    /// That of the whole picture, if all of the reference was there.
    error: Option<Error>,
}

/// What was compared: which state of the picture, and how many pixels of the reference were there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Compared {
    picture: u64,
    pixels: usize,
    /// Whether that was all of both.
    is_whole: bool,
}

impl Against {
    pub(super) fn new(wake: Wake) -> Self {
        Self {
            wake,
            reference: None,
            comparing: None,
            found: None,
            compares: None,
            sees_nothing: false,
            compared: None,
            version: 0,
        }
    }

    /// Which state of the map there is.
    pub(super) fn version(&self) -> u64 {
        self.version
    }

    /// ΔE of each pixel, not a number where there is no reference yet, if they are of a picture as large as this.
    pub(super) fn values(&self, picture: &Picture) -> Option<&[f32]> {
        let apart = &self.found.as_ref()?.apart;
        (apart.len() == picture.film().pixels().len()).then_some(apart)
    }

    /// How far the whole picture of a job is from the reference, if that was measured.
    pub(super) fn measured(&self, job: &Job, picture: &Picture) -> Option<Error> {
        let reference = self.reference.as_ref()?;
        let found = self.found.as_ref()?;
        let is_of_it = found.of.picture == picture.version && reference.view == view_of(job);
        found.error.filter(|_| is_of_it)
    }

    /// How far the reference is, in words.
    pub(super) fn progress_words(&self, picture: &Picture) -> String {
        let is_compared = |found: &Found| found.of.is_whole && found.of.picture == picture.version;
        match &self.reference {
            None if self.sees_nothing => "nothing is seen in this picture".to_owned(),
            None => "the reference waits for the picture".to_owned(),
            Some(reference) if reference.is_whole() => {
                if self.found.as_ref().is_some_and(is_compared) {
                    "measured".to_owned()
                } else {
                    "of the picture before".to_owned()
                }
            }
            Some(reference) if reference.failed => "the reference failed".to_owned(),
            Some(reference) => {
                let share = reference.pixels as f64 / reference.known.len().max(1) as f64;
                format!("{:.0} % of the reference is there", (100.0 * share).floor())
            }
        }
    }

    /// Takes in what has come. Begins to render the reference where it is wanted, once the picture is whole, and to compare
    /// what there is of it with the picture.
    pub(super) fn follow(&mut self, about: &About<'_>, wanted: bool) {
        self.receive();
        let Some(job) = about.job else { return };
        self.sees_nothing = about.sees_nothing;
        let view = view_of(job);
        if self.reference.as_ref().is_some_and(|it| it.view != view) {
            self.reference = None;
            self.comparing = None;
            self.compares = None;
            self.found = None;
            self.version += 1;
        }
        if self.reference.is_none()
            && wanted
            && about.picture.progress.finished
            && let Some(pilot) = about.pilot
        {
            let finest = pilot.choice(pilot.finest());
            self.render(view, finest, about);
        }
        self.compare(about);
    }

    fn render(&mut self, view: Job, finest: Choice, about: &About<'_>) {
        let Some(packed) = about.packed.clone() else {
            // The engine was publishing at this very moment: ask again.
            (self.wake)();
            return;
        };
        let size = packed.settings.size;
        let film = Film::new(size);
        let rank = Rank::BehindThePicture;
        let rendering = Running::begin("reference", rank, &self.wake, move |cancel, tell| {
            let (scene, plan) = (&packed.scene, &packed.plan);
            let numbers = finest.numbers;
            study::render_reference(scene, plan, &packed.settings, numbers, cancel, tell);
        });
        self.reference = Some(Reference {
            view,
            known: Arc::new(vec![false; film.pixels().len()]),
            film: Arc::new(film),
            pixels: 0,
            own: finest.error.all,
            failed: rendering.is_none(),
            rendering,
        });
    }

    fn receive(&mut self) {
        // While it is compared it stays as it is, and needs no copy; what has come waits.
        if let Some(reference) = &mut self.reference
            && self.comparing.is_none()
        {
            while let Some(rendering) = &reference.rendering {
                match rendering.next() {
                    Ok(Some(tile)) => reference.take(&tile),
                    Ok(None) => break,
                    Err(Ended) => {
                        reference.rendering = None;
                        reference.failed = !reference.is_whole();
                    }
                }
            }
        }
        match self.comparing.as_ref().map(Running::next) {
            Some(Ok(Some(found))) => {
                self.found = Some(found);
                self.version += 1;
                self.comparing = None;
            }
            Some(Err(Ended)) => self.comparing = None,
            Some(Ok(None)) | None => {}
        }
    }

    fn compare(&mut self, about: &About<'_>) {
        let (Some(reference), Some(pilot)) = (&self.reference, about.pilot) else {
            return;
        };
        let of = Compared {
            picture: about.picture.version,
            pixels: reference.pixels,
            is_whole: reference.is_whole() && about.picture.progress.finished,
        };
        let is_done = self.found.as_ref().is_some_and(|found| found.of == of);
        let is_soon = self.compared.is_some_and(|at| at.elapsed() < AGAIN) && !of.is_whole;
        if is_done || is_soon || reference.pixels == 0 || self.comparing.is_some() {
            return;
        }
        if self
            .compares
            .as_ref()
            .is_none_or(|(version, _)| *version != of.picture)
        {
            self.compares = Some((of.picture, Arc::new(about.picture.film().clone())));
        }
        let Some((_, picture)) = self.compares.clone() else {
            return;
        };
        let own = reference.own;
        let (film, known) = (Arc::clone(&reference.film), Arc::clone(&reference.known));
        let pilot = Arc::clone(pilot);
        self.compared = Some(Instant::now());
        let rank = Rank::BehindThePicture;
        self.comparing = Running::begin("compare", rank, &self.wake, move |_, tell| {
            let whole = of.is_whole.then(|| study::measured(&film, &picture, own));
            tell(Found {
                of,
                apart: study::apart(&pilot, &film, &known, &picture),
                error: whole.flatten(),
            });
        });
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use crate::project::Project;
    use crate::volume::procedural;

    #[test]
    fn only_the_picture_that_was_compared_counts_as_measured() {
        let project = Project::default();
        let job = project.job(&Arc::new(procedural::torch())).unwrap();
        let picture = Picture::new([4, 2]);
        let film = Arc::new(Film::new([4, 2]));
        let mut against = Against::new(Arc::new(|| {}));
        against.reference = Some(Reference {
            view: view_of(&job),
            known: Arc::new(vec![true; 8]),
            film,
            pixels: 8,
            own: Error::default(),
            rendering: None,
            failed: false,
        });
        let found = |version: u64| Found {
            of: Compared {
                picture: version,
                pixels: 8,
                is_whole: true,
            },
            apart: vec![0.0; 8],
            error: Some(Error::default()),
        };
        against.found = Some(found(picture.version));
        assert!(against.measured(&job, &picture).is_some());
        // Other numbers show the same, another camera does not.
        let mut finer = job.clone();
        finer.settings.step_voxels = 0.3;
        assert!(against.measured(&finer, &picture).is_some());
        let mut aside = job.clone();
        aside.camera = aside.camera.orbited(0.1, 0.0);
        assert!(against.measured(&aside, &picture).is_none());
        against.found = Some(found(picture.version + 1));
        assert!(against.measured(&job, &picture).is_none());
    }

    #[test]
    fn a_reference_is_whole_when_every_pixel_of_it_is_there() {
        let project = Project::default();
        let job = project.job(&Arc::new(procedural::torch())).unwrap();
        let mut reference = Reference {
            view: view_of(&job),
            known: Arc::new(vec![false; 15]),
            film: Arc::new(Film::new([5, 3])),
            pixels: 0,
            own: Error::default(),
            rendering: None,
            failed: false,
        };
        for (origin, size) in [([0, 0], [4, 3]), ([4, 0], [1, 3])] {
            assert!(!reference.is_whole());
            reference.take(&Tile {
                stride: 1,
                sample: 15,
                origin,
                size,
                pixels: vec![crate::render::Pixel::default(); (size[0] * size[1]) as usize],
                taken: Vec::new(),
            });
        }
        assert!(reference.is_whole() && reference.known.iter().all(|known| *known));
    }
}
