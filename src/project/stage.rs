//! From what a person set to what stands around the fire.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use super::backdrops::Backdrops;
use super::error::ProjectError;
use super::ranges::{BACKDROP_CD_M2, COLOUR, MOST_SHAPES, STAGE_LENGTH_M, STAGE_POSITION_M};
use super::settings::{BackdropKind, StageSettings};
use crate::math::Aabb;
use crate::scene::stage::{Backdrop, Ground, Log, Pattern, Sphere};
use crate::scene::{Camera, Stage};

/// Squares of a checker that fill the height of the frame.
const SQUARES_IN_HEIGHT: f64 = 12.0;
/// Distance of the backdrop in largest sides of the fire: far enough that what is bent has room to move.
const DISTANCE_IN_FIRES: f64 = 2.0;

/// What a stage takes where nothing is set: from the fire's size and the camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageDefaults {
    /// The box of the fire, m; of 1 m about the origin where there is none.
    pub fire: Aabb,
    /// z of the ground, m.
    pub ground_height_m: f64,
    /// Distance of the backdrop behind the camera's target, m.
    pub backdrop_distance_m: f64,
    /// Edge of a checker's square, m, at the backdrop's distance as it is set.
    pub backdrop_square_m: f64,
}

impl StageDefaults {
    /// x, y, z and radius of a sphere beside the fire, towards a camera in front, on its ground, m.
    pub fn sphere(&self) -> [f64; 4] {
        let (centre, length) = (self.fire.centre(), self.log_length_m());
        let radius = length / 8.0;
        [
            centre.x + 0.7 * length,
            centre.y - 0.3 * length,
            self.ground_height_m + radius,
            radius,
        ]
    }

    /// Two logs that cross under the middle of the fire, one on the ground and one that leans on it: both ends and the
    /// radius, m.
    pub fn logs(&self) -> [[f64; 7]; 2] {
        let (centre, length) = (self.fire.centre(), self.log_length_m());
        let radius = length / 16.0;
        // A quarter turn between them, seen from above.
        let [dx, dy] = [0.5 * length * FRAC_1_SQRT_2; 2];
        let z = self.ground_height_m + radius;
        let log = |[from_y, to_y]: [f64; 2], to_z| {
            [
                centre.x - dx,
                centre.y + from_y,
                z,
                centre.x + dx,
                centre.y + to_y,
                to_z,
                radius,
            ]
        };
        // Where they cross, the middle lines are two radii apart: the far end is twice as high above the near one.
        [log([-dy, dy], z), log([dy, -dy], z + 4.0 * radius)]
    }

    /// A length that suits the fire: its width, but not less than a third of its height.
    fn log_length_m(&self) -> f64 {
        let size = self.fire.size();
        size.x.max(size.y).max(size.z / 3.0)
    }
}

impl StageSettings {
    /// Sets a ground, crossed logs and a sphere, fitted to the fire, in place of what stands here.
    pub fn set_logs_and_a_sphere(&mut self, defaults: &StageDefaults) {
        self.ground = true;
        self.ground_height_m = None;
        self.logs = defaults.logs().to_vec();
        self.spheres = vec![defaults.sphere()];
    }

    /// What this stage takes where nothing is set, around a fire's box.
    pub fn defaults(&self, fire: &Aabb, camera: &Camera) -> StageDefaults {
        let fire = if fire.is_empty() {
            Aabb {
                min: DVec3::splat(-0.5),
                max: DVec3::splat(0.5),
            }
        } else {
            *fire
        };
        let [least, most] = STAGE_LENGTH_M;
        let backdrop_distance_m =
            (DISTANCE_IN_FIRES * fire.size().max_element()).clamp(least, most);
        let distance_m = self.backdrop_distance_m.unwrap_or(backdrop_distance_m);
        let from_eye_m = camera.target.distance(camera.eye) + distance_m;
        let frame_m = 2.0 * from_eye_m * (0.5 * camera.fov_deg).to_radians().tan();
        StageDefaults {
            fire,
            ground_height_m: fire.min.z,
            backdrop_distance_m,
            backdrop_square_m: (frame_m / SQUARES_IN_HEIGHT).clamp(least, most),
        }
    }

    /// The stage that these settings ask for.
    ///
    /// # Errors
    /// The backdrop's picture cannot be had.
    pub(super) fn stage(
        &self,
        defaults: &StageDefaults,
        backdrops: &mut Backdrops,
    ) -> Result<Stage, ProjectError> {
        let pattern = match self.backdrop {
            BackdropKind::None => None,
            BackdropKind::Checker => Some(Pattern::Checker {
                square_m: self.backdrop_square_m.unwrap_or(defaults.backdrop_square_m),
            }),
            BackdropKind::Gradient => Some(Pattern::Gradient),
            BackdropKind::Picture => {
                let path = self.backdrop_picture.as_ref();
                let path = path.ok_or(ProjectError::NoPicture)?;
                Some(Pattern::Picture(backdrops.read(path)?))
            }
        };
        let distance_m = self
            .backdrop_distance_m
            .unwrap_or(defaults.backdrop_distance_m);
        Ok(Stage {
            ground: self.ground.then(|| Ground {
                height_m: self.ground_height_m.unwrap_or(defaults.ground_height_m),
                colour: self.ground_colour,
            }),
            spheres: self
                .spheres
                .iter()
                .map(|&[x, y, z, radius_m]| Sphere {
                    centre: DVec3::new(x, y, z),
                    radius_m,
                    colour: self.sphere_colour,
                })
                .collect(),
            logs: self
                .logs
                .iter()
                .map(|&[x0, y0, z0, x1, y1, z1, radius_m]| Log {
                    ends: [DVec3::new(x0, y0, z0), DVec3::new(x1, y1, z1)],
                    radius_m,
                    colour: self.log_colour,
                })
                .collect(),
            backdrop: pattern.map(|pattern| Backdrop {
                pattern,
                distance_m,
                luminance_cd_m2: self.backdrop_luminance_cd_m2,
            }),
        })
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`ProjectError`] names the key, its value and its range.
    pub(super) fn check(&self) -> Result<(), ProjectError> {
        let range = |key, value: f64, [min, max]: [f64; 2]| {
            let fits = (min..=max).contains(&value);
            fits.then_some(()).ok_or(ProjectError::Range {
                key,
                value,
                min,
                max,
            })
        };
        range(
            "stage.ground_height_m",
            self.ground_height_m.unwrap_or(0.0),
            STAGE_POSITION_M,
        )?;
        range(
            "stage.backdrop_distance_m",
            self.backdrop_distance_m.unwrap_or(1.0),
            STAGE_LENGTH_M,
        )?;
        range(
            "stage.backdrop_square_m",
            self.backdrop_square_m.unwrap_or(1.0),
            STAGE_LENGTH_M,
        )?;
        range(
            "stage.backdrop_luminance_cd_m2",
            self.backdrop_luminance_cd_m2,
            BACKDROP_CD_M2,
        )?;
        for (key, colour) in [
            ("stage.ground_colour", self.ground_colour),
            ("stage.sphere_colour", self.sphere_colour),
            ("stage.log_colour", self.log_colour),
        ] {
            colour
                .into_iter()
                .try_for_each(|channel| range(key, channel, COLOUR))?;
        }
        check_shapes("stage.spheres", "sphere", &self.spheres)?;
        check_shapes("stage.logs", "log", &self.logs)
    }
}

/// Checks a list of shapes, each some positions and last a radius.
fn check_shapes<const N: usize>(
    key: &'static str,
    name: &'static str,
    shapes: &[[f64; N]],
) -> Result<(), ProjectError> {
    if shapes.len() > MOST_SHAPES {
        return Err(ProjectError::TooManyShapes {
            key,
            count: shapes.len(),
        });
    }
    for (index, shape) in shapes.iter().enumerate() {
        for (at, &value) in shape.iter().enumerate() {
            let (what, [min, max]) = if at + 1 == N {
                ("radius", STAGE_LENGTH_M)
            } else {
                ("position", STAGE_POSITION_M)
            };
            if !(min..=max).contains(&value) {
                return Err(ProjectError::Shape {
                    key,
                    name,
                    number: index + 1,
                    what,
                    value,
                    min,
                    max,
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
