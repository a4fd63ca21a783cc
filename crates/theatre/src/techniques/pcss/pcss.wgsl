// Blocker search and filter of native.rs: one invocation is one job, a pixel's look at one map from one emitter. Integers
// only, so that it reads the very texels that the native code reads.

struct Params {
    jobs: u32,
    // 1 or 3.
    channels: u32,
    emitters: u32,
    search_samples: u32,
    filter_samples: u32,
}

struct Job {
    x: u32,
    y: u32,
    emitter: u32,
    beam: u32,
    pattern_: u32,
}

struct Beam {
    // First code of the map, two codes a word; planes of channels follow each other, then depths.
    codes: u32,
    // First depth code; 0xffffffff for an upright plane.
    depths: u32,
    stride: u32,
    // Codes a channel.
    plane: u32,
    channels: u32,
    max_code: u32,
    size: i32,
    bits: u32,
    pixel_x: i32,
    pixel_y: i32,
    // First column's and first row's centre.
    columns: u32,
    rows: u32,
}

// One a beam and emitter.
struct Penumbra {
    search_x: i32,
    search_y: i32,
    // First of the filter's sides, one a depth code.
    widths: u32,
    // First places of the emitter's patterns.
    search: u32,
    filter_: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> jobs: array<Job>;
@group(0) @binding(2) var<storage, read> beams: array<Beam>;
@group(0) @binding(3) var<storage, read> penumbrae: array<Penumbra>;
@group(0) @binding(4) var<storage, read> widths: array<vec2<i32>>;
@group(0) @binding(5) var<storage, read> centres: array<i32>;
@group(0) @binding(6) var<storage, read> places: array<vec4<i32>>;
@group(0) @binding(7) var<storage, read> codes: array<u32>;
@group(0) @binding(8) var<storage, read_write> sums: array<u32>;

// The high half of the signed product width * place, width >= 0.
fn scaled(width: i32, place: i32) -> i32 {
    let a = u32(width);
    let b = bitcast<u32>(place);
    let low = (a & 0xffffu) * (b & 0xffffu);
    let left = (a >> 16u) * (b & 0xffffu);
    let right = (a & 0xffffu) * (b >> 16u);
    let middle = (low >> 16u) + (left & 0xffffu) + (right & 0xffffu);
    let high = (a >> 16u) * (b >> 16u) + (left >> 16u) + (right >> 16u) + (middle >> 16u);
    return bitcast<i32>(high) - select(0, width, place < 0);
}

fn code(at: u32) -> u32 {
    return (codes[at >> 1u] >> ((at & 1u) * 16u)) & 0xffffu;
}

fn padded(beam: Beam, t: i32) -> u32 {
    return u32(clamp(t >> beam.bits, -1, beam.size) + 1);
}

fn texel(beam: Beam, centre: vec2<i32>, side: vec2<i32>, place: vec4<i32>) -> u32 {
    let x = centre.x + scaled(side.x, place.x) + scaled(beam.pixel_x, place.z);
    let y = centre.y + scaled(side.y, place.y) + scaled(beam.pixel_y, place.w);
    return padded(beam, y) * beam.stride + padded(beam, x);
}

@compute @workgroup_size(64)
fn filter_jobs(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= params.jobs {
        return;
    }
    let job = jobs[index];
    let beam = beams[job.beam];
    let penumbra = penumbrae[job.beam * params.emitters + job.emitter];
    let centre = vec2(centres[beam.columns + job.x], centres[beam.rows + job.y]);
    let upright = beam.depths == 0xffffffffu;
    let first = penumbra.search + job.pattern_ * params.search_samples;
    let reach = vec2(penumbra.search_x, penumbra.search_y);
    var blockers = 0u;
    var depth = 0u;
    for (var k = 0u; k < params.search_samples; k++) {
        let at = texel(beam, centre, reach, places[first + k]);
        var clear = true;
        for (var c = 0u; c < beam.channels; c++) {
            clear = clear && code(beam.codes + c * beam.plane + at) == beam.max_code;
        }
        if clear {
            continue;
        }
        blockers++;
        if upright {
            break;
        }
        depth += code(beam.depths + at);
    }
    var sum = array<u32, 3>(0u, 0u, 0u);
    if blockers == 0u {
        let lit = beam.max_code * params.filter_samples;
        sum = array<u32, 3>(lit, lit, lit);
    } else {
        let side = widths[penumbra.widths + (2u * depth + blockers) / (2u * blockers)];
        let first = penumbra.filter_ + job.pattern_ * params.filter_samples;
        for (var k = 0u; k < params.filter_samples; k++) {
            let at = texel(beam, centre, side, places[first + k]);
            for (var c = 0u; c < beam.channels; c++) {
                sum[c] += code(beam.codes + c * beam.plane + at);
            }
        }
    }
    for (var c = 0u; c < params.channels; c++) {
        sums[index * params.channels + c] = sum[min(c, beam.channels - 1u)];
    }
}
