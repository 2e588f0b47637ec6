// The display on the graphics card: the mean light over the patch of film that a pixel of the canvas covers, then the
// steps of `BakedView::apply`, with the same numbers. Change both together; a test compares them.

struct View {
    // Rows of the matrix from XYZ to linear Rec. 709; w: the softness of the fit into the triangle, how far outside is
    // let be, and where paling starts (0: it does not).
    rgb_from_xyz: array<vec4<f32>, 3>,
    // Weights of Y; w is the share of the curve that is applied channel by channel.
    luminance: vec4<f32>,
    // log2 of the light at a table's first point, points for each stop, last point, 1 where the target encodes sRGB
    // itself.
    table: vec4<f32>,
    // Rows of the matrix from linear Rec. 709 to the receptors of the hue; w: the road, as `Road` has it, what Y is
    // multiplied by for its false colour, and 1 where clipped channels are marked.
    receptors_from_rgb: array<vec4<f32>, 3>,
    // Rows of the matrix back; w: the weights of the lightness.
    rgb_from_receptors: array<vec4<f32>, 3>,
    // Film pixels for one pixel of the canvas, and where on the film its upper left corner lies (yz).
    place: vec4<f32>,
    // Width and height of the canvas (xy).
    canvas: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;
// XYZ of the film, and the stride of the pass that wrote the pixel.
@group(0) @binding(1) var film: texture_2d<f32>;
// First row: y in red, w in green; second row: false colours.
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

// A row of tables at a position, in points from the first.
fn tables(position: f32, row: i32) -> vec3<f32> {
    let inside = min(position, view.table.z);
    let left = min(i32(inside), i32(view.table.z) - 1);
    let a = textureLoad(curves, vec2<i32>(left, row), 0).xyz;
    let b = textureLoad(curves, vec2<i32>(left + 1, row), 0).xyz;
    return mix(a, b, inside - f32(left));
}

// y and w at a light.
fn looked_up(light: f32) -> vec2<f32> {
    let position = (log2(light) - view.table.x) * view.table.y;
    // Also true for a light of 0, whose logarithm is not a number everywhere.
    if !(position >= 0.0) || light <= 0.0 {
        return vec2<f32>(0.0);
    }
    return tables(position, 0).xy;
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

// A colour as lightness (w) and what sets it apart from grey.
fn apart(rgb: vec3<f32>) -> vec4<f32> {
    let response = vec3<f32>(
        dot(view.receptors_from_rgb[0].xyz, rgb),
        dot(view.receptors_from_rgb[1].xyz, rgb),
        dot(view.receptors_from_rgb[2].xyz, rgb),
    );
    let largest = max(response.r, max(response.g, response.b));
    // No eye sees it: lightness 0.
    if largest <= 0.0 {
        return vec4<f32>(0.0);
    }
    let compressed = pow(max(response, vec3<f32>(0.01 * largest)), vec3<f32>(1.0 / 3.0));
    let weights = vec3<f32>(
        view.rgb_from_receptors[0].w,
        view.rgb_from_receptors[1].w,
        view.rgb_from_receptors[2].w,
    );
    let lightness = dot(weights, compressed);
    return vec4<f32>(compressed - lightness, lightness);
}

// The colour of what was taken apart.
fn together(parts: vec4<f32>) -> vec3<f32> {
    let q = parts.xyz + parts.w;
    let response = q * q * q;
    return vec3<f32>(
        dot(view.rgb_from_receptors[0].xyz, response),
        dot(view.rgb_from_receptors[1].xyz, response),
        dot(view.rgb_from_receptors[2].xyz, response),
    );
}

fn cubic(c: vec4<f32>, k: f32) -> f32 {
    return ((c.w * k + c.z) * k + c.y) * k + c.x;
}

// The k up to `furthest` at which a bound is met.
fn reach(parts: vec4<f32>, bound: vec3<f32>, outside: f32, furthest: f32) -> f32 {
    let l = parts.w;
    let d = parts.xyz;
    let c = vec4<f32>(
        outside + l * l * l * dot(bound, vec3<f32>(1.0)),
        3.0 * l * l * dot(bound, d),
        3.0 * l * dot(bound, d * d),
        dot(bound, d * d * d),
    );
    if cubic(c, furthest) >= 0.0 {
        return furthest;
    }
    var low = 0.0;
    var high = furthest;
    for (var i = 0; i < 10; i++) {
        let middle = 0.5 * (low + high);
        if cubic(c, middle) < 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let above = max(cubic(c, low), 0.0);
    return low + (high - low) * above / (above - cubic(c, high));
}

// The share of colour that keeps three bounds.
fn kept(parts: vec4<f32>, bounds: mat3x3<f32>, outside: f32) -> f32 {
    let start = view.rgb_from_xyz[2].w;
    let furthest = 1.0 / start;
    let nearest = min(
        reach(parts, bounds[0], outside, furthest),
        min(reach(parts, bounds[1], outside, furthest), reach(parts, bounds[2], outside, furthest)),
    );
    if nearest >= furthest {
        return 1.0;
    }
    let left = 1.0 - start * nearest;
    return nearest * (start + (1.0 - start) * left / (left + (1.0 - start) * nearest));
}

// The colour in units of its largest channel, taken apart and paled until the display can show it, or nearly. Lightness
// 0 where there is no light. The share that was kept goes along.
struct Nearer {
    parts: vec4<f32>,
    kept: f32,
}

fn nearer_grey(rgb: vec3<f32>) -> Nearer {
    if dot(view.luminance.xyz, rgb) <= 0.0 {
        return Nearer(vec4<f32>(0.0), 1.0);
    }
    let parts = apart(rgb / max(rgb.r, max(rgb.g, rgb.b)));
    if parts.w <= 0.0 {
        return Nearer(vec4<f32>(0.0), 1.0);
    }
    // Columns of a matrix here are the rows of ours.
    let bounds = mat3x3<f32>(
        view.rgb_from_receptors[0].xyz,
        view.rgb_from_receptors[1].xyz,
        view.rgb_from_receptors[2].xyz,
    );
    let share = kept(parts, bounds, view.rgb_from_xyz[1].w);
    return Nearer(vec4<f32>(parts.xyz * share, parts.w), share);
}

fn by_channels(seen: vec3<f32>) -> vec3<f32> {
    // Fit into the triangle of the display.
    var near = seen;
    if view.rgb_from_xyz[2].w > 0.0 {
        let nearer = nearer_grey(seen);
        if nearer.kept < 1.0 {
            let pale = together(nearer.parts);
            near = pale * (dot(view.luminance.xyz, seen) / dot(view.luminance.xyz, pale));
        }
    }
    let rgb = without_negatives(near);
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

fn by_hue(seen: vec3<f32>, of_luminance: bool) -> vec3<f32> {
    // Fit into the triangle of the display.
    let nearer = nearer_grey(seen);
    if nearer.parts.w <= 0.0 {
        return vec3<f32>(0.0);
    }
    let inside = max(together(nearer.parts), vec3<f32>(0.0));
    let y = dot(view.luminance.xyz, seen);
    var light = y;
    if !of_luminance {
        light = max(inside.r, max(inside.g, inside.b)) / dot(view.luminance.xyz, inside) * y;
    }
    // Shoulder and path to white; then what is still too bright for its colour.
    let top = looked_up(light);
    var parts = vec4<f32>(nearer.parts.xyz * (1.0 - top.y), nearer.parts.w);
    if of_luminance {
        let r = view.rgb_from_receptors[0].xyz;
        let g = view.rgb_from_receptors[1].xyz;
        let b = view.rgb_from_receptors[2].xyz;
        let weights = view.luminance.x * r + view.luminance.y * g + view.luminance.z * b;
        let bounds = mat3x3<f32>(weights - top.x * r, weights - top.x * g, weights - top.x * b);
        parts = vec4<f32>(parts.xyz * kept(parts, bounds, 0.0), parts.w);
    }
    let pale = max(together(parts), vec3<f32>(0.0));
    var measure = max(pale.r, max(pale.g, pale.b));
    if of_luminance {
        measure = dot(view.luminance.xyz, pale);
    }
    return min(pale * (top.x / measure), vec3<f32>(1.0));
}

// The colour of a light's stop.
fn by_stops(light: f32) -> vec3<f32> {
    let position = (log2(max(light, exp2(view.table.x))) - view.table.x) * view.table.y;
    return tables(max(position, 0.0), 1);
}

fn shown(xyz: vec3<f32>) -> vec3<f32> {
    // Expose and adapt.
    var seen = vec3<f32>(
        dot(view.rgb_from_xyz[0].xyz, xyz),
        dot(view.rgb_from_xyz[1].xyz, xyz),
        dot(view.rgb_from_xyz[2].xyz, xyz),
    );
    var y = xyz.y;
    if !(is_finite(seen.r) && is_finite(seen.g) && is_finite(seen.b)) {
        seen = vec3<f32>(0.0);
        y = 0.0;
    }
    switch i32(view.receptors_from_rgb[0].w) {
        case 1: {
            return by_hue(seen, false);
        }
        case 2: {
            return by_hue(seen, true);
        }
        case 3: {
            return by_stops(view.receptors_from_rgb[1].w * y);
        }
        default: {
            return by_channels(seen);
        }
    }
}

fn srgb_encoded(linear: vec3<f32>) -> vec3<f32> {
    let power = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(power, linear * 12.92, linear <= vec3<f32>(0.0031308));
}

// Light of a pixel as it was written. What is no number is black, so that it spoils no mean.
fn written(texel: vec2<i32>) -> vec3<f32> {
    let xyz = textureLoad(film, texel, 0).xyz;
    let good = is_finite(xyz.x) && is_finite(xyz.y) && is_finite(xyz.z);
    return select(vec3<f32>(0.0), xyz, good);
}

// Light of a pixel that a coarse pass wrote: between the four nearest rays. A ray stands in the middle of its block of
// stride × stride pixels (see `render::pass`), so the picture does not move when it sharpens. The pixel in the middle
// of a block is read because a finer pass that was there already has put its nearest ray there.
fn between_rays(texel: vec2<i32>, stride: i32, size: vec2<i32>) -> vec3<f32> {
    let place = (vec2<f32>(texel) + 0.5) / f32(stride) - 0.5;
    let ray = vec2<i32>(floor(place));
    let share = fract(place);
    let last = (size - 1) / stride;
    let first_middle = clamp(ray, vec2<i32>(0), last) * stride + stride / 2;
    let next_middle = clamp(ray + 1, vec2<i32>(0), last) * stride + stride / 2;
    // The last block may reach over the edge of the film.
    let a = min(first_middle, size - 1);
    let b = min(next_middle, size - 1);
    let above = mix(written(a), written(vec2<i32>(b.x, a.y)), share.x);
    let below = mix(written(vec2<i32>(a.x, b.y)), written(b), share.x);
    return mix(above, below, share.y);
}

fn light(texel: vec2<i32>, size: vec2<i32>) -> vec3<f32> {
    let stride = i32(textureLoad(film, texel, 0).w);
    if stride > 1 {
        return between_rays(texel, stride, size);
    }
    return written(texel);
}

// A coordinate on the film, on the edge of a pixel where it is as good as there: what rounding leaves of a bright
// neighbour would be seen.
fn settled(at: vec2<f32>) -> vec2<f32> {
    let edge = round(at);
    return select(at, edge, abs(at - edge) < vec2<f32>(1e-3));
}

// Most film pixels that are read for one pixel of the canvas on each axis. A patch with more is sampled on an even
// lattice of 16 × 16: it takes a zoom below 1/15 to get there.
const MOST: i32 = 16;

// Which pixel of the film is the k-th of a span on one axis (x), and how much of it lies in the span (y).
fn part(k: i32, low: f32, high: f32, count: i32) -> vec2<f32> {
    if count > MOST {
        return vec2<f32>(floor(low + (high - low) * (f32(k) + 0.5) / f32(MOST)), 1.0);
    }
    let texel = floor(low) + f32(k);
    return vec2<f32>(texel, min(high, texel + 1.0) - max(low, texel));
}

// Mean light over a patch of the film: crisp squares where a film pixel is large, no aliasing where it is small, and
// the pixel itself at one to one.
fn mean_light(low: vec2<f32>, high: vec2<f32>, size: vec2<i32>) -> vec3<f32> {
    let count = vec2<i32>(ceil(high)) - vec2<i32>(floor(low));
    let reads = clamp(count, vec2<i32>(1), vec2<i32>(MOST));
    var sum = vec3<f32>(0.0);
    var weights = 0.0;
    for (var j = 0; j < reads.y; j++) {
        let row = part(j, low.y, high.y, count.y);
        for (var i = 0; i < reads.x; i++) {
            let column = part(i, low.x, high.x, count.x);
            let texel = clamp(vec2<i32>(i32(column.x), i32(row.x)), vec2<i32>(0), size - 1);
            let weight = column.y * row.y;
            sum += weight * light(texel, size);
            weights += weight;
        }
    }
    return sum / weights;
}

// Stripes over what is at the highest level of a display in any channel. The other stripes show what is there.
const HIGHEST_LEVEL: f32 = 254.5 / 255.0;
const STRIPE: f32 = 4.0;
const MARK: vec3<f32> = vec3<f32>(0.0, 0.75, 1.0);

fn marked(encoded: vec3<f32>, column_row: vec2<f32>) -> vec3<f32> {
    let is_clipped = max(encoded.r, max(encoded.g, encoded.b)) >= HIGHEST_LEVEL;
    let is_striped = fract((column_row.x + column_row.y) / (2.0 * STRIPE)) < 0.5;
    let marks = view.receptors_from_rgb[2].w > 0.5;
    return select(encoded, MARK, marks && is_clipped && is_striped);
}

fn srgb_decoded(encoded: vec3<f32>) -> vec3<f32> {
    let power = pow((encoded + 0.055) / 1.055, vec3<f32>(2.4));
    return select(power, encoded / 12.92, encoded <= vec3<f32>(0.04045));
}

@fragment
fn pixel(at: Corner) -> @location(0) vec4<f32> {
    let size = vec2<i32>(textureDimensions(film));
    // Whole numbers, so that every step up to the film is exact where the zoom is a power of two.
    let column_row = floor(at.place * view.canvas.xy);
    let low = settled(column_row * view.place.x + view.place.yz);
    let high = settled((column_row + 1.0) * view.place.x + view.place.yz);
    let middle = 0.5 * (low + high);
    if any(middle < vec2<f32>(0.0)) || any(middle >= vec2<f32>(size)) {
        // Beside the picture: what was painted there before shows.
        discard;
    }
    let inside_low = max(low, vec2<f32>(0.0));
    let inside_high = min(high, vec2<f32>(size));
    let linear = shown(mean_light(inside_low, inside_high, size));
    let encoded = srgb_encoded(clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0)));
    let seen = marked(encoded, column_row);
    if view.table.w > 0.5 {
        return vec4<f32>(select(linear, srgb_decoded(seen), any(seen != encoded)), 1.0);
    }
    return vec4<f32>(seen, 1.0);
}
