//! Sixteen rays at a time.

use glam::{DAffine3, DVec3};

/// Rays that are followed together.
pub const LANES: usize = 16;

/// One number a ray.
pub type Lanes = [f64; LANES];

/// What hits nothing.
pub const NOTHING: u32 = u32::MAX;

/// Where rays begin, metres.
#[allow(clippy::large_enum_variant, reason = "one on the stack, copied with its rays")]
#[derive(Clone, Debug, PartialEq)]
pub enum Origin {
    /// All at one point, which is cheaper.
    One(DVec3),
    /// Each at its own: x, y and z.
    Each([Lanes; 3]),
}

/// Sixteen rays. Distances along a ray are in units of its direction's length.
#[derive(Clone, Debug)]
pub struct Rays {
    /// Where they begin.
    pub origin: Origin,
    /// x, y and z of their directions, of any length.
    pub direction: [Lanes; 3],
    /// Hits at this distance or nearer don't count.
    pub near: f64,
    /// Hits at this distance or farther don't count; what is below [`Rays::near`] follows no ray.
    pub far: Lanes,
}

impl Rays {
    /// Rays from one point along sixteen vectors, without an end.
    pub fn from_point(origin: DVec3, directions: &[DVec3; LANES]) -> Self {
        Self {
            origin: Origin::One(origin),
            direction: split(directions),
            near: 0.0,
            far: [f64::INFINITY; LANES],
        }
    }

    /// Rays from sixteen points, without an end.
    pub fn from_points(origins: &[DVec3; LANES], directions: &[DVec3; LANES]) -> Self {
        Self {
            origin: Origin::Each(split(origins)),
            direction: split(directions),
            near: 0.0,
            far: [f64::INFINITY; LANES],
        }
    }

    /// Where ray `r` begins, metres.
    pub fn origin(&self, r: usize) -> DVec3 {
        match &self.origin {
            Origin::One(origin) => *origin,
            Origin::Each(origins) => DVec3::new(origins[0][r], origins[1][r], origins[2][r]),
        }
    }

    /// The direction of ray `r`.
    pub fn direction(&self, r: usize) -> DVec3 {
        DVec3::new(self.direction[0][r], self.direction[1][r], self.direction[2][r])
    }

    /// Lets ray `r` hit nothing.
    pub fn stop(&mut self, r: usize) {
        self.far[r] = f64::NEG_INFINITY;
    }

    /// Whether ray `r` may hit anything.
    pub fn follows(&self, r: usize) -> bool {
        self.far[r] > self.near
    }

    /// The same rays seen from elsewhere; distances along them stay what they are.
    pub fn through(&self, map: &DAffine3) -> Self {
        let directions: [DVec3; LANES] = std::array::from_fn(|r| map.transform_vector3(self.direction(r)));
        let origin = match self.origin {
            Origin::One(origin) => Origin::One(map.transform_point3(origin)),
            Origin::Each(_) => {
                Origin::Each(split(&std::array::from_fn(|r| map.transform_point3(self.origin(r)))))
            }
        };
        Self { origin, direction: split(&directions), near: self.near, far: self.far }
    }
}

/// x, y and z of vectors.
pub(super) fn split(vectors: &[DVec3; LANES]) -> [Lanes; 3] {
    [vectors.map(|v| v.x), vectors.map(|v| v.y), vectors.map(|v| v.z)]
}

/// What sixteen rays hit.
#[derive(Clone, Debug, PartialEq)]
pub struct Hits {
    /// Where along each ray; infinite where nothing is hit.
    pub at: Lanes,
    /// Which triangle; [`NOTHING`] where none.
    pub triangle: [u32; LANES],
}

impl Default for Hits {
    fn default() -> Self {
        Self { at: [f64::INFINITY; LANES], triangle: [NOTHING; LANES] }
    }
}
