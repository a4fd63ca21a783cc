// Visibilities mixed by the emitters' shares of the light, the ambient light added, and the colour written: display
// codes, or linear radiance followed by the visibilities.

struct Params {
    width: u32,
    rows: u32,
    channels: u32,
    emitters: u32,
    rest: u32,
    share_channels: u32,
    // 1 where the lit screen's three channels are equal, else 3.
    lit_channels: u32,
    planes: u32,
    // Channels of each plane's own shadow; 0 where one plane's distance is all.
    own_channels: u32,
    // 1: the paper's ambient light.
    paper: u32,
    // 1: sRGB codes; 0: radiance and visibilities.
    display: u32,
    // Exposure: 1 / white.
    scale: f32,
    k_d: f32,
    s_r: f32,
    s_g: f32,
    s_b: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> visibility: array<f32>;
@group(0) @binding(2) var<storage, read> weights: array<f32>;
@group(0) @binding(3) var<storage, read> lit: array<f32>;
@group(0) @binding(4) var<storage, read> share: array<f32>;
@group(0) @binding(5) var<storage, read> own: array<f32>;
// The encoder's bins, then the planes' distances as f32 bits.
@group(0) @binding(6) var<storage, read> tables: array<u32>;
@group(0) @binding(7) var<storage, read_write> out: array<u32>;

// As in encode.rs: 128 bins an octave from 2^-13, a step's place in the low half.
const LOWEST = 114u << 23u;
const BINS = 13u << 7u;

fn code(linear: f32) -> u32 {
    let bits = bitcast<u32>(clamp(linear, bitcast<f32>(LOWEST), bitcast<f32>(0x3f7fffffu)));
    return (tables[(bits - LOWEST) >> 16u] + (bits & 0xffffu)) >> 16u;
}

fn seen(e: u32, c: u32, pixel: u32, pixels: u32) -> f32 {
    let v = visibility[(e * params.channels + min(c, params.channels - 1u)) * pixels + pixel];
    return min(v / weights[e * pixels + pixel], 1.0);
}

fn distance_m(c: u32, pixel: u32, pixels: u32) -> f32 {
    if params.own_channels == 0u {
        return bitcast<f32>(tables[BINS]);
    }
    var sum = 0.0;
    var weight = 0.0;
    for (var p = 0u; p < params.planes; p++) {
        let o = own[(p * params.own_channels + min(c, params.own_channels - 1u)) * pixels + pixel];
        sum += bitcast<f32>(tables[BINS + p]) * o;
        weight += o;
    }
    return select(0.0, sum / weight, weight > 0.0);
}

@compute @workgroup_size(64)
fn shade(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.width {
        return;
    }
    let pixels = params.width * params.rows;
    let pixel = id.y * params.width + id.x;
    let s = vec3<f32>(params.s_r, params.s_g, params.s_b);
    var packed = 0xff000000u;
    for (var c = 0u; c < 3u; c++) {
        let rest = seen(params.rest, c, pixel, pixels);
        // Mixed relative to one emitter, so that all lit is exactly 1 and all dark exactly 0.
        var x = rest;
        for (var e = 0u; e < params.emitters; e++) {
            if e != params.rest {
                let at = (e * params.share_channels + min(c, params.share_channels - 1u)) * pixels + pixel;
                x += share[at] * (seen(e, c, pixel, pixels) - rest);
            }
        }
        if params.paper == 1u {
            x += (1.0 - x) * (min(distance_m(c, pixel, pixels) / params.k_d, 1.0) * s[c]);
        }
        let radiance = lit[min(c, params.lit_channels - 1u) * pixels + pixel] * x;
        if params.display == 1u {
            packed |= code(radiance * params.scale) << (8u * c);
        } else {
            out[c * pixels + pixel] = bitcast<u32>(radiance);
        }
    }
    if params.display == 1u {
        out[pixel] = packed;
    } else {
        for (var v = 0u; v < params.emitters * params.channels; v++) {
            let value = seen(v / params.channels, v % params.channels, pixel, pixels);
            out[(3u + v) * pixels + pixel] = bitcast<u32>(value);
        }
    }
}
