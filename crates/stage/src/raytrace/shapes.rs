//! Rays against simple shapes, in closed form.

use glam::DVec3;
use kelir_scene::stage::{AreaShape, Form};

/// Where a ray first meets a shape between `near` and `far`, and the shape's outer normal there (not normalised); `None` for meshes, whose tree is asked.
pub(super) fn meet(
    form: &Form,
    origin: DVec3,
    direction: DVec3,
    near: f64,
    far: f64,
) -> Option<(f64, DVec3)> {
    match *form {
        Form::Mesh(_) => None,
        Form::Sphere { radius_m } => sphere(radius_m, origin, direction, near, far),
        Form::Disk { radius_m } => {
            flat(&AreaShape::Disk { radius_m }, origin, direction, near, far).map(|at| (at, DVec3::Z))
        }
        Form::Rectangle { size_m } => {
            flat(&AreaShape::Rectangle { size_m }, origin, direction, near, far).map(|at| (at, DVec3::Z))
        }
        Form::Triangle { corners_m } => triangle(corners_m.map(DVec3::from), origin, direction, near, far),
        Form::Cone { radius_m, height_m } => cone(radius_m, height_m, origin, direction, near, far),
    }
}

/// Where a ray meets an outline in z = 0.
pub(super) fn flat(shape: &AreaShape, origin: DVec3, direction: DVec3, near: f64, far: f64) -> Option<f64> {
    let at = -origin.z / direction.z;
    let p = origin + at * direction;
    let within = match *shape {
        AreaShape::Rectangle { size_m: [w, h] } => p.x.abs() <= 0.5 * w && p.y.abs() <= 0.5 * h,
        AreaShape::Disk { radius_m } => p.x * p.x + p.y * p.y <= radius_m * radius_m,
    };
    (within && at > near && at < far).then_some(at)
}

fn sphere(radius: f64, origin: DVec3, direction: DVec3, near: f64, far: f64) -> Option<(f64, DVec3)> {
    // Counted from the point of the ray that is nearest to the middle: what is far away cancels nothing.
    let a = direction.length_squared();
    let middle = -origin.dot(direction) / a;
    let nearest = origin + middle * direction;
    let rest = radius * radius - nearest.length_squared();
    if rest < 0.0 || rest.is_nan() {
        return None;
    }
    let half = (rest / a).sqrt();
    let at = [middle - half, middle + half].into_iter().find(|&at| at > near && at < far)?;
    Some((at, nearest + (at - middle) * direction))
}

fn triangle(
    [a, b, c]: [DVec3; 3],
    origin: DVec3,
    direction: DVec3,
    near: f64,
    far: f64,
) -> Option<(f64, DVec3)> {
    let [p, q, r] = [a, b, c].map(|corner| corner - origin);
    let sides = [q.cross(r), r.cross(p), p.cross(q)].map(|edge| edge.dot(direction));
    if !(sides.iter().all(|x| *x >= 0.0) || sides.iter().all(|x| *x <= 0.0)) {
        return None;
    }
    let normal = (b - a).cross(c - a);
    let at = normal.dot(p) / normal.dot(direction);
    (at > near && at < far).then_some((at, normal))
}

fn cone(
    radius: f64,
    height: f64,
    origin: DVec3,
    direction: DVec3,
    near: f64,
    far: f64,
) -> Option<(f64, DVec3)> {
    // x² + z² = k² (h − y)², from the base to the tip.
    let k2 = (radius / height) * (radius / height);
    let up = height - origin.y;
    let a = direction.x * direction.x + direction.z * direction.z - k2 * direction.y * direction.y;
    let half_b = origin.x * direction.x + origin.z * direction.z + k2 * up * direction.y;
    let c = origin.x * origin.x + origin.z * origin.z - k2 * up * up;
    let mut found: Option<(f64, DVec3)> = None;
    let mut take = |at: f64, normal: DVec3| {
        if at > near && at < far && found.is_none_or(|(first, _)| at < first) {
            found = Some((at, normal));
        }
    };
    let side = |at: f64| {
        let p = origin + at * direction;
        ((0.0..=height).contains(&p.y)).then_some((at, DVec3::new(p.x, k2 * (height - p.y), p.z)))
    };
    let roots = if a.abs() > 1e-14 * direction.length_squared() {
        let rest = half_b * half_b - a * c;
        if rest >= 0.0 {
            // The root without cancellation, and the other by their product.
            let q = -(half_b + half_b.signum() * rest.sqrt());
            [q / a, c / q]
        } else {
            [f64::NAN; 2]
        }
    } else {
        [-c / (2.0 * half_b), f64::NAN]
    };
    roots.into_iter().filter_map(side).for_each(|(at, normal)| take(at, normal));
    let at = -origin.y / direction.y;
    let p = origin + at * direction;
    if p.x * p.x + p.z * p.z <= radius * radius {
        take(at, DVec3::NEG_Y);
    }
    found
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn unit(v: [f64; 3]) -> DVec3 {
        DVec3::from(v).try_normalize().unwrap_or(DVec3::X)
    }

    /// Whether a point is inside, by the shape's own inequality, which the roots were not taken from.
    fn inside(form: &Form, p: DVec3) -> bool {
        match *form {
            Form::Sphere { radius_m } => p.length() < radius_m,
            Form::Cone { radius_m, height_m } => {
                p.y > 0.0 && p.y < height_m && p.x.hypot(p.z) < radius_m * (1.0 - p.y / height_m)
            }
            _ => unreachable!("solid shapes"),
        }
    }

    proptest! {
        /// Before the hit the ray is outside and behind it inside (or the other way round, from inside), and normals point outwards.
        #[test]
        fn hits_are_where_the_ray_goes_in_or_out(
            from in prop::array::uniform3(-2.0..2.0f64), to in prop::array::uniform3(-1.0..1.0f64), cone: bool,
        ) {
            let form = if cone { Form::Cone { radius_m: 0.8, height_m: 1.1 } } else { Form::Sphere { radius_m: 0.9 } };
            let (origin, direction) = (DVec3::from(from), unit(to));
            let started = inside(&form, origin);
            let at = |t: f64| inside(&form, origin + t * direction);
            match meet(&form, origin, direction, 0.0, f64::INFINITY) {
                Some((t, normal)) => {
                    prop_assume!(t > 1e-3);
                    // A graze along an edge is no change that a step can see.
                    prop_assume!(normal.normalize().dot(direction).abs() > 1e-2);
                    for k in 0..50 {
                        prop_assert_eq!(at(t * (f64::from(k) + 0.5) / 50.0 * (1.0 - 1e-6)), started);
                    }
                    prop_assume!(at(t + 1e-7) != started || at(t + 1e-9) != started || at(t + 1e-5) != started || cone);
                    prop_assert_eq!(normal.dot(direction) > 0.0, started);
                }
                None => prop_assert!((0..400).all(|k| !at(f64::from(k) * 0.01)), "missed"),
            }
        }
    }

    #[test]
    fn closed_forms_of_a_few_rays() {
        let ray = |form: &Form, o: [f64; 3], d: [f64; 3]| {
            meet(form, o.into(), d.into(), 0.0, f64::INFINITY).map(|(at, _)| at)
        };
        let sphere = Form::Sphere { radius_m: 1.0 };
        assert_eq!(ray(&sphere, [0.0, 0.0, 3.0], [0.0, 0.0, -1.0]), Some(2.0));
        assert_eq!(ray(&sphere, [0.0, 0.0, 0.0], [0.0, 0.0, -2.0]), Some(0.5));
        assert_eq!(ray(&sphere, [0.0, 1.1, 3.0], [0.0, 0.0, -1.0]), None);
        let cone = Form::Cone { radius_m: 1.0, height_m: 2.0 };
        assert_eq!(ray(&cone, [0.0, 5.0, 0.0], [0.0, -1.0, 0.0]), Some(3.0));
        assert_eq!(ray(&cone, [3.0, 1.0, 0.0], [-1.0, 0.0, 0.0]), Some(2.5));
        assert_eq!(ray(&cone, [0.2, -1.0, 0.0], [0.0, 1.0, 0.0]), Some(1.0));
        let wall = Form::Rectangle { size_m: [2.0, 1.0] };
        assert_eq!(ray(&wall, [0.9, 0.4, 1.0], [0.0, 0.0, -1.0]), Some(1.0));
        assert_eq!(ray(&wall, [0.9, 0.6, 1.0], [0.0, 0.0, -1.0]), None);
        assert_eq!(ray(&wall, [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]), None);
        let corners_m = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(ray(&Form::Triangle { corners_m }, [0.2, 0.2, 1.0], [0.0, 0.0, -1.0]), Some(1.0));
        assert_eq!(ray(&Form::Triangle { corners_m }, [0.6, 0.6, 1.0], [0.0, 0.0, -1.0]), None);
    }
}
