//! Posing by resampling against resvg drawing the posed figure itself: two programs, one pose.

use crate::support::{MANIFEST, SCENE, files, parse};
use kelir_scene::Plane;

const TEXELS: f64 = 256.0;

/// The test figure with cut-out work, its parts moved by `body`, `bar` and `leaf` (SVG transforms).
fn figure(body: &str, bar: &str, leaf: &str) -> String {
    let holes: String =
        (0..5).map(|i| format!("<circle cx=\"{}\" cy=\"80\" r=\"3\"/>", 40 + 12 * i)).collect();
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 128 128">
        <mask id="m"><rect width="128" height="128" fill="#fff"/>{holes}</mask>
        <g id="body"><g transform="{body}"><rect x="40" y="40" width="48" height="48" mask="url(#m)"/></g></g>
        <g id="bar"><g transform="{bar}"><path d="M60 60h40v8h-40z M70 62v4h4v-4z" fill-rule="evenodd"/></g></g>
        <g id="leaf"><g transform="{leaf}"><path d="M94 64q8 -12 16 0q-8 12 -16 0z"/></g></g></svg>"##
    )
}

fn plane(svg: String, lines: &str) -> Plane {
    let mut files = files();
    files.insert("puppets/figure.svg".into(), svg.into_bytes());
    let manifest = MANIFEST.replace("pivot = [112, 64]", "pivot = [96, 64]");
    files.insert("puppets/figure.toml".into(), manifest.into_bytes());
    let scene = SCENE.replace("texels = 128", &format!("texels = {TEXELS}\n{lines}"));
    parse(&scene, &files).unwrap().still().planes.remove(0)
}

/// Root mean square and maximum of the difference of two planes' transmittances on their common lattice.
fn difference(a: &Plane, b: &Plane) -> [f64; 2] {
    let texel_m = 0.6 / TEXELS;
    // Of a plane's top left corner, in texels from the figure's centre, x right and y down.
    let corner = |p: &Plane| {
        [
            (p.centre_m.x / texel_m - 0.5 * p.mask.width as f64).round() as i64,
            (-p.centre_m.y / texel_m - 0.5 * p.mask.height as f64).round() as i64,
        ]
    };
    let at = |p: &Plane, x: i64, y: i64| {
        let [x0, y0] = corner(p);
        match (usize::try_from(x - x0), usize::try_from(y - y0)) {
            (Ok(x), Ok(y)) if x < p.mask.width && y < p.mask.height => p.mask.transmittance(0, x, y),
            _ => 1.0,
        }
    };
    let half = TEXELS as i64 / 2 + 20;
    let (mut squares, mut worst, mut count) = (0.0, 0.0f64, 0.0);
    for y in -half..half {
        for x in -half..half {
            let d = at(a, x, y) - at(b, x, y);
            squares += d * d;
            worst = worst.max(d.abs());
            count += 1.0;
        }
    }
    [(squares / count).sqrt(), worst]
}

#[test]
fn a_pose_is_what_resvg_draws_with_the_same_transforms() {
    // SVG's positive angles are clockwise on the screen.
    for (rotate, bar, leaf) in [(17.0, 0.0, 0.0), (0.0, 33.0, 0.0), (0.0, -25.0, 71.0), (-40.0, 100.0, -55.0)]
    {
        let lines = format!("rotate_deg = {rotate:?}\npose = {{ bar = {bar:?}, leaf = {leaf:?} }}");
        let resampled = plane(figure("", "", ""), &lines);
        let drawn = |rotate: f64| {
            let whole = format!("rotate({} 64 64)", -rotate);
            let arm = format!("{whole} rotate({} 64 64)", -bar);
            plane(figure(&whole, &arm, &format!("{arm} rotate({} 96 64)", -leaf)), "")
        };
        let [rms, worst] = difference(&resampled, &drawn(rotate));
        let [off, _] = difference(&resampled, &drawn(rotate + 1.0));
        println!("{rotate}° {bar}° {leaf}°: rms {rms:.4}, max {worst:.3}; one degree off {off:.4}");
        // Resampling softens edges by half a texel: less than half of full scale at an edge, nothing elsewhere.
        assert!(rms < 0.02 && worst < 0.5, "{rotate}° {bar}° {leaf}°: rms {rms}, max {worst}");
        // Control: one degree off is seen.
        assert!(off > 2.0 * rms, "{off} beside {rms}");
    }
    // At rest nothing is resampled.
    assert_eq!(
        difference(&plane(figure("", "", ""), ""), &plane(figure("", "", ""), "rotate_deg = 0.0")),
        [0.0; 2]
    );
}
