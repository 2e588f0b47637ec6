//! Where sixteen rays are on their ways: each in a span of samples of the same length, one sample of each at a time.

use super::chord::{Chord, Run};
use super::glow::Step;
use super::lookup::lookup_lanes;
use super::scatter::InScatter;
use crate::math::lanes::{Arithmetic, LANES, Lanes};
use crate::scene::medium::Medium;

/// Rays side by side.
pub(super) struct Packet<'a> {
    chords: [Option<&'a Chord>; LANES],
    pub(super) is_bent: bool,
}

impl<'a> Packet<'a> {
    pub(super) fn new(chords: [Option<&'a Chord>; LANES]) -> Self {
        let is_bent = |chord: &&Chord| !chord.middles.is_empty();
        Self {
            chords,
            is_bent: chords.iter().flatten().any(is_bent),
        }
    }
}

/// Where each ray of a packet is on its way: in a span of steps of the same length.
pub(super) struct Walk<'a> {
    packet: &'a Packet<'a>,
    /// Length of a step that is not cut, m.
    step_m: f32,
    /// Lattice positions where the chords begin and vectors of whole steps, by axis.
    start: [[f64; LANES]; 3],
    delta: [[f64; LANES]; 3],
    /// Middle of the next sample, whole steps from the chord's begin.
    middle: [f64; LANES],
    /// Length of a sample, as a share of a whole step, and the same for positions.
    share: Lanes,
    pace: [f64; LANES],
    /// Samples of the span that are left; 0 for a ray that is through.
    left: [u32; LANES],
    /// The run that the span is in, and the step after the span.
    run: [usize; LANES],
    step: [u32; LANES],
}

impl<'a> Walk<'a> {
    #[inline(always)]
    pub(super) fn new(packet: &'a Packet<'a>, step_m: f32) -> Self {
        let mut walk = Self {
            packet,
            step_m,
            start: [[0.0; LANES]; 3],
            delta: [[0.0; LANES]; 3],
            middle: [0.0; LANES],
            share: [0.0; LANES],
            pace: [0.0; LANES],
            left: [0; LANES],
            run: [0; LANES],
            step: [0; LANES],
        };
        for (lane, chord) in packet.chords.iter().enumerate() {
            let Some(chord) = chord else { continue };
            for axis in 0..3 {
                walk.start[axis][lane] = chord.start[axis];
                walk.delta[axis][lane] = chord.delta[axis];
            }
            walk.step[lane] = chord.runs[0].first;
            walk.enter_span(chord, lane);
        }
        walk
    }

    /// Begins the next span of a ray: the whole steps of a run, or the last step, which is shorter.
    fn enter_span(&mut self, chord: &Chord, lane: usize) {
        let mut first = self.step[lane];
        if first == chord.runs[self.run[lane]].end {
            self.run[lane] += 1;
            let Some(run) = chord.runs.get(self.run[lane]) else {
                self.stop(lane);
                return;
            };
            first = run.first;
        }
        let Run { end, cuts, .. } = chord.runs[self.run[lane]];
        let (end, length) = if first == chord.last {
            (end, f64::from(chord.last_share))
        } else {
            (end.min(chord.last), 1.0)
        };
        let share = length / f64::from(cuts);
        self.pace[lane] = share;
        self.share[lane] = share as f32;
        self.middle[lane] = f64::from(first) + 0.5 * share;
        self.left[lane] = (end - first) * cuts;
        self.step[lane] = end;
    }

    /// Ends a ray.
    #[inline(always)]
    pub(super) fn stop(&mut self, lane: usize) {
        self.left[lane] = 0;
        self.share[lane] = 0.0;
    }

    /// Each ray takes its next sample; those that are through take an empty one. Also how many took one.
    #[inline(always)]
    pub(super) fn next<A: Arithmetic, const GAS: bool, const SCATTER: bool, const BEND: bool>(
        &mut self,
        medium: &Medium,
        scatter: Option<&InScatter>,
        around: &mut [Lanes],
    ) -> (Step, u64) {
        let mut position: [[f64; LANES]; 3] = std::array::from_fn(|axis| {
            std::array::from_fn(|lane| {
                self.start[axis][lane] + self.middle[lane] * self.delta[axis][lane]
            })
        });
        if BEND {
            for (lane, chord) in self.packet.chords.iter().enumerate() {
                let Some(chord) = chord else { continue };
                if self.left[lane] > 0 && !chord.middles.is_empty() {
                    let middle = chord.bent_at(self.middle[lane]);
                    for axis in 0..3 {
                        position[axis][lane] = middle[axis];
                    }
                }
            }
        }
        let found = lookup_lanes::<A, GAS, SCATTER>(medium, &position, &self.left);
        let length: Lanes = std::array::from_fn(|lane| self.step_m * self.share[lane]);
        let mut taken = Step {
            column: std::array::from_fn(|lane| found[lane][0] * length[lane]),
            smoke: [0.0; LANES],
            inverse_temperature: std::array::from_fn(|lane| 1.0 / found[lane][1]),
            flame: [0.0; LANES],
            length,
        };
        if GAS {
            taken.flame = std::array::from_fn(|lane| found[lane][2]);
        }
        if SCATTER {
            taken.smoke = std::array::from_fn(|lane| found[lane][3] * length[lane]);
            if let Some(scatter) = scatter {
                for lane in 0..LANES {
                    if self.left[lane] > 0 {
                        let position = std::array::from_fn(|axis| position[axis][lane]);
                        scatter.read(position, lane, around);
                    }
                }
            }
        }
        let mut active = 0;
        for lane in 0..LANES {
            active += u64::from(self.left[lane] > 0);
        }
        // Spans end seldom: first all lanes as if none did.
        let ends = self.left.map(|left| left == 1);
        for (middle, pace) in self.middle.iter_mut().zip(&self.pace) {
            *middle += pace;
        }
        self.left = self.left.map(|left| left.saturating_sub(1));
        for (lane, chord) in self.packet.chords.iter().enumerate() {
            if let (true, Some(chord)) = (ends[lane], chord) {
                self.enter_span(chord, lane);
            }
        }
        (taken, active)
    }
}
