// The sampler of native.rs: one invocation is one replicate of one job, a job is one pixel's and one emitter's estimate.

struct Params {
    width: u32,
    height: u32,
    // Points per replicate.
    samples: u32,
    jobs: u32,
    planes: u32,
    seed: u32,
    // 1 where points also spread over the pixel.
    area: u32,
    // 1 or 3.
    channels: u32,
    // 0 for points that stand still.
    scrambled: u32,
    // Shifts of the points that the tables hold.
    variants: u32,
}

struct Job {
    x: u32,
    y: u32,
    emitter: u32,
    // Planes first..end.
    first: u32,
    end: u32,
    v0_r: f32,
    v0_g: f32,
    v0_b: f32,
}

// Texel = anchor + floor(offset + emitter * u + pixel * v), clamped to the clear border.
struct Axis {
    offset: f32,
    low: f32,
    high: f32,
    anchor: i32,
    // The box's middle relative to the anchor as the tables count.
    middle: i32,
}

struct Emitter {
    side_x: f32,
    side_y: f32,
    pixel_x: f32,
    pixel_y: f32,
    // 0 rectangle, 1 disk, 2 dome.
    shape: u32,
    // Its tables' first word behind the points', or NONE.
    table: u32,
}

// The texels that one plane shows of one emitter (planes of an emitter follow each other).
struct Map {
    emitter_x: f32,
    emitter_y: f32,
    pixel_x: f32,
    pixel_y: f32,
    // First layer of the plane's mask, and how many it has.
    layer: u32,
    channels: u32,
    // 1: a perspective map with the job's own numbers in `seen`.
    tilted: u32,
    // 0 for the dome, whose directions do not depend on the place in the pixel.
    behind: f32,
    right_x: f32,
    right_y: f32,
    down_x: f32,
    down_y: f32,
    normal_x: f32,
    normal_y: f32,
    // What a code counts, as in bounds.rs.
    unit: f32,
    // Bits of a table's texel.
    shift_x: u32,
    shift_y: u32,
}

// What one job adds to a tilted plane, as in tilted.rs.
struct Seen {
    x: Axis,
    y: Axis,
    ratio: f32,
    rest: f32,
    depth: f32,
    along_x: f32,
    along_y: f32,
}

const REPLICATES = 16u;
const NONE = 4294967295u;
// Sums of this many terms are added to sums of sums, so that rounding stays small however many points there are.
const FLUSH = 32u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> jobs: array<Job>;
// Four times `samples * REPLICATES` words; behind them the tables of tables.rs, subset by subset, x then y, variant by variant.
@group(0) @binding(2) var<storage, read> points: array<u32>;
@group(0) @binding(3) var<storage, read> emitters: array<Emitter>;
@group(0) @binding(4) var<storage, read> maps: array<Map>;
// For each map its columns, then its rows.
@group(0) @binding(5) var<storage, read> axes: array<Axis>;
// For each emitter: tangents of the columns, then of the rows.
@group(0) @binding(6) var<storage, read> tangents: array<f32>;
@group(0) @binding(7) var masks: texture_2d_array<u32>;
@group(0) @binding(8) var<storage, read_write> sums: array<f32>;
// job * planes + plane; empty where no plane is tilted.
@group(0) @binding(9) var<storage, read> seen_by: array<Seen>;

fn hash(word: u32) -> u32 {
    var x = word;
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    return x ^ (x >> 16u);
}

fn shift(key: u32, dimension: u32, replicate: u32) -> u32 {
    return hash(key + (dimension * REPLICATES + replicate) * 0x9e3779b9u) * params.scrambled;
}

fn unit(word: u32) -> f32 {
    return f32(bitcast<i32>(word) >> 8u) * (1.0 / 16777216.0);
}

fn texel(axis: Axis, t: f32) -> i32 {
    return i32(floor(clamp(t, axis.low, axis.high))) + axis.anchor;
}

// Axis and place as whole numbers; see tables.rs.
fn tabled_texel(axis: Axis, place: i32, shift: u32) -> i32 {
    return clamp((axis.middle + place) >> shift, i32(axis.low), i32(axis.high)) + axis.anchor;
}

fn tilted_texels(map: Map, seen: Seen, u: vec2<f32>, v: vec2<f32>) -> vec2<i32> {
    // y runs downwards on source and pixel, upwards in space.
    let q = vec2<f32>(map.emitter_x * u.x, -(map.emitter_y * u.y));
    let p = vec2<f32>(map.pixel_x * v.x, -(map.pixel_y * v.y));
    let m = p + seen.ratio * (q - p);
    let w = q - map.behind * p;
    let normal = vec2<f32>(map.normal_x, map.normal_y);
    let right = vec2<f32>(map.right_x, map.right_y);
    let down = vec2<f32>(map.down_x, map.down_y);
    let step = (seen.rest - dot(normal, m)) / (seen.depth + dot(normal, w));
    return vec2<i32>(
        texel(seen.x, seen.x.offset + (dot(right, m) + step * (seen.along_x + dot(right, w)))),
        texel(seen.y, seen.y.offset + (dot(down, m) + step * (seen.along_y + dot(down, w)))),
    );
}

fn disk(u: vec2<f32>) -> vec2<f32> {
    let steep = abs(u.y) > abs(u.x);
    let long = select(u.x, u.y, steep);
    let short = select(u.y, u.x, steep);
    let t = select(short / long, 0.0, long == 0.0);
    let z = t * t;
    let sin = t * (0.78539816 + z * (-0.08074551 + z * (0.0024903946 + z * (-3.6576204e-5 + z * 3.1336169e-7))));
    let cos = 1.0 + z * (-0.30842514 + z * (0.015854344 + z * (-3.2599189e-4 + z * (3.5908604e-6 - z * 2.461137e-8))));
    return select(vec2<f32>(long * cos, long * sin), vec2<f32>(long * sin, long * cos), steep);
}

fn directions(u: vec2<f32>) -> vec2<f32> {
    return u * (2.0 / sqrt(max(1.0 - 4.0 * (u.x * u.x + u.y * u.y), 1e-12)));
}

@compute @workgroup_size(64)
fn sample(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let thread = id.y * groups.x * 64u + id.x;
    let index = thread / REPLICATES;
    let replicate = thread % REPLICATES;
    if index >= params.jobs {
        return;
    }
    let job = jobs[index];
    let v0 = vec3<f32>(job.v0_r, job.v0_g, job.v0_b);
    let emitter = emitters[job.emitter];
    let key = hash(hash(params.seed ^ hash(job.y * params.width + job.x)) + job.emitter);
    let shifts = vec4<u32>(
        shift(key, 0u, replicate),
        shift(key, 1u, replicate),
        shift(key, 2u, replicate),
        shift(key, 3u, replicate),
    );
    let lines = params.width + params.height;
    let tangent = vec2<f32>(
        tangents[job.emitter * lines + job.x],
        tangents[job.emitter * lines + params.width + job.y],
    );
    let table = params.samples * REPLICATES;
    let coloured = params.channels == 3u;
    // Where the pixel's own x and y begin in the tables.
    let tabled = emitter.table != NONE;
    let count = job.end - job.first;
    var sides = vec2<u32>(emitter.table);
    if tabled {
        if count != params.planes {
            sides += 2u * params.variants * table * (params.planes + 1u + 2u * job.first);
        }
        let mask = params.variants - 1u;
        sides += vec2<u32>(key & mask, params.variants + ((key >> 16u) & mask)) * (count + 1u) * table;
    }
    var total = vec3<f32>(0.0);
    var part = vec3<f32>(0.0);
    for (var s = 0u; s < params.samples; s++) {
        let at = s * REPLICATES + replicate;
        var u = vec2<f32>(0.0);
        var v = vec2<f32>(0.0);
        if !tabled {
            u = vec2<f32>(unit(points[at] ^ shifts.x), unit(points[table + at] ^ shifts.y));
        }
        if !tabled && params.area == 1u {
            v = vec2<f32>(
                unit(points[2u * table + at] ^ shifts.z),
                unit(points[3u * table + at] ^ shifts.w),
            );
        }
        if emitter.shape >= 1u {
            u = disk(u);
        }
        if emitter.shape == 2u {
            u = directions(u);
        }
        var seen = vec3<f32>(1.0);
        for (var p = job.first; p < job.end; p++) {
            let m = job.emitter * params.planes + p;
            let map = maps[m];
            var texels: vec2<i32>;
            if tabled {
                let place = sides + (p - job.first) * table + at;
                let x = axes[m * lines + job.x];
                let y = axes[m * lines + params.width + job.y];
                texels = vec2<i32>(
                    tabled_texel(x, bitcast<i32>(points[place.x]), map.shift_x),
                    tabled_texel(y, bitcast<i32>(points[place.y]), map.shift_y),
                );
            } else if map.tilted == 1u {
                texels = tilted_texels(map, seen_by[index * params.planes + p], u, v);
            } else {
                let x = axes[m * lines + job.x];
                let y = axes[m * lines + params.width + job.y];
                texels = vec2<i32>(
                    texel(x, x.offset + map.emitter_x * u.x + map.pixel_x * v.x),
                    texel(y, y.offset + map.emitter_y * u.y + map.pixel_y * v.y),
                );
            }
            let first = f32(textureLoad(masks, texels, map.layer, 0).x) * map.unit;
            if coloured {
                let green = select(0u, 1u, map.channels == 3u);
                seen *= vec3<f32>(
                    first,
                    f32(textureLoad(masks, texels, map.layer + green, 0).x) * map.unit,
                    f32(textureLoad(masks, texels, map.layer + 2u * green, 0).x) * map.unit,
                );
            } else {
                seen.x *= first;
            }
        }
        var x = tangent.x - emitter.side_x * u.x + emitter.pixel_x * v.x;
        var y = tangent.y - emitter.side_y * u.y + emitter.pixel_y * v.y;
        if tabled {
            let place = sides + count * table + at;
            x = tangent.x - bitcast<f32>(points[place.x]);
            y = tangent.y - bitcast<f32>(points[place.y]);
        }
        let w = 1.0 + (x * x + y * y);
        // The dome's sides and tangents are zero: its weight is 1.
        part += (seen - v0) * (1.0 / (w * w));
        if (s & (FLUSH - 1u)) == FLUSH - 1u {
            total += part;
            part = vec3<f32>(0.0);
        }
    }
    total += part;
    let out = index * params.channels * REPLICATES + replicate;
    sums[out] = total.x;
    if coloured {
        sums[out + REPLICATES] = total.y;
        sums[out + 2u * REPLICATES] = total.z;
    }
}
