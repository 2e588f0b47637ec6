//! How a person moves a camera: around its target, sideways, nearer and further, and back to all of the flame.
//!
//! Every move is a pure function of the camera: no state, so the same drag gives the same camera.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::camera::{Camera, FRAMING_MARGIN, room_of};
use crate::math::Aabb;

/// How close an orbit comes to a pole, degrees. At the pole itself `up` lies along the line of sight and says
/// nothing; beyond it the picture would stand on its head. A tenth of a degree cannot be seen in a view from above.
const POLE_GAP_DEG: f64 = 0.1;

/// Least and greatest distance of a dolly, metres: a tenth of the smallest voxel that a file may have, where eye and
/// target are still apart in coordinates of kilometres; and from where a thousand of the largest voxels are a speck.
const DISTANCE_M: [f64; 2] = [1e-7, 1e9];

/// Smallest cosine between the line of sight, or up, and an axis along which they count as lying.
const ALONG: f64 = 1.0 - 1e-12;

impl Camera {
    /// Turned about the target as on a turntable whose axis is `up` (the world's z unless another was set): by
    /// `yaw` radians counter-clockwise seen from above, and raised by `pitch` radians.
    ///
    /// Distance, target, `up`, roll and field of view stay. The height over the target ends a tenth of a degree short of
    /// the poles, so the picture neither rolls nor turns over.
    #[must_use]
    pub fn orbited(&self, yaw: f64, pitch: f64) -> Self {
        let axis = self.up.try_normalize().unwrap_or(DVec3::Z);
        let from_target = self.eye - self.target;
        let height = from_target.dot(axis);
        let sideways = from_target - height * axis;
        let radial = sideways
            .try_normalize()
            .unwrap_or_else(|| axis.any_orthonormal_vector());
        let turned = yaw.cos() * radial + yaw.sin() * axis.cross(radial);
        let elevation = short_of_poles(height.atan2(sideways.length()) + pitch);
        self.placed(elevation.cos() * turned + elevation.sin() * axis)
    }

    /// Seen from another side, upright: `azimuth` radians from the front (which looks along +y) counter-clockwise
    /// seen from above, so a quarter turn is the view from the right; `elevation` radians above the horizon, which
    /// ends a tenth of a degree short of the poles. Distance, target and field of view stay; up is z, without a roll.
    #[must_use]
    pub fn seen_from(&self, azimuth: f64, elevation: f64) -> Self {
        let elevation = short_of_poles(elevation);
        let radial = DVec3::new(azimuth.sin(), -azimuth.cos(), 0.0);
        Self {
            up: DVec3::Z,
            roll_deg: 0.0,
            ..self.placed(elevation.cos() * radial + elevation.sin() * DVec3::Z)
        }
    }

    /// Eye and target moved in the plane of the picture, to the right and upwards, by these shares of the height
    /// that the picture has at the target's distance: `panned(-x, y)` lets a point at the target's depth follow a
    /// pointer that moves right by `x` and down by `y` picture heights.
    ///
    /// A camera that cannot see stays where it is.
    #[must_use]
    pub fn panned(&self, right: f64, up: f64) -> Self {
        let Ok([forward, rightwards, upwards]) = self.basis() else {
            return *self;
        };
        let distance = (self.target - self.eye).dot(forward);
        let height = 2.0 * distance * (0.5 * self.fov_deg).to_radians().tan();
        let by = height * (right * rightwards + up * upwards);
        Self {
            eye: self.eye + by,
            target: self.target + by,
            ..*self
        }
    }

    /// Nearer to the target (`factor` below 1) or further away. The distance stays within 0.1 µm and a million km,
    /// or where it was if it began outside.
    #[must_use]
    pub fn dollied(&self, factor: f64) -> Self {
        let from_target = self.eye - self.target;
        let distance = from_target.length();
        let [nearest, furthest] = DISTANCE_M;
        let wanted = (distance * factor).clamp(nearest.min(distance), furthest.max(distance));
        // Also keeps a camera without a direction, and a factor that is not a number, from spoiling the eye.
        if distance > 0.0 && wanted > 0.0 {
            Self {
                eye: self.target + from_target * (wanted / distance),
                ..*self
            }
        } else {
            *self
        }
    }

    /// Moved so that it sees all of a box in a picture of the given width/height, from the side it looks from.
    /// Direction, up and field of view stay; the target is the middle of the box.
    ///
    /// A camera that cannot see stays where it is.
    #[must_use]
    pub fn framed(&self, bounds: &Aabb, aspect: f64) -> Self {
        let Ok([forward, right, up]) = self.basis() else {
            return *self;
        };
        let (centre, size) = room_of(bounds);
        let half_height = (0.5 * self.fov_deg).to_radians().tan();
        let half_width = half_height * aspect;
        let room = Aabb {
            min: -0.5 * size,
            max: 0.5 * size,
        };
        // A corner at `depth` behind the middle is inside if its offset is within the picture's half side at
        // `distance + depth`.
        let distance_for = |corner: DVec3| {
            let across = corner.dot(right).abs() / half_width;
            let upwards = corner.dot(up).abs() / half_height;
            FRAMING_MARGIN * across.max(upwards) - corner.dot(forward)
        };
        let distance = room.corners().map(distance_for).fold(0.0, f64::max);
        Self {
            eye: centre - distance * forward,
            target: centre,
            ..*self
        }
    }

    /// Whether it looks as [`Camera::framing`] does, rolled or not: along +y, z up.
    pub fn is_at_the_front(&self) -> bool {
        let along = |vector: DVec3, axis: DVec3| vector.normalize_or_zero().dot(axis) > ALONG;
        along(self.target - self.eye, DVec3::Y) && along(self.up, DVec3::Z)
    }

    /// The eye in another direction from the target, at the same distance.
    fn placed(&self, from_target: DVec3) -> Self {
        Self {
            eye: self.target + (self.eye - self.target).length() * from_target,
            ..*self
        }
    }
}

fn short_of_poles(elevation: f64) -> f64 {
    let highest = FRAC_PI_2 - POLE_GAP_DEG.to_radians();
    elevation.clamp(-highest, highest)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
    use super::*;

    const CAMERA: Camera = Camera {
        eye: DVec3::new(1.0, -4.0, 2.0),
        target: DVec3::new(1.0, 1.0, 2.0),
        up: DVec3::Z,
        fov_deg: 32.0,
        roll_deg: 0.0,
    };

    fn distance(camera: &Camera) -> f64 {
        (camera.eye - camera.target).length()
    }

    #[test]
    fn an_orbit_follows_the_circle() {
        let quarter = CAMERA.orbited(FRAC_PI_2, 0.0);
        assert!(quarter.eye.abs_diff_eq(DVec3::new(6.0, 1.0, 2.0), 1e-12));
        let raised = CAMERA.orbited(0.0, 30_f64.to_radians());
        let wanted = DVec3::new(1.0, 1.0 - 5.0 * 0.75_f64.sqrt(), 2.0 + 2.5);
        assert!(raised.eye.abs_diff_eq(wanted, 1e-12));
        for camera in [quarter, raised] {
            assert!((distance(&camera) - 5.0).abs() < 1e-12);
            assert_eq!((camera.target, camera.up), (CAMERA.target, CAMERA.up));
        }
    }

    #[test]
    fn an_orbit_stops_short_of_the_poles_and_turns_back_the_same_way() {
        for side in [-1.0, 1.0] {
            let mut camera = CAMERA;
            for _ in 0..100 {
                camera = camera.orbited(0.3, side * 0.1);
            }
            let height = (camera.eye - camera.target).z / distance(&camera);
            let gap = 90.0 - height.abs().asin().to_degrees();
            assert!((gap - POLE_GAP_DEG).abs() < 1e-6, "{gap}");
            assert!(height * side > 0.0);
            assert!(camera.view([64, 64]).is_ok());
            // No turning over: the azimuth is what the yaws add up to.
            let azimuth = (camera.eye - camera.target).truncate();
            let wanted = (-FRAC_PI_2 + 30.0).sin_cos();
            let wanted = glam::DVec2::new(wanted.1, wanted.0);
            assert!(azimuth.normalize().abs_diff_eq(wanted, 1e-9));
        }
    }

    #[test]
    fn an_orbit_turns_about_another_up() {
        let camera = Camera {
            eye: DVec3::new(0.0, 0.0, 3.0),
            target: DVec3::ZERO,
            up: DVec3::new(0.0, 2.0, 0.0),
            fov_deg: 50.0,
            roll_deg: 0.0,
        };
        let turned = camera.orbited(FRAC_PI_2, 0.0);
        assert!(turned.eye.abs_diff_eq(DVec3::new(3.0, 0.0, 0.0), 1e-12));
        let over = camera.orbited(0.0, 9.0);
        assert!(over.eye.y > 2.999 && over.view([8, 8]).is_ok());
    }

    #[test]
    fn the_sides_are_where_a_person_looks_for_them() {
        let side = |azimuth: f64, elevation: f64| {
            let camera = CAMERA.seen_from(azimuth.to_radians(), elevation.to_radians());
            assert!((distance(&camera) - 5.0).abs() < 1e-12);
            (camera.eye - camera.target) / 5.0
        };
        assert!(side(0.0, 0.0).abs_diff_eq(DVec3::NEG_Y, 1e-12));
        assert!(side(90.0, 0.0).abs_diff_eq(DVec3::X, 1e-12));
        assert!(side(180.0, 0.0).abs_diff_eq(DVec3::Y, 1e-12));
        assert!(side(0.0, 90.0).abs_diff_eq(DVec3::Z, 2e-3));
        // From above, up in the picture is away from the front.
        let above = CAMERA.seen_from(0.0, FRAC_PI_2);
        let [_, right, up] = above.basis().unwrap();
        assert!(right.abs_diff_eq(DVec3::X, 1e-9) && up.abs_diff_eq(DVec3::Y, 2e-3));
        assert!(CAMERA.is_at_the_front() && CAMERA.seen_from(0.0, 0.0).is_at_the_front());
        assert!(!CAMERA.orbited(0.001, 0.0).is_at_the_front());
    }

    #[test]
    fn a_roll_turns_the_picture_about_its_middle_and_stays_in_an_orbit() {
        let rolled = Camera {
            roll_deg: 90.0,
            ..CAMERA
        };
        // Turned clockwise by a quarter, its right is what was below.
        let [forward, right, up] = rolled.basis().unwrap();
        assert!(forward.abs_diff_eq(DVec3::Y, 1e-12));
        assert!(right.abs_diff_eq(DVec3::NEG_Z, 1e-12) && up.abs_diff_eq(DVec3::X, 1e-12));
        let [plain, turned] = [CAMERA, rolled].map(|camera| camera.view([200, 200]).unwrap());
        let same = turned.ray(130.0, 100.0).direction;
        assert!(plain.ray(100.0, 130.0).direction.abs_diff_eq(same, 1e-12));
        // Drags go on to move what is under the pointer, and the sides are upright.
        assert_eq!(rolled.orbited(0.3, 0.2).roll_deg, 90.0);
        assert_eq!(rolled.seen_from(0.0, 0.0).roll_deg, 0.0);
    }

    #[test]
    fn a_pan_keeps_a_point_at_the_targets_depth_under_the_pointer() {
        let camera = CAMERA.orbited(0.7, 0.4);
        let size = [300, 200];
        let before = camera.view(size).unwrap();
        // The pointer goes 30 pixels right and 12 down: what was under it shall be there again.
        let (from, to) = ([90.0, 60.0], [120.0, 72.0]);
        let after = camera.panned(-30.0 / 200.0, 12.0 / 200.0);
        let [forward, ..] = camera.basis().unwrap();
        let ray = before.ray(from[0], from[1]);
        let point = ray.at(5.0 / ray.direction.dot(forward));
        let again = after.view(size).unwrap().ray(to[0], to[1]);
        assert!(
            (point - again.origin)
                .normalize()
                .abs_diff_eq(again.direction, 1e-12)
        );
        assert!((distance(&after) - 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_dolly_scales_the_distance_within_bounds() {
        assert!((distance(&CAMERA.dollied(0.5)) - 2.5).abs() < 1e-12);
        assert!(
            CAMERA
                .dollied(2.0)
                .eye
                .abs_diff_eq(DVec3::new(1.0, -9.0, 2.0), 1e-12)
        );
        let many = |factor: f64| (0..10_000).fold(CAMERA, |camera, _| camera.dollied(factor));
        assert!((distance(&many(0.9)) / DISTANCE_M[0] - 1.0).abs() < 1e-6);
        assert!((distance(&many(1.1)) / DISTANCE_M[1] - 1.0).abs() < 1e-6);
        assert!(many(0.9).view([8, 8]).is_ok() && many(1.1).view([8, 8]).is_ok());
        for odd in [f64::NAN, -1.0, f64::INFINITY] {
            assert!(CAMERA.dollied(odd).view([8, 8]).is_ok(), "{odd}");
        }
    }

    #[test]
    fn a_framed_box_fills_the_picture_up_to_the_margin() {
        let bounds = Aabb {
            min: DVec3::new(-1.0, 2.0, 0.0),
            max: DVec3::new(0.5, 3.0, 4.0),
        };
        for fov_deg in [5.0, 32.0, 120.0] {
            for (yaw, pitch) in [(0.0, 0.0), (0.6, 0.5), (2.5, -1.2), (0.0, 9.0)] {
                for aspect in [0.3, 1.0, 16.0 / 9.0] {
                    let from = Camera { fov_deg, ..CAMERA }.orbited(yaw, pitch);
                    let camera = from.framed(&bounds, aspect);
                    let [forward, right, up] = camera.basis().unwrap();
                    assert!(forward.abs_diff_eq(from.basis().unwrap()[0], 1e-12));
                    let half = (0.5 * fov_deg).to_radians().tan();
                    let reaches = bounds.corners().map(|corner| {
                        let to = corner - camera.eye;
                        let depth = to.dot(forward);
                        assert!(depth > 0.0);
                        let across = to.dot(right).abs() / (depth * half * aspect);
                        across.max(to.dot(up).abs() / (depth * half))
                    });
                    let reach = reaches.fold(0.0, f64::max);
                    assert!((reach * FRAMING_MARGIN - 1.0).abs() < 1e-9, "{reach}");
                }
            }
        }
        let front = CAMERA.framed(&bounds, 1.5);
        let framing = Camera::framing(&bounds, 1.5, CAMERA.fov_deg);
        assert!(front.eye.abs_diff_eq(framing.eye, 1e-12));
    }

    #[test]
    fn nothing_to_frame_still_gives_a_camera_that_sees() {
        for bounds in [
            Aabb::EMPTY,
            Aabb {
                min: DVec3::ONE,
                max: DVec3::ONE,
            },
        ] {
            assert!(CAMERA.framed(&bounds, 1.0).view([8, 8]).is_ok());
        }
    }
}
