//! Light from a uniform dome backstage, which the puppets block.
//!
//! A plane at distance d takes E_a / (π L_a) = mean of its opacity under k(ρ) = d² / (π (d² + ρ²)²), wherever the point is: a
//! convolution, made once per mask and distance by FFT and kept while the puppet only moves sideways. Several planes multiply, as PA does.
//!
//! The kernel is smooth over about d, so opacity is put on a lattice of step d / steps (the knob `dome_steps`): each texel's area shared among its four
//! neighbours (which keeps its centre of mass, so the error is of second order in 1 / steps), or, where texels are larger than the step,
//! texels cut into lattice cells, each with the kernel's exact integral over a cell. Between lattice points the map is interpolated
//! by cubics.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec2;
use kelir_scene::{Mask, Plane, Theatre};
use rayon::prelude::*;
use rustfft::{FftPlanner, num_complex::Complex};

use crate::irradiance::lambert;

/// Most lattice points a side; very near planes have coarser lattices than d / steps.
const MOST: usize = 2048;

/// One plane's blocking of the dome, in one channel, on a lattice around the plane's centre.
#[derive(Debug)]
pub(super) struct DomeMap {
    mask: Arc<Mask>,
    channel: usize,
    distance_m: f64,
    size_m: [f64; 2],
    steps: u32,
    /// Lateral distance from the plane's centre that the lattice covers.
    covers_m: DVec2,
    /// Position of value (0, 0) relative to the plane's centre, metres, and the step; y runs downwards.
    origin_m: DVec2,
    step_m: DVec2,
    width: usize,
    values: Vec<f32>,
}

/// The dome as the screen sees it.
#[derive(Debug)]
pub(super) struct DomeLight<'a> {
    radiance: [f64; 3],
    /// Per plane: its centre and its map a channel.
    pub planes: Vec<(DVec2, Vec<&'a DomeMap>)>,
}

fn reach_m(theatre: &Theatre, plane: &Plane) -> DVec2 {
    0.5 * DVec2::new(theatre.screen.width_m, theatre.screen.height_m) + plane.centre_m.truncate().abs()
}

fn serves(map: &DomeMap, theatre: &Theatre, plane: &Plane, channel: usize, steps: u32) -> bool {
    map.mask.id == plane.mask.id
        && map.channel == channel
        && map.distance_m == -plane.centre_m.z
        && map.size_m == plane.size_m
        && map.steps == steps
        && map.covers_m.cmpge(reach_m(theatre, plane)).all()
}

/// Makes `maps` hold what the theatre's planes need, with `steps` lattice points per distance, and no other; returns how many were made.
pub(super) fn prepare(theatre: &Theatre, steps: u32, maps: &mut Vec<DomeMap>) -> u64 {
    let needed: Vec<(&Plane, usize)> =
        theatre.planes.iter().flat_map(|p| (0..p.mask.channels).map(move |c| (p, c))).collect();
    maps.retain(|map| needed.iter().any(|(p, c)| serves(map, theatre, p, *c, steps)));
    let mut built = 0;
    for (plane, channel) in needed {
        if !maps.iter().any(|map| serves(map, theatre, plane, channel, steps)) {
            maps.push(DomeMap::new(theatre, plane, channel, steps));
            built += 1;
        }
    }
    built
}

impl<'a> DomeLight<'a> {
    /// From maps that [`prepare`] made.
    pub(super) fn new(theatre: &Theatre, radiance: [f64; 3], steps: u32, maps: &'a [DomeMap]) -> Self {
        let of = |plane: &Plane| {
            let channels = (0..plane.mask.channels)
                .filter_map(|c| maps.iter().find(|map| serves(map, theatre, plane, c, steps)))
                .collect();
            (plane.centre_m.truncate(), channels)
        };
        Self { radiance, planes: theatre.planes.iter().map(of).collect() }
    }

    /// E_a / π of channel `c` at `p_m`: the radiance times what the planes leave of the dome.
    pub(super) fn radiance(&self, c: usize, p_m: DVec2) -> f32 {
        let through = |(centre, maps): &(DVec2, Vec<&DomeMap>)| match maps.get(c.min(maps.len().max(1) - 1)) {
            Some(map) => 1.0 - map.at(p_m - *centre),
            None => 1.0,
        };
        (self.radiance[c] * self.planes.iter().map(through).product::<f64>()) as f32
    }
}

impl DomeMap {
    fn new(theatre: &Theatre, plane: &Plane, channel: usize, steps: u32) -> Self {
        let distance_m = -plane.centre_m.z;
        let size = DVec2::from(plane.size_m);
        let grid = DVec2::new(plane.mask.width as f64, plane.mask.height as f64);
        let texel = size / grid;
        // Room to slide before the map has to be made again.
        let covers_m = reach_m(theatre, plane) + 0.25 * theatre.screen.width_m;
        let span = 2.0 * covers_m + size;
        let wanted = (distance_m / f64::from(steps)).max((span / (MOST as f64 - 8.0)).max_element());
        let cells = texel.max_element() > wanted;
        // Lattice points lie on cell centres of the mask when cells are exact, else on any lattice around its centre.
        let (step, lattice) = if cells {
            let per = (texel / wanted).floor().max(DVec2::ONE);
            (texel / per, grid * per)
        } else {
            (DVec2::splat(wanted), (size / wanted).ceil() + 2.0)
        };
        let [mw, mh] = [lattice.x as usize, lattice.y as usize];
        let deposit = if cells { cut(plane, channel, mw, mh) } else { share(plane, channel, step, mw, mh) };
        // Output points: the same lattice, going on beyond the mask.
        let beyond = ((covers_m + 3.0 * step) / step).ceil();
        let (bx, by) = (beyond.x as usize, beyond.y as usize);
        // Point (0, 0) of the deposit is at −(lattice − 1)/2 steps from the centre; outputs cover ± beyond steps around the centre.
        let half = DVec2::new((mw - 1) as f64, (mh - 1) as f64) * 0.5;
        let (ox, oy) = ((half.x - bx as f64).floor(), (half.y - by as f64).floor());
        let (width, height) = (2 * bx + 2, 2 * by + 2);
        let kernel = |i: f64, j: f64| {
            let at = DVec2::new(i, j) * step;
            if cells {
                lambert(at, 0.5 * step.x, 0.5 * step.y, distance_m) / PI
            } else {
                let d2 = distance_m * distance_m;
                d2 / (PI * (d2 + at.length_squared()).powi(2)) * step.x * step.y
            }
        };
        let values = convolve(&deposit, [mw, mh], [ox as i64, oy as i64], [width, height], &kernel);
        let origin_m = DVec2::new((ox - half.x) * step.x, -(oy - half.y) * step.y);
        Self {
            mask: plane.mask.clone(),
            channel,
            distance_m,
            size_m: plane.size_m,
            steps,
            covers_m,
            origin_m,
            step_m: step,
            width,
            values,
        }
    }

    /// The lattice's values, row by row, and how many a row.
    pub(super) fn lattice(&self) -> (&[f32], usize) {
        (&self.values, self.width)
    }

    /// The first of four lattice columns and rows around an offset from the plane's centre, before any is clamped to the lattice,
    /// and their weights.
    pub(super) fn taps(&self, offset_m: DVec2) -> ([f64; 2], [[f64; 4]; 2]) {
        let t = (offset_m - self.origin_m) * DVec2::new(1.0, -1.0) / self.step_m;
        let first = t.floor();
        let weights = t - first;
        ([first.x - 1.0, first.y - 1.0], [cubic(weights.x), cubic(weights.y)])
    }

    /// Blocked share of the dome at an offset from the plane's centre, by cubic interpolation.
    fn at(&self, offset_m: DVec2) -> f64 {
        let ([i, j], [wx, wy]) = self.taps(offset_m);
        let height = self.values.len() / self.width;
        let clamp = |k: f64, n: usize| k.clamp(0.0, (n - 1) as f64) as usize;
        let mut sum = 0.0;
        for (dy, wy) in wy.iter().enumerate() {
            let row = &self.values[clamp(j + dy as f64, height) * self.width..];
            for (dx, wx) in wx.iter().enumerate() {
                sum += wx * wy * f64::from(row[clamp(i + dx as f64, self.width)]);
            }
        }
        sum.clamp(0.0, 1.0)
    }
}

/// Catmull–Rom weights of the four points around a fraction.
fn cubic(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [
        0.5 * (-t3 + 2.0 * t2 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (-3.0 * t3 + 4.0 * t2 + t),
        0.5 * (t3 - t2),
    ]
}

/// Texels cut into lattice cells: opacity of each cell.
fn cut(plane: &Plane, channel: usize, mw: usize, mh: usize) -> Vec<f64> {
    let mask = &plane.mask;
    let (px, py) = (mw / mask.width, mh / mask.height);
    (0..mw * mh).map(|k| 1.0 - mask.transmittance(channel, k % mw / px, k / mw / py)).collect()
}

/// Texels shared among the lattice points around their centres, in units of a lattice cell's area.
fn share(plane: &Plane, channel: usize, step: DVec2, mw: usize, mh: usize) -> Vec<f64> {
    let mask = &plane.mask;
    let texel = DVec2::from(plane.size_m) / DVec2::new(mask.width as f64, mask.height as f64);
    let area = texel.x * texel.y / (step.x * step.y);
    let mut out = vec![0.0; mw * mh];
    for y in 0..mask.height {
        let ty = ((y as f64 + 0.5) * texel.y - 0.5 * plane.size_m[1]) / step.y + 0.5 * (mh - 1) as f64;
        let (j, fy) = (ty.floor() as usize, ty - ty.floor());
        for x in 0..mask.width {
            let opacity = (1.0 - mask.transmittance(channel, x, y)) * area;
            if opacity == 0.0 {
                continue;
            }
            let tx = ((x as f64 + 0.5) * texel.x - 0.5 * plane.size_m[0]) / step.x + 0.5 * (mw - 1) as f64;
            let (i, fx) = (tx.floor() as usize, tx - tx.floor());
            out[j * mw + i] += opacity * (1.0 - fx) * (1.0 - fy);
            out[j * mw + i + 1] += opacity * fx * (1.0 - fy);
            out[(j + 1) * mw + i] += opacity * (1.0 - fx) * fy;
            out[(j + 1) * mw + i + 1] += opacity * fx * fy;
        }
    }
    out
}

/// Σ deposit(m) · kernel(first + o − m) at outputs o of `size`, in lattice steps, by FFT without wrap-around.
fn convolve(
    deposit: &[f64],
    [mw, mh]: [usize; 2],
    [ox, oy]: [i64; 2],
    [width, height]: [usize; 2],
    kernel: &(dyn Fn(f64, f64) -> f64 + Sync),
) -> Vec<f32> {
    let fast = |n: usize| {
        (n..)
            .find(|n| {
                [2, 3, 5].iter().fold(*n, |mut n, p| {
                    while n % p == 0 {
                        n /= p
                    }
                    n
                }) == 1
            })
            .unwrap_or(n)
    };
    let (nx, ny) = (fast(width + mw - 1), fast(height + mh - 1));
    // Entry i of the kernel's line is its value at first + i − (m − 1) steps.
    let mut spectrum: Vec<Complex<f64>> = (0..nx * ny)
        .into_par_iter()
        .map(|k| {
            let (i, j) = (k % nx, k / nx);
            let inside = i < width + mw - 1 && j < height + mh - 1;
            let at = |i: usize, first: i64, m: usize| (first + i as i64 - (m as i64 - 1)) as f64;
            let value = if inside { kernel(at(i, ox, mw), at(j, oy, mh)) } else { 0.0 };
            Complex::new(value, 0.0)
        })
        .collect();
    let mut mass = vec![Complex::new(0.0, 0.0); nx * ny];
    for (row, line) in deposit.chunks_exact(mw).zip(mass.chunks_exact_mut(nx)) {
        row.iter().zip(line).for_each(|(d, m)| m.re = *d);
    }
    let mut planner = FftPlanner::new();
    let plans = [false, true].map(|inverse| {
        let direction = if inverse { rustfft::FftDirection::Inverse } else { rustfft::FftDirection::Forward };
        [planner.plan_fft(nx, direction), planner.plan_fft(ny, direction)]
    });
    let both =
        |data: &mut Vec<Complex<f64>>, plans: &[Arc<dyn rustfft::Fft<f64>>; 2], nx: usize, ny: usize| {
            data.par_chunks_mut(nx).for_each(|row| plans[0].process(row));
            *data = transposed(data, nx, ny);
            data.par_chunks_mut(ny).for_each(|row| plans[1].process(row));
            *data = transposed(data, ny, nx);
        };
    both(&mut spectrum, &plans[0], nx, ny);
    both(&mut mass, &plans[0], nx, ny);
    spectrum.par_iter_mut().zip(&mass).for_each(|(a, b)| *a *= b);
    both(&mut spectrum, &plans[1], nx, ny);
    let scale = 1.0 / (nx * ny) as f64;
    let entry = |k: usize| spectrum[(k / width + mh - 1) * nx + k % width + mw - 1].re * scale;
    (0..width * height).map(|k| entry(k) as f32).collect()
}

fn transposed(data: &[Complex<f64>], nx: usize, ny: usize) -> Vec<Complex<f64>> {
    let mut out = vec![Complex::new(0.0, 0.0); data.len()];
    out.par_chunks_mut(ny).enumerate().for_each(|(i, column)| {
        column.iter_mut().enumerate().for_each(|(j, o)| *o = data[j * nx + i]);
    });
    out
}
