// One piece of one emitter: the product over the planes of each box's transmittance, added to the emitter's visibility.

struct Params {
    width: u32,
    rows: u32,
    // Image row of the band's first row.
    first: u32,
    // Sub-pixels a pixel and axis.
    sub: u32,
    // Planes that the piece sees: `lookups[start..end]`.
    start: u32,
    end: u32,
    // 1 or 3 channels of visibility.
    channels: u32,
    emitter: u32,
    emitters: u32,
    // The last emitter that shines: its share is what the others leave.
    rest: u32,
    share_channels: u32,
    // Channels of each plane's own shadow; 0 where nobody asks for it.
    own_channels: u32,
    // 1 where pieces weigh by their own irradiance.
    by_irradiance: u32,
    // 1 for an emitter's first piece.
    is_first: u32,
    // Pixel pitch and the piece over the lamp's distance: tangents of the first column and row, and half-sides.
    step_x: f32,
    step_y: f32,
    origin_x: f32,
    origin_y: f32,
    half_x: f32,
    half_y: f32,
}

struct Lookup {
    // Where its column windows are, how many, and weights an end.
    windows: u32,
    count: u32,
    reach: u32,
    // Where its sums are, and the words from one channel to the next (0 for a grey mask).
    sums: u32,
    channel: u32,
    from_x: u32,
    to_x: u32,
    // Index among the planes on the beam.
    plane: u32,
    // Weight of the columns between both ends.
    interior: f32,
    // From fixed point to opacity.
    norm: f32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> lookups: array<Lookup>;
@group(0) @binding(2) var<storage, read> windows: array<u32>;
@group(0) @binding(3) var<storage, read> sums: array<u32>;
// (emitter * channels + c) * pixels + pixel, sums of weight * product.
@group(0) @binding(4) var<storage, read_write> visibility: array<f32>;
// emitter * pixels + pixel, sums of weights.
@group(0) @binding(5) var<storage, read_write> weights: array<f32>;
// (emitter * share_channels + c) * pixels + pixel.
@group(0) @binding(6) var<storage, read> share: array<f32>;
// (plane * own_channels + c) * pixels + pixel, sums of share * opacity * weight.
@group(0) @binding(7) var<storage, read_write> own: array<f32>;

fn opacity(l: Lookup, row: u32, column: u32, c: u32) -> f32 {
    let base = l.sums + c * l.channel + row * (l.to_x - l.from_x + 1u) - l.from_x;
    let low = i32(l.from_x);
    let high = i32(l.to_x);
    let reach = i32(l.reach);
    let at = l.windows + column;
    let first = bitcast<i32>(windows[at]);
    let second = bitcast<i32>(windows[at + l.count]);
    var before = sums[base + u32(clamp(first, low, high))];
    // Nothing opaque in sight: every difference below would be zero.
    if sums[base + u32(clamp(second + reach, low, high))] == before {
        return 0.0;
    }
    var mean = 0.0;
    var weight = at + 2u * l.count;
    for (var k = 1; k <= reach; k++) {
        let next = sums[base + u32(clamp(first + k, low, high))];
        mean += bitcast<f32>(windows[weight]) * f32(next - before);
        before = next;
        weight += l.count;
    }
    let middle = sums[base + u32(clamp(second, low, high))];
    mean += l.interior * f32(middle - before);
    before = middle;
    for (var k = 1; k <= reach; k++) {
        let next = sums[base + u32(clamp(second + k, low, high))];
        mean += bitcast<f32>(windows[weight]) * f32(next - before);
        before = next;
        weight += l.count;
    }
    return min(mean * l.norm, 1.0);
}

// Mean over the piece of 1 / (1 + tan^2)^2, which is its irradiance over area / distance^2, by a 4 x 4 Gauss rule.
fn irradiance(x: f32, y: f32) -> f32 {
    let nodes = vec4<f32>(-0.8611363116, -0.3399810436, 0.3399810436, 0.8611363116);
    let shares = vec4<f32>(0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226);
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        let dx = x + nodes[i] * params.half_x;
        for (var j = 0; j < 4; j++) {
            let dy = y + nodes[j] * params.half_y;
            let w = 1.0 + (dx * dx + dy * dy);
            sum += shares[i] * shares[j] / (w * w);
        }
    }
    return sum;
}

fn share_of(c: u32, pixel: u32, pixels: u32) -> f32 {
    if params.emitter != params.rest {
        return share[(params.emitter * params.share_channels + c) * pixels + pixel];
    }
    var others = 0.0;
    for (var e = 0u; e < params.emitters; e++) {
        if e != params.rest {
            others += share[(e * params.share_channels + c) * pixels + pixel];
        }
    }
    return 1.0 - others;
}

@compute @workgroup_size(64)
fn add(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.width {
        return;
    }
    let pixels = params.width * params.rows;
    let pixel = id.y * params.width + id.x;
    var weight = 1.0;
    if params.by_irradiance == 1u {
        let x = params.origin_x + f32(id.x) * params.step_x;
        let y = params.origin_y + f32(params.first + id.y) * params.step_y;
        weight = irradiance(x, y);
    }
    let is_first = params.is_first == 1u;
    let w = params.emitter * pixels + pixel;
    weights[w] = select(weights[w], 0.0, is_first) + weight;
    let sub = params.sub;
    let per = 1.0 / f32(sub * sub);
    for (var c = 0u; c < params.channels; c++) {
        var sum = 0.0;
        for (var s = 0u; s < sub * sub; s++) {
            var product = 1.0;
            for (var l = params.start; l < params.end; l++) {
                let lookup = lookups[l];
                let shade = opacity(lookup, id.y * sub + s / sub, id.x * sub + s % sub, c);
                product *= 1.0 - shade;
                // A grey scene's only channel answers for all of the shares' channels.
                for (var o = 0u; o < params.own_channels; o++) {
                    if params.channels == 1u || o == c {
                        let part = share_of(min(o, params.share_channels - 1u), pixel, pixels) * shade * weight;
                        own[(lookup.plane * params.own_channels + o) * pixels + pixel] += part;
                    }
                }
            }
            sum += product;
        }
        let v = (params.emitter * params.channels + c) * pixels + pixel;
        visibility[v] = select(visibility[v], 0.0, is_first) + weight * (sum * per);
    }
}
