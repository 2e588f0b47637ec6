//! Tests of loading in the background.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by panicking"
)]

use super::request::{TOGETHER, open_partner};
use super::*;
use crate::volume::{self, BuiltIn, VolumeError, Wanted};

#[test]
fn a_path_may_be_quoted_or_an_address() {
    let paths = paths_of(" \"/a b/c.vdb\" \nfile:///d.vdb\n\n");
    assert_eq!(
        paths,
        [PathBuf::from("/a b/c.vdb"), PathBuf::from("/d.vdb")]
    );
}

/// A load whose thread has not ended.
fn running(ticket: u64) -> Load {
    Load {
        ticket,
        words: ticket.to_string(),
        watch: Watch::default(),
        brought: None,
    }
}

fn shown() -> Outcome {
    Outcome::Shown(Arc::new(volume::procedural::torch()))
}

fn words(loader: &Loader) -> Option<&str> {
    loader.loading().map(|loading| loading.words)
}

/// A loader with two loads, and their watches.
fn with_two_watched() -> (Loader, [Watch; 2]) {
    let mut loader = Loader::new(Arc::new(|| {}));
    let loads = [1, 2].map(running);
    let watches = loads.each_ref().map(|load| load.watch.clone());
    loader.loads.extend(loads);
    (loader, watches)
}

#[test]
fn cancelled_loads_vanish_at_once_and_what_they_bring_is_dropped() {
    let (mut loader, watches) = with_two_watched();
    // The older one has succeeded and waits for the newer one.
    assert!(loader.sender.send((1, shown())).is_ok());
    assert!(loader.poll().is_none());
    loader.cancel();
    assert!(loader.loading().is_none());
    assert!(watches.iter().all(Watch::is_cancelled));
    // The newer one had succeeded when it was told to stop.
    assert!(loader.sender.send((2, shown())).is_ok());
    assert!(loader.poll().is_none() && loader.loading().is_none());
    // What is asked for next is not held up.
    loader.loads.push(running(3));
    assert!(loader.sender.send((3, shown())).is_ok());
    assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));
}

#[test]
fn what_no_longer_counts_is_stopped() {
    let (mut loader, [older, newer]) = with_two_watched();
    assert!(loader.sender.send((2, shown())).is_ok());
    assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));
    assert!(!older.is_cancelled());
    loader.forget_older();
    assert!(older.is_cancelled() && !newer.is_cancelled());

    let (loader, watches) = with_two_watched();
    drop(loader);
    assert!(watches.iter().all(Watch::is_cancelled));
}

#[test]
fn every_kind_of_request_stops_when_told() {
    let open = Arc::new(volume::procedural::torch());
    let file = PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/hostile/ascii_good_constant.txt"
    ));
    for request in [
        Request::BuiltIn(BuiltIn::Torch),
        Request::Project(vec![file.clone()], Wanted::default()),
        Request::Files(vec![file.clone()], Wanted::default()),
        Request::Partner(Arc::clone(&open), file.clone()),
        Request::Lacking(
            Arc::new(volume::open(&[file], &Limits::default()).unwrap()),
            Wanted::everything(),
        ),
    ] {
        let name = request.words();
        assert!(!matches!(
            load(request.clone(), &Limits::default(), &Watch::default()),
            Outcome::Failed { .. }
        ));
        let watch = Watch::default();
        watch.cancel();
        let Outcome::Failed { words, .. } = load(request, &Limits::default(), &watch) else {
            panic!("{name} was loaded");
        };
        assert_eq!(words, VolumeError::Cancelled.to_string(), "{name}");
        assert_eq!(watch.share(), 0.0, "{name}");
    }
}

#[test]
fn a_partner_that_must_be_read_alone_goes_on_where_the_pair_ended() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["first_soot.txt", "second_soot.txt"].map(|name| {
        let path = folder.path().join(name);
        std::fs::write(&path, "1 1 2\n1e-6 2e-6\n").unwrap();
        path
    });
    let open = volume::open(&[first], &Limits::default()).unwrap();
    let shares = Arc::new(std::sync::Mutex::new(Vec::new()));
    let heard = Arc::clone(&shares);
    let watch = Watch::with_listener(move |watch| heard.lock().unwrap().push(watch.share()));
    let outcome = open_partner(&Arc::new(open), &second, &Limits::default(), &watch).unwrap();
    assert!(matches!(outcome, Outcome::Replaced(_)));
    let shares = shares.lock().unwrap();
    assert!(
        shares.is_sorted() && shares.last() == Some(&1.0),
        "{shares:?}"
    );
    assert!(
        shares.iter().any(|share| (0.1..TOGETHER).contains(share)),
        "{shares:?}"
    );
    assert!(
        shares
            .iter()
            .any(|share| (TOGETHER + 0.02..0.99).contains(share)),
        "{shares:?}"
    );
}

#[test]
fn an_older_load_wins_only_once_the_newer_one_failed() {
    let failed = || Outcome::Failed {
        request: Request::BuiltIn(BuiltIn::Torch),
        words: String::new(),
    };
    // Two loads run; the older one is the first to end.
    let with_two = || {
        let mut loader = Loader::new(Arc::new(|| {}));
        loader.loads.extend([1, 2].map(running));
        assert!(loader.sender.send((1, shown())).is_ok());
        assert!(loader.poll().is_none());
        assert_eq!(words(&loader), Some("2"));
        loader
    };

    let mut loader = with_two();
    assert!(loader.sender.send((2, failed())).is_ok());
    assert!(matches!(loader.poll(), Some(Outcome::Failed { .. })));
    assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));

    let mut loader = with_two();
    assert!(loader.sender.send((2, shown())).is_ok());
    assert!(matches!(loader.poll(), Some(Outcome::Shown(_))));
    loader.forget_older();
    assert!(loader.poll().is_none() && loader.loading().is_none());
}
