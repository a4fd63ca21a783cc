//! What is white on a stage, and where its penumbrae are: asked of the ray tracer.

use kelir_frame::{Pixel, View};
use kelir_scene::Exposure;
use kelir_scene::stage::Stage;

use crate::raytrace;

/// Columns of the picture that white is looked for in, so that it does not depend on the size of a drawing.
const COLUMNS: usize = 192;

/// Samples a pixel and light there.
const SAMPLES: usize = 64;

/// The radiance shown as white: what the first of these says, or the brightest surface that any of them shows without shadows. Lamps and
/// environments that are seen themselves don't count: they may well be brighter than white. 1 where nothing is lit.
pub fn white(all: &[Stage]) -> f64 {
    if let Some(Exposure::White(white)) = all.first().map(|stage| stage.exposure) {
        return white;
    }
    let brightest = all.iter().map(brightest).fold(0.0, f64::max);
    if brightest > 0.0 { brightest } else { 1.0 }
}

fn brightest(stage: &Stage) -> f64 {
    let rows = (COLUMNS as f64 / stage.camera.aspect).round().max(1.0) as usize;
    let view = View { size: [COLUMNS, rows], pixel: Pixel::Centre, skip: true };
    raytrace::surfaces(&unshadowed(stage), &view, SAMPLES).into_iter().flatten().fold(0.0, f64::max)
}

/// Whether a pixel's middle is in penumbra: of the light of lamps that are no points some arrives, and not all.
pub fn penumbra(stage: &Stage, view: &View) -> Vec<bool> {
    let mut soft = stage.clone();
    soft.lights.retain(|light| light.kind.is_soft());
    soft.ambient = [0.0; 3];
    let view = View { pixel: Pixel::Centre, ..*view };
    if soft.lights.is_empty() {
        return vec![false; view.size[0] * view.size[1]];
    }
    // The same samples: where nothing is in the way both are the same numbers.
    let with = raytrace::surfaces(&soft, &view, SAMPLES);
    let without = raytrace::surfaces(&unshadowed(&soft), &view, SAMPLES);
    with.iter().zip(&without).map(|(some, all)| (0..3).any(|c| some[c] > 0.0 && some[c] < all[c])).collect()
}

/// The stage with nothing that stands in the light's way.
fn unshadowed(stage: &Stage) -> Stage {
    let mut stage = stage.clone();
    stage.objects.iter_mut().for_each(|object| object.casts = false);
    stage
}

#[cfg(test)]
mod tests {
    use kelir_scene::stage::*;

    use super::*;
    use crate::raytrace::tests::*;

    fn lamp(radiance: f64) -> LightKind {
        LightKind::Area {
            pose: overhead(1.0),
            shape: AreaShape::Rectangle { size_m: [0.2; 2] },
            radiance: [radiance, 0.5 * radiance, 0.0],
        }
    }

    fn card() -> Object {
        let mut card = object("card", Form::Rectangle { size_m: [0.1; 2] }, glam::DVec3::new(0.0, 0.5, 0.0));
        card.pose.rotation = glam::DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2);
        card
    }

    #[test]
    fn white_is_the_brightest_surface_without_shadows() {
        let mut bare = stage(vec![floor()], vec![lamp(3.0)]);
        bare.camera.pose.position_m.y = 0.8;
        let white_of = |stage: &Stage| white(std::slice::from_ref(stage));
        // Under the middle of the lamp, of which the closed form is Lambert's.
        let corner = |a: f64, b: f64| a / (1.0f64 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        let right = 3.0 * 4.0 * 0.5 * 2.0 * corner(0.1, 0.1) / std::f64::consts::PI;
        assert!((white_of(&bare) / right - 1.0).abs() < 0.01, "{} {right}", white_of(&bare));
        // A card shades the brightest point, and is nearer to the lamp and brighter itself.
        let mut shaded = bare.clone();
        shaded.objects.push(card());
        assert!(white_of(&shaded) > 3.0 * right);
        // What is seen of a lamp does not count, what is written does.
        let mut seen = bare.clone();
        seen.lights.push(Light { name: "other".into(), kind: lamp(0.0) });
        assert_eq!(white_of(&seen), white_of(&bare));
        seen.exposure = Exposure::White(7.0);
        assert_eq!(white_of(&seen), 7.0);
        bare.lights.clear();
        assert_eq!(white_of(&bare), 1.0);
    }

    #[test]
    fn a_penumbra_is_where_some_of_a_lamp_is_seen() {
        let mut scene = stage(vec![floor(), card()], vec![lamp(1.0), point([3.0, 3.0, 0.0], 1.0)]);
        scene.camera.pose.position_m.y = 0.4;
        let view = View { size: [33, 33], ..VIEW };
        let found = penumbra(&scene, &view);
        for (k, found) in found.iter().enumerate() {
            let p = middle(view, k, 1.0);
            // From p the card covers [−0.1 − p, 0.1 − p] of the lamp's [−0.1, 0.1] along each axis.
            let covered = |p: f64| ((0.1 - p).min(0.1) - (-0.1 - p).max(-0.1)).max(0.0) / 0.2;
            let share = covered(p.x) * covered(p.z);
            // What 64 samples could miss is not asked for.
            if (0.15..=0.85).contains(&share) {
                assert!(found, "{k}: {share}");
            }
            if share == 0.0 {
                assert!(!found, "{k}");
            }
        }
        scene.lights.remove(0);
        assert!(penumbra(&scene, &view).iter().all(|found| !found), "a point has no penumbra");
    }
}
