//! `sootlight info`: what is in the files, and what would be made of it.

use std::fmt::Write as _;

use super::command::Info;
use super::error::CliError;
use super::table::Table;
use super::{load, output, plan};
use crate::math::Aabb;
use crate::project::{Job, Project};
use crate::scene::flame::world_bounds;
use crate::volume::{
    FieldKind, GridSummary, Producer, Summary, UpAxis, Volume, figures, summarise,
};

impl Info {
    /// Tells what was found, then fails if nothing of it can be rendered.
    pub(super) fn run(&self) -> Result<(), CliError> {
        told(&self.project, self.plan)
    }
}

fn told(project: &Project, with_plan: bool) -> Result<(), CliError> {
    let volume = load::whole_volume(project)?;
    let summary = summarise(&volume, project.volume.producer);
    let mut text = sources(&summary, project);
    text.push_str(&grids(&summary));
    text.push_str(&producer(&summary, project));
    let job = project.job(&volume);
    if let Ok(job) = &job {
        text.push_str(&made_of_it(job, &volume));
        if with_plan {
            text.push_str(&plan::told(job));
        }
    } else {
        let notes = summary
            .notes
            .iter()
            .chain(summary.preset.assumptions.iter().map(|it| &it.words));
        text.push_str(&flaws(&notes.map(String::as_str).collect::<Vec<_>>()));
    }
    output::say(text.trim_end());
    job.map(|_| ()).map_err(CliError::project)
}

fn sources(summary: &Summary, project: &Project) -> String {
    let mut text = String::new();
    for path in &summary.sources {
        let _ = writeln!(text, "{}", path.display());
    }
    if summary.sources.is_empty() {
        let name = project.volume.built_in.name();
        let _ = writeln!(text, "the built-in flame, {name}");
    }
    let _ = write!(text, "format    {}", summary.format.name());
    if let Some(creator) = &summary.creator {
        let _ = write!(text, ", written by {creator}");
    }
    text.push_str("\n\n");
    text
}

fn grids(summary: &Summary) -> String {
    let mut table = Table::new(&[
        "grid",
        "stored",
        "voxels",
        "range",
        "voxel size",
        "active",
        "memory",
    ]);
    for grid in &summary.grids {
        let GridSummary { dims, range, .. } = grid;
        table.row([
            grid.name.clone(),
            grid.stored_as.clone(),
            format!("{} × {} × {}", dims.x, dims.y, dims.z),
            format!(
                "{} to {}",
                figures(f64::from(range.0)),
                figures(f64::from(range.1))
            ),
            voxel_size(grid),
            grid.active_voxels.to_string(),
            bytes(grid.bytes),
        ]);
    }
    let mut text = table.to_string();
    for skipped in &summary.skipped {
        let _ = writeln!(text, "not used: {}: {}", skipped.name, skipped.reason);
    }
    text.push('\n');
    text
}

fn producer(summary: &Summary, project: &Project) -> String {
    let reason = &summary.recognised.reason;
    match project.volume.producer {
        Producer::Auto => format!(
            "producer  {}: {reason}\n",
            summary.recognised.producer.name()
        ),
        named => format!("producer  {}, as it was set\n", named.name()),
    }
}

fn made_of_it(job: &Job, volume: &Volume) -> String {
    let mut text = String::new();
    let placement = &job.flame.placement;
    let up = match placement.up {
        UpAxis::Y => "y",
        UpAxis::Z => "z",
    };
    let _ = writeln!(text, "up        {up}");
    let _ = writeln!(text, "data      {}", extent(&data_bounds(job, volume)));
    // Where most of the soot is: stray voxels of the data do not count.
    let fire = world_bounds(volume, &job.flame.maps, placement);
    let _ = writeln!(text, "fire      {}", extent(&fire));
    text.push_str("\nwhat would be made of it\n");
    let mut table = Table::new(&["field", "from grid", "raw", "physical", "unit"]);
    for (kind, map) in job.flame.maps.iter() {
        let Some(grid) = volume.grid(&map.grid) else {
            continue;
        };
        let raw = (f64::from(grid.range().0), f64::from(grid.range().1));
        let mapped = map.mapped_range(raw);
        let range = |(low, high): (f64, f64)| format!("{} to {}", figures(low), figures(high));
        let unit = if kind == FieldKind::Flame {
            "0 to 1"
        } else {
            kind.unit()
        };
        table.row([
            kind.name().to_owned(),
            map.grid.clone(),
            range(raw),
            range(mapped),
            unit.to_owned(),
        ]);
    }
    text.push_str(&table.to_string());
    text.push_str(&burning(job));
    text.push_str(&flaws(&job.flaws.iter().collect::<Vec<_>>()));
    text
}

/// What burns, and what that does to the fields.
fn burning(job: &Job) -> String {
    let flame = &job.flame;
    let mut text = format!("\nfuel      {}", flame.fuel.name());
    if job.soot_follows_fuel {
        let _ = match flame.fuel.row().soot_yield {
            1.0 => Ok(()),
            times if times > 0.0 => write!(text, ": {} × the soot of propane", figures(times)),
            _ => write!(text, ": burns without soot"),
        };
    }
    let _ = writeln!(
        text,
        "\namounts   {} × the soot field, {} × the smoke field",
        figures(flame.soot_amount),
        figures(flame.smoke_amount)
    );
    let salt = flame.glow.salt;
    if !salt.is_none() {
        let ppm = figures(flame.glow.salt_ppm);
        let _ = writeln!(text, "salt      {}, {ppm} ppm", salt.name());
    }
    text
}

/// The box of every voxel of the grids that are used, in the world, metres.
fn data_bounds(job: &Job, volume: &Volume) -> Aabb {
    let world_from_file = job.flame.placement.world_from_file();
    let grids = job.flame.maps.iter();
    let boxes = grids
        .filter_map(|(_, map)| volume.grid(&map.grid))
        .filter(|grid| !grid.bounds().is_empty())
        .map(|grid| {
            // A voxel reaches half a step around its sample.
            let voxels = Aabb {
                min: grid.bounds().min.as_dvec3() - 0.5,
                max: grid.bounds().max.as_dvec3() - 0.5,
            };
            voxels.transformed(&(world_from_file * grid.world_from_index()))
        });
    boxes.fold(Aabb::EMPTY, |sum, next| sum.union(&next))
}

fn extent(bounds: &Aabb) -> String {
    if bounds.is_empty() {
        return "empty".to_owned();
    }
    let side = |from: f64, to: f64| format!("{} to {}", figures(from), figures(to));
    format!(
        "x {}, y {}, z {} m",
        side(bounds.min.x, bounds.max.x),
        side(bounds.min.y, bounds.max.y),
        side(bounds.min.z, bounds.max.z)
    )
}

fn flaws(flaws: &[&str]) -> String {
    if flaws.is_empty() {
        return "\nnothing was assumed\n".to_owned();
    }
    flaws
        .iter()
        .fold("\nassumed or repaired\n".to_owned(), |mut text, flaw| {
            let _ = writeln!(text, "  {flaw}");
            text
        })
}

fn voxel_size(grid: &GridSummary) -> String {
    let size = grid.voxel_size;
    if (size - size.x).abs().max_element() <= 1e-6 * size.x {
        figures(size.x)
    } else {
        format!(
            "{} × {} × {}",
            figures(size.x),
            figures(size.y),
            figures(size.z)
        )
    }
}

fn bytes(bytes: u64) -> String {
    match bytes as f64 {
        b if b >= 1e9 => format!("{:.1} GB", b / 1e9),
        b if b >= 1e6 => format!("{:.1} MB", b / 1e6),
        b if b >= 1e3 => format!("{:.1} kB", b / 1e3),
        b => format!("{b:.0} B"),
    }
}
