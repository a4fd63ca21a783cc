#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use kelir_frame::{Backend, Pixel};

use super::scenes::{figure, plane, scenes, theatre, view};
use super::twins::wrong;
use super::*;
use crate::oracle::{Point, geometric};
use crate::pa::Native;

fn on_gpu(shaders: &Shaders, knobs: Knobs) -> OnGpu {
    let gpu = kelir_frame::gpu::choose(Backend::Gpu).expect("the tests need a Vulkan adapter").unwrap();
    OnGpu::new(gpu, knobs, shaders).unwrap()
}

/// The oracle shares nothing with the GPU but the scene.
#[test]
fn gpu_agrees_with_the_oracle() {
    for pixel in [Pixel::Centre, Pixel::Area] {
        let (scene, view) = (&scenes()[0].1, view(pixel));
        let frame = on_gpu(&Shaders::default(), Knobs::default()).radiance(scene, &view).unwrap();
        let off = on_gpu(&wrong()[0], Knobs::default()).radiance(scene, &view).unwrap();
        let (mut error, mut control) = (0f64, 0f64);
        for j in (2..90).step_by(7) {
            for i in (1..160).step_by(5) {
                for e in 0..2 {
                    let truth = geometric(scene, e, Point::pixel(scene, &view, i, j), 1.0)[0];
                    let of = |f: &Frame| (f64::from(f.visibilities[e].values[j * 160 + i]) - truth).abs();
                    error = error.max(of(&frame));
                    control = control.max(of(&off));
                }
            }
        }
        assert!(error <= 2e-6, "{pixel:?}: {error:e}");
        assert!(control > 1e-2);
    }
}

/// Without puppets, or with one beside the beam, the lit screen is drawn.
#[test]
fn gpu_draws_an_empty_stage() {
    let view = view(Pixel::Area);
    let beside = plane(figure(40, 64, 1, 255), [40.0, 0.0, -0.2]);
    for planes in [vec![], vec![beside]] {
        let scene = theatre(planes, Ambient::None, [[2000.0; 3], [40.0; 3]]);
        let drawn = on_gpu(&Shaders::default(), Knobs::default()).radiance(&scene, &view).unwrap();
        assert_eq!(drawn.radiance, Native::new(Knobs::default()).radiance(&scene, &view).unwrap().radiance);
    }
}

/// Batches of tiles and pieces, as large images and many pieces need, change no bit; nor does drawing a second time from what was kept.
#[test]
fn batches_change_nothing() {
    let (scene, view) = (&scenes()[3].1, view(Pixel::Area));
    let mut whole = on_gpu(&Shaders::default(), Knobs::default());
    let mut batched = on_gpu(&Shaders::default(), Knobs::default());
    batched.most = [17, 32];
    let one = whole.radiance(scene, &view).unwrap();
    let many = batched.radiance(scene, &view).unwrap();
    assert!(one.stats.counts["batches"] == 1 && many.stats.counts["batches"] > 1);
    assert_eq!(one.radiance, many.radiance);
    let again = whole.radiance(scene, &view).unwrap();
    assert_eq!(one.radiance, again.radiance);
    assert_eq!((again.stats.counts["tables_built"], again.stats.counts["background_reused"]), (0, 1));
}

#[test]
fn structs_are_laid_out_as_the_shaders_expect() {
    use super::passes::{RowsParams, ShadeParams, SlopeParams, VisibilityParams};
    use super::tables::TableParams;
    use crate::shaders::same_layout;
    let s = Shaders::default();
    same_layout!(&s.table, "Params", TableParams { width, height, max_code, quads });
    same_layout!(&s.rows, "Params", RowsParams { blocks, width, height, shift });
    same_layout!(
        &s.visibility,
        "Params",
        VisibilityParams {
            tiles,
            pieces,
            lookups,
            bounds,
            stride,
            count,
            channel,
            right,
            plane,
            shares,
            shares_end,
            shares_step,
            rest,
            unused_x,
            unused_y,
            unused_z,
        }
    );
    same_layout!(
        &s.tilted,
        "Params",
        SlopeParams {
            tiles,
            count,
            maps,
            width,
            height,
            sub_x,
            sub_y,
            norm,
            along_x,
            along_y,
            unused_x,
            unused_y,
        }
    );
    same_layout!(
        &s.shade,
        "Params",
        ShadeParams {
            tiles,
            stride,
            count,
            right,
            bottom,
            channel,
            distances,
            domes,
            scale,
            k_d,
            unused_x,
            unused_y,
            s,
            dome,
        }
    );
}

/// What stands in WGSL and in Rust is the same.
#[test]
fn constants_are_those_of_the_shaders() {
    use crate::shaders::same_constants;
    use kelir_frame::encode::LOWEST;
    use words::ROW;
    use work::{ACROSS, BLOCK, SHELF};
    same_constants!(include_str!("../shade.wgsl"), { "ACROSS": ACROSS, "LOWEST": LOWEST, "ROW": ROW });
    same_constants!(include_str!("../visibility.wgsl"), { "ACROSS": ACROSS, "BLOCK": BLOCK, "ROW": ROW, "SHELF": SHELF });
    same_constants!(include_str!("../rows.wgsl"), { "BLOCK": BLOCK, "ROW": ROW, "SHELF": SHELF });
    same_constants!(include_str!("../tilted.wgsl"), { "ACROSS": ACROSS, "ROW": ROW });
    same_constants!(include_str!("../table.wgsl"), { "workgroup_size": tables::WORKGROUP });
}
