//! What a pass computes for sixteen neighbouring pixels: the march, and where it is asked for light that was scattered more
//! than once.

use super::Cancel;
use super::fields::Fields;
use super::film::Pixel;
use super::march::Marcher;
use super::orders::HigherOrders;
use super::plan::Plan;
use crate::math::lanes::LANES;
use crate::scene::Scene;
use crate::scene::camera::CameraError;

/// Points of a picture, pixels from its upper left corner; `None` beyond its edges.
pub(super) type Points = [Option<[f64; 2]>; LANES];

/// Renders packets of rays of one picture.
pub(super) struct Packets<'a> {
    marcher: Marcher<'a>,
    higher: Option<HigherOrders<'a>>,
}

impl<'a> Packets<'a> {
    /// Prepares it with the plan's fields, in the calling thread's rayon pool. `by_paths`: whether light is followed by paths
    /// where the plan says so.
    ///
    /// # Errors
    /// The camera cannot see.
    pub(super) fn new(
        scene: &'a Scene,
        plan: &'a Plan,
        fields: &'a Fields,
        step_voxels: f64,
        by_paths: bool,
    ) -> Result<Self, CameraError> {
        let marcher = Marcher::with_fields(scene, plan, fields, step_voxels)?.for_a_picture();
        let higher = (by_paths && plan.orders > 1)
            .then(|| HigherOrders::new(scene, &plan.tables, plan.orders));
        Ok(Self { marcher, higher })
    }

    /// The light through these points, as this sample of their pixels, and how many samples of the medium it took. The
    /// cancel is asked before it begins and before each path; `None` if it was cancelled.
    pub(super) fn render(
        &self,
        points: &Points,
        sample: u32,
        cancel: &Cancel,
    ) -> Option<([Pixel; LANES], u64)> {
        if cancel.is_cancelled() {
            return None;
        }
        let (mut pixels, taken) = self.marcher.march(points);
        if let Some(higher) = &self.higher {
            for (pixel, point) in pixels.iter_mut().zip(points) {
                if let Some(point) = point {
                    higher.add(*point, sample, pixel, cancel);
                }
                if cancel.is_cancelled() {
                    return None;
                }
            }
        }
        Some((pixels, taken))
    }
}
