//! What was typed, checked and with its meaning: after this only the world can fail.

use std::path::{Path, PathBuf};

use super::args::{Args, ProjectArgs, RenderArgs, SpectrumArgs, StudyArgs, Sub};
use super::error::CliError;
use super::pictures::Pictures;
use crate::export::png::Bits;
use crate::export::{Format, is_same_file};
use crate::project::set::did_you_mean;
use crate::project::{Preset, Project};
use crate::scene::curves::Bands;

/// A thing to do.
#[derive(Debug)]
pub(super) enum Command {
    /// Open the window.
    Window(Box<Window>),
    /// Render a still.
    Render(Box<Render>),
    /// Measure what accuracy costs.
    Study(Box<Study>),
    /// Tell about a volume.
    Info(Box<Info>),
    /// Tabulate the optics of a place.
    Spectrum(Box<Spectrum>),
}

/// A window to open.
#[derive(Debug)]
pub(super) struct Window {
    pub(super) project: Project,
    /// The scene file that was named, and what it says by itself.
    pub(super) scene: Option<(PathBuf, Project)>,
}

/// A still to render.
#[derive(Debug)]
pub(super) struct Render {
    pub(super) project: Project,
    pub(super) output: PathBuf,
    pub(super) format: Format,
    pub(super) threads: usize,
    /// Seconds of planning and rendering after which it stops.
    pub(super) time_limit: Option<f64>,
    pub(super) stats: Option<PathBuf>,
    pub(super) pictures: Pictures,
}

/// A scene to measure.
#[derive(Debug)]
pub(super) struct Study {
    pub(super) project: Project,
    pub(super) folder: PathBuf,
    pub(super) threads: usize,
}

/// A volume to tell about.
#[derive(Debug)]
pub(super) struct Info {
    pub(super) project: Project,
    /// Whether to tell as well which effects would be computed.
    pub(super) plan: bool,
}

/// The optics of a place to tabulate.
#[derive(Debug)]
pub(super) struct Spectrum {
    pub(super) project: Project,
    /// `None` for standard output.
    pub(super) output: Option<PathBuf>,
    pub(super) bands: Bands,
    /// Temperature (K), soot volume fraction and progress of the reaction, where they were given.
    pub(super) temperature_k: Option<f64>,
    pub(super) soot: Option<f64>,
    pub(super) flame: Option<f64>,
}

/// What a temperature may be, K.
const TEMPERATURE_K: [f64; 2] = [1.0, 1e5];
/// What a share may be.
const SHARE: [f64; 2] = [0.0, 1.0];

impl Command {
    /// What the arguments mean.
    pub(super) fn new(mut args: Args) -> Result<Self, CliError> {
        find_scene(args.project_mut())?;
        match args.command {
            None => Window::new(&args.project).map(|window| Self::Window(Box::new(window))),
            Some(Sub::Info {
                project: args,
                plan,
            }) => {
                project(&args, |_| {}).map(|project| Self::Info(Box::new(Info { project, plan })))
            }
            Some(Sub::Render(args)) => {
                Render::new(args).map(|render| Self::Render(Box::new(render)))
            }
            Some(Sub::Study(args)) => Study::new(args).map(|study| Self::Study(Box::new(study))),
            Some(Sub::Spectrum(args)) => {
                Spectrum::new(args).map(|spectrum| Self::Spectrum(Box::new(spectrum)))
            }
        }
    }
}

impl Window {
    fn new(args: &ProjectArgs) -> Result<Self, CliError> {
        refuse_mistyped_command(&args.files)?;
        let said = |path: &PathBuf| Ok((path.clone(), read_scene(path)?));
        Ok(Self {
            project: project(args, |_| {})?,
            scene: args.scene.as_ref().map(said).transpose()?,
        })
    }
}

impl Render {
    fn new(args: RenderArgs) -> Result<Self, CliError> {
        let format = format(&args.output, args.bits.as_deref())?;
        let project = project(&args.project, |project| {
            if let Some(quality) = args.quality {
                project.render.quality = quality;
                project.render.target_error = None;
            }
            project.render.size = args.size.unwrap_or(project.render.size);
        })?;
        if let Some(stats) = &args.stats {
            let picture = [(args.output.as_path(), "the picture")];
            refuse_lost_files("--stats", stats, &picture, &args.project, &project)?;
        }
        if args.frames.is_some() && project.volume.path.is_empty() {
            return Err(CliError::Usage(
                "--frames: the built-in flame has no frames; name one file of a sequence, or its folder".to_owned(),
            ));
        }
        let threads = threads(args.threads);
        Ok(Self {
            project,
            output: args.output,
            format,
            threads,
            time_limit: args.time_limit,
            stats: args.stats,
            pictures: match (args.frames, args.turntable) {
                (Some(frames), _) => Pictures::Frames(frames),
                (None, Some(views)) => Pictures::Turntable(views),
                (None, None) => Pictures::One,
            },
        })
    }
}

impl Study {
    fn new(args: StudyArgs) -> Result<Self, CliError> {
        let project = project(&args.project, |project| {
            project.render.size = args.size.unwrap_or(project.render.size);
        })?;
        if args.output.exists() && !args.output.is_dir() {
            return Err(CliError::Usage(format!(
                "-o {}: this is a file; name the folder to write the tables and charts into",
                args.output.display()
            )));
        }
        Ok(Self {
            project,
            folder: args.output,
            threads: threads(args.threads),
        })
    }
}

/// As many as were asked for, or as there are cores.
fn threads(asked: Option<u16>) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    asked.map_or_else(cores, usize::from)
}

impl Spectrum {
    fn new(args: SpectrumArgs) -> Result<Self, CliError> {
        let output = args.output.filter(|path| path != Path::new("-"));
        if let Some(path) = output.as_ref().filter(|path| Format::of(path).is_some()) {
            return Err(CliError::Usage(format!(
                "-o {}: a spectrum is a table; let the name end with .csv",
                path.display()
            )));
        }
        let within = |flag: &str, value: Option<f64>, [low, high]: [f64; 2]| match value {
            Some(value) if !(low..=high).contains(&value) => Err(CliError::Usage(format!(
                "{flag} {value}: it must lie between {low} and {high}"
            ))),
            value => Ok(value),
        };
        let temperature_k = within("--temperature", args.temperature, TEMPERATURE_K)?;
        let soot = within("--soot", args.soot, SHARE)?;
        let flame = within("--flame", args.flame, SHARE)?;
        let bands = Bands::new(args.range, args.step)
            .map_err(|error| CliError::setting("--range and --step are not right", error))?;
        let project = project(&args.project, |_| {})?;
        if let Some(path) = &output {
            refuse_lost_files("-o", path, &[], &args.project, &project)?;
        }
        Ok(Self {
            project,
            output,
            bands,
            temperature_k,
            soot,
            flame,
        })
    }
}

/// A scene file that was named where volumes are is the scene to start from.
fn find_scene(args: &mut ProjectArgs) -> Result<(), CliError> {
    let is_scene = |path: &PathBuf| {
        let ending = path.extension();
        ending.is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
    };
    let Some(at) = args.files.iter().position(is_scene) else {
        return Ok(());
    };
    let scene = args.files.remove(at);
    let other = match (&args.scene, &args.preset) {
        _ if args.files.iter().any(is_scene) => "another one",
        (Some(_), _) => "--scene",
        (_, Some(_)) => "--preset",
        _ => {
            args.scene = Some(scene);
            return Ok(());
        }
    };
    Err(CliError::Usage(format!(
        "{}: a scene file cannot be used with {other}; name one scene to start from",
        scene.display()
    )))
}

fn read_scene(path: &Path) -> Result<Project, CliError> {
    Project::read(path).map_err(CliError::scene)
}

/// Scene file or preset, then flags, then `--set` in its order; the later wins.
fn project(args: &ProjectArgs, flags: impl FnOnce(&mut Project)) -> Result<Project, CliError> {
    let preset = args.preset.as_deref().and_then(Preset::named);
    let mut project = match (&args.scene, preset) {
        (Some(path), _) => read_scene(path)?,
        (None, Some(preset)) => preset.project(),
        (None, None) => Project::default(),
    };
    flags(&mut project);
    if !args.files.is_empty() {
        project.volume.path.clone_from(&args.files);
    }
    for assignment in &args.set {
        project.set(assignment).map_err(|error| {
            CliError::setting(format!("--set {assignment} is not right"), error)
        })?;
    }
    project.check().map_err(CliError::project)?;
    Ok(project)
}

/// The format that a file's ending and the flag for bits ask for.
fn format(output: &Path, bits: Option<&str>) -> Result<Format, CliError> {
    match (Format::of(output), bits) {
        (Some(Format::Png(_)), Some("16")) => Ok(Format::Png(Bits::Sixteen)),
        (Some(Format::Exr), Some(_)) => Err(CliError::Usage(
            "--bits is for PNG: EXR always has 32-bit floats; leave it out".to_owned(),
        )),
        (Some(format), _) => Ok(format),
        (None, _) => Err(CliError::Usage(format!(
            "-o {}: the name must end with .png (as it looks) or .exr (the light itself)",
            output.display()
        ))),
    }
}

/// What is written may not take the place of anything that it is made from or beside.
fn refuse_lost_files(
    flag: &str,
    target: &Path,
    beside: &[(&Path, &str)],
    args: &ProjectArgs,
    project: &Project,
) -> Result<(), CliError> {
    let scene = args.scene.iter().map(|path| (path.as_path(), "the scene"));
    let volume = project.volume.path.iter();
    let volume = volume.map(|path| (path.as_path(), "the volume"));
    let mut others = beside.iter().copied().chain(scene).chain(volume);
    match others.find(|(path, _)| is_same_file(target, path)) {
        Some((path, what)) => Err(CliError::Usage(format!(
            "{flag} {}: {what} is the same file, {}; choose a name of its own",
            target.display(),
            path.display()
        ))),
        None => Ok(()),
    }
}

/// A single word that is no file but nearly a command was meant as one.
fn refuse_mistyped_command(files: &[PathBuf]) -> Result<(), CliError> {
    let Some(word) = files
        .first()
        .filter(|file| file.extension().is_none() && !file.exists())
        .and_then(|file| file.to_str())
    else {
        return Ok(());
    };
    match did_you_mean(word, ["render", "study", "info", "spectrum", "help"]) {
        Some(command) => Err(CliError::Usage(format!(
            "there is no command and no file named {word}; did you mean {command}?"
        ))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    #![allow(
        clippy::unwrap_used,
        clippy::panic,
        reason = "a test fails by panicking"
    )]
    use clap::Parser as _;

    use super::*;
    use crate::project::Quality;

    fn render(arguments: &[&str]) -> Result<Render, CliError> {
        let words = ["sootlight", "render"]
            .into_iter()
            .chain(arguments.iter().copied());
        match Command::new(Args::try_parse_from(words).unwrap())? {
            Command::Render(render) => Ok(*render),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_ending_decides_the_format() {
        assert_eq!(
            render(&["-o", "a.PNG"]).unwrap().format,
            Format::Png(Bits::Eight)
        );
        assert_eq!(
            render(&["-o", "a.png", "--bits", "16"]).unwrap().format,
            Format::Png(Bits::Sixteen)
        );
        assert_eq!(render(&["-o", "a.exr"]).unwrap().format, Format::Exr);
        for wrong in [
            &["-o", "a.jpg"][..],
            &["-o", "png"],
            &["-o", "a.exr", "--bits", "8"],
        ] {
            assert!(
                matches!(render(wrong), Err(CliError::Usage(_))),
                "{wrong:?}"
            );
        }
    }

    #[test]
    fn set_wins_over_flags_and_flags_over_the_scene() {
        let made = render(&[
            "-o",
            "a.png",
            "--quality",
            "final",
            "--size",
            "64x32",
            "--set",
            "render.step_voxels=2",
        ]);
        let project = made.unwrap().project;
        assert_eq!(
            (project.render.quality, project.render.size),
            (Quality::Final, [64, 32])
        );
        let settings = project.settings(project.render.size).unwrap();
        assert_eq!((settings.step_voxels, settings.samples_per_pixel), (2.0, 4));
        let made = render(&["-o", "a.png", "x.vdb", "--set", "volume.path=y.vdb"]).unwrap();
        assert_eq!(made.project.volume.path, [PathBuf::from("y.vdb")]);
    }

    #[test]
    fn a_number_out_of_range_is_refused_before_anything_is_loaded() {
        let error =
            render(&["-o", "a.png", "no-such.vdb", "--set", "soot.radius_nm=-1"]).unwrap_err();
        let CliError::WrongSetting { source, .. } = error else {
            panic!("{error:?}")
        };
        assert_eq!(
            source.to_string(),
            "soot.radius_nm is -1: it must lie between 1 and 100"
        );
    }
}
