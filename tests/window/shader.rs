//! The display shader against the processor's display, on colours over the whole range of light.

use eframe::egui_wgpu::{RenderState, RendererOptions, wgpu};
use sootlight::app::Display;
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

#[test]
fn the_shader_shows_what_the_processor_computes() {
    let state = std::panic::catch_unwind(|| {
        let setup = egui_kittest::wgpu::default_wgpu_setup();
        egui_kittest::wgpu::create_render_state(setup, RendererOptions::PREDICTABLE)
    });
    let Ok(state) = state else {
        super::say("skipped: no graphics driver");
        return;
    };
    let colours = random_colours();
    let mut film = Film::new([SIDE, SIDE]);
    let pixels = colours
        .iter()
        .map(|&xyz| Pixel {
            xyz,
            opacity: [0.0; 3],
        })
        .collect();
    film.merge(&Tile {
        stride: 1,
        sample: 0,
        origin: [0; 2],
        size: [SIDE; 2],
        pixels,
        samples: 0,
    });

    let warm = [1.1, 1.0, 0.2];
    for (curve, adaptation, exposure) in [
        (Curve::Filmic, 0.0, 1.0),
        (Curve::Filmic, 0.8, 30.0),
        (Curve::Linear, 0.3, 0.5),
    ] {
        let view = BakedView::new(&View {
            exposure,
            adaptation,
            white_xyz: warm,
            curve,
        });
        let shown = shown_by_shader(&state, &film, &view);
        for (i, (&xyz, shown)) in colours.iter().zip(shown).enumerate() {
            let wanted = view.apply(xyz);
            for c in 0..3 {
                let off = (wanted[c] * 255.0 - f32::from(shown[c])).abs();
                assert!(
                    off <= 1.0,
                    "{curve:?}, colour {i} {xyz:?}: {wanted:?} but {shown:?}"
                );
            }
        }
    }
}

/// The bytes that the shader writes for a film.
fn shown_by_shader(state: &RenderState, film: &Film, view: &BakedView) -> Vec<[u8; 4]> {
    let (device, queue) = (&state.device, &state.queue);
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let size = wgpu::Extent3d {
        width: SIDE,
        height: SIDE,
        depth_or_array_layers: 1,
    };
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let mut display = Display::new(device, format);
    display.upload(device, queue, film, &[]);
    display.set_view(queue, view);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let attachment = wgpu::RenderPassColorAttachment {
            view: &target.create_view(&wgpu::TextureViewDescriptor::default()),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations::default(),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(attachment)],
            ..wgpu::RenderPassDescriptor::default()
        });
        display.paint(&mut pass);
    }
    let row = (4 * SIDE).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row * SIDE),
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
    rows.flat_map(|row| row[..4 * SIDE as usize].chunks(4))
        .map(|p| [p[0], p[1], p[2], p[3]])
        .collect()
}
