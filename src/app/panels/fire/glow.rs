//! What glows in the gas beside soot: salts and the blue of burning gas.

use egui::Ui;

use crate::app::panels::knob::{Choice, Knob};
use crate::app::panels::unit;
use crate::project::{FuelSettings, Project, ranges};
use crate::scene::Salt;

/// Draws the controls.
pub(super) fn show(
    ui: &mut Ui,
    project: &mut Project,
    [idle_salt, idle_blue]: [Option<String>; 2],
) {
    let default = FuelSettings::default();
    let tips: Vec<String> = Salt::all().map(about_salt).collect();
    let options: Vec<(Salt, String, &str)> = Salt::all()
        .zip(&tips)
        .map(|(salt, tip)| (salt, salt.row().label.to_owned(), tip.as_str()))
        .collect();
    Choice {
        label: "Salt",
        options: &options,
        tip: "A metal salt in the fuel. Its atoms and molecules glow in colours of their own where the gas is hot; soot \
              outshines them, so fuels without soot show them best.",
        default: default.salt,
        idle: None,
    }
    .show(ui, &mut project.fuel.salt);
    Knob {
        label: "Salt amount",
        unit: unit::PPM,
        slider: [0.01, 10_000.0],
        range: ranges::SALT_PPM,
        logarithmic: true,
        default: default.salt_ppm,
        tip: "How many of a million molecules of the hot gas are the salt's metal. Lines of a thick vapour saturate: a \
              hundred times the sodium gives ten times the light.",
        idle: idle_salt,
    }
    .show(ui, &mut project.fuel.salt_ppm);
    Knob {
        label: "Blue glow",
        unit: unit::TIMES,
        slider: [0.01, 1000.0],
        range: ranges::AMOUNT,
        logarithmic: true,
        default: default.blue_glow,
        tip: "Multiplies the light that burning gas gives off by itself: CH, C₂ and CO₂*, the blue of a gas burner and \
              at the foot of a candle's flame. Beside bright soot it is not seen.",
        idle: idle_blue,
    }
    .show(ui, &mut project.fuel.blue_glow);
}

/// Where a salt's light lies.
fn about_salt(salt: Salt) -> String {
    let row = salt.row();
    let mut lines: Vec<i32> = row
        .lines
        .iter()
        .map(|line| line.lambda_nm.round() as i32)
        .collect();
    lines.sort_unstable();
    lines.dedup();
    let lines: Vec<String> = lines.iter().map(i32::to_string).collect();
    let bands = if row.molecules.is_empty() {
        ""
    } else {
        ", and bands of its molecules"
    };
    match lines.as_slice() {
        [] => "Fuel and air alone.".to_owned(),
        lines => format!("Lines at {} nm{bands}.", lines.join(", ")),
    }
}
