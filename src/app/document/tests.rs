use super::*;

fn set(document: &mut Document, radius_nm: f64, held: bool) {
    let before = document.project.clone();
    document.project.soot.radius_nm = radius_nm;
    document.remember(before, held);
}

#[test]
fn an_opening_can_be_taken_back_but_memory_is_bounded() {
    let torch = || Arc::new(crate::volume::procedural::torch());
    let [first, second, third] = [torch(), torch(), torch()];
    let mut document = Document::new(Project::default());
    let shown = |document: &Document, volume: &Arc<Volume>| {
        document
            .volume()
            .is_some_and(|open| Arc::ptr_eq(open, volume))
    };
    assert!(document.open(Arc::clone(&first)).is_ok() && !document.can_undo());
    set(&mut document, 30.0, false);
    assert!(document.replace(Arc::clone(&second)).is_ok());
    set(&mut document, 50.0, false);
    document.undo();
    document.undo();
    assert!(shown(&document, &first) && document.project.soot.radius_nm == 30.0);
    document.undo();
    assert!(!document.can_undo());
    for _ in 0..3 {
        document.redo();
    }
    assert!(shown(&document, &second) && document.project.soot.radius_nm == 50.0);

    assert!(document.replace(Arc::clone(&third)).is_ok());
    for _ in 0..9 {
        document.undo();
    }
    assert!(shown(&document, &second), "the first one is let go");
}

#[test]
fn a_job_is_made_anew_only_for_another_question() {
    let mut document = Document::new(Project::default());
    let torch = || Arc::new(crate::volume::procedural::torch());
    assert!(document.open(torch()).is_ok());
    // A job that is made anew has its names at another place: the old one is still alive meanwhile.
    let mut made = |change: &dyn Fn(&mut Document), canvas| {
        change(&mut document);
        let job = document.job(canvas);
        job.and_then(|job| Some(job.flame.maps.soot.as_ref()?.grid.as_ptr()))
    };
    let first = made(&|_| (), [64, 64]);
    assert!(first.is_some());
    assert_eq!(made(&|_| (), [64, 64]), first);
    let wider = made(&|_| (), [65, 64]);
    assert_ne!(wider, first);
    let grown = made(&|document| document.project.soot.radius_nm = 31.0, [65, 64]);
    assert_ne!(grown, wider);

    let another = torch();
    assert!(document.open(Arc::clone(&another)).is_ok());
    let job = document.job([65, 64]);
    assert!(job.is_some_and(|job| Arc::ptr_eq(&job.volume, &another)));
}

#[test]
fn a_document_without_a_volume_asks_for_nothing() {
    let mut document = Document::new(Project::default());
    assert!(document.job([64, 64]).is_none());
    assert!(document.problem().is_none());
}

#[test]
fn nothing_is_undone_into_a_window_that_shows_nothing() {
    let torch = || Arc::new(crate::volume::procedural::torch());
    let mut document = Document::new(Project::default());
    set(&mut document, 30.0, false);
    assert!(document.replace(torch()).is_ok());
    assert!(!document.can_undo());
}

#[test]
fn what_is_measured_by_itself_is_no_step_and_reaches_back() {
    let metering = |exposure: f64| Metering {
        exposure,
        white_xyz: [1.0; 3],
        bright_y: 1.0,
    };
    let mut document = Document::new(Project::default());
    assert!(
        document
            .open(Arc::new(crate::volume::procedural::torch()))
            .is_ok()
    );
    // A slider moves before the first picture is seen, and again before it is a full one.
    set(&mut document, 30.0, false);
    document.measured(metering(2.0));
    set(&mut document, 40.0, false);
    document.measured(metering(3.0));
    document.undo();
    assert_eq!(document.metering, Some(metering(3.0)));
    document.undo();
    assert_eq!(document.metering, Some(metering(3.0)));
    assert!(!document.can_undo());
    // What a person asks for is a step.
    document.change(|document| document.metering = Some(metering(5.0)));
    document.undo();
    assert_eq!(document.metering, Some(metering(3.0)));
}

#[test]
fn a_view_asks_for_no_job() {
    let mut document = Document::new(Project::default());
    assert!(
        document
            .open(Arc::new(crate::volume::procedural::torch()))
            .is_ok()
    );
    let mut made = |exposure_ev: f64| {
        document.project.view.exposure_ev = exposure_ev;
        let job = document.job([64, 64]);
        job.and_then(|job| Some(job.flame.maps.soot.as_ref()?.grid.as_ptr()))
    };
    assert_eq!(made(0.0), made(1.0));
}
