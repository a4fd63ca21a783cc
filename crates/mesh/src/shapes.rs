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
