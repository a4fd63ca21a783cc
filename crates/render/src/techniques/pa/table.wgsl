// Column sums of a mask's opacity codes: entry (x, y) is the sum over the texels of column x above row y.
// One invocation a column and no barriers: what a software adapter is good at, and wide enough for a real one.

struct Params {
    width: u32,
    height: u32,
    max_code: u32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var mask: texture_2d<u32>;
@group(0) @binding(2) var table: texture_storage_2d<r32uint, write>;

@compute @workgroup_size(64)
fn build(@builtin(global_invocation_id) id: vec3<u32>) {
    let x = id.x;
    if x >= params.width {
        return;
    }
    var sum = 0u;
    textureStore(table, vec2<u32>(x, 0u), vec4<u32>(0u));
    for (var y = 0u; y < params.height; y++) {
        sum += params.max_code - textureLoad(mask, vec2<u32>(x, y), 0).x;
        textureStore(table, vec2<u32>(x, y + 1u), vec4<u32>(sum));
    }
}
