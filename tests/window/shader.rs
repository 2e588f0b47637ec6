//! The display shader against the processor's display: colours over the whole range of light, and where the pixels of a
//! film go on a canvas.

use eframe::egui_wgpu::{RenderState, RendererOptions, wgpu};
use sootlight::app::{Display, Mapping};
use sootlight::colour::display::{BakedView, Curve, View};
use sootlight::render::{Film, Pixel, Tile};

/// Side of the square of colours that the shader is tried on.
const SIDE: u32 = 100;

/// Colours over the whole range of light, many of them outside of what a display can show, some not numbers.
fn random_colours() -> Vec<[f32; 3]> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = move || {
        // SplitMix64.
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut colours: Vec<[f32; 3]> = (0..SIDE * SIDE)
        .map(|_| {
            let light = (random() * 30.0 - 20.0).exp2();
            [random(), random(), random()].map(|v| light * (1.2 * v - 0.1))
        })
        .collect();
    colours[0] = [f32::NAN, 1.0, 0.0];
    colours[1] = [f32::INFINITY, 1.0, 1.0];
    colours[2] = [0.0; 3];
    colours[3] = [-1.0; 3];
    colours
}

/// A device to draw with, or words that say why the test is skipped.
pub(super) fn device() -> Option<RenderState> {
    let state = std::panic::catch_unwind(|| {
        let setup = egui_kittest::wgpu::default_wgpu_setup();
        egui_kittest::wgpu::create_render_state(setup, RendererOptions::PREDICTABLE)
    });
    if state.is_err() {
        super::say("skipped: no graphics driver");
    }
    state.ok()
}

/// A film whose rays, every `stride` pixels, see these colours, row by row.
fn film(size: [u32; 2], stride: u32, colours: &[[f32; 3]]) -> Film {
    let mut film = Film::new(size);
    let pixels = colours
        .iter()
        .map(|&xyz| Pixel {
            xyz,
            opacity: [0.0; 3],
        })
        .collect();
    film.merge(&Tile {
        stride,
        sample: 0,
        origin: [0; 2],
        size: size.map(|side| side.div_ceil(stride)),
        pixels,
        taken: Vec::new(),
    });
    film
}

#[test]
fn the_shader_shows_what_the_processor_computes() {
    let Some(state) = device() else { return };
    let colours = random_colours();
    let film = film([SIDE; 2], 1, &colours);
    let warm = [1.1, 1.0, 0.2];
    let modes = Curve::ALL.into_iter().flat_map(|curve| {
        let [dim, bright] = [(0.0, 1.0), (0.8, 30.0)];
        [
            (curve, dim, false),
            (curve, bright, false),
            (curve, dim, true),
        ]
    });
    for (curve, (adaptation, exposure), false_colour) in modes {
        let view = BakedView::new(&View {
            exposure,
            adaptation,
            white_xyz: warm,
            curve,
            half_saturation: 0.4,
            false_colour,
        });
        let canvas = Canvas {
            format: wgpu::TextureFormat::Rgba8Unorm,
            ..Canvas::new(1.0, [0.0; 2], [SIDE; 2])
        };
        let shown = canvas.shown_by_shader(&state, &film, 1, &view);
        for (i, (&xyz, shown)) in colours.iter().zip(shown).enumerate() {
            let wanted = view.apply(xyz);
            for c in 0..3 {
                let off = 255.0 * (wanted[c] - shown[c]).abs();
                assert!(
                    off <= 1.001,
                    "{curve:?} {false_colour}, colour {i} {xyz:?}: {wanted:?} but {shown:?}"
                );
            }
        }
    }
}

/// Shows light as it is.
fn plain() -> BakedView {
    BakedView::new(&View {
        exposure: 1.0,
        adaptation: 0.0,
        white_xyz: [0.0; 3],
        curve: Curve::Linear,
        half_saturation: 1.0,
        false_colour: false,
    })
}

/// A nearly white light of this luminance.
fn light(y: f32) -> [f32; 3] {
    [0.95 * y, y, 1.09 * y]
}

/// Luminance that rises evenly over a film of up to 128 × 128 pixels, at a point in pixels from its corner.
fn ramp(x: f32, y: f32) -> f32 {
    0.1 + 0.003 * x + 0.002 * y
}

/// Whether the canvas shows light of luminance `y` at column, row.
#[track_caller]
fn assert_shows(shown: &[[f32; 4]], width: u32, [x, y]: [u32; 2], luminance: f32) {
    let shown = shown[(y * width + x) as usize];
    let wanted = plain().apply(light(luminance));
    for c in 0..3 {
        assert!(
            (wanted[c] - shown[c]).abs() < 1e-3,
            "at {x}, {y}: {wanted:?} but {shown:?}"
        );
    }
}

#[test]
fn a_coarse_ramp_is_shown_as_a_ramp() {
    let Some(state) = device() else { return };
    let size = [60, 44];
    for stride in [2_u32, 4, 8] {
        let step = stride as f32;
        let rays = size.map(|side: u32| side.div_ceil(stride));
        let centre = |ray: u32| (ray as f32 + 0.5) * step;
        let colours = (0..rays[0] * rays[1])
            .map(|i| light(ramp(centre(i % rays[0]), centre(i / rays[0]))))
            .collect::<Vec<_>>();
        let film = film(size, stride, &colours);
        let canvas = Canvas::new(1.0, [0.0; 2], size);
        let shown = canvas.shown_by_shader(&state, &film, stride as u8, &plain());
        // Between the outermost rays, whose blocks may reach over the edge.
        let half = stride / 2;
        for y in half..(size[1] / stride * stride - half) {
            for x in half..(size[0] / stride * stride - half) {
                assert_shows(
                    &shown,
                    size[0],
                    [x, y],
                    ramp(x as f32 + 0.5, y as f32 + 0.5),
                );
            }
        }
        // Beyond them the outermost ray's light goes on.
        assert_shows(&shown, size[0], [0, 0], ramp(0.5 * step, 0.5 * step));
    }
}

/// A film without any order, and its luminances.
fn speckled(size: [u32; 2]) -> (Film, Vec<f32>) {
    let luminances: Vec<f32> = (0..size[0] * size[1])
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as f32 / 256.0)
        .collect();
    let colours: Vec<_> = luminances.iter().map(|&y| light(y)).collect();
    (film(size, 1, &colours), luminances)
}

#[test]
fn a_magnified_pixel_is_a_crisp_square() {
    let Some(state) = device() else { return };
    let size = [7, 5];
    let (film, luminances) = speckled(size);
    for zoom in [2, 3, 8] {
        let canvas = Canvas::new(f64::from(zoom), [0.0; 2], size.map(|side| side * zoom));
        let shown = canvas.shown_by_shader(&state, &film, 1, &plain());
        let width = canvas.mapping.canvas[0];
        for y in 0..size[1] * zoom {
            for x in 0..width {
                let pixel = y / zoom * size[0] + x / zoom;
                assert_shows(&shown, width, [x, y], luminances[pixel as usize]);
            }
        }
    }
}

#[test]
fn a_reduced_picture_is_the_mean_of_what_it_covers() {
    let Some(state) = device() else { return };
    let size = [12, 8];
    let (film, luminances) = speckled(size);
    let at = |x: u32, y: u32| luminances[(y * size[0] + x) as usize];
    let canvas = Canvas::new(0.5, [0.0; 2], [6, 4]);
    let shown = canvas.shown_by_shader(&state, &film, 1, &plain());
    for y in 0..4 {
        for x in 0..6 {
            let (left, top) = (2 * x, 2 * y);
            let sum = at(left, top) + at(left + 1, top) + at(left, top + 1) + at(left + 1, top + 1);
            assert_shows(&shown, 6, [x, y], sum / 4.0);
        }
    }
    // At two thirds a screen pixel covers one and a half of the film's.
    let canvas = Canvas::new(2.0 / 3.0, [0.0; 2], [8, 5]);
    let shown = canvas.shown_by_shader(&state, &film, 1, &plain());
    let halves = [at(1, 0), at(2, 0), at(1, 1), at(2, 1)];
    let mean = (0.5 * halves[0] + halves[1] + 0.25 * halves[2] + 0.5 * halves[3]) / 2.25;
    assert_shows(&shown, 8, [1, 0], mean);
}

#[test]
fn a_picture_far_too_large_is_sampled_evenly() {
    let Some(state) = device() else { return };
    let size = [128, 128];
    let colours: Vec<_> = (0..size[0] * size[1])
        .map(|i| light(ramp((i % 128) as f32 + 0.5, (i / 128) as f32 + 0.5)))
        .collect();
    let film = film(size, 1, &colours);
    // 40 × 40 film pixels on each, and 8 × 8 left at the edges.
    let canvas = Canvas::new(1.0 / 40.0, [0.0; 2], [4, 4]);
    let shown = canvas.shown_by_shader(&state, &film, 1, &plain());
    for [x, y] in [[0_u32, 0], [1, 0], [2, 2]] {
        let middle = |at: u32| 40.0 * at as f32 + 20.0;
        assert_shows(&shown, 4, [x, y], ramp(middle(x), middle(y)));
    }
}

#[test]
fn the_picture_lies_where_it_was_put_and_nothing_is_drawn_beside_it() {
    let Some(state) = device() else { return };
    let size = [9, 6];
    let (film, luminances) = speckled(size);
    let canvas = Canvas::new(1.0, [3.0, -2.0], [16, 8]);
    let shown = canvas.shown_by_shader(&state, &film, 1, &plain());
    for y in 0..8 {
        for x in 0..16 {
            let on_film = (3..12).contains(&x) && y < 4;
            if on_film {
                let pixel = (y + 2) * size[0] + x - 3;
                assert_shows(&shown, 16, [x, y], luminances[pixel as usize]);
            } else {
                assert_eq!(shown[(y * 16 + x) as usize], CLEARED, "at {x}, {y}");
            }
        }
    }
}

#[test]
fn what_is_clipped_is_striped_and_nothing_else_is() {
    let Some(state) = device() else { return };
    // From darkness to twice display white, row by row.
    let (width, height) = (16_u32, 8_u32);
    let colours: Vec<[f32; 3]> = (0..width * height)
        .map(|i| light(2.0 * (i % width) as f32 / (width - 1) as f32))
        .collect();
    let film = film([width, height], 1, &colours);
    for format in [
        wgpu::TextureFormat::Rgba8Unorm,
        // What the card encodes itself is striped alike.
        wgpu::TextureFormat::Rgba8UnormSrgb,
    ] {
        let plain_canvas = Canvas {
            format,
            ..Canvas::new(1.0, [0.0; 2], [width, height])
        };
        let striped = Canvas {
            marks_clipped: true,
            ..plain_canvas
        };
        let before = plain_canvas.shown_by_shader(&state, &film, 1, &plain());
        let after = striped.shown_by_shader(&state, &film, 1, &plain());
        let is_clipped = |pixel: &[f32; 4]| pixel[..3].iter().any(|&v| v > 254.5 / 255.0);
        let changed = before.iter().zip(&after).map(|(one, other)| one != other);
        let clipped = before.iter().filter(|it| is_clipped(it)).count();
        assert!((40..90).contains(&clipped), "{clipped}");
        assert!(
            before
                .iter()
                .zip(changed.clone())
                .all(|(it, changed)| is_clipped(it) || !changed)
        );
        // Every second stripe.
        let share = changed.filter(|it| *it).count() as f64 / clipped as f64;
        assert!((0.4..0.6).contains(&share), "{share}");
    }
}

/// What is on a canvas before the picture, clear so that it cannot be mistaken for one.
const CLEARED: [f32; 4] = [0.0; 4];

/// A target for the shader, and how the film lies on it.
struct Canvas {
    format: wgpu::TextureFormat,
    mapping: Mapping,
    marks_clipped: bool,
}

impl Canvas {
    /// A canvas of numbers as the shader gives them.
    fn new(zoom: f64, corner: [f64; 2], canvas: [u32; 2]) -> Self {
        Self {
            format: wgpu::TextureFormat::Rgba32Float,
            mapping: Mapping {
                zoom,
                corner,
                canvas,
            },
            marks_clipped: false,
        }
    }

    /// What the shader shows of a film that a pass of this stride wrote, row by row.
    fn shown_by_shader(
        &self,
        state: &RenderState,
        film: &Film,
        stride: u8,
        view: &BakedView,
    ) -> Vec<[f32; 4]> {
        let (device, queue) = (&state.device, &state.queue);
        let [width, height] = self.mapping.canvas;
        let size = wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        };
        let target = device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: self.format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let mut display = Display::new(device, self.format);
        display.upload(device, queue, film, &vec![stride; film.pixels().len()]);
        display.set_view(queue, view, self.marks_clipped);
        display.set_mapping(queue, &self.mapping);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let attachment = wgpu::RenderPassColorAttachment {
                view: &target.create_view(&wgpu::TextureViewDescriptor::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            };
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(attachment)],
                ..wgpu::RenderPassDescriptor::default()
            });
            display.paint(&mut pass);
        }
        let pixel = self.format.block_copy_size(None).expect("a plain format");
        let row = (pixel * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row),
            rows_per_image: None,
        };
        let into = wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout,
        };
        encoder.copy_texture_to_buffer(target.as_image_copy(), into, size);
        queue.submit([encoder.finish()]);
        buffer.map_async(wgpu::MapMode::Read, .., |result| {
            result.expect("the buffer can be read");
        });
        device
            .poll(wgpu::PollType::wait_indefinitely())
            .expect("the graphics card answers");
        let bytes = buffer.get_mapped_range(..).expect("it is mapped");
        let rows = bytes.chunks(row as usize);
        rows.flat_map(|row| row[..(pixel * width) as usize].chunks(pixel as usize))
            .map(|pixel| match *pixel {
                [r, g, b, a] => [r, g, b, a].map(|v| f32::from(v) / 255.0),
                _ => std::array::from_fn(|c| {
                    let channel = &pixel[4 * c..4 * c + 4];
                    f32::from_le_bytes(channel.try_into().expect("four bytes"))
                }),
            })
            .collect()
    }
}
