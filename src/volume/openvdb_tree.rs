//! An OpenVDB tree as bricks. Its leaves are bricks already, in another order; its tiles are runs of them.

use std::path::Path;

use glam::IVec3;
use openvdb_rs::math::Coord;
use openvdb_rs::tree::{LeafNode, Tree};
use openvdb_rs::types::Value;
use rayon::prelude::*;

use super::build::{GridHead, NewBrick, Tally, is_usable};
use super::grid::Grid;
use super::lattice::{BRICK_EDGE, BRICK_LEN, IndexBox, MAX_COORDINATE};
use super::watch::Stretch;
use super::{Limits, VolumeError};

/// The grid of a tree: active voxels of leaves, and active tiles of every level.
///
/// # Errors
/// A box or a number of bricks beyond the limits, before anything of that size is allocated;
/// [`VolumeError::Cancelled`].
pub(super) fn bricks<T: Value>(
    path: &Path,
    mut head: GridHead,
    tree: &Tree<T>,
    to_f32: impl Fn(T) -> f32 + Sync,
    left: &Limits,
    stretch: Stretch,
) -> Result<(Grid, Tally), VolumeError> {
    let background = to_f32(*tree.background());
    head.background = if is_usable(background) {
        background
    } else {
        0.0
    };
    let background = head.background;

    let mut extent = IndexBox::EMPTY;
    let mut fits = true;
    let mut cover = |origin: Coord, bricks: i32| {
        let min = IVec3::from_array(std::array::from_fn(|axis| origin[axis]));
        fits &= (0..3).all(|axis| i64::from(min[axis]).abs() <= MAX_COORDINATE);
        extent = extent.union(IndexBox {
            min,
            max: min.saturating_add(IVec3::splat(bricks * BRICK_EDGE)),
        });
        min.map(|c| c.div_euclid(BRICK_EDGE))
    };
    let mut leaves: Vec<(IVec3, &LeafNode<T>)> = Vec::new();
    for leaf in tree.leaf_refs() {
        if !leaf.is_empty() {
            leaves.push((cover(leaf.offset_to_global_coord(0), 1), leaf));
        }
    }
    let mut tiles: Vec<(IVec3, i32, f32)> = Vec::new();
    tree.visit_tiles(&mut |tile, value, active, level| {
        if active {
            let edge = bricks_per_tile(level);
            tiles.push((cover(tile.min, edge), edge, to_f32(*value)));
        }
    });

    let what = format!("grid {}", head.name);
    if !fits {
        return Err(VolumeError::Malformed {
            path: path.to_owned(),
            line: None,
            message: format!(
                "expected voxels within ±{MAX_COORDINATE} of the origin, {what} has some beyond; remove the stray voxels"
            ),
        });
    }
    left.check_extent(path, &format!("the box of {what}"), extent)?;
    let tile_bricks = tiles.iter().fold(0u64, |sum, (_, edge, _)| {
        sum.saturating_add(u64::from(edge.unsigned_abs()).pow(3))
    });
    let each = size_of::<NewBrick>() as u64;
    let dense = (leaves.len() as u64).saturating_mul((BRICK_LEN * size_of::<f32>()) as u64);
    let needed = (leaves.len() as u64)
        .saturating_add(tile_bricks)
        .saturating_mul(each)
        .saturating_add(dense);
    left.check_bytes(path, &what, needed)?;

    let rows = tiles.iter().map(|(_, edge, _)| *edge as usize);
    let counter = stretch.counter(leaves.len() + rows.sum::<usize>());
    let mut bricks: Vec<NewBrick> = leaves
        .into_par_iter()
        .map(|(coordinate, leaf)| {
            if !counter.goes_on() {
                return Err(VolumeError::Cancelled);
            }
            Ok(NewBrick::from_samples(coordinate, background, |voxel| {
                let offset = LeafNode::<T>::coord_to_offset(&Coord::new(voxel.x, voxel.y, voxel.z));
                leaf.is_value_on_at(offset)
                    .then(|| to_f32(*leaf.get_value_at(offset)))
            }))
        })
        .collect::<Result<_, _>>()?;
    for (origin, edge, value) in tiles {
        for z in 0..edge {
            if !counter.goes_on() {
                return Err(VolumeError::Cancelled);
            }
            for y in 0..edge {
                for x in 0..edge {
                    let coordinate = origin + IVec3::new(x, y, z);
                    bricks.push(NewBrick::constant(coordinate, value, background));
                }
            }
        }
    }
    Ok(Grid::from_bricks(head, bricks))
}

/// Edge in bricks of a tile owned by a node of this level: 8, 128 or 4096 voxels.
fn bricks_per_tile(level: u32) -> i32 {
    match level {
        0 | 1 => 1,
        2 => 16,
        _ => 512,
    }
}
