// Mean opacity of a tilted plane's boxes, as tilted.rs has it. Fragments are laid out as in visibility.wgsl.
//
// What a screen point sees is a ratio of affine functions of the point. Each tile has them in f64 from the host, relative to a pixel in its
// middle, so that f32 loses nothing.

struct Params {
    tiles: u32,
    count: u32,
    // Where the look-up's maps begin among the words: six vectors a tile.
    maps: u32,
    // Texels of the table.
    width: u32,
    height: u32,
    // The sub-pixel of each pixel.
    sub_x: u32,
    sub_y: u32,
    // 1 / the largest code.
    norm: f32,
    // n . h of the piece's half-sides.
    along_x: f32,
    along_y: f32,
    unused_x: u32,
    unused_y: u32,
}

override SUB: u32 = 1u;
override WIDE: bool = false;

const ACROSS = 64u;

// Words side by side in a texture of them.
const ROW = 2048u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var plan: texture_2d<u32>;
@group(0) @binding(2) var table: texture_2d_array<u32>;

fn words(at: u32) -> vec4<u32> {
    return textureLoad(plan, vec2<u32>(at % ROW, at / ROW), 0);
}

// The table's entry, low word first; its texels hold four rows, see table.wgsl.
fn entry(x: u32, y: u32) -> vec2<u32> {
    let place = vec2<u32>(x, (y + 8u) / 4u);
    let low = textureLoad(table, place, 0, 0)[y % 4u];
    if WIDE {
        return vec2<u32>(low, textureLoad(table, place, 1, 0)[y % 4u]);
    }
    return vec2<u32>(low, 0u);
}

// a - b of 64 bits.
fn minus(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x - b.x, a.y - b.y - u32(a.x < b.x));
}

// The sum of a box's codes between two columns, from sums at its corners.
fn box(upper: vec2<u32>, next_upper: vec2<u32>, lower: vec2<u32>, next_lower: vec2<u32>) -> f32 {
    let sum = minus(minus(next_lower, lower), minus(next_upper, upper));
    if WIDE {
        return f32(sum.y) * 4294967296.0 + f32(sum.x);
    }
    return f32(sum.x);
}

// Ends of three parts of a box [centre - side / 2, centre + side / 2], in whole texels from the centre's own, and each part's weight.
struct Parts {
    ends: vec4<f32>,
    weights: vec3<f32>,
}

fn parts(centre: f32, side: f32) -> Parts {
    let start = centre - 0.5 * side;
    let stop = centre + 0.5 * side;
    let first = floor(start);
    let last = floor(stop);
    if first == last {
        return Parts(vec4<f32>(first, first + 1.0, first + 1.0, first + 1.0), vec3<f32>(side, 0.0, 0.0));
    }
    return Parts(vec4<f32>(first, first + 1.0, last, last + 1.0), vec3<f32>(first + 1.0 - start, 1.0, stop - last));
}

fn inside(base: i32, ends: vec4<f32>, size: u32) -> vec4<u32> {
    return vec4<u32>(clamp(vec4<i32>(base) + vec4<i32>(ends), vec4<i32>(0), vec4<i32>(i32(size))));
}

// Length of the box along one axis, from a = n . (c - p), b = n . (q - p), m and n . h of the piece's half-side.
fn side(a: f32, b: f32, m: f32, along: f32) -> f32 {
    let more = a / (b + along);
    let less = a / (b - along);
    let sees_more = more > 0.0 && more < 1.0;
    let sees_less = less > 0.0 && less < 1.0;
    // Where one half of a piece sees past the plane, the other half says how large it is there.
    if sees_more && sees_less {
        return abs(more * m / b) + abs(less * m / b);
    }
    return select(0.0, 2.0 * abs(more * m / b), sees_more) + select(0.0, 2.0 * abs(less * m / b), sees_less);
}

fn opacity(maps: u32, i: f32, j: f32) -> f32 {
    // Texel of the middle (whole and fraction), the map's change a sub-pixel in two parts, the second what the first's few bits leave.
    let middle = words(maps);
    let coarse = bitcast<vec4<f32>>(words(maps + 1u));
    let fine = bitcast<vec4<f32>>(words(maps + 2u));
    // Value, change along i and along j: of n . (c - p) and n . (q - p), of both axes' m.
    let heights = bitcast<vec4<f32>>(words(maps + 3u));
    let changes = bitcast<vec4<f32>>(words(maps + 4u));
    let spans = bitcast<vec4<f32>>(words(maps + 5u));
    let a = heights.x + (heights.y * i + heights.z * j);
    let b = heights.w + (changes.x * i + changes.y * j);
    let way = a / b;
    if !(way > 0.0 && way < 1.0) {
        return 0.0;
    }
    let m = vec2<f32>(
        changes.z + (changes.w * i + spans.x * j),
        spans.y + (spans.z * i + spans.w * j),
    );
    let sides = vec2<f32>(side(a, b, m.x, params.along_x), side(a, b, m.y, params.along_y));
    if sides.x <= 0.0 || sides.y <= 0.0 {
        return 0.0;
    }
    let step = coarse.xz * i + coarse.yw * j;
    let rest = fine.xz * i + fine.yw * j;
    // (g d) / (1 + b' d) = g d - g d b' d / (1 + b' d); the first is exact in its coarse part.
    let bent = (step + rest) * ((changes.x * i + changes.y * j) / b);
    let whole = floor(step);
    let centre = bitcast<vec2<f32>>(middle.zw) + (step - whole) + (rest - bent);
    let more = floor(centre);
    let base = bitcast<vec2<i32>>(middle.xy) + vec2<i32>(whole) + vec2<i32>(more);
    let x = parts(centre.x - more.x, sides.x);
    let y = parts(centre.y - more.y, sides.y);
    let xs = inside(base.x, x.ends, params.width);
    let ys = inside(base.y, y.ends, params.height);
    var sum = 0.0;
    var upper_a = entry(xs.x, ys.x);
    var upper_b = entry(xs.y, ys.x);
    var upper_c = entry(xs.z, ys.x);
    var upper_d = entry(xs.w, ys.x);
    for (var k = 0; k < 3; k++) {
        let lower_a = entry(xs.x, ys[k + 1]);
        let lower_b = entry(xs.y, ys[k + 1]);
        let lower_c = entry(xs.z, ys[k + 1]);
        let lower_d = entry(xs.w, ys[k + 1]);
        let row = x.weights.x * box(upper_a, upper_b, lower_a, lower_b)
            + x.weights.y * box(upper_b, upper_c, lower_b, lower_c)
            + x.weights.z * box(upper_c, upper_d, lower_c, lower_d);
        sum += y.weights[k] * row;
        upper_a = lower_a;
        upper_b = lower_b;
        upper_c = lower_c;
        upper_d = lower_d;
    }
    let mean = sum / (sides.x * sides.y) * params.norm;
    return select(mean, 1.0, mean > 0.999999);
}

@vertex
fn cover(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn slope(@builtin(position) place: vec4<f32>) -> @location(0) vec4<u32> {
    let x = u32(place.x);
    let y = u32(place.y);
    let tile = min(y / 2u * ACROSS + x / 32u, params.count - 1u);
    let maps = params.maps + 6u * tile;
    // From the first sub-pixel of the tile's middle pixel.
    let i = f32(i32((x % 32u) * SUB + params.sub_x) - i32(16u * SUB));
    let j = f32(i32((y % 2u * 4u) * SUB + params.sub_y) - i32(4u * SUB));
    let step = f32(SUB);
    let a = opacity(maps, i, j);
    let b = opacity(maps, i, j + step);
    let c = opacity(maps, i, j + 2.0 * step);
    let d = opacity(maps, i, j + 3.0 * step);
    return bitcast<vec4<u32>>(vec4<f32>(a, b, c, d));
}
