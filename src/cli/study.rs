//! `sootlight study`: what accuracy costs in time, as tables and charts.

use std::io::Cursor;

use image::{ImageFormat, RgbImage};

use super::command::Study;
use super::error::CliError;
use super::pool::pool;
use super::table::Table;
use super::{load, output};
use crate::export;
use crate::render::Cancel;
use crate::render::preparation::Preparation;
use crate::study::{Chart, Family, Report, report};

impl Study {
    /// Does it.
    pub(super) fn run(&self) -> Result<(), CliError> {
        let folder = self.folder.display();
        let refused = |error| {
            CliError::failed(
                format!("{folder} cannot be written into; name another folder"),
                error,
            )
        };
        std::fs::create_dir_all(&self.folder).map_err(refused)?;
        let files = ["csv", "json", "png", "svg"]
            .map(|ending| self.folder.join(format!("accuracy.{ending}")));
        for file in &files {
            export::check_target(file, &self.project.sources())
                .map_err(|error| CliError::failed("nothing was measured", error))?;
        }
        let pool = pool(self.threads)?;
        let volume = pool.install(|| load::volume(&self.project))?;
        let job = self.project.job(&volume).map_err(CliError::project)?;
        let bar = output::progress_bar(&Preparation::default());
        let mut known = 0;
        let measured = pool.install(|| {
            report(&job, &job.scene(None), &Cancel::never(), &mut |_, count| {
                known += 1;
                output::advance(&bar, f64::from(known) / count as f64);
            })
        });
        bar.finish_and_clear();
        let report = measured.ok_or_else(|| {
            CliError::Said(
                "there is nothing to be seen in this picture: nothing was measured. sootlight info tells what is in the volume"
                    .to_owned(),
            )
        })?;

        let chart = Chart {
            report: &report,
            title: &self.title(),
        };
        let broken =
            |error: &dyn std::error::Error| CliError::Said(format!("nothing was written: {error}"));
        let (pixels, size) = chart.to_rgb().map_err(|error| broken(&error))?;
        let contents = [
            report.to_csv().map_err(|error| broken(&error))?,
            format!("{:#}\n", report.to_json()).into_bytes(),
            as_png(pixels, size).map_err(|error| broken(&error))?,
            chart.to_svg().map_err(|error| broken(&error))?.into_bytes(),
        ];
        for (file, bytes) in files.iter().zip(&contents) {
            export::write(file, bytes).map_err(|error| {
                CliError::failed("what was measured was not all written", error)
            })?;
        }
        output::say(&told(&report));
        for file in &files {
            output::say(&format!("{}", file.display()));
        }
        Ok(())
    }

    /// What the scene is called.
    fn title(&self) -> String {
        let volume = &self.project.volume;
        let file = volume.path.first().and_then(|path| path.file_name());
        file.map_or_else(
            || format!("the built-in {}", volume.built_in.name()),
            |name| name.to_string_lossy().into_owned(),
        )
    }
}

fn as_png(pixels: Vec<u8>, [width, height]: [u32; 2]) -> Result<Vec<u8>, image::ImageError> {
    let mut bytes = Cursor::new(Vec::new());
    // As many bytes as the chart was asked for.
    let picture = RgbImage::from_raw(width, height, pixels).unwrap_or_default();
    picture.write_to(&mut bytes, ImageFormat::Png)?;
    Ok(bytes.into_inner())
}

/// What was chosen for each quality, in words.
fn told(report: &Report) -> String {
    let mut table = Table::new(&["quality", "aims at", "is rendered with", "error", "seconds"]);
    for (quality, numbers) in &report.qualities {
        let of = |family: Family| {
            let mut points = report.points.iter();
            points.find(|it| it.variant.family == family && it.variant.numbers == *numbers)
        };
        let point = of(Family::Chosen).or_else(|| of(Family::Step));
        table.row([
            quality.name().to_owned(),
            format!("{} ΔE", quality.target_de()),
            numbers.in_words(),
            point.map_or_else(|| "-".to_owned(), |it| format!("{:.2} ΔE", it.error.de95)),
            point.map_or_else(|| "-".to_owned(), |it| format!("{:.2}", it.took.wall_s)),
        ]);
    }
    table.to_string()
}
