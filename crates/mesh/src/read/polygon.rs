//! Faces of more than three corners, cut into triangles.

use glam::{DVec2, DVec3};

/// Corners of a face that is not convex: cutting its ears off takes time by their square.
const MOST: usize = 256;

/// Triangles of a face of at least three corners, as places in it, wound like it: a fan where the face is convex, else by cutting ears off,
/// the face seen along its mean normal. `None`: it is not convex and has too many corners. A face that has no plane is a fan.
pub(super) fn triangles(corners: &[DVec3]) -> Option<Vec<[usize; 3]>> {
    let n = corners.len();
    let fan = || Some((2..n).map(|k| [0, k - 1, k]).collect());
    if n <= 3 {
        return fan();
    }
    // Newell's normal: exact for a plane face, and a mean for others.
    let normal: DVec3 =
        (0..n).map(|k| (corners[k] - corners[0]).cross(corners[(k + 1) % n] - corners[0])).sum();
    let Some(normal) = normal.try_normalize() else { return fan() };
    let across = normal.any_orthonormal_vector();
    let up = normal.cross(across);
    let flat: Vec<DVec2> =
        corners.iter().map(|corner| DVec2::new(corner.dot(across), corner.dot(up))).collect();
    let turn = |a: usize, b: usize, c: usize| (flat[b] - flat[a]).perp_dot(flat[c] - flat[b]);
    // Convex as seen from the first corner: what a fan needs.
    if (2..n).all(|k| turn(0, k - 1, k) > 0.0) && (0..n).all(|k| turn(k, (k + 1) % n, (k + 2) % n) >= 0.0) {
        return fan();
    }
    if n > MOST {
        return None;
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut cut = Vec::with_capacity(n - 2);
    while left.len() > 3 {
        let m = left.len();
        let at = |k: usize| left[k % m];
        let is_ear = |k: usize| {
            let [a, b, c] = [at(k + m - 1), at(k), at(k + 1)];
            let inside = |p: usize| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            turn(a, b, c) > 0.0 && !left.iter().any(|&p| p != a && p != b && p != c && inside(p))
        };
        // A face that crosses itself may have no ear: then any corner goes, and the check sees what comes of it.
        let ear = (0..m).find(|&k| is_ear(k)).unwrap_or(0);
        cut.push([at(ear + m - 1), at(ear), at(ear + 1)]);
        left.remove(ear);
    }
    cut.push([left[0], left[1], left[2]]);
    Some(cut)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]
    use super::*;

    fn area(corners: &[DVec3], triangles: &[[usize; 3]]) -> (f64, f64) {
        let vectors = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|k| corners[k]);
            0.5 * (b - a).cross(c - a)
        });
        let (sum, lengths) =
            vectors.fold((DVec3::ZERO, 0.0), |(sum, lengths), v| (sum + v, lengths + v.length()));
        (sum.length(), lengths)
    }

    #[test]
    fn a_face_that_is_not_convex_is_covered_once() {
        // An L of area 3, and an arrow head, in a plane that is none of the axes'.
        let place = |(x, y): (f64, f64)| DVec3::new(x, y, 0.3 * x - 0.2 * y);
        let stretch = (1.0 + 0.09 + 0.04f64).sqrt();
        let l = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)].map(place);
        let arrow = [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (1.5, 1.0)].map(place);
        for (corners, flat_area) in [(&l[..], 3.0), (&arrow[..], 0.5)] {
            for start in 0..corners.len() {
                let mut corners = corners.to_vec();
                corners.rotate_left(start);
                let cut = triangles(&corners).unwrap();
                assert_eq!(cut.len(), corners.len() - 2);
                let (signed, covered) = area(&corners, &cut);
                assert!((signed - flat_area * stretch).abs() < 1e-12, "{signed}");
                assert!((covered - signed).abs() < 1e-12, "overlaps: {covered} of {signed}");
            }
        }
        // Negative control: a fan from the L's third corner overlaps itself.
        let mut turned = l.to_vec();
        turned.rotate_left(2);
        let fan: Vec<_> = (2..6).map(|k| [0, k - 1, k]).collect();
        let (signed, covered) = area(&turned, &fan);
        assert!(covered - signed > 0.1);
    }

    #[test]
    fn hostile_faces_end() {
        let circle = |k: usize| {
            let turn = k as f64 / 500.0 * std::f64::consts::TAU;
            DVec3::new(turn.cos(), turn.sin(), 0.0)
        };
        let mut convex: Vec<DVec3> = (0..500).map(circle).collect();
        assert_eq!(triangles(&convex).unwrap().len(), 498);
        convex[250] *= 0.5;
        assert_eq!(triangles(&convex), None);
        for odd in [[DVec3::ZERO; 5], [DVec3::NAN; 5], [DVec3::INFINITY; 5], [DVec3::MAX; 5]] {
            assert_eq!(triangles(&odd).unwrap().len(), 3);
        }
        // A star that crosses itself.
        let star: Vec<DVec3> = (0..5).map(|k| circle(k * 200 % 500)).collect();
        assert_eq!(triangles(&star).unwrap().len(), 3);
    }
}
