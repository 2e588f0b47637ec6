//! The whole road of a still, and why nothing comes of it.

use thiserror::Error;

use super::order::Order;
use crate::export::{ExportError, Still, check_target};
use crate::project::ProjectError;
use crate::range::RangeError;
use crate::render::preparation::Preparation;
use crate::render::{Cancel, Flaws, Level};
use crate::study;

/// Why nothing was written.
#[derive(Debug, Error)]
pub(super) enum NotExported {
    #[error(transparent)]
    Export(#[from] ExportError),
    #[error("this cannot be rendered as it is set: {0}")]
    Project(#[from] ProjectError),
    #[error("{0} is no file but a device or a pipe: choose another name")]
    NoFile(String),
    #[error(transparent)]
    Range(#[from] RangeError),
    #[error("the threads to export with cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// The whole road, on the exporter's thread. `begin` hears of the first ray.
pub(super) fn export(
    order: &Order,
    cancel: &Cancel,
    (preparation, begin): (&Preparation, &(dyn Fn() + Sync)),
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Flaws, NotExported> {
    // Writing to a pipe would wait for its reader, and the window for that.
    if std::fs::metadata(&order.path).is_ok_and(|about| !about.is_file() && !about.is_dir()) {
        return Err(NotExported::NoFile(order.path.display().to_string()));
    }
    let picture = order.project.stage.backdrop_picture.clone();
    let sources: Vec<_> = order
        .volume
        .sources
        .iter()
        .cloned()
        .chain(picture)
        .collect();
    check_target(&order.path, &sources)?;
    let mut still = Still::new(&order.project, &order.volume, order.metering)?;
    pool()?.install(|| {
        let scene = still.scene();
        if let Some(on_show) = order.effects {
            still = still.showing(&scene, on_show);
        }
        let plan = still.plan(&scene).told_by(preparation);
        let (settings, wished) = (still.job.settings, still.job.accuracy);
        let aim = study::aim(&scene, plan, &settings, wished, None, cancel);
        still.job.settings = aim.settings;
        if aim.plan.fields(&scene, Level::Fine, cancel).is_some() {
            begin();
        }
        let frame = still.render_planned(&scene, &aim.plan, cancel, progress)?;
        let written = still.write(&frame, order.format, &order.path, cancel)?;
        Ok(written.flaws)
    })
}

/// Threads to export with: half of the cores, for the window stays live.
pub(super) fn pool() -> Result<rayon::ThreadPool, rayon::ThreadPoolBuildError> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    rayon::ThreadPoolBuilder::new()
        .num_threads((cores / 2).max(1))
        .thread_name(|i| format!("sootlight-export-{i}"))
        .build()
}
