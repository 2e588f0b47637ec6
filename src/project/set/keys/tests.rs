//! What keys tell of their values.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
use super::*;
use crate::physics::soot::SootModel;
use crate::project::{BackdropKind, Saturation};
use crate::scene::{Fuel, Interpolation, Salt};

#[test]
fn what_a_key_expects_names_every_row_of_its_table() {
    let expects = |name: &str| KEYS.iter().find(|key| key.name == name).unwrap().expects;
    let is_named = |key: &str, name: &str| {
        let mut words = expects(key).split([',', ' ']);
        assert!(words.any(|word| word == name), "{key} does not name {name}");
    };
    Fuel::all().for_each(|fuel| is_named("fuel.name", fuel.name()));
    Salt::all().for_each(|salt| is_named("fuel.salt", salt.name()));
    for model in SootModel::ALL {
        is_named("soot.model", model.name());
    }
    for way in Interpolation::ALL {
        is_named("render.interpolation", way.name());
    }
    for whose in Saturation::ALL {
        is_named("air.saturation", whose.name());
    }
    for kind in BackdropKind::ALL {
        is_named("stage.backdrop", kind.name());
    }
}
