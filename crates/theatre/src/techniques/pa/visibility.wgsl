// Visibility of one emitter in one channel: the product over the planes of each box's transmittance, summed over the emitter's
// pieces by weight. Or, for the paper's ambient light, what one plane alone hides.
//
// Every fragment of the target is four pixels, one above the other; a tile of 32 x 8 pixels is a cell of 32 x 2 fragments.

struct Params {
    // Where things begin among the words: tiles, pieces, look-ups, the loop's bounds.
    tiles: u32,
    pieces: u32,
    lookups: u32,
    bounds: u32,
    // Words of one tile, and the number of tiles.
    stride: u32,
    count: u32,
    channel: u32,
    // The image's last column, pixels.
    right: u32,
    // The plane whose own shadow is asked for, and where the emitter's share of the light is: layers `shares` to `shares_end` - 1
    // by `shares_step`; what they leave where `rest` is 1.
    plane: u32,
    shares: u32,
    shares_end: u32,
    shares_step: u32,
    rest: u32,
    unused_x: u32,
    unused_y: u32,
    unused_z: u32,
}

// Weights at each end of a box, sub-pixels a pixel and axis.
override REACH: u32 = 2u;
override SUB: u32 = 1u;
// Pieces weigh by their own irradiance; one plane's own shadow is asked for; some planes are tilted.
override IRRADIANCE: bool = false;
override OWN: bool = false;
override TILTED: bool = false;
// Sums go on from `before`; they are divided by the weights' sum at last.
override GOES_ON: bool = false;
override ENDS: bool = true;

// As in rows.wgsl.
const SHELF = 64u;
const BLOCK = 32u;
// Cells side by side in the target.
const ACROSS = 64u;

// Words side by side in a texture of them.
const ROW = 2048u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var plan: texture_2d<u32>;
@group(0) @binding(2) var sums: texture_2d<u32>;
@group(0) @binding(3) var before: texture_2d<u32>;
@group(0) @binding(4) var lit: texture_2d_array<u32>;
// Opacities of tilted planes, see tilted.wgsl.
@group(0) @binding(5) var slopes: texture_2d_array<u32>;

fn words(at: u32) -> vec4<u32> {
    return textureLoad(plan, vec2<u32>(at % ROW, at / ROW), 0);
}

// One plane of one piece as a tile sees it: where its combined rows begin, which texels they hold, which of a column's texels is asked for.
struct Strip {
    block: u32,
    low: i32,
    high: i32,
    quad: u32,
}

// Four rows' entries of combined rows.
fn entries(strip: Strip, texel: i32) -> vec4<u32> {
    let t = u32(clamp(texel, strip.low, strip.high) - strip.low);
    let block = strip.block + t / BLOCK;
    let place = vec2<u32>(block % SHELF * BLOCK + t % BLOCK, block / SHELF * (2u * SUB) + strip.quad);
    return textureLoad(sums, place, 0);
}

// Mean opacity of the boxes of four pixels: positive weights of exact integer differences.
fn opacity(windows: u32, interior: f32, strip: Strip) -> vec4<f32> {
    var mean = vec4<f32>(0.0);
    var left = vec4<u32>(0u);
    var middle = vec4<u32>(0u);
    for (var k = 0u; k < REACH; k += 3u) {
        let first = words(windows + k / 3u * 2u);
        let second = words(windows + k / 3u * 2u + 1u);
        let a = bitcast<i32>(first.x);
        let b = bitcast<i32>(second.x);
        let weights = bitcast<vec3<f32>>(first.yzw);
        let weights_b = bitcast<vec3<f32>>(second.yzw);
        left = entries(strip, a);
        var right = entries(strip, b);
        if k == 0u {
            middle = right;
        }
        var next = entries(strip, a + 1);
        var next_b = entries(strip, b + 1);
        mean += weights.x * vec4<f32>(next - left) + weights_b.x * vec4<f32>(next_b - right);
        left = next;
        right = next_b;
        if k + 1u < REACH {
            next = entries(strip, a + 2);
            next_b = entries(strip, b + 2);
            mean += weights.y * vec4<f32>(next - left) + weights_b.y * vec4<f32>(next_b - right);
            left = next;
            right = next_b;
        }
        if k + 2u < REACH {
            next = entries(strip, a + 3);
            next_b = entries(strip, b + 3);
            mean += weights.z * vec4<f32>(next - left) + weights_b.z * vec4<f32>(next_b - right);
            left = next;
        }
    }
    mean += interior * vec4<f32>(middle - left);
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

fn share(x: u32, quad: u32) -> vec4<f32> {
    var sum = vec4<f32>(0.0);
    for (var layer = params.shares; layer < params.shares_end; layer += params.shares_step) {
        sum += bitcast<vec4<f32>>(textureLoad(lit, vec2<u32>(x, quad), layer, 0));
    }
    return select(sum, 1.0 - sum, vec4<bool>(params.rest == 1u));
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
    let row = home.y + y % 2u * 4u;
    let rows = vec4<f32>(f32(row)) + vec4<f32>(0.0, 1.0, 2.0, 3.0);
    // Pieces to add, and all pieces of the emitter; read from the words, since some drivers compile anew for each value of a uniform
    // that bounds a loop.
    let bounds = words(params.bounds);
    var all = vec4<f32>(0.0);
    if OWN || ENDS {
        for (var p = bounds.z; p < bounds.w; p++) {
            all += weight(params.pieces + 3u * p, f32(column), rows);
        }
    }
    var total = vec4<f32>(0.0);
    if GOES_ON {
        total = bitcast<vec4<f32>>(textureLoad(before, vec2<u32>(x, y), 0));
    }
    var light = vec4<f32>(1.0);
    if OWN {
        light = share(column, row / 4u);
    }
    for (var p = bounds.x; p < bounds.y; p++) {
        let piece = words(params.pieces + 3u * p);
        var sum = vec4<f32>(0.0);
        for (var s = 0u; s < SUB * SUB; s++) {
            var product = vec4<f32>(1.0);
            for (var l = piece.x; l < piece.y; l++) {
                // Its windows, words from channel to channel (blocks or layers), plane or 65536 + plane where it is tilted, interior.
                let lookup = words(params.lookups + l);
                if !OWN || (lookup.z & 0xffffu) == params.plane {
                    let seen = words(tile + 1u + l);
                    let begins = seen.x + params.channel * lookup.y;
                    var shade = vec4<f32>(0.0);
                    if TILTED && lookup.z > 0xffffu {
                        shade = bitcast<vec4<f32>>(textureLoad(slopes, vec2<u32>(x, y), begins + s, 0));
                    } else {
                        let windows = lookup.x + (column * SUB + s % SUB) * ((REACH + 2u) / 3u * 2u);
                        let quad = y % 2u * SUB + s / SUB;
                        let strip = Strip(begins, bitcast<i32>(seen.y), bitcast<i32>(seen.z), quad);
                        shade = opacity(windows, bitcast<f32>(lookup.w), strip);
                    }
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
    if !OWN && ENDS {
        total = min(total / all, vec4<f32>(1.0));
    }
    return bitcast<vec4<u32>>(total);
}
