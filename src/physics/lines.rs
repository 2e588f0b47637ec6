//! Spectral lines of atoms in hot gas.
//!
//! ```text
//! S = ∫ σ_a dλ = N₁ (g₂/g₁) A λ⁴ (1 − e^{−x}) / (8πc),   j = S·B(λ, T),   x = hc/(λkT)
//! N₁ = N g₁ e^{−E₁/kT} / Q,   N = X p / (kT)
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | S | area of the line in the absorption coefficient | 1 (m⁻¹ times m) |
//! | j | what the whole line emits | W m⁻³ sr⁻¹ |
//! | N, N₁ | number density of the atoms, and of those in the lower level | m⁻³ |
//! | X, p | mole fraction of the atoms, pressure | 1, Pa |
//! | g₁, g₂, E₁ | degeneracies of the lower and upper level, energy of the lower one | 1, 1, J |
//! | Q | partition function, taken as the degeneracy of the ground level | 1 |
//! | A | rate of spontaneous emission | s⁻¹ |
//! | λ | vacuum wavelength | m in the formulae, nm in the data |
//!
//! Written so, nothing is 0·∞ when T → 0: absorption goes to that of the ground level and emission to 0.
//!
//! **Width.** At 1 atm collisions make a line about 0.1 cm⁻¹ wide: γ = 0.05 cm⁻¹·λ², some picometres. A line therefore
//! belongs to exactly one bin of a spectrum, and what it gives once it is thick says [`super::growth`].
//!
//! **Validity.** Thermal populations below about 3000 K, where the excited levels hardly count in Q.
//!
//! **Source.** R. C. Hilborn, Am. J. Phys. 50 (1982) 982; G. Dorta-Perez, *Realistic fire rendering* (2015), eq. 3.8 and
//! 3.20, corrected. Data: A. Kramida et al., *NIST Atomic Spectra Database*; air wavelengths brought to vacuum by
//! Ciddor's equation at 15 °C.

use std::f64::consts::PI;

use super::blackbody::SECOND_RADIATION_CONSTANT_NM_K;
use super::constants::{BOLTZMANN_J_PER_K, LIGHT_SPEED_M_PER_S, METRES_PER_NM};

/// Standard atmosphere, Pa. Exact (10th CGPM, 1954).
pub const ATMOSPHERE_PA: f64 = 101_325.0;

/// Half width at half height of a line in a flame at 1 atm, cm⁻¹: the order of magnitude of collisional widths.
const HALF_WIDTH_PER_CM: f64 = 0.05;
/// Inverse centimetres in an inverse metre's place: 1 cm⁻¹ = 100 m⁻¹.
const PER_CM: f64 = 100.0;
/// hc/k in cm K: kelvin for an inverse centimetre.
const KELVIN_PER_CM: f64 = SECOND_RADIATION_CONSTANT_NM_K * 1e-7;

/// A line of an atom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Vacuum wavelength, nm.
    pub lambda_nm: f64,
    /// Rate of spontaneous emission A, s⁻¹.
    pub rate_per_s: f64,
    /// Degeneracies of the lower and the upper level.
    pub degeneracies: [f64; 2],
    /// Energy of the lower level, cm⁻¹.
    pub lower_per_cm: f64,
    /// Partition function Q: degeneracy of the ground level.
    pub partition: f64,
}

const fn resonance(lambda_nm: f64, rate_per_s: f64, lower: f64, upper: f64) -> Line {
    Line {
        lambda_nm,
        rate_per_s,
        degeneracies: [lower, upper],
        lower_per_cm: 0.0,
        partition: lower,
    }
}

const fn excited(lambda_nm: f64, rate_per_s: f64, g: [f64; 2], lower_per_cm: f64) -> Line {
    Line {
        lambda_nm,
        rate_per_s,
        degeneracies: g,
        lower_per_cm,
        // Copper's ground level, ²S₁/₂.
        partition: 2.0,
    }
}

/// Lithium's red resonance lines.
pub const LITHIUM: &[Line] = &[
    resonance(670.96120, 3.6891e7, 2.0, 4.0),
    resonance(670.97620, 3.6890e7, 2.0, 2.0),
];
/// Sodium's D lines.
pub const SODIUM: &[Line] = &[
    resonance(589.15834, 6.16e7, 2.0, 4.0),
    resonance(589.75583, 6.14e7, 2.0, 2.0),
];
/// Potassium: two lines at the end of the visible red, one at its violet end.
pub const POTASSIUM: &[Line] = &[
    resonance(766.70090, 3.779e7, 2.0, 4.0),
    resonance(770.10837, 3.734e7, 2.0, 2.0),
    resonance(404.52848, 1.15e6, 2.0, 4.0),
];
/// Calcium's blue-violet resonance line.
pub const CALCIUM: &[Line] = &[resonance(422.79184, 2.18e8, 1.0, 3.0)];
/// Strontium's blue resonance line.
pub const STRONTIUM: &[Line] = &[resonance(460.86218, 2.01e8, 1.0, 3.0)];
/// Barium's green resonance line.
pub const BARIUM: &[Line] = &[resonance(553.70186, 1.19e8, 1.0, 3.0)];
/// Copper's green lines, all from excited levels.
pub const COPPER: &[Line] = &[
    excited(510.69639, 2.0e6, [6.0, 4.0], 11202.618),
    excited(515.46706, 6.0e7, [2.0, 4.0], 30535.324),
    excited(521.96549, 7.5e7, [4.0, 6.0], 30783.697),
];

/// Number density of a mole fraction of a gas, m⁻³. Preconditions: `pressure_pa` ≥ 0, `temperature_k` > 0.
pub fn number_density(mole_fraction: f64, pressure_pa: f64, temperature_k: f64) -> f64 {
    mole_fraction * pressure_pa / (BOLTZMANN_J_PER_K * temperature_k)
}

impl Line {
    /// S/N in m³: the line's area in the absorption coefficient for each atom in a cubic metre. At 0 K that of the
    /// ground level (0 for a line from an excited one). Precondition: `temperature_k` ≥ 0.
    pub fn area_per_atom(&self, temperature_k: f64) -> f64 {
        let x = SECOND_RADIATION_CONSTANT_NM_K / (self.lambda_nm * temperature_k);
        self.cold_area_per_atom() * self.lower_share(temperature_k) * -(-x).exp_m1()
    }

    /// S/N in m³ if all atoms were in the lower level's Boltzmann share 1, without stimulated emission: what does not
    /// depend on temperature.
    pub fn cold_area_per_atom(&self) -> f64 {
        let lambda_m = self.lambda_nm * METRES_PER_NM;
        // N₁/N · g₂/g₁ = g₂/Q · e^{−E₁/kT}.
        self.degeneracies[1] / self.partition * self.rate_per_s * lambda_m.powi(4)
            / (8.0 * PI * LIGHT_SPEED_M_PER_S)
    }

    /// E₁/k in K, so that the lower level's Boltzmann factor is e^{−this/T}.
    pub fn lower_k(&self) -> f64 {
        self.lower_per_cm * KELVIN_PER_CM
    }

    /// e^{−E₁/kT}.
    fn lower_share(&self, temperature_k: f64) -> f64 {
        // The ground level is full at any temperature: at 0 K the quotient would be 0/0.
        if self.lower_per_cm == 0.0 {
            1.0
        } else {
            (-self.lower_k() / temperature_k).exp()
        }
    }

    /// Half width at half height γ, m.
    pub fn half_width_m(&self) -> f64 {
        let lambda_m = self.lambda_nm * METRES_PER_NM;
        HALF_WIDTH_PER_CM * PER_CM * lambda_m * lambda_m
    }
}

/// Whether a line falls into a bin of wavelengths: the lower end belongs to the bin, the upper one to the next, so that
/// a line on a border is counted once.
pub fn is_in_bin(lambda_nm: f64, [from_nm, to_nm]: [f64; 2]) -> bool {
    (from_nm..to_nm).contains(&lambda_nm)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::super::blackbody;
    use super::super::golden_csv::Table;
    use super::*;

    fn all() -> impl Iterator<Item = (&'static str, &'static Line)> {
        let species = [
            ("Li I", LITHIUM),
            ("Na I", SODIUM),
            ("K I", POTASSIUM),
            ("Ca I", CALCIUM),
            ("Sr I", STRONTIUM),
            ("Ba I", BARIUM),
            ("Cu I", COPPER),
        ];
        species
            .into_iter()
            .flat_map(|(name, lines)| lines.iter().map(move |line| (name, line)))
    }

    #[test]
    fn the_data_are_those_of_the_table() {
        let text = include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/golden/atomic_lines.csv"
        ));
        let mut compared = 0;
        for row in Table::parse(text).rows() {
            let nm = row.number("lambda_vac_nm");
            let Some((_, line)) = all().find(|(_, line)| line.lambda_nm == nm) else {
                assert_eq!(row.text("species"), "Tl I", "{nm} nm is missing");
                continue;
            };
            assert_eq!(line.rate_per_s, row.number("A_ki_s-1"));
            assert_eq!(
                line.degeneracies,
                [row.number("g_i"), row.number("g_k")],
                "{nm}"
            );
            assert_eq!(line.lower_per_cm, row.number("E_i_cm-1"));
            let fwhm_pm = 2.0 * line.half_width_m() * 1e12;
            let error = (fwhm_pm / row.number("lorentz_fwhm_pm_0.1cm-1") - 1.0).abs();
            assert!(error < 1e-3, "{nm}: {fwhm_pm} pm");
            compared += 1;
        }
        assert_eq!(compared, all().count());
    }

    #[test]
    fn strengths_agree_with_fifty_digit_arithmetic() {
        let text = include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/tests/golden/line_strength.csv"
        ));
        let mut compared = 0;
        for row in Table::parse(text).rows() {
            let (nm, kelvin) = (row.number("lambda_vac_nm"), row.number("T_K"));
            let atoms = row.number("N_total_m-3");
            let Some((_, line)) = all().find(|(_, line)| line.lambda_nm == nm) else {
                assert_eq!(row.text("species"), "Tl I");
                continue;
            };
            assert_eq!(line.partition, row.number("Q"), "{nm}");
            let lower = atoms * line.degeneracies[0] / line.partition * line.lower_share(kelvin);
            let near = |ours: f64, column: &str| {
                let error = (ours / row.number(column) - 1.0).abs();
                assert!(error < 1e-12, "{nm} nm, {kelvin} K, {column}: {error:e}");
            };
            let area = atoms * line.area_per_atom(kelvin);
            near(lower, "N1_m-3");
            near(area, "S_int_sigma_dlambda_dimensionless");
            near(area / 5e-9, "sigma_bin5nm_m-1");
            // S has metres of wavelength, Planck's radiance nanometres.
            let emitted = area / METRES_PER_NM * blackbody::spectral_radiance(nm, kelvin);
            near(emitted, "j_W_m-3_sr-1");
            compared += 1;
        }
        assert!(compared > 40, "only {compared} rows");
    }

    #[test]
    fn case_30_a_cold_line_absorbs_and_does_not_glow() {
        for (name, line) in all() {
            for kelvin in [0.0, 1e-3, 1.0] {
                let area = line.area_per_atom(kelvin);
                let emitted = area * blackbody::spectral_radiance(line.lambda_nm, kelvin);
                assert_eq!(emitted, 0.0, "{name}");
                let expected = if line.lower_per_cm == 0.0 {
                    line.cold_area_per_atom()
                } else {
                    0.0
                };
                assert_eq!(area, expected, "{name} at {kelvin} K");
            }
        }
    }

    #[test]
    fn case_31_at_endless_heat_absorption_goes_to_zero_as_x() {
        for (name, line) in all() {
            let area = line.area_per_atom(1e15);
            let x = SECOND_RADIATION_CONSTANT_NM_K / (line.lambda_nm * 1e15);
            let error = (area / (line.cold_area_per_atom() * x) - 1.0).abs();
            assert!(error < 1e-9, "{name}: {error:e}");
        }
    }

    #[test]
    fn case_32_a_line_on_a_border_is_in_one_bin() {
        let bins = [[585.0, 590.0], [590.0, 595.0]];
        assert_eq!(bins.map(|bin| is_in_bin(590.0, bin)), [false, true]);
        let count = (0..100)
            .filter(|i| {
                is_in_bin(
                    590.0,
                    [380.0 + 5.0 * f64::from(*i), 385.0 + 5.0 * f64::from(*i)],
                )
            })
            .count();
        assert_eq!(count, 1);
    }

    #[test]
    fn a_third_of_a_ppm_of_sodium_is_thick_after_some_millimetres() {
        let atoms = number_density(0.3e-6, ATMOSPHERE_PA, 2000.0);
        let line = &SODIUM[0];
        let depth_per_m = atoms * line.area_per_atom(2000.0) / (PI * line.half_width_m());
        assert!((1.0 / depth_per_m - 0.004).abs() < 0.002, "{depth_per_m}");
    }
}
