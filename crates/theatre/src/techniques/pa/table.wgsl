// A summed-area table of a mask's opacity codes: the sum over the texels left of x and above y, modulo 2^32 in layer 0; its high word in
// layer 1 where boxes need 64 bits.
//
// A texel holds four rows, one above the other, because a load costs the same whether it brings one word or four; rows 8 above and
// below the mask repeat its edge. One invocation a column, then one a row of texels, and no barriers: what a software adapter is good
// at, and wide enough for a real one.

struct Params {
    width: u32,
    height: u32,
    max_code: u32,
    // Rows of the target's texels.
    quads: u32,
}

override WIDE: bool = false;

@group(0) @binding(0) var<uniform> params: Params;
// Codes for `columns`, what `columns` wrote for `rows`.
@group(0) @binding(1) var source: texture_2d<u32>;
@group(0) @binding(2) var table: texture_storage_2d_array<rgba32uint, write>;

fn code(x: u32, y: i32) -> u32 {
    let row = u32(clamp(y, 0, i32(params.height) - 1));
    let opacity = params.max_code - textureLoad(source, vec2<u32>(x, row), 0).x;
    return select(0u, opacity, y >= 0 && y < i32(params.height));
}

// A column's own sum is under 2^32 for any mask.
@compute @workgroup_size(32)
fn columns(@builtin(global_invocation_id) id: vec3<u32>) {
    let x = id.x;
    if x >= params.width {
        return;
    }
    var sum = 0u;
    for (var q = 0u; q < params.quads; q++) {
        let y = i32(4u * q) - 8;
        let b = sum + code(x, y);
        let c = b + code(x, y + 1);
        let d = c + code(x, y + 2);
        textureStore(table, vec2<u32>(x, q), 0, vec4<u32>(sum, b, c, d));
        sum = d + code(x, y + 3);
    }
}

@compute @workgroup_size(32)
fn rows(@builtin(global_invocation_id) id: vec3<u32>) {
    let q = id.x;
    if q >= params.quads {
        return;
    }
    var low = vec4<u32>(0u);
    var high = vec4<u32>(0u);
    textureStore(table, vec2<u32>(0u, q), 0, low);
    if WIDE {
        textureStore(table, vec2<u32>(0u, q), 1, high);
    }
    for (var x = 0u; x < params.width; x++) {
        let before = low;
        low += textureLoad(source, vec2<u32>(x, q), 0);
        textureStore(table, vec2<u32>(x + 1u, q), 0, low);
        if WIDE {
            high += vec4<u32>(low < before);
            textureStore(table, vec2<u32>(x + 1u, q), 1, high);
        }
    }
}
