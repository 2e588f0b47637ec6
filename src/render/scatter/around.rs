//! The light that is scattered once, in any direction: what path tracing of higher orders takes up where it scatters.
//!
//! # How
//!
//! J is smooth over the sphere: of a wave of order l in the light that arrives, the phase function of Henyey and Greenstein
//! keeps g^l. So J is worked out towards the four corners of a tetrahedron, and read between them by the one linear function
//! of direction that has these values,
//!
//! ```text
//! J(ω) = ¼ Σ (1 + 3 dₖ·ω) Jₖ
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | Jₖ | what is scattered along dₖ for each unit of σ_s | W m⁻² sr⁻¹ nm⁻¹ |
//! | dₖ | unit vectors to the corners of a regular tetrahedron | 1 |
//! | ω | the direction asked for | 1 |
//!
//! which is right for the orders 0 and 1 and leaves out what there is of g² and beyond. Where all |g| are below
//! [`NEARLY_EVEN`] the mean over all directions stands for all of them.
//!
//! **Limits.** Where cells are a mean free path wide and more, J is smeared: in a white cloud ten mean free paths deep with
//! cells of 0.8, all orders from 2 to 16 together are 6 % too dim, the second 7 %.
//!
//! It is the last scattering before the fire alone that is so simplified; the others are drawn from the phase function.

use glam::DVec3;

use super::InScatter;
use super::gathered::Towards;
use crate::render::cells::Chunk;
use crate::render::null_collision::Around;
use crate::render::own_light::own_light;

/// Mean cosine up to which light is taken to be scattered evenly, that of spheres of soot 40 nm in diameter: J then changes
/// by no more than 15 % from one side to the other, and its mean over the directions of paths by far less.
const NEARLY_EVEN: f32 = 0.05;

/// Directions to the corners of a tetrahedron.
const CORNERS: [DVec3; 4] = {
    const A: f64 = 0.577_350_269_189_625_8;
    [
        DVec3::new(A, A, A),
        DVec3::new(A, -A, -A),
        DVec3::new(-A, A, -A),
        DVec3::new(-A, -A, A),
    ]
};

/// What has to be worked out where light is scattered so, after that to the eye.
pub(super) fn towards(asymmetry: &[Chunk]) -> Vec<Towards> {
    let mut towards = vec![Towards::Eye];
    if asymmetry.iter().flatten().all(|g| g.abs() <= NEARLY_EVEN) {
        towards.push(Towards::AllSides);
    } else {
        towards.extend(CORNERS.map(Towards::Direction));
    }
    towards
}

/// J in any direction.
#[derive(Debug)]
pub(in crate::render) struct AllAround {
    /// One for all, or one for each corner.
    fields: Vec<InScatter>,
}

impl AllAround {
    pub(super) fn new(fields: Vec<InScatter>) -> Self {
        Self { fields }
    }
}

impl Around for AllAround {
    fn read(
        &self,
        position: DVec3,
        direction: DVec3,
        [emission, extinction]: [&[f64]; 2],
        light: &mut [f64],
    ) {
        light.fill(0.0);
        let is_one = self.fields.len() == 1;
        let mut known = 0;
        for (field, corner) in self.fields.iter().zip(CORNERS) {
            if field.light.is_empty() {
                continue;
            }
            let weight = if is_one {
                1.0
            } else {
                0.25 * (1.0 + 3.0 * corner.dot(direction))
            };
            field.each(position.to_array(), |colour, value| {
                if let Some(light) = light.get_mut(colour) {
                    *light += weight * f64::from(value);
                }
            });
            known = field.counts[0] + field.counts[2];
        }
        let reach_m = self.fields.first().map_or(0.0, InScatter::reach_m);
        let here = emission.iter().zip(extinction);
        for (light, (&emission, &extinction)) in light.iter_mut().zip(here).take(known) {
            let own = own_light(emission as f32, extinction as f32, 1.0, reach_m);
            *light = (*light + f64::from(own)).max(0.0);
        }
    }
}
