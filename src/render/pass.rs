//! In which order a picture is computed: a ladder of passes, tiles in the order that suits who waits, a parallel loop.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use super::film::{PACKET_SIDE, Pixel, Tile};
use super::packets::Packets;
use super::prompt::Prompt;
use super::subpixel::Lattice;
use super::{Cancel, Level, Plan, Settings};
use crate::math::coprime_from;
use crate::math::lanes::LANES;
use crate::scene::Scene;

/// Edge of a tile, in rays.
pub const TILE: u32 = 32;

/// One walk over the picture: every `stride`th pixel, one ray each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// Pixels between rays, a power of two.
    pub stride: u32,
    /// Which of the pixel's samples.
    pub sample: u32,
    /// How many there are; the only one is the pixel's centre.
    pub samples: u32,
    /// Length of a step in voxels.
    pub step_voxels: f64,
    /// Which part of the picture it sharpens; `None` for all of it.
    pub region: Option<Region>,
    /// Who waits for it: a person sees the middle first, a file's tiles are spread so that the finished share tells the time
    /// that is left.
    pub audience: Audience,
}

/// A part of a picture, pixels from its upper left corner: columns and rows from the first on, up to the second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Region {
    /// The first column and row.
    pub from: [u32; 2],
    /// One past the last.
    pub to: [u32; 2],
}

impl Region {
    /// Whether any of it lies in a rectangle, told by its upper left pixel and its width and height.
    fn meets(&self, corner: [u32; 2], size: [u32; 2]) -> bool {
        [0, 1]
            .into_iter()
            .all(|axis| corner[axis] < self.to[axis] && corner[axis] + size[axis] > self.from[axis])
    }
}

impl Pass {
    /// Rays of the whole pass.
    pub fn rays(&self, size: [u32; 2]) -> u64 {
        let rays = size.map(|side| side.div_ceil(self.stride));
        if self.region.is_none() {
            return u64::from(rays[0]) * u64::from(rays[1]);
        }
        let tiles = self.tiles(rays).into_iter();
        tiles
            .map(|corner| tile_size(corner, rays, TILE))
            .map(|[width, height]| u64::from(width) * u64::from(height))
            .sum()
    }

    /// How fine the fields are that it needs: a coarse picture is not worth fine ones.
    pub fn level(&self) -> Level {
        if self.stride > 1 {
            Level::Coarse
        } else {
            Level::Fine
        }
    }

    /// Upper left rays of its tiles, in the order that suits who waits for it.
    fn tiles(&self, rays: [u32; 2]) -> Vec<[u32; 2]> {
        let mut tiles = match self.audience {
            Audience::Window => centre_out(rays),
            Audience::Still => spread(rays),
        };
        if let Some(region) = self.region {
            let pixels = |rays: [u32; 2]| rays.map(|ray| ray * self.stride);
            tiles.retain(|&corner| {
                region.meets(pixels(corner), pixels(tile_size(corner, rays, TILE)))
            });
        }
        tiles
    }
}

/// Width and height of the tile at a corner, in rays.
fn tile_size(corner: [u32; 2], rays: [u32; 2], side: u32) -> [u32; 2] {
    [0, 1].map(|axis| side.min(rays[axis] - corner[axis]))
}

/// Who waits for the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Audience {
    /// A person: coarse first, sharpening while she watches.
    Window,
    /// A file: only what counts.
    Still,
}

/// The smaller part of a length of 1 that is cut in the golden section.
const GOLDEN: f64 = 0.381_966;

/// What of a tile is there is handed on after so long, where a packet's rays take their time: a person sees that it goes on.
const PROMPT: Duration = Duration::from_millis(100);

/// Step of the coarse passes in voxels, if the settings do not ask for a longer one: a 1/8 picture does not
/// show the 0.3 % that a longer step costs.
const COARSE_STEP_VOXELS: f64 = 2.0;

/// The passes of a picture in their order.
pub fn ladder(settings: &Settings, audience: Audience) -> Vec<Pass> {
    let coarse = match audience {
        Audience::Window => &[8, 4, 2][..],
        Audience::Still => &[],
    };
    let step_voxels = settings.step_voxels;
    let coarse = coarse.iter().map(|&stride| Pass {
        stride,
        sample: 0,
        samples: 1,
        step_voxels: step_voxels.max(COARSE_STEP_VOXELS),
        region: None,
        audience,
    });
    let full = (0..settings.samples_per_pixel).map(|sample| Pass {
        stride: 1,
        sample,
        samples: settings.samples_per_pixel,
        step_voxels,
        region: None,
        audience,
    });
    coarse.chain(full).collect()
}

/// The passes of a picture for a window that shows all of it already, less exactly: only what counts.
pub fn ladder_again(settings: &Settings) -> Vec<Pass> {
    let mut passes = ladder(settings, Audience::Window);
    passes.retain(|pass| pass.stride == 1);
    passes
}

/// The passes of a picture for a window that is sharp in a part of it: coarse everywhere, then fine there.
pub fn ladder_within(settings: &Settings, region: Region) -> Vec<Pass> {
    let mut passes = ladder(settings, Audience::Window);
    let fine = passes.iter_mut().filter(|pass| pass.stride == 1);
    fine.for_each(|pass| pass.region = Some(region));
    passes
}

/// Renders one pass in the calling thread's rayon pool, tiles in the order that suits who waits, and hands each to `sink` from the worker that made it. `false` if it was cancelled before the last tile.
///
/// The cancel is asked before each packet of sixteen rays, and before each path of light that is scattered more than
/// once. A camera that cannot see gives no tiles: settings and camera are checked at the doors.
pub fn render_pass(
    scene: &Scene,
    plan: &Plan,
    pass: &Pass,
    cancel: &Cancel,
    sink: &(dyn Fn(Tile) + Sync),
) -> bool {
    let Some(fields) = plan.fields(scene, pass.level(), cancel) else {
        return false;
    };
    // Coarse passes are for speed.
    let by_paths = pass.stride == 1;
    let Ok(packets) = Packets::new(scene, plan, fields, pass.step_voxels, by_paths) else {
        return true;
    };
    let rays = plan.tables.size.map(|side| side.div_ceil(pass.stride));
    let within = Lattice::of(pass.samples).place(pass.sample);
    for_each_tile(&pass.tiles(rays), rays, TILE, |corner, size| {
        let mut prompt = Prompt::new(PROMPT, sink);
        let tile = render_tile(&packets, pass, within, corner, size, cancel, &mut |tile| {
            prompt.hear(tile);
        })?;
        prompt.end(tile);
        Some(())
    })
}

/// Sides of the blocks of a mosaic in pixels, coarsest first: of each block, the packet in its corner is rendered before those
/// of smaller blocks.
pub const MOSAIC: [u32; 4] = [32, 16, 8, PACKET_SIDE];

/// Renders a still's picture packet by packet, in the order of a [`MOSAIC`]: whatever is there of it is as it will be, and soon
/// there is something of every part. Each packet is handed to `sink` as the mean of its samples from the worker that made it.
/// `false` if cancelled.
pub fn render_mosaic(
    scene: &Scene,
    plan: &Plan,
    settings: &Settings,
    cancel: &Cancel,
    sink: &(dyn Fn(Tile) + Sync),
) -> bool {
    let passes = ladder(settings, Audience::Still);
    let Some(fields) = plan.fields(scene, Level::Fine, cancel) else {
        return false;
    };
    let Ok(packets) = Packets::new(scene, plan, fields, settings.step_voxels, true) else {
        return true;
    };
    let lattice = Lattice::of(settings.samples_per_pixel);
    let rays = plan.tables.size;
    for_each_tile(&mosaic(rays), rays, PACKET_SIDE, |corner, size| {
        let mut whole: Option<Tile> = None;
        for pass in &passes {
            let within = lattice.place(pass.sample);
            let tile = render_tile(&packets, pass, within, corner, size, cancel, &mut |_| ())?;
            match &mut whole {
                Some(whole) => whole.join(&tile),
                None => whole = Some(tile),
            }
        }
        whole.map(sink)
    })
}

/// Upper left pixels of all packets in the order of a mosaic, those of each size of block from the centre outwards.
fn mosaic(size: [u32; 2]) -> Vec<[u32; 2]> {
    let mut before = None;
    let mut packets = Vec::new();
    for side in MOSAIC {
        let corners = |axis: usize| (0..size[axis]).step_by(side as usize);
        let all = corners(1).flat_map(|y| corners(0).map(move |x| [x, y]));
        let is_new = |at: &[u32; 2]| before.is_none_or(|side: u32| at.iter().any(|v| v % side > 0));
        let mut new: Vec<[u32; 2]> = all.filter(is_new).collect();
        sort_centre_out(&mut new, PACKET_SIDE, size);
        packets.extend(new);
        before = Some(side);
    }
    packets
}

/// Calls `work` with the upper left ray and the size of every tile, in the calling thread's rayon pool. Whether none gave
/// `None`; after one did, those of others may be missing as well.
fn for_each_tile(
    corners: &[[u32; 2]],
    rays: [u32; 2],
    side: u32,
    work: impl Fn([u32; 2], [u32; 2]) -> Option<()> + Sync,
) -> bool {
    let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
    rayon::broadcast(|_| {
        while let Some(&corner) = corners.get(next.fetch_add(1, Ordering::Relaxed)) {
            let size = tile_size(corner, rays, side);
            if work(corner, size).is_none() {
                stopped.store(true, Ordering::Relaxed);
            }
        }
    });
    !stopped.into_inner()
}

/// Upper left rays of all tiles, those that follow each other far apart: at any time what is done is spread evenly.
fn spread(rays: [u32; 2]) -> Vec<[u32; 2]> {
    let mut tiles = centre_out(rays);
    tiles.sort_unstable_by_key(|[x, y]| [*y, *x]);
    let count = tiles.len();
    // Steps of the golden section fill a circle most evenly (Knuth, TAOCP 6.4, theorem S).
    let stride = coprime_from((GOLDEN * count as f64) as usize, count);
    (0..count).map(|i| tiles[i * stride % count]).collect()
}

/// Upper left rays of all tiles, those nearest the centre first.
fn centre_out(rays: [u32; 2]) -> Vec<[u32; 2]> {
    let corners = |axis: usize| (0..rays[axis]).step_by(TILE as usize);
    let mut tiles: Vec<[u32; 2]> = corners(1)
        .flat_map(|y| corners(0).map(move |x| [x, y]))
        .collect();
    sort_centre_out(&mut tiles, TILE, rays);
    tiles
}

/// Brings squares of this side, told by their upper left corners, into the order of their distance from the centre.
fn sort_centre_out(corners: &mut [[u32; 2]], side: u32, size: [u32; 2]) {
    let from_centre = |corner: u32, length: u32| {
        let doubled = i64::from(2 * corner + side) - i64::from(length);
        doubled * doubled
    };
    corners.sort_by_key(|&[x, y]| from_centre(x, size[0]) + from_centre(y, size[1]));
}

/// A ray for each pixel of a tile, at the same place within each. `sofar` hears of the tile after each of its packets, whose counts
/// are those in it. `None` if cancelled.
fn render_tile(
    packets: &Packets<'_>,
    pass: &Pass,
    within: [f64; 2],
    corner: [u32; 2],
    size: [u32; 2],
    cancel: &Cancel,
    sofar: &mut dyn FnMut(&Tile),
) -> Option<Tile> {
    let packets_across = size.map(|side| side.div_ceil(PACKET_SIDE) as usize);
    let mut tile = Tile {
        stride: pass.stride,
        sample: pass.sample,
        origin: corner.map(|ray| ray * pass.stride),
        size,
        pixels: vec![Pixel::default(); (size[0] * size[1]) as usize],
        taken: Vec::with_capacity(packets_across[0] * packets_across[1]),
    };
    for top in (0..size[1]).step_by(PACKET_SIDE as usize) {
        for left in (0..size[0]).step_by(PACKET_SIDE as usize) {
            // Steps of a packet: which pixels, which rays, the march, and back to their places.
            let places: [Option<[u32; 2]>; LANES] = std::array::from_fn(|lane| {
                let place = [
                    left + lane as u32 % PACKET_SIDE,
                    top + lane as u32 / PACKET_SIDE,
                ];
                (place[0] < size[0] && place[1] < size[1]).then_some(place)
            });
            let points = places.map(|place| {
                let on_picture = |axis: usize, ray: u32| {
                    (f64::from(corner[axis] + ray) + within[axis]) * f64::from(pass.stride)
                };
                place.map(|[x, y]| [on_picture(0, x), on_picture(1, y)])
            });
            let (packet, of_packet) = packets.render(&points, pass.sample, cancel)?;
            // More than 2³² samples for sixteen rays would take longer than anybody waits.
            tile.taken
                .push(u32::try_from(of_packet).unwrap_or(u32::MAX));
            for (place, pixel) in places.iter().zip(packet) {
                if let Some([x, y]) = place {
                    tile.pixels[(y * size[0] + x) as usize] = pixel;
                }
            }
            sofar(&tile);
        }
    }
    Some(tile)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Effects;
    use crate::scene::WavelengthSet;

    const SETTINGS: Settings = Settings {
        size: [100, 50],
        step_voxels: 0.5,
        wavelengths: WavelengthSet::Fitted(4),
        samples_per_pixel: 3,
        scattering_orders: 1,
        effects: Effects::AUTO,
    };

    #[test]
    fn a_window_sharpens_and_a_still_skips_the_coarse_passes() {
        let strides: Vec<u32> = ladder(&SETTINGS, Audience::Window)
            .iter()
            .map(|pass| pass.stride)
            .collect();
        assert_eq!(strides, [8, 4, 2, 1, 1, 1]);
        assert_eq!(ladder(&SETTINGS, Audience::Still).len(), 3);
    }

    #[test]
    fn tiles_cover_every_ray_once_and_begin_in_the_middle() {
        let tiles = centre_out([100, 50]);
        assert_eq!(tiles.len(), 4 * 2);
        assert!(tiles[0][0] == 32 || tiles[0][0] == 64);
        let mut sorted = tiles.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), tiles.len());
    }

    #[test]
    fn spread_tiles_are_all_there_and_any_part_of_them_is_spread() {
        for rays in [[1280, 720], [100, 50], [31, 7], [500, 40]] {
            let tiles = spread(rays);
            let mut sorted = tiles.clone();
            sorted.sort_unstable();
            let mut all = centre_out(rays);
            all.sort_unstable();
            assert_eq!(sorted, all);
        }
        // A tenth of the tiles has a tenth of what lies in the middle ninth, as it has of the whole.
        let tiles = spread([1280, 720]);
        let is_inside = |[x, y]: &&[u32; 2]| (420..850).contains(x) && (240..480).contains(y);
        let inside = |tiles: &[[u32; 2]]| tiles.iter().filter(is_inside).count() as f64;
        for tenth in tiles.chunks_exact(tiles.len() / 10) {
            let share = inside(tenth) / inside(&tiles);
            assert!((share - 0.1).abs() < 0.025, "{share}");
        }
    }

    #[test]
    fn a_mosaic_has_every_packet_once_and_some_of_every_part_first() {
        let packets = mosaic([70, 33]);
        let mut sorted = packets.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), packets.len());
        assert_eq!(packets.len(), 18 * 9);
        let mut first = packets[..6].to_vec();
        assert_eq!(first[0], [32, 0]);
        first.sort_unstable();
        let blocks = [0, 32, 64].map(|x| [0, 32].map(|y| [x, y])).concat();
        assert_eq!(first, blocks);
    }
}
