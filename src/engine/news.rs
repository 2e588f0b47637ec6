//! What the engine tells: news of the running job, and its scene for whoever wants to look closer.

use std::sync::Arc;
use std::time::Duration;

use crate::render::costs::Cost;
use crate::render::plan::Decision;
use crate::render::{Effects, Facts, Flaws, Pass, Plan, Settings, Tile};
use crate::scene::Scene;

/// Which submit something belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Generation(pub(super) u64);

/// News from the engine.
#[derive(Debug)]
pub struct Update {
    /// The submit that it belongs to.
    pub generation: Generation,
    /// What happened.
    pub news: News,
}

/// What happened to a job.
#[derive(Debug)]
pub enum News {
    /// The medium is packed, the passes begin.
    Started {
        /// The passes to come.
        passes: Vec<Pass>,
        /// Size of the picture in pixels.
        size: [u32; 2],
        /// Time the packing and baking took.
        bake: Duration,
        /// What the settings cannot show faithfully.
        flaws: Flaws,
        /// Which effects are computed, and why.
        decisions: Vec<Decision>,
    },
    /// What the next pass needs is worked out, its rays begin.
    PassBegun {
        /// Time since the submit.
        since_submit: Duration,
    },
    /// A tile of the running pass.
    Tile(Tile),
    /// A pass is whole.
    PassDone {
        /// Its index among the passes.
        index: usize,
        /// Time since the submit.
        since_submit: Duration,
        /// Time the pass took.
        took: Duration,
        /// What has been found out about the picture so far.
        facts: Facts,
    },
    /// All passes are whole.
    Finished,
    /// What each effect costs or would cost in this picture, measured once there was nothing else to do.
    Costs(Vec<Cost>),
    /// A worker failed; the words say how.
    Failed(String),
}

/// A job's scene as it is being rendered, lent to whoever wants to look closer. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Packed {
    /// The submit that it belongs to.
    pub generation: Generation,
    /// The packed scene.
    pub scene: Scene,
    /// Size of its picture in pixels.
    pub size: [u32; 2],
    /// Which effects are computed: none is left to be decided, so that who looks closer looks at what is on show.
    pub effects: Effects,
    /// How accurately it is rendered.
    pub settings: Settings,
    /// What is computed, with the fields as soon as they are worked out.
    pub plan: Arc<Plan>,
}
