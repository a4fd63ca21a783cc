// A summed-area table of a mask's opacity codes: entry (x, y) is the sum over the texels left of x and above y, modulo 2^32
// (or 2^64, low word first, where the target is rg32uint).
//
// One invocation a column, then one a row, and no barriers: what a software adapter is good at, and wide enough for a real one.

struct Params {
    width: u32,
    height: u32,
    max_code: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Codes for `columns`, what `columns` wrote for `rows`.
@group(0) @binding(1) var source: texture_2d<u32>;
@group(0) @binding(2) var table: texture_storage_2d<r32uint, write>;

// A column's own sum is under 2^32 for any mask.
@compute @workgroup_size(32)
fn columns(@builtin(global_invocation_id) id: vec3<u32>) {
    let x = id.x;
    if x >= params.width {
        return;
    }
    var sum = 0u;
    textureStore(table, vec2<u32>(x, 0u), vec4<u32>(0u));
    for (var y = 0u; y < params.height; y++) {
        sum += params.max_code - textureLoad(source, vec2<u32>(x, y), 0).x;
        textureStore(table, vec2<u32>(x, y + 1u), vec4<u32>(sum, 0u, 0u, 0u));
    }
}

@compute @workgroup_size(32)
fn rows(@builtin(global_invocation_id) id: vec3<u32>) {
    let y = id.x;
    if y > params.height {
        return;
    }
    var low = 0u;
    var high = 0u;
    textureStore(table, vec2<u32>(0u, y), vec4<u32>(0u));
    for (var x = 0u; x < params.width; x++) {
        let before = low;
        low += textureLoad(source, vec2<u32>(x, y), 0).x;
        high += u32(low < before);
        textureStore(table, vec2<u32>(x + 1u, y), vec4<u32>(low, high, 0u, 0u));
    }
}
