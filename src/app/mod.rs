//! The window: an [`eframe::App`] whose `logic()` takes in what the background brought and whose `ui()` draws.
//!
//! Panels change the [`Document`]; whatever else they want they ask for with a command. Once all panels had their
//! say, [`App`] compares the job that the document stands for with the one it submitted, and submits what differs:
//! the only place that does. Exposure, adaptation and curve are no part of a job; they only change the view.

mod canvas;
mod document;
mod exporter;
mod files;
mod hands;
mod history;
mod meter;
mod panels;
mod recent;
mod start;
mod theme;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

pub use canvas::{Display, Mapping};
pub use document::{Document, FieldRow};
pub use start::{AppError, run};

use self::canvas::Canvas;
use self::exporter::Exporter;
use self::files::{Loader, Outcome, Request};
use self::meter::Meter;
use self::panels::Panels;
use self::recent::Recent;
use crate::colour::display::View;
use crate::engine::{Engine, Generation, Picture};
use crate::project::{CameraSettings, Job, Project, ProjectError, VolumeSettings};
use crate::volume::Volume;

/// While tiles come in, the picture is drawn this often: each drawing takes time from the workers where the
/// processor is also the graphics card.
const FRAME: Duration = Duration::from_millis(30);
/// While a file is read, how far it is is drawn this often.
const LOADING_FRAME: Duration = Duration::from_millis(100);

/// So long a changed job waits for the first picture of the one before it.
const LONGEST_WAIT: Duration = Duration::from_millis(250);

/// The window.
pub struct App {
    document: Document,
    engine: Engine,
    picture: Picture,
    meter: Meter,
    canvas: Canvas,
    /// Size of the canvas in pixels, once it was laid out.
    canvas_size: Option<[u32; 2]>,
    submitted: Option<Submitted>,
    loader: Loader,
    exporter: Exporter,
    panels: Panels,
    recent: Recent,
    /// What went wrong last, until it is dismissed.
    notice: Option<String>,
    /// Whether somebody wants to close the window while it exports.
    closing: Closing,
    title: String,
}

/// What becomes of a window that is to be closed while it exports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Closing {
    /// Nobody asked.
    #[default]
    No,
    /// It was asked for, and the answer is awaited.
    Asked,
    /// It closes once the export has ended.
    AfterExport,
    /// It closes, whatever runs.
    Now,
}

/// The job that the engine works on.
struct Submitted {
    job: Job,
    generation: Generation,
    at: Instant,
    /// When its first news came: the medium is packed then.
    begun: Option<Instant>,
}

impl Submitted {
    /// Whether the first picture of this job is about to come, so that another of the same volume waits for it. While
    /// the medium is packed nothing could begin anyway; after that the wait is bounded.
    fn is_worth_waiting_for(&self, next: &Job, picture: &Picture) -> bool {
        let progress = &picture.progress;
        let is_newest = picture.generation() == Some(self.generation);
        let came = is_newest && (progress.done > 0 || progress.failure.is_some());
        let long = self
            .begun
            .is_some_and(|begun| begun.elapsed() > LONGEST_WAIT);
        Arc::ptr_eq(&self.job.volume, &next.volume) && !came && !long
    }
}

impl App {
    /// A window on a project; begins to load its volume. Without a graphics card (in a test) everything works but
    /// the picture is not drawn.
    ///
    /// # Errors
    /// The system gives no threads.
    pub fn new(creation: &eframe::CreationContext<'_>, project: Project) -> Result<Self, AppError> {
        let ctx = &creation.egui_ctx;
        theme::put_on(ctx);
        let tile_wake = ctx.clone();
        let tile_wake = Box::new(move || tile_wake.request_repaint_after(FRAME));
        let engine =
            Engine::new(Engine::threads_beside_a_window(), tile_wake).map_err(AppError::Threads)?;
        let export_wake = ctx.clone();
        let exporter = Exporter::new(Arc::new(move || export_wake.request_repaint()));
        let load_wake = ctx.clone();
        let mut loader = Loader::new(Arc::new(move || load_wake.request_repaint()));
        loader.begin(match project.volume.path.as_slice() {
            [] => Request::BuiltIn,
            paths => Request::Project(paths.to_vec()),
        });
        Ok(Self {
            document: Document::new(project),
            engine,
            picture: Picture::new([1, 1]),
            meter: Meter::default(),
            canvas: Canvas::new(creation.wgpu_render_state.clone()),
            canvas_size: None,
            submitted: None,
            loader,
            exporter,
            panels: Panels::default(),
            recent: Recent::load(creation.storage),
            notice: None,
            closing: Closing::default(),
            title: String::new(),
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
            && submitted == self.document.last_job()
            && self.renders_newest()
            && self.picture.progress.finished
    }

    /// What went wrong last, in words, unless it was dismissed.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// Opens files as if they had been dropped on the window.
    pub fn open(&mut self, paths: Vec<PathBuf>) {
        let request = match (self.document.wants_a_partner(), paths.as_slice()) {
            (_, []) => return,
            (Some(open), [path]) => Request::Partner(Arc::clone(open), path.clone()),
            _ => Request::Files(paths),
        };
        self.notice = None;
        self.loader.begin(request);
    }

    /// Stops whatever is being loaded; what is open stays. Where nothing is open yet, the built-in flame is loaded.
    pub fn cancel_loading(&mut self) {
        if self.loader.loading().is_none() {
            return;
        }
        self.loader.cancel();
        if self.document.volume().is_none() {
            self.fall_back();
        }
    }

    /// Moves the camera so that all of the flame is seen, from the side that it is seen from now.
    pub fn frame_all(&mut self) {
        self.document.frame_all();
    }

    /// Whether the engine's news are about the job submitted last.
    fn renders_newest(&self) -> bool {
        self.generation().is_some() && self.picture.generation() == self.generation()
    }

    /// Whether the picture is of the open volume and of the job submitted last, however coarse.
    fn shows_newest(&self) -> bool {
        let of_the_open_volume = match (self.document.volume(), &self.submitted) {
            (Some(open), Some(submitted)) => Arc::ptr_eq(open, &submitted.job.volume),
            _ => false,
        };
        of_the_open_volume && self.renders_newest() && self.picture.progress.done > 0
    }

    /// What cannot be faithful in the picture on show, then what was assumed of the file, in words.
    fn flaws(&self) -> Vec<&str> {
        let assumed = self
            .document
            .last_job()
            .into_iter()
            .flat_map(|job| job.flaws.iter());
        self.picture.progress.flaws.iter().chain(assumed).collect()
    }

    /// Takes in what the engine rendered.
    fn drain(&mut self) {
        for update in self.engine.drain() {
            self.picture.take(update);
        }
        if self.renders_newest()
            && let Some(submitted) = &mut self.submitted
        {
            submitted.begun.get_or_insert_with(Instant::now);
        }
        let Some(submitted) = &self.submitted else {
            return;
        };
        if self.shows_newest() {
            let (flame, known) = (&submitted.job.flame, self.document.metering);
            if let Some(metering) = self.meter.follow(&self.picture, flame, known) {
                self.document.measured(metering);
            }
        }
    }

    /// Takes in what the loader read.
    fn receive(&mut self) {
        while let Some(outcome) = self.loader.poll() {
            match outcome {
                Outcome::Shown(volume) => self.show(volume, Document::open),
                Outcome::Replaced(volume) => self.show(volume, Document::replace),
                Outcome::Completed { open, both } => {
                    let now = self.document.volume();
                    let same = now.is_some_and(|now| Arc::ptr_eq(now, &open));
                    // Settings made for another volume do not suit these files.
                    let way = if same {
                        Document::complete
                    } else {
                        Document::replace
                    };
                    self.show(both, way);
                }
                Outcome::Failed { request, words } => {
                    self.refuse(&words, !matches!(request, Request::BuiltIn));
                }
                Outcome::Chosen(paths) => self.open(paths),
                Outcome::NoDialog => self.panels.file.no_dialog = true,
            }
        }
    }

    /// Shows a volume in one of the document's ways, or says why not.
    fn show(
        &mut self,
        volume: Arc<Volume>,
        way: fn(&mut Document, Arc<Volume>) -> Result<(), ProjectError>,
    ) {
        let name = |path: &PathBuf| path.display().to_string();
        let names = volume.sources.iter().map(name).collect::<Vec<_>>();
        match way(&mut self.document, volume) {
            Ok(()) => {
                self.loader.forget_older();
                self.panels.file.path.clear();
                self.exporter.dismiss();
                if let Some(volume) = self.document.volume() {
                    self.recent.add(&volume.sources);
                }
            }
            Err(error) => self.refuse(&format!("{}: {error}", names.join(", ")), true),
        }
    }

    /// Says why something was not opened. Where that would leave the window without anything, the built-in flame
    /// is shown, unless that is what failed.
    fn refuse(&mut self, words: &str, built_in_may_help: bool) {
        let empty = self.document.volume().is_none() && self.loader.loading().is_none();
        let mut end = "";
        if empty && built_in_may_help {
            self.fall_back();
            end = ". The built-in flame is shown instead";
        }
        self.notice = Some(format!("{words}{end}"));
    }

    /// Loads the built-in flame in place of what the project names.
    fn fall_back(&mut self) {
        // The settings were made for files that are not shown.
        self.document.project.volume = VolumeSettings::default();
        self.document.project.camera = CameraSettings::default();
        self.loader.begin(Request::BuiltIn);
    }

    /// Submits the document's job if it is another than the one submitted last.
    fn follow(&mut self) {
        let Some(size) = self.canvas_size else { return };
        let Some(job) = self.document.job(size) else {
            return;
        };
        match &mut self.submitted {
            // The same picture may be meant by other numbers, such as a humidity that nothing shows.
            Some(submitted) if submitted.job == *job => submitted.job = job.clone(),
            // A slider that moves faster than pictures come would starve them all.
            Some(submitted) if submitted.is_worth_waiting_for(job, &self.picture) => {}
            _ => {
                let generation = self.engine.submit(job.clone());
                self.submitted = Some(Submitted {
                    job: job.clone(),
                    generation,
                    at: Instant::now(),
                    begun: None,
                });
            }
        }
    }

    fn retitle(&mut self, ctx: &egui::Context) {
        let title = format!("Sootlight — {}", self.document.title());
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}

impl eframe::App for App {
    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.recent.save(storage);
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }

    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        self.receive();
        self.exporter.poll();
        self.drain();
        self.retitle(ctx);
        // A hidden window draws nothing, yet what was loaded begins to render.
        self.follow();
        if self.loader.loading().is_some() {
            ctx.request_repaint_after(LOADING_FRAME);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        self.guard_the_export(&ctx);
        self.take_drops(&ctx);
        let mut commands = self.take_keys(&ctx);

        // Panels change the document, and ask for what they cannot do themselves.
        let before = self.document.project.clone();
        panels::status(ui, self, &mut commands);
        let flaws: Vec<String> = self.flaws().into_iter().map(String::from).collect();
        self.panels
            .show(ui, &mut self.document, &self.recent, &flaws, &mut commands);

        // The picture has all the space that is left.
        let canvas = ui.available_rect_before_wrap();
        let view = self.view();
        let camera = self.document.last_job().map(|job| job.camera);
        let shown = self.canvas.show(ui, &self.picture, &view, camera);
        self.canvas_size = Some(shown.size);
        panels::overlay(ui, self, canvas, &mut commands);
        let size = self.document.fixed_size.unwrap_or(shown.size);
        self.panels
            .export
            .show(&ctx, &self.document, &self.exporter, size, &mut commands);

        if let Some(camera) = &shown.camera {
            self.document.move_camera(camera);
        }
        if shown.frame_all {
            self.frame_all();
        }
        self.document
            .remember(before, hands::is_held(&ctx) || shown.scrolling);
        self.obey(commands);
        self.follow();
    }
}
