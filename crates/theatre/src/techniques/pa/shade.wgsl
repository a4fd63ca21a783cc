// Visibilities mixed by the emitters' shares of the light, ambient light added, and the colour written: display codes, or one
// channel of linear radiance. Fragments are laid out as in visibility.wgsl.

struct Params {
    tiles: u32,
    stride: u32,
    count: u32,
    // The image's last column and row.
    right: u32,
    bottom: u32,
    // The channel of `radiance`.
    channel: u32,
    // Among the words: the planes' distances, one a vector, as f32 bits; four vectors a plane that hides the dome.
    distances: u32,
    domes: u32,
    // Exposure: 1 / white.
    scale: f32,
    k_d: f32,
    unused_x: u32,
    unused_y: u32,
    s: vec4<f32>,
    // The dome's radiance, times the albedo where that is one colour.
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
// The paper's ambient light; planes that hide the dome, if there is one; whether the albedo is an image, then the last layers of `lit`.
override PAPER: bool = false;
override DOME: bool = false;
override DOME_PLANES: u32 = 0u;
override ALBEDO: bool = false;

const ACROSS = 64u;

// Words side by side in a texture of them.
const ROW = 2048u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var plan: texture_2d<u32>;
// Layer emitter * CHANNELS + c.
@group(0) @binding(2) var visibility: texture_2d_array<u32>;
// Layer plane * OWN_CHANNELS + c.
@group(0) @binding(3) var own: texture_2d_array<u32>;
// The lit screen's channels, then the shares of every emitter but REST, channel by channel; four rows a texel.
@group(0) @binding(4) var lit: texture_2d_array<u32>;
// The encoder's bins.
@group(0) @binding(5) var bins: texture_2d<u32>;
// The dome's maps, one after the other.
@group(0) @binding(6) var maps: texture_2d<u32>;

// As in encode.rs: 128 bins an octave from 2^-13, a step's place in the low half.
const LOWEST = 114u << 23u;

fn words(at: u32) -> vec4<u32> {
    return textureLoad(plan, vec2<u32>(at % ROW, at / ROW), 0);
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
    return bitcast<vec4<f32>>(textureLoad(lit, vec2<u32>(x, y / 4u), layer, 0));
}

fn lattice(at: u32) -> f32 {
    return bitcast<f32>(textureLoad(maps, vec2<u32>(at % ROW, at / ROW), 0).x);
}

// What a plane hides of the dome at one pixel: a cubic between lattice points. `columns` and `rows` say where the windows are, four
// weights and the first point of each pixel; `map` where the map is and how wide.
fn hidden(columns: u32, rows: u32, map: vec2<u32>) -> f32 {
    let across = bitcast<vec4<f32>>(words(columns));
    let down = bitcast<vec4<f32>>(words(rows));
    var at = map.x + words(rows + 1u).x * map.y + words(columns + 1u).x;
    var sum = 0.0;
    for (var k = 0; k < 4; k++) {
        let row = vec4<f32>(lattice(at), lattice(at + 1u), lattice(at + 2u), lattice(at + 3u));
        sum += down[k] * dot(across, row);
        at += map.y;
    }
    return clamp(sum, 0.0, 1.0);
}

// The dome's light in channel c at four pixels.
fn dome(c: u32, x: u32, y: u32) -> vec4<f32> {
    var light = vec4<f32>(params.dome[c]);
    for (var p = 0u; p < DOME_PLANES; p++) {
        // Windows of columns and rows, channels; then a map each.
        let plane = words(params.domes + 4u * p);
        let map = words(params.domes + 4u * p + 1u + min(c, plane.z - 1u)).xy;
        let columns = plane.x + 2u * x;
        let a = hidden(columns, plane.y + 2u * min(y, params.bottom), map);
        let b = hidden(columns, plane.y + 2u * min(y + 1u, params.bottom), map);
        let c = hidden(columns, plane.y + 2u * min(y + 2u, params.bottom), map);
        let d = hidden(columns, plane.y + 2u * min(y + 3u, params.bottom), map);
        light *= 1.0 - vec4<f32>(a, b, c, d);
    }
    if ALBEDO {
        light *= pixels(LIT_CHANNELS + (EMITTERS - 1u) * SHARE_CHANNELS + c, x, y);
    }
    return light;
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
    let lamp = pixels(min(c, LIT_CHANNELS - 1u), x, y) * factor;
    if DOME {
        return lamp + dome(c, x, y);
    }
    return lamp;
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
