//! A quick look at what each number is worth in a scene: steps, wavelengths and rays, each tried by itself.
//!
//! Light that comes from all sides is the same in all of it but for the wavelengths, which are compared without it: what it
//! adds is as smooth as the rest, and working it out for every set would take longer than the picture.

use rayon::prelude::*;

use super::numbers::{Numbers, RAYS, REFERENCE};
use super::sight::{Error, Picture, Sight};
use super::tried::{self, Tried};
use crate::project::{Accuracy, Quality};
use crate::render::part::{LOOK_STEP_VOXELS, Part};
use crate::render::{Cancel, Plan, Settings};
use crate::scene::{Scene, WavelengthSet};

/// Most packets of sixteen pixels in the light.
const PACKETS: usize = 96;
/// Least of them, however long their rays are.
const LEAST_PACKETS: usize = 24;
/// Of a picture at most this share is looked at, unless that is too little to tell anything.
const MOST_OF_PICTURE: f64 = 0.02;
/// The set that others are compared with.
const FINEST_SET: WavelengthSet = WavelengthSet::Plain(64);

/// Work of a sample beside what each wavelength takes of it: finding it and fetching what is there.
const WORK_OF_SAMPLE: f64 = 10.0;
/// Work of a lit ray before its first sample.
const WORK_OF_RAY: f64 = 100.0;
/// Work of finding the way of a bent ray, for each voxel of the box's longest side.
const WORK_OF_BENDING: f64 = 170.0;

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
    /// Whether light from all sides is a part of the picture.
    needs_fields: bool,
    /// By how much more samples the whole picture takes than its part says, and seconds of processor time of each.
    more_samples: f64,
    cpu_s_of_sample: f64,
    /// Seconds of what a ray a pixel takes without its samples.
    cpu_s_of_rays: f64,
    /// Lit pixels of the whole picture, and the work of each of their rays beside its samples.
    lit: f64,
    work_of_ray: f64,
    /// Every choice of what was tried.
    table: Vec<Choice>,
}

/// A choice of numbers, with what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// The numbers.
    pub numbers: Numbers,
    /// The error that a picture with them has.
    pub error: Split,
    /// Seconds of processor time of its march.
    pub cpu_s: f64,
    /// What they cost in no unit: the same on every machine.
    pub work: f64,
}

impl Pilot {
    /// Looks at a scene in the calling thread's rayon pool. The `plan` is of these settings; its fields are worked out if
    /// nobody has asked for them. What is wished only decides with which wavelengths steps
    /// are tried.
    /// With it comes the plan that steps were tried with, if it was another. `None` if cancelled, or if there is nothing to be
    /// seen.
    pub fn new(
        scene: &Scene,
        plan: &Plan,
        settings: &Settings,
        wished: Accuracy,
        cancel: &Cancel,
    ) -> Option<(Self, Option<Plan>)> {
        let pixels = settings.pixels() as f64;
        let most = (MOST_OF_PICTURE * pixels / 16.0) as usize;
        let part = Part::lit(scene, plan, most.clamp(LEAST_PACKETS, PACKETS), cancel)?;
        let weights = part.weights();

        // Where light that was scattered or falls on a stage calls for more wavelengths than the fewest, a plan takes as many.
        let fewest = Settings {
            wavelengths: WavelengthSet::ALL[0],
            ..*settings
        };
        let least = if wished.wavelengths {
            Plan::after(scene, &fewest, &plan.decisions).wavelengths()
        } else {
            0
        };
        let mut sets = tried::sets(scene, plan, settings, least, &part, cancel)?;
        let finest = sets.iter().find(|it| it.what == FINEST_SET)?.xyz.clone();
        let sight = Sight::of(&finest, weights.clone());
        // Where only the stage is lit, direct light is none.
        let sight = sight.or_else(|| {
            let lit = part.render(scene, plan, tried::STEP, 1, cancel)?;
            Sight::of(&lit.xyz, weights)
        })?;
        tried::compare(&sight, &mut sets, &finest);
        let set = tried::set_for(&sets, plan, settings, wished);
        let settings = Settings {
            wavelengths: set,
            ..*settings
        };
        let is_another = plan.wavelengths() != set.count();
        let another = is_another.then(|| plan.at(scene, &settings).told_by(plan.preparation()));
        let plan = another.as_ref().unwrap_or(plan);

        let mut steps = tried::steps(scene, plan, settings.step_voxels, &part, cancel)?;
        let finest_step = steps.last()?.xyz.clone();
        tried::compare(&sight, &mut steps, &finest_step);

        let centre = steps.iter().find(|it| it.what == tried::STEP)?;
        let mut rays = tried::rays(scene, plan, centre, &part, cancel)?;
        let smoothest = rays.last()?.xyz.clone();
        tried::compare(&sight, &mut rays, &smoothest);

        // The shortest step with this set, and by how much more wavelengths and more rays change another picture.
        let here = &sets.iter().find(|it| it.what == set)?.xyz;
        let by_set = tried::times(here, &finest);
        let by_rays = tried::times(&centre.xyz, &smoothest);
        let changes = by_set.iter().zip(&by_rays);
        let pixels = finest_step.iter().zip(changes);
        let reference: Picture = pixels
            .map(|(xyz, (set, rays))| std::array::from_fn(|c| xyz[c] * set[c] * rays[c]))
            .collect();
        let own = tried::own_error(&sight, &steps, &sets, &rays);
        let lit = sight.lit_weight(&reference);
        let longest = scene.flame.medium().longest_side_voxels();
        let work_of_ray = WORK_OF_RAY
            + if plan.bends() {
                WORK_OF_BENDING * longest
            } else {
                0.0
            };
        let looked = steps.iter().find(|it| it.what == LOOK_STEP_VOXELS)?;
        // Where only what is behind the fire is seen, no sample is taken.
        let more_samples = if looked.samples > 0.0 {
            part.looked_samples()? / looked.samples
        } else {
            1.0
        };
        let (first, last) = (steps.first()?, steps.last()?);
        let cpu_s_of_sample = if last.samples > first.samples {
            (last.cpu_s - first.cpu_s) / (last.samples - first.samples)
        } else {
            0.0
        };
        let mut pilot = Self {
            table: Vec::new(),
            more_samples,
            cpu_s_of_sample,
            cpu_s_of_rays: (first.cpu_s - cpu_s_of_sample * first.samples).max(0.0),
            part,
            sight,
            reference,
            own,
            steps,
            sets,
            rays,
            set,
            features: plan.tables.features.len(),
            needs_fields: plan.gathers(),
            lit,
            work_of_ray,
        };
        let everything = pilot.choices(Accuracy::ALL, Numbers::of(&settings));
        pilot.table = everything
            .into_par_iter()
            .map(|numbers| pilot.choice(numbers))
            .collect();
        Some((pilot, another))
    }

    /// Share of the picture's pixels that was looked at.
    pub fn share(&self) -> f64 {
        self.part.share()
    }

    /// What the reference itself is off by, estimated from how it still changes.
    pub fn own_error(&self) -> Error {
        self.own
    }

    /// How different two colours, X, Y, Z in W m⁻² sr⁻¹, look to the eye that errors are told for, ΔE_ITP.
    pub fn apart(&self, one: [f64; 3], other: [f64; 3]) -> f64 {
        self.sight.apart(one, other)
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

    /// Processor's and wall-clock seconds that the march of the whole picture takes with these numbers: what each ray takes by
    /// itself, as the part has it, and what each sample takes, as many as the look has counted.
    pub fn seconds(&self, numbers: Numbers) -> [f64; 2] {
        let (step, set, _) = self.tried(numbers);
        let here = self.sets.iter().find(|it| it.what == self.set);
        let of_set = here.map_or(0.0, |here| (set.cpu_s - here.cpu_s) / set.samples.max(1.0));
        let more = self.cpu_s_of_sample * (self.more_samples - 1.0) * step.samples;
        let more = more + of_set * self.more_samples * step.samples;
        let cpu_s = f64::from(numbers.samples_per_pixel) * (step.cpu_s + more).max(0.0);
        [cpu_s, cpu_s * step.wall_s / step.cpu_s]
    }

    /// Seconds of processor time of the whole picture's march where a part of it, scaled, took so many with so many rays a
    /// pixel.
    pub(super) fn of_whole(&self, cpu_s: f64, rays: u32) -> f64 {
        let of_rays = f64::from(rays) * self.cpu_s_of_rays;
        if cpu_s <= of_rays {
            return cpu_s;
        }
        of_rays + self.more_samples * (cpu_s - of_rays)
    }

    /// What these numbers cost, in no unit: counted, so that it is the same on every machine.
    pub fn work(&self, numbers: Numbers) -> f64 {
        let (step, ..) = self.tried(numbers);
        let colours = numbers.wavelengths.count() as usize + self.features;
        let of_samples = self.more_samples * step.samples * (WORK_OF_SAMPLE + colours as f64);
        let of_ray = of_samples + self.lit * self.work_of_ray;
        f64::from(numbers.samples_per_pixel) * of_ray
    }

    /// Every choice of what was tried.
    pub fn table(&self) -> &[Choice] {
        &self.table
    }

    /// What is known of some numbers.
    pub fn choice(&self, numbers: Numbers) -> Choice {
        let known = self.table.iter().find(|it| it.numbers == numbers);
        known.copied().unwrap_or_else(|| Choice {
            numbers,
            error: self.error(numbers),
            cpu_s: self.seconds(numbers)[0],
            work: self.work(numbers),
        })
    }

    /// Every choice of the numbers that are free; the others are those given.
    pub fn choices(&self, free: Accuracy, given: Numbers) -> Vec<Numbers> {
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

    /// The cheapest numbers that are as accurate as wished; if there are none, the nearest to it. Depends on no clock.
    pub fn choose(&self, wished: Accuracy, given: Numbers) -> Numbers {
        self.choose_from(self.choices(wished, given), wished.target_de)
            .unwrap_or(given)
    }

    /// The same among those whose march takes at most so many seconds here and now; the quickest if none is so quick.
    pub fn choose_within(&self, wished: Accuracy, given: Numbers, wall_s: f64) -> Numbers {
        let mut all = self.choices(wished, given);
        // Light from all sides is worked out for one set, and would take its time for another.
        all.retain(|numbers| !self.needs_fields || numbers.wavelengths == self.set);
        let seconds = |numbers: &Numbers| self.seconds(*numbers)[1];
        let quickest = all
            .iter()
            .copied()
            .min_by(|one, other| seconds(one).total_cmp(&seconds(other)));
        all.retain(|numbers| seconds(numbers) <= wall_s);
        self.choose_from(all, wished.target_de)
            .or(quickest)
            .unwrap_or(given)
    }

    /// The numbers of a picture that others may be compared with, pixel by pixel: those of the highest quality. The reference's
    /// own take many times as long, and no eye tells the two apart.
    pub fn finest(&self) -> Numbers {
        let all = self.table.iter().map(|choice| choice.numbers).collect();
        self.choose_from(all, Quality::Reference.target_de())
            .unwrap_or(REFERENCE)
    }

    fn choose_from(&self, all: Vec<Numbers>, target_de: f64) -> Option<Numbers> {
        let all: Vec<Choice> = all.into_iter().map(|it| self.choice(it)).collect();
        let off = |choice: &Choice| choice.error.all.de95.max(target_de);
        // Light from all sides was worked out for one set, and would take longer for another than that saves in the march.
        let is_lost = |choice: &Choice| self.needs_fields && choice.numbers.wavelengths != self.set;
        let best = all.iter().min_by(|one, other| {
            let by_error = off(one).total_cmp(&off(other));
            let by_loss = is_lost(one).cmp(&is_lost(other));
            by_error.then(by_loss).then(one.work.total_cmp(&other.work))
        });
        best.map(|choice| choice.numbers)
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
