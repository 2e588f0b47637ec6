//! The core: from a scene to a film. Headless, without global state, and without a clock but for what [`mod@costs`] tells.
//!
//! [`Settings`] say how accurate, [`Plan`] what is computed for this scene at these settings, [`pass`] in which
//! order, [`march`] how, [`film`] where it lands, [`develop`] how a film becomes a picture; [`probe`] looks at one
//! point alone, [`mod@costs`] measures what each effect takes. [`mod@null_collision`] is the slow, unbiased reference that the march is tested against.
//!
//! Everything here is deterministic: the same scene and settings give the same bits, whatever the number of
//! threads or the order of tiles, because a pixel's value depends on its own ray alone.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::scene::WavelengthSet;

pub mod along;
mod baked;
mod bend;
mod cells;
mod chord;
pub mod clock;
pub mod costs;
mod cover;
pub mod develop;
pub mod difference;
mod eikonal;
pub mod fields;
pub mod film;
mod gate;
pub mod glow;
mod growth;
mod irradiance;
mod kernel;
mod level;
pub mod levels;
mod lookup;
pub mod march;
pub mod null_collision;
mod orders;
mod own_light;
mod packets;
pub mod part;
pub mod pass;
pub mod plan;
pub mod preparation;
pub mod probe;
mod prompt;
mod scatter;
mod shift;
mod spans;
mod spread;
pub mod still;
mod subpixel;
mod sweep;
pub mod tables;
mod walk;
mod way;
pub mod white;

pub use film::{Film, Pixel, Tile};
pub use gate::Gate;
pub use level::Level;
pub use pass::{Audience, Pass, Region, render_mosaic, render_pass};
pub use plan::{Facts, Plan};
pub use probe::{Probe, Prober};
pub use still::{Frame, render_planned, render_still};

/// How accurate a picture is, in concrete numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Length of a step in voxels.
    pub step_voxels: f64,
    /// At which wavelengths light is transported.
    pub wavelengths: WavelengthSet,
    /// Rays for each pixel; 1 is the pixel's centre.
    pub samples_per_pixel: u32,
    /// Above 1: how often light may be scattered where scattering is computed, the orders after the first by path tracing
    /// and not by fields.
    pub scattering_orders: u32,
    /// Which effects are computed.
    pub effects: Effects,
}

/// Which effects are computed; what is not in the scene costs nothing either way. In a scene file `[effects]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Effects {
    /// Lines of a salt's atoms. Auto: where they can be seen.
    pub lines: Switch,
    /// Bands of a salt's molecules. Auto: where they can be seen.
    pub bands: Switch,
    /// Light of radicals in the reaction zone. Auto: unless soot outshines it.
    pub chemiluminescence: Switch,
    /// The fire's own light, scattered once by soot and smoke. Auto: where it can be seen.
    pub scattering: Switch,
    /// Light bent by hot gas. Auto: where something behind the fire shows it.
    pub refraction: Switch,
    /// Colours bent differently. Auto: never, for it is a fiftieth of the bending.
    pub dispersion: Switch,
    /// The fire as a light for the stage. Auto: where there is a stage.
    pub fire_light: Switch,
    /// Smoke beside the soot. Auto: where it can be seen.
    pub smoke: Switch,
    /// Light scattered more than once, by fields and without noise. Auto: where it can be seen.
    pub scattering_orders: Switch,
    /// More wavelengths than the settings say. Auto: where those are too few for the colours of the scene. A person sets
    /// their number instead.
    #[serde(skip)]
    pub wavelengths: Switch,
}

impl Effects {
    /// Each where it can be seen.
    pub const AUTO: Self = Self {
        lines: Switch::Auto,
        bands: Switch::Auto,
        chemiluminescence: Switch::Auto,
        scattering: Switch::Auto,
        refraction: Switch::Auto,
        dispersion: Switch::Auto,
        fire_light: Switch::Auto,
        smoke: Switch::Auto,
        scattering_orders: Switch::Auto,
        wavelengths: Switch::Auto,
    };
}

/// Whether an effect is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Switch {
    /// Where it can be seen.
    #[default]
    Auto,
    /// Always.
    On,
    /// Never.
    Off,
}

/// Why settings cannot be rendered with.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// A side is zero or too long.
    #[error(
        "the picture is {} × {} pixels: each side must be 1 to {MAX_SIDE}, and all together at most {} million",
        .0[0], .0[1], MAX_PIXELS / 1_000_000
    )]
    Size([u32; 2]),
    /// The step is not a number in its range.
    #[error("render.step_voxels is {0}: it must lie between {min} and {max}", min = STEP_RANGE[0], max = STEP_RANGE[1])]
    Step(f64),
    /// There is no such set.
    #[error("there is no set of {} wavelengths: choose 4, 6 or 8 (fitted), 16, 32 or 64 (plain)", .0.count())]
    Wavelengths(WavelengthSet),
    /// Too few or too many orders.
    #[error("render.scattering_orders is {0}: it must lie between 1 and {MAX_ORDERS}")]
    Orders(u32),
    /// Too few or too many rays.
    #[error("render.samples_per_pixel is {0}: it must lie between 1 and {MAX_SAMPLES}")]
    Samples(u32),
}

/// Longest side of a picture in pixels.
pub const MAX_SIDE: u32 = 16384;
/// Most pixels of a picture: 8192², a film of 1.6 GB and an export of about twice as much.
pub const MAX_PIXELS: u64 = 1 << 26;
/// Shortest and longest step in voxels. A step beyond the box is one step of its chord.
pub const STEP_RANGE: [f64; 2] = [0.01, 64.0];
/// Most orders of scattering: light that was scattered so often has lost its way, and nearly all of itself.
pub const MAX_ORDERS: u32 = 64;
/// Most rays for one pixel.
pub const MAX_SAMPLES: u32 = 4096;

impl Settings {
    /// The settings, if every number lies in its range.
    ///
    /// # Errors
    /// [`SettingsError`] names the first number that does not, its value and its range.
    pub fn validated(self) -> Result<Self, SettingsError> {
        let sides_fit = self.size.iter().all(|side| (1..=MAX_SIDE).contains(side));
        if !sides_fit || self.pixels() > MAX_PIXELS {
            return Err(SettingsError::Size(self.size));
        }
        if !(STEP_RANGE[0]..=STEP_RANGE[1]).contains(&self.step_voxels) {
            return Err(SettingsError::Step(self.step_voxels));
        }
        if !WavelengthSet::ALL.contains(&self.wavelengths) {
            return Err(SettingsError::Wavelengths(self.wavelengths));
        }
        if !(1..=MAX_SAMPLES).contains(&self.samples_per_pixel) {
            return Err(SettingsError::Samples(self.samples_per_pixel));
        }
        if !(1..=MAX_ORDERS).contains(&self.scattering_orders) {
            return Err(SettingsError::Orders(self.scattering_orders));
        }
        Ok(self)
    }

    /// Pixels of the picture.
    pub fn pixels(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// What could not be faithful in a frame, in words for a person. Sorted, each said once.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Flaws(BTreeSet<String>);

impl Flaws {
    /// Adds a flaw in words.
    pub fn add(&mut self, words: impl Into<String>) {
        self.0.insert(words.into());
    }

    /// Whether the frame is as faithful as it was asked to be.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The flaws in words.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.0.iter().map(String::as_str)
    }
}

impl Extend<String> for Flaws {
    fn extend<T: IntoIterator<Item = String>>(&mut self, words: T) {
        self.0.extend(words);
    }
}

/// Tells a render that nobody waits for it any more: a generation that has passed.
#[derive(Debug, Clone, Default)]
pub struct Cancel {
    current: Arc<AtomicU64>,
    mine: u64,
    until: Option<Instant>,
}

impl Cancel {
    /// A render that nothing cancels.
    pub fn never() -> Self {
        Self::default()
    }

    /// Cancelled as soon as `current` differs from `mine`.
    pub fn when_passed(current: Arc<AtomicU64>, mine: u64) -> Self {
        Self {
            current,
            mine,
            until: None,
        }
    }

    /// The same, cancelled as well once so much time has passed from now: for what is measured, never for a picture.
    #[must_use]
    pub fn or_after(&self, time: Duration) -> Self {
        Self {
            until: Instant::now().checked_add(time),
            ..self.clone()
        }
    }

    /// The same, cancelled as well from a moment on.
    #[must_use]
    pub fn or_at(&self, end: Instant) -> Self {
        Self {
            until: Some(self.until.map_or(end, |until| until.min(end))),
            ..self.clone()
        }
    }

    /// Whether to stop.
    pub fn is_cancelled(&self) -> bool {
        self.current.load(Ordering::Relaxed) != self.mine
            || self.until.is_some_and(|until| Instant::now() > until)
    }
}

#[cfg(test)]
mod tests;
