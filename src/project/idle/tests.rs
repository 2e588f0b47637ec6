//! Which controls act, and what the others say.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use std::sync::Arc;

use super::*;
use crate::project::Project;
use crate::volume::procedural;

fn idle(assignments: &[&str], control: Control) -> Option<String> {
    let mut project = Project::default();
    project.set_all(assignments.iter().copied()).unwrap();
    let job = project.job(&Arc::new(procedural::torch())).unwrap();
    why_idle(&job, control, &[])
}

fn left_out(effect: Effect) -> Decision {
    Decision {
        effect,
        switch: Switch::Auto,
        on: false,
        bound: Some(0.0),
        reason: "it is too faint".into(),
    }
}

#[test]
fn a_fuel_acts_through_models_that_look_at_it_and_where_it_says_how_much_soot_there_is() {
    // The built-in flame takes its soot from the fuel; numbers by hand settle how much there is.
    assert_eq!(idle(&[], Control::Fuel), None);
    let given = "volume.soot.scale=1";
    // What a fuel's products weigh bends light.
    assert_eq!(idle(&[given], Control::Fuel), None);
    let straight = "effects.refraction=off";
    assert!(
        idle(&[given, straight], Control::Fuel)
            .unwrap()
            .contains("soot model")
    );
    for model in ["dalzell-sarofim", "hottel-broughton"] {
        let set = format!("soot.model={model}");
        assert_eq!(
            idle(&[given, straight, &set], Control::Fuel),
            None,
            "{model}"
        );
    }
    assert_eq!(
        idle(&[given, straight, "fuel.salt=sodium"], Control::Fuel),
        None
    );
}

#[test]
fn a_salt_and_the_blue_glow_say_what_they_lack() {
    assert!(idle(&[], Control::SaltAmount).is_some());
    assert_eq!(idle(&["fuel.salt=copper"], Control::SaltAmount), None);
    let off = ["fuel.salt=copper", "effects.lines=off", "effects.bands=off"];
    assert!(
        idle(&off, Control::SaltAmount)
            .unwrap()
            .contains("off under Effects")
    );
    let off = idle(&["effects.chemiluminescence=off"], Control::BlueGlow).unwrap();
    assert!(off.contains("off under Effects"), "{off}");
    assert!(idle(&[], Control::BlueGlow).unwrap().contains("Flame from"));
    assert_eq!(idle(&["volume.flame.grid=soot"], Control::BlueGlow), None);
    assert_eq!(
        idle(&["effects.chemiluminescence=on"], Control::BlueGlow),
        None
    );
    let grey = ["fuel.name=black-body", "volume.flame.grid=soot"];
    assert!(idle(&grey, Control::BlueGlow).unwrap().contains("fuel"));
}

#[test]
fn a_fuel_without_soot_says_so_and_can_be_changed_for_another() {
    let clean = "fuel.name=methanol";
    let words = idle(&[clean], Control::SootAmount).unwrap();
    assert!(words.contains("without soot"), "{words}");
    for control in [Control::SootModel, Control::SootRadius, Control::Hold] {
        let words = idle(&[clean], control);
        assert_eq!(words.as_deref(), Some("there is no soot"), "{control:?}");
    }
    assert_eq!(idle(&[clean], Control::Fuel), None);
    // Where the amount was said by hand, the fuel does not say it.
    let given = [clean, "volume.soot.scale=1"];
    assert_eq!(idle(&given, Control::SootAmount), None);
}

#[test]
fn heat_acts_where_gas_glows_without_soot() {
    let salted = ["fuel.name=methanol", "fuel.salt=sodium"];
    assert_eq!(idle(&salted, Control::Heat), None);
    let by_heat = ["soot.amount=0", "effects.chemiluminescence=on"];
    assert_eq!(idle(&by_heat, Control::Heat), None);
    let blue = ["soot.amount=0", "volume.flame.grid=soot"];
    assert!(idle(&blue, Control::Heat).is_some());
}

#[test]
fn a_radius_acts_if_the_number_of_particles_is_kept() {
    assert_eq!(idle(&[], Control::SootRadius), None);
    // With its volume kept it still scatters otherwise.
    assert_eq!(idle(&["soot.hold=volume"], Control::SootRadius), None);
    let off = ["soot.hold=volume", "effects.scattering=off"];
    assert!(
        idle(&off, Control::SootRadius)
            .unwrap()
            .contains("which is off")
    );
    assert_eq!(
        idle(&["soot.amount=0", "smoke.amount=0"], Control::SootRadius).as_deref(),
        Some("there is no soot")
    );
}

#[test]
fn nothing_about_soot_acts_where_there_is_none() {
    let none = ["soot.amount=0", "smoke.amount=0"];
    for control in [
        Control::SootModel,
        Control::SootRadius,
        Control::Hold,
        Control::Heat,
    ] {
        let words = idle(&none, control);
        assert!(words.is_some(), "{control:?}");
    }
    assert_eq!(idle(&[], Control::SootModel), None);
    assert_eq!(idle(&[], Control::Heat), None);
    assert!(idle(&[], Control::Hold).is_some());
    assert_eq!(idle(&["soot.radius_nm=30"], Control::Hold), None);
    assert!(idle(&["fuel.blue_glow=0"], Control::FlameField).is_some());
    assert_eq!(idle(&["volume.flame.grid=soot"], Control::FlameField), None);
}

#[test]
fn amounts_act_on_fields_that_are_there() {
    assert_eq!(idle(&[], Control::SootAmount), None);
    assert!(idle(&[], Control::SmokeAmount).is_some());
    let smoky = ["volume.smoke.grid=temperature", "volume.smoke.scale=1e-9"];
    assert_eq!(idle(&smoky, Control::SmokeAmount), None);
    let sootless = [smoky[0], smoky[1], "volume.soot.grid="];
    assert!(idle(&sootless, Control::SootAmount).is_some());
}

#[test]
fn air_acts_where_light_is_bent() {
    let controls = [
        Control::Humidity,
        Control::Co2,
        Control::Pressure,
        Control::Saturation,
        Control::RefractionGain,
    ];
    for control in controls {
        let words = idle(&["volume.temperature.grid="], control).unwrap();
        assert!(words.contains("how hot the gas is"), "{control:?}: {words}");
        assert_eq!(idle(&[], control), None, "{control:?}");
        let off = idle(&["stage.ground=true", "effects.refraction=off"], control).unwrap();
        assert!(off.contains("which is off"), "{control:?}: {off}");
    }
    let apart = |set: &[&str]| idle(set, Control::Dispersion);
    assert!(apart(&[]).unwrap().contains("only a backdrop"));
    assert_eq!(apart(&["stage.backdrop=checker"]), None);
    assert!(
        apart(&["effects.refraction=off"])
            .unwrap()
            .contains("which is off")
    );
    // Air that is the gas's own heat acts without.
    assert_eq!(idle(&[], Control::AirTemperature), None);
    assert_eq!(
        idle(&["volume.temperature.grid="], Control::AirTemperature),
        None
    );
}

#[test]
fn what_scatters_acts_where_scattering_is_computed() {
    assert_eq!(idle(&[], Control::Asymmetry), None);
    assert_eq!(
        idle(&["soot.amount=0"], Control::Asymmetry).as_deref(),
        Some("there is no soot")
    );
    assert_eq!(
        idle(&[], Control::SmokeAlbedo).as_deref(),
        Some("there is no smoke")
    );
    let smoky = ["volume.smoke.grid=temperature", "volume.smoke.scale=1e-9"];
    assert_eq!(idle(&smoky, Control::SmokeAlbedo), None);
    let off = [smoky[0], smoky[1], "effects.scattering=off"];
    for control in [Control::Asymmetry, Control::SmokeAlbedo] {
        assert!(idle(&off, control).unwrap().contains("which is off"));
    }
    assert_eq!(idle(&[], Control::StageColour), None);
    let dark = idle(&["effects.fire_light=off"], Control::StageColour).unwrap();
    assert_eq!(
        dark,
        "colours act through fire light, which is off: switch it on under Effects"
    );
}

#[test]
fn what_the_plan_leaves_out_sends_to_its_reason() {
    let mut project = Project::default();
    project
        .set_all(["stage.ground=true", "soot.hold=volume"])
        .unwrap();
    let job = project.job(&Arc::new(procedural::torch())).unwrap();
    for (control, effect) in [
        (Control::Asymmetry, Effect::Scattering),
        (Control::SootRadius, Effect::Scattering),
        (Control::StageColour, Effect::FireLight),
    ] {
        assert_eq!(why_idle(&job, control, &[]), None, "{control:?}");
        let words = why_idle(&job, control, &[left_out(effect)]).unwrap();
        assert!(words.contains("Effects says why"), "{control:?}: {words}");
    }
}
