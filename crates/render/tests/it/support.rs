//! Theatres that the tests draw.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use glam::DVec3;
use kelir_scene::{
    Albedo, Ambient, Emitter, EmitterShape, Exposure, Lamp, Mask, Masks, Plane, Scene, Screen, Texels,
    Theatre,
};

/// A scene that ships: its name, the theatre as written, and one later instant of its timeline.
pub(crate) struct Shipped {
    pub name: String,
    pub sha256: String,
    pub still: Theatre,
    pub later: Option<Theatre>,
}

/// Every scene that ships, read once.
pub(crate) fn shipped() -> &'static [Shipped] {
    static SCENES: OnceLock<Vec<Shipped>> = OnceLock::new();
    SCENES.get_or_init(|| {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../stimuli/scenes");
        let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
        paths.retain(|p| p.extension().is_some_and(|e| e == "toml"));
        paths.sort();
        let read = |path: &PathBuf| {
            let scene = Scene::from_path(path).unwrap_or_else(|errors| panic!("{errors}"));
            let seconds = scene.timeline().map(|t| t.seconds);
            Shipped {
                name: path.file_stem().unwrap().to_str().unwrap().to_owned(),
                sha256: scene.sha256().to_owned(),
                still: scene.still(),
                later: seconds.map(|s| scene.theatre_at(0.4 * s, &mut Masks::default())),
            }
        };
        paths.iter().map(read).collect()
    })
}

/// A figure with soft edges and holes at texel pitch.
pub(crate) fn figure(side: usize, channels: usize) -> Mask {
    let n = side as f64;
    let texel = |c: usize, x: usize, y: usize| {
        let (u, v) = (x as f64 / n - 0.45, y as f64 / n - 0.5);
        let r = (u * u * 1.7 + v * v).sqrt() + 0.05 * (9.0 * u + 3.0 * c as f64).sin();
        let holes = if (x / 2 + y / 3).is_multiple_of(5) && u > 0.05 { 0.6 } else { 0.0 };
        (255.0 * ((r - 0.35) * n / 3.0).clamp(0.0, 1.0).max(holes)).round() as u8
    };
    let texels =
        (0..channels).flat_map(|c| (0..side).flat_map(move |y| (0..side).map(move |x| texel(c, x, y))));
    Mask::new(side, side, channels, Texels::U8(texels.collect()))
}

/// A square puppet.
pub(crate) fn plane(mask: Mask, centre_m: [f64; 3], height_m: f64) -> Plane {
    Plane { mask: Arc::new(mask), centre_m: DVec3::from(centre_m), size_m: [height_m; 2], tilt_deg: [0.0; 2] }
}

/// Two emitters before a coloured screen.
pub(crate) fn theatre(planes: Vec<Plane>) -> Theatre {
    let emitter = |name: &str, side: f64, radiance: f64| Emitter {
        name: name.into(),
        shape: EmitterShape::Rectangle { size_m: [side, 0.8 * side] },
        radiance: [radiance; 3],
    };
    Theatre {
        screen: Screen { width_m: 1.6, height_m: 0.9, albedo: Albedo::Uniform([0.8, 0.7, 0.6]) },
        lamp: Lamp {
            position_m: DVec3::new(0.05, -0.03, -1.5),
            emitters: vec![emitter("inner", 0.02, 2000.0), emitter("outer", 0.1, 40.0)],
        },
        ambient: Ambient::None,
        planes,
        exposure: Exposure::Auto,
    }
}
