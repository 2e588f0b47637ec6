//! `sootlight spectrum`: what a place of the fire does to light, against wavelength.

use std::fmt::Write as _;

use super::command::Spectrum;
use super::error::CliError;
use super::{load, output};
use crate::export;
use crate::project::Job;
use crate::scene::Local;
use crate::scene::curves::{Curves, Row, USUAL_PLACE, peak_of};

/// The columns, each with its unit.
const HEADER: &str = "lambda_nm,emission_W_m-3_sr-1_nm-1,absorption_m-1,scattering_m-1,n_minus_1";

impl Spectrum {
    /// Does it.
    pub(super) fn run(&self) -> Result<(), CliError> {
        let not_written = |error| CliError::failed("the spectrum was not written", error);
        if let Some(path) = &self.output {
            export::check_writable(path).map_err(not_written)?;
        }
        let volume = load::volume(&self.project)?;
        let job = self.project.job(&volume).map_err(CliError::project)?;
        let place = self.place(&job);
        let no_air = |error| CliError::setting("there is no such air", error);
        let curves = Curves::new(&job.flame, place).map_err(no_air)?;
        let rows = curves.rows(&self.bands).map_err(no_air)?;

        let mut text = self.assumptions(&job, &place, &curves);
        table(&mut text, &rows);
        match &self.output {
            None => output::say(text.trim_end()),
            Some(path) => {
                export::write(path, text.as_bytes()).map_err(not_written)?;
                let count = rows.len();
                output::say(&format!("{}: {count} wavelengths", path.display()));
            }
        }
        Ok(())
    }

    /// What was given, else what the files have, else what is usual.
    fn place(&self, job: &Job) -> Local {
        let found = if job.volume.sources.is_empty() {
            USUAL_PLACE
        } else {
            peak_of(&job.volume, &job.flame)
        };
        Local {
            soot_volume_fraction: self.soot.unwrap_or(found.soot_volume_fraction),
            temperature_k: self.temperature_k.unwrap_or(found.temperature_k),
            flame: self.flame.unwrap_or(found.flame),
        }
    }

    /// Comment lines that say what the table is of.
    fn assumptions(&self, job: &Job, place: &Local, curves: &Curves) -> String {
        let flame = &job.flame;
        let names = job.volume.sources.iter().map(|path| {
            let name = path.file_name().unwrap_or(path.as_os_str());
            // A name may hold a line break, a comment may not.
            name.to_string_lossy().replace(['\n', '\r'], " ")
        });
        let names = names.collect::<Vec<_>>().join(" + ");
        let from = |given: Option<f64>, peak: &str| match (given, names.as_str()) {
            (Some(_), _) => String::new(),
            (None, "") => " (assumed)".to_owned(),
            (None, names) => format!(" ({peak} of {names})"),
        };
        let mut text = format!(
            "# sootlight {}: the optics of one place of a fire\n",
            env!("CARGO_PKG_VERSION")
        );
        let mut line = |words: String| {
            let _ = writeln!(text, "# {words}");
        };
        let salt = match flame.glow.salt {
            salt if salt.is_none() => String::new(),
            salt => format!("; salt: {}, {} ppm", salt.name(), flame.glow.salt_ppm),
        };
        line(format!(
            "fuel: {}; soot: {} of radius {} nm{salt}",
            flame.fuel.name(),
            flame.soot_model,
            flame.soot_radius_nm
        ));
        line(format!(
            "soot volume fraction: {:e}{}; with soot.amount, fuel and radius: {:e}",
            legible(place.soot_volume_fraction),
            from(self.soot, "the densest"),
            legible(curves.soot_volume_fraction())
        ));
        line(format!(
            "temperature: {} K{}; progress of the reaction: {}{}",
            legible(place.temperature_k),
            from(self.temperature_k, "the hottest"),
            place.flame,
            if self.flame.is_some() {
                ""
            } else {
                " (assumed)"
            }
        ));
        line(format!(
            "air: {} K, {} Pa, humidity {}, {} ppm CO2: {:.6} of its molecules are water",
            flame.air.temperature_k,
            flame.air.pressure_pa,
            flame.air.humidity,
            flame.air.co2_ppm,
            curves.gas().air().water()
        ));
        line(format!(
            "gas: {:.3} products of the fuel, the rest air",
            curves.products_share()
        ));
        let outside = curves.lines_outside(&self.bands);
        if !outside.is_empty() {
            let outside: Vec<String> = outside.iter().map(|nm| format!("{nm:.2}")).collect();
            line(format!(
                "lines of the salt outside of this range, in no row: {} nm",
                outside.join(", ")
            ));
        }
        line(format!(
            "vacuum wavelengths; each row but n_minus_1 is the mean over {} nm around its wavelength",
            self.bands.step_nm()
        ));
        text
    }
}

/// A number without the digits that a file's f32 has not.
fn legible(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

fn table(text: &mut String, rows: &[Row]) {
    text.push_str(HEADER);
    text.push('\n');
    for row in rows {
        let at = &row.coefficients;
        // The step is at least a thousandth of a nanometre: what lies beyond a millionth is rounding.
        let lambda_nm = (row.lambda_nm * 1e6).round() / 1e6;
        let _ = writeln!(
            text,
            "{lambda_nm},{:e},{:e},{:e},{:e}",
            at.emission, at.absorption, at.scattering, row.n_minus_1
        );
    }
}
