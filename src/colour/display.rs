//! The baked view: one matrix and two tables that turn XYZ into what the screen is sent.
//!
//! A [`View`] is what a person chose. [`BakedView::new`] turns it once into numbers; [`BakedView::apply`] is all that is
//! done for a pixel. A shader reads the same numbers and takes the same steps, so there is one truth:
//!
//! ```text
//! 1  rgb = rgb_from_xyz · xyz; black if a channel is not finite
//! 2  bend = softness · max(rgb); c⁺ = (c + √(c² + bend²))/2 per channel; rgb = rgb⁺ · Y(rgb)/Y(rgb⁺); black if Y ≤ 0
//! 3  v = max(rgb); c = mix(rgb/v · y(v), y(rgb), per_channel); c = mix(c, y(v), w(v))
//! 4  sRGB encoding, by its formula
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | xyz | tristimulus values | W m⁻² sr⁻¹ |
//! | rgb, v | linear Rec. 709 light, 1 = display white | 1 |
//! | y, w | the tone curve and the path to white, see [`Curve`] | 1 |
//!
//! Step 3 with y channel by channel turns a bright orange to yellow, as film and sensors do; with y of the brightest
//! channel alone it would keep the hue to the end. A flame needs mostly the first. The mix with white then takes the
//! brightest part from yellow to white. The brightest channel is y(v) all along, so nothing is ever clipped, grey stays
//! grey, and every channel grows with exposure.
//!
//! **Tables.** y and w are stored at [`TABLE_LEN`] points, evenly over log₂ v from [`TABLE_FIRST_STOP`] to
//! [`TABLE_LAST_STOP`], and are linear between them; 32 points a stop make the error of y less than 1e-4 of itself. A
//! light below the first point is black, one above the last is shown as the last.
//!
//! **Adaptation** is von Kries with the white's brightness left out: the white keeps its Y whatever the degree, so
//! exposure alone decides how bright the picture is.

use glam::DVec3;

pub use super::curve::Curve;
use super::gamut;
use super::{adaptation, xyz};

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
}

/// A [`View`] as numbers, ready for pixels, on this side and in a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedView {
    /// Rows of the matrix from XYZ to linear Rec. 709, exposure and adaptation within.
    pub rgb_from_xyz: [[f32; 3]; 3],
    /// Weights of Y in linear Rec. 709, for step 2.
    pub luminance: [f32; 3],
    /// Softness ε of step 2.
    pub softness: f32,
    /// Table of y, [`TABLE_LEN`] points.
    pub curve: Vec<f32>,
    /// Table of w, [`TABLE_LEN`] points.
    pub whiteness: Vec<f32>,
    /// Share of the curve that is applied channel by channel.
    pub per_channel: f32,
}

impl BakedView {
    /// Bakes a view.
    pub fn new(view: &View) -> Self {
        debug_assert!(view.exposure > 0.0 && view.exposure.is_finite());
        let matrix = xyz::rgb_from_xyz() * adaptation_of(view) * view.exposure;
        Self {
            rgb_from_xyz: [0, 1, 2].map(|i| matrix.row(i).as_vec3().to_array()),
            luminance: gamut::LUMINANCE,
            softness: view.curve.softness() as f32,
            curve: table(|light| view.curve.shown(light)),
            whiteness: table(|light| view.curve.whiteness(light)),
            per_channel: view.curve.per_channel() as f32,
        }
    }

    /// The sRGB-encoded colour of a pixel, each channel 0..=1 and never NaN.
    pub fn apply(&self, xyz: [f32; 3]) -> [f32; 3] {
        self.linear(xyz).map(xyz::srgb_encode)
    }

    /// Steps 1 to 3: the linear Rec. 709 light that the display is to give, each channel 0..=1.
    pub fn linear(&self, xyz: [f32; 3]) -> [f32; 3] {
        // Expose and adapt. Half a colour would be a wrong colour, so one bad channel makes the pixel black.
        let rgb = self
            .rgb_from_xyz
            .map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2]);
        if !rgb.iter().all(|channel| channel.is_finite()) {
            return [0.0; 3];
        }

        // Fit into the triangle of the display.
        let rgb = gamut::without_negatives(rgb, self.softness);
        let brightest = rgb[0].max(rgb[1]).max(rgb[2]);
        if brightest <= 0.0 {
            return [0.0; 3];
        }

        // Shoulder: partly on each channel, partly on the brightest with the ratio of the channels kept; then the mix
        // with white.
        let shown = lookup(&self.curve, brightest);
        let whiteness = lookup(&self.whiteness, brightest);
        rgb.map(|channel| {
            let kept = channel / brightest * shown;
            let own = lookup(&self.curve, channel);
            let mixed = kept + (own - kept) * self.per_channel;
            mixed + (shown - mixed) * whiteness
        })
    }
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
fn table(of_light: impl Fn(f64) -> f64) -> Vec<f32> {
    (0..TABLE_LEN)
        .map(|point| {
            let stop = f64::from(TABLE_FIRST_STOP) + point as f64 / f64::from(POINTS_PER_STOP);
            of_light(stop.exp2()) as f32
        })
        .collect()
}

/// The value of a table at a light ≥ 0.
fn lookup(table: &[f32], light: f32) -> f32 {
    let position = (light.log2() - TABLE_FIRST_STOP) * POINTS_PER_STOP;
    if position < 0.0 {
        return 0.0;
    }
    let position = position.min((TABLE_LEN - 1) as f32);
    let left = (position as usize).min(TABLE_LEN - 2);
    let t = position - left as f32;
    table[left] * (1.0 - t) + table[left + 1] * t
}

#[cfg(test)]
mod tests;
