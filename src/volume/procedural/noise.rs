//! Gradient noise, and a smooth step.

use glam::{IVec3, Vec3};

/// 0 below `low`, 1 above `high`, smooth between.
pub(super) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

pub(super) fn noise_vector(point: Vec3) -> Vec3 {
    Vec3::new(
        noise(point),
        noise(point + Vec3::new(31.4, 17.2, 5.9)),
        noise(point - Vec3::new(11.8, 47.3, 23.1)),
    )
}

/// Gradient noise, about −1 to 1, features of size 1 (Perlin 2002: quintic fade, twelve edge gradients).
pub(super) fn noise(point: Vec3) -> f32 {
    // Rounded down without a call: the coordinates are far below 2³¹.
    let toward_zero = point.as_ivec3();
    let above = toward_zero.as_vec3().cmpgt(point);
    let cell = toward_zero - IVec3::new(i32::from(above.x), i32::from(above.y), i32::from(above.z));
    let f = point - cell.as_vec3();
    let fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let corner = |x: i32, y: i32, z: i32| {
        let offset = IVec3::new(x, y, z);
        gradient(cell + offset).dot(f - offset.as_vec3())
    };
    let mix = |a: f32, b: f32, t: f32| a + t * (b - a);
    let along_x = |y, z| mix(corner(0, y, z), corner(1, y, z), fade.x);
    let along_y = |z| mix(along_x(0, z), along_x(1, z), fade.y);
    mix(along_y(0), along_y(1), fade.z)
}

/// The directions from a cube's centre to the middles of its edges.
const GRADIENTS: [Vec3; 12] = {
    const fn edges(x: Vec3, y: Vec3) -> [Vec3; 4] {
        [
            sum(x, y, 1.0, 1.0),
            sum(x, y, -1.0, 1.0),
            sum(x, y, 1.0, -1.0),
            sum(x, y, -1.0, -1.0),
        ]
    }
    const fn sum(x: Vec3, y: Vec3, a: f32, b: f32) -> Vec3 {
        Vec3::new(a * x.x + b * y.x, a * x.y + b * y.y, a * x.z + b * y.z)
    }
    let [p, q, r] = [
        edges(Vec3::X, Vec3::Y),
        edges(Vec3::X, Vec3::Z),
        edges(Vec3::Y, Vec3::Z),
    ];
    [
        p[0], p[1], p[2], p[3], q[0], q[1], q[2], q[3], r[0], r[1], r[2], r[3],
    ]
};

/// One of [`GRADIENTS`], by a hash of the lattice point (mixing as in MurmurHash3,
/// Appleby 2011).
fn gradient(point: IVec3) -> Vec3 {
    let mut hash = (point.x as u32).wrapping_mul(0x9e37_79b1)
        ^ (point.y as u32).wrapping_mul(0x85eb_ca77)
        ^ (point.z as u32).wrapping_mul(0xc2b2_ae3d);
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^= hash >> 16;
    GRADIENTS[(hash % 3 * 4 + (hash >> 8 & 3)) as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_continuous_and_bounded() {
        let mut before = noise(Vec3::new(0.0, 0.0, 0.3));
        for i in 1..20_000 {
            let value = noise(Vec3::new(i as f32 * 1e-3, i as f32 * 7e-4, 0.3));
            // A step of 1.2e-3 at a slope that the quintic fade keeps below 6.
            assert!(
                (value - before).abs() < 7.5e-3 && value.abs() <= 1.1,
                "{before} {value}"
            );
            before = value;
        }
    }
}
