//! The line below the picture: how far the render is and how fast.

use std::time::Duration;

use egui::{Frame, Label, Margin, Panel, ProgressBar, RichText, Ui, vec2};

use crate::app::App;
use crate::app::theme::WARNING;
use crate::engine::picture::Progress;

/// Draws the line.
pub(in crate::app) fn status(ui: &mut Ui, app: &App) {
    let frame = Frame::new()
        .fill(ui.visuals().panel_fill)
        .inner_margin(Margin::symmetric(12, 3));
    Panel::bottom("status")
        .resizable(false)
        .exact_size(28.0)
        .frame(frame)
        .show(ui, |ui| {
            ui.horizontal_centered(|ui| {
                if let Some(loading) = app.loader.loading() {
                    let words =
                        format!("{:.0} %  Reading {}…", 100.0 * loading.share, loading.words);
                    ui.add(Label::new(words).truncate());
                    return;
                }
                let waiting = Progress::default();
                let progress = if app.renders_newest() {
                    &app.picture.progress
                } else {
                    &waiting
                };
                ui.add(
                    ProgressBar::new(share(progress))
                        .desired_width(120.0)
                        .desired_height(6.0),
                );
                let since = app
                    .submitted
                    .as_ref()
                    .map_or(Duration::ZERO, |submitted| submitted.at.elapsed());
                flaw_count(ui, &app.flaws());
                for (words, width) in cells(progress, since) {
                    // Cells of fixed width: the line does not jump while its numbers run.
                    let text = Label::new(RichText::new(words)).truncate();
                    ui.allocate_ui(vec2(width, ui.available_height()), |ui| {
                        ui.set_min_width(width);
                        ui.add(text);
                    });
                }
            });
        });
}

/// How much of the picture is assumed, always in sight; all of it in words under the pointer. It comes before the
/// numbers, so that a narrow window cuts those first.
fn flaw_count(ui: &mut Ui, flaws: &[&str]) {
    let words = match flaws.len() {
        0 => return,
        1 => "1 assumption".to_owned(),
        n => format!("{n} assumptions"),
    };
    ui.label(RichText::new(words).color(WARNING))
        .on_hover_text(flaws.join("\n"));
}

/// Finished share of all rays, 0 to 1.
fn share(progress: &Progress) -> f32 {
    if progress.finished {
        return 1.0;
    }
    let weight = |stride: u32| 1.0 / f64::from(stride * stride);
    let all: f64 = progress.passes.iter().map(|pass| weight(pass.stride)).sum();
    let done: f64 = progress
        .passes
        .iter()
        .take(progress.done)
        .map(|pass| weight(pass.stride))
        .sum();
    let running = progress.passes.get(progress.done).map_or(0.0, |pass| {
        weight(pass.stride) * progress.rays_in_pass as f64 / progress.rays_of_pass.max(1) as f64
    });
    if all > 0.0 {
        ((done + running) / all) as f32
    } else {
        0.0
    }
}

/// The words of the line, each with the width that its longest form needs.
fn cells(progress: &Progress, since_submit: Duration) -> Vec<(String, f32)> {
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
        (format!("{:.0} %", 100.0 * share(progress)), 42.0),
        (format!("pass {pass}/{count}"), 74.0),
        (format!("{elapsed:.2} s"), 64.0),
        (format!("{} rays/s", counted(rate(progress.rays))), 104.0),
        (
            format!("{} samples/s", counted(rate(progress.samples))),
            124.0,
        ),
        (format!("first picture {first}"), 150.0),
    ]
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

    #[test]
    fn the_share_counts_rays_and_ends_at_one() {
        let passes = [8, 4, 2, 1]
            .map(|stride| Pass {
                stride,
                sample: 0,
                step_voxels: 1.0,
            })
            .to_vec();
        let mut progress = Progress {
            passes,
            done: 3,
            rays_in_pass: 50,
            rays_of_pass: 100,
            ..Progress::default()
        };
        let before_last = 1.0 / 64.0 + 1.0 / 16.0 + 0.25;
        assert!(
            (f64::from(share(&progress)) - (before_last + 0.5) / (before_last + 1.0)).abs() < 1e-6
        );
        progress.finished = true;
        assert_eq!(share(&progress), 1.0);
        assert_eq!(share(&Progress::default()), 0.0);
    }
}
