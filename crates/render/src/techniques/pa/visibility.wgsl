// Visibility of one emitter in one channel: the product over the planes of each box's transmittance, summed over the emitter's
// pieces by weight. Or, for the paper's ambient light, what one plane alone hides.
//
// Every fragment of the target is four pixels, one above the other; a tile of 32 x 8 pixels is a cell of 32 x 2 fragments.

struct Params {
    // Where things begin among the words.
    tiles: u32,
    pieces: u32,
    lookups: u32,
    // Words of one tile, and the number of tiles.
    stride: u32,
    count: u32,
    // Pieces to add, and all pieces of the emitter.
    begin: u32,
    end: u32,
    first: u32,
    last: u32,
    channel: u32,
    // The image's last column and row, pixels.
    right: u32,
    bottom: u32,
    // Whether sums go on from `before`; whether they are divided by the weights' sum at last.
    goes_on: u32,
    ends: u32,
    // The plane whose own shadow is asked for, and where the emitter's share of the light is: layers `shares` to `shares_end` - 1
    // by `shares_step`; what they leave where `rest` is 1.
    plane: u32,
    shares: u32,
    shares_end: u32,
    shares_step: u32,
    rest: u32,
    unused: u32,
}

// Weights at each end of a box, sub-pixels a pixel and axis.
override REACH: u32 = 2u;
override SUB: u32 = 1u;
// Pieces weigh by their own irradiance; one plane's own shadow is asked for.
override IRRADIANCE: bool = false;
override OWN: bool = false;

// As in rows.wgsl.
const SHELF = 64u;
const BLOCK = 32u;
// Cells side by side in the target.
const ACROSS = 64u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var plan: texture_2d<u32>;
@group(0) @binding(2) var sums: texture_2d<u32>;
@group(0) @binding(3) var before: texture_2d<u32>;
@group(0) @binding(4) var lit: texture_2d_array<u32>;

fn words(at: u32) -> vec4<u32> {
    return textureLoad(plan, vec2<u32>(at % 2048u, at / 2048u), 0);
}

// Four rows' entries of a combined row.
struct Entries {
    low: vec4<u32>,
    high: vec4<u32>,
}

// One plane of one piece as a tile sees it: where its combined rows begin, and which texels they hold.
struct Strip {
    block: u32,
    low: i32,
    high: i32,
    row: u32,
}

fn entries(strip: Strip, texel: i32) -> Entries {
    let t = u32(clamp(texel, strip.low, strip.high) - strip.low);
    let block = strip.block + t / BLOCK;
    let x = block % SHELF * BLOCK + t % BLOCK;
    let y = block / SHELF * (8u * SUB) + strip.row;
    let a = textureLoad(sums, vec2<u32>(x, y), 0).xy;
    let b = textureLoad(sums, vec2<u32>(x, y + SUB), 0).xy;
    let c = textureLoad(sums, vec2<u32>(x, y + 2u * SUB), 0).xy;
    let d = textureLoad(sums, vec2<u32>(x, y + 3u * SUB), 0).xy;
    return Entries(vec4<u32>(a.x, b.x, c.x, d.x), vec4<u32>(a.y, b.y, c.y, d.y));
}

fn between(a: Entries, b: Entries) -> vec4<f32> {
    let low = b.low - a.low;
    let high = b.high - a.high - vec4<u32>(b.low < a.low);
    return vec4<f32>(high) * 4294967296.0 + vec4<f32>(low);
}

// Mean opacity of the boxes of four pixels: positive weights of exact integer differences.
fn opacity(windows: u32, scale: vec2<f32>, strip: Strip) -> vec4<f32> {
    var window = words(windows);
    let first = bitcast<i32>(window.x);
    let second = bitcast<i32>(window.y);
    var left = entries(strip, first);
    var right = entries(strip, second);
    let middle = right;
    var mean = vec4<f32>(0.0);
    for (var k = 0u; k < REACH; k++) {
        if k % 2u == 1u {
            window = words(windows + (k + 1u) / 2u);
        }
        let weights = bitcast<vec2<f32>>(select(window.zw, window.xy, vec2<bool>(k % 2u == 1u)));
        let next_left = entries(strip, first + i32(k) + 1);
        let next_right = entries(strip, second + i32(k) + 1);
        mean += weights.x * between(left, next_left) + weights.y * between(right, next_right);
        left = next_left;
        right = next_right;
    }
    mean = (mean + scale.x * between(left, middle)) * scale.y;
    // What is dark is so exactly, as where it is not looked up at all.
    return select(mean, vec4<f32>(1.0), mean > vec4<f32>(0.999999));
}

// Mean over the piece of 1 / (1 + tan^2)^2, which is its irradiance over area / distance^2, by a 4 x 4 Gauss rule; `x` and `y` are the
// tangents towards its centre, `half` those of its half-sides.
fn irradiance(x: f32, y: vec4<f32>, half: vec2<f32>) -> vec4<f32> {
    let nodes = vec4<f32>(-0.8611363116, -0.3399810436, 0.3399810436, 0.8611363116);
    let shares = vec4<f32>(0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226);
    var sum = vec4<f32>(0.0);
    for (var i = 0; i < 4; i++) {
        let dx = x + nodes[i] * half.x;
        for (var j = 0; j < 4; j++) {
            let dy = y + nodes[j] * half.y;
            let w = 1.0 + (dx * dx + dy * dy);
            sum += shares[i] * shares[j] / (w * w);
        }
    }
    return sum;
}

// Weights of a piece at four pixels: column, rows.
fn weight(piece: u32, column: f32, rows: vec4<f32>) -> vec4<f32> {
    let share = bitcast<f32>(words(piece).z);
    if IRRADIANCE {
        let map = bitcast<vec4<f32>>(words(piece + 1u));
        let half = bitcast<vec4<f32>>(words(piece + 2u)).xy;
        return share * irradiance(map.x + column * map.z, map.y + rows * map.w, half);
    }
    return vec4<f32>(share);
}

fn share(x: u32, y: u32) -> f32 {
    var sum = 0.0;
    for (var layer = params.shares; layer < params.shares_end; layer += params.shares_step) {
        sum += bitcast<f32>(textureLoad(lit, vec2<u32>(x, min(y, params.bottom)), layer, 0).x);
    }
    return select(sum, 1.0 - sum, params.rest == 1u);
}

@vertex
fn cover(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn add(@builtin(position) place: vec4<f32>) -> @location(0) vec4<u32> {
    let x = u32(place.x);
    let y = u32(place.y);
    let tile = params.tiles + params.stride * min(y / 2u * ACROSS + x / 32u, params.count - 1u);
    let home = words(tile);
    let column = min(home.x + x % 32u, params.right);
    let row = y % 2u * 4u;
    let rows = vec4<f32>(f32(home.y + row)) + vec4<f32>(0.0, 1.0, 2.0, 3.0);
    var all = vec4<f32>(0.0);
    if OWN || params.ends == 1u {
        for (var p = params.first; p < params.last; p++) {
            all += weight(params.pieces + 3u * p, f32(column), rows);
        }
    }
    var total = vec4<f32>(0.0);
    if params.goes_on == 1u {
        total = bitcast<vec4<f32>>(textureLoad(before, vec2<u32>(x, y), 0));
    }
    var light = vec4<f32>(1.0);
    if OWN {
        let j = home.y + row;
        light = vec4<f32>(share(column, j), share(column, j + 1u), share(column, j + 2u), share(column, j + 3u));
    }
    for (var p = params.begin; p < params.end; p++) {
        let piece = words(params.pieces + 3u * p);
        var sum = vec4<f32>(0.0);
        for (var s = 0u; s < SUB * SUB; s++) {
            var product = vec4<f32>(1.0);
            for (var l = piece.x; l < piece.y; l++) {
                let lookup = words(params.lookups + 2u * l);
                if !OWN || lookup.z == params.plane {
                    let scale = bitcast<vec2<f32>>(words(params.lookups + 2u * l + 1u).xy);
                    let seen = words(tile + 1u + l);
                    let windows = lookup.x + (column * SUB + s % SUB) * (1u + REACH / 2u);
                    let block = seen.x + params.channel * lookup.y;
                    let strip = Strip(block, bitcast<i32>(seen.y), bitcast<i32>(seen.z), row * SUB + s / SUB);
                    let shade = opacity(windows, scale, strip);
                    if OWN {
                        sum += shade;
                    } else {
                        product *= 1.0 - shade;
                    }
                }
            }
            if !OWN {
                sum += product;
            }
        }
        let mean = sum * (1.0 / f32(SUB * SUB));
        if OWN {
            total += light * mean * (weight(params.pieces + 3u * p, f32(column), rows) / all);
        } else {
            total += weight(params.pieces + 3u * p, f32(column), rows) * mean;
        }
    }
    if !OWN && params.ends == 1u {
        total = min(total / all, vec4<f32>(1.0));
    }
    return bitcast<vec4<u32>>(total);
}
