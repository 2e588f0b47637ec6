//! What burns, what its soot is like, and how hot it is.

mod glow;
mod heat;

use egui::Ui;

use super::PresetsMenu;
use super::knob::{Choice, Knob, name, note};
use super::{Command, Known, section, short, unit};
use crate::physics::constants::METRES_PER_NM;
use crate::physics::soot::{
    Hold, LARGEST_AGGREGATE_RADIUS_NM, REFERENCE_RADIUS_NM, SMALLEST_RADIUS_NM, SootModel,
    volume_fraction_factor,
};
use crate::project::{Control, Job, Project, SmokeSettings, SootSettings, ranges};
use crate::scene::Fuel;

/// By how much more spheres of a radius must absorb than small particles for it to be told.
const TOLD_ABSORPTION: f64 = 0.045;
/// Wavelength at which that is judged, nm: where the eye is most sensitive.
const JUDGED_NM: f64 = 555.0;

/// Draws the section.
pub(super) fn show(
    ui: &mut Ui,
    project: &mut Project,
    known: Known<'_>,
    menu: &mut PresetsMenu,
    commands: &mut Vec<Command>,
) {
    section(ui, "Fire", true, |ui| {
        menu.show(ui, commands);
        let job = known.job;
        let idle = |control| known.idle(control);
        fuel(
            ui,
            project,
            job,
            [Control::Fuel, Control::SootModel].map(idle),
        );
        radius(ui, project, [Control::SootRadius, Control::Hold].map(idle));
        Knob {
            label: "Asymmetry",
            unit: unit::COSINE,
            slider: ranges::ASYMMETRY,
            range: ranges::ASYMMETRY,
            logarithmic: false,
            default: 0.0,
            tip: "Mean cosine of the angle by which soot and smoke scatter light: 0 evenly, 1 onwards, −1 back. Small \
                  spheres scatter nearly evenly; clusters of them, as old soot is, onwards.",
            idle: idle(Control::Asymmetry),
        }
        .show_optional(
            ui,
            &mut project.soot.asymmetry,
            "automatic: that of spheres of the soot's radius",
        );
        let default = SootSettings::default();
        Knob {
            label: "Soot amount",
            unit: unit::TIMES,
            slider: [0.01, 100.0],
            range: ranges::AMOUNT,
            logarithmic: true,
            default: default.amount,
            tip: "Multiplies the soot of the file. More soot glows more and hides more of what is behind it: a thick \
                  fire shines like a solid of its own temperature, a thin one is transparent.",
            idle: idle(Control::SootAmount),
        }
        .show(ui, &mut project.soot.amount);
        let smoke_alone = |job: &Job| {
            let flame = &job.flame;
            flame.soot_amount <= 0.0 && flame.smoke_amount > 0.0 && flame.maps.smoke.is_some()
        };
        if job.is_some_and(smoke_alone) {
            note(
                ui,
                "what still glows like soot is smoke: its amount is under Heat and smoke",
            );
        }
        glow::show(
            ui,
            project,
            [Control::SaltAmount, Control::BlueGlow].map(idle),
        );
    });
}

/// Draws the section of what the file's other fields are worth.
pub(super) fn heat_and_smoke(ui: &mut Ui, project: &mut Project, known: Known<'_>) {
    section(ui, "Heat and smoke", true, |ui| {
        heat::show(ui, project, known);
        Knob {
            label: "Smoke amount",
            unit: unit::TIMES,
            slider: [0.01, 100.0],
            range: ranges::AMOUNT,
            logarithmic: true,
            default: 1.0,
            tip: "Multiplies the smoke of the file: soot beside the flame's own. Where it is cold it only darkens, \
                  where it is hot it glows.",
            idle: known.idle(Control::SmokeAmount),
        }
        .show(ui, &mut project.smoke.amount);
        Knob {
            label: "Smoke albedo",
            unit: unit::PERCENT,
            slider: ranges::ALBEDO,
            range: ranges::ALBEDO,
            logarithmic: false,
            default: SmokeSettings::default().albedo,
            tip: "How much of the light that smoke takes it scatters; the rest it swallows. Black smoke of a sooty fire \
                  scatters about a fifth, white smoke nearly all.",
            idle: known.idle(Control::SmokeAlbedo),
        }
        .show(ui, &mut project.smoke.albedo);
    });
}

fn fuel(
    ui: &mut Ui,
    project: &mut Project,
    job: Option<&Job>,
    [idle, idle_model]: [Option<String>; 2],
) {
    let tips: Vec<String> = Fuel::all().map(about_fuel).collect();
    let options: Vec<(Fuel, String, &str)> = Fuel::all()
        .zip(&tips)
        .map(|(fuel, tip)| (fuel, fuel.row().label.to_owned(), tip.as_str()))
        .collect();
    Choice {
        label: "Fuel",
        options: &options,
        tip: "What burns. Each fuel glows blue in its own way where it burns, and its soot was measured to absorb, and so \
              to glow, differently over the colours. Where the file does not say how much soot there is, the fuel does.",
        default: Fuel::default(),
        idle,
    }
    .show(ui, &mut project.fuel.name);
    let fuel = project.fuel.name;
    if job.is_some_and(|job| job.soot_follows_fuel) && fuel != Fuel::default() {
        note(ui, &soot_of(fuel));
    }
    let words = |model: SootModel| match model {
        SootModel::Chang => ("Chang 1990", "One index for the soot of all fuels."),
        SootModel::DalzellSarofim => ("Dalzell & Sarofim 1969", "An index for each fuel's soot."),
        SootModel::HottelBroughton => (
            "Hottel & Broughton 1932",
            "Absorption falls with the power 1.39 of the wavelength: redder transparency.",
        ),
        SootModel::Grey => (
            "Grey",
            "Absorbs all colours alike: Planck's law alone, as no soot is.",
        ),
    };
    let options = SootModel::ALL.map(|model| {
        let (words, tip) = words(model);
        (model, words.to_owned(), tip)
    });
    Choice {
        label: "Soot model",
        options: &options,
        tip: "Whose measurement says how soot's absorption depends on wavelength.",
        default: SootModel::default(),
        idle: idle_model,
    }
    .show(ui, &mut project.soot.model);
}

/// How much soot a fuel makes, in words.
fn soot_of(fuel: Fuel) -> String {
    let times = fuel.row().soot_yield;
    if times > 0.0 {
        format!("{} × the soot of propane", short(times))
    } else {
        "burns without soot".to_owned()
    }
}

/// What a fuel is like, and who says so.
fn about_fuel(fuel: Fuel) -> String {
    let row = fuel.row();
    let blue = if row.radicals == [0.0; 3] {
        "no blue glow"
    } else {
        "a blue glow where it burns"
    };
    format!("{}, {blue}. {}", soot_of(fuel), row.source)
}

fn radius(ui: &mut Ui, project: &mut Project, [idle, idle_hold]: [Option<String>; 2]) {
    Knob {
        label: "Soot radius",
        unit: unit::NANOMETRES,
        slider: [SMALLEST_RADIUS_NM, LARGEST_AGGREGATE_RADIUS_NM],
        range: ranges::SOOT_RADIUS_NM,
        logarithmic: false,
        default: REFERENCE_RADIUS_NM,
        tip: "Radius of the soot's particles. What the fire looks like depends on what stays the same meanwhile: the \
              number of particles (there is more soot, with the cube of the radius: brighter, denser, less \
              transparent) or the volume of soot (it absorbs and glows as before). Larger particles scatter more, with \
              the cube of the radius.",
        idle,
    }
    .show(ui, &mut project.soot.radius_nm);
    ui.horizontal(|ui| {
        name(
            ui,
            "Radius keeps",
            "What stays the same when the radius changes.",
        );
        let hold = &mut project.soot.hold;
        ui.selectable_value(hold, Hold::Volume, "volume")
            .on_hover_text("The volume of soot stays: fewer, larger particles.");
        ui.selectable_value(hold, Hold::Number, "number")
            .on_hover_text(
                "The number of particles stays: each grows, and so does the amount of soot.",
            );
    });
    // There is always a line, so that nothing below moves while the radius does.
    let soot = &project.soot;
    let factor = volume_fraction_factor(soot.hold, soot.radius_nm);
    let words = match soot.hold {
        Hold::Number => format!("{} × the file's soot, by the radius", short(factor)),
        Hold::Volume => "as much soot as the file has".to_owned(),
    };
    let law = project.fuel.name.soot_law(soot.model);
    let more = law.absorption_left_out(JUDGED_NM, soot.radius_nm * METRES_PER_NM);
    let words = if more > TOLD_ABSORPTION {
        let percent = (100.0 * more).round();
        format!("{words}; so large spheres would absorb {percent} % more than is computed")
    } else {
        words
    };
    note(ui, &idle_hold.unwrap_or(words));
}
