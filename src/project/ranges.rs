//! What every number may be, in one place: the scene file, the command line and the window's controls read it.

pub use crate::render::STEP_RANGE as STEP_VOXELS;
pub use crate::scene::camera::FOV_RANGE_DEG as FOV_DEG;
pub use crate::volume::MEMORY_LIMIT_MB;

/// `camera.roll_deg`: a whole turn.
pub const ROLL_DEG: [f64; 2] = [-180.0, 180.0];
/// `soot.radius_nm`: from single spheres of the smallest flames to aggregates thought of as spheres.
pub const SOOT_RADIUS_NM: [f64; 2] = [1.0, 100.0];
/// `soot.amount`, `smoke.amount` and `fuel.blue_glow`.
pub const AMOUNT: [f64; 2] = [0.0, 1e4];
/// `fuel.salt_ppm`: up to a tenth of the gas.
pub const SALT_PPM: [f64; 2] = [0.0, 1e5];
/// `render.target_error`, ΔE_ITP: from what no eye sees to another picture.
pub const TARGET_ERROR: [f64; 2] = [0.01, 100.0];
/// `air.temperature_k`.
pub const AIR_TEMPERATURE_K: [f64; 2] = [200.0, 400.0];
/// `soot.asymmetry`: short of light that is not scattered at all.
pub const ASYMMETRY: [f64; 2] = [-0.99, 0.99];
/// `smoke.albedo`: short of smoke that takes nothing.
pub const ALBEDO: [f64; 2] = [0.0, 0.99];
/// `air.pressure_pa`: from thirty kilometres up to ten atmospheres, where the equation of state ends.
pub const PRESSURE_PA: [f64; 2] = [1e3, crate::physics::moist_air::HIGHEST_PRESSURE_PA];
/// `air.refraction_gain`: nature's and more, for the eye.
pub const REFRACTION_GAIN: [f64; 2] = [1.0, 20.0];
/// Positions on the stage, m, and `stage.ground_height_m`.
pub const STAGE_POSITION_M: [f64; 2] = [-1e6, 1e6];
/// Radii, squares and distances on the stage, m.
pub const STAGE_LENGTH_M: [f64; 2] = [1e-6, 1e6];
/// Most spheres, and most logs: each is tried by each ray.
pub const MOST_SHAPES: usize = 256;
/// Each channel of a colour on the stage, linear: nothing sends back more than falls on it.
pub const COLOUR: [f64; 2] = [0.0, 1.0];
/// `stage.backdrop_luminance_cd_m2`: up to the sun.
pub const BACKDROP_CD_M2: [f64; 2] = [0.0, 1e9];
/// `air.humidity`, from dry to saturated.
pub const HUMIDITY: [f64; 2] = [0.0, 1.0];
/// `air.co2_ppm`: what Ciddor's equation (1996) was made for.
pub const CO2_PPM: [f64; 2] = [0.0, 2000.0];
/// `view.exposure_ev`.
pub const EXPOSURE_EV: [f64; 2] = [-20.0, 20.0];
/// `view.adaptation`.
pub const ADAPTATION: [f64; 2] = [0.0, 1.0];
/// `view.white_k`: from an ember to the bluest sky.
pub const WHITE_K: [f64; 2] = [1000.0, 20_000.0];
/// `view.display_white_cd_m2`: from moonlight to a black body of 100 000 K and beyond.
pub const DISPLAY_WHITE_CD_M2: [f64; 2] = [1e-3, 1e15];
/// Each of `view.white_xy`: short of colours without any.
pub const WHITE_XY: [f64; 2] = [1e-3, 1.0];
/// `view.half_saturation_cd_m2`: from moonlight to the sun.
pub const HALF_SATURATION_CD_M2: [f64; 2] = [1e-3, 1e9];
/// `volume.voxel_size_m`.
pub const VOXEL_SIZE_M: [f64; 2] = [1e-6, 1e4];
