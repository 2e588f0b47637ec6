//! What was typed. What it means is decided in [`super::command`].

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use clap::{Args as ClapArgs, Parser, Subcommand};

use crate::project::set::KEYS;
use crate::project::{PRESETS, Quality};
use crate::range::VIEWS;
use crate::sequence::Frames;

/// Fire as physics shows it.
///
/// Without a command, opens the window with the files loaded. Without FILE, shows the built-in flame.
#[derive(Debug, Parser)]
#[command(name = "sootlight", version, args_conflicts_with_subcommands = true, after_long_help = keys_help())]
pub(super) struct Args {
    #[command(subcommand)]
    pub(super) command: Option<Sub>,
    #[command(flatten)]
    pub(super) project: ProjectArgs,
}

/// The commands that need no window.
#[derive(Debug, Subcommand)]
pub(super) enum Sub {
    /// Render a picture into a file.
    #[command(after_long_help = keys_help())]
    Render(RenderArgs),
    /// Measure what accuracy costs in time: of this scene, on this machine.
    ///
    /// Writes accuracy.csv and accuracy.json (every setting that was tried, with its error and seconds), accuracy.png and
    /// accuracy.svg (the same as a chart) into a folder. Seconds are those of the whole picture; a spread part of it is
    /// rendered.
    #[command(after_long_help = keys_help())]
    Study(StudyArgs),
    /// Tell what is in a volume and what would be made of it.
    Info {
        #[command(flatten)]
        project: ProjectArgs,
        /// Tell as well which effects a picture would be computed with, why, and what each costs in seconds: measured,
        /// so it takes about as long as a picture.
        #[arg(long)]
        plan: bool,
    },
    /// Write emission, absorption, scattering and refractive index against wavelength, as CSV.
    ///
    /// They are those of one place of the fire: with FILE, its hottest gas and densest soot; without, 1800 K and a soot
    /// volume fraction of 1e-6. Amount and radius of the soot, fuel and air are the scene's.
    #[command(after_long_help = keys_help())]
    Spectrum(SpectrumArgs),
}

impl Args {
    /// What makes the project, whatever is to be done with it.
    pub(super) fn project_mut(&mut self) -> &mut ProjectArgs {
        match &mut self.command {
            None => &mut self.project,
            Some(Sub::Info { project, .. }) => project,
            Some(Sub::Render(args)) => &mut args.project,
            Some(Sub::Study(args)) => &mut args.project,
            Some(Sub::Spectrum(args)) => &mut args.project,
        }
    }
}

/// What makes a project.
#[derive(Debug, Clone, Default, ClapArgs)]
pub(super) struct ProjectArgs {
    /// Volume files: OpenVDB, dense or sparse ASCII, sparse binary; several are read as one volume. Or a scene file.
    #[arg(value_name = "FILE")]
    pub(super) files: Vec<PathBuf>,
    /// A scene file to start from.
    #[arg(long, value_name = "SCENE.toml")]
    pub(super) scene: Option<PathBuf>,
    /// One of the program's own scenes to start from.
    #[arg(long, value_name = "NAME", conflicts_with = "scene", value_parser = PossibleValuesParser::new(PRESETS.iter().map(|preset| preset.name)))]
    pub(super) preset: Option<String>,
    /// Set a key of the scene file, such as soot.amount=2; may be repeated. --help lists the keys.
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
}

/// Flags of `render`.
#[derive(Debug, ClapArgs)]
pub(super) struct RenderArgs {
    #[command(flatten)]
    pub(super) project: ProjectArgs,
    /// The picture: .png as it looks, .exr with the light itself.
    #[arg(short, long, value_name = "OUT.{png,exr}")]
    pub(super) output: PathBuf,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(super) size: Option<[u32; 2]>,
    /// How exact: step, wavelengths and rays are chosen for this scene so that 95 % of it are within 5, 1, 0.3 or 0.05 ΔE.
    /// Numbers in the scene file or in --set win.
    #[arg(long, value_parser = PossibleValuesParser::new(Quality::ALL.map(Quality::name)).map(|name| quality(&name)))]
    pub(super) quality: Option<Quality>,
    /// Stop after so many seconds, loading and writing not counted: less exact numbers are chosen where the wished ones would
    /// take longer.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true, value_parser = seconds)]
    pub(super) time_limit: Option<f64>,
    /// Frames of the numbered sequence that FILE is one of, or the folder that it is: 1-120, 7, or 1-120:2 for every second.
    /// Exposure, white, the mapping of fields, camera, effects and numbers are measured once for all. The number goes into
    /// OUT before its ending, or where it has ####. Pictures that are there, made from the same files and settings, are kept.
    #[arg(long, value_name = "A-B", conflicts_with = "time_limit")]
    pub(super) frames: Option<Frames>,
    /// So many views evenly round the fire instead of one, the first from where the camera is. Exposure and all else is held
    /// as with --frames, and pictures are numbered and kept as there.
    #[arg(
        long,
        value_name = "N",
        conflicts_with_all = ["time_limit", "frames"],
        value_parser = clap::value_parser!(u32).range(i64::from(VIEWS[0])..=i64::from(VIEWS[1]))
    )]
    pub(super) turntable: Option<u32>,
    /// Threads to render with; all cores if not given. The picture is the same.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// Bits of each channel of a PNG.
    #[arg(long, value_parser = PossibleValuesParser::new(["8", "16"]))]
    pub(super) bits: Option<String>,
    /// Write times, counts, settings and flaws as JSON.
    #[arg(long, value_name = "STATS.json")]
    pub(super) stats: Option<PathBuf>,
}

/// Flags of `study`.
#[derive(Debug, ClapArgs)]
pub(super) struct StudyArgs {
    #[command(flatten)]
    pub(super) project: ProjectArgs,
    /// The folder to write into; made if it is not there.
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: PathBuf,
    /// Width and height in pixels of the picture that is studied.
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(super) size: Option<[u32; 2]>,
    /// Threads to measure with; all cores if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
}

/// Flags of `spectrum`.
#[derive(Debug, ClapArgs)]
pub(super) struct SpectrumArgs {
    #[command(flatten)]
    pub(super) project: ProjectArgs,
    /// The table; without it, or for -, standard output.
    #[arg(short, long, value_name = "OUT.csv")]
    pub(super) output: Option<PathBuf>,
    /// Temperature of the place in kelvin.
    #[arg(long, allow_negative_numbers = true, value_name = "K")]
    pub(super) temperature: Option<f64>,
    /// Soot volume fraction of the place, before soot.amount and the radius multiply it.
    #[arg(long, allow_negative_numbers = true, value_name = "F_V")]
    pub(super) soot: Option<f64>,
    /// Progress of the reaction at the place, 0 to 1: what glows without soot.
    #[arg(long, allow_negative_numbers = true, value_name = "SHARE")]
    pub(super) flame: Option<f64>,
    /// Distance of two wavelengths in nm; each row is the mean over so much.
    #[arg(
        long,
        allow_negative_numbers = true,
        value_name = "NM",
        default_value_t = 1.0
    )]
    pub(super) step: f64,
    /// First and last wavelength in nm.
    #[arg(long, value_name = "A-B", default_value = "380-780", value_parser = range)]
    pub(super) range: [f64; 2],
}

fn range(text: &str) -> Result<[f64; 2], String> {
    let ends = text
        .split_once(['-', '–'])
        .map(|(first, last)| [first.trim().parse(), last.trim().parse()]);
    match ends {
        Some([Ok(first), Ok(last)]) => Ok([first, last]),
        _ => Err("expected the first and the last wavelength in nm, such as 380-780".to_owned()),
    }
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once(['x', 'X', '×'])
        .map(|(width, height)| [width.parse(), height.parse()]);
    match sides {
        Some([Ok(width), Ok(height)]) => Ok([width, height]),
        _ => Err("expected width x height in pixels, such as 1280x720".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (MOST_HURRIED_S..=LONGEST_LIMIT_S).contains(&seconds) => Ok(seconds),
        _ => Err(format!(
            "expected a number of seconds, {MOST_HURRIED_S} to {LONGEST_LIMIT_S}"
        )),
    }
}

/// What `--time-limit` may be, seconds: up to a year.
const MOST_HURRIED_S: f64 = 0.001;
const LONGEST_LIMIT_S: f64 = 3.2e7;

/// The quality of a name that the parser has let through.
fn quality(name: &str) -> Quality {
    Quality::ALL
        .into_iter()
        .find(|quality| quality.name() == name)
        .unwrap_or_default()
}

/// The keys of the scene file, aligned.
fn keys_help() -> String {
    let mut help = "Keys of --set and of the scene file:\n".to_owned();
    let width = KEYS.iter().map(|key| key.name.len()).max().unwrap_or(0);
    for key in KEYS {
        let _ = writeln!(
            help,
            "  {:width$}  {}: {}",
            key.name, key.meaning, key.expects
        );
    }
    help
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_definition_is_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn a_range_is_two_wavelengths() {
        assert_eq!(range("380-780"), Ok([380.0, 780.0]));
        assert_eq!(range("589.5 – 589.7"), Ok([589.5, 589.7]));
        for wrong in ["380", "380-", "-780", "a-b", "380-580-780", ""] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_size_is_two_numbers() {
        assert_eq!(size("640x360"), Ok([640, 360]));
        assert_eq!(size("640×360"), Ok([640, 360]));
        for wrong in ["640", "640x", "x360", "-1x5", "1.5x2", "640x360x2", ""] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
