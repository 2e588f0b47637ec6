//! What the file's numbers mean: who wrote it, which grid is which field, how large a voxel is.

use egui::Ui;

use super::knob::{Choice, Knob};
use super::quality::capitalised;
use super::{section, unit};
use crate::project::{Control, Job, Project, Up, ranges, why_idle};
use crate::volume::{FieldKind, Limits, Producer, Recognised, UpAxis};

/// Edges of voxels that the slider spans, m.
const VOXELS_M: [f64; 2] = [1e-4, 1.0];
/// Memory that the slider spans, MB.
const MEMORY_MB: [f64; 2] = [256.0, 65_536.0];

/// Draws the section.
pub(super) fn show(
    ui: &mut Ui,
    project: &mut Project,
    job: Option<&Job>,
    recognised: Option<&Recognised>,
) {
    section(ui, "Volume", true, |ui| {
        let (Some(job), Some(recognised)) = (job, recognised) else {
            return;
        };
        producer(ui, project, recognised);
        let automatic = match (project.volume.up, job.flame.placement.up) {
            (Up::Auto, UpAxis::Y) => "Auto: y",
            (Up::Auto, UpAxis::Z) => "Auto: z",
            _ => "Auto",
        };
        let options = [
            (Up::Auto, automatic, "As the producer writes it."),
            (Up::Y, "y", ""),
            (Up::Z, "z", ""),
        ]
        .map(|(up, words, tip)| (up, words.to_owned(), tip));
        Choice {
            label: "Up axis",
            options: &options,
            tip: "The file's axis that points up. Houdini writes y, Blender and EmberGen z.",
            default: Up::Auto,
            idle: None,
        }
        .show(ui, &mut project.volume.up);
        let mut voxel = project.volume.voxel_size_m.unwrap_or(job.proposed_voxel_m);
        let changed = Knob {
            label: "Voxel size",
            unit: unit::MILLIMETRES,
            slider: VOXELS_M,
            range: ranges::VOXEL_SIZE_M,
            logarithmic: true,
            default: job.proposed_voxel_m,
            tip: "Edge of a voxel, and with it the size of the fire. The same soot over a longer way is denser to the \
                  eye: a large fire is less transparent and redder than a small one.",
            idle: None,
        }
        .show(ui, &mut voxel);
        if changed {
            project.volume.voxel_size_m = (voxel != job.proposed_voxel_m).then_some(voxel);
        }
        for kind in FieldKind::ALL {
            field(ui, project, job, kind);
        }
        memory(ui, project);
    });
}

/// What a file may cost.
fn memory(ui: &mut Ui, project: &mut Project) {
    let default = Limits::default().memory_mb().round();
    let mut limit = project.volume.memory_limit_mb.unwrap_or(default);
    let changed = Knob {
        label: "Memory limit",
        unit: unit::MEGABYTES,
        slider: MEMORY_MB,
        range: ranges::MEMORY_LIMIT_MB,
        logarithmic: true,
        default,
        tip: "Memory for a file, for its grids and for what is packed of them, each. A file that needs more is refused \
              before it is read; what is open stays. It holds from the next file on that is opened.",
        idle: None,
    }
    .show(ui, &mut limit);
    if changed {
        project.volume.memory_limit_mb = (limit != default).then_some(limit);
    }
}

fn producer(ui: &mut Ui, project: &mut Project, recognised: &Recognised) {
    let options = Producer::ALL.map(|producer| {
        let words = match producer {
            Producer::Auto => format!("Auto: {}", recognised.producer.name()),
            Producer::EmberGen => "EmberGen".to_owned(),
            named => capitalised(named.name()),
        };
        let tip = match producer {
            Producer::Physical => "Soot volume fractions and kelvin, as they stand.",
            _ => "",
        };
        (producer, words, tip)
    });
    Choice {
        label: "Producer",
        options: &options,
        tip: &format!(
            "Whose conventions the fields follow. Solvers write numbers without units; the producer says what they \
             probably mean. Auto: {}.",
            recognised.reason
        ),
        default: Producer::Auto,
        idle: None,
    }
    .show(ui, &mut project.volume.producer);
}

/// Which grid a field is made from.
fn field(ui: &mut Ui, project: &mut Project, job: &Job, kind: FieldKind) {
    let (label, tip) = match kind {
        FieldKind::Soot => ("Soot from", "The grid that becomes glowing soot."),
        FieldKind::Smoke => (
            "Smoke from",
            "The grid that becomes smoke, beside the flame's own soot.",
        ),
        FieldKind::Flame => ("Flame from", "The grid that says where it burns."),
        FieldKind::Temperature => ("Temp. from", "The grid that becomes temperature."),
    };
    let set = &mut project.volume.field_mut(kind).grid;
    let automatic = match (&*set, job.flame.maps.get(kind)) {
        (None, Some(map)) => format!("Auto: {}", map.grid),
        (None, None) => "Auto: none".to_owned(),
        _ => "Auto".to_owned(),
    };
    let own = [
        (None, automatic, "As the producer's preset has it."),
        (Some(String::new()), "None".to_owned(), ""),
    ];
    let named = job.volume.grid_names().map(|name| {
        let is_read = job.volume.grid(name).is_some();
        let tip = if is_read {
            ""
        } else {
            "Not read so far: nothing needed it."
        };
        (Some(name.to_owned()), name.to_owned(), tip)
    });
    let options: Vec<_> = own.into_iter().chain(named).collect();
    Choice {
        label,
        options: &options,
        tip,
        default: None,
        idle: (kind == FieldKind::Flame)
            .then(|| why_idle(job, Control::FlameField, &[]))
            .flatten(),
    }
    .show(ui, set);
}
