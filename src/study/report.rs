//! Every variant measured for itself, against one reference.
//!
//! The reference is the same part of the picture with the shortest step, 64 wavelengths and 28 rays a pixel, and with every
//! effect that the plan has found can be seen. What it is off by itself is estimated by the pilot, and no error is told below it.

use super::front::front;
use super::numbers::{Numbers, REFERENCE};
use super::pilot::{Choice, Pilot};
use super::sight::{Error, Sight};
use super::variant::{Family, Variant, variants};
use crate::project::{Accuracy, Job, Quality};
use crate::render::clock::{Took, timed_on_pool};
use crate::render::part::Part;
use crate::render::plan::Effect;
use crate::render::{Cancel, Level, Plan, Settings};
use crate::scene::{Interpolation, Scene};

/// Most packets of sixteen pixels in the light.
const PACKETS: usize = 56;
/// How often each variant is rendered, and how often if that takes its time.
const ROUNDS: usize = 3;
const FEW_ROUNDS: usize = 2;
/// Seconds of processor time of a part from which on it is rendered less often.
const LONG_S: f64 = 0.2;

/// How a variant went.
#[derive(Debug, Clone, PartialEq)]
pub enum Status {
    /// As it should.
    Measured,
    /// A picture came of it, but the plan has something against it, in words.
    Unstable(String),
    /// No picture came of it, in words.
    Failed(String),
}

/// A variant, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// What was rendered.
    pub variant: Variant,
    /// Seconds of the whole picture, planning and fields counted: of processor time, and by the wall clock.
    pub took: Took,
    /// The march alone of that.
    pub march: Took,
    /// By how much the wall clock's seconds differ from round to round: half of the range.
    pub spread_s: f64,
    /// How far it is from the reference.
    pub error: Error,
    /// Whether no other variant is both quicker and more exact.
    pub on_front: bool,
    /// How it went.
    pub status: Status,
}

/// What accuracy costs in one scene.
#[derive(Debug, Clone)]
pub struct Report {
    /// All that was measured.
    pub points: Vec<Point>,
    /// What the reference itself is off by.
    pub own: Error,
    /// What is chosen for each quality, the most exact last.
    pub qualities: Vec<(Quality, Numbers)>,
    /// Size of the picture in pixels.
    pub size: [u32; 2],
    /// Threads that it was measured with.
    pub threads: usize,
    /// Share of the pixels that was looked at.
    pub share: f64,
}

/// What all variants of a scene are measured with.
struct Bench<'a> {
    /// Plans of every set so far, and what their fields took.
    known: Vec<(Plan, Took)>,
    job: &'a Job,
    scene: &'a Scene,
    plan: &'a Plan,
    planning: Took,
    /// What it took to find out how light is bent, which all plans that bend it take over.
    bending: Took,
    settings: Settings,
    part: Part,
    pilot: Pilot,
    sight: Sight,
    reference: Vec<[f64; 3]>,
    cancel: &'a Cancel,
}

/// Measures a job's scene, in the calling thread's rayon pool. `progress` hears each point as it is known, and how many there
/// will be. `None` if cancelled, or if there is nothing to be seen.
pub fn report(
    job: &Job,
    scene: &Scene,
    cancel: &Cancel,
    progress: &mut dyn FnMut(&Point, usize),
) -> Option<Report> {
    let (plan, planning) = timed_on_pool(|| Plan::new(scene, &job.settings));
    let ((), bending) = timed_on_pool(|| plan.bend(scene));
    let settings = job.settings;
    let all = |quality: Quality| Accuracy {
        target_de: quality.target_de(),
        ..Accuracy::ALL
    };
    let given = Numbers::of(&settings);
    let (pilot, tried) = Pilot::new(scene, &plan, &settings, all(Quality::Final), cancel)?;
    let choose = |quality| {
        let numbers = pilot.choose(all(quality), given);
        let plan = Plan::after(scene, &numbers.within(&settings), &plan.decisions);
        (quality, numbers.carrying(plan.wavelengths()))
    };
    let qualities = Quality::ALL.map(choose).to_vec();
    drop(tried);

    let part = Part::lit(scene, &plan, PACKETS, cancel)?;
    let at = plan.at(scene, &REFERENCE.within(&settings));
    let rays = REFERENCE.samples_per_pixel;
    let reference = part.render(scene, &at, REFERENCE.step_voxels, rays, cancel)?;
    let mut bench = Bench {
        known: Vec::new(),
        job,
        scene,
        plan: &plan,
        planning,
        bending,
        settings,
        sight: Sight::of(&reference.xyz, part.weights())?,
        reference: reference.xyz,
        part,
        pilot,
        cancel,
    };
    let still = qualities[2].1;
    let effects = Effect::ALL.into_iter().filter(|&effect| {
        effect != Effect::Wavelengths && plan.switched(scene, &settings, effect).is_some()
    });
    let effects: Vec<Effect> = effects.collect();
    let chosen = bench.worth_measuring(&qualities);
    let variants = variants(still, job.flame.interpolation, &chosen, &effects);
    let count = variants.len();
    let mut points: Vec<Point> = Vec::with_capacity(count);
    for variant in variants {
        let point = bench.measure(variant)?;
        progress(&point, count);
        points.push(point);
    }
    mark_front(&mut points);
    Some(Report {
        own: bench.pilot.own_error(),
        points,
        qualities,
        size: settings.size,
        threads: rayon::current_num_threads(),
        share: bench.part.share(),
    })
}

/// Marks what no other variant is both quicker, by the clock as the chart has it, and more exact than. Other interpolations,
/// effects and RGB are other pictures: no choice between speed and accuracy.
pub(super) fn mark_front(points: &mut [Point]) {
    let places: Vec<[f64; 2]> = points
        .iter()
        .map(|point| match (&point.status, point.variant.family) {
            (
                Status::Measured,
                Family::Chosen | Family::Step | Family::Wavelengths | Family::Samples,
            ) => [point.took.wall_s, point.error.de95],
            _ => [f64::NAN; 2],
        })
        .collect();
    for (point, on_front) in points.iter_mut().zip(front(&places)) {
        point.on_front = on_front;
    }
}

impl Bench<'_> {
    /// The choices that are expected on the front, with those of the qualities, the least exact first.
    fn worth_measuring(&self, qualities: &[(Quality, Numbers)]) -> Vec<Numbers> {
        let all = self.pilot.table();
        let of = |choice: &Choice| [choice.cpu_s, choice.error.all.de95];
        let places: Vec<[f64; 2]> = all.iter().map(of).collect();
        let on_front = front(&places);
        let mut chosen: Vec<(f64, Numbers)> = Vec::new();
        for (choice, on_front) in all.iter().zip(on_front) {
            if on_front {
                chosen.push((choice.error.all.de95, choice.numbers));
            }
        }
        chosen.sort_by(|one, other| other.0.total_cmp(&one.0));
        // Of several that are nearly as good one is enough.
        let mut last = f64::INFINITY;
        chosen.retain(|(off, _)| {
            let is_better = *off < APART * last;
            if is_better {
                last = *off;
            }
            is_better
        });
        for (_, numbers) in qualities {
            if !chosen.iter().any(|(_, it)| it == numbers) {
                chosen.push((self.pilot.error(*numbers).all.de95, *numbers));
            }
        }
        chosen.sort_by(|one, other| other.0.total_cmp(&one.0));
        chosen.into_iter().map(|(_, numbers)| numbers).collect()
    }

    /// `None` if cancelled.
    fn measure(&mut self, variant: Variant) -> Option<Point> {
        let settings = variant.numbers.within(&self.settings);
        let another = self.another_scene(variant.interpolation);
        let (scene, basis) = match &another {
            Some(Ok((scene, plan))) => (scene, plan),
            Some(Err(words)) => return Some(Point::failed(variant, words.clone())),
            None => (self.scene, self.plan),
        };
        let mut plan = match (variant.family, variant.switched) {
            (Family::Baked, _) => basis.baked(scene, &settings),
            (_, Some(effect)) => {
                let at = basis.at(scene, &settings);
                at.switched(scene, &settings, effect)?
            }
            _ => basis.at(scene, &settings),
        };
        let is_usual =
            another.is_none() && variant.switched.is_none() && variant.family != Family::Baked;
        let mut known = self.known.iter();
        let known = known.find(|(it, _)| is_usual && it.wavelengths() == plan.wavelengths());
        if let Some((known, _)) = known {
            plan.take_over(known);
        }
        let known = known.map(|(_, took)| *took);
        // Of another scene it is worked out here, off the clock.
        plan.bend(scene);
        let bending = if plan.bends() {
            self.bending
        } else {
            Took::default()
        };
        let (fields, took) = timed_on_pool(|| plan.fields(scene, Level::Fine, self.cancel));
        fields?;
        let in_fields = known.unwrap_or(took);
        let numbers = variant.numbers;
        let rays = numbers.samples_per_pixel;
        let mut took: Vec<Took> = Vec::new();
        let mut xyz = Vec::new();
        let mut rounds = ROUNDS;
        while took.len() < rounds {
            let (part, step) = (&self.part, numbers.step_voxels);
            let (rendered, on_clock) =
                timed_on_pool(|| part.render(scene, &plan, step, rays, self.cancel));
            let rendered = rendered?;
            if on_clock.cpu_s > LONG_S {
                rounds = FEW_ROUNDS;
            }
            let cpu_s = self.pilot.of_whole(rendered.cpu_s, rays);
            took.push(Took {
                cpu_s,
                wall_s: cpu_s * rendered.wall_s / rendered.cpu_s.max(f64::MIN_POSITIVE),
            });
            xyz = rendered.xyz;
        }
        if xyz.iter().flatten().any(|value| !value.is_finite()) {
            return Some(Point::failed(variant, "pixels are no numbers".to_owned()));
        }
        let against = plan.flaws.iter();
        let against = against.filter(|flaw| !self.plan.flaws.iter().any(|it| it == *flaw));
        let against = against.map(str::to_owned).next();
        if is_usual && known.is_none() {
            self.known.push((plan, in_fields));
        }
        took.sort_by(|one, other| one.wall_s.total_cmp(&other.wall_s));
        let (quickest, slowest) = (took[0], took[took.len() - 1]);
        let march = took[took.len() / 2];
        let error = self.sight.error(&self.reference, &xyz);
        Some(Point {
            took: self.planning + bending + in_fields + march,
            march,
            spread_s: 0.5 * (slowest.wall_s - quickest.wall_s),
            error: error.at_least(self.pilot.own_error()),
            on_front: false,
            status: against.map_or(Status::Measured, Status::Unstable),
            variant,
        })
    }

    /// The scene packed for another interpolation, with the same effects; `None` where it is the scene's own.
    fn another_scene(&self, interpolation: Interpolation) -> Option<Result<(Scene, Plan), String>> {
        if interpolation == self.job.flame.interpolation {
            return None;
        }
        let mut job = self.job.clone();
        job.flame.interpolation = interpolation;
        if let Err(error) = job.flame.check(&job.volume) {
            return Some(Err(error.to_string()));
        }
        let scene = job.scene(Some(self.scene));
        let effects = self.settings.effects.as_decided(&self.plan.decisions);
        let settings = Settings {
            effects,
            ..self.settings
        };
        let plan = Plan::new(&scene, &settings);
        Some(Ok((scene, plan)))
    }
}

/// A choice is measured if its error is at most this share of the one before.
const APART: f64 = 0.8;

impl Point {
    fn failed(variant: Variant, words: String) -> Self {
        Self {
            variant,
            took: Took::default(),
            march: Took::default(),
            spread_s: 0.0,
            error: Error::default(),
            on_front: false,
            status: Status::Failed(words),
        }
    }
}
