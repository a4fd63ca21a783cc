//! A part is the whole drawing with the others hidden, and turns about the point that its manifest names: over generated drawings.

use std::collections::HashMap;

use proptest::prelude::*;

use crate::support::{Files, SCENE, files, parse};
use kelir_scene::{Masks, Plane, Scene};

/// How a drawing says how large it is: attributes of its root, and its view box's corner and size in user units.
#[derive(Clone, Debug)]
struct Sheet {
    attributes: String,
    corner: [f64; 2],
    size: [f64; 2],
}

/// Sheets 120 × 90 user units large or of that ratio, in all units and with margins on either side.
fn sheets() -> impl Strategy<Value = Sheet> {
    let units = prop::sample::select(vec![
        "",
        "width=\"120\" height=\"90\"",
        "width=\"40mm\" height=\"30mm\"",
        "width=\"4in\" height=\"3in\"",
        "width=\"16cm\"",
        "height=\"90pt\"",
        "width=\"100%\" height=\"100%\"",
        "width=\"160Q\" height=\"120Q\"",
        "width=\"8pc\" height=\"6PC\"",
        "width=\"300\" height=\"90\"",
        "width=\"120\" height=\"200\" preserveAspectRatio=\"xMaxYMin\"",
        "width=\"300\" height=\"90\" preserveAspectRatio=\"none\"",
    ]);
    let corner = (prop::sample::select(vec![0.0, -30.0, 17.5]), prop::sample::select(vec![0.0, 250.0]));
    (units, corner, prop::sample::select(vec![1.0, 0.1, 25.4])).prop_map(|(units, (x, y), scale)| {
        let (corner, size) = ([x * scale, y * scale], [120.0 * scale, 90.0 * scale]);
        let attributes = format!("{units} viewBox=\"{} {} {} {}\"", corner[0], corner[1], size[0], size[1]);
        Sheet { attributes, corner, size }
    })
}

/// A transform, and its inverse.
fn transforms() -> impl Strategy<Value = [&'static str; 2]> {
    prop::sample::select(vec![
        ["", ""],
        ["translate(7 -3)", "translate(-7 3)"],
        ["scale(2)", "scale(0.5)"],
        ["rotate(30)", "rotate(-30)"],
        ["matrix(1 0.5 0 1 2 0)", "matrix(1 -0.5 0 1 -2 1)"],
    ])
}

/// A rule of each kind of selector that makes one of the shapes, or none, another.
fn rules() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec![
        "",
        "rect{fill:#123}",
        "#arm{opacity:.5}",
        ".b{opacity:.4}",
        "g > rect{opacity:.6}",
        "g + g rect{opacity:.5}",
        "g:first-child{opacity:.5}",
        "*{stroke:none}",
        "[fill]{opacity:.7}",
        "[class=b]{opacity:.3}",
        "svg g + g + g{opacity:.5}",
        "g{display:inline}",
        "#arm{display:inline}",
        "g g{opacity:.5}",
        ".gone{display:none}",
        "#body rect, #arm rect{opacity:.8}",
    ])
}

/// A drawing of three parts and what belongs to none, each part within a wrapping layer or not.
fn drawing(sheet: &Sheet, [there, back]: [&str; 2], rule: &str, wrapped: bool, inline: &str) -> String {
    let [x, y] = sheet.corner;
    let unit = sheet.size[0] / 120.0;
    // In user units of the sheet, however the group is transformed.
    let rect = |left: f64, top: f64, w: f64, h: f64, class: &str| {
        let (left, top) = (x + left * unit, y + top * unit);
        format!(
            r##"<g transform="{there}"><g transform="{back}"><rect class="{class}" x="{left}" y="{top}" width="{}" height="{}" fill="#000"/></g></g>"##,
            w * unit,
            h * unit
        )
    };
    let (open, close) = if wrapped { ("<g id=\"layer1\">", "</g>") } else { ("", "") };
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" {}><style>{rule}</style><defs><g id="kept">{}</g></defs>{open}
<g id="body">{}{}</g><g id="arm" style="{inline}">{}</g><g id="leaf" class="b">{}<use href="#kept"/></g>{close}</svg>"##,
        sheet.attributes,
        rect(100.0, 70.0, 6.0, 6.0, "k"),
        rect(10.0, 10.0, 30.0, 60.0, "b"),
        rect(12.0, 72.0, 8.0, 8.0, "gone"),
        rect(50.0, 30.0, 20.0, 20.0, "a"),
        rect(80.0, 20.0, 15.0, 25.0, ""),
    )
}

fn scene(svg: &str, sheet: Option<&Sheet>, pose: &str) -> Scene {
    let mut files: Files = files();
    files.insert("puppets/p.svg".into(), svg.into());
    let at = |x: f64, y: f64| {
        let (sheet, unit) = (sheet.unwrap(), sheet.unwrap().size[0] / 120.0);
        format!("[{}, {}]", sheet.corner[0] + x * unit, sheet.corner[1] + y * unit)
    };
    let image = match sheet {
        None => "p.svg",
        Some(_) => {
            let manifest = format!(
                "image = \"p.svg\"\n[[parts]]\nid = \"body\"\n[[parts]]\nid = \"arm\"\npivot = {}\n[[parts]]\nid = \"leaf\"\npivot = {}\n",
                at(60.0, 40.0),
                at(0.0, 0.0)
            );
            files.insert("puppets/p.toml".into(), manifest.into());
            "p.toml"
        }
    };
    let scene = SCENE
        .replace("figure.toml", image)
        .replace("texels = 128", &format!("texels = 128\nbits = 16\n{pose}"));
    parse(&scene, &files).unwrap_or_else(|e| panic!("{e}\n{svg}"))
}

fn plane(scene: &Scene) -> Plane {
    scene.still().planes.remove(0)
}

/// What of the light is held back, and its centre in metres.
fn shadow(plane: &Plane) -> (f64, [f64; 2]) {
    let (w, h) = (plane.mask.width, plane.mask.height);
    let side = [plane.size_m[0] / w as f64, plane.size_m[1] / h as f64];
    let (mut sum, mut moment) = (0.0, [0.0; 2]);
    for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
        let opacity = 1.0 - plane.mask.transmittance(0, x, y);
        let p = plane.point_m(
            (x as f64 + 0.5) * side[0] - 0.5 * plane.size_m[0],
            0.5 * plane.size_m[1] - (y as f64 + 0.5) * side[1],
        );
        sum += opacity;
        moment = [moment[0] + opacity * p.x, moment[1] + opacity * p.y];
    }
    (sum, moment.map(|m| m / sum))
}

/// The largest difference of two masks of one grid.
fn difference(a: &Plane, b: &Plane) -> f64 {
    assert_eq!((a.mask.width, a.mask.height), (b.mask.width, b.mask.height));
    let all = (0..a.mask.height).flat_map(|y| (0..a.mask.width).map(move |x| (x, y)));
    all.map(|(x, y)| (a.mask.transmittance(0, x, y) - b.mask.transmittance(0, x, y)).abs())
        .fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 96, ..ProptestConfig::default() })]

    /// With a manifest and without one, at rest: the same picture.
    #[test]
    fn parts_at_rest_are_the_drawing(
        sheet in sheets(), transform in transforms(), rule in rules(), wrapped: bool,
        inline in prop::sample::select(vec!["", "display:inline", "fill:#000;display:inline"]),
    ) {
        let svg = drawing(&sheet, transform, rule, wrapped, inline);
        let (whole, parts) = (plane(&scene(&svg, None, "")), plane(&scene(&svg, Some(&sheet), "")));
        let most = difference(&whole, &parts);
        prop_assert!(most <= 2.0 / 255.0, "{most} in {svg}");
        prop_assert!(shadow(&whole).0 > 100.0);
    }

    /// The arm is a square about its pivot: however it is turned, its middle stays, and so does all else.
    #[test]
    fn a_part_keeps_the_point_that_it_turns_about(
        sheet in sheets(), transform in transforms(), wrapped: bool, degrees in prop::sample::select(vec![90.0, 30.0, -135.0]),
    ) {
        let svg = drawing(&sheet, transform, "#body, #leaf, #kept{opacity:0}", wrapped, "");
        let rest = shadow(&plane(&scene(&svg, Some(&sheet), "")));
        let turned = shadow(&plane(&scene(&svg, Some(&sheet), &format!("pose = {{ arm = {degrees} }}"))));
        let texel_m = 0.6 / 128.0;
        for axis in 0..2 {
            prop_assert!((rest.1[axis] - turned.1[axis]).abs() < 0.1 * texel_m, "{rest:?} {turned:?} in {svg}");
        }
    }
}

fn drawn(svg: &str, manifest: &str, lines: &str) -> Result<Scene, String> {
    let mut files = files();
    files.insert("puppets/p.svg".into(), svg.into());
    files.insert("puppets/p.toml".into(), format!("image = \"p.svg\"\n{manifest}").into());
    let scene =
        SCENE.replace("figure.toml", "p.toml").replace("texels = 128", &format!("texels = 100\n{lines}"));
    parse(&scene, &files).map_err(|e| e.to_string())
}

const ARM: &str = "[[parts]]\nid = \"body\"\n[[parts]]\nid = \"arm\"\npivot = [50.0, 44.0]\n";

fn figure(arm: &str) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" viewBox="0 0 100 100"><g id="body"><rect x="40" y="60" width="20" height="40"/></g>{arm}</svg>"#
    )
}

/// What lies beyond the drawing's edge is cut off of a part that nothing poses; of one that a pose names or a track drives, and of what hangs on it,
/// it is there at every angle.
#[test]
fn what_is_posed_reaches_beyond_the_edge() {
    let hand = "[[parts]]\nid = \"hand\"\nparent = \"arm\"\n";
    let svg = figure(
        r#"<g id="arm"><rect x="50" y="40" width="90" height="8"/></g><g id="hand"><rect x="90" y="20" width="20" height="8"/></g>"#,
    )
    .replace("height=\"40\"", "height=\"60\"");
    let (body, cut, whole) = (20.0 * 40.0, 50.0 * 8.0 + 10.0 * 8.0, 90.0 * 8.0 + 20.0 * 8.0);
    let shadow_of = |lines: &str, after: &str| {
        let scene = drawn(&svg, &format!("{ARM}{hand}"), lines).unwrap();
        assert!(after.is_empty() || scene.timeline().is_some());
        shadow(&plane(&scene)).0
    };
    for (lines, expected) in [
        ("", body + cut),
        ("rotate_deg = 90", body + cut),
        ("pose = {}", body + cut),
        ("pose = { arm = 0.0 }", body + whole),
        ("pose = { arm = 1e-9 }", body + whole),
        ("pose = { arm = 150.0 }", body + whole),
        ("pose = { arm = 360.0 }", body + whole),
    ] {
        let found = shadow_of(lines, "");
        assert!((found - expected).abs() < 2.0, "{found}, not {expected}: {lines:?}");
    }
    // A track poses it as well, from the start.
    let timeline = track("arm", &[(0.0, 0.0), (1.0, 30.0)]);
    let [cut_off, driven] =
        ["", &timeline].map(|lines| plane(&drawn(&svg, &format!("{ARM}{hand}"), lines).unwrap()));
    assert!((shadow(&driven).0 - (body + whole)).abs() < 0.1, "{}", shadow(&driven).0);
    // Control: `apart`, which finds that nothing pops, would.
    let found = apart(&cut_off, &driven);
    assert!((found - (whole - cut)).abs() < 0.1, "{found}");
}

#[test]
fn parts_that_draw_nothing_are_told() {
    for arm in [r#"<g id="arm" style="display:none"><rect width="9" height="9"/></g>"#, r#"<g id="arm"/>"#] {
        let scene = drawn(&figure(arm), ARM, "pose = { arm = 90 }").unwrap();
        let told: Vec<String> = scene.warnings().iter().map(ToString::to_string).collect();
        assert!(told.len() == 1 && told[0].contains("part \"arm\" draws nothing"), "{told:?}");
    }
    let scene = drawn(&figure(r#"<g id="arm"><rect width="9" height="9"/></g>"#), ARM, "").unwrap();
    assert!(scene.warnings().is_empty());
}

/// Names as editors write them: labels, wrapping layers, spaces, dots, colons, slashes.
#[test]
fn parts_are_found_by_what_editors_call_them() {
    let square = r#"<rect x="50" y="40" width="40" height="8"/>"#;
    for name in ["Arm left", "arm—left", "arm:left", "arm/left", "arm.left", "Левая_рука", "arm_x0020_left"]
    {
        let manifest = ARM.replace("\"arm\"", &format!("{name:?}"));
        let pose = format!("pose = {{ {name:?} = 90.0 }}");
        let by_id = drawn(&figure(&format!("<g id=\"{name}\">{square}</g>")), &manifest, &pose).unwrap();
        let by_label = figure(&format!("<g id=\"g7\" inkscape:label=\"{name}\">{square}</g>"));
        let by_label = drawn(&by_label, &manifest, &pose).unwrap();
        assert_eq!(difference(&plane(&by_id), &plane(&by_label)), 0.0, "{name}");
    }
    let wrapped =
        figure("").replace("<g id=\"body\">", "<g id=\"layer1\" inkscape:label=\"Layer 1\"><g id=\"body\">");
    let wrapped = wrapped.replace("</svg>", &format!("<g id=\"arm\">{square}</g></g></svg>"));
    assert!(drawn(&wrapped, ARM, "pose = { arm = 90 }").unwrap().warnings().is_empty());
    let absent = drawn(&figure("<g id=\"g7\" inkscape:label=\"Arm left\"/>"), ARM, "").unwrap_err();
    assert!(absent.contains("its labels Arm left"), "{absent}");
    let loose = drawn(&figure(&square.replace("<rect", "<rect id=\"arm\"")), ARM, "").unwrap_err();
    assert!(loose.contains("#arm is a <rect>: group it by itself"), "{loose}");
    let nested = figure("").replace("<g id=\"body\">", &format!("<g id=\"body\"><g id=\"arm\">{square}</g>"));
    let nested = drawn(&nested, ARM, "").unwrap_err();
    assert!(nested.contains("part \"arm\" within part \"body\""), "{nested}");
}

/// A timeline that turns a part, with keys of [seconds, degrees].
fn track(part: &str, keys: &[(f64, f64)]) -> String {
    let keys: Vec<String> =
        keys.iter().map(|(t, degrees)| format!("{{ t = {t:?}, value = {degrees:?} }}")).collect();
    format!(
        "[timeline]\nfps = 1\nseconds = 2.0\n[[timeline.tracks]]\ntarget = \"puppets[0].pose.{part}\"\nkeys = [{}]\n",
        keys.join(", ")
    )
}

/// What two masks differ by, in texels of opacity, wherever their grids end: both lie on one lattice, and beyond them all is clear.
fn apart(a: &Plane, b: &Plane) -> f64 {
    let texel_m = a.size_m[0] / a.mask.width as f64;
    let mut signed = HashMap::new();
    for (plane, sign) in [(a, 1.0), (b, -1.0)] {
        let (w, h) = (plane.mask.width, plane.mask.height);
        let left = ((plane.centre_m.x - 0.5 * plane.size_m[0]) / texel_m).round() as i64;
        let top = ((plane.centre_m.y + 0.5 * plane.size_m[1]) / texel_m).round() as i64;
        for (x, y) in (0..h).flat_map(|y| (0..w).map(move |x| (x, y))) {
            *signed.entry((left + x as i64, top - y as i64)).or_insert(0.0) +=
                sign * (1.0 - plane.mask.transmittance(0, x, y));
        }
    }
    signed.values().map(|difference: &f64| difference.abs()).sum()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    /// No part pops as a timeline turns it: in an angle ε its outline sweeps at most its length times ε times its distance from the joint, wherever
    /// the drawing ends.
    #[test]
    fn a_small_turn_is_a_small_change(
        left in -60.0..130.0f64, top in -60.0..130.0f64, w in 5.0..60.0f64, h in 5.0..60.0f64,
        rest in prop::sample::select(vec![0.0, 40.0]), log_turn in -5.0..0.0f64,
    ) {
        let svg = figure(&format!(
            "<g id=\"arm\"><rect x=\"{left}\" y=\"{top}\" width=\"{w}\" height=\"{h}\"/></g>"
        ));
        let turn = 10f64.powf(log_turn);
        let timeline = track("arm", &[(0.0, rest), (1.0, rest + turn)]);
        let scene = drawn(&svg, ARM, &format!("bits = 16\n{timeline}")).unwrap();
        let mut masks = Masks::default();
        let [before, after] = [0.0, 1.0].map(|time_s| scene.theatre_at(time_s, &mut masks).planes.remove(0));
        let [x, y] = [left - 50.0, top - 44.0];
        let reach = x.abs().max((x + w).abs()).hypot(y.abs().max((y + h).abs()));
        // Resampling and rounding to codes may add as much again.
        let most = 2.0 * 2.0 * (w + h) * reach * turn.to_radians();
        let codes = f64::from(u16::MAX).recip() * (w + 2.0) * (h + 2.0);
        let found = apart(&before, &after);
        prop_assert!(found <= most + codes, "{found}, at most {most} by {turn}° of {svg}");
        // It is all there from the start.
        let seen = shadow(&before).0;
        prop_assert!((seen - (w * h + 800.0)).abs() < 1.0 || rest != 0.0 || left < 60.0 && left + w > 40.0 && top + h > 60.0, "{seen}");
    }
}
