//! What pointer and keys do over the picture: move the camera as in Blender, and zoom and pan the picture itself.

use egui::{
    CursorIcon, Event, InputState, Key, Modifiers, PointerButton, Popup, Pos2, Response, Vec2,
};

use super::placement::{Placement, Sizes};
use crate::scene::Camera;

/// Turn of the camera for a drag of one point, radians: Blender's 0.4°.
const TURN: f64 = 0.4 * std::f64::consts::PI / 180.0;
/// Share by which a scroll of one point dollies: a notch of a wheel, 40 points, is about a sixth.
const SCROLL_DOLLY: f64 = 0.0045;
/// Share by which a drag of one point dollies.
const DRAG_DOLLY: f64 = 0.008;

/// What a person holds: where the picture lies, and what the running drag moves.
#[derive(Debug, Default)]
pub(super) struct Moves {
    pub(super) placement: Placement,
    drag: Option<Drag>,
}

/// What a key or a button asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action {
    /// The camera moves so that all of the flame is seen.
    FrameAll,
    /// The camera looks from another side: azimuth from the front and height above the horizon, degrees.
    Side([f64; 2]),
    /// The picture becomes larger by a step.
    Larger,
    /// The picture becomes smaller by a step.
    Smaller,
    /// A pixel of the picture is a pixel of the screen.
    OneToOne,
    /// The picture fits the canvas.
    Fit,
}

/// What a drag moves; it is chosen where the drag begins and stays to its end.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Drag {
    Orbit,
    Pan,
    Dolly,
    Picture,
}

/// Where the canvas lies, and what lies on it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Space {
    /// Upper left corner of the canvas, points.
    pub(super) origin: Pos2,
    pub(super) pixels_per_point: f32,
    pub(super) sizes: Sizes,
    /// Whether keys are meant for the picture.
    pub(super) keys: bool,
}

impl Space {
    /// A place on the canvas in screen pixels.
    fn place(&self, at: Pos2) -> [f64; 2] {
        self.pixels(at - self.origin)
    }

    fn pixels(&self, by: Vec2) -> [f64; 2] {
        [by.x, by.y].map(|v| f64::from(v * self.pixels_per_point))
    }

    fn middle(&self) -> [f64; 2] {
        self.sizes.canvas.map(|side| 0.5 * f64::from(side))
    }
}

impl Moves {
    /// Takes what happened in this frame, and what the buttons over the picture ask for. Moves the camera, if there
    /// is one; true if all of the flame shall be framed.
    pub(super) fn take(
        &mut self,
        response: &Response,
        space: Space,
        pressed: &[Action],
        camera: &mut Option<Camera>,
    ) -> bool {
        self.take_drag(response, space, camera);
        let hovered = response.hover_pos().filter(|_| response.contains_pointer());
        if let Some(at) = hovered {
            self.take_wheel(response, space, at, camera);
        }
        let about = hovered.map_or(space.middle(), |at| space.place(at));
        let mut frame_all = false;
        let pressed_keys = if space.keys {
            keys(&response.ctx)
        } else {
            Vec::new()
        };
        let keys = pressed_keys.into_iter().map(|key| (key, about));
        let double = response.double_clicked().then_some((Action::Fit, about));
        let pressed = pressed.iter().map(|&button| (button, space.middle()));
        for (action, about) in keys.chain(double).chain(pressed) {
            match action {
                Action::FrameAll => frame_all = true,
                Action::Side([azimuth, elevation]) => {
                    let [azimuth, elevation] = [azimuth, elevation].map(f64::to_radians);
                    change(camera, |camera| camera.seen_from(azimuth, elevation));
                }
                Action::Larger => self.placement = self.placement.stepped(true, about, space.sizes),
                Action::Smaller => {
                    self.placement = self.placement.stepped(false, about, space.sizes);
                }
                Action::OneToOne => self.placement = self.placement.one_to_one(about, space.sizes),
                Action::Fit => self.placement = Placement::FIT,
            }
        }
        frame_all
    }

    fn take_drag(&mut self, response: &Response, space: Space, camera: &mut Option<Camera>) {
        let space_key = response.ctx.input(|input| input.key_down(Key::Space));
        let mut by = response.drag_delta();
        if response.drag_started() {
            self.drag = Drag::begun(response, space_key);
            // A drag is known as one only after some way: none of it is lost.
            by = response.total_drag_delta().unwrap_or(by);
        } else if !response.dragged() {
            self.drag = None;
        }
        let (x, y) = (f64::from(by.x), f64::from(by.y));
        match self.drag {
            // What is dragged is the fire: a camera that goes left lets it turn to the right.
            Some(Drag::Orbit) => change(camera, |camera| camera.orbited(-TURN * x, TURN * y)),
            Some(Drag::Pan) => {
                let height =
                    self.placement.mapping(space.sizes).zoom * f64::from(space.sizes.film[1]);
                let [right, down] = space.pixels(by).map(|pixels| pixels / height);
                change(camera, |camera| camera.panned(-right, down));
            }
            Some(Drag::Dolly) => change(camera, |camera| camera.dollied((DRAG_DOLLY * y).exp())),
            Some(Drag::Picture) => {
                self.placement = self.placement.panned(space.pixels(by), space.sizes);
            }
            None => {}
        }
        let cursor = match self.drag {
            Some(drag) => drag.cursor(),
            None if space_key && response.hovered() => CursorIcon::Grab,
            None => return,
        };
        response.ctx.set_cursor_icon(cursor);
    }

    fn take_wheel(
        &mut self,
        response: &Response,
        space: Space,
        at: Pos2,
        camera: &mut Option<Camera>,
    ) {
        let (scrolled, zoomed) = response
            .ctx
            .input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        if scrolled != 0.0 {
            let factor = (-SCROLL_DOLLY * f64::from(scrolled)).exp();
            change(camera, |camera| camera.dollied(factor));
        }
        if zoomed != 1.0 {
            let about = space.place(at);
            self.placement = self.placement.zoomed(f64::from(zoomed), about, space.sizes);
        }
    }
}

fn change(camera: &mut Option<Camera>, by: impl FnOnce(&Camera) -> Camera) {
    *camera = camera.as_ref().map(by);
}

impl Drag {
    fn begun(response: &Response, space_key: bool) -> Option<Self> {
        let Modifiers { shift, ctrl, .. } = response.ctx.input(|input| input.modifiers);
        let by = |button| response.drag_started_by(button);
        if by(PointerButton::Secondary) || by(PointerButton::Primary) && space_key {
            Some(Self::Picture)
        } else if by(PointerButton::Middle) && ctrl {
            Some(Self::Dolly)
        } else if by(PointerButton::Middle) || by(PointerButton::Primary) {
            Some(if shift { Self::Pan } else { Self::Orbit })
        } else {
            None
        }
    }

    fn cursor(self) -> CursorIcon {
        match self {
            Self::Orbit => CursorIcon::AllScroll,
            Self::Pan => CursorIcon::Move,
            Self::Dolly => CursorIcon::ResizeVertical,
            Self::Picture => CursorIcon::Grabbing,
        }
    }
}

/// What the keys ask for, unless they are being typed into a field.
fn keys(ctx: &egui::Context) -> Vec<Action> {
    if ctx.text_edit_focused() || Popup::is_any_open(ctx) {
        return Vec::new();
    }
    let pressed = |input: &InputState| {
        let actions = input.events.iter().filter_map(|event| match event {
            Event::Key {
                key,
                pressed: true,
                modifiers,
                ..
            } => action_of(*key, *modifiers),
            _ => None,
        });
        actions.collect()
    };
    ctx.input(pressed)
}

/// Ctrl with plus, minus and 0 is left to the size of the whole window's contents.
fn action_of(key: Key, modifiers: Modifiers) -> Option<Action> {
    let opposite = modifiers.command || modifiers.ctrl;
    let side = |azimuth: f64, elevation: f64| Some(Action::Side([azimuth, elevation]));
    match (key, opposite) {
        _ if modifiers.alt => None,
        (Key::Num1, false) => side(0.0, 0.0),
        (Key::Num1, true) => side(180.0, 0.0),
        (Key::Num3, false) => side(90.0, 0.0),
        (Key::Num3, true) => side(-90.0, 0.0),
        (Key::Num7, false) => side(0.0, 90.0),
        (Key::Num7, true) => side(0.0, -90.0),
        (Key::Home, false) => Some(Action::FrameAll),
        (Key::Plus | Key::Equals, false) => Some(Action::Larger),
        (Key::Minus, false) => Some(Action::Smaller),
        (Key::Num0, false) => Some(Action::Fit),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_windows_own_shortcuts_stay_its_own() {
        for key in [Key::Plus, Key::Equals, Key::Minus, Key::Num0, Key::Home] {
            assert!(action_of(key, Modifiers::NONE).is_some());
            assert_eq!(action_of(key, Modifiers::COMMAND), None);
            assert_eq!(action_of(key, Modifiers::ALT), None);
        }
        assert_eq!(
            action_of(Key::Num3, Modifiers::CTRL),
            Some(Action::Side([-90.0, 0.0]))
        );
    }
}
