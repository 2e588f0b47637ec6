//! The march stripped down: the plain kernel, against which what makes it quick is measured, and the limit, with nothing
//! but the work of a sample.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use sootlight::math::Ray;
use sootlight::math::lanes::{self, Kernel, LANES, Lanes};
use sootlight::render::tables::{MAX_NODES, Tables};
use sootlight::scene::Scene;

/// Rows of a picture that a thread takes at once.
const ROWS: usize = 4;
/// Samples of each lane that the limit takes in one call.
const CHUNK: u32 = 4096;
/// Calls of it by each thread.
const CALLS: u32 = 16;
/// Samples along the edge of the limit's brick, as in the march.
const EDGE: usize = 9;

/// One step of all wavelengths: L += t B (1 − e^{−τ}).
#[inline(always)]
fn light_step(
    tables: &Tables,
    column: &Lanes,
    inverse_temperature: &Lanes,
    transmittance: &mut [Lanes; MAX_NODES],
    radiance: &mut [Lanes; MAX_NODES],
) {
    for (n, node) in tables.nodes.iter().enumerate() {
        let (transmittance, radiance) = (&mut transmittance[n], &mut radiance[n]);
        for lane in 0..LANES {
            let x = node.planck_exponent_k * inverse_temperature[lane];
            let planck = node.planck_scale * lanes::inverse_exp_m1(x);
            let emitted = transmittance[lane] * -lanes::exp_m1(-node.absorption * column[lane]);
            radiance[lane] += planck * emitted;
            transmittance[lane] -= emitted;
        }
    }
}

/// Between eight samples, trilinear: the one at `first` and its upper neighbours in a box `x`, `y` wide.
#[inline(always)]
fn fetch(samples: &[[f32; 2]], first: usize, [x, y]: [usize; 2], fraction: [f32; 3]) -> [f32; 2] {
    let between = |a: [f32; 4], b: [f32; 4], f: f32| -> [f32; 4] {
        std::array::from_fn(|i| a[i] + f * (b[i] - a[i]))
    };
    let pair = |row: usize| -> [f32; 4] {
        let pair = &samples[first + row..first + row + 2];
        [pair[0][0], pair[0][1], pair[1][0], pair[1][1]]
    };
    let near = between(pair(0), pair(x), fraction[1]);
    let far = between(pair(x * y), pair(x * y + x), fraction[1]);
    let [soot, hot, soot_high, hot_high] = between(near, far, fraction[2]);
    [
        soot + fraction[0] * (soot_high - soot),
        hot + fraction[0] * (hot_high - hot),
    ]
}

/// A medium as one box of samples, without bricks.
pub(crate) struct Dense {
    size: [usize; 3],
    samples: Vec<[f32; 2]>,
}

impl Dense {
    /// Copies the medium of a scene whose lattice lies along the axes of the world.
    pub(crate) fn new(scene: &Scene) -> Self {
        let medium = scene.flame.medium();
        let far = 1e3;
        // The box by rays through its middle.
        let middle = scene.camera.target;
        let end = [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .flat_map(|axis| [axis, -axis])
            .filter_map(|direction| {
                let origin = middle - far * direction;
                let (local, [_, exit]) = medium.enter(&Ray { origin, direction })?;
                Some(local.at(exit))
            })
            .fold(DVec3::ZERO, DVec3::max);
        // The cell at the end needs one sample more.
        let size = end.to_array().map(|end| end.ceil() as usize + 2);
        let samples = (0..size[0] * size[1] * size[2]).map(|i| {
            let place = [i % size[0], i / size[0] % size[1], i / (size[0] * size[1])];
            let [soot, kelvin] = medium.sample(DVec3::from(place.map(|at| at as f64)));
            // Cold where nothing is stored.
            [
                soot as f32,
                if soot > 0.0 || kelvin > 0.0 {
                    kelvin as f32
                } else {
                    300.0
                },
            ]
        });
        let samples = samples.collect();
        Self { size, samples }
    }

    /// X, Y, Z of all pixels, in the calling thread's pool.
    pub(crate) fn march(&self, scene: &Scene, tables: &Tables, side: u32, step: f64) -> Vec<f64> {
        let side = side as usize;
        let film: Vec<Mutex<Vec<f64>>> =
            (0..side.div_ceil(ROWS)).map(|_| Mutex::default()).collect();
        let next = AtomicUsize::new(0);
        rayon::broadcast(|_| {
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let (Some(band), top) = (film.get(number), number * ROWS) else {
                    return;
                };
                let mut pixels = vec![0.0; ROWS * side * 3];
                for left in (0..side).step_by(LANES / ROWS) {
                    let light = lanes::dispatch(Packet {
                        dense: self,
                        scene,
                        tables,
                        step,
                        side,
                        at: [left, top],
                    });
                    for lane in 0..LANES {
                        let (x, y) = (left + lane / ROWS, lane % ROWS);
                        if x < side {
                            let nodes = light[..tables.nodes.len()].iter();
                            let xyz = tables
                                .wavelengths
                                .xyz_of(nodes.map(|light| f64::from(light[lane])));
                            pixels[(y * side + x) * 3..][..3].copy_from_slice(&xyz);
                        }
                    }
                }
                if let Ok(mut band) = band.lock() {
                    *band = pixels;
                }
            }
        });
        let bands = film
            .into_iter()
            .map(|band| band.into_inner().unwrap_or_default());
        bands.flatten().take(side * side * 3).collect()
    }
}

/// Sixteen rays of the plain kernel.
struct Packet<'a> {
    dense: &'a Dense,
    scene: &'a Scene,
    tables: &'a Tables,
    step: f64,
    side: usize,
    at: [usize; 2],
}

impl Kernel for Packet<'_> {
    type Output = [Lanes; MAX_NODES];

    #[inline(always)]
    fn run(self) -> Self::Output {
        let (medium, size) = (self.scene.flame.medium(), self.dense.size);
        let mut radiance = [[0.0; LANES]; MAX_NODES];
        let mut transmittance = [[1.0; LANES]; MAX_NODES];
        let Ok(view) = self.scene.camera.view([self.side as u32; 2]) else {
            return radiance;
        };
        let step_m = self.step * medium.voxel_size_m();
        let (mut start, mut delta) = ([DVec3::ZERO; LANES], [DVec3::ZERO; LANES]);
        let mut steps = [0.0; LANES];
        for lane in 0..LANES {
            let [x, y] = [self.at[0] + lane / ROWS, self.at[1] + lane % ROWS];
            let ray = view.ray(x as f64 + 0.5, y as f64 + 0.5);
            if let Some((local, [enter, exit])) = medium.enter(&ray) {
                start[lane] = local.at(enter);
                delta[lane] = local.direction * step_m;
                steps[lane] = (exit - enter) / step_m;
            }
        }
        let most = steps
            .iter()
            .fold(0.0_f64, |most, steps| most.max(*steps))
            .ceil() as u32;
        for i in 0..most {
            let mut column = [0.0; LANES];
            let mut inverse_temperature = [1.0; LANES];
            for lane in 0..LANES {
                let share = (steps[lane] - f64::from(i)).clamp(0.0, 1.0);
                if share <= 0.0 {
                    continue;
                }
                let at = start[lane] + (f64::from(i) + 0.5 * share) * delta[lane];
                let voxel = at.to_array().map(|at| at.max(0.0) as usize);
                let fraction = std::array::from_fn(|axis| (at[axis] - voxel[axis] as f64) as f32);
                let first = (voxel[2] * size[1] + voxel[1]) * size[0] + voxel[0];
                let [soot, kelvin] =
                    fetch(&self.dense.samples, first, [size[0], size[1]], fraction);
                column[lane] = soot * (step_m * share) as f32;
                inverse_temperature[lane] = 1.0 / kelvin.max(1.0);
            }
            light_step(
                self.tables,
                &column,
                &inverse_temperature,
                &mut transmittance,
                &mut radiance,
            );
        }
        radiance
    }
}

/// The work of a sample and nothing else.
pub(crate) struct Limit {
    tables: Tables,
    brick: Vec<[f32; 2]>,
}

impl Limit {
    pub(crate) fn new(tables: &Tables) -> Self {
        let brick =
            (0..EDGE * EDGE * EDGE).map(|i| [1e-8 * (i % 7) as f32, 1500.0 + (i % 11) as f32]);
        Self {
            tables: tables.clone(),
            brick: brick.collect(),
        }
    }

    /// Does it in the calling thread's pool, and says how many samples it took.
    pub(crate) fn run(&self) -> u64 {
        let threads = rayon::broadcast(|_| {
            for _ in 0..CALLS {
                std::hint::black_box(lanes::dispatch(Chunk(self)));
            }
        });
        threads.len() as u64 * u64::from(CALLS) * u64::from(CHUNK) * LANES as u64
    }
}

/// [`CHUNK`] samples of each lane.
struct Chunk<'a>(&'a Limit);

impl Kernel for Chunk<'_> {
    type Output = [Lanes; MAX_NODES];

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self(Limit { tables, brick }) = self;
        let mut radiance = [[0.0; LANES]; MAX_NODES];
        let mut transmittance = [[1.0; LANES]; MAX_NODES];
        for i in 0..CHUNK {
            let mut column = [0.0; LANES];
            let mut inverse_temperature = [1.0; LANES];
            for lane in 0..LANES {
                // Another cell for each lane and sample.
                let number = (i as usize + lane).wrapping_mul(0x9e37_79b9) >> 7;
                let voxel = [number & 7, number >> 3 & 7, number >> 6 & 7];
                let fraction = voxel.map(|at| 0.1 * at as f32);
                let first = (voxel[2] * EDGE + voxel[1]) * EDGE + voxel[0];
                let [soot, kelvin] = fetch(brick, first, [EDGE; 2], fraction);
                column[lane] = 0.01 * soot;
                inverse_temperature[lane] = 1.0 / kelvin;
            }
            light_step(
                tables,
                &column,
                &inverse_temperature,
                &mut transmittance,
                &mut radiance,
            );
        }
        radiance
    }
}
