//! What valid scenes become.

use crate::support::{SCENE, files, parse, png, rows};
use kelir_scene::{Albedo, Ambient, EmitterShape, Exposure, Texels};

#[test]
fn a_scene_is_read_as_written() {
    let theatre = parse(SCENE, &files()).unwrap().still();
    assert_eq!((theatre.screen.width_m, theatre.screen.height_m), (1.6, 0.9));
    assert!(matches!(theatre.screen.albedo, Albedo::Uniform([r, g, b]) if [r, g, b] == [0.8; 3]));
    assert_eq!(theatre.lamp.position_m.to_array(), [0.0, 0.0, -1.5]);
    let names: Vec<_> = theatre.lamp.emitters.iter().map(|e| e.name.as_str()).collect();
    assert_eq!(names, ["inner", "outer"]);
    assert_eq!(theatre.lamp.emitters[0].shape, EmitterShape::Rectangle { size_m: [0.02, 0.02] });
    assert_eq!(theatre.lamp.emitters[0].radiance, [2000.0; 3]);
    assert_eq!(theatre.lamp.emitters[1].radiance, [40.0, 40.0, 30.5]);
    assert_eq!(theatre.ambient, Ambient::None);
    assert_eq!(theatre.exposure, Exposure::Auto);
    let plane = &theatre.planes[0];
    assert_eq!((plane.mask.width, plane.mask.height, plane.mask.channels), (128, 128, 1));
    assert_eq!(plane.centre_m.to_array(), [0.0, 0.0, -0.2]);
    assert!((plane.size_m[0] - 0.6).abs() < 1e-12 && (plane.size_m[1] - 0.6).abs() < 1e-12);
}

#[test]
fn a_figure_at_rest_is_drawn_texel_by_texel() {
    let theatre = parse(SCENE, &files()).unwrap().still();
    let inside = |x: usize, y: usize| {
        let within = |x0, y0, x1, y1| (x0..x1).contains(&x) && (y0..y1).contains(&y);
        within(32, 32, 96, 96) || within(60, 60, 116, 68) || within(108, 56, 124, 72)
    };
    for (y, row) in rows(&theatre.planes[0].mask, 0).iter().enumerate() {
        for (x, &code) in row.iter().enumerate() {
            assert_eq!(code, if inside(x, y) { 0 } else { 255 }, "texel ({x}, {y})");
        }
    }
}

#[test]
fn a_png_keeps_its_own_texels() {
    let mut files = files();
    files.insert("puppets/p.png".into(), png(5, 4, |x, y| [200, 100, 0, (x * 50 + y) as u8]));
    let scene = SCENE.replace("figure.toml", "p.png").replace("texels = 128", "");
    let theatre = parse(&scene, &files).unwrap().still();
    let mask = &theatre.planes[0].mask;
    assert_eq!((mask.width, mask.height, mask.channels), (5, 4, 1));
    for (y, row) in rows(mask, 0).iter().enumerate() {
        for (x, &code) in row.iter().enumerate() {
            assert_eq!(code, 255 - (x * 50 + y) as u32);
        }
    }
    assert!((theatre.planes[0].size_m[0] - 0.6 / 4.0 * 5.0).abs() < 1e-12);
}

#[test]
fn translucent_transmittance_is_one_minus_alpha_times_one_minus_colour() {
    let mut files = files();
    // sRGB 188 is linear 0.502886 (IEC 61966-2-1: ((188/255 + 0.055) / 1.055)^2.4).
    files.insert("puppets/p.png".into(), png(2, 1, |x, _| [255, 188, 0, if x == 0 { 255 } else { 51 }]));
    let scene =
        SCENE.replace("figure.toml", "p.png").replace("texels = 128", "translucent = true\nbits = 16");
    let theatre = parse(&scene, &files).unwrap().still();
    let mask = &theatre.planes[0].mask;
    assert!(matches!(mask.texels, Texels::U16(_)));
    let expected = [[1.0, 0.502886, 0.0], [1.0, 1.0 - 0.2 * (1.0 - 0.502886), 0.8]];
    for (x, expected) in expected.iter().enumerate() {
        for (c, expected) in expected.iter().enumerate() {
            let found = mask.transmittance(c, x, 0);
            assert!((found - expected).abs() < 1e-5, "texel {x} channel {c}: {found} for {expected}");
        }
    }
}
