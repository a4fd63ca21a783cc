//! Poses and rotations against what geometry says.

use std::sync::Arc;

use crate::support::{SCENE, files, parse, rows};
use kelir_scene::{Masks, Plane, Scene, Theatre};

/// The scene with `lines` in its puppet.
fn posed(lines: &str) -> Plane {
    let scene = SCENE.replace("texels = 128", &format!("texels = 128\nbits = 16\n{lines}"));
    parse(&scene, &files()).unwrap().still().planes.remove(0)
}

/// A figure whose only part is a bar that reaches from `pivot` to the right, and its scene with `lines`.
fn bar(lines: &str) -> Plane {
    let mut files = files();
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 128 128">
        <g id="bar"><rect x="60" y="50" width="56" height="12"/></g></svg>"#;
    let manifest = "image = \"bar.svg\"\n[[parts]]\nid = \"bar\"\npivot = [60, 56]\n";
    files.insert("puppets/bar.svg".into(), svg.into());
    files.insert("puppets/bar.toml".into(), manifest.into());
    let scene = SCENE
        .replace("figure.toml", "bar.toml")
        .replace("texels = 128", &format!("texels = 128\nbits = 16\n{lines}"));
    parse(&scene, &files).unwrap().still().planes.remove(0)
}

/// Opacity at every texel centre, with the centre's position (u right, v up, in texels) from the figure's centre.
fn opacities(plane: &Plane) -> Vec<([f64; 2], f64)> {
    let texel_m = 0.6 / 128.0;
    let [offset_u, offset_v] = [plane.centre_m.x / texel_m, plane.centre_m.y / texel_m];
    let (w, h) = (plane.mask.width as f64, plane.mask.height as f64);
    let mut all = Vec::new();
    for y in 0..plane.mask.height {
        for x in 0..plane.mask.width {
            let at = [x as f64 + 0.5 - 0.5 * w + offset_u, 0.5 * h - y as f64 - 0.5 + offset_v];
            all.push((at, 1.0 - plane.mask.transmittance(0, x, y)));
        }
    }
    all
}

/// How far `p` lies outside a rectangle of size `w` × `h` whose left edge's middle is at `pivot`, turned by `degrees`
/// counter-clockwise (u right, v up); negative inside.
fn outside(p: [f64; 2], pivot: [f64; 2], [w, h]: [f64; 2], degrees: f64) -> f64 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let d = [p[0] - pivot[0], p[1] - pivot[1]];
    let along = d[0] * cos + d[1] * sin;
    let across = -d[0] * sin + d[1] * cos;
    (along - 0.5 * w).abs().max(across.abs() + 0.5 * w - 0.5 * h) - 0.5 * w
}

/// Worst disagreement with the turned rectangle at texels well inside or outside, and the area's and centroid's errors.
fn errors(plane: &Plane, degrees: f64) -> [f64; 3] {
    let (pivot, size) = ([-4.0, 8.0], [56.0, 12.0]);
    let mut worst: f64 = 0.0;
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for (at, opacity) in opacities(plane) {
        let d = outside(at, pivot, size, degrees);
        // Bilinear interpolation reaches √2 texels at the utmost.
        if d.abs() > 1.45 {
            worst = worst.max((opacity - if d < 0.0 { 1.0 } else { 0.0 }).abs());
        }
        area += opacity;
        moment = [moment[0] + opacity * at[0], moment[1] + opacity * at[1]];
    }
    let (sin, cos) = degrees.to_radians().sin_cos();
    let centroid = [pivot[0] + 28.0 * cos, pivot[1] + 28.0 * sin];
    let off = (moment[0] / area - centroid[0]).hypot(moment[1] / area - centroid[1]);
    [worst, (area / (56.0 * 12.0) - 1.0).abs(), off]
}

#[test]
fn a_posed_bar_is_the_turned_rectangle() {
    for degrees in [10.0, 37.5, 90.0, 135.0, 180.0, -61.0, 270.0, 359.0] {
        let plane = bar(&format!("pose = {{ bar = {degrees} }}"));
        let [worst, area, centroid] = errors(&plane, degrees);
        assert!(worst < 1e-4 && area < 2e-3 && centroid < 0.02, "{degrees}°: {worst} {area} {centroid}");
        // Control: one degree more, or the other sense, is noticed.
        let [_, _, centroid] = errors(&plane, degrees + 1.0);
        assert!(centroid > 0.4, "{degrees}°: one degree off is a centroid {centroid} off");
        if degrees % 180.0 != 0.0 {
            assert!(errors(&plane, -degrees)[0] > 0.9, "{degrees}°: the other sense is noticed");
        }
    }
}

#[test]
fn a_turn_is_counter_clockwise_as_the_audience_sees_it() {
    // The bar points right (+x); a quarter turn has it point up (+y, smaller rows).
    let up = bar("pose = { bar = 90.0 }");
    let centre_of_mass = |plane: &Plane| {
        let all = opacities(plane);
        let area: f64 = all.iter().map(|(_, o)| o).sum();
        all.iter().fold([0.0; 2], |m, (at, o)| [m[0] + at[0] * o / area, m[1] + at[1] * o / area])
    };
    let [u, v] = centre_of_mass(&up);
    assert!((u + 4.0).abs() < 0.01 && (v - 36.0).abs() < 0.01, "({u}, {v})");
    // The whole figure turns about its centre: the bar's middle (24, 8) goes to (−8, 24).
    let [u, v] = centre_of_mass(&bar("rotate_deg = 90.0"));
    assert!((u + 8.0).abs() < 0.01 && (v - 24.0).abs() < 0.01, "({u}, {v})");
}

#[test]
fn the_identity_is_an_exact_copy_and_quarter_turns_permute_texels() {
    let rest = rows(&posed("").mask, 0);
    assert_eq!(rows(&posed("rotate_deg = 360.0").mask, 0), rest);
    assert_eq!(rows(&posed("pose = { bar = 0.0, leaf = 360.0 }").mask, 0), rest);
    // Control: a turn that small is no identity.
    assert_ne!(rows(&posed("rotate_deg = 0.5").mask, 0), rest);
    // Upside down: the body is symmetric, and every row and column is reversed.
    let turned = posed("rotate_deg = 180.0");
    let (w, h) = (turned.mask.width, turned.mask.height);
    let codes = rows(&turned.mask, 0);
    let texel = 0.6 / 128.0;
    let left = (turned.centre_m.x / texel - 0.5 * w as f64 + 64.0).round() as usize;
    let top = (64.0 - turned.centre_m.y / texel - 0.5 * h as f64).round() as usize;
    for y in 0..h {
        for x in 0..w {
            assert_eq!(codes[y][x], rest[127 - y - top][127 - x - left], "({x}, {y})");
        }
    }
}

#[test]
fn children_follow_their_parents() {
    // The leaf's centre (116, 64) is 52 to the right of the bar's pivot, the body's centre; posed by 90° it is 52 above.
    let plane = posed("pose = { bar = 90.0 }");
    let all = opacities(&plane);
    let at = |u: f64, v: f64| all.iter().find(|(at, _)| *at == [u, v]).map(|(_, o)| *o);
    assert_eq!(at(-0.5, 52.5), Some(1.0), "the leaf is above");
    assert_eq!(at(7.5, 52.5), Some(1.0), "with its full width");
    assert_eq!(at(52.5, 0.5), Some(0.0), "and no longer to the right");
    // The leaf turned back by 90° about (112, 64), 48 along the bar, reaches from 44 to 52 … sideways and up again.
    let plane = posed("pose = { bar = 90.0, leaf = -90.0 }");
    let all = opacities(&plane);
    let at = |u: f64, v: f64| all.iter().find(|(at, _)| *at == [u, v]).map(|(_, o)| *o);
    assert_eq!(at(11.5, 48.5), Some(1.0), "the leaf points right from (0, 48)");
    assert_eq!(at(11.5, 57.5), Some(0.0));
}

#[test]
fn the_grid_grows_so_that_nothing_is_cut() {
    // Turned by 180° about (60, 56), the bar reaches from 4 to 60; by 90° from row 0 to 56; by 135° beyond no edge.
    // A part that is turned out of the view box makes the grid larger.
    let mut files = files();
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 128 128">
        <g id="bar"><rect x="10" y="50" width="100" height="12"/></g></svg>"#;
    let manifest = "image = \"bar.svg\"\n[[parts]]\nid = \"bar\"\npivot = [10, 56]\n";
    files.insert("puppets/bar.svg".into(), svg.into());
    files.insert("puppets/bar.toml".into(), manifest.into());
    let scene = |deg| {
        let lines = format!("texels = 128\nbits = 16\npose = {{ bar = {deg} }}");
        SCENE.replace("figure.toml", "bar.toml").replace("texels = 128", &lines)
    };
    let plane = parse(&scene(150.0), &files).unwrap().still().planes.remove(0);
    assert!(plane.mask.width > 128 && plane.mask.height >= 128);
    let area: f64 = opacities(&plane).iter().map(|(_, o)| o).sum();
    assert!((area / 1200.0 - 1.0).abs() < 2e-3, "{area}");
    let texel = 0.6 / 128.0;
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    assert!(near(plane.size_m[0], plane.mask.width as f64 * texel) && near(plane.size_m[1], 128.0 * texel));
    // The right edge stayed where it was.
    assert!(near(plane.centre_m.x + 0.5 * plane.size_m[0], 0.3));
}

#[test]
fn overlapping_parts_multiply() {
    let mut files = files();
    let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 64 64">
        <g id="a"><rect width="48" height="64" fill="#000" opacity="0.6"/></g>
        <g id="b"><rect x="16" width="48" height="64" fill="#bc0000"/></g></svg>"##;
    let manifest = "image = \"two.svg\"\n[[parts]]\nid = \"a\"\n[[parts]]\nid = \"b\"\n";
    files.insert("puppets/two.svg".into(), svg.into());
    files.insert("puppets/two.toml".into(), manifest.into());
    let scene = SCENE
        .replace("figure.toml", "two.toml")
        .replace("texels = 128", "texels = 64\nbits = 16\ntranslucent = true");
    let mask = parse(&scene, &files).unwrap().still().planes.remove(0).mask;
    assert_eq!(mask.channels, 3);
    let tau = |c, x| mask.transmittance(c, x, 30);
    // a lets 0.4 of everything through, b only red: sRGB 188 is linear 0.502886.
    let near = |found: f64, expected: f64| (found - expected).abs() < 2e-5;
    assert!(near(tau(0, 8), 0.4) && near(tau(1, 8), 0.4), "a alone: {}", tau(0, 8));
    assert!(near(tau(0, 56), 0.502886) && near(tau(1, 56), 0.0), "b alone: {}", tau(0, 56));
    assert!(near(tau(0, 32), 0.4 * 0.502886) && near(tau(2, 32), 0.0), "both: {}", tau(0, 32));
    // Control: ordinary "over" compositing would not have given that.
    assert!(!near(tau(0, 32), 0.502886));
}

const MOVING: &str = r#"
[timeline]
fps = 10
seconds = 2.0
loop = true
[[timeline.tracks]]
target = "puppets[0].pose.bar"
keys = [ { t = 0.0, value = 0.0 }, { t = 1.0, value = 40.0 }, { t = 2.0, value = 0.0 } ]
[[timeline.tracks]]
target = "puppets[0].position_m"
easing = "smooth"
keys = [ { t = 0.5, value = [0.0, 0.0, -0.2] }, { t = 1.5, value = [0.4, 0.0, -0.3] } ]
[[timeline.tracks]]
target = "lamp.position_m"
easing = "step"
keys = [ { t = 0.0, value = [0.0, 0.0, -1.5] }, { t = 1.0, value = [0.1, 0.0, -1.5] } ]
"#;

/// The scene at an instant, for whom keeps no masks.
fn at(scene: &Scene, time_s: f64) -> Theatre {
    scene.theatre_at(time_s, &mut Masks::default())
}

fn moving(lines: &str) -> Scene {
    let scene = SCENE.replace("texels = 128", &format!("texels = 128\n{lines}"));
    parse(&format!("{scene}{MOVING}"), &files()).unwrap()
}

#[test]
fn a_timeline_moves_what_its_tracks_name() {
    let scene = moving("");
    assert_eq!(scene.timeline().unwrap().frame_count(), 20);
    let x = |t| at(&scene, t).planes[0].centre_m.x;
    assert_eq!(x(0.0), 0.0);
    // Half-way in time is half-way in value; a quarter of the way (1 − cos 45°)/2.
    assert!((x(1.0) - 0.2).abs() < 1e-12);
    assert!((x(0.75) - 0.4 * 0.146446609406726).abs() < 1e-12);
    assert!((x(1.9) - 0.4).abs() < 1e-12);
    let lamp = |t| at(&scene, t).lamp.position_m.x;
    assert_eq!([lamp(0.99), lamp(1.0)], [0.0, 0.1]);
    // Looping, the end is the start again, and so is every later round.
    assert_eq!(x(2.0), 0.0);
    assert!((x(2.75) - x(0.75)).abs() < 1e-12);
    assert_eq!(x(f64::NAN), 0.0, "no time is no reason to fail");
}

#[test]
fn a_pose_on_the_timeline_is_the_pose_in_the_file() {
    for (t, degrees) in [(0.0, 0.0), (0.5, 20.0), (1.0, 40.0), (1.25, 30.0)] {
        let shown = at(&moving(""), t).planes.remove(0);
        let lines = format!("pose = {{ bar = {degrees:?} }}");
        let written =
            parse(&SCENE.replace("texels = 128", &format!("texels = 128\n{lines}")), &files()).unwrap();
        let written = written.still().planes.remove(0);
        assert_eq!(rows(&shown.mask, 0), rows(&written.mask, 0), "{degrees}°");
        // Control: a little later it is another pose.
        assert_ne!(rows(&at(&moving(""), t + 0.1).planes[0].mask, 0), rows(&written.mask, 0));
    }
}

#[test]
fn equal_poses_share_their_mask_and_different_ones_do_not() {
    let scene = moving("");
    let mut masks = Masks::default();
    let mut mask_at = |t| scene.theatre_at(t, &mut masks).planes.remove(0).mask;
    let first = mask_at(0.3);
    let other = mask_at(0.4);
    assert!(!Arc::ptr_eq(&first, &other) && first.id != other.id);
    let again = mask_at(2.3 - 2.0);
    let back = mask_at(0.4);
    assert!(Arc::ptr_eq(&other, &back), "a mask that was just shown is kept");
    assert_eq!(rows(&again, 0), rows(&first, 0));
    let anew = at(&scene, 0.4).planes.remove(0).mask;
    assert!(
        !Arc::ptr_eq(&anew, &back) && rows(&anew, 0) == rows(&back, 0),
        "who keeps none has it drawn anew"
    );
    // The masks of one scene are never another's, though it hangs in the same pose.
    let coarse = SCENE.replace("texels = 128", "texels = 64");
    let coarse = parse(&format!("{coarse}{MOVING}"), &files()).unwrap();
    assert_ne!(coarse.theatre_at(0.4, &mut masks).planes[0].mask.width, back.width);
    // What is posed as written is there from the start, and every drawing has the same.
    let still = parse(&format!("{SCENE}[timeline]\nfps = 1\nseconds = 1\n"), &files()).unwrap();
    assert_eq!(at(&still, 0.0).planes[0].mask.id, still.still().planes[0].mask.id);
    assert!(Arc::ptr_eq(&scene.still().planes[0].mask, &at(&scene, 0.0).planes[0].mask));
}

#[test]
fn a_scene_is_shared_by_threads_that_pose_it_at_once() {
    let scene = Arc::new(moving(""));
    let drawn = |t: f64| rows(&at(&scene, t).planes[0].mask, 0);
    let expected = [0.3, 0.7, 1.1].map(drawn);
    let threads = [0.3, 0.7, 1.1].map(|t| {
        let scene = scene.clone();
        std::thread::spawn(move || rows(&at(&scene, t).planes[0].mask, 0))
    });
    let shown = threads.map(|thread| thread.join().unwrap());
    assert!(shown == expected && shown[0] != shown[1], "each thread has the pose that it asked for");
}

#[test]
fn parts_joints_and_poses_are_there_to_be_read() {
    let scene = moving("pose = { leaf = 10.0 }\nrotate_deg = 5");
    let [puppet] = scene.puppets() else { panic!("one puppet") };
    assert_eq!(puppet.image(), "../puppets/figure.toml");
    let parts: Vec<_> = puppet.parts().iter().map(|p| (p.id.as_str(), p.parent, p.pivot)).collect();
    let joints =
        [("body", None, None), ("bar", Some(0), Some([64.0, 64.0])), ("leaf", Some(1), Some([112.0, 64.0]))];
    assert_eq!(parts, joints);
    assert_eq!(puppet.parts()[1].limits_deg, Some([-120.0, 180.0]));
    let written = &scene.staging().puppets[0];
    assert_eq!((written.pose.parts_deg.as_slice(), written.pose.rotate_deg), (&[0.0, 0.0, 10.0][..], 5.0));
    // Half-way in time the bar has turned half its way, and the puppet has gone half of its.
    let later = scene.staging_at(1.0);
    assert_eq!(later.puppets[0].pose.parts_deg, [0.0, 40.0, 10.0]);
    assert!((later.puppets[0].position_m.x - 0.2).abs() < 1e-12 && later.lamp_m.x == 0.1, "{later:?}");
    assert_eq!(parse(SCENE, &files()).unwrap().staging_at(1.0), *parse(SCENE, &files()).unwrap().staging());
}

#[test]
fn many_poses_in_any_order_give_the_same_masks() {
    // Buffers are reused and plates cached: history must not show.
    let scene = moving("pose = { leaf = 10.0 }");
    let mut masks = Masks::default();
    let times = [0.1, 0.9, 0.5, 0.2, 0.9, 1.3];
    let shown: Vec<_> =
        times.iter().map(|&t| rows(&scene.theatre_at(t, &mut masks).planes[0].mask, 0)).collect();
    for (&t, shown) in times.iter().zip(&shown) {
        assert_eq!(&rows(&at(&moving("pose = { leaf = 10.0 }"), t).planes[0].mask, 0), shown, "{t} s");
    }
}
