//! A quick look at what each number is worth in a scene: steps, wavelengths and rays, each tried by itself.
//!
//! Light that comes from all sides is the same in all of it but for the wavelengths, which are compared without it: what it
//! adds is as smooth as the rest, and working it out for every set would take longer than the picture.

use super::numbers::{Numbers, RAYS, STEPS};
use super::sight::{Error, Picture, Sight};
use crate::render::part::{Part, Rendered};
use crate::render::{Cancel, Film, Plan, Settings};
use crate::scene::{Scene, WavelengthSet};

/// Most packets of sixteen pixels in the light.
const PACKETS: usize = 96;
/// Least of them, however long their rays are.
const LEAST_PACKETS: usize = 24;
/// Of a picture at most this share is looked at, unless that is too little to tell anything.
const MOST_OF_PICTURE: f64 = 0.02;
/// Step at which wavelengths and rays are tried, voxels.
const STEP: f64 = 1.0;
/// The set that others are compared with.
const FINEST_SET: WavelengthSet = WavelengthSet::Plain(64);
/// Share of the target that wavelengths may take for the set to be the one that steps are tried with.
const SHARE_OF_SET: f64 = 0.5;

/// Work of a sample beside what each wavelength takes of it: finding it and fetching what is there.
const WORK_OF_SAMPLE: f64 = 10.0;
/// Work of a ray before its first sample, and of its pixel.
const WORK_OF_RAY: f64 = 100.0;

/// Which numbers are to be chosen; the others stand as they are set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Free {
    /// The step.
    pub step: bool,
    /// The wavelengths.
    pub wavelengths: bool,
    /// The rays of each pixel.
    pub rays: bool,
}

/// An error by its causes, 95th percentiles of ΔE_ITP.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Split {
    /// Of the step.
    pub step: f64,
    /// Of the wavelengths.
    pub wavelengths: f64,
    /// Of too few rays: edges that are not smooth.
    pub rays: f64,
    /// Of all together, never below the reference's own.
    pub all: Error,
}

/// What was found out about a scene.
#[derive(Debug, Clone)]
pub struct Pilot {
    part: Part,
    sight: Sight,
    reference: Picture,
    /// What the reference is off by.
    own: Error,
    steps: Vec<Tried<f64>>,
    sets: Vec<Tried<WavelengthSet>>,
    rays: Vec<Tried<u32>>,
    /// The set that steps and rays were tried with.
    set: WavelengthSet,
    features: usize,
    pixels: f64,
}

/// One number, tried.
#[derive(Debug, Clone)]
struct Tried<T> {
    what: T,
    xyz: Picture,
    /// How it looks different from the finest, pixel by pixel and in all.
    shift: Vec<[f64; 3]>,
    error: Error,
    /// Samples, processor's seconds and wall-clock seconds of one ray a pixel of the whole picture.
    samples: f64,
    cpu_s: f64,
    wall_s: f64,
}

impl Pilot {
    /// Looks at a scene in the calling thread's rayon pool. The `plan` is of these settings; its fields are worked out if
    /// nobody has asked for them. `target_de` is what is aimed at: it only decides with which wavelengths steps are tried.
    /// `None` if cancelled, or if there is nothing to be seen.
    pub fn new(
        scene: &Scene,
        plan: &Plan,
        settings: &Settings,
        target_de: f64,
        cancel: &Cancel,
    ) -> Option<Self> {
        let pixels = settings.pixels() as f64;
        let most = (MOST_OF_PICTURE * pixels / 16.0) as usize;
        let part = Part::lit(scene, plan, most.clamp(LEAST_PACKETS, PACKETS), cancel)?;
        let weights = part.weights();

        let mut sets = Vec::new();
        for set in WavelengthSet::ALL {
            let settings = Settings {
                wavelengths: set,
                ..*settings
            };
            let direct = plan.direct(scene, &settings);
            sets.push(Tried::new(
                set,
                part.render(scene, &direct, STEP, 1, cancel)?,
            ));
        }
        let finest = sets.iter().find(|it| it.what == FINEST_SET)?.xyz.clone();
        let sight = Sight::of(&finest, weights.clone());
        // Where only the stage is lit, direct light is none.
        let sight = sight.or_else(|| {
            let lit = part.render(scene, plan, STEP, 1, cancel)?;
            Sight::of(&lit.xyz, weights)
        })?;
        compare(&sight, &mut sets, &finest);
        let set = set_for(&sets, settings, target_de);
        let settings = Settings {
            wavelengths: set,
            ..*settings
        };
        let other;
        let plan = if plan.tables.wavelengths.len() == set.count() as usize {
            plan
        } else {
            other = plan.at(scene, &settings);
            &other
        };

        let mut steps = Vec::new();
        let mut all: Vec<f64> = STEPS.to_vec();
        if !all.contains(&settings.step_voxels) {
            all.push(settings.step_voxels);
            all.sort_by(|one, other| other.total_cmp(one));
        }
        for step in all {
            steps.push(Tried::new(step, part.render(scene, plan, step, 1, cancel)?));
        }
        let finest_step = steps.last()?.xyz.clone();
        compare(&sight, &mut steps, &finest_step);

        let centre = steps.iter().find(|it| it.what == STEP)?;
        let mut rays = vec![Tried {
            what: 1,
            ..centre.as_rays()
        }];
        for count in RAYS.into_iter().skip(1) {
            rays.push(Tried::new(
                count,
                part.render(scene, plan, STEP, count, cancel)?,
            ));
        }
        let smoothest = rays.last()?.xyz.clone();
        compare(&sight, &mut rays, &smoothest);

        // The shortest step with this set, and by how much more wavelengths and more rays change another picture.
        let here = &sets.iter().find(|it| it.what == set)?.xyz;
        let changed = |i: usize, c: usize| {
            let times = |more: f64, less: f64| {
                if less > 0.0 && more > 0.0 {
                    more / less
                } else {
                    1.0
                }
            };
            let by_set = times(finest[i][c], here[i][c]);
            let by_rays = times(smoothest[i][c], centre.xyz[i][c]);
            finest_step[i][c] * by_set * by_rays
        };
        let all = 0..finest.len();
        let reference = all
            .map(|i| std::array::from_fn(|c| changed(i, c)))
            .collect();
        let own = own_error(&sight, &steps, &sets, &rays);
        Some(Self {
            part,
            sight,
            reference,
            own,
            steps,
            sets,
            rays,
            set,
            features: plan.tables.features.len(),
            pixels,
        })
    }

    /// Share of the picture's pixels that was looked at.
    pub fn share(&self) -> f64 {
        self.part.share()
    }

    /// What the reference itself is off by, estimated from how it still changes.
    pub fn own_error(&self) -> Error {
        self.own
    }

    /// The error that a picture with these numbers has, by its causes.
    pub fn error(&self, numbers: Numbers) -> Split {
        let (step, set, rays) = self.tried(numbers);
        let lit = self.sight.lit(&[&self.reference, &step.xyz]);
        let shifts: [&[[f64; 3]]; 3] = [&step.shift, &set.shift, &rays.shift];
        let [de95, de_mean] = self.sight.delta_e(&lit, &shifts);
        let together = step.error.beside(set.error).beside(rays.error);
        Split {
            step: step.error.de95,
            wavelengths: set.error.de95,
            rays: rays.error.de95,
            all: Error {
                de95,
                de_mean,
                ..together
            }
            .at_least(self.own),
        }
    }

    /// How far a film of the whole picture is from the reference, measured where that is known. `None` if the film is of
    /// another size.
    pub fn measure(&self, film: &Film) -> Option<Error> {
        let pixels: Option<Picture> = self
            .part
            .places()
            .into_iter()
            .map(|[x, y]| film.pixel(x, y).map(|pixel| pixel.xyz.map(f64::from)))
            .collect();
        Some(
            self.sight
                .error(&self.reference, &pixels?)
                .at_least(self.own),
        )
    }

    /// Processor's and wall-clock seconds that the march of the whole picture takes with these numbers.
    pub fn seconds(&self, numbers: Numbers) -> [f64; 2] {
        let (step, set, _) = self.tried(numbers);
        let here = self.sets.iter().find(|it| it.what == self.set);
        let times = here.map_or(1.0, |here| set.cpu_s / here.cpu_s);
        [step.cpu_s, step.wall_s]
            .map(|of_ray| f64::from(numbers.samples_per_pixel) * times * of_ray)
    }

    /// What these numbers cost, in no unit: counted, so that it is the same on every machine.
    pub fn work(&self, numbers: Numbers) -> f64 {
        let (step, ..) = self.tried(numbers);
        let colours = numbers.wavelengths.count() as usize + self.features;
        let of_ray = step.samples * (WORK_OF_SAMPLE + colours as f64) + self.pixels * WORK_OF_RAY;
        f64::from(numbers.samples_per_pixel) * of_ray
    }

    /// Every choice of the numbers that are free; the others are those given.
    pub fn choices(&self, free: Free, given: Numbers) -> Vec<Numbers> {
        let steps: Vec<f64> = self
            .steps
            .iter()
            .map(|it| it.what)
            .filter(|step| free.step || *step == given.step_voxels)
            .collect();
        let sets = self
            .sets
            .iter()
            .map(|it| it.what)
            .filter(|set| free.wavelengths || *set == given.wavelengths);
        let rays: Vec<u32> = if free.rays {
            RAYS.to_vec()
        } else {
            vec![given.samples_per_pixel]
        };
        sets.flat_map(|wavelengths| {
            let rays = &rays;
            steps.iter().flat_map(move |&step_voxels| {
                rays.iter().map(move |&samples_per_pixel| Numbers {
                    step_voxels,
                    wavelengths,
                    samples_per_pixel,
                })
            })
        })
        .collect()
    }

    /// The cheapest numbers whose error is at most so much; if there are none, the nearest to it. Depends on no clock.
    pub fn choose(&self, target_de: f64, free: Free, given: Numbers) -> Numbers {
        let mut all = self.choices(free, given);
        all.sort_by(|one, other| self.work(*one).total_cmp(&self.work(*other)));
        let mut nearest = (f64::INFINITY, given);
        for numbers in all {
            let off = self.error(numbers).all.de95;
            if off <= target_de {
                return numbers;
            }
            if off < nearest.0 {
                nearest = (off, numbers);
            }
        }
        nearest.1
    }

    /// What was tried of these numbers, or the next longer step and fewer rays.
    fn tried(&self, numbers: Numbers) -> (&Tried<f64>, &Tried<WavelengthSet>, &Tried<u32>) {
        let step = self
            .steps
            .iter()
            .rev()
            .find(|it| it.what >= numbers.step_voxels);
        let set = self.sets.iter().find(|it| it.what == numbers.wavelengths);
        let rays = self
            .rays
            .iter()
            .rev()
            .find(|it| it.what <= numbers.samples_per_pixel);
        (
            step.unwrap_or(&self.steps[0]),
            set.unwrap_or(&self.sets[0]),
            rays.unwrap_or(&self.rays[0]),
        )
    }
}

impl<T> Tried<T> {
    fn new(what: T, rendered: Rendered) -> Self {
        Self {
            what,
            xyz: rendered.xyz,
            shift: Vec::new(),
            error: Error::default(),
            samples: rendered.samples,
            cpu_s: rendered.cpu_s,
            wall_s: rendered.wall_s,
        }
    }
}

impl Tried<f64> {
    fn as_rays(&self) -> Tried<u32> {
        Tried {
            what: 1,
            xyz: self.xyz.clone(),
            shift: Vec::new(),
            error: Error::default(),
            samples: self.samples,
            cpu_s: self.cpu_s,
            wall_s: self.wall_s,
        }
    }
}

/// Compares what was tried with the finest of it.
fn compare<T>(sight: &Sight, all: &mut [Tried<T>], finest: &[[f64; 3]]) {
    for tried in all {
        tried.shift = sight.shift(finest, &tried.xyz);
        tried.error = sight.error(finest, &tried.xyz);
    }
}

/// The smallest set whose error leaves enough of the target to others; the largest if none does.
fn set_for(sets: &[Tried<WavelengthSet>], settings: &Settings, target_de: f64) -> WavelengthSet {
    let good = sets
        .iter()
        .find(|it| it.error.de95 <= SHARE_OF_SET * target_de);
    good.map_or(settings.wavelengths, |it| it.what)
}

/// What the reference is off by: the midpoint rule's error falls to a quarter with half the step (L. F. Richardson 1911), that
/// of bands of wavelengths likewise with twice their number, and that of
/// evenly spread rays.
fn own_error(
    sight: &Sight,
    steps: &[Tried<f64>],
    sets: &[Tried<WavelengthSet>],
    rays: &[Tried<u32>],
) -> Error {
    fn last<T>(sight: &Sight, tried: &[Tried<T>], share: f64) -> Error {
        let [.., before, last] = tried else {
            return Error::default();
        };
        sight.error(&last.xyz, &before.xyz).scaled(share)
    }
    last(sight, steps, 1.0 / 3.0)
        .beside(last(sight, sets, 1.0 / 3.0))
        .beside(last(sight, rays, 1.0 / 3.0))
}
