//! The picture on the screen: the film as a float texture, developed by the graphics card.
//!
//! Exposure, adaptation, curve, zoom and pan change a uniform and two rows of a thousand points, so a view of any size
//! follows the slider at once and no ray is marched again. The film is uploaded whole, in one write.

use eframe::egui_wgpu::wgpu;

use super::placement::Mapping;
use crate::colour::display::{BakedView, TABLE_FIRST_STOP, TABLE_LAST_STOP, TABLE_LEN};
use crate::render::Film;

/// The display shader with the film and the view it works on.
pub struct Display {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    film: wgpu::Texture,
    curves: wgpu::Texture,
    target_encodes: bool,
    staging: Vec<[f32; 4]>,
}

/// Rows of four numbers in `View` of the shader: what a view fills, then what a mapping fills.
const VIEW_ROWS: usize = 11;
const MAPPING_ROWS: usize = 2;
const ROW_BYTES: usize = 16;

impl Display {
    /// A display that draws to targets of the given format.
    pub fn new(device: &wgpu::Device, target: wgpu::TextureFormat) -> Self {
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("display"),
            entries: &[entry(0, uniform), entry(1, texture), entry(2, texture)],
        });
        let pipeline = pipeline(device, &layout, target);
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: ((VIEW_ROWS + MAPPING_ROWS) * ROW_BYTES) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let film = float_texture(device, "film", [1, 1]);
        let curves = float_texture(device, "curves", [TABLE_LEN as u32, 2]);
        let group = bind(device, &layout, &uniform, &film, &curves);
        let target_encodes = target.is_srgb();
        Self {
            pipeline,
            layout,
            group,
            uniform,
            film,
            curves,
            target_encodes,
            staging: Vec::new(),
        }
    }

    /// Brings a film to the graphics card in one write, with the stride of the pass that wrote each pixel (those that
    /// are missing count as 1): between the rays of a coarse pass the picture is interpolated. The film's sides must be
    /// within the device's limit.
    pub fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        film: &Film,
        strides: &[u8],
    ) {
        let size = film.size();
        if [self.film.width(), self.film.height()] != size {
            self.film = float_texture(device, "film", size);
            self.group = bind(
                device,
                &self.layout,
                &self.uniform,
                &self.film,
                &self.curves,
            );
        }
        self.staging.clear();
        let strides = strides.iter().copied().chain(std::iter::repeat(1));
        self.staging
            .extend(film.pixels().iter().zip(strides).map(|(pixel, stride)| {
                let [x, y, z] = pixel.xyz;
                [x, y, z, f32::from(stride)]
            }));
        write(queue, &self.film, &self.staging);
    }

    /// Develops with this view from now on, and lays stripes over what is at the display's highest level if that is to be
    /// marked.
    pub fn set_view(&mut self, queue: &wgpu::Queue, view: &BakedView, marks_clipped: bool) {
        // Rows of a matrix, with a number behind each.
        let rows = |[r, g, b]: [[f32; 3]; 3], w: [f32; 3]| {
            let row = |[x, y, z]: [f32; 3], w| [x, y, z, w];
            [row(r, w[0]), row(g, w[1]), row(b, w[2])]
        };
        let (outside, start) = view.paling.map_or((0.0, 0.0), |p| (p.outside, p.start));
        let matrix = rows(view.rgb_from_xyz, [view.softness, outside, start]);
        let road = f32::from(view.road as u8);
        let marks = f32::from(u8::from(marks_clipped));
        let hue = rows(view.hue.receptors_from_rgb, [road, view.exposure, marks]);
        let back = rows(view.hue.rgb_from_receptors, view.hue.lightness);
        let [lr, lg, lb] = view.luminance;
        let last = (TABLE_LEN - 1) as f32;
        let stops = TABLE_LAST_STOP - TABLE_FIRST_STOP;
        let table = [
            TABLE_FIRST_STOP,
            last / stops,
            last,
            f32::from(u8::from(self.target_encodes)),
        ];
        let luminance = [lr, lg, lb, view.per_channel];
        let [x, y, z] = matrix;
        let [long, middle, short] = hue;
        let [red, green, blue] = back;
        let rows: [[f32; 4]; VIEW_ROWS] = [
            x, y, z, luminance, table, long, middle, short, red, green, blue,
        ];
        queue.write_buffer(&self.uniform, 0, bytemuck::cast_slice(&rows));
        let points = view.curve.iter().zip(&view.whiteness);
        let points = points.map(|(&y, &w)| [y, w, 0.0, 0.0]);
        let colours = view.false_colour.iter().map(|&[r, g, b]| [r, g, b, 0.0]);
        let missing = TABLE_LEN - view.false_colour.len();
        let points: Vec<[f32; 4]> = points
            .chain(colours)
            .chain(std::iter::repeat_n([0.0; 4], missing))
            .collect();
        write(queue, &self.curves, &points);
    }

    /// Shows the film where this mapping says from now on.
    pub fn set_mapping(&mut self, queue: &wgpu::Queue, mapping: &Mapping) {
        let Mapping {
            zoom,
            corner: [left, top],
            canvas: [width, height],
        } = *mapping;
        let place = [1.0 / zoom, -left / zoom, -top / zoom, 0.0].map(|v| v as f32);
        let canvas = [width as f32, height as f32, 0.0, 0.0];
        let rows: [[f32; 4]; MAPPING_ROWS] = [place, canvas];
        let after_view = (VIEW_ROWS * ROW_BYTES) as u64;
        queue.write_buffer(&self.uniform, after_view, bytemuck::cast_slice(&rows));
    }

    /// Draws over the whole viewport of a pass, which is the canvas of the mapping. Beside the picture, what was there
    /// before stays.
    pub fn paint(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..3, 0..1);
    }
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    target: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("display"),
        source: wgpu::ShaderSource::Wgsl(include_str!("display.wgsl").into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("display"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("display"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("pixel"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(target.into())],
        }),
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        multiview_mask: None,
        cache: None,
    })
}

fn float_texture(device: &wgpu::Device, label: &str, [width, height]: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    uniform: &wgpu::Buffer,
    film: &wgpu::Texture,
    curves: &wgpu::Texture,
) -> wgpu::BindGroup {
    let view =
        |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    let (film, curves) = (view(film), view(curves));
    let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("display"),
        layout,
        entries: &[
            entry(0, uniform.as_entire_binding()),
            entry(1, wgpu::BindingResource::TextureView(&film)),
            entry(2, wgpu::BindingResource::TextureView(&curves)),
        ],
    })
}

/// Fills a whole texture; there must be as many texels as it has.
fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, texels: &[[f32; 4]]) {
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(16 * texture.width()),
        rows_per_image: None,
    };
    queue.write_texture(
        texture.as_image_copy(),
        bytemuck::cast_slice(texels),
        layout,
        texture.size(),
    );
}
