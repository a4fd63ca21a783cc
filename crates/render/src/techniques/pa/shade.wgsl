// Visibilities mixed by the emitters' shares of the light, ambient light added, and the colour written: display codes, or one
// channel of linear radiance. Fragments are laid out as in visibility.wgsl.

struct Params {
    tiles: u32,
    stride: u32,
    count: u32,
    right: u32,
    bottom: u32,
    // The channel of `radiance`.
    channel: u32,
    // Among the words: the planes' distances, one a word vector, as f32 bits; for the dome, see `dome`.
    distances: u32,
    columns: u32,
    rows: u32,
    // Exposure: 1 / white.
    scale: f32,
    k_d: f32,
    unused: f32,
    s: vec4<f32>,
    dome: vec4<f32>,
}

override EMITTERS: u32 = 2u;
override REST: u32 = 1u;
// Channels of the visibilities, of the lit screen, of the shares of light, of each plane's own shadow (0: one plane's distance is all).
override CHANNELS: u32 = 1u;
override LIT_CHANNELS: u32 = 1u;
override SHARE_CHANNELS: u32 = 1u;
override OWN_CHANNELS: u32 = 0u;
override PLANES: u32 = 1u;
// Whether all three channels are one.
override GREY: bool = false;
// The paper's ambient light.
override PAPER: bool = false;

const ACROSS = 64u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var plan: texture_2d<u32>;
// Layer emitter * CHANNELS + c.
@group(0) @binding(2) var visibility: texture_2d_array<u32>;
// Layer plane * OWN_CHANNELS + c.
@group(0) @binding(3) var own: texture_2d_array<u32>;
// The lit screen's channels, then the shares of every emitter but REST, channel by channel.
@group(0) @binding(4) var lit: texture_2d_array<u32>;
// The encoder's bins.
@group(0) @binding(5) var bins: texture_2d<u32>;

// As in encode.rs: 128 bins an octave from 2^-13, a step's place in the low half.
const LOWEST = 114u << 23u;

fn words(at: u32) -> vec4<u32> {
    return textureLoad(plan, vec2<u32>(at % 2048u, at / 2048u), 0);
}

fn bin(k: u32) -> u32 {
    return textureLoad(bins, vec2<u32>(k, 0u), 0).x;
}

fn code(linear: vec4<f32>) -> vec4<u32> {
    let bits = bitcast<vec4<u32>>(clamp(linear, vec4<f32>(bitcast<f32>(LOWEST)), vec4<f32>(bitcast<f32>(0x3f7fffffu))));
    let at = (bits - LOWEST) >> vec4<u32>(16u);
    let step = vec4<u32>(bin(at.x), bin(at.y), bin(at.z), bin(at.w));
    return (step + (bits & vec4<u32>(0xffffu))) >> vec4<u32>(16u);
}

// Four pixels of a plane that is as large as the image.
fn pixels(layer: u32, x: u32, y: u32) -> vec4<f32> {
    let a = textureLoad(lit, vec2<u32>(x, min(y, params.bottom)), layer, 0).x;
    let b = textureLoad(lit, vec2<u32>(x, min(y + 1u, params.bottom)), layer, 0).x;
    let c = textureLoad(lit, vec2<u32>(x, min(y + 2u, params.bottom)), layer, 0).x;
    let d = textureLoad(lit, vec2<u32>(x, min(y + 3u, params.bottom)), layer, 0).x;
    return bitcast<vec4<f32>>(vec4<u32>(a, b, c, d));
}

fn seen(emitter: u32, c: u32, place: vec2<u32>) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(visibility, place, emitter * CHANNELS + min(c, CHANNELS - 1u), 0));
}

fn distance_m(c: u32, place: vec2<u32>) -> vec4<f32> {
    if OWN_CHANNELS == 0u {
        return vec4<f32>(bitcast<f32>(words(params.distances).x));
    }
    var sum = vec4<f32>(0.0);
    var weight = vec4<f32>(0.0);
    for (var p = 0u; p < PLANES; p++) {
        let shadow = bitcast<vec4<f32>>(textureLoad(own, place, p * OWN_CHANNELS + min(c, OWN_CHANNELS - 1u), 0));
        sum += bitcast<f32>(words(params.distances + p).x) * shadow;
        weight += shadow;
    }
    return select(vec4<f32>(0.0), sum / weight, weight > vec4<f32>(0.0));
}

// Linear radiance of four pixels in channel c.
fn light(c: u32, place: vec2<u32>, x: u32, y: u32) -> vec4<f32> {
    let rest = seen(REST, c, place);
    // Mixed relative to one emitter, so that all lit is exactly 1 and all dark exactly 0.
    var factor = rest;
    for (var e = 0u; e < EMITTERS; e++) {
        if e != REST {
            let layer = LIT_CHANNELS + (e - u32(e > REST)) * SHARE_CHANNELS + min(c, SHARE_CHANNELS - 1u);
            factor += pixels(layer, x, y) * (seen(e, c, place) - rest);
        }
    }
    if PAPER {
        factor += (1.0 - factor) * (min(distance_m(c, place) / params.k_d, vec4<f32>(1.0)) * params.s[c]);
    }
    return pixels(min(c, LIT_CHANNELS - 1u), x, y) * factor;
}

@vertex
fn cover(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(k & 1u) * 4.0 - 1.0, f32(k >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The image's column and first of four rows.
fn pixel(place: vec2<u32>) -> vec2<u32> {
    let tile = min(place.y / 2u * ACROSS + place.x / 32u, params.count - 1u);
    let home = words(params.tiles + params.stride * tile);
    return vec2<u32>(min(home.x + place.x % 32u, params.right), home.y + place.y % 2u * 4u);
}

@fragment
fn codes(@builtin(position) at: vec4<f32>) -> @location(0) vec4<u32> {
    let place = vec2<u32>(at.xy);
    let home = pixel(place);
    if GREY {
        return vec4<u32>(0xff000000u) | (code(light(0u, place, home.x, home.y) * params.scale) * 0x010101u);
    }
    var packed = vec4<u32>(0xff000000u);
    for (var c = 0u; c < 3u; c++) {
        packed |= code(light(c, place, home.x, home.y) * params.scale) << vec4<u32>(8u * c);
    }
    return packed;
}

@fragment
fn radiance(@builtin(position) at: vec4<f32>) -> @location(0) vec4<u32> {
    let place = vec2<u32>(at.xy);
    let home = pixel(place);
    return bitcast<vec4<u32>>(light(params.channel, place, home.x, home.y));
}
