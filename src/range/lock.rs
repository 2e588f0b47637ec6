//! What is measured once for a range, and held over it.
//!
//! A few frames spread over the range are looked at. Fields are mapped by the highest peak among them, the camera frames the
//! fires of all of them, an effect that one of them calls for is computed for every frame. Of the brightest one, exposure
//! and white are measured, and step, wavelengths and rays are chosen: what is exact enough there is so elsewhere, and
//! nothing is exposed by a frame before the fire is lit.

use super::error::{FrameError, RangeError};
use super::hold::Taken;
use super::look::{METERED_SIDE, MOST, brightness, order_of, within};
use super::reader::Reader;
use super::shots::{Shot, Shots};
use crate::export::Still;
use crate::project::Project;
use crate::render::develop::Metering;
use crate::render::plan::Decision;
use crate::render::{Cancel, Plan, Settings, render_planned};
use crate::scene::Scene;
use crate::study::{self, Numbers};
use crate::volume::FieldKind;

/// A project whose every frame is made alike.
#[derive(Debug, Clone)]
pub struct Locked {
    /// With everything set that would differ from frame to frame, and the files of the brightest frame looked at.
    pub project: Project,
    /// Which frame exposure, white and numbers were measured on.
    pub measured_on: u64,
    /// What was assumed of the files where it is set now, in words.
    pub assumed: Vec<String>,
}

/// A frame that is looked at.
struct Look<'a> {
    shot: &'a Shot,
    taken: Taken,
    flaws: Vec<String>,
}

/// Finds what is to be held over these pictures, in the calling thread's rayon pool. `progress` hears the finished share,
/// 0 to 1.
///
/// # Errors
/// [`RangeError::NoFrame`] where no frame can be read, [`RangeError::Cancelled`].
pub fn lock(
    project: &Project,
    shots: &Shots,
    cancel: &Cancel,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Locked, RangeError> {
    let mut reader = Reader::new(cancel);
    let looks = look_at(project, shots, &mut reader, cancel)?;
    // Twice as many steps as frames, and two more.
    let all = (2 * looks.len() + 2) as f64;
    progress(looks.len() as f64 / all);

    let heat = |look: &Look<'_>| look.taken.peak(FieldKind::Temperature);
    let hottest = looks.iter().fold(&looks[0], |hottest, look| {
        if heat(look) > heat(hottest) {
            look
        } else {
            hottest
        }
    });
    let mut taken = hottest.taken.clone();
    for look in &looks {
        taken.join(&look.taken);
    }
    if shots.turns() {
        taken.turn_round();
    }
    let assumed = hottest.flaws.clone();
    let mut project = project.clone();
    taken.hold_all(&mut project);

    let mut brightest: Option<(f64, &Look<'_>)> = None;
    let mut decisions: Vec<Decision> = Vec::new();
    for (i, look) in looks.iter().enumerate() {
        let still = reader.still(&project, look.shot);
        if cancel.is_cancelled() {
            return Err(RangeError::Cancelled);
        }
        let Ok(still) = still else { continue };
        let scene = reader.scene(&still);
        let settings = &still.job.settings;
        join(&mut decisions, still.plan(&scene).decisions);
        let y = brightness(&scene, settings, cancel).ok_or(RangeError::Cancelled)?;
        if brightest.is_none_or(|(most, _)| y > most) {
            brightest = Some((y, look));
        }
        progress((looks.len() + i + 1) as f64 / all);
    }
    project.effects = project.effects.as_decided(&decisions);

    let (_, measured) = brightest.unwrap_or((0.0, hottest));
    let number = measured.shot.number;
    let failed = |source| RangeError::NoFrame { number, source };
    let still = reader.still(&project, measured.shot).map_err(failed)?;
    let scene = reader.scene(&still);
    let settings = choose(&mut project, &still, &scene, cancel);
    progress((all - 1.0) / all);
    let metering = meter(&scene, &settings, cancel).ok_or(RangeError::Cancelled)?;
    project.view.hold(&metering);
    project.volume.path.clone_from(&measured.shot.paths);
    progress(1.0);
    let told: Vec<&str> = still.job.flaws.iter().collect();
    // Views of one fire are one file's.
    let hottest_in = |words: String| {
        if shots.turns() {
            return words;
        }
        format!("{words} (in frame {}, and so in all)", hottest.shot.number)
    };
    Ok(Locked {
        project,
        measured_on: number,
        assumed: assumed
            .into_iter()
            .filter(|words| !told.contains(&words.as_str()))
            .map(hottest_in)
            .collect(),
    })
}

/// Looks at a few frames that can be read.
fn look_at<'a>(
    project: &Project,
    shots: &'a Shots,
    reader: &mut Reader<'_>,
    cancel: &Cancel,
) -> Result<Vec<Look<'a>>, RangeError> {
    let mut looks = Vec::new();
    let mut first_error = None;
    let order = order_of(shots.len());
    let all: Vec<&Shot> = shots.iter().collect();
    for (i, shot) in order.into_iter().map(|at| all[at]).enumerate() {
        if i >= MOST && !looks.is_empty() {
            break;
        }
        let volume = reader.volume(project, shot);
        if cancel.is_cancelled() {
            return Err(RangeError::Cancelled);
        }
        let looked = volume
            .map_err(FrameError::from)
            .and_then(|volume| Ok(project.job(&volume)?));
        match looked {
            Ok(job) => looks.push(Look {
                shot,
                taken: Taken::of(project, &job),
                flaws: job.flaws.iter().map(String::from).collect(),
            }),
            Err(source) => {
                let number = shot.number;
                first_error.get_or_insert(RangeError::NoFrame { number, source });
            }
        }
    }
    match first_error {
        Some(error) if looks.is_empty() => Err(error),
        _ => Ok(looks),
    }
}

/// What one frame calls for, the others are computed with as well.
fn join(decisions: &mut Vec<Decision>, others: Vec<Decision>) {
    for other in others {
        match decisions.iter_mut().find(|it| it.effect == other.effect) {
            Some(known) => known.on |= other.on,
            None => decisions.push(other),
        }
    }
}

/// Sets the numbers that are as exact as wished, and gives the settings with them.
fn choose(project: &mut Project, still: &Still, scene: &Scene, cancel: &Cancel) -> Settings {
    let (settings, wished) = (&still.job.settings, still.job.accuracy);
    let aim = study::aim(scene, still.plan(scene), settings, wished, None, cancel);
    let carried = Numbers::of(&aim.settings).carrying(aim.plan.wavelengths());
    let render = &mut project.render;
    render.step_voxels.get_or_insert(carried.step_voxels);
    render.wavelengths.get_or_insert(carried.wavelengths);
    render
        .samples_per_pixel
        .get_or_insert(carried.samples_per_pixel);
    aim.settings
}

fn meter(scene: &Scene, settings: &Settings, cancel: &Cancel) -> Option<Metering> {
    let settings = Settings {
        size: within(settings.size, METERED_SIDE),
        ..*settings
    };
    let plan = Plan::new(scene, &settings);
    let frame = render_planned(scene, &plan, &settings, cancel, &|_| {})?;
    Some(Metering::of(&frame.film))
}
