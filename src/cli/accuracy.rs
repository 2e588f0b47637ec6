//! What is told of a picture's error: what was wished, what is expected, and why it is no better.

use serde_json::{Value, json};

use super::json::finite;
use crate::project;
use crate::render::Frame;
use crate::study::{Aim, Error, Numbers, Split};

/// Why a picture is as exact as it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StoppedBy {
    /// It is as exact as was wished.
    Target,
    /// There was no time for more.
    TimeLimit,
    /// No numbers that are tried are as exact as was wished.
    Finest,
    /// The numbers were set by hand.
    Settings,
}

/// What is known of a picture's error.
#[derive(Debug, Clone)]
pub(super) struct Accuracy {
    wished: project::Accuracy,
    stopped_by: StoppedBy,
    /// `None` where nobody has looked.
    known: Option<Known>,
}

#[derive(Debug, Clone)]
struct Known {
    expected: Split,
    own: Error,
    left_out_de: f64,
    cpu_s: f64,
    wall_s: f64,
    share: f64,
}

impl Accuracy {
    /// `has_limit`: whether the picture had to be done in time.
    pub(super) fn of(aim: &Aim, wished: project::Accuracy, frame: &Frame, has_limit: bool) -> Self {
        let numbers = Numbers::of(&aim.settings).carrying(aim.plan.wavelengths());
        let known = aim.pilot.as_ref().map(|pilot| {
            let [cpu_s, wall_s] = pilot.seconds(numbers);
            Known {
                expected: pilot.error(numbers),
                own: pilot.own_error(),
                left_out_de: aim.plan.left_out_de(),
                cpu_s,
                wall_s,
                share: pilot.share(),
            }
        });
        let is_good = known
            .as_ref()
            .is_some_and(|known| known.expected.all.de95 <= wished.target_de);
        let stopped_by = match (&aim.pilot, is_good && frame.finished) {
            (None, _) if frame.finished && !(has_limit && wished.is_open()) => StoppedBy::Settings,
            (Some(_), true) => StoppedBy::Target,
            (Some(pilot), false) if frame.finished => {
                let chosen = Numbers::of(&aim.settings);
                if !has_limit || pilot.choose(wished, chosen) == chosen {
                    StoppedBy::Finest
                } else {
                    StoppedBy::TimeLimit
                }
            }
            _ => StoppedBy::TimeLimit,
        };
        Self {
            wished,
            stopped_by,
            known,
        }
    }

    pub(super) fn to_json(&self) -> Value {
        let stopped_by = match self.stopped_by {
            StoppedBy::Target => "target",
            StoppedBy::TimeLimit => "time-limit",
            StoppedBy::Finest => "finest",
            StoppedBy::Settings => "settings",
        };
        let known = self.known.as_ref().map(|known| {
            let Split {
                step,
                wavelengths,
                rays,
                all,
            } = known.expected;
            json!({
                "de95": finite(all.de95),
                "de_mean": finite(all.de_mean),
                "rel_y": finite(all.rel_y),
                "rel_xyz": finite(all.rel_xyz),
                "of_step_de95": finite(step),
                "of_wavelengths_de95": finite(wavelengths),
                "of_rays_de95": finite(rays),
                "effects_left_out_at_most_de": finite(known.left_out_de),
                "reference_de95": finite(known.own.de95),
                "march_cpu_seconds": finite(known.cpu_s),
                "march_seconds": finite(known.wall_s),
                "share_of_pixels": finite(known.share),
            })
        });
        json!({
            "wished_de95": finite(self.wished.target_de),
            "stopped_by": stopped_by,
            // Null where nobody has looked: every number was set by hand, or nothing can be seen.
            "expected": known,
        })
    }
}
