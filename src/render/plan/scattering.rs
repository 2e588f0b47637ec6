//! Whether scattering is seen.

use super::{ASKED_FOR, Decision, SCATTERING};
use crate::physics::constants::METRES_PER_NM;
use crate::render::Switch;
use crate::scene::Scene;

/// Share of light that is scattered below which it is left out. Each scattering takes light out of a line of sight and
/// brings other light in, so the picture changes by less: of soot that scatters 1 % of what comes through, by about half
/// of that, where the eye begins to see a difference side by side.
const SEEN: f64 = 0.015;
/// Wavelength at which it is judged, nm: where the eye is most sensitive.
const JUDGED_NM: f64 = 555.0;

/// Whether scattering is computed.
pub(super) fn decide(scene: &Scene, switch: Switch) -> Decision {
    let decision = |on, reason: String| Decision {
        effect: SCATTERING,
        on,
        reason,
    };
    let flame = &scene.flame;
    let Some(scattering) = flame.scattering().filter(|_| switch != Switch::Off) else {
        return decision(
            false,
            match switch {
                Switch::Off => "effects.scattering is off",
                _ => "there is no soot and no smoke",
            }
            .to_owned(),
        );
    };
    if switch == Switch::On {
        return decision(true, ASKED_FOR.to_owned());
    }
    let absorption = flame.absorption_per_sample(JUDGED_NM);
    let [by_soot, by_smoke] = flame
        .scattering_per_sample(JUDGED_NM)
        .map(|scattering| scattering / absorption);
    let [all, smoke] = flame.medium().densest_columns();
    // What is scattered of the light that a column takes: the albedo times what does not come through.
    let share = |ratio: f64, column: f64| {
        let depth = absorption * (1.0 + ratio) * column;
        ratio / (1.0 + ratio) * -(-depth).exp_m1()
    };
    let share = share(by_soot, all - smoke).max(0.0) + share(by_smoke, smoke);
    let radius_nm = scattering.radius_m / METRES_PER_NM;
    let particles = if smoke > 0.0 {
        format!(
            "soot of {radius_nm:.0} nm scatters {:.1} % of what it absorbs, smoke {:.0} %",
            100.0 * by_soot,
            100.0 * by_smoke
        )
    } else {
        format!(
            "soot of {radius_nm:.0} nm scatters {:.1} % of what it absorbs",
            100.0 * by_soot
        )
    };
    let seen = share > SEEN;
    decision(
        seen,
        format!(
            "{particles}: at most {:.1} % of the light is scattered{}",
            100.0 * share,
            if seen { "" } else { ", too little to see" }
        ),
    )
}
