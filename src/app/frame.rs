//! A frame of the window: what the background brought is taken in, then everything is drawn.

use std::time::Duration;

use super::canvas::{Beside, Over};
use super::closing::{Close, Closing};
use super::snapshots::Way;
use super::{App, canvas, hands, panels, plots, theme, timeline};
use crate::colour::display::View;

/// While a file is read, how far it is is drawn this often.
const LOADING_FRAME: Duration = Duration::from_millis(100);
/// While a picture is worked on, its time is drawn this often, whether or not tiles come: what has to be worked out before them
/// may take its time.
const WORKING_FRAME: Duration = Duration::from_millis(250);

impl App {
    /// Draws the picture over all the space that is left, with what lies over it.
    fn draw_picture(&mut self, ui: &mut egui::Ui, view: &View) -> canvas::Shown {
        let camera = self.document.last_job().map(|job| job.camera);
        let map = self.map(ui.ctx());
        let seen = self.snapshots.seen();
        let name = seen.map(|(snapshot, _)| snapshot.name());
        let beside = seen
            .zip(name.as_deref())
            .map(|((snapshot, share), name)| Beside {
                number: snapshot.number,
                name,
                film: &snapshot.film,
                strides: &snapshot.strides,
                view: &snapshot.view,
                share,
                has_line: self.snapshots.way() == Way::Wipe,
            });
        let over = Over {
            map,
            marks_clipped: self.plots.marks_clipped(view),
            beside,
        };
        let keys = !self.panels.export.is_open();
        let shown = self
            .canvas
            .show(ui, &self.picture, view, camera, &over, keys);
        self.region.show(ui, &shown.place);
        if let Some(share) = shown.wiped {
            self.snapshots.wipe_to(share);
        }
        shown
    }
}

impl eframe::App for App {
    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.recent.save(storage);
        theme::save(&self.ctx, storage);
        self.picture_what_is_open(true);
        self.thumbnails.save(&self.recent);
    }

    fn on_exit(&mut self) {
        // Without a device the window did not end by itself.
        if self.lost.words().is_none() {
            self.autosave.end();
        }
        self.lost.end();
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }

    fn logic(&mut self, ctx: &egui::Context, _: &mut eframe::Frame) {
        self.receive();
        self.read_what_is_lacking();
        if self.exporter.poll() {
            self.tell_ended(ctx);
        }
        self.receive_saved(ctx);
        if self.lost.words().is_some() && self.closing != Closing::Now {
            self.close(Close::AfterExport, ctx);
        }
        // A hidden window can be closed as well.
        self.guard_what_would_be_lost(ctx);
        self.drain();
        if let Some(wait) = self.play() {
            ctx.request_repaint_after(wait);
        }
        self.look();
        self.picture_what_is_open(false);
        self.retitle(ctx);
        // A hidden window draws nothing, yet what was loaded begins to render.
        self.follow();
        if self.loader.loading().is_some() {
            ctx.request_repaint_after(LOADING_FRAME);
        }
        self.keep_what_is_set(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        // Neither wakes the window while light from all sides is worked out.
        if self.is_working() || self.exporter.running().is_some() {
            ctx.request_repaint_after(WORKING_FRAME);
        }
        self.take_drops(&ctx);
        let mut commands = self.take_keys(&ctx);

        // Panels change the document, and ask for what they cannot do themselves.
        let before = self.document.project.clone();
        let carried = self.engine.scene();
        let carried = carried.map(|packed| packed.plan.wavelengths());
        self.document.carried = carried;
        let job = self.document.last_job();
        self.told = job.and_then(|job| self.accuracy.told(job, carried));
        self.tell_measured();
        panels::status(ui, self, &mut commands);
        let flaws: Vec<String> = self.flaws().into_iter().map(String::from).collect();
        self.panels.show(
            ui,
            &mut self.document,
            &panels::Beside {
                told: self.told.as_ref(),
                map: self.maps.shown(),
                region: &self.region,
                snapshots: &self.snapshots,
                recent: &self.recent,
                thumbnails: &self.thumbnails,
            },
            &flaws,
            &mut commands,
        );

        timeline::strip(ui, self, &mut commands);

        // The picture has all the space that is left.
        let canvas = ui.available_rect_before_wrap();
        let view = self.view();
        let shown = self.draw_picture(ui, &view);
        self.canvas_size = Some(shown.size);
        let job = self.document.last_job();
        if self.plots.shows_accuracy()
            && !self.engine.pauses()
            && let Some(job) = job
        {
            let is_done = self.picture.progress.finished;
            let packed = if is_done { self.engine.scene() } else { None };
            self.accuracy.measure(job, packed);
        }
        let about = plots::Shown {
            job,
            film: self.picture.film(),
            view: &view,
            accuracy: &self.accuracy,
            told: self.told.as_ref(),
        };
        self.plots
            .show(&ctx, &self.engine, &about, &shown.place, &mut commands);
        panels::overlay(ui, self, canvas, &mut commands);
        let size = self.document.fixed_size.unwrap_or(shown.size);
        let (saved, writes) = (self.scene_file.path(), self.scene_file.is_writing());
        self.panels.save.show(&ctx, saved, writes, &mut commands);
        panels::help::show(&ctx, &mut self.panels.shows_help);
        self.panels.export.show(
            &ctx,
            &self.document,
            (&self.exporter, &self.timeline),
            size,
            &mut commands,
        );

        if let Some(camera) = &shown.camera {
            self.document.move_camera(camera);
        }
        if shown.frame_all {
            self.frame_all();
        }
        self.document
            .remember(before, hands::is_held(&ctx) || shown.scrolling);
        self.obey(&ctx, commands);
        self.read_what_is_lacking();
        self.follow();
    }
}
