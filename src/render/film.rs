//! The film: where spectra become three numbers, and where passes and samples come together.

use std::ops::Range;

use crate::math::lanes::LANES;

/// Width and height of a packet, the rays that are marched side by side.
pub const PACKET_SIDE: u32 = 4;

const _: () = assert!((PACKET_SIDE * PACKET_SIDE) as usize == LANES);

/// What one ray, or the mean of many, leaves on the film.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pixel {
    /// X, Y, Z of the radiance, W m⁻² sr⁻¹; luminance is 683 Y cd m⁻².
    pub xyz: [f32; 3],
    /// X, Y, Z of 1 − transmittance under D65, Y = 1 for an opaque pixel.
    pub opacity: [f32; 3],
}

/// A rectangle of a pass, on its way to a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Tile {
    /// Pixels of the picture between neighbours of this tile, a power of two.
    pub stride: u32,
    /// Which sample of the pixel this is; 0 is the first.
    pub sample: u32,
    /// Upper left pixel of the picture that this tile covers.
    pub origin: [u32; 2],
    /// Width and height, in steps of `stride`.
    pub size: [u32; 2],
    /// Row by row from the top.
    pub pixels: Vec<Pixel>,
    /// Samples of the medium that were taken for each packet of [`PACKET_SIDE`]² rays, packets row by row.
    pub taken: Vec<u32>,
}

impl Tile {
    /// Samples of the medium that were taken for all of it.
    pub fn samples(&self) -> u64 {
        self.taken.iter().map(|&taken| u64::from(taken)).sum()
    }

    /// Samples that the ray at this column and row of the tile took, as the mean of its packet, whose rays march together.
    /// 0 where nobody has counted.
    pub fn samples_of(&self, column: u32, row: u32) -> f32 {
        let packet = [column, row].map(|ray| ray / PACKET_SIDE);
        let across = self.size[0].div_ceil(PACKET_SIDE);
        let taken = self.taken.get((packet[1] * across + packet[0]) as usize);
        let side = |axis: usize| PACKET_SIDE.min(self.size[axis] - packet[axis] * PACKET_SIDE);
        taken.map_or(0.0, |&taken| taken as f32 / (side(0) * side(1)) as f32)
    }

    /// One of its packets by itself, counted row by row.
    pub(super) fn packet(&self, index: usize) -> Self {
        let across = self.size[0].div_ceil(PACKET_SIDE).max(1);
        let first = [index as u32 % across, index as u32 / across].map(|at| at * PACKET_SIDE);
        let size = [0, 1].map(|axis| PACKET_SIDE.min(self.size[axis] - first[axis]));
        let row = |y: u32| {
            let begin = (y * self.size[0] + first[0]) as usize;
            self.pixels[begin..begin + size[0] as usize].iter().copied()
        };
        Self {
            origin: [0, 1].map(|axis| self.origin[axis] + first[axis] * self.stride),
            size,
            pixels: (first[1]..first[1] + size[1]).flat_map(row).collect(),
            taken: self.taken.get(index).copied().into_iter().collect(),
            ..*self
        }
    }

    /// Takes the next sample of the same rays into the mean.
    pub(super) fn join(&mut self, next: &Self) {
        let share = 1.0 / (next.sample as f32 + 1.0);
        for (mean, sample) in self.pixels.iter_mut().zip(&next.pixels) {
            mean.join(sample, share);
        }
        for (all, taken) in self.taken.iter_mut().zip(&next.taken) {
            *all = all.saturating_add(*taken);
        }
    }

    /// The pixels that it covers of a picture of this size: columns and rows.
    pub fn covers(&self, size: [u32; 2]) -> [Range<usize>; 2] {
        [0, 1].map(|axis| {
            let end = self.origin[axis] + self.size[axis] * self.stride;
            self.origin[axis] as usize..end.min(size[axis]) as usize
        })
    }

    /// The pixels that the ray at this column and row stands for, on a picture of this size: columns and rows.
    pub fn block(&self, column: u32, row: u32, size: [u32; 2]) -> [Range<usize>; 2] {
        let first = [
            self.origin[0] + column * self.stride,
            self.origin[1] + row * self.stride,
        ];
        [0, 1]
            .map(|axis| first[axis] as usize..(first[axis] + self.stride).min(size[axis]) as usize)
    }
}

/// A picture in linear XYZ with opacity.
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    size: [u32; 2],
    pixels: Vec<Pixel>,
}

impl Film {
    /// A black, clear film of width × height pixels.
    pub fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            pixels: vec![Pixel::default(); size[0] as usize * size[1] as usize],
        }
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Row by row from the top.
    pub fn pixels(&self) -> &[Pixel] {
        &self.pixels
    }

    /// The pixel at column x, row y, if it is on the film.
    pub fn pixel(&self, x: u32, y: u32) -> Option<&Pixel> {
        (x < self.size[0] && y < self.size[1])
            .then(|| &self.pixels[(y * self.size[0] + x) as usize])
    }

    /// Lays a tile on the film. A coarse one fills its blocks; a later sample joins the mean of those before
    /// it, so the samples of a pixel must arrive in order (tiles of one pass may come in any).
    pub fn merge(&mut self, tile: &Tile) {
        let width = self.size[0] as usize;
        let share = 1.0 / (tile.sample as f32 + 1.0);
        for (i, pixel) in tile.pixels.iter().enumerate() {
            let (column, row) = (i as u32 % tile.size[0], i as u32 / tile.size[0]);
            let [across, down] = tile.block(column, row, self.size);
            for y in down {
                for old in &mut self.pixels[y * width + across.start..y * width + across.end] {
                    if tile.sample == 0 {
                        *old = *pixel;
                    } else {
                        old.join(pixel, share);
                    }
                }
            }
        }
    }
}

impl Pixel {
    /// Moves the mean towards one more sample, which counts for `share` of the whole.
    pub(super) fn join(&mut self, sample: &Self, share: f32) {
        for c in 0..3 {
            self.xyz[c] += share * (sample.xyz[c] - self.xyz[c]);
            self.opacity[c] += share * (sample.opacity[c] - self.opacity[c]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(stride: u32, sample: u32, origin: [u32; 2], size: [u32; 2], y: f32) -> Tile {
        let pixel = Pixel {
            xyz: [0.0, y, 0.0],
            opacity: [0.0; 3],
        };
        Tile {
            stride,
            sample,
            origin,
            size,
            pixels: vec![pixel; (size[0] * size[1]) as usize],
            taken: Vec::new(),
        }
    }

    #[test]
    fn a_coarse_tile_fills_its_blocks_up_to_the_edge() {
        let mut film = Film::new([5, 3]);
        film.merge(&tile(4, 0, [4, 0], [1, 1], 2.0));
        let lit: Vec<bool> = film
            .pixels()
            .iter()
            .map(|pixel| pixel.xyz[1] > 0.0)
            .collect();
        assert_eq!(lit.iter().filter(|&&lit| lit).count(), 3);
        assert!(lit[4] && lit[9] && lit[14]);
    }

    #[test]
    fn what_a_packet_took_is_its_rays_evenly() {
        // Two packets across, one of them a single ray wide, and two down.
        let mut counted = tile(2, 0, [10, 4], [5, 6], 1.0);
        counted.taken = vec![160, 8, 40, 6];
        assert_eq!(counted.samples(), 214);
        let each = [[0, 0], [4, 3], [3, 4], [4, 5]].map(|[x, y]| counted.samples_of(x, y));
        assert_eq!(each, [10.0, 2.0, 5.0, 3.0]);
        // The last ray's block ends with the picture.
        assert_eq!(counted.block(4, 5, [19, 20]), [18..19, 14..16]);
        // Nobody has counted.
        assert_eq!(tile(1, 0, [0, 0], [1, 1], 1.0).samples_of(0, 0), 0.0);
    }

    #[test]
    fn packets_by_themselves_are_the_tile() {
        let size = [19, 20];
        let mut whole = tile(2, 0, [10, 4], [5, 6], 0.0);
        for (i, pixel) in (0_u16..).zip(&mut whole.pixels) {
            pixel.xyz[1] = f32::from(i);
        }
        whole.taken = vec![160, 8, 40, 6];
        let packets: Vec<Tile> = (0..4).map(|i| whole.packet(i)).collect();
        assert_eq!([packets[1].origin, packets[2].origin], [[18, 4], [10, 12]]);
        assert_eq!([packets[1].size, packets[2].size], [[1, 4], [4, 2]]);
        let [mut one, mut other] = [Film::new(size), Film::new(size)];
        one.merge(&whole);
        for packet in &packets {
            other.merge(packet);
        }
        assert_eq!(one, other);
        let samples: u64 = packets.iter().map(Tile::samples).sum();
        assert_eq!(samples, whole.samples());
    }

    #[test]
    fn samples_are_averaged_and_a_new_first_sample_replaces_them() {
        let mut film = Film::new([1, 1]);
        for (sample, y) in [1.0, 2.0, 6.0].into_iter().enumerate() {
            film.merge(&tile(1, sample as u32, [0, 0], [1, 1], y));
        }
        assert_eq!(film.pixels()[0].xyz[1], 3.0);
        film.merge(&tile(1, 0, [0, 0], [1, 1], 7.0));
        assert_eq!(film.pixels()[0].xyz[1], 7.0);
    }
}
