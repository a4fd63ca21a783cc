//! The stress cases, as data.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use kelir_frame::Pixel;
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Plane, Screen, Texels, Theatre,
};

/// What a mask shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// A body with soft edges and holes of a few texels; not symmetric in any way.
    Figure,
    /// Opaque and clear texels by turns: nothing is finer.
    Checkerboard,
    /// Opaque left of the middle.
    HalfPlane,
    /// Everything opaque.
    Opaque,
    /// Everything clear.
    Clear,
}

/// One theatre: a puppet before a lamp.
#[derive(Clone, Debug)]
pub struct Case {
    /// What is stressed.
    pub name: String,
    /// What the mask shows.
    pub pattern: Pattern,
    /// Texels a side.
    pub side: usize,
    /// 8 or 16 bits a texel.
    pub bits: u32,
    /// Emitters: full sides, metres, and radiance.
    pub emitters: Vec<([f64; 2], f64)>,
    /// The lamp's centre, metres.
    pub lamp_m: [f64; 3],
    /// The puppet's distance behind the screen, metres.
    pub distance_m: f64,
    /// How far beside the line from the screen's middle to the lamp the puppet hangs, metres.
    pub aside_m: [f64; 2],
    /// The puppet's height, metres; it is square.
    pub height_m: f64,
    /// Degrees about x, then y.
    pub tilt_deg: [f64; 2],
    /// The screen, metres.
    pub screen_m: [f64; 2],
    /// Pixel rule.
    pub pixel: Pixel,
}

impl Case {
    fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            pattern: Pattern::Figure,
            side: 512,
            bits: 8,
            emitters: vec![([0.05, 0.04], 40.0)],
            lamp_m: [0.05, -0.03, -1.5],
            distance_m: 0.4,
            aside_m: [0.031, 0.017],
            height_m: 0.6,
            tilt_deg: [0.0; 2],
            screen_m: [1.6, 0.9],
            pixel: Pixel::Centre,
        }
    }

    /// Whether PA's boxes are exact for it: the puppet hangs parallel to the screen.
    pub fn is_parallel(&self) -> bool {
        self.tilt_deg == [0.0; 2]
    }

    /// The theatre; its white is found from it, its albedo is 1.
    pub fn theatre(&self) -> Theatre {
        let lamp = DVec3::from(self.lamp_m);
        let ratio = -self.distance_m / lamp.z;
        let centre = lamp.truncate() * ratio + DVec2::from(self.aside_m);
        let emitter = |(k, (size_m, radiance)): (usize, &([f64; 2], f64))| Emitter {
            name: format!("{k}"),
            shape: EmitterShape::Rectangle { size_m: *size_m },
            radiance: [*radiance; 3],
        };
        Theatre {
            screen: Screen {
                width_m: self.screen_m[0],
                height_m: self.screen_m[1],
                albedo: Albedo::Uniform([1.0; 3]),
            },
            lamp: Lamp {
                position_m: lamp,
                emitters: self.emitters.iter().enumerate().map(emitter).collect(),
            },
            ambient: Ambient::None,
            planes: vec![Plane {
                mask: Arc::new(mask(self.pattern, self.side, self.bits)),
                centre_m: centre.extend(-self.distance_m),
                size_m: [self.height_m; 2],
                tilt_deg: self.tilt_deg,
            }],
            exposure: Exposure::Auto,
        }
    }
}

/// A square grey mask of `side` texels in 8 or 16 bits.
pub(super) fn mask(pattern: Pattern, side: usize, bits: u32) -> Mask {
    let n = side as f64;
    let figure = |x: usize, y: usize| {
        let (u, v) = (x as f64 / n - 0.45, y as f64 / n - 0.5);
        let r = (u * u * 1.7 + v * v).sqrt() + 0.05 * (9.0 * u).sin();
        let holes = if (x / 2 + y / 3).is_multiple_of(5) && u > 0.05 { 0.6 } else { 0.0 };
        ((r - 0.35) * n / 3.0).clamp(0.0, 1.0f64).max(holes)
    };
    let through = |k: usize| {
        let (x, y) = (k % side, k / side);
        match pattern {
            Pattern::Figure => figure(x, y),
            Pattern::Checkerboard => f64::from((x + y) as u32 % 2),
            Pattern::HalfPlane => f64::from(u32::from(2 * x >= side)),
            Pattern::Opaque => 0.0,
            Pattern::Clear => 1.0,
        }
    };
    let codes = (0..side * side).map(through);
    let texels = match bits {
        16 => Texels::U16(codes.map(|t| (65535.0 * t).round() as u16).collect()),
        _ => Texels::U8(codes.map(|t| (255.0 * t).round() as u8).collect()),
    };
    Mask::new(side, side, 1, texels)
}

/// A case with nothing stressed.
pub(super) fn plain() -> Case {
    Case::new("plain")
}

/// Every case whose mask has at most `most` texels a side; parallel ones with both pixel rules.
pub fn cases(most: usize) -> Vec<Case> {
    let mut all = Vec::new();
    for side in [64, 256, 1024, 4096, 8192] {
        all.push(Case { side, ..Case::new(format!("mask of {side}²")) });
        all.push(Case { side, bits: 16, ..Case::new(format!("mask of {side}², 16 bits")) });
    }
    for (side, bits) in [(1024, 16), (8192, 8), (8192, 16)] {
        let case = Case {
            side,
            bits,
            distance_m: 1.2,
            emitters: vec![([0.3, 0.3], 40.0)],
            height_m: 0.3,
            ..Case::new(format!("box of more than 2³², {side}², {bits} bits"))
        };
        all.push(case);
    }
    for side_m in [1e-6, 1e-4, 1e-2, 0.1, 1.0] {
        let emitters = vec![([side_m, 0.8 * side_m], 40.0)];
        all.push(Case { emitters, ..Case::new(format!("emitter of {side_m:e} m")) });
    }
    for (distance_m, place) in [
        (1e-4, "0.1 mm off the screen"),
        (0.01, "10 mm off the screen"),
        (0.75, "halfway"),
        (1.49, "10 mm off the lamp"),
        (1.4999, "0.1 mm off the lamp"),
    ] {
        all.push(Case { distance_m, ..Case::new(format!("puppet {place}")) });
        for side_m in [1e-6, 1.0] {
            let emitters = vec![([side_m; 2], 40.0)];
            all.push(Case {
                distance_m,
                emitters,
                ..Case::new(format!("puppet {place}, emitter {side_m:e} m"))
            });
        }
    }
    for x in [3.0, 100.0, 1000.0] {
        all.push(Case { lamp_m: [x, -0.3 * x, -1.5], ..Case::new(format!("lamp {x} m off axis")) });
    }
    for (emitter, what) in [(1e-6, "tiny"), (0.0044, "about a texel's"), (0.1, "many texels'")] {
        for side in [255, 1024, 8192] {
            // The middle pixel sees a grid line of even masks exactly: its box is cut in halves, however small.
            let case = Case {
                pattern: Pattern::Checkerboard,
                side,
                emitters: vec![([emitter; 2], 40.0)],
                lamp_m: [0.0, 0.0, -1.5],
                aside_m: [0.0; 2],
                ..Case::new(format!("checkerboard of {side}², {what} box"))
            };
            all.push(case);
        }
    }
    for side_m in [1e-6, 0.1] {
        let case = Case {
            pattern: Pattern::HalfPlane,
            emitters: vec![([side_m; 2], 40.0)],
            lamp_m: [0.0, 0.0, -1.5],
            aside_m: [0.0; 2],
            height_m: 2.5,
            ..Case::new(format!("half-plane on the axis, emitter {side_m:e} m"))
        };
        all.push(case);
    }
    for side in [64, 512, 8192] {
        for (pattern, what) in [(Pattern::Opaque, "opaque"), (Pattern::Clear, "clear")] {
            all.push(Case { pattern, side, height_m: 0.6, ..Case::new(format!("all {what}, {side}²")) });
            all.push(Case {
                pattern,
                side,
                height_m: 3.0,
                ..Case::new(format!("all {what}, {side}², beyond the screen"))
            });
        }
    }
    all.push(Case { lamp_m: [1e4, -1e4, -1.5], ..Case::new("lamp 1e4 m off axis, puppet 2.7e3 m") });
    all.push(Case {
        screen_m: [1.6e4, 0.9e4],
        lamp_m: [0.05e4, -0.03e4, -1.5e4],
        distance_m: 0.4e4,
        aside_m: [0.031e4, 0.017e4],
        height_m: 0.6e4,
        emitters: vec![([0.05e4, 0.04e4], 40.0)],
        ..Case::new("everything 1e4 times as large")
    });
    for (radiance, other) in [(1e-6, 1e-6), (1e6, 1e6), (1e-6, 1e6), (1e6, 1e-6)] {
        let emitters = vec![([0.02, 0.015], radiance), ([0.1, 0.12], other)];
        all.push(Case { emitters, ..Case::new(format!("radiance {radiance:e} beside {other:e}")) });
    }
    let both = all.into_iter().flat_map(|case| {
        let area = Case { pixel: Pixel::Area, name: format!("{}, area", case.name), ..case.clone() };
        [case, area]
    });
    let mut all: Vec<Case> = both.collect();
    for degrees in [30.0, 60.0, 80.0, 89.0, 89.9] {
        let case = Case {
            tilt_deg: [0.0, degrees],
            side: 64,
            distance_m: 0.75,
            emitters: vec![([0.1, 0.1], 40.0)],
            ..Case::new(format!("tilted by {degrees}°"))
        };
        all.push(case);
    }
    all.retain(|case| case.side <= most);
    all
}
