//! Controls that cannot change a picture as things are, and why: told in words beside them.
//!
//! Whether one can is not decided by rules of its own, but by asking: the job with another value of that control is
//! compared with the job itself.

use super::job::Job;
use crate::physics::moist_air::Edition;
use crate::physics::soot::{Hold, SootModel};
use crate::render::Switch;
use crate::render::plan::{Decision, Effect};
use crate::scene::{FlameParams, Fuel};
use crate::volume::FieldMap;

/// A control whose effect depends on the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// `fuel.name`
    Fuel,
    /// `soot.model`
    SootModel,
    /// `soot.hold`
    Hold,
    /// `volume.temperature.scale` and `volume.temperature.offset`
    Heat,
    /// `volume.flame.grid`
    FlameField,
    /// `soot.radius_nm`
    SootRadius,
    /// `soot.amount`
    SootAmount,
    /// `smoke.amount`
    SmokeAmount,
    /// `fuel.salt_ppm`
    SaltAmount,
    /// `fuel.blue_glow`
    BlueGlow,
    /// `air.humidity`
    Humidity,
    /// `air.co2_ppm`
    Co2,
    /// `air.pressure_pa`
    Pressure,
    /// `air.temperature_k`
    AirTemperature,
    /// `air.saturation`
    Saturation,
    /// `air.refraction_gain`
    RefractionGain,
    /// `effects.dispersion`
    Dispersion,
    /// `soot.asymmetry`
    Asymmetry,
    /// `smoke.albedo`
    SmokeAlbedo,
    /// `stage.ground_colour`, `stage.sphere_colour`, `stage.log_colour`
    StageColour,
}

/// Why something that acts through an effect does not, as the words after its name.
fn without(effect: Effect, switch: Switch, decisions: &[Decision], nothing: &str) -> String {
    let decided = decisions.iter().find(|it| it.effect == effect && !it.on);
    let effect = effect.name();
    match (switch, decided) {
        (Switch::Off, _) => format!("{effect}, which is off: switch it on under Effects"),
        (_, Some(_)) => format!("{effect}, which is left out here: Effects says why"),
        _ => format!("{effect}; {nothing}"),
    }
}

/// Why a control cannot change this job's picture; `None` if it can. `decisions` are those of the job's plan; empty while
/// there is none yet.
pub fn why_idle(job: &Job, control: Control, decisions: &[Decision]) -> Option<String> {
    // What the plan leaves out makes no difference, whatever was asked for.
    let is_left_out = |effect: Effect| decisions.iter().any(|it| it.effect == effect && !it.on);
    let mut flame = job.flame.clone();
    flame.scattering = flame
        .scattering
        .filter(|_| !is_left_out(Effect::Scattering));
    flame.bending = flame.bending.filter(|_| !is_left_out(Effect::Refraction));
    let dark = is_left_out(Effect::FireLight) || job.settings.effects.fire_light == Switch::Off;
    is_idle(job, &flame, dark, control).then(|| words(job, &flame, control, decisions))
}

fn is_none(map: Option<&FieldMap>, amount: f64) -> bool {
    map.is_none() || amount <= 0.0
}

fn bends_nothing(flame: &FlameParams) -> bool {
    flame.bending.is_none() || flame.maps.temperature.is_none()
}

fn has_no_soot(flame: &FlameParams) -> bool {
    is_none(flame.maps.soot.as_ref(), flame.soot_amount)
        && is_none(flame.maps.smoke.as_ref(), flame.smoke_amount)
}

fn is_sootless(job: &Job) -> bool {
    job.soot_follows_fuel && job.flame.fuel.row().soot_yield <= 0.0
}

/// The reason, for a control that is idle.
fn words(job: &Job, flame: &FlameParams, control: Control, decisions: &[Decision]) -> String {
    let (no_soot, sootless) = (has_no_soot(flame), is_sootless(job));
    let effects = &job.settings.effects;
    let scattering = || {
        without(
            Effect::Scattering,
            effects.scattering,
            decisions,
            "there is none here",
        )
    };
    let refraction = || {
        let nothing = "no field says how hot the gas is";
        // Nothing else keeps the plan from it.
        without(Effect::Refraction, effects.refraction, &[], nothing)
    };
    let words: &str = match control {
        Control::Fuel if flame.soot_model == SootModel::Chang => {
            "the file says how much soot there is, and this soot model has one soot for all fuels: choose another below"
        }
        Control::Heat if no_soot => "there is no soot, and no gas that glows by its heat",
        Control::SootModel | Control::Hold | Control::SootRadius | Control::Asymmetry
            if no_soot =>
        {
            "there is no soot"
        }
        Control::SootModel => "the soot models agree here",
        Control::Hold => "at 21.25 nm, where the file's soot holds, both are the same",
        Control::Heat => "the temperature does not matter here",
        Control::FlameField => {
            "only the blue glow reads it, and there is none: what glows is said by “Soot from”"
        }
        Control::Fuel => "the soot of these fuels absorbs alike under this soot model",
        Control::SootRadius => &format!(
            "with its volume kept, soot of any radius absorbs and glows alike; it would tell through {}",
            scattering()
        ),
        Control::SootAmount if sootless => "this fuel burns without soot",
        Control::SootAmount => "this volume has no soot field",
        Control::SmokeAmount => "this volume has no smoke field: choose a grid for it under Volume",
        Control::SaltAmount if effects.lines == Switch::Off || effects.bands == Switch::Off => {
            "there is no salt, or what glows of it is switched off under Effects"
        }
        Control::SaltAmount => "there is no salt",
        Control::BlueGlow if effects.chemiluminescence == Switch::Off => {
            "radicals are switched off under Effects"
        }
        Control::BlueGlow if flame.fuel.row().radicals == [0.0; 3] => {
            "this fuel has no radicals that glow"
        }
        Control::BlueGlow => {
            "no field says where gas burns: choose one for “Flame from” under Volume"
        }
        Control::Humidity | Control::Saturation => {
            &format!("humidity acts through {}", refraction())
        }
        Control::Co2 => &format!("CO₂ acts through {}", refraction()),
        Control::Pressure => &format!("pressure acts through {}", refraction()),
        Control::AirTemperature => &format!(
            "the file says how hot all its gas is; around it heat acts through {}",
            refraction()
        ),
        Control::RefractionGain => &format!("it acts through {}", refraction()),
        Control::Dispersion if !bends_nothing(flame) => {
            "only a backdrop shows it: choose one under Stage"
        }
        Control::Dispersion => &format!("it is a part of {}", refraction()),
        Control::SmokeAlbedo if is_none(flame.maps.smoke.as_ref(), flame.smoke_amount) => {
            "there is no smoke"
        }
        Control::Asymmetry | Control::SmokeAlbedo => &format!("it acts through {}", scattering()),
        Control::StageColour => &format!(
            "colours act through {}",
            without(
                Effect::FireLight,
                effects.fire_light,
                decisions,
                "nothing is lit"
            )
            .replace('_', " ")
        ),
    };
    words.to_owned()
}

/// Whether a control makes no difference to a job whose flame is what its plan makes of it.
fn is_idle(job: &Job, flame: &FlameParams, dark: bool, control: Control) -> bool {
    let (no_soot, sootless) = (has_no_soot(flame), is_sootless(job));
    let same = |change: &dyn Fn(&mut FlameParams)| {
        let mut other = flame.clone();
        change(&mut other);
        flame.gives_same_light_as(&other)
    };
    match control {
        Control::SootModel => {
            no_soot
                || SootModel::ALL
                    .into_iter()
                    .all(|m| same(&|f| f.soot_model = m))
        }
        Control::Hold => {
            let both = [Hold::Number, Hold::Volume];
            no_soot || both.into_iter().all(|hold| same(&|f| f.soot_hold = hold))
        }
        Control::Heat => no_soot && !flame.gas_shines_by_heat(),
        Control::FlameField => same(&|f| f.maps.flame = None),
        Control::Fuel => {
            // Grey soot is no fuel's; that it would differ says nothing of the others.
            let mut sooty = Fuel::all().filter(|fuel| fuel.row().soot.is_some());
            let follows = job.soot_follows_fuel && (sootless || !no_soot);
            !follows && sooty.all(|fuel| same(&|f| f.fuel = fuel))
        }
        Control::SootRadius => no_soot || same(&|f| f.soot_radius_nm *= 1.5),
        Control::SootAmount => sootless || same(&|f| f.soot_amount += 1.0),
        Control::SmokeAmount => same(&|f| f.smoke_amount += 1.0),
        Control::SaltAmount => same(&|f| f.glow.salt_ppm += 1.0),
        Control::BlueGlow => same(&|f| f.glow.radicals += 1.0),
        Control::Humidity => {
            // Air without any water and air that is full of it.
            [0.0, 1.0]
                .into_iter()
                .all(|humidity| same(&|f| f.air.humidity = humidity))
        }
        Control::Co2 => same(&|f| f.air.co2_ppm += 100.0),
        Control::Pressure => same(&|f| f.air.pressure_pa *= 1.5),
        Control::AirTemperature => same(&|f| f.air.temperature_k += 10.0),
        Control::Saturation => {
            let both = [Edition::Ciddor1996, Edition::Nist];
            both.into_iter()
                .all(|edition| same(&|f| f.air.edition = edition))
        }
        Control::RefractionGain => bends_nothing(flame),
        // What is seen of the fire itself goes one way.
        Control::Dispersion => bends_nothing(flame) || job.stage.backdrop.is_none(),
        Control::Asymmetry => no_soot || flame.scattering.is_none(),
        Control::SmokeAlbedo => {
            is_none(flame.maps.smoke.as_ref(), flame.smoke_amount) || flame.scattering.is_none()
        }
        Control::StageColour => dark,
    }
}

#[cfg(test)]
mod tests;
