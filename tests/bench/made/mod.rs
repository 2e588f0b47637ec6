//! Fires of any size and fullness, and files of them in every format: what no folder of real fires has.

#![allow(dead_code, reason = "each bench needs a part of it")]

use std::fmt::Write as _;
use std::fs;
use std::io::{BufWriter, Write};
use std::path::Path;

use glam::{DAffine3, DVec3, IVec3};
use openvdb_rs::FloatGrid;
use openvdb_rs::io::{WriteOptions, write_to};
use openvdb_rs::math::{Coord, Transform, Vec3d};
use openvdb_rs::metadata::MetaMap;
use rayon::prelude::*;
use sootlight::volume::{Border, Grid, Volume};

use super::Failure;

/// A swaying column of flame in a cube of voxels.
#[derive(Clone, Copy)]
pub(crate) struct Fire {
    /// Voxels along each axis.
    pub(crate) side: i32,
    /// Radius of the column over the side of the cube. From 1 on the column fills the cube.
    pub(crate) radius: f64,
}

/// One of a fire's two fields.
#[derive(Clone, Copy)]
pub(crate) enum Field {
    /// Soot volume fraction.
    Soot,
    /// Kelvin.
    Temperature,
}

/// How a file is written.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    DenseAscii,
    SparseAscii,
    SparseBinary,
    /// Half floats, zipped.
    OpenVdb,
}

impl Field {
    pub(crate) const BOTH: [Self; 2] = [Self::Soot, Self::Temperature];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Soot => "soot",
            Self::Temperature => "temperature",
        }
    }

    /// The value of what is outside the flame.
    fn ambient(self) -> f32 {
        match self {
            Self::Soot => 0.0,
            Self::Temperature => 300.0,
        }
    }
}

impl Kind {
    pub(crate) const ALL: [Self; 4] = [
        Self::DenseAscii,
        Self::SparseAscii,
        Self::SparseBinary,
        Self::OpenVdb,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::DenseAscii => "dense ASCII",
            Self::SparseAscii => "sparse ASCII",
            Self::SparseBinary => "sparse binary",
            Self::OpenVdb => "OpenVDB",
        }
    }
}

impl Fire {
    /// A cube that is all flame.
    pub(crate) fn full(side: i32) -> Self {
        Self { side, radius: 2.0 }
    }

    /// Both fields in memory.
    pub(crate) fn volume(&self) -> Volume {
        let world = DAffine3::from_scale(DVec3::splat(1.0 / f64::from(self.side)))
            * DAffine3::from_translation(DVec3::splat(0.5));
        let grids = Field::BOTH.map(|field| {
            let (dims, ambient) = (IVec3::splat(self.side), field.ambient());
            let value = |voxel| self.value(field, voxel).unwrap_or(ambient);
            Grid::from_fn(
                field.name(),
                dims,
                world,
                Border::Background,
                ambient,
                value,
            )
        });
        Volume::from_grids(grids.to_vec(), "a column of flame")
    }

    /// The distance from the column's middle in its radii, 0 to 1; `None` outside.
    fn depth(&self, voxel: IVec3) -> Option<f64> {
        let [x, y, z] = ((voxel.as_dvec3() + 0.5) / f64::from(self.side)).to_array();
        let sway = 0.1 * (5.0 * z).sin() * (1.0 - self.radius).max(0.0);
        let from_middle = (x - 0.5 - sway).hypot(y - 0.5) / self.radius;
        (from_middle < 1.0).then_some(from_middle)
    }

    /// The value of a voxel in the flame; `None` outside.
    pub(crate) fn value(&self, field: Field, voxel: IVec3) -> Option<f32> {
        let depth = self.depth(voxel)?;
        let [x, y, z] = voxel.as_dvec3().to_array();
        let wrinkle = 1.0 + 0.3 * (0.4 * x + (0.3 * y).sin()).sin() * (0.35 * z).cos();
        let body = 1.0 - depth * depth;
        let value = match field {
            Field::Soot => 1e-9 + 1e-6 * body * wrinkle,
            Field::Temperature => 700.0 + 1200.0 * body * wrinkle,
        };
        Some(value as f32)
    }

    /// The voxels in the flame with their values, x fastest.
    fn voxels(&self, field: Field) -> Vec<(IVec3, f32)> {
        let side = self.side;
        let rows = (0..side * side).into_par_iter();
        rows.flat_map_iter(|row| {
            (0..side).filter_map(move |x| {
                let voxel = IVec3::new(x, row % side, row / side);
                Some((voxel, self.value(field, voxel)?))
            })
        })
        .collect()
    }

    /// Writes one field, or both where the format holds several, and gives the file's length.
    pub(crate) fn write(&self, kind: Kind, field: Field, path: &Path) -> Result<u64, Failure> {
        let mut file = BufWriter::new(fs::File::create(path)?);
        match kind {
            Kind::DenseAscii => self.write_dense(field, &mut file)?,
            Kind::SparseAscii => self.write_sparse(field, &mut file)?,
            Kind::SparseBinary => self.write_binary(field, &mut file)?,
            Kind::OpenVdb => {
                let grids = Field::BOTH.map(|field| self.vdb(field).into());
                write_to(&mut file, &grids, &MetaMap::new(), &WriteOptions::default())?;
            }
        }
        file.flush()?;
        Ok(fs::metadata(path)?.len())
    }

    /// The files of both fields in one format, in a folder.
    pub(crate) fn write_both(
        &self,
        kind: Kind,
        folder: &Path,
    ) -> Result<Vec<std::path::PathBuf>, Failure> {
        let fields = match kind {
            Kind::OpenVdb => &Field::BOTH[..1],
            _ => &Field::BOTH[..],
        };
        let each = fields.iter().map(|&field| {
            let path = folder.join(format!("{}.fire", field.name()));
            self.write(kind, field, &path)?;
            Ok(path)
        });
        each.collect()
    }

    fn write_dense(&self, field: Field, file: &mut impl Write) -> std::io::Result<()> {
        let side = self.side;
        writeln!(file, "{side} {side} {side}")?;
        for z in 0..side {
            let rows = (0..side).into_par_iter().map(|y| {
                let mut text = String::new();
                for x in 0..side {
                    let line = match self.value(field, IVec3::new(x, y, z)) {
                        Some(value) => writeln!(text, "{value:.6e}"),
                        None => writeln!(text, "{}", field.ambient()),
                    };
                    // Writing into a string cannot fail.
                    line.unwrap_or_default();
                }
                text
            });
            for row in rows.collect::<Vec<_>>() {
                file.write_all(row.as_bytes())?;
            }
        }
        Ok(())
    }

    fn write_sparse(&self, field: Field, file: &mut impl Write) -> std::io::Result<()> {
        let (side, voxels) = (self.side, self.voxels(field));
        let (count, ambient) = (voxels.len(), field.ambient());
        writeln!(file, "{side} {side} {side} {count} {ambient}")?;
        for (voxel, value) in voxels {
            writeln!(file, "{} {} {} {value:.6e}", voxel.x, voxel.y, voxel.z)?;
        }
        Ok(())
    }

    fn write_binary(&self, field: Field, file: &mut impl Write) -> std::io::Result<()> {
        let voxels = self.voxels(field);
        file.write_all(&(voxels.len() as i32).to_le_bytes())?;
        for (voxel, value) in voxels {
            for coordinate in voxel.to_array() {
                file.write_all(&coordinate.to_le_bytes())?;
            }
            for channel in [f64::from(value); 4] {
                file.write_all(&channel.to_le_bytes())?;
            }
        }
        Ok(())
    }

    fn vdb(&self, field: Field) -> FloatGrid {
        let mut transform = Transform::linear(1.0 / f64::from(self.side));
        transform.post_translate(Vec3d::splat(0.5 / f64::from(self.side)));
        let mut grid = FloatGrid::new(field.ambient())
            .with_transform(transform)
            .with_name(field.name());
        grid.set_save_float_as_half(matches!(field, Field::Temperature));
        let mut tree = grid.accessor_mut();
        for (voxel, value) in self.voxels(field) {
            tree.set_value(&Coord::new(voxel.x, voxel.y, voxel.z), value);
        }
        grid
    }
}
