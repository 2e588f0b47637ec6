//! A tile that takes its time is handed on in pieces, so that a person sees that it goes on.

use std::time::{Duration, Instant};

use super::film::Tile;

/// Hands on what there is of one tile.
pub(super) struct Prompt<'a> {
    patience: Duration,
    sink: &'a (dyn Fn(Tile) + Sync),
    /// Packets that were handed on.
    handed: usize,
    since: Instant,
}

impl<'a> Prompt<'a> {
    /// Whose packets wait at most so long, and the time that one takes.
    pub(super) fn new(patience: Duration, sink: &'a (dyn Fn(Tile) + Sync)) -> Self {
        Self {
            patience,
            sink,
            handed: 0,
            since: Instant::now(),
        }
    }

    /// One more packet is in the tile.
    pub(super) fn hear(&mut self, tile: &Tile) {
        if self.since.elapsed() >= self.patience {
            self.hand_on(tile);
            self.since = Instant::now();
        }
    }

    /// The tile is whole: it is handed on as one, or what is missing of it.
    pub(super) fn end(mut self, tile: Tile) {
        if self.handed == 0 {
            (self.sink)(tile);
        } else {
            self.hand_on(&tile);
        }
    }

    fn hand_on(&mut self, tile: &Tile) {
        let there = tile.taken.len();
        for packet in self.handed..there {
            (self.sink)(tile.packet(packet));
        }
        self.handed = there;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Mutex, PoisonError};

    use super::*;
    use crate::render::film::{Film, Pixel};

    /// What is handed on of a tile of two by two packets, and the film of it.
    fn handed(patience: Duration) -> (usize, Film) {
        let tiles = Mutex::new(Vec::new());
        let sink = |tile| {
            let mut tiles = tiles.lock().unwrap_or_else(PoisonError::into_inner);
            tiles.push(tile);
        };
        let mut tile = Tile {
            stride: 1,
            sample: 0,
            origin: [0, 0],
            size: [8, 8],
            pixels: Vec::new(),
            taken: Vec::new(),
        };
        tile.pixels = (0_u8..64)
            .map(|i| Pixel {
                xyz: [f32::from(i); 3],
                opacity: [0.0; 3],
            })
            .collect();
        let mut prompt = Prompt::new(patience, &sink);
        for took in 1..=4 {
            tile.taken.push(took);
            prompt.hear(&tile);
        }
        prompt.end(tile);
        let tiles = tiles.into_inner().unwrap_or_default();
        let mut film = Film::new([8, 8]);
        for tile in &tiles {
            film.merge(tile);
        }
        (tiles.len(), film)
    }

    #[test]
    fn a_slow_tile_comes_in_packets_and_a_quick_one_whole() {
        let (slow, in_packets) = handed(Duration::ZERO);
        let (quick, whole) = handed(Duration::MAX);
        assert_eq!([slow, quick], [4, 1]);
        assert_eq!(in_packets, whole);
    }
}
