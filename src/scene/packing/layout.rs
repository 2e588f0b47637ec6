//! Where bricks go, before any is made.

use glam::{IVec3, UVec3};

use super::super::interpolation::Interpolation;
use super::super::medium::{BRICK, BRICK_SAMPLES, Sample};
use super::super::source::Source;
use super::{BURNING_K, Burning, Fields, PackingError};
use crate::math::Aabb;
use crate::volume::{FieldMap, Grid, Limits};

/// Where bricks go.
pub(super) struct Layout<'a> {
    /// The grid whose lattice is packed.
    pub(super) reference: &'a Grid,
    /// Soot and smoke.
    pub(super) absorbers: Vec<Source<'a>>,
    /// Box of the voxels, min inside, max outside.
    pub(super) voxels: [IVec3; 2],
    /// First voxel of the lattice, on a brick's border.
    pub(super) origin: IVec3,
    /// Bricks of the lattice along each axis.
    pub(super) bricks: UVec3,
    /// Bricks that may show something, in the order of the table.
    pub(super) occupied: Vec<UVec3>,
}

impl<'a> Layout<'a> {
    /// `None` if there is nothing to pack.
    ///
    /// # Errors
    /// The fields lie too far apart, or fill too many bricks.
    pub(super) fn new(fields: &Fields<'a>, limits: &Limits) -> Result<Option<Self>, PackingError> {
        let Fields { volume, maps, .. } = *fields;
        let grid_of = |map: &Option<FieldMap>| map.as_ref().and_then(|map| volume.grid(&map.grid));
        let by_rank = [&maps.soot, &maps.smoke, &maps.flame, &maps.temperature];
        let Some(reference) = by_rank.into_iter().find_map(grid_of) else {
            return Ok(None);
        };
        let source = |map: &'a Option<FieldMap>, amount: f64| {
            Source::new(volume, map.as_ref(), reference, amount).filter(Source::has_data)
        };
        let smoke = absorber(fields, maps.smoke.as_ref(), fields.amounts[1], reference);
        let smoke_apart = fields.smoke_apart && smoke.is_some();
        let absorbers: Vec<Source<'a>> =
            absorber(fields, maps.soot.as_ref(), fields.amounts[0], reference)
                .into_iter()
                .chain(smoke)
                .collect();
        // What glows in the gas, and from which value of its field on.
        let burning = fields.gas.burning.and_then(|burning| match burning {
            Burning::Field => Some((source(&maps.flame, 1.0)?, 0.0)),
            Burning::Temperature => Some((source(&maps.temperature, 1.0)?, BURNING_K[0])),
        });
        let hot = fields
            .gas
            .hot_above_k
            .and_then(|kelvin| Some((source(&maps.temperature, 1.0)?, kelvin)));
        let bending = fields
            .gas
            .bends_above_k
            .and_then(|kelvin| Some((source(&maps.temperature, 1.0)?, kelvin)));
        let gases: Vec<(Source<'a>, f64)> = burning.into_iter().chain(hot).collect();

        let seen = |(source, above)| Shown {
            source,
            above,
            margin: 0,
        };
        let absorbing = absorbers.iter().map(|source| seen((source, 0.0)));
        let shining = gases.iter().map(|(source, above)| seen((source, *above)));
        // Where light is bent the difference between neighbours counts, a voxel further.
        let bending = bending.iter().map(|(source, above)| Shown {
            margin: 1,
            ..seen((source, *above))
        });
        let shown: Vec<Shown<'_>> = absorbing.chain(shining).chain(bending).collect();
        if shown.is_empty() {
            return Ok(None);
        }
        let [min, max] = hull(&shown, limits)?;

        // Around the voxels, from a brick's border on: what an interpolation reaches, and a voxel for rounding.
        let reach = fields.interpolation.reach();
        let edge = BRICK as i32;
        let origin = (min - reach).div_euclid(IVec3::splat(edge)) * edge;
        let bricks = ((max + reach - origin + edge - 1) / edge).as_uvec3();
        let beside = match fields.interpolation {
            Interpolation::Tricubic => 1,
            Interpolation::Nearest | Interpolation::Trilinear => 0,
        };
        let occupied = occupied_bricks(&shown, origin, bricks, beside);
        let beside = usize::from(fields.gas.burning.is_some()) + usize::from(smoke_apart);
        let size = size_of::<Sample>() + beside * size_of::<f32>();
        let bytes = (occupied.len() * BRICK_SAMPLES * size) as u64;
        if bytes > limits.max_bytes {
            return Err(PackingError::TooLarge {
                bricks: occupied.len() as u64,
                bytes,
                limit: limits.max_bytes,
            });
        }
        Ok(Some(Self {
            reference,
            absorbers,
            voxels: [min, max],
            origin,
            bricks,
            occupied,
        }))
    }
}

/// A field that shows, or bends light, where it is above a value; and how many voxels beside that count.
struct Shown<'a> {
    source: &'a Source<'a>,
    above: f64,
    margin: i32,
}

/// Soot or smoke as it is packed, times its amount; `None` if there is none.
pub(super) fn absorber<'a>(
    fields: &Fields<'a>,
    map: Option<&'a FieldMap>,
    amount: f64,
    reference: &Grid,
) -> Option<Source<'a>> {
    let source = Source::new(fields.volume, map, reference, amount);
    source.filter(|source| amount > 0.0 && source.has_data())
}

/// The box of everything that may show, min inside, max outside.
fn hull(shown: &[Shown<'_>], limits: &Limits) -> Result<[IVec3; 2], PackingError> {
    // In f64, where grids that lie far apart do not overflow.
    let hull = shown.iter().fold(Aabb::EMPTY, |hull, shown| {
        hull.union(&shown.source.bounds())
    });
    let across = hull.size() / BRICK as f64 + 3.0;
    let widest = 2_f64.powi(29);
    let fits = across.element_product() <= limits.max_extent_bricks as f64;
    // A hull that is not a number, of transforms beyond f64, does not fit either.
    if !fits || hull.min.min_element() < -widest || hull.max.max_element() > widest {
        return Err(PackingError::TooWide {
            voxels: hull.size().to_array(),
            limit: limits.max_extent_bricks,
        });
    }
    Ok([hull.min.as_ivec3(), hull.max.as_ivec3()])
}

/// Bricks that anything may reach with a sample, and those up to `beside` bricks off, in the order of the table.
fn occupied_bricks(shown: &[Shown<'_>], origin: IVec3, bricks: UVec3, beside: i32) -> Vec<UVec3> {
    let count = bricks.as_u64vec3().element_product() as usize;
    let mut marks = vec![false; count];
    let edge = IVec3::splat(BRICK as i32);
    let (width, height) = (bricks.x as usize, bricks.y as usize);
    for &Shown {
        source,
        above,
        margin,
    } in shown
    {
        source.for_each_above(above, |voxels| {
            // A brick at 8b holds samples 8b to 8b + 8, so a voxel on a border is in two of them.
            let min = voxels.min.as_ivec3() - margin;
            let max = voxels.max.as_ivec3() + margin;
            let first = (min - 1 - origin).div_euclid(edge) - beside;
            let last = (max - origin).div_euclid(edge) + beside;
            let range = [first.max(IVec3::ZERO), last.min(bricks.as_ivec3() - 1)];
            for_each_in(range, |brick| {
                let row = brick.z as usize * height + brick.y as usize;
                marks[row * width + brick.x as usize] = true;
            });
        });
    }
    let position = |i: usize| {
        UVec3::new(
            (i % width) as u32,
            (i / width % height) as u32,
            (i / width / height) as u32,
        )
    };
    (0..count).filter(|&i| marks[i]).map(position).collect()
}

/// Visits the bricks from the first to the last, both included.
pub(super) fn for_each_in([first, last]: [IVec3; 2], mut visit: impl FnMut(IVec3)) {
    for z in first.z..=last.z {
        for y in first.y..=last.y {
            for x in first.x..=last.x {
                visit(IVec3::new(x, y, z));
            }
        }
    }
}
