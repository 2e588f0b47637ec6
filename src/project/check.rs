//! Whether every number of a project lies in its range.

use super::error::ProjectError;
use super::ranges;
use super::settings::Project;
use crate::scene::camera::FRAMING_FOV_DEG;

impl Project {
    /// Checks every number that can be judged without a volume.
    ///
    /// # Errors
    /// [`ProjectError`] names the key, its value and its range.
    pub fn check(&self) -> Result<(), ProjectError> {
        self.check_ranges()?;
        for view in &self.camera.views {
            view.camera().view([1, 1])?;
        }
        self.settings(self.render.size)?;
        Ok(())
    }

    /// Checks every number that has a range of its own.
    ///
    /// # Errors
    /// As [`Project::check`].
    pub(super) fn check_ranges(&self) -> Result<(), ProjectError> {
        let [white_x, white_y] = self.view.white_xy.unwrap_or([0.5; 2]);
        let numbers = [
            (
                "soot.radius_nm",
                self.soot.radius_nm,
                ranges::SOOT_RADIUS_NM,
            ),
            ("soot.amount", self.soot.amount, ranges::AMOUNT),
            (
                "soot.asymmetry",
                self.soot.asymmetry.unwrap_or(0.0),
                ranges::ASYMMETRY,
            ),
            ("smoke.amount", self.smoke.amount, ranges::AMOUNT),
            ("smoke.albedo", self.smoke.albedo, ranges::ALBEDO),
            ("fuel.salt_ppm", self.fuel.salt_ppm, ranges::SALT_PPM),
            ("fuel.blue_glow", self.fuel.blue_glow, ranges::AMOUNT),
            (
                "air.temperature_k",
                self.air.temperature_k,
                ranges::AIR_TEMPERATURE_K,
            ),
            ("air.pressure_pa", self.air.pressure_pa, ranges::PRESSURE_PA),
            ("air.humidity", self.air.humidity, ranges::HUMIDITY),
            ("air.co2_ppm", self.air.co2_ppm, ranges::CO2_PPM),
            (
                "air.refraction_gain",
                self.air.refraction_gain,
                ranges::REFRACTION_GAIN,
            ),
            (
                "render.target_error",
                self.render
                    .target_error
                    .unwrap_or_else(|| self.render.quality.target_de()),
                ranges::TARGET_ERROR,
            ),
            (
                "camera.fov_deg",
                self.camera.fov_deg.unwrap_or(FRAMING_FOV_DEG),
                ranges::FOV_DEG,
            ),
            (
                "camera.roll_deg",
                self.camera.roll_deg.unwrap_or(0.0),
                ranges::ROLL_DEG,
            ),
            (
                "view.exposure_ev",
                self.view.exposure_ev,
                ranges::EXPOSURE_EV,
            ),
            ("view.adaptation", self.view.adaptation, ranges::ADAPTATION),
            (
                "view.white_k",
                self.view.white_k.unwrap_or(ranges::WHITE_K[0]),
                ranges::WHITE_K,
            ),
            (
                "view.display_white_cd_m2",
                self.view.display_white_cd_m2.unwrap_or(1.0),
                ranges::DISPLAY_WHITE_CD_M2,
            ),
            ("view.white_xy", white_x, ranges::WHITE_XY),
            ("view.white_xy", white_y, ranges::WHITE_XY),
            (
                "view.half_saturation_cd_m2",
                self.view.half_saturation_cd_m2.unwrap_or(1.0),
                ranges::HALF_SATURATION_CD_M2,
            ),
            (
                "volume.voxel_size_m",
                self.volume.voxel_size_m.unwrap_or(1.0),
                ranges::VOXEL_SIZE_M,
            ),
            (
                "volume.memory_limit_mb",
                self.volume
                    .memory_limit_mb
                    .unwrap_or(ranges::MEMORY_LIMIT_MB[0]),
                ranges::MEMORY_LIMIT_MB,
            ),
        ];
        match numbers
            .into_iter()
            .find(|(_, value, [min, max])| !(*min..=*max).contains(value))
        {
            Some((key, value, [min, max])) => Err(ProjectError::Range {
                key,
                value,
                min,
                max,
            }),
            None => self.stage.check(),
        }
    }
}
