//! The colours of maps, which never change: bands with fixed edges, cold and dark for little, warm and light for much.

use egui::Color32;

use crate::app::panels::short;
use crate::colour::false_colour::{BLACK, STOPS};

/// Bands of a quantity.
pub(super) struct Scale {
    /// What is mapped, as the legend is titled.
    pub(super) title: &'static str,
    /// Where bands end, ascending; the last has no end.
    edges: &'static [f32],
    /// Of [`STOPS`], which colour each band has.
    stops: &'static [usize],
    /// What is said of nothing at all, if that has a colour of its own.
    nothing: Option<&'static str>,
}

/// Samples of the medium, for each pixel.
pub(super) const SAMPLES: Scale = Scale {
    title: "Cost of each pixel, samples of the fire",
    edges: &[3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4],
    stops: &[0, 2, 3, 5, 7, 8, 10, 11, 13],
    nothing: Some("none"),
};

/// ΔE_ITP. What may be seen is warm.
pub(super) const ERROR: Scale = Scale {
    title: "Error of each pixel, ΔE (1 is just seen)",
    edges: &[0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0],
    stops: &[1, 2, 3, 4, 5, 7, 9, 10, 12, 13],
    nothing: None,
};

impl Scale {
    /// The colour of a value; clear where it is not a number.
    pub(super) fn colour(&self, value: f32) -> Color32 {
        if value.is_nan() {
            return Color32::TRANSPARENT;
        }
        if value <= 0.0 && self.nothing.is_some() {
            return opaque(BLACK);
        }
        self.band(self.edges.partition_point(|&edge| edge <= value))
    }

    fn band(&self, index: usize) -> Color32 {
        self.stops
            .get(index)
            .and_then(|&stop| STOPS.get(stop))
            .map_or(Color32::TRANSPARENT, |&srgb| opaque(srgb))
    }

    /// Each band's colour and words, least first.
    pub(super) fn rows(&self) -> Vec<(Color32, String)> {
        let told = |edge: f32| match f64::from(edge) {
            // A decimal of f32 has more digits as f64.
            edge if edge < 1.0 => short((1e3 * edge).round() / 1e3),
            edge => short(edge),
        };
        let nothing = self.nothing.map(|words| (opaque(BLACK), words.to_owned()));
        let bands = (0..=self.edges.len()).map(|index| {
            let words = match (
                index.checked_sub(1).map(|i| self.edges[i]),
                self.edges.get(index),
            ) {
                (None, Some(&end)) => format!("below {}", told(end)),
                (Some(from), Some(&end)) => format!("{} to {}", told(from), told(end)),
                (from, None) => format!("{} and more", told(from.unwrap_or(0.0))),
            };
            (self.band(index), words)
        });
        nothing.into_iter().chain(bands).collect()
    }
}

fn opaque([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    #[test]
    fn every_band_has_a_colour_of_its_own_lighter_than_the_one_before() {
        for scale in [&SAMPLES, &ERROR] {
            let rows = scale.rows();
            assert_eq!(scale.stops.len(), scale.edges.len() + 1);
            let luma = |colour: &Color32| {
                let [r, g, b, _] = colour.to_array().map(f32::from);
                0.2126 * r + 0.7152 * g + 0.0722 * b
            };
            for pair in rows.windows(2) {
                assert!(luma(&pair[0].0) < luma(&pair[1].0), "{pair:?}");
            }
        }
    }

    #[test]
    fn a_value_has_the_colour_of_the_row_that_names_it() {
        let rows = ERROR.rows();
        for (value, words) in [
            (0.0, "below 0.05"),
            (0.05, "0.05 to 0.1"),
            (0.99, "0.5 to 1"),
            (1.0, "1 to 2"),
            (1e6, "20 and more"),
        ] {
            let row = rows.iter().find(|row| row.1 == words).unwrap();
            assert_eq!(ERROR.colour(value), row.0, "{value}");
        }
        let rows = SAMPLES.rows();
        assert_eq!(rows[0], (SAMPLES.colour(0.0), "none".to_owned()));
        assert_eq!(rows[6], (SAMPLES.colour(500.0), "300 to 1000".to_owned()));
        // What is not known is clear.
        assert_eq!(ERROR.colour(f32::NAN), Color32::TRANSPARENT);
    }
}
