//! Small meshes that tests know all about.

use crate::Mesh;

/// Its four faces look outwards.
pub(crate) fn tetrahedron() -> Mesh {
    Mesh::new(
        vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    )
}

/// The unit cube between (0, 0, 0) and (1, 1, 1): vertex 1·x + 2·y + 4·z.
pub(crate) fn cube() -> Mesh {
    let positions = (0..8u8).map(|v| [v & 1, v >> 1 & 1, v >> 2].map(f32::from)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh::new(positions, faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// Several meshes as one.
pub(crate) fn joined(meshes: &[Mesh]) -> Mesh {
    let mut all = Mesh::default();
    for mesh in meshes {
        let first = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        all.triangles.extend(mesh.triangles.iter().map(|triangle| triangle.map(|index| first + index)));
    }
    all
}

/// Moved, metres.
pub(crate) fn moved(mut mesh: Mesh, by: [f32; 3]) -> Mesh {
    mesh.positions.iter_mut().for_each(|position| (0..3).for_each(|k| position[k] += by[k]));
    mesh
}

/// A ring about the y axis, radii 2 and 1: `around` times `across` vertices.
pub(crate) fn torus(around: u32, across: u32) -> Mesh {
    let turn = |k: u32, of: u32| f64::from(k) / f64::from(of) * std::f64::consts::TAU;
    let vertex = |i: u32, j: u32| {
        let (u, v) = (turn(i, around), turn(j, across));
        let r = 2.0 + v.cos();
        [r * u.cos(), v.sin(), -r * u.sin()].map(|x| x as f32)
    };
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    let cells = || (0..around).flat_map(move |i| (0..across).map(move |j| (i, j)));
    let quad =
        |(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]];
    Mesh::new(cells().map(|(i, j)| vertex(i, j)).collect(), cells().flat_map(quad).collect())
}

/// A strip of `n` cells with half a turn.
pub(crate) fn mobius(n: u32) -> Mesh {
    let vertex = |i: u32, side: f64| {
        let u = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        let r = 3.0 + side * (u / 2.0).cos();
        [r * u.cos(), side * (u / 2.0).sin(), -r * u.sin()].map(|x| x as f32)
    };
    let at = |i: u32, side: u32| if i == n { 1 - side } else { 2 * i + side };
    let quad = |i: u32| [[at(i, 0), at(i + 1, 0), at(i + 1, 1)], [at(i, 0), at(i + 1, 1), at(i, 1)]];
    Mesh::new(
        (0..n).flat_map(|i| [vertex(i, -1.0), vertex(i, 1.0)]).collect(),
        (0..n).flat_map(quad).collect(),
    )
}

/// A ball of this radius, metres: an octahedron, each side cut in `n`.
pub(crate) fn ball(radius: f64, n: u32) -> Mesh {
    let mut mesh = Mesh::default();
    let mut known = std::collections::HashMap::new();
    let mut vertex = |mesh: &mut Mesh, p: [i64; 3]| {
        *known.entry(p).or_insert_with(|| {
            let v = glam::DVec3::from_array(p.map(|x| x as f64)).normalize() * radius;
            mesh.positions.push(v.as_vec3().to_array());
            mesh.positions.len() as u32 - 1
        })
    };
    let n = i64::from(n);
    for octant in 0..8 {
        let sign = [0, 1, 2].map(|k| if octant >> k & 1 == 0 { 1 } else { -1 });
        let outward = sign.iter().product::<i64>() > 0;
        let mut face = |corners: [[i64; 2]; 3]| {
            let mut triangle =
                corners.map(|[x, y]| vertex(&mut mesh, [sign[0] * x, sign[1] * y, sign[2] * (n - x - y)]));
            if !outward {
                triangle.swap(1, 2);
            }
            mesh.triangles.push(triangle);
        };
        for x in 0..n {
            for y in 0..n - x {
                face([[x, y], [x + 1, y], [x, y + 1]]);
                if x + y + 2 <= n {
                    face([[x + 1, y], [x + 1, y + 1], [x, y + 1]]);
                }
            }
        }
    }
    mesh
}
