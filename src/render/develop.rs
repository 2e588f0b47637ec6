//! From a film to a picture: automatic exposure, and the only road to files and golden images.
//!
//! The window develops with the same [`BakedView`] in its shader; here it is applied on the processor.

use rayon::prelude::*;

use super::Flaws;
use super::film::{Film, Pixel};
use super::white::black_body_xyz;
use crate::colour::cie;
use crate::colour::display::{BakedView, Curve, View};

/// What a person sets of the view; exposure is relative to the automatic one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewParams {
    /// Stops above the automatic exposure, or above that of `display_white_cd_m2`.
    pub exposure_ev: f64,
    /// Luminance that becomes display white at 0 stops, cd m⁻², above 0; `None`: as it was measured.
    pub display_white_cd_m2: Option<f64>,
    /// Degree of von Kries adaptation to the white, 0 to 1.
    pub adaptation: f64,
    /// Temperature of the black body whose colour is the white, K; `None`: the fire's own white, as it was measured.
    pub white_k: Option<f64>,
    /// CIE 1931 x and y of the white, y above 0, where no temperature is set; `None`: as it was measured.
    pub white_xy: Option<[f64; 2]>,
    /// How light becomes display values.
    pub curve: Curve,
    /// Luminance to which the eye's curve responds half, cd m⁻²; `None`: follows the automatic exposure.
    pub half_saturation_cd_m2: Option<f64>,
    /// Whether luminance is shown in stops, each of a colour, in place of the picture.
    pub false_colour: bool,
}

/// What the automatic exposure saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metering {
    /// Multiplies XYZ so that a fire of ordinary contrast fills the display's range.
    pub exposure: f64,
    /// Colour of the hottest visible part: mean XYZ of the brightest pixels, W m⁻² sr⁻¹. Black for a black
    /// film.
    pub white_xyz: [f64; 3],
    /// Y of the 99.5th percentile of lit pixels, W m⁻² sr⁻¹; 0 for a black film.
    pub bright_y: f64,
}

/// Pixels darker than this share of the brightest are not lit.
const LIT: f32 = 1e-4;
/// The share of lit pixels that is darker than the bright ones.
const BRIGHT: f64 = 0.995;
/// Display-linear value of the 99.5th percentile of lit pixels: the body of a flame stays below white, its core
/// goes above and rolls off along the curve.
const BRIGHT_LEVEL: f64 = 4.0;

/// Half-saturation of the eye where none is set, in shares of what the automatic exposure makes display white: half
/// of the bright parts, which so respond by two thirds and keep room above them.
const AUTOMATIC_HALF: f64 = BRIGHT_LEVEL / 2.0;

/// Least luminance that the automatic exposure makes display white, cd m⁻²: where mesopic vision ends and colours are
/// no longer seen (CIE 191:2010). Soot at room temperature stays dark.
const DARKEST_WHITE_CD_M2: f64 = 0.005;

/// Whether light of this Y, W m⁻² sr⁻¹, can be seen at any exposure that is chosen automatically.
pub fn can_be_seen(y: f64) -> bool {
    !is_too_dark(y * brightest_exposure())
}

/// The highest automatic exposure.
fn brightest_exposure() -> f64 {
    cie::MAX_LUMINOUS_EFFICACY / DARKEST_WHITE_CD_M2
}

/// Whether a share of display white is seen by no one.
pub fn is_too_dark(share: f64) -> bool {
    share < BLACK
}

/// Share of display white below which a picture counts as black: half a step of 8 bits is seen by no one.
const BLACK: f64 = 1.0 / 512.0;

impl Metering {
    /// Whether the brightest parts stay below what a display shows at this exposure.
    pub fn is_black(&self) -> bool {
        is_too_dark(self.bright_y * self.exposure)
    }

    /// Meters a film. Non-finite pixels are left out.
    pub fn of(film: &Film) -> Self {
        let usable = |pixel: &&Pixel| pixel.xyz.iter().all(|v| v.is_finite());
        let peak = film
            .pixels()
            .iter()
            .filter(usable)
            .map(|pixel| pixel.xyz[1])
            .fold(0.0, f32::max);
        if peak <= 0.0 {
            return Self {
                exposure: 1.0,
                white_xyz: [0.0; 3],
                bright_y: 0.0,
            };
        }
        let mut lit: Vec<&Pixel> = film
            .pixels()
            .iter()
            .filter(usable)
            .filter(|pixel| pixel.xyz[1] > LIT * peak)
            .collect();
        let at = ((lit.len() as f64 * BRIGHT) as usize).min(lit.len() - 1);
        lit.select_nth_unstable_by(at, |a, b| a.xyz[1].total_cmp(&b.xyz[1]));
        let bright_y = f64::from(lit[at].xyz[1]);
        let brightest = &lit[at..];
        let mean = |c: usize| {
            brightest
                .iter()
                .map(|pixel| f64::from(pixel.xyz[c]))
                .sum::<f64>()
                / brightest.len() as f64
        };
        Self {
            exposure: (BRIGHT_LEVEL / bright_y).min(brightest_exposure()),
            white_xyz: [mean(0), mean(1), mean(2)],
            bright_y,
        }
    }

    /// This, with what is set of it in the place of what was measured.
    #[must_use]
    pub fn with_set(&self, params: &ViewParams) -> Self {
        let white_xyz = match (params.white_k, params.white_xy) {
            (Some(kelvin), _) => black_body_xyz(kelvin),
            // What is left to 1 is z; a white of pure red has none.
            (None, Some([x, y])) => [x, y, (1.0 - x - y).max(0.0)],
            (None, None) => self.white_xyz,
        };
        Self {
            exposure: params
                .display_white_cd_m2
                .map_or(self.exposure, |white| cie::MAX_LUMINOUS_EFFICACY / white),
            white_xyz,
            bright_y: self.bright_y,
        }
    }

    /// Luminance that becomes display white at 0 stops, cd m⁻².
    pub fn display_white_cd_m2(&self) -> f64 {
        cie::MAX_LUMINOUS_EFFICACY / self.exposure
    }

    /// CIE 1931 x and y of the white; `None` where it is black.
    pub fn white_xy(&self) -> Option<[f64; 2]> {
        let [x, y, z] = self.white_xyz;
        let sum = x + y + z;
        (sum > 0.0 && y > 0.0).then(|| [x / sum, y / sum])
    }

    /// The view of a film metered so.
    pub fn view(&self, params: &ViewParams) -> View {
        let held = self.with_set(params);
        View {
            exposure: held.exposure * params.exposure_ev.exp2(),
            adaptation: params.adaptation,
            white_xyz: held.white_xyz,
            curve: params.curve,
            half_saturation: params
                .half_saturation_cd_m2
                .map_or(AUTOMATIC_HALF, |half| held.share_of_white(half)),
            false_colour: params.false_colour,
        }
    }

    /// Luminance to which the eye's curve responds half if none is set, cd m⁻².
    pub fn automatic_half_saturation_cd_m2(&self) -> f64 {
        AUTOMATIC_HALF * cie::MAX_LUMINOUS_EFFICACY / self.exposure
    }

    /// A luminance in shares of what the automatic exposure makes display white. A stop set above that lets twice the
    /// light into the eye, whose half-saturation stays: the eye is behind the exposure.
    fn share_of_white(&self, cd_m2: f64) -> f64 {
        cd_m2 * self.exposure / cie::MAX_LUMINOUS_EFFICACY
    }
}

/// What a film says against itself: pixels that are no numbers (shown and written as black), and where the first of them
/// is, row by row from the top.
pub fn flaws_of(film: &Film) -> Flaws {
    let mut flaws = Flaws::default();
    let is_spoilt = |pixel: &&Pixel| {
        pixel
            .xyz
            .iter()
            .chain(&pixel.opacity)
            .any(|value| !value.is_finite())
    };
    let spoilt = film.pixels().iter().filter(is_spoilt).count();
    if let Some(first) = film.pixels().iter().position(|pixel| is_spoilt(&pixel)) {
        let width = film.size()[0] as usize;
        let (column, row) = (first % width, first / width);
        flaws.add(format!(
            "{spoilt} pixels are no numbers and are shown as black, the first in column {column}, row {row}, counted \
             from 0 at the upper left"
        ));
    }
    flaws
}

/// Display values of a film, sRGB-encoded, 0 to 1, row by row from the top.
pub fn develop(film: &Film, view: &BakedView) -> Vec<[f32; 3]> {
    film.pixels()
        .par_iter()
        .map(|pixel| view.apply(pixel.xyz))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Tile;

    #[test]
    fn a_fire_that_no_eye_would_see_is_not_made_bright() {
        let metered = |y: f32| {
            let mut film = Film::new([1, 1]);
            let pixels = vec![Pixel {
                xyz: [y, y, y],
                opacity: [0.0; 3],
            }];
            film.merge(&Tile {
                stride: 1,
                sample: 0,
                origin: [0, 0],
                size: [1, 1],
                pixels,
                taken: Vec::new(),
            });
            Metering::of(&film)
        };
        assert!(metered(1e-20).is_black() && metered(0.0).is_black());
        assert!(!metered(1e-6).is_black());
        assert_eq!(metered(100.0).exposure, BRIGHT_LEVEL / 100.0);
    }

    #[test]
    fn a_black_film_and_a_spoilt_pixel_do_not_upset_the_meter() {
        let mut film = Film::new([2, 1]);
        assert_eq!(Metering::of(&film).bright_y, 0.0);
        let pixels = [[f32::NAN; 3], [1.0, 2.0, 0.5]]
            .map(|xyz| Pixel {
                xyz,
                opacity: [0.0; 3],
            })
            .to_vec();
        film.merge(&Tile {
            stride: 1,
            sample: 0,
            origin: [0, 0],
            size: [2, 1],
            pixels,
            taken: Vec::new(),
        });
        let metering = Metering::of(&film);
        assert_eq!(metering.bright_y, 2.0);
        assert_eq!(metering.white_xyz, [1.0, 2.0, 0.5]);
    }

    fn params(white_k: Option<f64>, half_saturation_cd_m2: Option<f64>) -> ViewParams {
        ViewParams {
            exposure_ev: 1.0,
            display_white_cd_m2: None,
            adaptation: 1.0,
            white_k,
            white_xy: None,
            curve: Curve::Eye,
            half_saturation_cd_m2,
            false_colour: false,
        }
    }

    const METERING: Metering = Metering {
        exposure: 0.02,
        white_xyz: [1.0, 0.9, 0.3],
        bright_y: 200.0,
    };

    #[test]
    fn a_white_is_measured_unless_it_is_set() {
        let white = |white_k| METERING.view(&params(white_k, None)).white_xyz;
        assert_eq!(white(None), METERING.white_xyz);
        assert_eq!(white(Some(2856.0)), black_body_xyz(2856.0));
    }

    #[test]
    fn what_was_measured_and_is_set_by_hand_gives_the_same_view() {
        let measured = METERING.view(&params(None, Some(700.0)));
        let set = ViewParams {
            display_white_cd_m2: Some(METERING.display_white_cd_m2()),
            white_xy: METERING.white_xy(),
            ..params(None, Some(700.0))
        };
        // Another film, metered otherwise, is developed alike.
        let other = Metering {
            exposure: 7.0,
            white_xyz: [1.0; 3],
            bright_y: 1.0,
        };
        let held = other.view(&set);
        let is_near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert!(is_near(held.exposure, measured.exposure));
        assert!(is_near(held.half_saturation, measured.half_saturation));
        let [x, y, z] = held.white_xyz.map(|part| part / held.white_xyz[1]);
        let [u, v, w] = METERING.white_xyz.map(|part| part / METERING.white_xyz[1]);
        assert!(is_near(x, u) && is_near(y, v) && is_near(z, w));
        // A temperature is the white whatever the chromaticity.
        let both = ViewParams {
            white_k: Some(2856.0),
            ..set
        };
        assert_eq!(other.view(&both).white_xyz, black_body_xyz(2856.0));
    }

    #[test]
    fn a_black_body_of_the_white_looks_white_to_an_adapted_eye() {
        let view = METERING.view(&ViewParams {
            curve: Curve::Linear,
            exposure_ev: 0.0,
            ..params(Some(2000.0), None)
        });
        let ember = black_body_xyz(2000.0);
        let [r, g, b] =
            BakedView::new(&view).apply(ember.map(|v| (0.5 / 0.02 * v / ember[1]) as f32));
        // The display white of von Kries has four decimals.
        assert!((r - g).abs() < 2e-3 && (g - b).abs() < 2e-3, "{r} {g} {b}");
    }

    #[test]
    fn a_luminance_of_the_half_saturation_is_shown_at_half() {
        // Twice the half through one stop of exposure is one half more.
        for (half, luminance) in [(None, 34_150.0), (Some(700.0), 350.0)] {
            let view = METERING.view(&params(None, half));
            let y = luminance / cie::MAX_LUMINOUS_EFFICACY;
            let white = crate::colour::xyz::xyz_from_xy(crate::colour::xyz::WHITE_XY) * y;
            let eye = View {
                adaptation: 0.0,
                ..view
            };
            let [_, shown, _] = BakedView::new(&eye).linear(white.as_vec3().to_array());
            assert!((shown - 0.5).abs() < 1e-3, "{half:?}: {shown}");
        }
        assert_eq!(
            METERING.automatic_half_saturation_cd_m2(),
            2.0 * 683.0 / 0.02
        );
    }
}
