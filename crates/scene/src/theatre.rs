//! The theatre at one instant, ready to draw: what every rendering technique is handed.
//!
//! Units: metres, radians nowhere (tilts are kept in degrees as written), radiance in W·m⁻²·sr⁻¹ up to one exposure.
//! Axes: the screen is z = 0, x right and y up as the audience (z > 0) sees it; lamp and puppets are at z < 0.

use std::sync::Arc;

use glam::DVec3;

/// Everything that light meets between the lamp and the audience at one instant.
#[derive(Clone, Debug)]
pub struct Theatre {
    /// The cloth.
    pub screen: Screen,
    /// The bulb: emitters that share one centre, add up, and never occlude each other.
    pub lamp: Lamp,
    /// Light that does not come from the lamp.
    pub ambient: Ambient,
    /// One occluder plane a puppet, in the file's order.
    pub planes: Vec<Plane>,
    /// What the display shows as white.
    pub exposure: Exposure,
}

impl Theatre {
    /// Whether lamp and planes are where they are in `other`, with the same masks. All that a timeline can move: two instants of one scene for
    /// which this is true look the same.
    pub fn same_staging(&self, other: &Theatre) -> bool {
        let plane = |(a, b): (&Plane, &Plane)| {
            a.mask.id == b.mask.id
                && a.centre_m == b.centre_m
                && a.size_m == b.size_m
                && a.tilt_deg == b.tilt_deg
        };
        self.lamp.position_m == other.lamp.position_m
            && self.planes.len() == other.planes.len()
            && self.planes.iter().zip(&other.planes).all(plane)
    }
}

/// The rear-lit screen: the rectangle `width_m` × `height_m` in z = 0, centred on the origin.
#[derive(Clone, Debug)]
pub struct Screen {
    /// Width in metres, > 0.
    pub width_m: f64,
    /// Height in metres, > 0.
    pub height_m: f64,
    /// Diffuse albedo, each channel in [0, 1].
    pub albedo: Albedo,
}

/// Linear Rec. 709 albedo over the screen.
#[derive(Clone, Debug)]
pub enum Albedo {
    /// The same everywhere.
    Uniform([f64; 3]),
    /// Stretched over the screen, first row at +y; an image or a procedural weave, already linear.
    Image(Arc<LinearImage>),
}

/// A linear image.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearImage {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Planes of `width * height` values, row-major, first row on top: red, green and blue, or one where all pixels are grey.
    pub planes: Vec<Vec<f32>>,
}

impl LinearImage {
    /// Of `width * height` linear RGB triples.
    pub fn new(width: usize, height: usize, rgb: &[[f32; 3]]) -> Self {
        debug_assert_eq!(rgb.len(), width * height);
        let grey = rgb.iter().all(|[r, g, b]| r == g && g == b);
        let plane = |c: usize| rgb.iter().map(|pixel| pixel[c]).collect();
        Self { width, height, planes: (0..if grey { 1 } else { 3 }).map(plane).collect() }
    }

    /// Channel `c` of 3.
    pub fn channel(&self, c: usize) -> &[f32] {
        &self.planes[c.min(self.planes.len() - 1)]
    }

    /// Channel `c` at (u, v), from (0, 0) at the top left to (1, 1), interpolated between the middles of pixels; beyond them its edge goes on.
    pub fn at(&self, c: usize, u: f64, v: f64) -> f64 {
        let axis = |x: f64, n: usize| {
            let x = (x * n as f64 - 0.5).clamp(0.0, (n - 1) as f64);
            let low = (x as usize).min(n - 1);
            (low, (low + 1).min(n - 1), x - low as f64)
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (axis(u, self.width), axis(v, self.height));
        let values = self.channel(c);
        let row = |y: usize| {
            let [a, b] = [x0, x1].map(|x| f64::from(values[y * self.width + x]));
            a * (1.0 - fx) + b * fx
        };
        row(y0) * (1.0 - fy) + row(y1) * fy
    }
}

/// The bulb.
#[derive(Clone, Debug)]
pub struct Lamp {
    /// The common centre of all emitters; z < 0.
    pub position_m: DVec3,
    /// At least one.
    pub emitters: Vec<Emitter>,
}

/// A one-sided Lambertian emitter parallel to the screen and centred on the lamp's position.
#[derive(Clone, Debug)]
pub struct Emitter {
    /// Unique within the lamp; names the image channels `Vgeo.<name>` and `Virr.<name>`.
    pub name: String,
    /// Outline.
    pub shape: EmitterShape,
    /// Radiance per linear channel, ≥ 0.
    pub radiance: [f64; 3],
}

/// Outline of an emitter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmitterShape {
    /// Full side lengths along x and y, metres.
    Rectangle {
        /// [width, height], each > 0.
        size_m: [f64; 2],
    },
    /// A disk.
    Disk {
        /// Radius in metres, > 0.
        radius_m: f64,
    },
}

impl EmitterShape {
    /// Area in m².
    pub fn area_m2(&self) -> f64 {
        match *self {
            Self::Rectangle { size_m: [w, h] } => w * h,
            Self::Disk { radius_m } => std::f64::consts::PI * radius_m * radius_m,
        }
    }

    /// Half-extents of the bounding rectangle, metres.
    pub fn half_extent_m(&self) -> [f64; 2] {
        match *self {
            Self::Rectangle { size_m: [w, h] } => [0.5 * w, 0.5 * h],
            Self::Disk { radius_m } => [radius_m; 2],
        }
    }
}

/// Ambient light models.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ambient {
    /// Black where no lamp light arrives.
    None,
    /// The paper's: shadows pale with the puppet's distance D from the screen, by min(D / k_d, 1) · s.
    Paper {
        /// Distance at which the shadow has paled fully, metres, > 0.
        k_d_m: f64,
        /// Share of the lit screen's colour that a fully paled shadow has, per channel, in [0, 1].
        s: [f64; 3],
    },
    /// A uniform dome backstage, occluded by the puppets.
    Dome {
        /// Radiance per channel, ≥ 0.
        radiance: [f64; 3],
    },
}

/// What the display shows as white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// The brightest unshadowed point of the whole timeline.
    Auto,
    /// A radiance, > 0.
    White(f64),
}

/// One puppet's occluder plane: a grid of texels of constant transmittance.
///
/// A point of the plane is `centre_m + R_y(tilt_deg[1]) · R_x(tilt_deg[0]) · (u, v, 0)` with u right and v up;
/// the puppet's own rotation and pose are already in the mask. Outside the grid the transmittance is 1.
#[derive(Clone, Debug)]
pub struct Plane {
    /// The texels.
    pub mask: Arc<Mask>,
    /// The centre of the grid.
    pub centre_m: DVec3,
    /// Full size of the grid along u and v, metres, > 0.
    pub size_m: [f64; 2],
    /// Degrees about x, then about y; [0, 0] is parallel to the screen.
    pub tilt_deg: [f64; 2],
}

impl Plane {
    /// The point of the plane that is `u_m` to the right of the grid's centre and `v_m` above it.
    pub fn point_m(&self, u_m: f64, v_m: f64) -> DVec3 {
        let [(sin_x, cos_x), (sin_y, cos_y)] = self.tilt_deg.map(|deg| deg.to_radians().sin_cos());
        // R_y · R_x · (u, v, 0)
        let (y, z) = (v_m * cos_x, v_m * sin_x);
        self.centre_m + DVec3::new(u_m * cos_y + z * sin_y, y, z * cos_y - u_m * sin_y)
    }

    /// The grid's corners: top left, top right, bottom right, bottom left as the audience sees an untilted plane.
    pub fn corners_m(&self) -> [DVec3; 4] {
        let [u, v] = self.size_m.map(|s| 0.5 * s);
        [[-u, v], [u, v], [u, -v], [-u, -v]].map(|[u, v]| self.point_m(u, v))
    }
}

/// Quantised transmittance: the truth for every technique.
#[derive(Debug)]
pub struct Mask {
    /// Texels a row.
    pub width: usize,
    /// Rows; the first row is at +v.
    pub height: usize,
    /// 1 (grey: the same for R, G and B) or 3.
    pub channels: usize,
    /// `channels` planes of `width * height` texels, row-major.
    pub texels: Texels,
    /// Unique within the process for every distinct content: two masks of equal id are the same mask.
    pub id: u64,
}

/// Texel storage; transmittance τ is the code divided by the largest code.
#[derive(Debug)]
pub enum Texels {
    /// 255 lets everything through.
    U8(Vec<u8>),
    /// 65535 lets everything through.
    U16(Vec<u16>),
}

impl Mask {
    /// A mask with a fresh id. Panics when the texel count is not `width * height * channels`.
    pub fn new(width: usize, height: usize, channels: usize, texels: Texels) -> Self {
        static NEXT: std::sync::atomic::AtomicU64 = std::sync::atomic::AtomicU64::new(1);
        let len = match &texels {
            Texels::U8(t) => t.len(),
            Texels::U16(t) => t.len(),
        };
        assert!(channels == 1 || channels == 3, "a mask has 1 or 3 channels, not {channels}");
        assert_eq!(len, width * height * channels, "texel count");
        let id = NEXT.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        Self { width, height, channels, texels, id }
    }

    /// Bytes of its texels.
    pub(crate) fn bytes(&self) -> usize {
        match &self.texels {
            Texels::U8(t) => t.len(),
            Texels::U16(t) => 2 * t.len(),
        }
    }

    /// The largest code: 255 or 65535.
    pub fn max_code(&self) -> u32 {
        match self.texels {
            Texels::U8(_) => 255,
            Texels::U16(_) => 65535,
        }
    }

    /// Transmittance in [0, 1] of channel `c` (0..3; grey masks answer for all three) at column `x`, row `y`.
    pub fn transmittance(&self, c: usize, x: usize, y: usize) -> f64 {
        let i = ((c % self.channels) * self.height + y) * self.width + x;
        match &self.texels {
            Texels::U8(t) => f64::from(t[i]) / 255.0,
            Texels::U16(t) => f64::from(t[i]) / 65535.0,
        }
    }
}
