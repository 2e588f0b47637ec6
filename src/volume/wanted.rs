//! Which grids of a file are read: those that a field may be made from, and no others.
//!
//! A file may carry grids that no field is made from: velocities, fuel, a second heat. And a field may be read by
//! one effect alone: smoke beside the soot, the flame where the gas glows blue. What a grid holds is known only once
//! it is read, so they are chosen one after the other: temperature, soot, flame, smoke. What is left out never
//! changes how the others are recognised.

use std::collections::BTreeSet;

use super::recognise::{Roles, is_kelvin};
use super::{FieldKind, Grid, Producer, Volume};

/// A grid of a file that nobody has needed so far.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnreadGrid {
    /// The grid's name.
    pub name: String,
    /// "half", "float" or "double".
    pub stored_as: &'static str,
}

/// What a reader is to read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    everything: bool,
    producer: Producer,
    named: BTreeSet<String>,
    left_out: Vec<FieldKind>,
}

impl Wanted {
    /// Every scalar grid.
    pub fn everything() -> Self {
        Self {
            everything: true,
            ..Self::default()
        }
    }

    /// What the fields are made from under a producer's conventions, and the grids of these names. A field that is
    /// `left_out` is one that no active effect reads: its grid is read only where another field needs it, or where
    /// it says what the others mean. Only flame and smoke can be left out.
    pub fn fields(
        producer: Producer,
        named: impl IntoIterator<Item = String>,
        left_out: impl IntoIterator<Item = FieldKind>,
    ) -> Self {
        Self {
            everything: false,
            producer,
            named: named.into_iter().collect(),
            left_out: left_out.into_iter().collect(),
        }
    }

    /// The grid to be read next, among grids in the order of their file, read or not.
    pub(super) fn next<'n>(&self, grids: &[(&'n str, Option<&Grid>)]) -> Option<&'n str> {
        let unread = |name: &&str| {
            let mut unread = grids.iter().filter(|(_, grid)| grid.is_none());
            unread.any(|(other, _)| other == name)
        };
        let first = || grids.iter().map(|(name, _)| *name).find(unread);
        if self.everything {
            return first();
        }
        let mut names = grids.iter().map(|(name, _)| *name);
        if let Some(named) = names.find(|name| self.named.contains(*name) && unread(name)) {
            return Some(named);
        }
        let may_have_data =
            |(_, grid): &&(&str, Option<&Grid>)| grid.is_none_or(|grid| !grid.bounds().is_empty());
        let names: Vec<&str> = grids
            .iter()
            .filter(may_have_data)
            .map(|(name, _)| *name)
            .collect();
        let roles = Roles::of(&names);
        let Roles {
            temperature,
            flame,
            soot,
            smoke,
        } = roles;
        if [temperature, flame, soot, smoke]
            .iter()
            .all(Option::is_none)
        {
            // A person may know what they mean.
            return first();
        }
        if let Some(name) = [temperature, soot].into_iter().flatten().find(unread) {
            return Some(name);
        }
        let is_left_out = |kind| temperature.is_some() && self.left_out.contains(&kind);
        let flame_is_idle = is_left_out(FieldKind::Flame) && soot.is_some();
        if let Some(name) = flame.filter(|name| !flame_is_idle && unread(name)) {
            return Some(name);
        }
        // A density beside a flame is smoke, unless both it and the heat are physical: then it is the soot.
        let is_physical = self.producer == Producer::Physical
            || grids
                .iter()
                .any(|(name, grid)| Some(*name) == temperature && grid.is_some_and(is_kelvin));
        let is_surely_smoke = soot.is_some() || flame.is_some() && !is_physical;
        let smoke_is_idle = is_left_out(FieldKind::Smoke) && is_surely_smoke;
        smoke.filter(|name| !smoke_is_idle && unread(name))
    }
}

impl Volume {
    /// A grid that was left unread, and that is wanted now.
    pub fn lacks(&self, wanted: &Wanted) -> Option<&str> {
        if self.unread.is_empty() || self.read_for == *wanted {
            return None;
        }
        let read = self
            .grids
            .iter()
            .map(|grid| (grid.name.as_str(), Some(grid)));
        let unread = self.unread.iter().map(|grid| (grid.name.as_str(), None));
        wanted.next(&read.chain(unread).collect::<Vec<_>>())
    }

    /// The names of all scalar grids, read or not.
    pub fn grid_names(&self) -> impl Iterator<Item = &str> {
        let read = self.grids.iter().map(|grid| grid.name.as_str());
        read.chain(self.unread.iter().map(|grid| grid.name.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, IVec3};

    use super::*;
    use crate::volume::{Border, preset, recognise};

    fn grid(name: &str, value: f32) -> Grid {
        let border = Border::Background;
        Grid::from_fn(name, IVec3::ONE, DAffine3::IDENTITY, border, 0.0, |_| value)
    }

    /// The names that are read of a file, in the order of reading.
    fn read(file: &[Grid], wanted: &Wanted) -> Vec<String> {
        let mut read: Vec<String> = Vec::new();
        loop {
            let grids: Vec<(&str, Option<&Grid>)> = file
                .iter()
                .map(|it| (it.name.as_str(), read.contains(&it.name).then_some(it)))
                .collect();
            match wanted.next(&grids) {
                Some(name) => read.push(name.to_owned()),
                None => return read,
            }
        }
    }

    fn left_out(kinds: &[FieldKind]) -> Wanted {
        Wanted::fields(Producer::Auto, [], kinds.iter().copied())
    }

    const BOTH: [FieldKind; 2] = [FieldKind::Flame, FieldKind::Smoke];

    #[test]
    fn grids_that_no_field_is_made_from_are_left_alone() {
        let file = ["fuel", "density", "heat", "flame", "temperature", "vel"];
        let file = file.map(|name| grid(name, 0.5));
        assert_eq!(
            read(&file, &Wanted::default()),
            ["temperature", "flame", "density"]
        );
        assert_eq!(read(&file, &Wanted::everything()).len(), file.len());
        let named = Wanted::fields(Producer::Auto, ["vel".to_owned()], []);
        assert!(read(&file, &named).contains(&"vel".to_owned()));
    }

    #[test]
    fn an_empty_grid_gives_way_to_the_next_of_its_meaning() {
        let file = [
            Grid::from_fn(
                "temperature",
                IVec3::ZERO,
                DAffine3::IDENTITY,
                Border::Background,
                0.0,
                |_| 0.0,
            ),
            grid("heat", 1.0),
            grid("density", 1.0),
        ];
        assert!(file[0].bounds().is_empty());
        let names = read(&file, &Wanted::default());
        assert_eq!(names, ["temperature", "heat", "density"]);
    }

    #[test]
    fn where_no_name_has_a_meaning_everything_is_read() {
        let file = ["a", "b"].map(|name| grid(name, 1.0));
        assert_eq!(read(&file, &left_out(&BOTH)), ["a", "b"]);
    }

    #[test]
    fn a_field_of_an_effect_that_is_off_is_read_only_where_another_needs_it() {
        let sooty = [
            grid("density", 0.3),
            grid("flame", 1.0),
            grid("soot", 2e-6),
            grid("temperature", 1800.0),
        ];
        assert_eq!(read(&sooty, &left_out(&BOTH)), ["temperature", "soot"]);
        // Without soot the flame is what glows.
        let blender = [
            grid("density", 0.3),
            grid("flame", 1.0),
            grid("temperature", 2.9),
        ];
        assert_eq!(read(&blender, &left_out(&BOTH)), ["temperature", "flame"]);
        // Kelvin beside it: the density may be the soot.
        let kelvin = [
            grid("density", 2e-6),
            grid("flame", 1.0),
            grid("temperature", 1800.0),
        ];
        assert_eq!(read(&kelvin, &left_out(&BOTH)).len(), 3);
        // Without a temperature the flame says how hot it is.
        let cold = [grid("flame", 1.0), grid("soot", 2e-6)];
        assert_eq!(read(&cold, &left_out(&BOTH)).len(), 2);
    }

    /// Over many files: what is left unread changes neither the producer nor the maps of the fields that are read.
    #[test]
    fn what_is_left_out_never_changes_what_the_rest_means() {
        let choices: [(&str, &[f32]); 7] = [
            ("temperature", &[0.0, 2.9, 1800.0]),
            ("heat", &[0.0, 1.0]),
            ("flame", &[0.0, 1.0]),
            ("flames", &[0.0, 7.0]),
            ("burn", &[0.0, 0.9]),
            ("soot", &[0.0, 0.5, 2e-6]),
            ("density", &[0.0, 0.4, 3e-6]),
        ];
        let count: usize = choices.iter().map(|(_, values)| values.len()).product();
        let mut compared = 0;
        for case in 0..count {
            let mut rest = case;
            let mut file = Vec::new();
            for (name, values) in choices {
                let value = values[rest % values.len()];
                rest /= values.len();
                if value > 0.0 {
                    file.push(grid(name, value));
                }
            }
            for producer in Producer::ALL {
                let wanted = Wanted::fields(producer, [], BOTH);
                let names = read(&file, &wanted);
                let whole = Volume::from_grids(file.clone(), "");
                let mut part = whole.clone();
                part.grids.retain(|grid| names.contains(&grid.name));
                let left = file.iter().filter(|grid| !names.contains(&grid.name));
                part.unread = left
                    .map(|grid| UnreadGrid {
                        name: grid.name.clone(),
                        stored_as: "float",
                    })
                    .collect();
                compared += usize::from(!part.unread.is_empty());
                assert_eq!(recognise(&part), recognise(&whole), "{names:?}");
                let (part, whole) = (preset(producer, &part), preset(producer, &whole));
                assert_eq!(part.maps.soot, whole.maps.soot, "{producer:?} {names:?}");
                assert_eq!(part.maps.temperature, whole.maps.temperature, "{names:?}");
                for kind in BOTH {
                    let map = part.maps.get(kind);
                    assert!(map.is_none() || map == whole.maps.get(kind), "{names:?}");
                }
            }
        }
        assert!(compared > 1000, "{compared}");
    }
}
