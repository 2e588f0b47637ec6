//! Picture by picture to the disk.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::error::{FrameError, RangeError};
use super::kept::{is_there, mark};
use super::order::Order;
use super::reader::Reader;
use super::shots::Shot;
use crate::export::{ExportError, Still, Written, check_target};
use crate::render::clock::timed_on_pool;
use crate::render::{Cancel, Frame, Gate};
use crate::scene::Scene;
use crate::study::{self, Aim};

/// A frame that is done with.
#[derive(Debug)]
pub struct Ended {
    /// Its number.
    pub number: u64,
    /// Its picture.
    pub target: PathBuf,
    /// What became of it.
    pub outcome: Outcome,
}

/// What became of a frame.
#[derive(Debug)]
pub enum Outcome {
    /// Its picture was made.
    Written(Box<Made>),
    /// Its picture was there already, made from the same files with the same settings.
    Kept,
    /// It has no picture; the next frame's turn comes.
    Failed(FrameError),
}

/// A picture that was made, with all that was known on the way.
#[derive(Debug)]
pub struct Made {
    /// What was rendered and told.
    pub still: Still,
    /// What was seen.
    pub scene: Scene,
    /// What came of it.
    pub frame: Frame,
    /// With which numbers.
    pub aim: Aim,
    /// What was developed and told.
    pub written: Written,
    /// What it took.
    pub seconds: Seconds,
}

/// Wall-clock seconds of each step, and processor seconds of the rendering.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Seconds {
    /// Reading the files.
    pub load: f64,
    /// Packing the medium.
    pub bake: f64,
    /// Planning and rendering.
    pub render: f64,
    /// Developing, encoding and writing.
    pub write: f64,
    /// Processor time of planning and rendering.
    pub render_cpu: f64,
}

/// Writes the pictures, in the calling thread's rayon pool. A frame that is bad is told and passed over. `progress` hears the
/// finished share of the frame in hand, 0 to 1, from any thread; `ended` hears of each frame in turn.
///
/// # Errors
/// [`RangeError::Cancelled`]; [`RangeError::Write`] where a picture was made and could not be written.
pub fn write(
    order: &Order,
    gate: &Gate,
    cancel: &Cancel,
    progress: &(dyn Fn(f64) + Sync),
    ended: &mut (dyn FnMut(Ended) + Send),
) -> Result<(), RangeError> {
    let mut reader = Reader::new(cancel);
    for (shot, target) in order.shots.iter().zip(order.shots.targets(&order.output)) {
        gate.pass(cancel);
        if cancel.is_cancelled() {
            return Err(RangeError::Cancelled);
        }
        let number = shot.number;
        let outcome = match frame(order, shot, &target, &mut reader, (cancel, progress)) {
            Ok(outcome) => outcome,
            Err(Stop::Frame(_)) if cancel.is_cancelled() => return Err(RangeError::Cancelled),
            Err(Stop::Frame(error)) => Outcome::Failed(error),
            Err(Stop::Range(ExportError::Cancelled)) => return Err(RangeError::Cancelled),
            Err(Stop::Range(source)) => return Err(RangeError::Write { number, source }),
        };
        ended(Ended {
            number,
            target,
            outcome,
        });
    }
    Ok(())
}

/// What an error ends.
enum Stop {
    Frame(FrameError),
    Range(ExportError),
}

impl<E: Into<FrameError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Frame(error.into())
    }
}

fn frame(
    order: &Order,
    shot: &Shot,
    target: &Path,
    reader: &mut Reader<'_>,
    (cancel, progress): (&Cancel, &(dyn Fn(f64) + Sync)),
) -> Result<Outcome, Stop> {
    let picture = order.project.stage.backdrop_picture.iter();
    let sources: Vec<PathBuf> = shot.paths.iter().chain(picture).cloned().collect();
    check_target(target, &sources)?;
    let mark = mark(order, shot)?;
    if is_there(target, order.format, &mark) {
        return Ok(Outcome::Kept);
    }
    let begun = Instant::now();
    let mut still = reader.still(&order.project, shot)?.marked(mark);
    let load = begun.elapsed().as_secs_f64();
    still.job.flaws.extend(order.assumed.iter().cloned());

    let begun = Instant::now();
    let scene = reader.scene(&still);
    let bake = begun.elapsed().as_secs_f64();
    let ((aim, frame), took) = timed_on_pool(|| {
        let (settings, wished) = (&still.job.settings, still.job.accuracy);
        let aim = study::aim(&scene, still.plan(&scene), settings, wished, None, cancel);
        let frame = still.render_planned(&scene, &aim.plan, cancel, progress);
        (aim, frame)
    });
    let frame = frame.map_err(Stop::Range)?;
    let begun = Instant::now();
    let written = still.write(&frame, order.format, target, cancel);
    let written = written.map_err(Stop::Range)?;
    let seconds = Seconds {
        load,
        bake,
        render: took.wall_s,
        write: begun.elapsed().as_secs_f64(),
        render_cpu: took.cpu_s,
    };
    Ok(Outcome::Written(Box::new(Made {
        still,
        scene,
        frame,
        aim,
        written,
        seconds,
    })))
}
