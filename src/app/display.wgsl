// The display on the graphics card: takes the steps of `BakedView::apply`, with the same numbers, for each pixel of
// the canvas. Change both together; a test compares them.

struct View {
    // Rows of the matrix from XYZ to linear Rec. 709; w of the first is the softness of the fit into the triangle.
    rgb_from_xyz: array<vec4<f32>, 3>,
    // Weights of Y; w is the share of the curve that is applied channel by channel.
    luminance: vec4<f32>,
    // log2 of the light at a table's first point, points for each stop, last point, 1 where the target encodes sRGB
    // itself.
    table: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;
// XYZ of the film.
@group(0) @binding(1) var film: texture_2d<f32>;
// One row: y in red, w in green.
@group(0) @binding(2) var curves: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) place: vec2<f32>,
}

// One triangle that covers the viewport.
@vertex
fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let place = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u));
    let position = vec4<f32>(place.x * 2.0 - 1.0, 1.0 - place.y * 2.0, 0.0, 1.0);
    return Corner(position, place);
}

// Both tables at a light.
fn looked_up(light: f32) -> vec2<f32> {
    let position = (log2(light) - view.table.x) * view.table.y;
    // Also true for a light of 0, whose logarithm is not a number everywhere.
    if !(position >= 0.0) || light <= 0.0 {
        return vec2<f32>(0.0);
    }
    let inside = min(position, view.table.z);
    let left = min(i32(inside), i32(view.table.z) - 1);
    let a = textureLoad(curves, vec2<i32>(left, 0), 0).xy;
    let b = textureLoad(curves, vec2<i32>(left + 1, 0), 0).xy;
    return mix(a, b, inside - f32(left));
}

// Compilers may assume that numbers are finite, so the bits decide.
fn is_finite(channel: f32) -> bool {
    return (bitcast<u32>(channel) & 0x7f800000u) != 0x7f800000u;
}

// max(channel, 0), rounded off by a hyperbola where |channel| is of the size of `bend`.
fn smooth_positive(channel: f32, bend: f32) -> f32 {
    let root = sqrt(channel * channel + bend * bend);
    if channel >= 0.0 {
        return 0.5 * (channel + root);
    }
    if bend > 0.0 {
        return 0.5 * bend * bend / (root - channel);
    }
    return 0.0;
}

// The colour without negative channels, of the same luminance.
fn without_negatives(rgb: vec3<f32>) -> vec3<f32> {
    let bend = view.rgb_from_xyz[0].w * max(rgb.r, max(rgb.g, rgb.b));
    let positive = vec3<f32>(
        smooth_positive(rgb.r, bend),
        smooth_positive(rgb.g, bend),
        smooth_positive(rgb.b, bend),
    );
    let y = dot(view.luminance.xyz, rgb);
    let y_positive = dot(view.luminance.xyz, positive);
    if y <= 0.0 || y_positive <= 0.0 {
        return vec3<f32>(0.0);
    }
    return positive * (y / y_positive);
}

fn shown(xyz: vec3<f32>) -> vec3<f32> {
    // Expose and adapt.
    let seen = vec3<f32>(
        dot(view.rgb_from_xyz[0].xyz, xyz),
        dot(view.rgb_from_xyz[1].xyz, xyz),
        dot(view.rgb_from_xyz[2].xyz, xyz),
    );
    if !(is_finite(seen.r) && is_finite(seen.g) && is_finite(seen.b)) {
        return vec3<f32>(0.0);
    }
    // Fit into the triangle of the display.
    let rgb = without_negatives(seen);
    let brightest = max(rgb.r, max(rgb.g, rgb.b));
    if brightest <= 0.0 {
        return vec3<f32>(0.0);
    }
    // Shoulder, then the mix with white.
    let top = looked_up(brightest);
    let kept = rgb / brightest * top.x;
    let own = vec3<f32>(looked_up(rgb.r).x, looked_up(rgb.g).x, looked_up(rgb.b).x);
    let mixed = mix(kept, own, view.luminance.w);
    return mix(mixed, vec3<f32>(top.x), top.y);
}

fn srgb_encoded(linear: vec3<f32>) -> vec3<f32> {
    let power = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(power, linear * 12.92, linear <= vec3<f32>(0.0031308));
}

@fragment
fn pixel(at: Corner) -> @location(0) vec4<f32> {
    let size = vec2<i32>(textureDimensions(film));
    let texel = clamp(vec2<i32>(floor(at.place * vec2<f32>(size))), vec2<i32>(0), size - 1);
    let linear = shown(textureLoad(film, texel, 0).xyz);
    let encoded = srgb_encoded(clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0)));
    return vec4<f32>(select(encoded, linear, view.table.w > 0.5), 1.0);
}
