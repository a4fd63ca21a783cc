// Table rows combined once for each image row: entry t of a row is the weighted sum, over the rows of its box, of all texels left
// of t, in 64-bit fixed point as the native code has it; of that the 32 bits are kept in which any box is under 2^32.
//
// Every fragment of the target is one entry of four rows. The target is cut into blocks of 32 entries times the rows of a tile; its texel
// (h, s) of a column holds the sub-rows s of pixel rows 4 h to 4 h + 3.

struct Params {
    // Where the blocks' descriptions begin among the words; block k is the k-th of the target.
    blocks: u32,
    // Texels of the table.
    width: u32,
    height: u32,
    // Fixed point of whole texels; 32 but for tables of 64 bits.
    shift: u32,
}

// Weights at each end of a box, sub-pixels a pixel and axis, whether the table has 64 bits.
override REACH: u32 = 2u;
override SUB: u32 = 1u;
override WIDE: bool = false;

// Blocks side by side in the target, entries in each.
const SHELF = 64u;
const BLOCK = 32u;

// Words side by side in a texture of them.
const ROW = 2048u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var plan: texture_2d<u32>;
@group(0) @binding(2) var table: texture_2d_array<u32>;

fn words(at: u32) -> vec4<u32> {
    return textureLoad(plan, vec2<u32>(at % ROW, at / ROW), 0);
}

// Entries of four rows from y on.
fn four(x: u32, y: i32, layer: u32) -> vec4<u32> {
    let row = u32(clamp(y + 8, 0, i32(params.height) + 8));
    let a = textureLoad(table, vec2<u32>(x, row / 4u), layer, 0);
    let b = textureLoad(table, vec2<u32>(x, row / 4u + 1u), layer, 0);
    let odd = vec4<bool>((row & 1u) == 1u);
    let one = select(a, vec4<u32>(a.yzw, b.x), odd);
    let two = select(b, vec4<u32>(b.yzw, b.w), odd);
    return select(one, vec4<u32>(one.zw, two.xy), vec4<bool>((row & 2u) == 2u));
}

// sum + strip * weight modulo 2^64 (low word first); one row's texels are under 2^32, so the strip's low word is all of it.
fn weigh(sum: vec2<u32>, strip: u32, weight: u32) -> vec2<u32> {
    let a = vec2<u32>(strip & 0xffffu, strip >> 16u);
    let b = vec2<u32>(weight & 0xffffu, weight >> 16u);
    let across = vec2<u32>(a.x * b.y, a.y * b.x);
    let middle = ((a.x * b.x) >> 16u) + (across.x & 0xffffu) + (across.y & 0xffffu);
    let high = a.y * b.y + (across.x >> 16u) + (across.y >> 16u) + (middle >> 16u);
    let low = sum.x + strip * weight;
    return vec2<u32>(low, sum.y + high + u32(low < sum.x));
}

fn combined(column: u32, at: u32, cut: u32) -> u32 {
    var sum = vec2<u32>(0u);
    // Rows behind the first end, and from the second on.
    var top = vec2<i32>(0);
    var above = 0u;
    var below = 0u;
    for (var k = 0u; k < REACH; k += 3u) {
        let first = words(at + k / 3u * 2u);
        let second = words(at + k / 3u * 2u + 1u);
        let start = vec2<i32>(bitcast<i32>(first.x), bitcast<i32>(second.x));
        let a = four(column, start.x, 0u);
        let b = four(column, start.y, 0u);
        if k == 0u {
            top = vec2<i32>(start.x + i32(REACH), start.y);
            below = b.x;
        }
        sum = weigh(sum, a.y - a.x, first.y);
        sum = weigh(sum, b.y - b.x, second.y);
        above = a.y;
        if k + 1u < REACH {
            sum = weigh(sum, a.z - a.y, first.z);
            sum = weigh(sum, b.z - b.y, second.z);
            above = a.z;
        }
        if k + 2u < REACH {
            sum = weigh(sum, a.w - a.z, first.w);
            sum = weigh(sum, b.w - b.z, second.w);
            above = a.w;
        }
    }
    // The rows between both ends, whole.
    let low = below - above;
    if WIDE {
        let high = four(column, top.y, 1u).x - four(column, top.x, 1u).x - u32(below < above);
        let whole = vec2<u32>(low << params.shift, (high << params.shift) | (low >> (32u - params.shift)));
        let all = sum.x + whole.x;
        sum = vec2<u32>(all, sum.y + whole.y + u32(all < sum.x));
    } else {
        sum.y += low;
    }
    return select((sum.x >> cut) | (sum.y << (32u - cut)), sum.y, cut == 32u);
}

@vertex
fn cover(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn combine(@builtin(position) place: vec4<f32>) -> @location(0) vec4<u32> {
    let x = u32(place.x);
    let y = u32(place.y);
    let quads = 2u * SUB;
    // Its first texel, where its first row's windows are, its last row, the bits that are cut off.
    let block = words(params.blocks + y / quads * SHELF + x / BLOCK);
    let column = min(block.x + x % BLOCK, params.width);
    let row = y % quads / SUB * 4u * SUB + y % SUB;
    let each = (REACH + 2u) / 3u * 2u;
    let a = combined(column, block.y + min(row, block.z) * each, block.w);
    let b = combined(column, block.y + min(row + SUB, block.z) * each, block.w);
    let c = combined(column, block.y + min(row + 2u * SUB, block.z) * each, block.w);
    let d = combined(column, block.y + min(row + 3u * SUB, block.z) * each, block.w);
    return vec4<u32>(a, b, c, d);
}
