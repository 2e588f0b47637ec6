//! The baked view: matrices and tables that turn XYZ into what the screen is sent.
//!
//! A [`View`] is what a person chose. [`BakedView::new`] turns it once into numbers; [`BakedView::apply`] is all that is
//! done for a pixel. A shader reads the same numbers and takes the same steps, so there is one truth:
//!
//! ```text
//! 1  rgb = rgb_from_xyz · xyz; black if a channel is not finite or Y ≤ 0
//! 2  the road of the curve:
//!    channels  rgb into the triangle, see [`super::gamut`]
//!              v = max(rgb); c = mix(rgb/v · y(v), y(rgb), per_channel); c = mix(c, y(v), w(v))
//!    hue       rgb into the triangle, at its hue
//!              m = max(rgb) or Y(rgb); paled at its hue by w(m), and until y(m) fits into the display; scaled to y(m)
//!    false     the colour of exposure · Y, see [`super::false_colour`]
//! 3  sRGB encoding, by its formula
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | xyz | tristimulus values | W m⁻² sr⁻¹ |
//! | rgb, v, m | linear Rec. 709 light, 1 = display white | 1 |
//! | y, w | the tone curve and the path to white, see [`Curve`] | 1 |
//! | paled | with less colour at the same hue, see `colour::hue` | 1 |
//!
//! y channel by channel turns a bright orange to yellow, as film and sensors do, and the mix with white takes the
//! brightest part from yellow to white. On the hue's road only the colourfulness changes. The brightest channel, or the
//! luminance for the eye, is y all along, so nothing is ever clipped, and grey stays grey.
//!
//! **Tables.** y and w are stored at [`TABLE_LEN`] points, evenly over log₂ v from [`TABLE_FIRST_STOP`] to
//! [`TABLE_LAST_STOP`], and are linear between them; 32 points a stop make the error of y less than 1e-4 of itself. A
//! light below the first point is black, one above the last is shown as the last. False colours are stored at the same
//! points: their edges are 1/32 of a stop wide.
//!
//! **Adaptation** is von Kries with the white's brightness left out: the white keeps its Y whatever the degree, so
//! exposure alone decides how bright the picture is.

use glam::DVec3;

pub use super::curve::{Curve, Road};
use super::false_colour::{self, Band};
pub use super::gamut::Paling;
pub use super::hue::HueSpace;
use super::{adaptation, gamut, xyz};

/// Points of each table.
pub const TABLE_LEN: usize = 1025;
/// log₂ of the light at the first point of a table.
pub const TABLE_FIRST_STOP: f32 = -16.0;
/// log₂ of the light at the last point of a table.
pub const TABLE_LAST_STOP: f32 = 16.0;
/// Points of a table per stop.
const POINTS_PER_STOP: f32 = (TABLE_LEN - 1) as f32 / (TABLE_LAST_STOP - TABLE_FIRST_STOP);

/// What a person chose about the look of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Multiplies XYZ, so that a Y of 1/exposure is display white. Precondition: positive and finite.
    pub exposure: f64,
    /// Degree of adaptation to `white_xyz`, 0..=1.
    pub adaptation: f64,
    /// Colour the eye adapts to; its brightness does not count. One that is no light (black, negative, not finite)
    /// leaves colours alone.
    pub white_xyz: [f64; 3],
    /// How light is brought into the range of the display.
    pub curve: Curve,
    /// The luminance that the eye's curve shows at half, 1 = display white. Precondition: positive and finite.
    pub half_saturation: f64,
    /// Whether each stop of luminance is shown in a colour of its own, in place of the picture.
    pub false_colour: bool,
}

/// A [`View`] as numbers, ready for pixels, on this side and in a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedView {
    /// Rows of the matrix from XYZ to linear Rec. 709, exposure and adaptation within.
    pub rgb_from_xyz: [[f32; 3]; 3],
    /// Weights of Y in linear Rec. 709.
    pub luminance: [f32; 3],
    /// Which of the steps are taken.
    pub road: Road,
    /// How a colour outside of the triangle is paled; `None`: not at all.
    pub paling: Option<Paling>,
    /// Softness ε of the way into the triangle, on the channels' road.
    pub softness: f32,
    /// Share of the curve that is applied channel by channel, on the channels' road.
    pub per_channel: f32,
    /// Where colours are paled.
    pub hue: HueSpace,
    /// Table of y, [`TABLE_LEN`] points.
    pub curve: Vec<f32>,
    /// Table of w, [`TABLE_LEN`] points.
    pub whiteness: Vec<f32>,
    /// What Y is multiplied by for its false colour.
    pub exposure: f32,
    /// Table of linear Rec. 709 false colours, [`TABLE_LEN`] points, on their road only.
    pub false_colour: Vec<[f32; 3]>,
}

impl View {
    /// The ranges of light that false colour tells apart, darkest first, whether or not it is on.
    pub fn bands(&self) -> Vec<Band> {
        false_colour::bands(|light| self.curve.shown(light, self.half_saturation))
    }
}

impl BakedView {
    /// Bakes a view.
    pub fn new(view: &View) -> Self {
        debug_assert!(view.exposure > 0.0 && view.exposure.is_finite());
        debug_assert!(view.half_saturation > 0.0 && view.half_saturation.is_finite());
        let matrix = xyz::rgb_from_xyz() * adaptation_of(view) * view.exposure;
        let curve = view.curve;
        Self {
            rgb_from_xyz: [0, 1, 2].map(|i| matrix.row(i).as_vec3().to_array()),
            luminance: xyz::LUMINANCE,
            road: if view.false_colour {
                Road::FalseColour
            } else {
                curve.road()
            },
            paling: curve.paling(),
            softness: curve.softness() as f32,
            per_channel: curve.per_channel() as f32,
            hue: HueSpace::new(),
            curve: table(|light| curve.shown(light, view.half_saturation) as f32),
            whiteness: table(|light| curve.whiteness(light) as f32),
            exposure: view.exposure as f32,
            false_colour: if view.false_colour {
                let bands = view.bands();
                let decode = |byte: u8| xyz::srgb_decode(f32::from(byte) / 255.0);
                table(|light| false_colour::colour_of(light, &bands).map(decode))
            } else {
                Vec::new()
            },
        }
    }

    /// The sRGB-encoded colour of a pixel, each channel 0..=1 and never NaN.
    pub fn apply(&self, xyz: [f32; 3]) -> [f32; 3] {
        self.linear(xyz).map(xyz::srgb_encode)
    }

    /// Steps 1 and 2: the linear Rec. 709 light that the display is to give, each channel 0..=1.
    pub fn linear(&self, xyz: [f32; 3]) -> [f32; 3] {
        // Expose and adapt. Half a colour would be a wrong colour, so one bad channel makes it no light.
        let rgb = self
            .rgb_from_xyz
            .map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]);
        let (rgb, y) = if rgb.iter().all(|channel| channel.is_finite()) {
            (rgb, xyz[1])
        } else {
            ([0.0; 3], 0.0)
        };
        match self.road {
            Road::Channels => self.by_channels(rgb),
            Road::HueOfBrightest => self.by_hue(rgb, brightest),
            Road::HueOfLuminance => self.by_hue(rgb, gamut::luminance),
            Road::FalseColour => self.by_stops(self.exposure * y),
        }
    }

    /// The curve partly on each channel, partly on the brightest with the ratio of the channels kept.
    fn by_channels(&self, rgb: [f32; 3]) -> [f32; 3] {
        // Fit into the triangle of the display.
        let near = match self.paling {
            Some(paling) => gamut::paled(rgb, paling, &self.hue),
            None => rgb,
        };
        let rgb = gamut::without_negatives(near, self.softness);
        let brightest = brightest(rgb);
        if brightest <= 0.0 {
            return [0.0; 3];
        }

        // Shoulder, then the mix with white.
        let shown = lookup(&self.curve, brightest);
        let whiteness = lookup(&self.whiteness, brightest);
        rgb.map(|channel| {
            let kept = channel / brightest * shown;
            let own = lookup(&self.curve, channel);
            let mixed = kept + (own - kept) * self.per_channel;
            mixed + (shown - mixed) * whiteness
        })
    }

    /// The curve on a measure of the brightness; the colour only becomes paler.
    fn by_hue(&self, rgb: [f32; 3], measure: fn([f32; 3]) -> f32) -> [f32; 3] {
        let seen = self
            .paling
            .and_then(|paling| Some((paling, gamut::nearer_grey(rgb, paling, &self.hue)?)));
        let Some((paling, (apart, kept))) = seen else {
            return [0.0; 3];
        };
        // Fit into the triangle of the display.
        let positive = |apart| self.hue.rgb(apart).map(|channel| channel.max(0.0));
        let fitted = apart.paled(kept);
        let inside = positive(fitted);
        let light = measure(inside) / gamut::luminance(inside) * gamut::luminance(rgb);

        // Shoulder and path to white; then what is still too bright for its colour.
        let shown = lookup(&self.curve, light);
        let pale = fitted.paled(1.0 - lookup(&self.whiteness, light));
        let pale = if self.road == Road::HueOfLuminance {
            pale.paled(pale.kept(self.hue.below_full(shown), 0.0, paling.start))
        } else {
            pale
        };
        let out = positive(pale);
        let scale = shown / measure(out);
        out.map(|channel| (channel * scale).min(1.0))
    }

    /// The colour of a light's stop.
    fn by_stops(&self, light: f32) -> [f32; 3] {
        let darkest = TABLE_FIRST_STOP.exp2();
        let (left, t) = place(light.max(darkest));
        let (a, b) = (self.false_colour[left], self.false_colour[left + 1]);
        [0, 1, 2].map(|i| a[i] * (1.0 - t) + b[i] * t)
    }
}

/// The largest channel.
fn brightest([r, g, b]: [f32; 3]) -> f32 {
    r.max(g).max(b)
}

/// Von Kries for a view, scaled so that the white keeps its Y.
fn adaptation_of(view: &View) -> glam::DMat3 {
    let white = DVec3::from_array(view.white_xyz);
    let scaled = white / white.y;
    if !(scaled.is_finite() && white.y > 0.0) {
        return glam::DMat3::IDENTITY;
    }
    let adapt = adaptation::von_kries(scaled.to_array(), view.adaptation);
    let seen_y = (adapt * scaled).y;
    if seen_y > 0.0 {
        adapt * (1.0 / seen_y)
    } else {
        glam::DMat3::IDENTITY
    }
}

/// A function of light, at the points of a table.
fn table<T>(of_light: impl Fn(f64) -> T) -> Vec<T> {
    (0..TABLE_LEN)
        .map(|point| {
            let stop = f64::from(TABLE_FIRST_STOP) + point as f64 / f64::from(POINTS_PER_STOP);
            of_light(stop.exp2())
        })
        .collect()
}

/// The value of a table at a light ≥ 0.
fn lookup(table: &[f32], light: f32) -> f32 {
    let stop = light.log2();
    if stop.is_nan() || stop < TABLE_FIRST_STOP {
        return 0.0;
    }
    let (left, t) = place(light);
    table[left] * (1.0 - t) + table[left + 1] * t
}

/// Between which points of a table a light lies, the left one and how far from it. Precondition: not below the first.
fn place(light: f32) -> (usize, f32) {
    let position = (light.log2() - TABLE_FIRST_STOP) * POINTS_PER_STOP;
    let position = position.min((TABLE_LEN - 1) as f32);
    let left = (position as usize).min(TABLE_LEN - 2);
    (left, position - left as f32)
}

#[cfg(test)]
mod hue_tests;
#[cfg(test)]
mod tests;
