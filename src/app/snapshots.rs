//! Snapshots: pictures as they were, with all that was set, to compare the picture on show with and to go back to.

use egui::{Context, TextureHandle, TextureOptions};

use super::document::Step;
use super::thumbnails::thumbnail;
use crate::colour::display::View;
use crate::engine::Picture;
use crate::render::Film;

/// Most that are kept: each holds a picture.
pub(super) const MOST: usize = 12;
/// Volumes that are kept in memory for their sake, the newest: they may be large, and can be read again.
const MOST_VOLUMES: usize = 2;

/// Every snapshot, and how the picture is compared with one of them.
pub(super) struct Snapshots {
    ctx: Context,
    all: Vec<Snapshot>,
    /// Which one it is compared with.
    chosen: u64,
    newest: u64,
    way: Way,
    /// Share of the picture's width that a wipe shows of the snapshot.
    share: f32,
}

/// A picture as it was.
pub(super) struct Snapshot {
    /// Its number, from 1.
    pub(super) number: u64,
    /// What was open.
    pub(super) title: String,
    pub(super) film: Film,
    pub(super) strides: Vec<u8>,
    pub(super) view: View,
    /// All that was set.
    pub(super) step: Step,
    pub(super) thumbnail: TextureHandle,
}

/// How two pictures are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Way {
    /// Only the picture on show is seen.
    #[default]
    Off,
    /// The snapshot left of a line, the picture right of it.
    Wipe,
    /// Only the snapshot is seen.
    Flip,
}

impl Snapshot {
    /// "Snapshot 2".
    pub(super) fn name(&self) -> String {
        format!("Snapshot {}", self.number)
    }
}

impl Snapshots {
    pub(super) fn new(ctx: &Context) -> Self {
        Self {
            ctx: ctx.clone(),
            all: Vec::new(),
            chosen: 0,
            newest: 0,
            way: Way::default(),
            share: 0.5,
        }
    }

    /// Every snapshot, oldest first.
    pub(super) fn all(&self) -> &[Snapshot] {
        &self.all
    }

    /// Whether there is room for one more.
    pub(super) fn is_full(&self) -> bool {
        self.all.len() >= MOST
    }

    /// Keeps a picture with what is set, and compares with it from here on. Nothing if it is full.
    pub(super) fn grab(&mut self, picture: &Picture, view: &View, title: String, step: Step) {
        if self.is_full() {
            return;
        }
        self.newest += 1;
        let image = thumbnail(picture.film(), view);
        let name = format!("snapshot {}", self.newest);
        self.all.push(Snapshot {
            number: self.newest,
            title,
            film: picture.film().clone(),
            strides: picture.strides().to_vec(),
            view: *view,
            step,
            thumbnail: self.ctx.load_texture(name, image, TextureOptions::LINEAR),
        });
        self.chosen = self.newest;
        self.let_volumes_go();
    }

    /// Holds no more than the newest few volumes.
    fn let_volumes_go(&mut self) {
        let mut held: Vec<Step> = Vec::new();
        for snapshot in self.all.iter_mut().rev() {
            let step = &mut snapshot.step;
            if !step.holds_a_volume() || held.iter().any(|it| it.is_of_one_volume_with(step)) {
                continue;
            }
            if held.len() < MOST_VOLUMES {
                held.push(step.clone());
            } else {
                step.let_the_volume_go();
            }
        }
    }

    /// The one that the picture is compared with.
    pub(super) fn chosen(&self) -> Option<&Snapshot> {
        self.get(self.chosen)
    }

    /// The one with this number.
    pub(super) fn get(&self, number: u64) -> Option<&Snapshot> {
        self.all.iter().find(|snapshot| snapshot.number == number)
    }

    /// Compares with this one from here on.
    pub(super) fn choose(&mut self, number: u64) {
        if self.get(number).is_some() {
            self.chosen = number;
        }
    }

    /// Throws one away.
    pub(super) fn forget(&mut self, number: u64) {
        self.all.retain(|snapshot| snapshot.number != number);
        if self.chosen == number {
            self.chosen = self.all.last().map_or(0, |last| last.number);
        }
        if self.all.is_empty() {
            self.way = Way::Off;
        }
    }

    /// Compares this way, or no more if it is that.
    pub(super) fn toggle(&mut self, way: Way) {
        let is_it = self.way == way || self.all.is_empty();
        self.way = if is_it { Way::Off } else { way };
    }

    /// Compares no more. True if it did.
    pub(super) fn close(&mut self) -> bool {
        std::mem::take(&mut self.way) != Way::Off
    }

    /// How pictures are compared.
    pub(super) fn way(&self) -> Way {
        self.way
    }

    /// Moves the line.
    pub(super) fn wipe_to(&mut self, share: f32) {
        self.share = share.clamp(0.0, 1.0);
    }

    /// The snapshot that is seen in place of the picture.
    pub(super) fn flipped(&self) -> Option<&Snapshot> {
        (self.way == Way::Flip).then(|| self.chosen()).flatten()
    }

    /// What is seen of a snapshot: of which one, and how much of the picture's width from its left.
    pub(super) fn seen(&self) -> Option<(&Snapshot, f32)> {
        let share = match self.way {
            Way::Off => return None,
            Way::Wipe => self.share,
            Way::Flip => 1.0,
        };
        Some((self.chosen()?, share))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use std::sync::Arc;

    use super::*;
    use crate::app::Document;
    use crate::project::Project;
    use crate::volume::BuiltIn;

    fn with(count: usize) -> Snapshots {
        let mut all = Snapshots::new(&Context::default());
        let document = Document::new(Project::default());
        for _ in 0..count {
            let picture = Picture::new([4, 2]);
            all.grab(
                &picture,
                &document.view(),
                document.title(),
                document.step(),
            );
        }
        all
    }

    #[test]
    fn the_newest_is_compared_with_until_another_is_chosen() {
        let mut all = with(3);
        assert_eq!(
            all.chosen().map(Snapshot::name).as_deref(),
            Some("Snapshot 3")
        );
        assert!(all.seen().is_none());
        all.toggle(Way::Wipe);
        all.choose(1);
        all.wipe_to(0.25);
        assert_eq!(
            all.seen().map(|(it, share)| (it.number, share)),
            Some((1, 0.25))
        );
        all.toggle(Way::Flip);
        assert_eq!(all.seen().map(|(_, share)| share), Some(1.0));
        all.toggle(Way::Flip);
        assert!(all.seen().is_none());
    }

    #[test]
    fn what_is_thrown_away_is_compared_with_no_more() {
        let mut all = with(2);
        all.toggle(Way::Wipe);
        all.forget(2);
        assert_eq!(all.seen().map(|(it, _)| it.number), Some(1));
        all.forget(1);
        assert!(all.seen().is_none() && !all.close());
    }

    #[test]
    fn the_newest_few_volumes_are_held() {
        let mut all = Snapshots::new(&Context::default());
        for flame in [BuiltIn::Torch, BuiltIn::Burner, BuiltIn::Spirit] {
            let mut document = Document::new(Project::default());
            document.open(Arc::new(flame.volume())).unwrap();
            for _ in 0..2 {
                let picture = Picture::new([4, 2]);
                let step = document.step();
                all.grab(&picture, &document.view(), document.title(), step);
            }
        }
        let held = all.all().iter().map(|it| it.step.holds_a_volume());
        assert!(held.eq([false, false, true, true, true, true]));
    }

    #[test]
    fn there_are_so_many_and_no_more() {
        let all = with(MOST + 1);
        assert_eq!(all.all().len(), MOST);
        assert!(all.is_full());
    }
}
