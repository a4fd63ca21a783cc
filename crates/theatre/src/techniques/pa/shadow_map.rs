//! The paper's own pipeline: each puppet is first drawn into a map of fixed resolution as the lamp's centre sees it, then
//! summed. Kept to show what exact boxes gain over it.

use std::borrow::Cow;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use kelir_scene::{Mask, Plane, Texels, Theatre};
use rayon::prelude::*;

use super::{Knobs, Variant};
use crate::project::is_tilted;

/// The theatre that tables are made of: as it is, or mapped where the knobs ask for it and every plane is upright (the plan refuses others).
pub(super) fn seen<'a>(theatre: &'a Theatre, knobs: &Knobs) -> Cow<'a, Theatre> {
    match knobs.variant {
        Variant::ShadowMap if !theatre.planes.iter().any(is_tilted) => {
            Cow::Owned(mapped(theatre, knobs.map_size as usize))
        }
        _ => Cow::Borrowed(theatre),
    }
}

/// The theatre with every plane's mask replaced by a map of `size` × `size` samples over what the lamp lights of the screen, taken at
/// their centres. Planes must be parallel to the screen, so that the lamp's view of them is affine.
fn mapped(theatre: &Theatre, size: usize) -> Theatre {
    let planes = theatre.planes.iter().map(|plane| Plane { ..map(theatre, plane, size) }).collect();
    Theatre { planes, ..theatre.clone() }
}

fn map(theatre: &Theatre, plane: &Plane, size: usize) -> Plane {
    let lamp = theatre.lamp.position_m;
    let ratio = plane.centre_m.z / lamp.z;
    let sides = DVec2::new(theatre.screen.width_m, theatre.screen.height_m) * (1.0 - ratio);
    let centre = lamp.truncate() * ratio;
    let grid = DVec2::new(plane.mask.width as f64, plane.mask.height as f64);
    let texel = |i: usize, j: usize| {
        let part = DVec2::new(i as f64 + 0.5, j as f64 + 0.5) / size as f64 - 0.5;
        let at = centre + part * sides * DVec2::new(1.0, -1.0) - plane.centre_m.truncate();
        let t = (at * DVec2::new(1.0, -1.0) / DVec2::from(plane.size_m) + 0.5) * grid;
        (t.x >= 0.0 && t.y >= 0.0 && t.x < grid.x && t.y < grid.y)
            .then(|| t.y as usize * plane.mask.width + t.x as usize)
    };
    fn sampled<T: Copy + Send + Sync>(
        texels: &[T],
        clear: T,
        area: usize,
        size: usize,
        at: impl Fn(usize, usize) -> Option<usize> + Sync,
    ) -> Vec<T> {
        let channels = texels.len() / area;
        let one = |k: usize| {
            let (c, k) = (k / (size * size), k % (size * size));
            at(k % size, k / size).map_or(clear, |t| texels[c * area + t])
        };
        (0..channels * size * size).into_par_iter().with_min_len(4096).map(one).collect()
    }
    let area = plane.mask.width * plane.mask.height;
    let texels = match &plane.mask.texels {
        Texels::U8(t) => Texels::U8(sampled(t, u8::MAX, area, size, texel)),
        Texels::U16(t) => Texels::U16(sampled(t, u16::MAX, area, size, texel)),
    };
    Plane {
        mask: Arc::new(Mask::new(size, size, plane.mask.channels, texels)),
        centre_m: DVec3::new(centre.x, centre.y, plane.centre_m.z),
        size_m: sides.into(),
        tilt_deg: [0.0; 2],
    }
}
