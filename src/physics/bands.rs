//! Bands of molecules in flames: where they lie and what shape they have.
//!
//! ```text
//! symmetric      φ(λ) = exp(−(λ−λ₀)²/2s²) / (s √(2π)),   s = w / (2 √(2 ln 2))
//! to the blue    φ(λ) = exp(−(λ₀−λ)/s) / s  for λ ≤ λ₀, else 0,   s = w / ln 2
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | φ | shape, ∫ φ dλ = 1 | nm⁻¹ |
//! | λ₀ | centre of a symmetric band, head of one that is degraded to the blue | nm |
//! | w | full width at half height | nm |
//!
//! A band is thousands of lines of rotation that overlap in a flame: here it is its envelope. Areas are relative and
//! compare only within a group.
//!
//! **Validity.** Those of the hydrocarbon radicals are *measured*, on a butane torch. All others are *illustrative*:
//! places and widths from lists of bands, areas to 30 % at best. Heads are as published, in air; the difference to
//! vacuum, 0.15 nm, is less than their widths.
//!
//! **Source.** A. G. Gaydon, *The Spectroscopy of Flames* (1974), for the C₂, CH and CO₂* systems; R. W. B. Pearse and
//! A. G. Gaydon, *The Identification of Molecular Spectra* (1976); W. Meyerriecks and K. L. Kosanke, J. Pyrotechnics 18
//! (2003) 710, for the metals' bands; T. Shimizu's spectra of copper flames, J. Pyrotechnics (part V), for CuCl.

use std::f64::consts::{LN_2, PI, SQRT_2};

/// A band by its envelope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Centre, or head where the band is degraded to the blue, nm.
    pub at_nm: f64,
    /// Full width at half height, nm.
    pub width_nm: f64,
    /// Which way it extends.
    pub shape: Shape,
    /// Emitted energy relative to the other bands of its group.
    pub area: f64,
}

/// The form of a band.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A Gaussian.
    Symmetric,
    /// A sharp head with a tail to shorter wavelengths.
    ToTheBlue,
}

const fn wide(at_nm: f64, width_nm: f64, area: f64) -> Band {
    Band {
        at_nm,
        width_nm,
        shape: Shape::Symmetric,
        area,
    }
}

const fn headed(at_nm: f64, width_nm: f64, area: f64) -> Band {
    Band {
        at_nm,
        width_nm,
        shape: Shape::ToTheBlue,
        area,
    }
}

/// CH, B–X and A–X: the violet of a gas flame. Measured.
pub const CH: &[Band] = &[wide(388.6, 10.0, 2.99), wide(431.4, 3.2, 7.2)];
/// C₂, the Swan system: the blue-green of a rich gas flame. Measured.
pub const C2: &[Band] = &[
    headed(473.7, 9.0, 3.26),
    headed(516.5, 6.8, 5.02),
    headed(563.6, 17.0, 2.24),
    headed(619.1, 20.0, 1.05),
];
/// CO₂*, the continuum of burning carbon monoxide. Estimated from the gaps of the same spectrum.
pub const CO2: &[Band] = &[wide(415.0, 170.0, 9.0)];
/// CaOH. Illustrative.
pub const CALCIUM_HYDROXIDE: &[Band] = &[wide(554.0, 12.0, 0.5), wide(622.0, 20.0, 1.0)];
/// CaCl. Illustrative.
pub const CALCIUM_CHLORIDE: &[Band] = &[wide(618.5, 6.0, 0.5), wide(621.2, 6.0, 0.5)];
/// SrOH. Illustrative.
pub const STRONTIUM_HYDROXIDE: &[Band] = &[
    wide(605.0, 10.0, 0.7),
    wide(646.0, 12.0, 0.25),
    wide(675.0, 18.0, 1.0),
];
/// SrCl. Illustrative.
pub const STRONTIUM_CHLORIDE: &[Band] = &[
    wide(636.0, 5.0, 0.25),
    wide(648.0, 5.0, 0.25),
    wide(661.0, 5.0, 0.25),
    wide(674.0, 5.0, 0.25),
];
/// BaOH. Illustrative.
pub const BARIUM_HYDROXIDE: &[Band] = &[wide(487.0, 12.0, 1.0), wide(512.0, 16.0, 1.0)];
/// BaCl. Illustrative.
pub const BARIUM_CHLORIDE: &[Band] = &[
    wide(507.0, 4.0, 0.25),
    wide(514.0, 4.0, 0.25),
    wide(524.0, 4.0, 0.25),
    wide(532.0, 4.0, 0.25),
];
/// CuOH, the green of copper salts, with the weaker bands beside it. Illustrative.
pub const COPPER_HYDROXIDE: &[Band] = &[
    wide(545.0, 20.0, 1.0),
    wide(505.0, 8.0, 0.1),
    wide(524.0, 8.0, 0.1),
    wide(620.0, 10.0, 0.1),
];
/// CuCl, the blue of copper chloride. Illustrative.
pub const COPPER_CHLORIDE: &[Band] = &[
    wide(428.0, 4.0, 0.25),
    wide(436.0, 4.0, 0.25),
    wide(443.0, 4.0, 0.25),
    wide(449.0, 4.0, 0.25),
    wide(539.7, 26.8, 0.2),
];

impl Band {
    /// ∫ φ dλ over a bin: the share of the band that lies in it. Shares of bins that join add up to 1 exactly in the
    /// limit of all wavelengths.
    pub fn share_in(&self, [from_nm, to_nm]: [f64; 2]) -> f64 {
        self.share_below(to_nm) - self.share_below(from_nm)
    }

    /// ∫ φ dλ from 0 to a wavelength.
    fn share_below(&self, nm: f64) -> f64 {
        match self.shape {
            Shape::Symmetric => {
                let deviation = self.width_nm / (2.0 * (2.0 * LN_2).sqrt());
                0.5 * libm::erfc((self.at_nm - nm) / (deviation * SQRT_2))
            }
            Shape::ToTheBlue => ((nm.min(self.at_nm) - self.at_nm) * LN_2 / self.width_nm).exp(),
        }
    }

    /// Wavelengths beyond which less than a thousandth of the band lies, nm.
    pub fn reach_nm(&self) -> [f64; 2] {
        // A Gaussian ends 1.4 of its widths off, a tail after ln 1000 / ln 2 of them.
        match self.shape {
            Shape::Symmetric => [
                self.at_nm - 1.4 * self.width_nm,
                self.at_nm + 1.4 * self.width_nm,
            ],
            Shape::ToTheBlue => [self.at_nm - 10.0 * self.width_nm, self.at_nm],
        }
    }

    /// Width of the box of the same area and height, nm: what a band covers, where its depth matters.
    pub fn box_width_nm(&self) -> f64 {
        match self.shape {
            Shape::Symmetric => self.width_nm * (PI / (4.0 * LN_2)).sqrt(),
            Shape::ToTheBlue => self.width_nm / LN_2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::golden_csv::Table;
    use super::*;

    const ALL: [(&str, &[Band]); 11] = [
        ("CH", CH),
        ("C2", C2),
        ("CO2* continuum", CO2),
        ("CaOH", CALCIUM_HYDROXIDE),
        ("CaCl", CALCIUM_CHLORIDE),
        ("SrOH", STRONTIUM_HYDROXIDE),
        ("SrCl", STRONTIUM_CHLORIDE),
        ("BaOH", BARIUM_HYDROXIDE),
        ("BaCl", BARIUM_CHLORIDE),
        ("CuCl", COPPER_CHLORIDE),
        ("CuOH", COPPER_HYDROXIDE),
    ];

    #[test]
    fn no_band_of_the_table_is_missing_and_areas_are_its_own() {
        let text = include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/golden/molecular_bands.csv"
        ));
        let mut compared = 0;
        for row in Table::parse(text).rows() {
            let species = row.text("species");
            // OH is invisible, boron is no salt that is offered.
            if ["OH", "BO2"].contains(&species) {
                continue;
            }
            let matching = |(name, _): &&(&str, &[Band])| {
                species == *name || species.starts_with(&format!("{name} "))
            };
            let bands = ALL
                .iter()
                .find(matching)
                .map_or(&[][..], |(_, bands)| *bands);
            let place = row
                .text("head_or_centre_nm")
                .replace(" broad", "")
                .replace('~', "");
            let numbers: Vec<f64> = place
                .split(['/', '-'])
                .map(|number| number.parse().unwrap_or_else(|_| panic!("{place}")))
                .collect();
            let (first, last) = (numbers[0], numbers[numbers.len() - 1]);
            let here = bands
                .iter()
                .filter(|band| (first - 0.1..=last + 0.1).contains(&band.at_nm));
            let area: f64 = here.map(|band| band.area).sum();
            let expected = row.number("rel_area");
            assert!(
                (area / expected - 1.0).abs() < 1e-9,
                "{species} {place}: {area}"
            );
            compared += 1;
        }
        assert!(compared >= 18, "only {compared} rows");
    }

    #[test]
    fn bins_share_a_band_without_loss_and_halves_are_as_wide_as_said() {
        for (name, bands) in ALL {
            for band in bands {
                let [from, to] = band.reach_nm();
                let bins = |width: f64| {
                    let first = (from / width).floor() as i32;
                    let last = (to / width).ceil() as i32;
                    (first..last).map(move |i| [f64::from(i) * width, f64::from(i + 1) * width])
                };
                for width in [1.0, 5.0] {
                    let sum: f64 = bins(width).map(|bin| band.share_in(bin)).sum();
                    assert!((0.998..1.0 + 1e-12).contains(&sum), "{name}: {sum}");
                }
                let height = |nm: f64| band.share_in([nm - 1e-4, nm]) / 1e-4;
                let half = match band.shape {
                    Shape::Symmetric => band.at_nm - 0.5 * band.width_nm,
                    Shape::ToTheBlue => band.at_nm - band.width_nm,
                };
                let ratio = height(half) / height(band.at_nm);
                assert!((ratio - 0.5).abs() < 1e-3, "{name}: {ratio}");
                let box_height = 1.0 / band.box_width_nm();
                assert!(
                    (box_height / height(band.at_nm) - 1.0).abs() < 1e-3,
                    "{name}"
                );
            }
        }
    }
}
