//! Whether what the plan leaves out can be left out: pictures with and without each effect, beside the bound that was given
//! for the difference.
//!
//! Eight scenes of the built-in flame are looked at in every run; all of them, with the shared volumes, by
//!
//! ```text
//! SOOTLIGHT_SHARED=… cargo test --release --test main -- --ignored --nocapture bounds_hold_in_all_scenes
//! ```
//!
//! With `SOOTLIGHT_SCENES=panfire` those alone whose name has it.

use std::sync::Arc;

use sootlight::project::Project;
use sootlight::render::difference::{Difference, difference};
use sootlight::render::plan::{Decision, Effect, OFF_BELOW, ON_ABOVE};
use sootlight::render::{Cancel, Effects, Frame, Plan, Settings, Switch, render_still};
use sootlight::volume::{self, BuiltIn, Limits, Volume, Wanted};

use super::common;

mod scenes;

use scenes::{Scene, eight, everything};

/// Effects that a person or the plan can switch.
const OPTIONAL: [Effect; 10] = [
    Effect::Smoke,
    Effect::Lines,
    Effect::Bands,
    Effect::Chemiluminescence,
    Effect::Scattering,
    Effect::ScatteringOrders,
    Effect::Refraction,
    Effect::Dispersion,
    Effect::FireLight,
    Effect::Wavelengths,
];
/// Change of a picture by an effect that is computed for nothing, ΔE_ITP.
const FOR_NOTHING: f64 = 0.01;

/// A scene that can be rendered in several ways.
struct Looked {
    volume: Arc<Volume>,
    sets: Vec<String>,
    is_near: bool,
}

impl Looked {
    fn at(scene: &Scene) -> Self {
        let volume = volume::open_or_built_in(
            &scene.files,
            BuiltIn::default(),
            &Wanted::default(),
            &Limits::default(),
        );
        Self {
            volume: Arc::new(volume.unwrap()),
            sets: scene.sets.clone(),
            is_near: scene.is_near,
        }
    }

    fn frame(&self, more: &[&str]) -> Frame {
        let mut project = Project::default();
        project.set("render.size=[64, 64]").unwrap();
        let sets = self.sets.iter().map(String::as_str);
        project.set_all(sets.chain(more.iter().copied())).unwrap();
        let mut job = project.job(&self.volume).unwrap();
        if self.is_near {
            let away = 0.6 * (job.camera.eye - job.camera.target);
            let up = 0.4 * away.length() * job.camera.up;
            job.camera.eye = job.camera.target + away + up;
        }
        render_still(&job.scene(None), &job.settings, &Cancel::never(), &|_| {}).unwrap()
    }
}

fn xyz(frame: &Frame) -> Vec<[f64; 3]> {
    let pixels = frame.film.pixels().iter();
    pixels.map(|pixel| pixel.xyz.map(f64::from)).collect()
}

fn decision(frame: &Frame, effect: Effect) -> &Decision {
    let found = frame.decisions.iter().find(|it| it.effect == effect);
    found.unwrap()
}

/// What an effect really changes in a scene: the picture as it is planned against the other way; `None` where there is no
/// other way.
fn change(looked: &Looked, planned: &Frame, effect: Effect) -> Option<Difference> {
    let decided = decision(planned, effect);
    let name = effect.name();
    let other = match effect {
        // The finest set there is.
        Effect::Wavelengths => "render.wavelengths=64".to_owned(),
        // On, it would be made up where nothing says what burns.
        Effect::Chemiluminescence if decided.bound == Some(0.0) => return None,
        _ if decided.on => format!("effects.{name}=off"),
        _ => format!("effects.{name}=on"),
    };
    let other = looked.frame(&[&other]);
    // Other effects stay as they were planned: what is scattered again goes with what is scattered.
    Some(if decided.on && effect != Effect::Wavelengths {
        difference(&xyz(planned), &xyz(&other))
    } else {
        difference(&xyz(&other), &xyz(planned))
    })
}

/// What was found of one effect in one scene.
struct Row {
    scene: String,
    effect: Effect,
    on: bool,
    bound: Option<f64>,
    change: Option<Difference>,
    reason: String,
}

impl Row {
    /// What is wrong with it, if anything is.
    fn fault(&self) -> Option<String> {
        let change = self.change?;
        let exceeds = self
            .bound
            .is_some_and(|bound| bound < EVERYTHING && change.p99 > bound.max(NOISE));
        let is_seen = !self.on && change.p99 > ON_ABOVE;
        (exceeds || is_seen).then(|| self.words())
    }

    fn words(&self) -> String {
        let Self { on, bound, .. } = self;
        let state = if *on { "on" } else { "off" };
        let bound = bound.map_or("?".to_owned(), |bound| format!("{bound:.4}"));
        let change = self.change.map_or("—".to_owned(), |change| {
            format!("mean {:.4}, 99 % {:.4}", change.mean, change.p99)
        });
        format!(
            "{}: {} {state}, at most {bound}, is {change} ({})",
            self.scene,
            self.effect.name(),
            self.reason
        )
    }
}

/// Bounds above this say that an effect may change everything: what is bright becomes dark, ΔE_ITP.
const EVERYTHING: f64 = 300.0;

/// Differences that f32 makes, ΔE_ITP: two pictures of one scene whose steps were numbered otherwise.
const NOISE: f64 = 0.002;

fn rows(scene: &Scene) -> Vec<Row> {
    let looked = Looked::at(scene);
    let planned = looked.frame(&[]);
    OPTIONAL
        .into_iter()
        .map(|effect| {
            let decided = decision(&planned, effect);
            Row {
                scene: scene.name(),
                effect,
                on: decided.on,
                bound: decided.bound,
                change: change(&looked, &planned, effect),
                reason: decided.reason.clone(),
            }
        })
        .collect()
}

#[test]
fn bounds_hold_in_eight_scenes() {
    for scene in eight() {
        for row in rows(&scene) {
            assert!(row.fault().is_none(), "{}", row.words());
        }
    }
}

#[test]
#[ignore = "renders some hundred pictures: ten minutes on two cores"]
fn bounds_hold_in_all_scenes() {
    let Some(shared) = common::shared() else {
        return;
    };
    let only = std::env::var("SOOTLIGHT_SCENES").unwrap_or_default();
    let mut scenes = everything(&shared.join("data"));
    scenes.retain(|scene| scene.name().contains(&only));
    let (mut faults, mut thrifty, mut idle) = (Vec::new(), 0, Vec::new());
    let (mut left_out, mut worst, mut could) = (0, 0.0_f64, 0);
    for scene in &scenes {
        let rows = rows(scene);
        let off = rows.iter().filter(|row| !row.on).count();
        thrifty += usize::from(2 * off >= OPTIONAL.len());
        // What no plan could leave out.
        let unseen = |row: &&Row| row.change.is_none_or(|change| change.p99 <= ON_ABOVE);
        could += usize::from(2 * rows.iter().filter(unseen).count() >= OPTIONAL.len());
        for row in &rows {
            println!("{}", row.words());
            faults.extend(row.fault());
            let change = row.change.map_or(0.0, |change| change.p99);
            if row.on && row.change.is_some() && change < FOR_NOTHING {
                idle.push(row.words());
            }
            if !row.on {
                left_out += 1;
                worst = worst.max(change);
            }
        }
    }
    println!(
        "{} scenes; half of the effects or more are left out in {thrifty}, and are too little to see in {could}; {left_out} effects left out change 99 % of a \
         picture by at most {worst:.3} ΔE; {} bounds do not hold; computed though they change less than {FOR_NOTHING} ΔE: {}",
        scenes.len(),
        faults.len(),
        idle.len()
    );
    for row in &idle {
        println!("  for nothing: {row}");
    }
    for row in &faults {
        println!("  wrong: {row}");
    }
    assert!(scenes.len() >= 40 || !only.is_empty());
    assert!(faults.is_empty(), "{faults:#?}");
}

fn planned(sets: &[&str], before: &[Decision]) -> (Plan, sootlight::scene::Scene, Settings) {
    let mut project = Project::default();
    project.set("render.size=[64, 64]").unwrap();
    project.set_all(sets.iter().copied()).unwrap();
    let job = project.job(&common::torch()).unwrap();
    let scene = job.scene(None);
    (
        Plan::after(&scene, &job.settings, before),
        scene,
        job.settings,
    )
}

fn of(plan: &Plan, effect: Effect) -> Decision {
    let found = plan.decisions.iter().find(|it| it.effect == effect);
    found.unwrap().clone()
}

#[test]
fn between_its_thresholds_an_effect_stays_as_it_was() {
    // A radius whose scattering lies between the two.
    let sets = |radius: f64| [format!("soot.radius_nm={radius}")];
    let bound = |radius: f64| {
        let sets = sets(radius);
        let (plan, ..) = planned(&[&sets[0]], &[]);
        of(&plan, Effect::Scattering).bound.unwrap()
    };
    let (mut low, mut high) = (5.0, 21.25);
    while !(OFF_BELOW..ON_ABOVE).contains(&bound(low)) {
        let middle = 0.5 * (low + high);
        if bound(middle) < 0.5 * (OFF_BELOW + ON_ABOVE) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let sets = sets(low);
    let with = |before: Option<bool>| {
        let (plan, ..) = planned(&[&sets[0]], &[]);
        let decided = of(&plan, Effect::Scattering);
        let before = before.map(|on| Decision { on, ..decided });
        let before: Vec<Decision> = before.into_iter().collect();
        let (plan, ..) = planned(&[&sets[0]], &before);
        of(&plan, Effect::Scattering).on
    };
    assert_eq!(
        [with(None), with(Some(true)), with(Some(false))],
        [true, true, false]
    );
}

#[test]
fn a_picture_hardly_moves_where_an_effect_comes_in() {
    // Soot radius through the place where scattering comes in, with nothing before.
    let is_on = |radius: f64| {
        let set = format!("soot.radius_nm={radius}");
        of(&planned(&[&set], &[]).0, Effect::Scattering).on
    };
    let (mut off, mut on) = (5.0, 40.0);
    assert!(!is_on(off) && is_on(on));
    while on - off > 1e-3 {
        let middle = 0.5 * (off + on);
        if is_on(middle) {
            on = middle;
        } else {
            off = middle;
        }
    }
    let pictures = [off, on].map(|radius| {
        let looked = Looked {
            volume: common::torch(),
            sets: vec![format!("soot.radius_nm={radius}")],
            is_near: false,
        };
        let frame = looked.frame(&[]);
        (xyz(&frame), decision(&frame, Effect::Scattering).on)
    });
    assert_eq!([pictures[0].1, pictures[1].1], [false, true]);
    let pop = difference(&pictures[1].0, &pictures[0].0);
    assert!(pop.p99 < ON_ABOVE, "{pop:?}");
}

#[test]
fn a_sequence_keeps_the_effects_of_its_first_frame() {
    let Some(shared) = common::shared() else {
        return;
    };
    let volumes: Vec<Arc<Volume>> = [1, 3, 6, 9, 12]
        .iter()
        .map(|frame| {
            let path = shared.join(format!("data/panfire_seq/panfire_{frame:04}.vdb"));
            Arc::new(volume::open(&[path], &Limits::default()).unwrap())
        })
        .collect();
    let plan = |volume: &Arc<Volume>, smoke: f64, effects: Option<Effects>| {
        let mut project = Project::default();
        project.set("render.size=[32, 32]").unwrap();
        project.smoke.amount = smoke;
        if let Some(effects) = effects {
            project.effects = effects;
        }
        let job = project.job(volume).unwrap();
        let plan = Plan::new(&job.scene(None), &job.settings);
        (plan, job.settings.effects)
    };
    // So little smoke at first that it is left out; then so much that a frame alone would show it.
    let (little, much) = (1e-7, 1.0);
    let (first, asked) = plan(&volumes[0], little, None);
    let locked = asked.as_decided(&first.decisions);
    assert!(
        Effect::ALL
            .iter()
            .all(|it| it.switch(&locked) != Switch::Auto || *it == Effect::Soot)
    );
    let states = |plan: &Plan| -> Vec<bool> { plan.decisions.iter().map(|it| it.on).collect() };
    let with_smoke = Effects {
        smoke: Switch::On,
        ..locked
    };
    let has_smoke = |plan: &Plan| {
        plan.decisions
            .iter()
            .any(|it| it.effect == Effect::Smoke && it.on)
    };
    for volume in &volumes {
        let (next, effects) = plan(volume, much, Some(locked));
        assert_eq!(effects, locked, "nothing is left to be decided");
        assert_eq!(states(&next), states(&first), "{:?}", volume.sources);
        assert!(has_smoke(&plan(volume, much, None).0));
        assert!(has_smoke(&plan(volume, little, Some(with_smoke)).0));
    }
}
