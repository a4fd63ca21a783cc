//! From rays to radiance.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use kelir_frame::sobol::{self, Points, REPLICATES};
use kelir_frame::{Meter, Pixel, View};
use kelir_scene::stage::LightKind;
use rayon::prelude::*;

use super::lights::{self, Sent, Source};
use super::rays::{LANES, NOTHING, Rays};
use super::world::{Point, World, leaving};

/// A mirror sees mirrors so many times over; what is behind more is black.
const MIRRORS: usize = 8;

/// Tiles of pixels that are followed together, in either direction.
const TILE: usize = 4;

const _: () = assert!(TILE * TILE == LANES && LANES == REPLICATES, "a lane is a pixel, or a replicate");

/// What a colour is, in numbers that add up.
type Colour = [f64; 3];

/// Everything that a pixel needs.
pub(super) struct Estimator<'a> {
    world: &'a World<'a>,
    sources: Vec<Source<'a>>,
    view: View,
    points: &'a Points,
    /// Of the light that surfaces send each other.
    bounced: Option<&'a Points>,
    /// Whether anything is estimated, or all is exact.
    sampled: bool,
    /// Whether lamps and environments that are seen themselves count.
    pub(super) shining: bool,
}

/// What a ray from the camera comes to.
#[derive(Clone, Copy, Default)]
struct Path {
    /// The first surface that is no mirror.
    point: Option<Point>,
    /// What mirrors on the way let through.
    through: Colour,
    /// What shines at its end by itself.
    shines: Colour,
}

/// One row of tiles: its rows' radiance and standard error, pixel by pixel.
pub(super) struct Band {
    pub radiance: Vec<Colour>,
    pub error: Vec<Colour>,
    /// Rays that were followed.
    pub rays: u64,
}

impl<'a> Estimator<'a> {
    pub(super) fn new(
        world: &'a World<'a>,
        view: &View,
        points: &'a Points,
        bounced: Option<&'a Points>,
    ) -> Self {
        let sources: Vec<_> = world.stage.lights.iter().map(|light| Source::new(&light.kind)).collect();
        let soft = sources.iter().any(|source| matches!(source, Source::Soft(..)));
        let sampled = soft || bounced.is_some() || view.pixel == Pixel::Area;
        Self { world, sources, view: *view, points, bounced, sampled, shining: true }
    }

    /// Whether there is an error to be told.
    pub(super) fn sampled(&self) -> bool {
        self.sampled
    }

    /// The whole image, in rows of tiles.
    pub(super) fn all(&self, meter: &Meter) -> Vec<Band> {
        let [_, height] = self.view.size;
        let band = |top: usize| {
            let rows = TILE.min(height - top);
            let band = self.band(top, rows);
            meter.add(rows);
            band
        };
        (0..height).into_par_iter().step_by(TILE).map(band).collect()
    }

    fn band(&self, top: usize, rows: usize) -> Band {
        let [width, _] = self.view.size;
        let mut band = Band {
            radiance: vec![[0.0; 3]; rows * width],
            error: vec![[0.0; 3]; if self.sampled { rows * width } else { 0 }],
            rays: 0,
        };
        for left in (0..width).step_by(TILE) {
            let columns = TILE.min(width - left);
            // What is beyond the image's edge is its last pixel once more.
            let pixels: [[usize; 2]; LANES] =
                std::array::from_fn(|r| [left + (r % TILE).min(columns - 1), top + (r / TILE).min(rows - 1)]);
            let (paths, exact) = match self.view.pixel {
                Pixel::Centre => self.middles(&pixels, &mut band.rays),
                Pixel::Area => Default::default(),
            };
            for r in (0..LANES).filter(|r| r % TILE < columns && r / TILE < rows) {
                let [i, j] = pixels[r];
                let at = (j - top) * width + i;
                if !self.sampled {
                    band.radiance[at] = exact[r];
                    continue;
                }
                let path = (self.view.pixel == Pixel::Centre).then_some((paths[r], exact[r]));
                (band.radiance[at], band.error[at]) = self.pixel([i, j], path, &mut band.rays);
            }
        }
        band
    }

    /// Paths through pixels' middles, and all of their radiance that is exact.
    fn middles(&self, pixels: &[[usize; 2]; LANES], rays: &mut u64) -> ([Path; LANES], [Colour; LANES]) {
        let paths = self.look(&pixels.map(|[i, j]| [i as f64 + 0.5, j as f64 + 0.5]), rays);
        let exact = self.exact(&paths, rays);
        (paths, exact)
    }

    /// Mean and standard error of a pixel; `path` where it is one for all samples, with what is exact of it.
    fn pixel(&self, [i, j]: [usize; 2], path: Option<(Path, Colour)>, rays: &mut u64) -> (Colour, Colour) {
        let pixel = (j * self.view.size[0] + i) as u32;
        let seed = sobol::fold(self.points.seed);
        // Nothing is estimated of what only shines, or of nothing.
        if let Some((Path { point: None, .. }, exact)) = path {
            return (exact, [0.0; 3]);
        }
        let mut sums = [[0f64; 3]; LANES];
        let jitter = sobol::stream(seed, pixel, u32::MAX);
        for sample in 0..self.points.samples {
            let (paths, exact) = match path {
                Some((path, exact)) => ([path; LANES], [exact; LANES]),
                None => {
                    let place = |r: usize| {
                        let at = |d: usize| self.points.at(jitter, d, sample, r) + 0.5;
                        [i as f64 + at(2), j as f64 + at(3)]
                    };
                    let paths = self.look(&std::array::from_fn(place), rays);
                    let exact = self.exact(&paths, rays);
                    (paths, exact)
                }
            };
            let soft = self.estimated(&paths, pixel, sample, rays);
            for r in 0..LANES {
                for c in 0..3 {
                    sums[r][c] += exact[r][c] + soft[r][c];
                }
            }
        }
        let n = self.points.samples as f64;
        let (mut mean, mut error) = ([0.0; 3], [0.0; 3]);
        for c in 0..3 {
            let replicates = sums.map(|sum| sum[c] / n);
            (mean[c], error[c]) = mean_and_error(&replicates);
        }
        (mean, error)
    }

    /// What rays through sixteen places of the picture (pixels from the top left) come to.
    fn look(&self, places: &[[f64; 2]; LANES], rays: &mut u64) -> [Path; LANES] {
        let width = self.view.size[0] as f64;
        let camera = &self.world.stage.camera;
        let both = places.map(|[x, y]| camera.ray(DVec2::new(x / width, y / width)));
        let (origins, directions) = (both.map(|b| b.0), both.map(|b| b.1));
        let mut packet = if origins.iter().all(|o| *o == origins[0]) {
            Rays::from_point(origins[0], &directions)
        } else {
            Rays::from_points(&origins, &directions)
        };
        let mut paths = [Path { through: [1.0; 3], ..Path::default() }; LANES];
        for _ in 0..=MIRRORS {
            *rays += count(&packet);
            let seen = self.world.first(&packet);
            let (mut from, mut towards) = ([DVec3::ZERO; LANES], [DVec3::ZERO; LANES]);
            let mut mirrored = [false; LANES];
            for r in (0..LANES).filter(|&r| packet.follows(r)) {
                let direction = packet.direction(r);
                let path = &mut paths[r];
                if seen.object[r] == NOTHING {
                    for light in &self.world.stage.lights {
                        let behind = lights::behind_all(&light.kind, direction);
                        (0..3).for_each(|c| path.shines[c] += path.through[c] * behind[c]);
                    }
                } else if let Some(lamp) = self.world.lamp(seen.object[r]) {
                    let LightKind::Area { pose, radiance, .. } = &self.world.stage.lights[lamp].kind else {
                        continue;
                    };
                    // Its back is black.
                    if (pose.rotation * DVec3::Z).dot(direction) < 0.0 {
                        (0..3).for_each(|c| path.shines[c] += path.through[c] * radiance[c]);
                    }
                } else {
                    let point = self.world.point(&packet, &seen, r);
                    if !point.mirror {
                        path.point = Some(point);
                        continue;
                    }
                    (0..3).for_each(|c| path.through[c] *= point.albedo[c]);
                    mirrored[r] = true;
                    from[r] = point.position;
                    towards[r] = direction - 2.0 * direction.dot(point.shading) * point.shading;
                }
            }
            let Some(first) = mirrored.iter().position(|m| *m) else { break };
            // Rays that have ended stand where one that goes on does, so that numbers stay small.
            let lane = |r: usize| if mirrored[r] { r } else { first };
            packet = leaving(
                &std::array::from_fn(|r| from[lane(r)]),
                &std::array::from_fn(|r| towards[lane(r)]),
                self.world.skin_m,
            );
            (0..LANES).filter(|&r| !mirrored[r]).for_each(|r| packet.stop(r));
        }
        paths
    }

    /// What of paths' radiance needs no samples: what shines by itself, ambient light, and lights that are points.
    fn exact(&self, paths: &[Path; LANES], rays: &mut u64) -> [Colour; LANES] {
        let points = paths.map(|path| path.point);
        let mut sum = [[0.0; 3]; LANES];
        for source in self.sources.iter().filter(|source| matches!(source, Source::Hard(_))) {
            self.add(source, &points, &[[0.5; 2]; LANES], &mut sum, rays);
        }
        std::array::from_fn(|r| {
            let Path { point, through, shines } = &paths[r];
            [0, 1, 2].map(|c| {
                let ambient = self.world.stage.ambient[c];
                let sent = point.map_or(0.0, |point| point.albedo[c] * (sum[r][c] / PI + ambient));
                through[c] * sent + if self.shining { shines[c] } else { 0.0 }
            })
        })
    }

    /// One sample of what of paths' radiance is estimated.
    fn estimated(&self, paths: &[Path; LANES], pixel: u32, sample: usize, rays: &mut u64) -> [Colour; LANES] {
        let points = paths.map(|path| path.point);
        let mut sum = [[0.0; 3]; LANES];
        self.soft(self.points, [0, 1], &points, pixel, sample, &mut sum, rays);
        if let Some(bounced) = self.bounced {
            self.bounce(bounced, &points, pixel, sample, &mut sum, rays);
        }
        std::array::from_fn(|r| {
            let Path { point, through, .. } = &paths[r];
            [0, 1, 2].map(|c| point.map_or(0.0, |point| through[c] * point.albedo[c] * sum[r][c] / PI))
        })
    }

    /// Adds one sample of the irradiance of every light that is soft.
    #[allow(clippy::too_many_arguments, reason = "one sample's whole address")]
    fn soft(
        &self,
        table: &Points,
        dimensions: [usize; 2],
        points: &[Option<Point>; LANES],
        pixel: u32,
        sample: usize,
        sum: &mut [Colour; LANES],
        rays: &mut u64,
    ) {
        let seed = sobol::fold(table.seed);
        for (k, source) in self.sources.iter().enumerate() {
            if matches!(source, Source::Hard(_)) {
                continue;
            }
            let key = sobol::stream(seed, pixel, k as u32);
            let u = std::array::from_fn(|r| dimensions.map(|d| table.at(key, d, sample, r) + 0.5));
            self.add(source, points, &u, sum, rays);
        }
    }

    /// Adds one sample of the irradiance that other surfaces send on, once.
    fn bounce(
        &self,
        table: &Points,
        points: &[Option<Point>; LANES],
        pixel: u32,
        sample: usize,
        sum: &mut [Colour; LANES],
        rays: &mut u64,
    ) {
        let key = sobol::stream(sobol::fold(table.seed), pixel, u32::MAX);
        let Some(first) = points.iter().flatten().next() else { return };
        let from = points.map(|point| point.unwrap_or(*first).position);
        let towards = std::array::from_fn(|r| {
            let [x, y] = lights::disk(table.at(key, 0, sample, r) + 0.5, table.at(key, 1, sample, r) + 0.5);
            let normal = points[r].unwrap_or(*first).shading;
            let (right, up) = normal.any_orthonormal_pair();
            x * right + y * up + (1.0 - x * x - y * y).max(0.0).sqrt() * normal
        });
        let mut packet = leaving(&from, &towards, self.world.skin_m);
        for r in 0..LANES {
            if points[r].is_none_or(|point| point.normal.dot(towards[r]) <= 0.0) {
                packet.stop(r);
            }
        }
        *rays += count(&packet);
        let seen = self.world.first(&packet);
        let others: [Option<Point>; LANES] = std::array::from_fn(|r| {
            let hit =
                packet.follows(r) && seen.object[r] != NOTHING && self.world.lamp(seen.object[r]).is_none();
            // What a mirror sends on is no diffuse light.
            hit.then(|| self.world.point(&packet, &seen, r)).filter(|point| !point.mirror)
        });
        let mut there = [[0.0; 3]; LANES];
        for source in self.sources.iter().filter(|source| matches!(source, Source::Hard(_))) {
            self.add(source, &others, &[[0.5; 2]; LANES], &mut there, rays);
        }
        self.soft(table, [2, 3], &others, pixel, sample, &mut there, rays);
        for r in 0..LANES {
            let Some(other) = others[r] else { continue };
            // Directions by their cosine: the irradiance is π times the mean of the radiance, which is albedo · E / π.
            (0..3).for_each(|c| sum[r][c] += other.albedo[c] * there[r][c]);
        }
    }

    /// Adds the irradiance of one light, by sixteen places on it, to those of sixteen points.
    fn add(
        &self,
        source: &Source,
        points: &[Option<Point>; LANES],
        u: &[[f64; 2]; LANES],
        sum: &mut [Colour; LANES],
        rays: &mut u64,
    ) {
        let mut arriving = [[0.0; 3]; LANES];
        let mut sent: [Option<Sent>; LANES] = [None; LANES];
        for r in 0..LANES {
            let Some(point) = &points[r] else { continue };
            let light = source.sends(point.position, u[r]);
            let cos = point.shading.dot(light.towards) / light.towards.length();
            let lit = cos > 0.0 && point.normal.dot(light.towards) > 0.0;
            let any = light.irradiance.iter().any(|e| *e > 0.0);
            if lit && any {
                arriving[r] = light.irradiance.map(|e| cos * e);
                sent[r] = Some(light);
            }
        }
        let Some(first) = sent.iter().position(Option::is_some) else { return };
        // Lanes that follow nothing stand where one that does is, so that numbers stay small.
        let lane = |r: usize| if sent[r].is_some() { r } else { first };
        let at = |r: usize| points[lane(r)].map_or(DVec3::ZERO, |point| point.position);
        let towards = |r: usize| sent[lane(r)].map_or(DVec3::Y, |light| light.towards);
        let positions = std::array::from_fn(at);
        let mut packet = match source.position() {
            // From the light, which is one point, to the surfaces.
            Some(position) => Rays::from_point(position, &std::array::from_fn(|r| -towards(r))),
            None => leaving(&positions, &std::array::from_fn(towards), self.world.skin_m),
        };
        for (r, sent) in sent.iter().enumerate() {
            match sent {
                None => packet.stop(r),
                Some(light) if light.ends => packet.far[r] = 1.0 - self.world.skin_m / light.towards.length(),
                Some(_) => {}
            }
        }
        *rays += count(&packet);
        let of = std::array::from_fn(|r| points[r].map_or(NOTHING, |point| point.object));
        let blocked = self.world.blocked(&packet, &of);
        for r in (0..LANES).filter(|r| blocked >> r & 1 == 0) {
            (0..3).for_each(|c| sum[r][c] += arriving[r][c]);
        }
    }
}

/// How many of the rays are followed.
fn count(rays: &Rays) -> u64 {
    (0..LANES).filter(|&r| rays.follows(r)).count() as u64
}

/// Mean of independent replicates, and its standard error: exactly 0 where all are equal.
fn mean_and_error(replicates: &[f64; REPLICATES]) -> (f64, f64) {
    let n = REPLICATES as f64;
    let first = replicates[0];
    let shift = replicates.iter().map(|v| v - first).sum::<f64>() / n;
    let square: f64 = replicates.iter().map(|v| (v - first - shift).powi(2)).sum();
    (first + shift, (square / (n * (n - 1.0))).sqrt())
}
