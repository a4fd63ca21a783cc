// Table rows combined once for each image row: the mean opacity code over the row's box, summed along x in fixed point.
//
// Sums wrap around: only differences over a box count, and the scale keeps every box under 2^32.

struct Params {
    // Image rows (of sub-pixels) to combine: first..first + rows.
    first: u32,
    rows: u32,
    // Texel columns from..to.
    from_x: u32,
    to_x: u32,
    height: u32,
    // Weights an end of a box.
    reach: u32,
    // Where this plane's row windows are: starts, seconds, then 2 * reach weights, `count` each.
    windows: u32,
    count: u32,
    // Where the sums go; to_x - from_x + 1 a row.
    sums: u32,
    // Weight of the rows between both ends.
    interior: f32,
    // Fixed-point units a code.
    scale: f32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var table: texture_2d<u32>;
@group(0) @binding(2) var<storage, read> windows: array<u32>;
@group(0) @binding(3) var<storage, read_write> sums: array<u32>;

fn above(x: u32, y: i32) -> u32 {
    return textureLoad(table, vec2<u32>(x, u32(clamp(y, 0, i32(params.height)))), 0).x;
}

@compute @workgroup_size(8)
fn combine(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.rows {
        return;
    }
    let at = params.windows + params.first + id.x;
    let count = params.count;
    let reach = i32(params.reach);
    let first = bitcast<i32>(windows[at]);
    let second = bitcast<i32>(windows[at + count]);
    let weights = at + 2u * count;
    var out = params.sums + id.x * (params.to_x - params.from_x + 1u);
    var sum = 0u;
    sums[out] = 0u;
    for (var x = params.from_x; x < params.to_x; x++) {
        var mean = 0.0;
        var before = above(x, first);
        for (var k = 0; k < reach; k++) {
            let next = above(x, first + k + 1);
            mean += bitcast<f32>(windows[weights + u32(k) * count]) * f32(next - before);
            before = next;
        }
        let middle = above(x, second);
        mean += params.interior * f32(middle - before);
        before = middle;
        for (var k = 0; k < reach; k++) {
            let next = above(x, second + k + 1);
            mean += bitcast<f32>(windows[weights + u32(k + reach) * count]) * f32(next - before);
            before = next;
        }
        sum += u32(mean * params.scale + 0.5);
        out += 1u;
        sums[out] = sum;
    }
}
