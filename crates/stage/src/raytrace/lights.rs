//! What lights send to a point, where nothing is in the way.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use kelir_scene::stage::{AreaShape, Environment, LightKind, Pose};

/// What a light sends to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sent {
    /// From the point to the light, or the direction of a light without end.
    pub towards: DVec3,
    /// Whether the light is where `towards` ends.
    pub ends: bool,
    /// Irradiance on a plane that faces it, one a channel: all of it, or an estimate whose mean over samples it is.
    pub irradiance: [f64; 3],
}

/// A light made ready.
pub(super) enum Source<'a> {
    /// From one direction or point: shadows have edges.
    Hard(&'a LightKind),
    /// From many: shadows are estimated.
    Soft(&'a LightKind, Option<Directions>),
}

impl<'a> Source<'a> {
    pub(super) fn new(kind: &'a LightKind) -> Self {
        match kind {
            LightKind::Environment(environment) => Self::Soft(kind, Some(Directions::new(environment))),
            _ if kind.is_soft() => Self::Soft(kind, None),
            _ => Self::Hard(kind),
        }
    }

    /// Where a light that is one point is, metres.
    pub(super) fn position(&self) -> Option<DVec3> {
        match self {
            Self::Hard(LightKind::Point { position_m, .. }) => Some(*position_m),
            Self::Hard(LightKind::Projector(projector)) => Some(projector.pose.position_m),
            _ => None,
        }
    }

    /// What it sends to a point, by a place of the unit square where it is soft.
    pub(super) fn sends(&self, point: DVec3, u: [f64; 2]) -> Sent {
        match self {
            Self::Hard(kind) => hard(kind, point),
            Self::Soft(LightKind::Directional { direction, irradiance, angular_radius_deg }, _) => {
                sun(*direction, irradiance, *angular_radius_deg, u)
            }
            Self::Soft(LightKind::Area { pose, shape, radiance }, _) => lamp(pose, shape, radiance, point, u),
            Self::Soft(LightKind::Environment(environment), Some(directions)) => {
                let (towards, density) = directions.pick(u);
                let radiance = environment.radiance(towards);
                Sent {
                    towards,
                    ends: false,
                    irradiance: radiance.map(|l| if density > 0.0 { l / density } else { 0.0 }),
                }
            }
            Self::Soft(..) => Sent { towards: DVec3::Y, ends: false, irradiance: [0.0; 3] },
        }
    }
}

/// Radiance of a light's own that is seen in a direction in which nothing stands.
pub(super) fn behind_all(kind: &LightKind, direction: DVec3) -> [f64; 3] {
    match kind {
        LightKind::Environment(environment) => environment.radiance(direction),
        LightKind::Directional { direction: goes, irradiance, angular_radius_deg }
            if *angular_radius_deg > 0.0 =>
        {
            let alpha = angular_radius_deg.to_radians();
            let seen = direction.normalize().dot(-*goes) >= alpha.cos();
            if seen { irradiance.map(|e| e / (PI * alpha.sin().powi(2))) } else { [0.0; 3] }
        }
        _ => [0.0; 3],
    }
}

fn hard(kind: &LightKind, point: DVec3) -> Sent {
    let from = |position: DVec3, share: [f64; 3], intensity: &[f64; 3], falloff: bool| {
        let towards = position - point;
        let over = if falloff { towards.length_squared() } else { 1.0 };
        let irradiance = [0, 1, 2].map(|c| if share[c] > 0.0 { share[c] * intensity[c] / over } else { 0.0 });
        Sent { towards, ends: true, irradiance }
    };
    match kind {
        LightKind::Point { position_m, intensity } => from(*position_m, [1.0; 3], intensity, true),
        LightKind::Projector(p) => from(p.pose.position_m, p.at(point), &p.intensity, p.falloff),
        LightKind::Directional { direction, irradiance, .. } => {
            Sent { towards: -*direction, ends: false, irradiance: *irradiance }
        }
        _ => Sent { towards: DVec3::Y, ends: false, irradiance: [0.0; 3] },
    }
}

/// A cone of even radiance, by a place in it: even over the cone's solid angle.
fn sun(goes: DVec3, irradiance: &[f64; 3], angular_radius_deg: f64, u: [f64; 2]) -> Sent {
    let alpha = angular_radius_deg.to_radians();
    // 1 − cos α, without cancellation.
    let depth = 2.0 * (0.5 * alpha).sin().powi(2);
    let rise = depth * u[0];
    let (sin, cos) = ((rise * (2.0 - rise)).max(0.0).sqrt(), 1.0 - rise);
    let axis = -goes;
    let (right, up) = axis.any_orthonormal_pair();
    let (sin_phi, cos_phi) = (TAU * u[1]).sin_cos();
    let towards = cos * axis + sin * (cos_phi * right + sin_phi * up);
    let weight = TAU * depth / (PI * alpha.sin().powi(2));
    Sent { towards, ends: false, irradiance: irradiance.map(|e| weight * e) }
}

/// A flat lamp, by a place on it: even over its area.
fn lamp(pose: &Pose, shape: &AreaShape, radiance: &[f64; 3], point: DVec3, [u, v]: [f64; 2]) -> Sent {
    let own = match *shape {
        AreaShape::Rectangle { size_m: [w, h] } => DVec3::new(w * (u - 0.5), h * (v - 0.5), 0.0),
        AreaShape::Disk { radius_m } => {
            let [x, y] = disk(u, v);
            DVec3::new(radius_m * x, radius_m * y, 0.0)
        }
    };
    let towards = pose.to_stage().transform_point3(own) - point;
    let length2 = towards.length_squared();
    let cos = (pose.rotation * DVec3::Z).dot(-towards) / length2.sqrt();
    let weight = if cos > 0.0 { shape.area_m2() * pose.scale * pose.scale * cos / length2 } else { 0.0 };
    Sent { towards, ends: true, irradiance: radiance.map(|l| weight * l) }
}

/// The unit square onto the unit disk, areas in proportion (Shirley & Chiu 1997).
pub(super) fn disk(u: f64, v: f64) -> [f64; 2] {
    let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    if a == 0.0 && b == 0.0 {
        return [0.0; 2];
    }
    let (radius, phi) =
        if a.abs() > b.abs() { (a, 0.25 * PI * b / a) } else { (b, 0.5 * PI - 0.25 * PI * a / b) };
    let (sin, cos) = phi.sin_cos();
    [radius * cos, radius * sin]
}

/// Directions of an environment, the brighter the likelier.
pub(super) struct Directions {
    size: [usize; 2],
    /// Sums of weights up to and with each row.
    rows: Vec<f64>,
    /// Within each row, sums up to and with each texel.
    texels: Vec<f64>,
}

impl Directions {
    fn new(environment: &Environment) -> Self {
        let image = &environment.image;
        let (w, h) = (image.width, image.height);
        let bright = |x: usize, y: usize| {
            (0..3).map(|c| environment.scale[c] * f64::from(image.channel(c)[y * w + x])).sum::<f64>()
        };
        let bright: Vec<f64> = (0..w * h).map(|k| bright(k % w, k / w)).collect();
        let (mut rows, mut texels) = (Vec::with_capacity(h), Vec::with_capacity(w * h));
        let mut total = 0.0;
        for y in 0..h {
            // A texel's mean of what is interpolated between its middle and those around.
            let sin = (PI * (y as f64 + 0.5) / h as f64).sin();
            let mut sum = 0.0;
            for x in 0..w {
                let line = |y: usize| {
                    let [left, middle, right] = [w - 1, 0, 1].map(|dx| bright[y * w + (x + dx) % w]);
                    0.125 * left + 0.75 * middle + 0.125 * right
                };
                let [above, below] = [y.saturating_sub(1), (y + 1).min(h - 1)];
                sum += sin * (0.125 * line(above) + 0.75 * line(y) + 0.125 * line(below));
                texels.push(sum);
            }
            total += sum;
            rows.push(total);
        }
        Self { size: [w, h], rows, texels }
    }

    /// A direction, and its density over solid angle.
    fn pick(&self, u: [f64; 2]) -> (DVec3, f64) {
        let [w, h] = self.size;
        let total = self.rows[h - 1];
        if total <= 0.0 {
            return (DVec3::Y, 0.0);
        }
        let (y, fy, row) = find(&self.rows, u[0]);
        let line = &self.texels[y * w..][..w];
        let (x, fx, texel) = find(line, u[1]);
        let place = [(x as f64 + fx) / w as f64, (y as f64 + fy) / h as f64];
        let density = row * texel * (w * h) as f64 / (2.0 * PI * PI * (PI * place[1]).sin());
        (Environment::direction(place), density)
    }
}

/// Of a table of sums: which step holds `u` of its whole, where in it, and its share.
fn find(sums: &[f64], u: f64) -> (usize, f64, f64) {
    let total = sums[sums.len() - 1];
    let want = u * total;
    let k = sums.partition_point(|s| *s <= want).min(sums.len() - 1);
    let before = if k == 0 { 0.0 } else { sums[k - 1] };
    let step = sums[k] - before;
    (k, if step > 0.0 { ((want - before) / step).clamp(0.0, 1.0 - f64::EPSILON) } else { 0.5 }, step / total)
}
