//! What to open, how that is done, and what came of it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::app::words::with_causes;
use crate::project::Project;
use crate::sequence::{Sequence, SequenceError};
use crate::volume::{self, BuiltIn, Limits, Volume, VolumeError, Wanted, Watch};

/// Share of a partner's load that opening it with the open volume takes: seldom must it be read again alone.
pub(super) const TOGETHER: f32 = 0.8;

/// What to open.
#[derive(Debug, Clone)]
pub(in crate::app) enum Request {
    /// A flame that needs no file: settings stay as they are.
    BuiltIn(BuiltIn),
    /// What the project names: settings stay as they are.
    Project(Vec<PathBuf>, Wanted),
    /// What a project that was kept names, to be shown with that project's settings.
    Session(Arc<Project>),
    /// A scene file: its volume, to be shown with its settings.
    Scene(PathBuf),
    /// These files as one volume, instead of what is open.
    Files(Vec<PathBuf>, Wanted),
    /// The open volume's files once more, with grids that were left unread.
    Lacking(Arc<Volume>, Wanted),
    /// A flame that needs no file, instead of what is open, burning as in a scene if one was chosen.
    OtherBuiltIn(BuiltIn, Option<Arc<Project>>),
    /// A file that may bring the missing field of the open volume, or else replaces it.
    Partner(Arc<Volume>, PathBuf),
}

/// What became of a request.
#[derive(Debug)]
pub(in crate::app) enum Outcome {
    /// A volume for the project as it stands.
    Shown(Arc<Volume>),
    /// A volume with the project that was kept of it.
    Restored(Arc<Volume>, Arc<Project>),
    /// The same from a scene file.
    Opened(Arc<Volume>, Arc<Project>, PathBuf),
    /// A volume that takes the place of the open one.
    Replaced(Arc<Volume>),
    /// One that does so and burns as in a scene.
    Burning(Arc<Volume>, Arc<Project>),
    /// The open volume with a field that it lacked.
    Completed {
        /// What was open when this was asked for.
        open: Arc<Volume>,
        /// Both together.
        both: Arc<Volume>,
    },
    /// The open volume with grids that were left unread.
    Filled {
        /// What was open when this was asked for.
        open: Arc<Volume>,
        /// The same files.
        volume: Arc<Volume>,
    },
    /// Nothing was opened, and why.
    Failed {
        /// What was asked for.
        request: Request,
        /// Why not, in words.
        words: String,
    },
    /// Somebody chose files in the dialog.
    Chosen(Vec<PathBuf>),
    /// The dialog never appeared.
    NoDialog,
}

impl Outcome {
    /// The volume that it brought.
    fn volume(&self) -> Option<&Arc<Volume>> {
        match self {
            Self::Shown(volume)
            | Self::Restored(volume, _)
            | Self::Opened(volume, ..)
            | Self::Replaced(volume)
            | Self::Burning(volume, _)
            | Self::Completed { both: volume, .. }
            | Self::Filled { volume, .. } => Some(volume),
            Self::Failed { .. } | Self::Chosen(_) | Self::NoDialog => None,
        }
    }
}

impl Request {
    pub(super) fn words(&self) -> String {
        let names = |paths: &[PathBuf]| {
            let name = |path: &PathBuf| path.display().to_string();
            paths.iter().map(name).collect::<Vec<_>>().join(", ")
        };
        match self {
            Self::BuiltIn(flame) | Self::OtherBuiltIn(flame, _) => {
                format!("the built-in {}", flame.name())
            }
            Self::Project(paths, _) | Self::Files(paths, _) => names(paths),
            Self::Session(project) if project.volume.path.is_empty() => {
                format!("the built-in {}", project.volume.built_in.name())
            }
            Self::Session(project) => names(&project.volume.path),
            Self::Lacking(open, _) => names(&open.sources),
            Self::Partner(_, path) | Self::Scene(path) => path.display().to_string(),
        }
    }
}

/// Does what is asked, and says what came of it.
pub(super) fn load(mut request: Request, limits: &Limits, watch: &Watch) -> Outcome {
    if let Request::Project(paths, _) | Request::Files(paths, _) = &mut request
        && let Err(error) = name_frame(paths)
    {
        let words = error.to_string();
        return Outcome::Failed { request, words };
    }
    let open = |paths, wanted| volume::open_wanted(paths, wanted, limits, watch);
    let outcome = match &request {
        Request::BuiltIn(flame) => flame
            .volume_watched(watch)
            .map(|v| Outcome::Shown(v.into())),
        Request::OtherBuiltIn(flame, None) => flame
            .volume_watched(watch)
            .map(|v| Outcome::Replaced(v.into())),
        Request::OtherBuiltIn(flame, Some(scene)) => flame
            .volume_watched(watch)
            .map(|v| Outcome::Burning(v.into(), Arc::clone(scene))),
        Request::Project(paths, wanted) => open(paths, wanted).map(|v| Outcome::Shown(v.into())),
        Request::Session(project) => {
            let volume = match project.volume.path.as_slice() {
                [] => project.volume.built_in.volume_watched(watch),
                paths => open(paths, &project.wanted()),
            };
            volume.map(|v| Outcome::Restored(v.into(), Arc::clone(project)))
        }
        Request::Scene(path) => return open_scene(path.clone(), watch),
        Request::Files(paths, wanted) => open(paths, wanted).map(|v| Outcome::Replaced(v.into())),
        Request::Lacking(before, wanted) => {
            open(&before.sources, wanted).map(|v| Outcome::Filled {
                open: Arc::clone(before),
                volume: v.into(),
            })
        }
        Request::Partner(open, path) => open_partner(open, path, limits, watch),
    };
    let outcome = outcome.unwrap_or_else(|error| Outcome::Failed {
        request,
        words: error.to_string(),
    });
    // What a camera frames takes a walk over all voxels: here, not where the window waits for it.
    for grid in outcome.volume().iter().flat_map(|volume| &volume.grids) {
        grid.bulk();
    }
    outcome
}

/// A scene file's volume under the limits that it sets.
fn open_scene(path: PathBuf, watch: &Watch) -> Outcome {
    let project = match Project::read(&path) {
        Ok(project) => Arc::new(project),
        Err(error) => {
            return Outcome::Failed {
                words: with_causes(&error),
                request: Request::Scene(path),
            };
        }
    };
    let limits = project.volume.limits();
    match load(Request::Session(project), &limits, watch) {
        Outcome::Restored(volume, project) => Outcome::Opened(volume, project, path),
        Outcome::Failed { words, .. } => Outcome::Failed {
            words: format!("{}: {words}", path.display()),
            request: Request::Scene(path),
        },
        other => other,
    }
}

/// Names the first frame of the only sequence in a folder in the place of that folder.
fn name_frame(paths: &mut Vec<PathBuf>) -> Result<(), SequenceError> {
    if let [folder] = paths.as_slice()
        && folder.is_dir()
    {
        let sequence = Sequence::of(folder)?;
        let [first, _] = sequence.ends();
        *paths = sequence.paths(first);
    }
    Ok(())
}

/// The open volume with the file's field; or the file alone, where it has the same field.
pub(super) fn open_partner(
    open: &Arc<Volume>,
    path: &Path,
    limits: &Limits,
    watch: &Watch,
) -> Result<Outcome, VolumeError> {
    match open.with_file_watched(path, limits, &watch.part(0.0, TOGETHER)) {
        Ok(both) => Ok(Outcome::Completed {
            open: Arc::clone(open),
            both: both.into(),
        }),
        Err(VolumeError::Cancelled) => Err(VolumeError::Cancelled),
        Err(together) => {
            let watch = watch.part(TOGETHER, 1.0);
            let paths = [path.to_owned()];
            let alone = volume::open_wanted(&paths, &open.read_for, limits, &watch)?;
            let partner = matches!(together, VolumeError::DimensionsDiffer { .. })
                && alone
                    .grids
                    .iter()
                    .all(|grid| open.grid(&grid.name).is_none());
            // A temperature of other dimensions was meant for this density, and cannot serve it.
            if partner {
                Err(together)
            } else {
                Ok(Outcome::Replaced(alone.into()))
            }
        }
    }
}
