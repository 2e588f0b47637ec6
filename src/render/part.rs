//! A part of a picture that stands for all of it: packets of rays, spread evenly over where there is light and, fewer, over
//! where there is none.
//!
//! What a part gives is what the picture gives there, to the last bit. What it takes is told for the whole picture: each
//! group of packets stands for all of its kind (W. G. Cochran, *Sampling Techniques* (1977), ch. 5: stratified sampling).

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::clock::{timed, timed_alone};
use super::difference::LIT;
use super::film::PACKET_SIDE;
use super::packets::{Packets, Points};
use super::subpixel::Lattice;
use super::{Audience, Cancel, Level, Pass, Plan, render_pass};
use crate::math::lanes::LANES;
use crate::scene::Scene;

/// Packets of a picture that stand for all of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    size: [u32; 2],
    groups: Vec<Group>,
    /// Samples that one ray a pixel of the whole picture takes with steps of [`LOOK_STEP_VOXELS`], where a look has told.
    looked: Option<f64>,
}

/// Packets of one kind.
#[derive(Debug, Clone, PartialEq)]
struct Group {
    /// Upper left pixel of each.
    corners: Vec<[u32; 2]>,
    /// Packets of the picture for each of them.
    stands_for: f64,
}

/// What a part gives, and what the whole picture takes by it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rendered {
    /// X, Y, Z of each pixel of the part, the mean of its samples, W m⁻² sr⁻¹.
    pub xyz: Vec<[f64; 3]>,
    /// Samples of the medium that the whole picture takes.
    pub samples: f64,
    /// Seconds of processor time that the march of the whole picture takes.
    pub cpu_s: f64,
    /// The same as wall-clock seconds of the calling pool, as well as this part kept it busy.
    pub wall_s: f64,
}

/// Pixels between the rays of the look that tells light from dark, and the side of a picture that is large enough for it.
const LOOK: [(u32, u32); 3] = [(8, 256), (4, 64), (1, 0)];
/// Step of that look, voxels.
pub const LOOK_STEP_VOXELS: f64 = 2.0;
/// Of so many packets in the light one more is taken in the dark.
const LIT_FOR_EACH_DARK: usize = 8;
/// Packets that are on the clock together: much longer than it takes to read the clock.
const CHUNK: usize = 8;

impl Part {
    /// At most so many packets, spread evenly over a picture.
    pub fn spread(size: [u32; 2], most: usize) -> Self {
        let across = packets_across(size);
        let all = across[0] as usize * across[1] as usize;
        let count = all.min(most);
        let corner = |i: usize| -> [u32; 2] {
            if count == all {
                return [i as u32 % across[0], i as u32 / across[0]];
            }
            let spread = evenly(i);
            std::array::from_fn(|axis| (spread[axis] * f64::from(across[axis])) as u32)
        };
        let corners: Vec<[u32; 2]> = (0..count)
            .map(|i| corner(i).map(|side| side * PACKET_SIDE))
            .collect();
        let groups = vec![Group {
            stands_for: all as f64 / count.max(1) as f64,
            corners,
        }];
        Self {
            size,
            groups,
            looked: None,
        }
    }

    /// At most so many packets where a quick look finds light, and an eighth as many where it finds none. Looks in the calling
    /// thread's rayon pool; `None` if cancelled.
    pub fn lit(scene: &Scene, plan: &Plan, most: usize, cancel: &Cancel) -> Option<Self> {
        let size = plan.tables.size;
        let look = Look::new(scene, plan, cancel)?;
        let across = packets_across(size);
        let all = (0..across[1]).flat_map(|y| (0..across[0]).map(move |x| [x, y]));
        let all = all.map(|packet| packet.map(|side| side * PACKET_SIDE));
        let (lit, dark): (Vec<[u32; 2]>, Vec<[u32; 2]>) = all.partition(|&at| look.is_lit(at));
        let groups = [(lit, most), (dark, most.div_ceil(LIT_FOR_EACH_DARK))];
        let groups = groups.into_iter().filter(|(kind, _)| !kind.is_empty());
        let groups = groups.map(|(mut kind, most)| {
            let all = kind.len();
            // Neighbours in this order are neighbours in the picture: each of a number of even parts is a piece of it.
            kind.sort_by_key(|&[x, y]| interleaved(x, y));
            let count = all.min(most);
            let at = |i: usize| ((i as f64 + 0.5) * all as f64 / count as f64) as usize;
            Group {
                corners: (0..count).map(|i| kind[at(i)]).collect(),
                stands_for: all as f64 / count as f64,
            }
        });
        Some(Self {
            size,
            groups: groups.collect(),
            looked: Some(look.samples),
        })
    }

    /// Samples that one ray a pixel of the whole picture takes with steps of [`LOOK_STEP_VOXELS`], counted all over it by the
    /// look, which is nearer than what a part tells. `None` where nobody has looked.
    pub fn looked_samples(&self) -> Option<f64> {
        self.looked
    }

    /// Share of the picture's pixels that is in it.
    pub fn share(&self) -> f64 {
        let pixels = self.weights().len() as f64;
        pixels / (f64::from(self.size[0]) * f64::from(self.size[1]))
    }

    /// For how many pixels of the picture each pixel stands, in the order of [`Rendered::xyz`].
    pub fn weights(&self) -> Vec<f64> {
        let each = |group: &Group| {
            let pixels = group.corners.iter().flat_map(|&at| self.pixels(at));
            vec![group.stands_for; pixels.flatten().count()]
        };
        self.groups.iter().flat_map(each).collect()
    }

    /// Column and row of each pixel, in the order of [`Rendered::xyz`].
    pub fn places(&self) -> Vec<[u32; 2]> {
        let corners = self.groups.iter().flat_map(|group| &group.corners);
        corners.flat_map(|&at| self.pixels(at)).flatten().collect()
    }

    /// Renders every pixel by so many samples in the calling thread's rayon pool, with the plan's fine fields, which are worked
    /// out if nobody has asked for them and are not on this clock. `None` if cancelled.
    pub fn render(
        &self,
        scene: &Scene,
        plan: &Plan,
        step_voxels: f64,
        samples: u32,
        cancel: &Cancel,
    ) -> Option<Rendered> {
        let fields = plan.fields(scene, Level::Fine, cancel)?;
        // A camera that cannot see sees nothing: it is checked at the doors.
        let packets = Packets::new(scene, plan, fields, step_voxels, true).ok()?;
        self.render_with(&packets, samples, cancel)
    }

    pub(super) fn render_with(
        &self,
        packets: &Packets<'_>,
        samples: u32,
        cancel: &Cancel,
    ) -> Option<Rendered> {
        let mut rendered = Rendered {
            xyz: Vec::with_capacity(
                LANES * self.groups.iter().map(|it| it.corners.len()).sum::<usize>(),
            ),
            samples: 0.0,
            cpu_s: 0.0,
            wall_s: 0.0,
        };
        let lattice = Lattice::of(samples);
        let within: Vec<[f64; 2]> = (0..samples).map(|sample| lattice.place(sample)).collect();
        let (done, wall_s) = timed(|| {
            let mut on_clock_s = 0.0;
            for group in &self.groups {
                let chunks = group.corners.par_chunks(CHUNK);
                let chunks: Option<Vec<_>> = chunks
                    .map(|corners| {
                        let (made, cpu_s) =
                            timed_alone(|| self.chunk(packets, corners, &within, cancel));
                        Some((made?, cpu_s))
                    })
                    .collect();
                for ((xyz, taken), cpu_s) in chunks? {
                    rendered.xyz.extend(xyz);
                    rendered.samples += group.stands_for * taken as f64;
                    rendered.cpu_s += group.stands_for * cpu_s;
                    on_clock_s += cpu_s;
                }
            }
            Some(on_clock_s)
        });
        let on_clock_s = done?;
        rendered.wall_s = rendered.cpu_s * wall_s / on_clock_s.max(f64::MIN_POSITIVE);
        Some(rendered)
    }

    /// The pixels of some packets one after another, by rays at these places within each, and how many samples of the medium
    /// they took.
    fn chunk(
        &self,
        packets: &Packets<'_>,
        corners: &[[u32; 2]],
        places: &[[f64; 2]],
        cancel: &Cancel,
    ) -> Option<(Vec<[f64; 3]>, u64)> {
        let mut means = Vec::with_capacity(LANES * corners.len());
        let mut taken = 0;
        for &corner in corners {
            let pixels = self.pixels(corner);
            let mut sums = [[0.0; 3]; LANES];
            for (sample, within) in (0_u32..).zip(places) {
                let points: Points = pixels.map(|pixel| {
                    pixel.map(|[x, y]| [f64::from(x) + within[0], f64::from(y) + within[1]])
                });
                let (found, of_packet) = packets.render(&points, sample, cancel)?;
                taken += of_packet;
                for (sum, pixel) in sums.iter_mut().zip(&found) {
                    for (sum, value) in sum.iter_mut().zip(pixel.xyz) {
                        *sum += f64::from(value);
                    }
                }
            }
            let share = 1.0 / places.len().max(1) as f64;
            let inside = sums
                .iter()
                .zip(&pixels)
                .filter(|(_, pixel)| pixel.is_some());
            means.extend(inside.map(|(sum, _)| sum.map(|value| share * value)));
        }
        Some((means, taken))
    }

    /// The pixels of a packet; `None` beyond the picture's edges.
    fn pixels(&self, corner: [u32; 2]) -> [Option<[u32; 2]>; LANES] {
        std::array::from_fn(|lane| {
            let x = corner[0] + lane as u32 % PACKET_SIDE;
            let y = corner[1] + lane as u32 / PACKET_SIDE;
            (x < self.size[0] && y < self.size[1]).then_some([x, y])
        })
    }
}

/// The `i`th of places that fill the unit square evenly, however many there are: the additive recurrence on the plastic number
/// (M. Roberts 2018).
fn evenly(i: usize) -> [f64; 2] {
    const PLASTIC: f64 = 1.324717957244746;
    [1.0 / PLASTIC, 1.0 / (PLASTIC * PLASTIC)].map(|step| (0.5 + i as f64 * step).fract())
}

fn packets_across(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(PACKET_SIDE))
}

/// Bits of both numbers by turns (G. M. Morton 1966): what is near in the plane is mostly near in this order.
fn interleaved(x: u32, y: u32) -> u64 {
    let apart = |value: u32| {
        (0..u32::BITS).fold(0_u64, |all, bit| {
            all | (u64::from(value >> bit & 1) << (2 * bit))
        })
    };
    apart(x) | apart(y) << 1
}

/// A quick look at a picture: how bright each of its blocks is.
struct Look {
    stride: u32,
    across: [u32; 2],
    /// Y of each block, row by row.
    light: Vec<f32>,
    peak: f32,
    /// Samples that it would take with a ray in each pixel.
    samples: f64,
}

impl Look {
    fn new(scene: &Scene, plan: &Plan, cancel: &Cancel) -> Option<Self> {
        let size = plan.tables.size;
        let shorter = size[0].min(size[1]);
        let fits = LOOK.into_iter().find(|&(_, side)| shorter >= side);
        let stride = fits.map_or(1, |(stride, _)| stride);
        let across = size.map(|side| side.div_ceil(stride));
        let light = Mutex::new(vec![0.0_f32; across[0] as usize * across[1] as usize]);
        let pass = Pass {
            stride,
            sample: 0,
            samples: 1,
            step_voxels: LOOK_STEP_VOXELS,
            region: None,
            audience: Audience::Still,
        };
        let taken = AtomicU64::new(0);
        let whole = render_pass(scene, plan, &pass, cancel, &|tile| {
            taken.fetch_add(tile.samples(), Ordering::Relaxed);
            let mut light = light
                .lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner);
            let first = tile.origin.map(|side| side / stride);
            for (i, pixel) in tile.pixels.iter().enumerate() {
                let x = first[0] + i as u32 % tile.size[0];
                let y = first[1] + i as u32 / tile.size[0];
                light[(y * across[0] + x) as usize] = pixel.xyz[1];
            }
        });
        let light = light
            .into_inner()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        let of_pixels = f64::from(size[0]) * f64::from(size[1]);
        let rays = pass.rays(size) as f64;
        whole.then(|| Self {
            samples: taken.into_inner() as f64 * of_pixels / rays,
            stride,
            across,
            peak: light.iter().copied().fold(0.0, f32::max),
            light,
        })
    }

    /// Whether there is light in a packet's block or beside it.
    fn is_lit(&self, corner: [u32; 2]) -> bool {
        let block = corner.map(|side| side / self.stride);
        let last = corner.map(|side| (side + PACKET_SIDE - 1) / self.stride);
        let around = |axis: usize| {
            block[axis].saturating_sub(1)..=(last[axis] + 1).min(self.across[axis] - 1)
        };
        let lit =
            |x: u32, y: u32| self.light[(y * self.across[0] + x) as usize] > LIT as f32 * self.peak;
        around(1).any(|y| around(0).any(|x| lit(x, y)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_are_all_of_a_small_picture_and_spread_over_a_large_one() {
        let small = Part::spread([13, 6], 256);
        assert_eq!(small.places().len(), 13 * 6);
        assert_eq!(small.share(), 1.0);
        let large = Part::spread([1001, 703], 256);
        let corners = &large.groups[0].corners;
        assert_eq!(corners.len(), 256);
        for quarter in [[0, 0], [500, 0], [0, 350], [500, 350]] {
            let inside = corners.iter().filter(|[x, y]| {
                (quarter[0]..quarter[0] + 500).contains(x)
                    && (quarter[1]..quarter[1] + 350).contains(y)
            });
            let share = inside.count() as f64 / 256.0;
            assert!((share - 0.25).abs() < 0.03, "{quarter:?}: {share}");
        }
    }

    #[test]
    fn neighbours_in_order_are_neighbours_in_the_plane() {
        assert_eq!(
            [
                interleaved(0, 0),
                interleaved(1, 0),
                interleaved(0, 1),
                interleaved(1, 1)
            ],
            [0, 1, 2, 3]
        );
        assert_eq!(interleaved(u32::MAX, u32::MAX), u64::MAX);
    }
}
