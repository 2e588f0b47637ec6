//! In which ways a picture is rendered for a report: one number after another around the choice for stills, and the choices
//! that are the cheapest for their error.

use super::numbers::{Numbers, RAYS, STEPS};
use crate::render::plan::Effect;
use crate::scene::{Interpolation, WavelengthSet};

/// What a variant tells of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Family {
    /// Steps of all lengths, all else as chosen for stills.
    Step,
    /// All sets of wavelengths.
    Wavelengths,
    /// All counts of rays.
    Samples,
    /// All ways to form values between voxels: other pictures, not only less exact ones.
    Interpolation,
    /// One effect switched the other way.
    Effects,
    /// Coefficients summed over X, Y and Z before the march, which others call RGB rendering.
    Baked,
    /// Numbers chosen together.
    Chosen,
}

impl Family {
    /// All of them, in the order of tables and charts.
    pub const ALL: [Self; 7] = [
        Self::Chosen,
        Self::Step,
        Self::Wavelengths,
        Self::Samples,
        Self::Interpolation,
        Self::Effects,
        Self::Baked,
    ];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Wavelengths => "wavelengths",
            Self::Samples => "samples",
            Self::Interpolation => "interpolation",
            Self::Effects => "effects",
            Self::Baked => "baked-rgb",
            Self::Chosen => "chosen",
        }
    }

    /// The name in charts, for a person.
    pub fn title(self) -> &'static str {
        match self {
            Self::Step => "Step size",
            Self::Wavelengths => "Wavelengths",
            Self::Samples => "Rays a pixel",
            Self::Interpolation => "Between voxels",
            Self::Effects => "An effect switched",
            Self::Baked => "RGB instead of spectra",
            Self::Chosen => "Chosen together",
        }
    }
}

/// One way to render a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// What it tells of.
    pub family: Family,
    /// How exactly.
    pub numbers: Numbers,
    /// How values between voxels are formed.
    pub interpolation: Interpolation,
    /// The effect that is switched the other way than the plan has it.
    pub switched: Option<Effect>,
}

impl Variant {
    /// In words: "step 2, 6 wavelengths, 1 ray".
    pub fn in_words(&self) -> String {
        let numbers = self.numbers.in_words();
        match (self.family, self.switched) {
            (Family::Interpolation, _) => format!("{}: {numbers}", self.interpolation.name()),
            (Family::Baked, _) => format!(
                "RGB: step {}, {} rays",
                self.numbers.step_voxels, self.numbers.samples_per_pixel
            ),
            (_, Some(effect)) => format!("{} switched: {numbers}", effect.name()),
            _ => numbers,
        }
    }
}

/// Steps that are tried with coefficients baked to three numbers, voxels.
const BAKED_STEPS: [f64; 3] = [2.0, 1.0, 0.5];

/// All variants around the numbers for stills, the most telling first: those `chosen` together, then each number by itself.
pub(super) fn variants(
    still: Numbers,
    interpolation: Interpolation,
    chosen: &[Numbers],
    effects: &[Effect],
) -> Vec<Variant> {
    let of = |family: Family, numbers: Numbers| Variant {
        family,
        numbers,
        interpolation,
        switched: None,
    };
    let chosen = chosen.iter().map(|numbers| of(Family::Chosen, *numbers));
    let steps = STEPS.into_iter().map(|step_voxels| {
        let numbers = Numbers {
            step_voxels,
            ..still
        };
        of(Family::Step, numbers)
    });
    let sets = WavelengthSet::ALL.into_iter().map(|wavelengths| {
        let numbers = Numbers {
            wavelengths,
            ..still
        };
        of(Family::Wavelengths, numbers)
    });
    let rays = RAYS.into_iter().map(|samples_per_pixel| {
        let numbers = Numbers {
            samples_per_pixel,
            ..still
        };
        of(Family::Samples, numbers)
    });
    let between = Interpolation::ALL.into_iter().map(|interpolation| Variant {
        interpolation,
        ..of(Family::Interpolation, still)
    });
    let effects = effects.iter().map(|&effect| Variant {
        switched: Some(effect),
        ..of(Family::Effects, still)
    });
    let baked = BAKED_STEPS.into_iter().map(|step_voxels| {
        let numbers = Numbers {
            step_voxels,
            ..still
        };
        of(Family::Baked, numbers)
    });
    let all = chosen.chain(steps).chain(sets).chain(rays);
    all.chain(between).chain(effects).chain(baked).collect()
}
