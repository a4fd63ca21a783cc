// Table rows combined once for each image row: entry t of a row is the weighted sum, over the rows of its box, of all texels left
// of t, in 64-bit fixed point (low word first) as the native code has it.
//
// Every fragment of the target is one entry. The target is cut into blocks of 32 entries times the rows of a tile.

struct Params {
    // Where the blocks' descriptions begin among the words; block k is the k-th of the target.
    blocks: u32,
    // Texels of the table.
    width: u32,
    height: u32,
    // Fixed point of whole texels; 32 but for tables of 64 bits.
    shift: u32,
}

// Weights at each end of a box, rows of a block, whether the table has 64 bits.
override REACH: u32 = 2u;
override ROWS: u32 = 8u;
override WIDE: bool = false;

// Blocks side by side in the target, entries in each.
const SHELF = 64u;
const BLOCK = 32u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var plan: texture_2d<u32>;
@group(0) @binding(2) var table: texture_2d<u32>;

fn words(at: u32) -> vec4<u32> {
    return textureLoad(plan, vec2<u32>(at % 2048u, at / 2048u), 0);
}

fn entry(x: u32, y: i32) -> vec2<u32> {
    return textureLoad(table, vec2<u32>(x, u32(clamp(y, 0, i32(params.height)))), 0).xy;
}

// sum + strip * weight modulo 2^64; one row's texels are under 2^32, so the strip's low word is all of it.
fn weigh(sum: vec2<u32>, strip: u32, weight: u32) -> vec2<u32> {
    let a = vec2<u32>(strip & 0xffffu, strip >> 16u);
    let b = vec2<u32>(weight & 0xffffu, weight >> 16u);
    let across = vec2<u32>(a.x * b.y, a.y * b.x);
    let middle = ((a.x * b.x) >> 16u) + (across.x & 0xffffu) + (across.y & 0xffffu);
    let high = a.y * b.y + (across.x >> 16u) + (across.y >> 16u) + (middle >> 16u);
    let low = sum.x + strip * weight;
    return vec2<u32>(low, sum.y + high + u32(low < sum.x));
}

@vertex
fn cover(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn combine(@builtin(position) place: vec4<f32>) -> @location(0) vec2<u32> {
    let x = u32(place.x);
    let y = u32(place.y);
    // Its first texel, where its first row's windows are, its last row.
    let block = words(params.blocks + y / ROWS * SHELF + x / BLOCK);
    let column = min(block.x + x % BLOCK, params.width);
    let at = block.y + min(y % ROWS, block.z) * (1u + REACH / 2u);
    var window = words(at);
    let first = bitcast<i32>(window.x);
    let second = bitcast<i32>(window.y);
    var above = entry(column, first);
    var below = entry(column, second);
    let bottom = below;
    var sum = vec2<u32>(0u);
    for (var k = 0u; k < REACH; k++) {
        if k % 2u == 1u {
            window = words(at + (k + 1u) / 2u);
        }
        let weights = select(window.zw, window.xy, vec2<bool>(k % 2u == 1u));
        let next_above = entry(column, first + i32(k) + 1);
        let next_below = entry(column, second + i32(k) + 1);
        sum = weigh(sum, next_above.x - above.x, weights.x);
        sum = weigh(sum, next_below.x - below.x, weights.y);
        above = next_above;
        below = next_below;
    }
    // The rows between both ends, whole.
    let low = bottom.x - above.x;
    if WIDE {
        let high = bottom.y - above.y - u32(bottom.x < above.x);
        let whole = vec2<u32>(low << params.shift, (high << params.shift) | (low >> (32u - params.shift)));
        let all = sum.x + whole.x;
        return vec2<u32>(all, sum.y + whole.y + u32(all < sum.x));
    }
    return vec2<u32>(sum.x, sum.y + low);
}
