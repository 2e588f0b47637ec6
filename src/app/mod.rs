//! The window: an [`eframe::App`] whose `logic()` takes in what the background brought and whose `ui()` draws.
//!
//! Panels change the [`Document`]; whatever else they want they ask for with a command. Once all panels had their
//! say, [`App`] compares the job that the document stands for with the one it submitted, and submits what differs:
//! the only place that does. Exposure, adaptation and curve are no part of a job; they only change the view.

mod accuracy;
mod autosave;
mod background;
mod canvas;
mod closing;
mod document;
mod exporter;
mod files;
mod frame;
mod hands;
mod history;
mod lost;
mod maps;
mod meter;
mod notify;
mod opening;
mod panels;
mod pictures;
mod plots;
mod recent;
mod region;
mod scene_file;
mod snapshots;
mod start;
mod theme;
mod thumbnails;
mod timeline;
mod words;

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

pub use canvas::{Display, Mapping};
pub use document::{Document, FieldRow};
pub use start::{AppError, run};

use self::accuracy::{Accuracy, Told};
use self::autosave::Autosave;
use self::canvas::Canvas;
use self::closing::Closing;
use self::exporter::Exporter;
use self::files::{Loader, Request};
use self::lost::Lost;
use self::maps::Maps;
use self::meter::Meter;
use self::panels::Panels;
use self::pictures::Submitted;
use self::plots::Plots;
use self::recent::Recent;
use self::region::RegionFrame;
use self::scene_file::SceneFile;
use self::snapshots::Snapshots;
use self::thumbnails::Thumbnails;
use self::timeline::Timeline;
use crate::colour::display::View;
use crate::engine::{Engine, Generation, Picture};
use crate::project::{Job, Project};
use crate::range;

/// While tiles come in, the picture is drawn this often: each drawing takes time from the workers where the
/// processor is also the graphics card.
const FRAME: Duration = Duration::from_millis(30);

/// The program's name to the desktop, and of its folder of data.
const APP_ID: &str = "sootlight";
/// Where in that folder a person's own presets lie.
const PRESETS: &str = "presets";
/// Where in that folder the pictures lie of what was opened before.
const THUMBNAILS: &str = "thumbnails";
/// Where in that folder it is kept what is open.
const SESSIONS: &str = "sessions";

/// The window.
pub struct App {
    document: Document,
    engine: Engine,
    picture: Picture,
    meter: Meter,
    accuracy: Accuracy,
    /// What is said of the picture's error.
    told: Option<Told>,
    maps: Maps,
    snapshots: Snapshots,
    region: RegionFrame,
    canvas: Canvas,
    /// Size of the canvas in pixels, once it was laid out.
    canvas_size: Option<[u32; 2]>,
    submitted: Option<Submitted>,
    loader: Loader,
    exporter: Exporter,
    timeline: Timeline,
    panels: Panels,
    plots: Plots,
    recent: Recent,
    thumbnails: Thumbnails,
    /// Which picture what is open was last pictured by.
    pictured: Option<Generation>,
    scene_file: SceneFile,
    autosave: Autosave,
    lost: Lost,
    /// Whether brightness and white are to be measured again, on the next picture.
    expose_anew: bool,
    /// What went wrong last, until it is dismissed.
    notice: Option<String>,
    /// Whether somebody wants to close the window while it exports, or with settings that are in no file.
    closing: Closing,
    title: String,
    ctx: egui::Context,
}

impl App {
    /// A window on a project; begins to load its volume. Without a graphics card (in a test) everything works but
    /// the picture is not drawn.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn new(creation: &eframe::CreationContext<'_>, project: Project) -> Result<Self, AppError> {
        let ctx = &creation.egui_ctx;
        theme::put_on(ctx, creation.storage);
        let tile_wake = ctx.clone();
        let tile_wake = Box::new(move || tile_wake.request_repaint_after(FRAME));
        let engine =
            Engine::new(Engine::threads_beside_a_window(), tile_wake).map_err(AppError::Threads)?;
        let export_wake = ctx.clone();
        let exporter = Exporter::new(Arc::new(move || export_wake.request_repaint()));
        let frame_wake = ctx.clone();
        let timeline = Timeline::new(Arc::new(move || frame_wake.request_repaint()));
        let study_wake = ctx.clone();
        let study_wake: background::Wake = Arc::new(move || study_wake.request_repaint());
        let map_wake = ctx.clone();
        let map_wake = Arc::new(move || map_wake.request_repaint_after(maps::ANEW));
        let load_wake = ctx.clone();
        let mut loader = Loader::new(Arc::new(move || load_wake.request_repaint()));
        let first = match project.volume.path.as_slice() {
            [] => Request::BuiltIn(project.volume.built_in),
            paths => Request::Project(paths.to_vec(), project.wanted()),
        };
        loader.begin(first, project.volume.limits());
        // What is remembered between windows stands beside it; a window that remembers nothing keeps nothing.
        let folder = creation.storage.and_then(|_| eframe::storage_dir(APP_ID));
        let mut panels = Panels::default();
        panels.presets.folder = folder.as_ref().map(|folder| folder.join(PRESETS));
        let recent = Recent::load(creation.storage);
        let pictures = folder.as_ref().map(|folder| folder.join(THUMBNAILS));
        let thumbnails = Thumbnails::load(ctx, pictures, &recent);
        let autosave = folder.map(|folder| Autosave::in_folder(&folder.join(SESSIONS), &project));
        let lost = Lost::default();
        let scene_file = SceneFile::new(&project);
        if let Some(state) = &creation.wgpu_render_state {
            lost.watch(&state.device, ctx);
        }
        Ok(Self {
            lost,
            autosave: autosave.unwrap_or_default(),
            document: Document::new(project),
            engine,
            picture: Picture::new([1, 1]),
            meter: Meter::default(),
            told: None,
            maps: Maps::new(map_wake),
            accuracy: Accuracy::new(study_wake),
            snapshots: Snapshots::new(ctx),
            region: RegionFrame::default(),
            canvas: Canvas::new(creation.wgpu_render_state.clone()),
            canvas_size: None,
            submitted: None,
            loader,
            exporter,
            timeline,
            panels,
            plots: Plots::default(),
            recent,
            thumbnails,
            pictured: None,
            scene_file,
            expose_anew: false,
            notice: None,
            closing: Closing::default(),
            title: String::new(),
            ctx: ctx.clone(),
        })
    }

    /// What is open and set.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// What is open and set, to be changed from outside.
    pub fn document_mut(&mut self) -> &mut Document {
        &mut self.document
    }

    /// The job that the document stands for: submitted, or about to be.
    pub fn job(&self) -> Option<&Job> {
        self.document.last_job()
    }

    /// Which submit that was.
    pub fn generation(&self) -> Option<Generation> {
        self.submitted
            .as_ref()
            .map(|submitted| submitted.generation)
    }

    /// How the picture is developed.
    pub fn view(&self) -> View {
        self.document.view()
    }

    /// The picture on show.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// Whether every pass of the document's job is on the picture, and nothing is being loaded.
    pub fn is_settled(&self) -> bool {
        let submitted = self.submitted.as_ref().map(|submitted| &submitted.job);
        self.loader.loading().is_none()
            && !self.timeline.waits()
            && submitted == self.document.last_job()
            && self.renders_newest()
            && self.picture.progress.finished
            && self
                .document
                .last_job()
                .is_none_or(|job| self.accuracy.is_settled(job))
    }

    /// Whether step, wavelengths and rays are chosen for the quality that is wished, as they are from the start. If not, those
    /// of a scene that nobody has looked at stay.
    pub fn choose_numbers(&mut self, chooses: bool) {
        self.accuracy.choose(chooses);
    }

    /// The number of the frame on show, if the open files are a frame of a sequence.
    pub fn frame(&self) -> Option<u64> {
        self.timeline.current()
    }

    /// Whether frames play.
    pub fn plays(&self) -> bool {
        self.timeline.plays()
    }

    /// What went wrong last, in words, unless it was dismissed.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// Keeps what is set in this folder from here on, as windows of the desktop do in their data folder, and offers what
    /// another window left there that did not end by itself.
    pub fn keep_in(&mut self, folder: &Path) {
        self.autosave = Autosave::in_folder(folder, &self.document.project);
    }

    /// Keeps a person's own presets in this folder from here on, as windows of the desktop do in their data folder.
    pub fn keep_presets_in(&mut self, folder: &Path) {
        self.panels.presets.folder = Some(folder.to_owned());
    }

    /// Moves the camera so that all of the flame is seen, from the side that it is seen from now.
    pub fn frame_all(&mut self) {
        self.document.frame_all();
    }

    /// What cannot be faithful in the picture on show, then what was assumed of the file, in words.
    fn flaws(&self) -> Vec<&str> {
        let assumed = self
            .document
            .last_job()
            .into_iter()
            .flat_map(|job| job.flaws.iter());
        let is_held = |job: &Job| range::is_held(&self.document.project, job);
        let is_held = self.document.last_job().is_some_and(is_held);
        let held = self.timeline.assumed().filter(|_| is_held);
        let own = self.picture.progress.flaws.iter();
        own.chain(assumed).chain(held).collect()
    }

    fn keep_what_is_set(&mut self, ctx: &egui::Context) {
        let project = &self.document.project;
        if let Some(wait) = self.autosave.follow(project, Instant::now()) {
            ctx.request_repaint_after(wait);
        }
        if let Some(words) = self.autosave.problem() {
            self.notice = Some(words);
        }
    }

    fn retitle(&mut self, ctx: &egui::Context) {
        let scene = self.scene_file.path().and_then(Path::file_name);
        let scene = scene.map(|name| format!("{} — ", name.to_string_lossy()));
        let unsaved = if self.is_unsaved() { " *" } else { "" };
        // A minimised window shows nothing else of an export.
        let exported = self.exporter.running().map(|(_, progress)| {
            let percent = (100.0 * progress.share).floor();
            format!("{percent:.0} % exported — ")
        });
        let title = format!(
            "{}Sootlight — {}{}{unsaved}",
            exported.unwrap_or_default(),
            scene.unwrap_or_default(),
            self.document.title()
        );
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}
