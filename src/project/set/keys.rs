//! The one list of everything that can be set.

/// One key of the scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key {
    /// The dotted name.
    pub name: &'static str,
    /// What its value must be, with unit and range.
    pub expects: &'static str,
    /// What it does.
    pub meaning: &'static str,
}

const fn key(name: &'static str, expects: &'static str, meaning: &'static str) -> Key {
    Key {
        name,
        expects,
        meaning,
    }
}

const GRID: &str = "a grid's name, or \"\" for none";
const RAW_FACTOR: &str = "a number, physical units for one unit of the file";
const PHYSICAL: &str = "a number in physical units";
const SWITCH: &str = "auto, on or off";
const COLOUR: &str = "linear red, green and blue, each 0 to 1, such as [0.25, 0.22, 0.2]";
const POINT: &str = "three numbers in m, such as [0, -2, 0.5]";

/// Everything that a scene file can hold, in its order.
pub const KEYS: &[Key] = &[
    key(
        "volume.path",
        "a path or a list of paths",
        "the volume; a built-in flame if not set",
    ),
    key(
        "volume.built_in",
        "torch, burner or spirit",
        "which of the program's own flames is shown where there is no path",
    ),
    key(
        "volume.producer",
        "auto, blender, embergen, houdini or physical",
        "whose conventions the fields follow",
    ),
    key(
        "volume.up",
        "auto, y or z",
        "the file's axis that points up",
    ),
    key(
        "volume.voxel_size_m",
        "a number of m, 1e-6 to 1e4",
        "edge of a voxel; the file's own if not set",
    ),
    key(
        "volume.memory_limit_mb",
        "a number of MB (10⁶ bytes), 16 to 1000000",
        "memory for a file, for its grids and for what is packed of them, each; 4295 if not set",
    ),
    key(
        "volume.soot.grid",
        GRID,
        "glowing soot, mapped to a volume fraction",
    ),
    key(
        "volume.soot.scale",
        RAW_FACTOR,
        "physical = clamp(scale · raw + offset, min, max)",
    ),
    key("volume.soot.offset", PHYSICAL, "value of a raw zero"),
    key("volume.soot.min", PHYSICAL, "least value"),
    key("volume.soot.max", PHYSICAL, "greatest value"),
    key(
        "volume.smoke.grid",
        GRID,
        "smoke, soot beside the flame's own that glows where it is hot; mapped to a volume fraction",
    ),
    key(
        "volume.smoke.scale",
        RAW_FACTOR,
        "physical = clamp(scale · raw + offset, min, max)",
    ),
    key("volume.smoke.offset", PHYSICAL, "value of a raw zero"),
    key("volume.smoke.min", PHYSICAL, "least value"),
    key("volume.smoke.max", PHYSICAL, "greatest value"),
    key(
        "volume.flame.grid",
        GRID,
        "progress of the reaction, 0 to 1",
    ),
    key(
        "volume.flame.scale",
        RAW_FACTOR,
        "physical = clamp(scale · raw + offset, min, max)",
    ),
    key("volume.flame.offset", PHYSICAL, "value of a raw zero"),
    key("volume.flame.min", PHYSICAL, "least value"),
    key("volume.flame.max", PHYSICAL, "greatest value"),
    key("volume.temperature.grid", GRID, "temperature, mapped to K"),
    key(
        "volume.temperature.scale",
        RAW_FACTOR,
        "physical = clamp(scale · raw + offset, min, max)",
    ),
    key("volume.temperature.offset", PHYSICAL, "value of a raw zero"),
    key("volume.temperature.min", PHYSICAL, "least value"),
    key("volume.temperature.max", PHYSICAL, "greatest value"),
    key(
        "fuel.name",
        "propane, acetylene, methane, ethylene, methanol, wood, candle-wax or black-body",
        "what burns: whose soot it is, how much of it where the volume does not say, how blue it glows",
    ),
    key(
        "fuel.salt",
        "none, sodium, potassium, lithium, calcium, calcium-chloride, strontium, strontium-chloride, barium, \
         barium-chloride, copper or copper-chloride",
        "a salt in the fuel that colours the flame",
    ),
    key(
        "fuel.salt_ppm",
        "a number of ppm, 0 to 100000",
        "mole fraction of the salt's metal in the undiluted hot gas",
    ),
    key(
        "fuel.blue_glow",
        "a number, 0 to 10000",
        "multiplies the light of CH, C₂ and CO₂* where the flame field says that gas burns",
    ),
    key(
        "soot.radius_nm",
        "a number of nm, 1 to 100",
        "radius of a primary particle",
    ),
    key(
        "soot.amount",
        "a number, 0 to 10000",
        "multiplies the soot field",
    ),
    key(
        "soot.model",
        "chang, dalzell-sarofim, hottel-broughton or grey",
        "how absorption depends on wavelength",
    ),
    key(
        "soot.hold",
        "number or volume",
        "what stays when the radius changes",
    ),
    key(
        "soot.asymmetry",
        "a number, -0.99 to 0.99",
        "mean cosine of the scattering by soot and smoke; that of spheres of the radius if not set",
    ),
    key(
        "smoke.amount",
        "a number, 0 to 10000",
        "multiplies the smoke field",
    ),
    key(
        "smoke.albedo",
        "a number, 0 to 0.99",
        "share of what smoke takes from light that it scatters",
    ),
    key(
        "air.temperature_k",
        "a number of K, 200 to 400",
        "temperature where the volume has none, and around the fire",
    ),
    key(
        "air.pressure_pa",
        "a number of Pa, 1000 to 1000000",
        "pressure; bends light, which shows only before a backdrop or a stage",
    ),
    key(
        "air.humidity",
        "a number, 0 to 1",
        "relative humidity; bends light, which shows only before a backdrop or a stage",
    ),
    key(
        "air.saturation",
        "huang or davis",
        "whose saturation pressure says how much water the humidity is",
    ),
    key(
        "air.co2_ppm",
        "a number of ppm, 0 to 2000",
        "carbon dioxide; bends light, which shows only before a backdrop or a stage",
    ),
    key(
        "air.refraction_gain",
        "a number, 1 to 20",
        "multiplies how strongly hot gas bends light; 1 is nature's",
    ),
    key(
        "stage.ground",
        "true or false",
        "a level ground that the fire's light falls on",
    ),
    key(
        "stage.ground_height_m",
        "a number of m, -1000000 to 1000000",
        "z of the ground; the lower end of the fire if not set",
    ),
    key("stage.ground_colour", COLOUR, "colour of the ground"),
    key(
        "stage.spheres",
        "lists of four numbers of m: middle and radius, such as [[0.5, 0, 0.1, 0.1]]",
        "spheres that the fire's light falls on",
    ),
    key("stage.sphere_colour", COLOUR, "colour of the spheres"),
    key(
        "stage.logs",
        "lists of seven numbers of m: both ends and radius, such as [[-0.3, 0, 0.05, 0.3, 0, 0.05, 0.04]]",
        "logs that the fire's light falls on",
    ),
    key("stage.log_colour", COLOUR, "colour of the logs"),
    key(
        "stage.backdrop",
        "none, checker, gradient or picture",
        "a shining screen behind everything, which bent light moves",
    ),
    key(
        "stage.backdrop_distance_m",
        "a number of m, 0.000001 to 1000000",
        "behind the camera's target; twice the fire's largest side if not set",
    ),
    key(
        "stage.backdrop_square_m",
        "a number of m, 0.000001 to 1000000",
        "edge of a square of the checker; a twelfth of the frame's height there if not set",
    ),
    key(
        "stage.backdrop_luminance_cd_m2",
        "a number of cd/m², 0 to 1000000000",
        "luminance of the backdrop's white",
    ),
    key(
        "stage.backdrop_picture",
        "the path of a PNG file",
        "the picture on the backdrop",
    ),
    key(
        "effects.lines",
        SWITCH,
        "lines of a salt's atoms; auto: where there is a salt",
    ),
    key(
        "effects.bands",
        SWITCH,
        "bands of a salt's molecules; auto: where there is a salt that has any",
    ),
    key(
        "effects.chemiluminescence",
        SWITCH,
        "the blue light of the reaction zone; auto: where there is a flame field and soot does not outshine it",
    ),
    key(
        "effects.scattering",
        SWITCH,
        "the fire's own light, scattered once by soot and smoke; auto: where it can be seen",
    ),
    key(
        "effects.refraction",
        SWITCH,
        "light bent by hot gas; auto: where it can be seen",
    ),
    key(
        "effects.dispersion",
        SWITCH,
        "colours bent differently; auto: where a backdrop shows it",
    ),
    key(
        "effects.fire_light",
        SWITCH,
        "the fire as a light for the stage; auto: where a stage is in view",
    ),
    key(
        "effects.smoke",
        SWITCH,
        "smoke beside the soot; auto: where it can be seen",
    ),
    key(
        "effects.scattering_orders",
        SWITCH,
        "light scattered more than once, without noise; auto: where it can be seen",
    ),
    key(
        "camera.eye",
        POINT,
        "position of the eye; framed if not set",
    ),
    key(
        "camera.target",
        POINT,
        "the point in the middle of the picture; framed if not set",
    ),
    key(
        "camera.up",
        "three numbers, such as [0, 0, 1]",
        "what is up in the picture",
    ),
    key(
        "camera.fov_deg",
        "a number of degrees, 0.01 to 179",
        "vertical field of view",
    ),
    key(
        "camera.roll_deg",
        "a number of degrees, -180 to 180",
        "turn about the line of sight, clockwise",
    ),
    key(
        "camera.views",
        "a list of views, such as [{ name = \"left\", eye = [-2, 0, 1], target = [0, 0, 1], up = [0, 0, 1], fov_deg = 30 }]",
        "views to go back to in the window",
    ),
    key(
        "render.size",
        "two whole numbers of pixels, such as [1280, 720]",
        "width and height of a still",
    ),
    key(
        "render.quality",
        "draft, look, final or reference",
        "how exact: step, wavelengths and rays are chosen for this scene so that 95 % of it are within 5, 1, 0.3 or 0.05 ΔE",
    ),
    key(
        "render.target_error",
        "a number of ΔE, 0.01 to 100",
        "the same as a number; overrides quality",
    ),
    key(
        "render.step_voxels",
        "a number of voxels, 0.01 to 64",
        "length of a step; overrides quality",
    ),
    key(
        "render.wavelengths",
        "4, 6 or 8 (fitted), 16, 32 or 64 (plain)",
        "how many; overrides quality",
    ),
    key(
        "render.interpolation",
        "nearest, trilinear or tricubic",
        "how values between voxels are formed; tricubic is smooth and never negative",
    ),
    key(
        "render.samples_per_pixel",
        "a whole number, 1 to 4096",
        "1 is the pixel's centre; overrides quality",
    ),
    key(
        "render.scattering_orders",
        "a whole number, 1 to 64",
        "how often light may be scattered; more than once by path tracing, with some noise",
    ),
    key(
        "view.exposure_ev",
        "a number of stops, -20 to 20",
        "above the automatic exposure",
    ),
    key(
        "view.display_white_cd_m2",
        "a number of cd/m², 0.001 to 1000000000000000",
        "luminance that is display white at 0 stops; measured from the scene if not set",
    ),
    key(
        "view.adaptation",
        "a number, 0 to 1",
        "how far the eye has adapted to the white",
    ),
    key(
        "view.white_k",
        "a number of K, 1000 to 20000",
        "the black body that is white; white_xy if not set",
    ),
    key(
        "view.white_xy",
        "two numbers, each 0.001 to 1, such as [0.52, 0.41]",
        "CIE 1931 chromaticity of the white; measured from the scene if not set",
    ),
    key(
        "view.curve",
        "photographic, filmic, eye or linear",
        "how light becomes display values",
    ),
    key(
        "view.half_saturation_cd_m2",
        "a number of cd/m², 0.001 to 1000000000",
        "what the eye's curve shows at half; follows the exposure if not set",
    ),
    key(
        "view.false_colour",
        "true or false",
        "each stop of luminance in a colour of its own",
    ),
];

#[cfg(test)]
mod tests;
