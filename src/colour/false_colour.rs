//! False colour: how bright each part of a picture is, in stops, whatever its own colour.
//!
//! ```text
//! v    = exposure · Y
//! stop = floor(log₂ v + 3),   0 for mid grey: v from 2⁻³ to 2⁻², whose middle is 2^(−2½) = 0.177
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | Y | luminance of the light, before adaptation and curve | W m⁻² sr⁻¹ |
//! | v | the same in shares of display white | 1 |
//!
//! Each stop from −6 to +7 has a colour: cold below mid grey, warm above, grey there alone, and lighter from each to the
//! next, so that a person who sees no hue reads the order all the same. Below 2⁻⁹ of display white, half a step of eight
//! bits, it counts as black. White begins at the first whole stop that the curve shows within 1/256 of white, at +8 at
//! the latest: plain clipping at display white, the others at 32 times that.
//!
//! **Validity.** Any light; none and less than none are black. Neighbours differ by 0.04 or more in Oklab for the normal
//! eye and for eyes that lack one receptor; black and white by 0.06 or more from everything else.
//!
//! **Source.** The palette is our own. That it is told apart is tested with the matrices of G. M. Machado, M. M. Oliveira
//! and L. A. F. Fernandes, IEEE Trans. Vis. Comput. Graph. 15 (2009) 1291.

/// The stop that begins where black ends.
const FIRST_STOP: i32 = -6;
/// log₂ of the light at which mid grey's stop begins.
const MID_GREY_FROM: i32 = -3;
/// log₂ of the light that counts as white at the latest.
const LATEST_WHITE: i32 = 5;
/// What is shown closer to 1 than this is white.
const NEARLY_WHITE: f64 = 1.0 / 256.0;

/// sRGB colours of the stops, from the first on: six cold ones, grey, and seven warm ones, each lighter than the one before.
pub const STOPS: [[u8; 3]; 14] = [
    [0x2d, 0x01, 0x4c],
    [0x31, 0x15, 0x68],
    [0x2d, 0x2c, 0x80],
    [0x21, 0x44, 0x8e],
    [0x1b, 0x5b, 0x92],
    [0x28, 0x6f, 0x94],
    [0x77, 0x77, 0x77],
    [0xd0, 0x62, 0x47],
    [0xdf, 0x78, 0x43],
    [0xec, 0x8f, 0x41],
    [0xf6, 0xa8, 0x44],
    [0xfd, 0xc1, 0x4e],
    [0xff, 0xdb, 0x6b],
    [0xff, 0xf4, 0x91],
];
/// sRGB colour of black.
pub const BLACK: [u8; 3] = [0x0f, 0x00, 0x1a];
/// sRGB colour of white.
const WHITE: [u8; 3] = [0xfe, 0x2f, 0xbc];

/// What a colour of the false picture stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Too dark for a display to show.
    Black,
    /// So many stops above mid grey.
    Stop(i32),
    /// As bright as the curve shows anything.
    White,
}

/// A range of light and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// What it stands for.
    pub level: Level,
    /// The light at which it begins, in shares of display white; it ends where the next one begins.
    pub from: f64,
    /// Its colour in sRGB.
    pub srgb: [u8; 3],
}

/// All bands, darkest first, for a curve that shows a light v ≥ 0 so.
pub(super) fn bands(shown: impl Fn(f64) -> f64) -> Vec<Band> {
    let is_white = |stop: &i32| shown(f64::from(*stop).exp2()) >= 1.0 - NEARLY_WHITE;
    let white = (0..LATEST_WHITE).find(is_white).unwrap_or(LATEST_WHITE);
    let band = |level, from, srgb| Band { level, from, srgb };
    let stops = STOPS.into_iter().zip(FIRST_STOP..).map(|(srgb, stop)| {
        let from = f64::from(stop + MID_GREY_FROM).exp2();
        band(Level::Stop(stop), from, srgb)
    });
    let white_from = f64::from(white).exp2();
    std::iter::once(band(Level::Black, 0.0, BLACK))
        .chain(stops.filter(|stop| stop.from < white_from))
        .chain([band(Level::White, white_from, WHITE)])
        .collect()
}

/// The colour of a light ≥ 0 among these bands.
pub(super) fn colour_of(light: f64, bands: &[Band]) -> [u8; 3] {
    let begun = bands.partition_point(|band| band.from <= light);
    bands[begun.max(1) - 1].srgb
}

#[cfg(test)]
mod tests {
    use super::*;
    use palette::{IntoColor, LinSrgb, Oklab, Srgb};

    /// How eyes without a receptor see linear light: nobody's loss, then long, middle and short.
    const EYES: [[[f32; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ],
    ];

    fn seen(srgb: [u8; 3], eye: [[f32; 3]; 3]) -> [f32; 3] {
        let [r, g, b] = srgb.map(|v| f32::from(v) / 255.0);
        let linear: LinSrgb = Srgb::new(r, g, b).into_linear();
        let light = [linear.red, linear.green, linear.blue];
        let [r, g, b] = eye.map(|row| {
            (0..3)
                .map(|i| row[i] * light[i])
                .sum::<f32>()
                .clamp(0.0, 1.0)
        });
        let lab: Oklab = LinSrgb::new(r, g, b).into_color();
        [lab.l, lab.a, lab.b]
    }

    fn apart(one: &Band, other: &Band, eye: [[f32; 3]; 3]) -> f32 {
        let (one, other) = (seen(one.srgb, eye), seen(other.srgb, eye));
        (0..3)
            .map(|i| (one[i] - other[i]).powi(2))
            .sum::<f32>()
            .sqrt()
    }

    fn all() -> Vec<Band> {
        bands(|_| 0.0)
    }

    #[test]
    fn every_stop_has_its_light_and_mid_grey_is_grey() {
        let bands = all();
        assert_eq!(bands.len(), STOPS.len() + 2);
        for stop in -6..=7 {
            let light = 0.5_f64.sqrt() * 2.0_f64.powi(stop - 2);
            let begun = bands.iter().rfind(|band| band.from <= light);
            let begun = begun.map(|band| (band.level, band.srgb));
            assert_eq!(
                begun,
                Some((Level::Stop(stop), colour_of(light, &bands))),
                "{stop}"
            );
        }
        let [r, g, b] = colour_of(0.18, &bands);
        assert!(r == g && g == b);
        assert_eq!(colour_of(0.0, &bands), BLACK);
        assert_eq!(colour_of(0.999 / 512.0, &bands), BLACK);
        assert_eq!(colour_of(1.0 / 512.0, &bands), STOPS[0]);
        assert_eq!(colour_of(31.99, &bands), STOPS[13]);
        assert_eq!(colour_of(32.0, &bands), WHITE);
        assert_eq!(colour_of(f64::INFINITY, &bands), WHITE);
    }

    #[test]
    fn white_begins_where_the_curve_shows_white() {
        let clipping = bands(|light| light.min(1.0));
        assert_eq!(colour_of(0.99, &clipping), STOPS[8]);
        assert_eq!(colour_of(1.0, &clipping), WHITE);
        let levels: Vec<_> = clipping.iter().map(|band| band.level).collect();
        assert_eq!(
            levels[levels.len() - 2..],
            [Level::Stop(2), Level::White],
            "what is white has no stops"
        );
    }

    #[test]
    fn stops_are_told_apart_by_every_eye_and_grow_lighter() {
        let bands = all();
        let stops = &bands[1..bands.len() - 1];
        for eye in EYES {
            for (i, stop) in stops.iter().enumerate() {
                for other in &stops[..i] {
                    assert!(apart(stop, other, eye) > 0.04, "{stop:?} {other:?}");
                }
                for mark in [&bands[0], &bands[bands.len() - 1]] {
                    assert!(apart(stop, mark, eye) > 0.06, "{stop:?} {mark:?}");
                }
            }
        }
        let lightness = |band: &Band| seen(band.srgb, EYES[0])[0];
        assert!(
            bands[..bands.len() - 1]
                .windows(2)
                .all(|pair| lightness(&pair[0]) + 0.04 < lightness(&pair[1]))
        );
    }
}
