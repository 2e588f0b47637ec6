//! Controls that every section is made of: a number with slider and field, a choice, and words under them.

use std::cell::RefCell;

use egui::{
    Align, Button, ComboBox, DragValue, Id, Label, Layout, PointerButton, Response, RichText,
    Sense, Slider, SliderClamping, Ui, vec2,
};

use super::unit::Unit;

/// Width of the names in front of the controls, points.
const NAME_WIDTH: f32 = 108.0;
/// Width of the fields behind the sliders, points.
const FIELD_WIDTH: f32 = 100.0;
/// How far a dragged field moves for each point, as a share of its range or (on a logarithmic scale) of its value.
const DRAG_SHARE: f64 = 0.005;

/// A number to be set: name, slider and field in one row. A double click on name or slider sets the default.
pub(super) struct Knob<'a> {
    pub(super) label: &'a str,
    pub(super) unit: Unit,
    /// What the slider spans.
    pub(super) slider: [f64; 2],
    /// What may be typed.
    pub(super) range: [f64; 2],
    pub(super) logarithmic: bool,
    pub(super) default: f64,
    /// What it does to the fire, and why.
    pub(super) tip: &'a str,
    /// Why it cannot change the picture as things are, if it cannot.
    pub(super) idle: Option<String>,
}

impl Knob<'_> {
    /// Draws it. True if the value was changed; it stays within the range unless it came from outside.
    pub(super) fn show(&self, ui: &mut Ui, value: &mut f64) -> bool {
        let old = *value;
        self.row(ui, value, &self.unit.words(self.default));
        *value != old
    }

    /// Draws a number that need not be set; while it is not, the default is shown. A double click gives it up again.
    pub(super) fn show_optional(&self, ui: &mut Ui, value: &mut Option<f64>, automatic: &str) {
        let mut number = value.unwrap_or(self.default);
        let old = number;
        if self.row(ui, &mut number, automatic) {
            *value = None;
        } else if number != old {
            *value = Some(number);
        }
        if value.is_none() {
            note(ui, automatic);
        }
    }

    /// The row, and words under it. True if a double click asked for the default, told in words.
    fn row(&self, ui: &mut Ui, value: &mut f64, default: &str) -> bool {
        let tip = format!(
            "{}\nType a number, with its unit if you like ({}). Double-click: back to {default}.",
            self.tip, self.unit.example
        );
        let mut reset = false;
        ui.horizontal(|ui| {
            let name = name(ui, self.label, &tip);
            ui.spacing_mut().slider_width =
                (ui.available_width() - FIELD_WIDTH - ui.spacing().item_spacing.x).max(40.0);
            let slider = Slider::new(value, self.slider[0]..=self.slider[1])
                .logarithmic(self.logarithmic)
                .clamping(SliderClamping::Edits)
                .show_value(false);
            let slider = ui.add(slider).labelled_by(name.id).on_hover_text(&tip);
            // A double click on a slider is a press first, which moves it: both are one step of undo.
            let twice = slider.contains_pointer()
                && ui.input(|input| input.pointer.button_double_clicked(PointerButton::Primary));
            reset = name.double_clicked() || twice;
            if reset {
                *value = self.default;
            }
            self.field(ui, value, &name);
        });
        self.words(ui, *value);
        reset
    }

    /// The field. What was typed and not understood, or not allowed, is kept in words for [`Knob::words`].
    fn field(&self, ui: &mut Ui, value: &mut f64, name: &Response) {
        let [low, high] = self.range;
        let speed = DRAG_SHARE
            * if self.logarithmic {
                value.abs().max(self.slider[0].abs())
            } else {
                self.slider[1] - self.slider[0]
            };
        let old = *value;
        let shown = self.unit.number(old);
        // `Some` once something was entered: what is wrong with it, if anything is.
        let entered = RefCell::new(None);
        let parse = |typed: &str| {
            // A field that was only looked into has the value that it had, not the few digits that it shows.
            let parsed = if typed.trim() == shown {
                Some(old)
            } else {
                self.unit.parse(typed)
            };
            let complaint = match parsed {
                _ if parsed == Some(old) => None,
                None => Some(format!(
                    "“{}” is not understood: type {}",
                    typed.trim(),
                    self.unit.example
                )),
                Some(value) if value < low => {
                    Some(format!("the least is {}", self.unit.words(low)))
                }
                Some(value) if value > high => {
                    Some(format!("the most is {}", self.unit.words(high)))
                }
                Some(_) => None,
            };
            entered.replace(Some(complaint));
            parsed
        };
        let field = DragValue::new(value)
            .range(low..=high)
            .clamp_existing_to_range(false)
            .update_while_editing(false)
            .speed(speed)
            .max_decimals(12)
            .suffix(format!(" {}", self.unit.beside(old)))
            .custom_formatter(|value, _| self.unit.number(value))
            .custom_parser(parse);
        let size = vec2(FIELD_WIDTH, ui.spacing().interact_size.y);
        ui.add_sized(size, field).labelled_by(name.id);
        match entered.into_inner() {
            Some(Some(complaint)) => {
                ui.data_mut(|data| data.insert_temp(self.id(), (complaint, *value)));
            }
            Some(None) => ui.data_mut(|data| data.remove::<(String, f64)>(self.id())),
            None => {}
        }
    }

    /// Words under the row: why the value is not what was typed, until it is another one, and why it changes nothing.
    fn words(&self, ui: &mut Ui, value: f64) {
        let complaint: Option<(String, f64)> = ui.data(|data| data.get_temp(self.id()));
        match complaint {
            Some((words, at)) if at == value => {
                ui.label(
                    RichText::new(words)
                        .small()
                        .color(ui.visuals().warn_fg_color),
                );
            }
            Some(_) => ui.data_mut(|data| data.remove::<(String, f64)>(self.id())),
            None => {}
        }
        if let Some(idle) = &self.idle {
            note(ui, idle);
        }
    }

    fn id(&self) -> Id {
        Id::unique(("complaint", self.label))
    }
}

/// One of several things to be chosen: name and menu in one row. A double click on the name chooses the default.
pub(super) struct Choice<'a, T> {
    pub(super) label: &'a str,
    /// What can be chosen, with its words and what it does.
    pub(super) options: &'a [(T, String, &'a str)],
    pub(super) tip: &'a str,
    pub(super) default: T,
    pub(super) idle: Option<String>,
}

impl<T: PartialEq + Clone> Choice<'_, T> {
    /// Draws it. True if another one was chosen.
    pub(super) fn show(&self, ui: &mut Ui, chosen: &mut T) -> bool {
        let old = chosen.clone();
        let words = |value: &T| {
            let option = self.options.iter().find(|(option, ..)| option == value);
            option.map_or("", |(_, words, _)| words)
        };
        let tip = format!(
            "{}\nDouble-click the name: back to {}.",
            self.tip,
            words(&self.default)
        );
        ui.horizontal(|ui| {
            let name = name(ui, self.label, &tip);
            if name.double_clicked() {
                *chosen = self.default.clone();
            }
            let menu = ComboBox::from_id_salt(self.label)
                .selected_text(words(chosen))
                .width(ui.available_width())
                .truncate()
                .show_ui(ui, |ui| {
                    for (value, words, tip) in self.options {
                        let option = ui.selectable_value(chosen, value.clone(), words);
                        if !tip.is_empty() {
                            option.on_hover_text(*tip);
                        }
                    }
                });
            menu.response.labelled_by(name.id).on_hover_text(&tip);
        });
        if let Some(idle) = &self.idle {
            note(ui, idle);
        }
        *chosen != old
    }
}

/// Small words under a control.
pub(super) fn note(ui: &mut Ui, words: &str) {
    ui.label(RichText::new(words).small().weak());
}

/// A control's name in a column of its own.
pub(super) fn name(ui: &mut Ui, label: &str, tip: &str) -> Response {
    let size = vec2(NAME_WIDTH, ui.spacing().interact_size.y);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_width(NAME_WIDTH);
        // Clicked by a hand alone: the keyboard's way through the panel is that of the controls.
        ui.add(Label::new(label).selectable(false).sense(Sense::CLICK))
    })
    .inner
    .on_hover_text(tip)
}

/// A button that is greyed out, but still named, while it can do nothing.
pub(super) fn button(ui: &mut Ui, enabled: bool, label: &str, tip: &str) -> bool {
    ui.add_enabled(enabled, Button::new(label))
        .on_hover_text(tip)
        .on_disabled_hover_text(tip)
        .clicked()
}
