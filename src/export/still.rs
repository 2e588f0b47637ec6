//! A still, from a project and its open volume to the bytes on disk: the one road of command line and window.
//!
//! [`Still::new`] checks the settings, [`Still::scene`] packs the medium, [`Still::render`] marches the rays, and
//! [`Still::write`] develops, encodes and writes. The steps are apart so that a caller may put each on its clock.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{ExportError, Format, Provenance, check_writable, exr, is_same_file, png, write};
use crate::colour::display::BakedView;
use crate::project::ranges::{EXPOSURE_EV, HALF_SATURATION_CD_M2};
use crate::project::{Darkness, Job, Project, ProjectError};
use crate::render::develop::{Metering, flaws_of};
use crate::render::{Cancel, Effects, Flaws, Frame, Plan, Settings, render_planned};
use crate::scene::Scene;
use crate::volume::Volume;

/// A still of a project.
#[derive(Debug, Clone)]
pub struct Still {
    /// What is rendered.
    pub job: Job,
    /// What is told of it, so that the same picture comes of it again.
    pub project: Project,
    locked: Option<Metering>,
    /// A line that the scene file in the picture begins with, as a comment.
    mark: Option<String>,
}

/// What is told of a still that was written.
#[derive(Debug, Clone)]
pub struct Written {
    /// The brightness and the white that it was developed with, before what a person set.
    pub metering: Metering,
    /// Everything assumed or not faithful.
    pub flaws: Flaws,
}

/// Whether a picture could be written here, asked before the work that it is to hold. `sources` are the files that
/// it is made from: the volume's, and the backdrop's.
///
/// # Errors
/// [`ExportError`]: the path is one of the sources, or as [`check_writable`].
pub fn check_target(path: &Path, sources: &[PathBuf]) -> Result<(), ExportError> {
    if sources.iter().any(|source| is_same_file(path, source)) {
        return Err(ExportError::OwnVolume {
            path: path.to_owned(),
        });
    }
    check_writable(path)
}

impl Still {
    /// A still of the size, quality, camera and view that the project sets. Brightness and white are measured on the
    /// still itself, or are `locked` as a window holds them.
    ///
    /// # Errors
    /// [`ProjectError`] names the key, its value and what would be right.
    pub fn new(
        project: &Project,
        volume: &Arc<Volume>,
        locked: Option<Metering>,
    ) -> Result<Self, ProjectError> {
        Ok(Self {
            job: project.job(volume)?,
            project: project.clone(),
            locked,
            mark: None,
        })
    }

    /// With a line by which the picture is told again. The scene file in it begins with it, as a comment.
    #[must_use]
    pub fn marked(mut self, mark: String) -> Self {
        self.mark = Some(mark);
        self
    }

    /// With the effects that somebody has seen computed, none of which is left to be decided. What the still would decide
    /// in the same way stays automatic in what is told of it; the rest is told as it was seen, so that the same picture
    /// comes of it.
    #[must_use]
    pub fn showing(mut self, scene: &Scene, seen: Effects) -> Self {
        let settings = &mut self.job.settings;
        // How many wavelengths are enough is another matter for the numbers of a still.
        let wavelengths = settings.effects.wavelengths;
        let alone = Plan::new(scene, settings).decisions;
        let alone = settings.effects.as_decided(&alone);
        settings.effects = Effects {
            wavelengths,
            ..seen
        };
        let told = &mut self.project.effects;
        for (told, alone, seen) in [
            (&mut told.lines, alone.lines, seen.lines),
            (&mut told.bands, alone.bands, seen.bands),
            (
                &mut told.chemiluminescence,
                alone.chemiluminescence,
                seen.chemiluminescence,
            ),
            (&mut told.scattering, alone.scattering, seen.scattering),
            (
                &mut told.scattering_orders,
                alone.scattering_orders,
                seen.scattering_orders,
            ),
            (&mut told.refraction, alone.refraction, seen.refraction),
            (&mut told.dispersion, alone.dispersion, seen.dispersion),
            (&mut told.fire_light, alone.fire_light, seen.fire_light),
            (&mut told.smoke, alone.smoke, seen.smoke),
        ] {
            if alone != seen {
                *told = seen;
            }
        }
        self
    }

    /// Packs the medium and bakes the laws.
    pub fn scene(&self) -> Scene {
        self.scene_after(None)
    }

    /// [`Still::scene`], which takes over from `before` what is the same.
    pub fn scene_after(&self, before: Option<&Scene>) -> Scene {
        self.job.scene(before)
    }

    /// Renders in the calling thread's rayon pool. `progress` hears the finished share, 0 to 1, from any thread.
    ///
    /// # Errors
    /// [`ExportError::Cancelled`].
    pub fn render(
        &self,
        scene: &Scene,
        cancel: &Cancel,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Frame, ExportError> {
        self.render_planned(scene, &self.plan(scene), cancel, progress)
    }

    /// Decides which effects are computed.
    pub fn plan(&self, scene: &Scene) -> Plan {
        Plan::new(scene, &self.job.settings)
    }

    /// [`Still::render`] after its plan, which whoever made it may go on using.
    ///
    /// # Errors
    /// [`ExportError::Cancelled`].
    pub fn render_planned(
        &self,
        scene: &Scene,
        plan: &Plan,
        cancel: &Cancel,
        progress: &(dyn Fn(f64) + Sync),
    ) -> Result<Frame, ExportError> {
        let settings: &Settings = &self.job.settings;
        render_planned(scene, plan, settings, cancel, progress).ok_or(ExportError::Cancelled)
    }

    /// Develops, encodes and writes: the file is whole or not there.
    ///
    /// # Errors
    /// [`ExportError`]: the encoder or the system refused, or it was cancelled. Whatever stood at `path` before
    /// stands there still.
    pub fn write(
        &self,
        frame: &Frame,
        format: Format,
        path: &Path,
        cancel: &Cancel,
    ) -> Result<Written, ExportError> {
        let own = Metering::of(&frame.film);
        let metering = self.locked.unwrap_or(own);
        let mut flaws = self.job.flaws.clone();
        flaws.extend(frame.flaws.iter().map(String::from));
        flaws.extend(flaws_of(&frame.film).iter().map(String::from));
        if own.is_black() {
            flaws.add(Darkness::of(&self.job).words);
        }

        let mut provenance = Provenance::new(&self.portable(&own), &flaws);
        if let Some(mark) = &self.mark {
            provenance.scene = format!("# {mark}\n{}", provenance.scene);
        }
        let encoded = match format {
            Format::Png(bits) => {
                let view = BakedView::new(&metering.view(&self.project.view()));
                png::encode(&frame.film, &view, bits, &provenance, cancel)
            }
            Format::Exr => exr::encode(&frame.film, &provenance, cancel),
        };
        // A last chance: from here on the file appears.
        if cancel.is_cancelled() {
            return Err(ExportError::Cancelled);
        }
        write(path, &encoded?.bytes)?;
        Ok(Written { metering, flaws })
    }

    /// The project that the command line makes the same picture from. It measures the still itself, so a locked
    /// exposure becomes stops above what it will measure, as far as `view.exposure_ev` reaches. Those stops stand before
    /// the eye, so a half-saturation that is set rises with them. A white that is not set is measured anew: another size
    /// or quality may shift it a little.
    fn portable(&self, own: &Metering) -> Project {
        let mut project = self.project.clone();
        // What is set to become display white is told as it stands.
        let locked = self
            .locked
            .filter(|_| project.view.display_white_cd_m2.is_none());
        if let Some(locked) = locked {
            let [least, greatest] = EXPOSURE_EV;
            let stops = (locked.exposure / own.exposure).log2();
            let exposure_ev = project.view.exposure_ev + stops;
            if exposure_ev.is_finite() {
                project.view.exposure_ev = exposure_ev.clamp(least, greatest);
                let [least, greatest] = HALF_SATURATION_CD_M2;
                let half = project.view.half_saturation_cd_m2;
                project.view.half_saturation_cd_m2 =
                    half.map(|half| (half * stops.exp2()).clamp(least, greatest));
            }
        }
        project
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use std::fs;
    use std::sync::atomic::AtomicU64;

    use super::*;
    use crate::export::test_film;
    use crate::volume::procedural;

    /// A still of the built-in flame, with a frame that is not its own.
    fn still(exposure_ev: f64, locked: Option<f64>) -> (Still, Frame) {
        let mut project = Project::default();
        project.view.exposure_ev = exposure_ev;
        let locked = locked.map(|exposure| Metering {
            exposure,
            white_xyz: [1.0; 3],
            bright_y: 1.0,
        });
        let frame = Frame {
            film: test_film(),
            rays: 0,
            samples: 0,
            decisions: Vec::new(),
            facts: crate::render::Facts::default(),
            flaws: Flaws::default(),
            finished: true,
        };
        let still = Still::new(&project, &Arc::new(procedural::torch()), locked);
        (still.unwrap(), frame)
    }

    #[test]
    fn a_locked_exposure_becomes_stops_above_what_will_be_measured() {
        let own = Metering::of(&test_film());
        let stops = |exposure_ev, locked| {
            let (still, _) = still(exposure_ev, locked);
            still.portable(&own).view.exposure_ev
        };
        assert_eq!(stops(0.5, None), 0.5);
        assert!((stops(0.5, Some(8.0 * own.exposure)) - 3.5).abs() < 1e-9);
        assert!((stops(0.5, Some(own.exposure / 2.0)) + 0.5).abs() < 1e-9);
        assert_eq!(stops(0.0, Some(1e30 * own.exposure)), EXPOSURE_EV[1]);
        assert_eq!(stops(0.0, Some(1e-30 * own.exposure)), EXPOSURE_EV[0]);
    }

    #[test]
    fn a_half_saturation_that_is_set_gives_the_same_picture_under_what_will_be_measured() {
        let own = Metering::of(&test_film());
        let locked = Metering {
            exposure: 8.0 * own.exposure,
            ..own
        };
        let (mut still, _) = still(0.5, None);
        still.locked = Some(locked);
        for half in [None, Some(300.0)] {
            still.project.view.half_saturation_cd_m2 = half;
            let shown = locked.view(&still.project.view());
            let made_again = own.view(&still.portable(&own).view());
            assert!((made_again.exposure / shown.exposure - 1.0).abs() < 1e-12);
            let ratio = made_again.half_saturation / shown.half_saturation;
            assert!((ratio - 1.0).abs() < 1e-12, "{half:?}: {ratio}");
        }
    }

    #[test]
    fn a_cancelled_write_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        fs::write(&path, "before").unwrap();
        let (still, frame) = still(0.0, None);
        let cancelled = Cancel::when_passed(Arc::new(AtomicU64::new(1)), 0);
        for format in Format::ALL {
            let written = still.write(&frame, format, &path, &cancelled);
            assert!(matches!(written, Err(ExportError::Cancelled)), "{format:?}");
            assert_eq!(fs::read(&path).unwrap(), b"before");
        }
        // The encoders stop by themselves, too, before they are through.
        let provenance = Provenance::new(&still.project, &Flaws::default());
        let encoded = exr::encode(&frame.film, &provenance, &cancelled);
        assert!(matches!(encoded, Err(ExportError::Cancelled)));
        let view = BakedView::new(&Metering::of(&frame.film).view(&still.project.view()));
        let encoded = png::encode(
            &frame.film,
            &view,
            png::Bits::Eight,
            &provenance,
            &cancelled,
        );
        assert!(matches!(encoded, Err(ExportError::Cancelled)));
        let written = still.write(&frame, Format::Exr, &path, &Cancel::never());
        assert!(written.is_ok() && fs::metadata(&path).unwrap().len() > 100);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_picture_does_not_take_the_place_of_its_volume() {
        let folder = tempfile::tempdir().unwrap();
        let volume = folder.path().join("fire.png");
        fs::write(&volume, "x").unwrap();
        let by_another_name = folder.path().join(".").join("fire.png");
        let sources = [folder.path().join("other.vdb"), volume];
        let refused = check_target(&by_another_name, &sources);
        assert!(matches!(refused, Err(ExportError::OwnVolume { .. })));
        assert!(check_target(&folder.path().join("new.png"), &sources).is_ok());
    }
}
