//! How the light becomes a picture. Nothing here is rendered again.

use egui::Ui;

use super::knob::{Choice, Knob, note};
use super::{Command, section, unit};
use crate::colour::display::Curve;
use crate::project::{Project, ViewSettings, ranges};

/// The white that is set first by hand, K: a candle's.
const SET_WHITE_K: f64 = 1900.0;

/// Draws the section. `automatic_half` is the half-saturation that is taken where none is set, cd m⁻².
pub(super) fn show(
    ui: &mut Ui,
    project: &mut Project,
    automatic_half: f64,
    commands: &mut Vec<Command>,
) {
    section(ui, "View", true, |ui| {
        let default = ViewSettings::default();
        let view = &mut project.view;
        Knob {
            label: "Exposure",
            unit: unit::STOPS,
            slider: [-10.0, 10.0],
            range: ranges::EXPOSURE_EV,
            logarithmic: false,
            default: default.exposure_ev,
            tip: "How long the picture is exposed, in stops: one more doubles the light. Counted from the exposure \
                  that was measured when the fire was first seen. The fire itself stays as it is.",
            idle: None,
        }
        .show(ui, &mut view.exposure_ev);
        adaptation(ui, view);
        curve(ui, view, automatic_half);
        let options = [
            (false, "Off".to_owned(), "The picture itself."),
            (
                true,
                "Luminance in stops".to_owned(),
                "Each stop has a colour; the legend over the picture says which, and how many cd/m² that is.",
            ),
        ];
        Choice {
            label: "False colour",
            options: &options,
            tip: "Shows how bright each part is, whatever its own colour: cold colours below mid grey, warm ones above, \
                  with marks for what a display shows as black and as white.",
            default: default.false_colour,
            idle: None,
        }
        .show(ui, &mut view.false_colour);
        let auto = ui.button("Auto exposure").on_hover_text(
            "Measures brightness and white again, on the picture as it is now, and sets the exposure to 0.",
        );
        if auto.clicked() {
            commands.push(Command::AutoExposure);
        }
    });
}

/// What the eye takes for white, and how far.
fn adaptation(ui: &mut Ui, view: &mut ViewSettings) {
    let unseen = view
        .false_colour
        .then(|| "false colour shows luminance, which adaptation leaves alone".to_owned());
    Knob {
        label: "Adaptation",
        unit: unit::PERCENT,
        slider: ranges::ADAPTATION,
        range: ranges::ADAPTATION,
        logarithmic: false,
        default: ViewSettings::default().adaptation,
        tip: "How far the eye has got used to the white below. At 0 % a flame is as deep orange as it would be beside \
              daylight; at 100 % what has that white's colour looks white, as after minutes in a dark room.",
        idle: unseen,
    }
    .show(ui, &mut view.adaptation);
    let none = (view.adaptation <= 0.0)
        .then(|| "an eye that has not adapted at all looks at no white".to_owned());
    let idle = if view.false_colour {
        Some("no white changes luminance, which false colour shows".to_owned())
    } else {
        none
    };
    let options = [
        (
            false,
            "From the scene".to_owned(),
            "The colour of the fire's brightest parts, measured when it was first seen.",
        ),
        (
            true,
            "Set".to_owned(),
            "The colour of a black body: 1900 K a candle, 2856 K a lamp, 6500 K daylight.",
        ),
    ];
    let mut set = view.white_k.is_some();
    let changed = Choice {
        label: "White",
        options: &options,
        tip: "What the eye has got used to and takes for white, as far as adaptation goes.",
        default: false,
        idle,
    }
    .show(ui, &mut set);
    if changed {
        view.white_k = set.then_some(SET_WHITE_K);
    }
    if let Some(white_k) = &mut view.white_k {
        Knob {
            label: "White at",
            unit: unit::WHITE_KELVIN,
            slider: [ranges::WHITE_K[0], 10_000.0],
            range: ranges::WHITE_K,
            logarithmic: true,
            default: SET_WHITE_K,
            tip: "Temperature of the black body that is white. One that is hotter than the fire makes the fire redder, \
                  one that is cooler makes it bluer.",
            idle: None,
        }
        .show(ui, white_k);
    }
}

/// How light is brought into the range of a display.
fn curve(ui: &mut Ui, view: &mut ViewSettings, automatic_half: f64) {
    let words = |curve| match curve {
        Curve::Photographic => (
            "Photographic",
            "A shoulder, as of film: bright parts turn yellow, then white, and keep their shapes.",
        ),
        Curve::Filmic => (
            "Filmic, hue kept",
            "The same shoulder at one hue: bright orange turns paler, and never yellow.",
        ),
        Curve::Eye => (
            "Eye",
            "Naka and Rushton's response to luminance, L/(L + τ), at one hue.",
        ),
        Curve::Linear => (
            "Linear",
            "Light as it is, cut off at display white: for measuring.",
        ),
    };
    let options = Curve::ALL.map(|curve| {
        let (name, tip) = words(curve);
        (curve, name.to_owned(), tip)
    });
    let shows = view
        .false_colour
        .then(|| "under false colour it only says where white begins".to_owned());
    Choice {
        label: "Curve",
        options: &options,
        tip: "How light is brought into the range of a display.",
        default: Curve::default(),
        idle: shows,
    }
    .show(ui, &mut view.curve);
    if view.curve != Curve::Eye {
        return;
    }
    let mut half = view.half_saturation_cd_m2.unwrap_or(automatic_half);
    let changed = Knob {
        label: "Half at",
        unit: unit::LUMINANCE,
        slider: [1.0, 1e7],
        range: ranges::HALF_SATURATION_CD_M2,
        logarithmic: true,
        default: automatic_half,
        tip: "The luminance τ to which the eye responds half. An eye used to the dark has a low one: all of the fire \
              glares. One used to the light has a high one: only the fire's brightest parts stand out.",
        idle: None,
    }
    .show(ui, &mut half);
    if changed {
        view.half_saturation_cd_m2 = (half != automatic_half).then_some(half);
    }
    if view.half_saturation_cd_m2.is_none() {
        note(ui, "follows the measured exposure");
    }
}
