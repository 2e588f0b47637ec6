//! A report as a table for a spreadsheet and as JSON for a script. Columns and keys are kept.

use serde_json::{Value, json};

use super::numbers::REFERENCE;
use super::report::{Point, Report, Status};
use super::variant::Family;

/// The columns.
const COLUMNS: [&str; 15] = [
    "family",
    "step_voxels",
    "wavelengths",
    "interpolation",
    "samples",
    "cpu_seconds",
    "seconds",
    "seconds_spread",
    "de95",
    "de_mean",
    "rel_xyz",
    "rel_y",
    "on_front",
    "status",
    "reason",
];

impl Status {
    /// Its name in tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Measured => "ok",
            Self::Unstable(_) => "unstable",
            Self::Failed(_) => "failed",
        }
    }

    /// Why it is no better; empty where nothing is wrong.
    pub fn reason(&self) -> &str {
        match self {
            Self::Measured => "",
            Self::Unstable(words) | Self::Failed(words) => words,
        }
    }
}

impl Point {
    /// How many wavelengths it was rendered with.
    fn wavelengths(&self) -> u32 {
        match self.variant.family {
            Family::Baked => 3,
            _ => self.variant.numbers.wavelengths.count(),
        }
    }

    /// Why it is no better, or what was switched.
    fn reason(&self) -> String {
        let switched = self.variant.switched;
        let switched = switched.map(|effect| format!("{} switched", effect.name()));
        match (switched, self.status.reason()) {
            (Some(switched), "") => switched,
            (Some(switched), reason) => format!("{switched}; {reason}"),
            (None, reason) => reason.to_owned(),
        }
    }

    /// Numbers of what came of it: none where nothing did.
    fn numbers(&self) -> [Option<f64>; 7] {
        let is_there = !matches!(self.status, Status::Failed(_));
        [
            self.took.cpu_s,
            self.took.wall_s,
            self.spread_s,
            self.error.de95,
            self.error.de_mean,
            self.error.rel_xyz,
            self.error.rel_y,
        ]
        .map(|value| (is_there && value.is_finite()).then_some(value))
    }
}

impl Report {
    /// The table as comma-separated values, one row for each point.
    ///
    /// # Errors
    /// The writer refused, which a list of bytes in memory does not.
    pub fn to_csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut table = csv::Writer::from_writer(Vec::new());
        table.write_record(COLUMNS)?;
        for point in &self.points {
            let numbers = point.variant.numbers;
            let mut row = vec![
                point.variant.family.name().to_owned(),
                numbers.step_voxels.to_string(),
                point.wavelengths().to_string(),
                point.variant.interpolation.name().to_owned(),
                numbers.samples_per_pixel.to_string(),
            ];
            let found = point.numbers();
            row.extend(found.map(|value| value.map_or_else(String::new, |it| format!("{it:.6}"))));
            row.push(point.on_front.to_string());
            row.push(point.status.name().to_owned());
            row.push(point.reason());
            table.write_record(row)?;
        }
        table
            .into_inner()
            .map_err(|refused| csv::Error::from(refused.into_error()))
    }

    /// The same as JSON, with what was chosen for each quality and what the reference is.
    pub fn to_json(&self) -> Value {
        let points = self.points.iter().map(|point| {
            let numbers = point.variant.numbers;
            let [cpu, wall, spread, de95, de_mean, rel_xyz, rel_y] = point.numbers();
            json!({
                "family": point.variant.family.name(),
                "step_voxels": numbers.step_voxels,
                "wavelengths": point.wavelengths(),
                "interpolation": point.variant.interpolation.name(),
                "samples": numbers.samples_per_pixel,
                "cpu_seconds": cpu,
                "seconds": wall,
                "seconds_spread": spread,
                "de95": de95,
                "de_mean": de_mean,
                "rel_xyz": rel_xyz,
                "rel_y": rel_y,
                "on_front": point.on_front,
                "status": point.status.name(),
                "reason": point.reason(),
            })
        });
        let qualities = self.qualities.iter().map(|(quality, numbers)| {
            json!({
                "quality": quality.name(),
                "target_de95": quality.target_de(),
                "step_voxels": numbers.step_voxels,
                "wavelengths": numbers.wavelengths.count(),
                "samples": numbers.samples_per_pixel,
                "words": numbers.in_words(),
            })
        });
        json!({
            "size": self.size,
            "threads": self.threads,
            "share_of_pixels": self.share,
            "reference": {
                "words": REFERENCE.in_words(),
                "de95": self.own.de95,
                "de_mean": self.own.de_mean,
                "rel_xyz": self.own.rel_xyz,
                "rel_y": self.own.rel_y,
            },
            "qualities": qualities.collect::<Vec<_>>(),
            "points": points.collect::<Vec<_>>(),
        })
    }
}
