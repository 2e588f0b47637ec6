//! What is set is kept on disk while a window is open, and offered by the next window if this one did not end by itself.
//!
//! Each window keeps a scene file of its own, beside a lock file that it holds locked for as long as it lives. A lock
//! that can be had therefore belongs to a window that is gone, however it ended, and what it kept can be restored. Until
//! that is done or declined the window that offers it holds the lock, so that two windows never offer the same.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::Document;
use crate::project::Project;
use crate::project::file::SceneFileError;

/// So long after the last change it is kept.
const QUIET: Duration = Duration::from_secs(2);
/// So long after the first change it is kept, even if changes go on.
const LONGEST: Duration = Duration::from_secs(10);
/// Endings of a scene file, and of its lock.
const SCENE: &str = "toml";
const LOCK: &str = "lock";

/// Keeps what is set, and knows what was left behind.
#[derive(Debug, Default)]
pub(super) struct Autosave {
    own: Option<Own>,
    /// What windows left that are gone, newest last.
    left: Vec<Left>,
}

/// What this window keeps.
#[derive(Debug)]
struct Own {
    folder: PathBuf,
    /// Its files, once something was kept.
    session: Option<Session>,
    /// What was seen last.
    seen: Project,
    /// When that had changed.
    changed: Instant,
    /// When the first change was made that is not kept.
    unkept: Option<Instant>,
    writing: Option<JoinHandle<Result<(), SceneFileError>>>,
    /// Why it could not be kept: told once.
    problem: Option<String>,
    told: bool,
}

/// A scene file and its lock, which is held.
#[derive(Debug)]
struct Session {
    scene: PathBuf,
    lock: PathBuf,
    _held: File,
}

#[derive(Debug)]
struct Left {
    session: Session,
    project: Project,
}

impl Autosave {
    /// Keeps what is set in a folder from here on, and looks there for what was left behind. `project` is what the window
    /// begins with: nothing is kept while that stands.
    pub(super) fn in_folder(folder: &Path, project: &Project) -> Self {
        let now = Instant::now();
        Self {
            own: Some(Own {
                folder: folder.to_owned(),
                session: None,
                seen: project.clone(),
                changed: now,
                unkept: None,
                writing: None,
                problem: None,
                told: false,
            }),
            left: left_in(folder),
        }
    }

    /// Looks at what is set, and keeps it some seconds after it was changed. Gives after which time to be called again at
    /// the latest, if something is not kept yet.
    pub(super) fn follow(&mut self, project: &Project, now: Instant) -> Option<Duration> {
        let own = self.own.as_mut()?;
        own.finish(false);
        if own.seen != *project {
            own.seen.clone_from(project);
            own.changed = now;
            own.unkept.get_or_insert(now);
        }
        let due = (own.changed + QUIET).min(own.unkept? + LONGEST);
        if now < due || own.writing.is_some() {
            return Some(due.saturating_duration_since(now).max(QUIET / 4));
        }
        own.unkept = None;
        own.begin_to_write();
        None
    }

    /// Why what is set cannot be kept, the first time that it cannot.
    pub(super) fn problem(&mut self) -> Option<String> {
        let own = self.own.as_mut()?;
        let problem = own.problem.take()?;
        (!std::mem::replace(&mut own.told, true)).then_some(problem)
    }

    /// What was open and set in a window that did not end by itself.
    pub(super) fn left(&self) -> Option<&Project> {
        self.left.last().map(|left| &left.project)
    }

    /// The same in words.
    pub(super) fn offer(&self) -> Option<String> {
        let title = Document::new(self.left()?.clone()).title();
        Some(format!(
            "A window was not closed by itself. What was open and set in it ({title}) was kept."
        ))
    }

    /// Takes away what was left: it is restored in this window, or nobody wants it.
    pub(super) fn forget(&mut self) {
        if let Some(left) = self.left.pop() {
            left.session.remove();
        }
    }

    /// Takes `project`, which is what was left, for this window's own before that is forgotten: at no moment is it only in
    /// memory.
    pub(super) fn take_over(&mut self, project: &Project) {
        if let Some(own) = &mut self.own {
            own.finish(true);
            own.seen.clone_from(project);
            own.unkept = None;
            own.begin_to_write();
            own.finish(true);
            if own.problem.is_some() {
                return;
            }
        }
        self.forget();
    }

    /// The window ends by itself: nothing of it needs to be kept.
    pub(super) fn end(&mut self) {
        if let Some(mut own) = self.own.take() {
            own.finish(true);
            own.unkept = None;
            if let Some(session) = own.session.take() {
                session.remove();
            }
        }
    }
}

impl Own {
    fn begin_to_write(&mut self) {
        if self.session.is_none() {
            match Session::new(&self.folder) {
                Ok(session) => self.session = Some(session),
                Err(error) => self.problem = Some(not_kept(&self.folder, &error)),
            }
        }
        let Some(session) = &self.session else { return };
        let (project, path) = (self.seen.clone(), session.scene.clone());
        // A disk may be slow, and the window does not wait for it.
        let spawned = std::thread::Builder::new()
            .name("sootlight-autosave".into())
            .spawn(move || project.write(&path));
        match spawned {
            Ok(thread) => self.writing = Some(thread),
            Err(error) => self.problem = Some(not_kept(&self.folder, &error)),
        }
    }

    /// Takes in what became of the last writing, if it has ended or is to be waited for.
    fn finish(&mut self, wait: bool) {
        let ended = self
            .writing
            .take_if(|thread| wait || thread.is_finished())
            .map(JoinHandle::join);
        if let Some(Ok(Err(error))) = ended {
            self.problem = Some(not_kept(&self.folder, &error));
        }
    }
}

impl Drop for Own {
    /// A window that ends by a panic keeps what it has not kept yet.
    fn drop(&mut self) {
        self.finish(true);
        if self.unkept.is_some() {
            self.begin_to_write();
            self.finish(true);
        }
    }
}

fn not_kept(folder: &Path, error: &dyn std::error::Error) -> String {
    let cause = error
        .source()
        .map_or(String::new(), |it| format!(" ({it})"));
    format!(
        "what is set cannot be kept for the case that the program ends unexpectedly: {error}{cause}. Make room in {}, or \
         allow writing there",
        folder.display()
    )
}

impl Session {
    /// Files of its own for this process in a folder, locked.
    fn new(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let process = std::process::id();
        // A number that is taken is that of a process that is gone, or of another window of this one.
        for number in 0..u32::MAX {
            let path = |ending: &str| folder.join(format!("{process}-{number}.{ending}"));
            match File::create_new(path(LOCK)) {
                Ok(file) if file.try_lock().is_ok() => {
                    return Ok(Self {
                        scene: path(SCENE),
                        lock: path(LOCK),
                        _held: file,
                    });
                }
                Ok(_) => {}
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::ErrorKind::AlreadyExists.into())
    }

    /// The files of a window that is gone. `None` while another window holds them.
    fn of_the_gone(lock: PathBuf) -> Option<Self> {
        let file = File::options().write(true).open(&lock).ok()?;
        file.try_lock().ok()?;
        Some(Self {
            scene: lock.with_extension(SCENE),
            lock,
            _held: file,
        })
    }

    /// Takes the files away, the scene first: a scene without a lock would never be found again.
    fn remove(self) {
        let _ = fs::remove_file(&self.scene);
        let _ = fs::remove_file(&self.lock);
    }
}

/// What windows that are gone left in a folder, newest last. What cannot be read stays where it is.
fn left_in(folder: &Path) -> Vec<Left> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let locks = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|ending| ending == LOCK));
    let mut left: Vec<Left> = locks
        .filter_map(Session::of_the_gone)
        .filter_map(|session| {
            let project = Project::read(&session.scene).ok()?;
            Some(Left { session, project })
        })
        .collect();
    left.sort_by_key(|left| {
        let about = fs::metadata(&left.session.scene);
        about.and_then(|about| about.modified()).ok()
    });
    left
}

#[cfg(test)]
mod tests;
