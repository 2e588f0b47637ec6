//! The line below the picture: how far the render is and how fast.

use std::time::Duration;

use egui::{
    Align, Button, Frame, Label, Layout, Margin, Panel, ProgressBar, RichText, Role, Ui,
    WidgetInfo, vec2,
};

use super::Command;
use super::quality::short_de;
use crate::app::App;
use crate::app::accuracy::Told;
use crate::app::files::Loading;
use crate::engine::Engine;
use crate::engine::Progress;

/// Height of the line in points, and of the space above and below its words.
const HEIGHT: f32 = 28.0;
const MARGIN: i8 = 3;
/// Least widths of the window at which there is room to pause the picture, and for the histogram, points: narrower ones have
/// their keys.
const WITH_PAUSE: f32 = 800.0;
const WITH_ALL: f32 = 960.0;

/// Draws the line.
pub(in crate::app) fn status(ui: &mut Ui, app: &App, commands: &mut Vec<Command>) {
    let frame = Frame::new()
        .fill(ui.visuals().panel_fill)
        .inner_margin(Margin::symmetric(12, MARGIN));
    Panel::bottom("status")
        .resizable(false)
        .exact_size(HEIGHT)
        .frame(frame)
        .show(ui, |ui| {
            // The line is as high whatever it says: the picture above must keep its size.
            ui.set_min_height(HEIGHT - 2.0 * f32::from(MARGIN));
            let width = ui.available_width();
            ui.horizontal_centered(|ui| {
                super::export::line(ui, app, commands);
                if let Some(load) = app.loader.loading() {
                    loading(ui, &load, commands);
                } else {
                    if width >= WITH_PAUSE {
                        pausing(ui, app, commands);
                    }
                    rendering(ui, app);
                }
                let flaws = app.flaws();
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let shown = !app.panels.hidden;
                    let panel = ui.selectable_label(shown, "Panel");
                    if panel
                        .on_hover_text("Show or hide the controls (N).")
                        .clicked()
                    {
                        commands.push(Command::TogglePanel);
                    }
                    let spectrum = ui.selectable_label(app.plots.is_open(), "Spectrum");
                    if spectrum
                        .on_hover_text(
                            "Show or hide the spectrum under the pointer, and what the fuel and the air do to light of \
                             each wavelength (S).",
                        )
                        .clicked()
                    {
                        commands.push(Command::ToggleSpectrum);
                    }
                    if width >= WITH_ALL
                        && ui
                            .selectable_label(app.plots.shows_levels(), "Histogram")
                            .on_hover_text(
                            "Show or hide how often the picture shows each level, and what is clipped (H).",
                        )
                        .clicked()
                    {
                        commands.push(Command::ToggleLevels);
                    }
                    let accuracy = ui.selectable_label(app.plots.shows_accuracy(), "Accuracy");
                    if accuracy
                        .on_hover_text("Show or hide what accuracy costs in time (C).")
                        .clicked()
                    {
                        commands.push(Command::ToggleAccuracy);
                    }
                    flaw_words(ui, &flaws);
                });
            });
        });
}

/// What is being read, how far, and a way to stop it.
fn loading(ui: &mut Ui, loading: &Loading<'_>, commands: &mut Vec<Command>) {
    bar(ui, loading.share);
    let stop = ui.button("Stop reading");
    if stop
        .on_hover_text("What is open stays as it is (Esc).")
        .clicked()
    {
        commands.push(Command::CancelLoading);
    }
    let words = format!("{:.0} %  Reading {}…", 100.0 * loading.share, loading.words);
    ui.add(Label::new(words).truncate());
}

/// A way to let the picture pause while it is rendered.
fn pausing(ui: &mut Ui, app: &App, commands: &mut Vec<Command>) {
    let (words, name, tip) = if app.engine.pauses() {
        (
            "Go on",
            "Go on with the picture",
            "The picture pauses. It goes on with the next change as well (P).",
        )
    } else {
        (
            "Pause",
            "Pause the picture",
            "Leaves the machine to something else; the picture stays as far as it is (P).",
        )
    };
    let button = Button::new(words).min_size(vec2(52.0, 0.0));
    let is_working = app.is_working();
    let button = ui.add_enabled(is_working, button);
    button.widget_info(|| WidgetInfo::labeled(Role::Button, is_working, name));
    if button.on_hover_text(tip).clicked() {
        commands.push(Command::PausePicture);
    }
}

fn bar(ui: &mut Ui, share: f32) {
    let bar = ProgressBar::new(share)
        .desired_width(BAR_WIDTH)
        .desired_height(6.0);
    ui.add(bar);
}

/// How far the picture is and how fast, as much of it as there is room for.
fn rendering(ui: &mut Ui, app: &App) {
    let waiting = Progress::default();
    let progress = if app.renders_newest() {
        &app.picture.progress
    } else {
        &waiting
    };
    let since = app
        .submitted
        .as_ref()
        .map_or(Duration::ZERO, |submitted| submitted.at.elapsed());
    bar(ui, progress.share() as f32);
    let job = app.document.last_job();
    let accuracy = if job.is_some_and(|job| app.accuracy.sees_nothing(job)) {
        "nothing is seen, so there is no error".to_owned()
    } else {
        accuracy_words(app.told.as_ref(), progress)
    };
    ui.allocate_ui(vec2(ACCURACY_WIDTH, ui.available_height()), |ui| {
        ui.set_min_width(ACCURACY_WIDTH);
        let label = ui.add(Label::new(accuracy).truncate());
        label.on_hover_text(
            "How far this picture is expected to be from the finest one: 95 % of what is lit are nearer than so many ΔE, of \
             which 1 is just seen. Predicted from a part of this scene; measured once the map of errors (E) is whole. Against our \
             own reference, and not a real fire.",
        );
    });
    let is_preparing = progress.done > 0 && progress.rays_in_pass == 0 && !progress.finished;
    let packed = is_preparing.then(|| app.engine.scene()).flatten();
    let preparing = packed.and_then(|packed| packed.plan.preparation().share());
    for (words, width) in cells(progress, since, preparing) {
        if ui.available_width() < width + FLAWS_WIDTH {
            break;
        }
        // Cells of fixed width: the line does not jump while its numbers run.
        ui.allocate_ui(vec2(width, ui.available_height()), |ui| {
            ui.set_min_width(width);
            ui.add(Label::new(words).truncate());
        });
    }
}

/// Width of the words on accuracy in points.
const ACCURACY_WIDTH: f32 = 384.0;

/// The picture's error, its time, and what the next better one would take.
fn accuracy_words(told: Option<&Told>, progress: &Progress) -> String {
    let Some(told) = told else {
        return "error … ΔE (95 %)".to_owned();
    };
    let threads = Engine::threads_beside_a_window() as f64;
    let took = if progress.finished {
        progress.elapsed.as_secs_f64()
    } else {
        told.here.cpu_s / threads
    };
    let (error, how) = match told.measured {
        Some(error) => (error, "measured"),
        None => (told.here.error.all, "predicted"),
    };
    let here = short_de(error.de95);
    let next = told.next.map_or_else(
        || "nothing finer".to_owned(),
        |next| {
            format!(
                "next {} ΔE in {}",
                short_de(next.error.all.de95),
                seconds(took + (next.cpu_s - told.here.cpu_s) / threads)
            )
        },
    );
    format!("error {here} ΔE (95 %), {how} · {} · {next}", seconds(took))
}

/// Seconds in two figures.
fn seconds(seconds: f64) -> String {
    match seconds {
        s if s < 0.1 => format!("{s:.2} s"),
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 600.0 => format!("{s:.0} s"),
        s => format!("{:.0} min", s / 60.0),
    }
}

/// Width of the bar in points.
const BAR_WIDTH: f32 = 96.0;
/// Room that is kept for the flaws' words and the four buttons, points.
const FLAWS_WIDTH: f32 = 420.0;

/// What of the picture is not faithful or assumed, always in sight: the first in words, all of them under the pointer.
fn flaw_words(ui: &mut Ui, flaws: &[&str]) {
    let words = match flaws {
        [] => return,
        [only] => (*only).to_owned(),
        [first, ..] => format!("{} flaws: {first}", flaws.len()),
    };
    let lines: Vec<String> = flaws.iter().map(|flaw| format!("• {flaw}")).collect();
    ui.add(Label::new(RichText::new(words).color(ui.visuals().warn_fg_color)).truncate())
        .on_hover_text(lines.join("\n"));
}

/// The words of the line, each with the width that its longest form needs, the most wanted first.
fn cells(
    progress: &Progress,
    since_submit: Duration,
    preparing: Option<f64>,
) -> Vec<(String, f32)> {
    let count = progress.passes.len();
    let elapsed = if progress.finished {
        progress.elapsed
    } else {
        since_submit
    }
    .as_secs_f64();
    let rate = |number: u64| {
        if elapsed > 0.0 {
            number as f64 / elapsed
        } else {
            0.0
        }
    };
    let pass = (progress.done + 1).min(count);
    let first = progress.first_picture.map_or("–".to_owned(), |time| {
        format!("{:.2} s", time.as_secs_f64())
    });
    vec![
        (format!("{:.0} %", 100.0 * progress.share()), 42.0),
        (time_left(progress, since_submit, preparing), 78.0),
        (format!("pass {pass}/{count}"), 70.0),
        (format!("{elapsed:.2} s"), 60.0),
        (format!("{} rays/s", counted(rate(progress.rays))), 104.0),
        (
            format!("{} samples/s", counted(rate(progress.samples))),
            124.0,
        ),
        (format!("first picture {first}"), 146.0),
    ]
}

/// How long the rest takes, if it goes on as it went.
fn time_left(progress: &Progress, since_submit: Duration, preparing: Option<f64>) -> String {
    if progress.finished {
        "done".to_owned()
    } else if progress.prepares() && progress.done > 0 {
        preparing.map_or("preparing…".to_owned(), |share| {
            format!("light {:.0} %", 100.0 * share)
        })
    } else {
        let left = progress.left(since_submit);
        left.map_or("… s left".to_owned(), |left| {
            format!("{:.1} s left", left.as_secs_f64())
        })
    }
}

/// A large number with its prefix.
fn counted(number: f64) -> String {
    match number {
        n if n >= 1e9 => format!("{:.2} G", n / 1e9),
        n if n >= 1e6 => format!("{:.2} M", n / 1e6),
        n if n >= 1e3 => format!("{:.1} k", n / 1e3),
        n => format!("{n:.0} "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::Pass;
    use crate::render::pass::Audience;
    use crate::scene::WavelengthSet;
    use crate::study::{Choice, Error, Numbers, Split};

    #[test]
    fn the_time_left_is_told_or_what_is_waited_for() {
        let pass = Pass {
            stride: 1,
            sample: 0,
            samples: 1,
            step_voxels: 1.0,
            region: None,
            audience: Audience::Window,
        };
        let second = Duration::from_secs(1);
        let mut progress = Progress {
            passes: vec![pass; 2],
            done: 1,
            begun: vec![second; 1],
            ..Progress::default()
        };
        let told = |progress: &Progress, light| time_left(progress, 4 * second, light);
        // Nothing is told of a pass that has not begun.
        assert_eq!(told(&progress, None), "preparing…");
        assert_eq!(told(&progress, Some(0.414)), "light 41 %");
        progress.begun.push(2 * second);
        assert_eq!(told(&progress, None), "3.0 s left");
        progress.finished = true;
        assert_eq!(told(&progress, None), "done");
        assert_eq!(told(&Progress::default(), None), "… s left");
    }

    #[test]
    fn the_error_is_told_with_its_time_and_the_next_better_one() {
        let choice = |de95: f64, cpu_s: f64| Choice {
            numbers: Numbers {
                step_voxels: 1.0,
                wavelengths: WavelengthSet::Fitted(6),
                samples_per_pixel: 1,
            },
            error: Split {
                all: Error {
                    de95,
                    ..Error::default()
                },
                ..Split::default()
            },
            cpu_s,
            work: 1.0,
        };
        let threads = Engine::threads_beside_a_window() as f64;
        let mut told = Told {
            here: choice(0.43, 0.8 * threads),
            next: Some(choice(0.112, 3.0 * threads)),
            measured: None,
        };
        let running = Progress::default();
        assert_eq!(
            accuracy_words(Some(&told), &running),
            "error 0.43 ΔE (95 %), predicted · 0.8 s · next 0.11 ΔE in 3.0 s"
        );
        // Once it is there, its own time counts, with all that is not the march.
        let done = Progress {
            finished: true,
            elapsed: Duration::from_secs(2),
            ..Progress::default()
        };
        assert_eq!(
            accuracy_words(Some(&told), &done),
            "error 0.43 ΔE (95 %), predicted · 2.0 s · next 0.11 ΔE in 4.2 s"
        );
        told.measured = Some(Error {
            de95: 0.38,
            ..Error::default()
        });
        assert!(accuracy_words(Some(&told), &done).starts_with("error 0.38 ΔE (95 %), measured"));
        told.next = None;
        assert!(accuracy_words(Some(&told), &done).ends_with("nothing finer"));
        assert_eq!(accuracy_words(None, &done), "error … ΔE (95 %)");
    }
}
