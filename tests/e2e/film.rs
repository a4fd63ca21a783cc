//! `kelir animate`: frames for studies, films for sharing, seen by a browser.

use kelir_tests::{browser, kelir, kelir_ok};
use serde_json::{Value, json};

const SIZE: &str = "320x180";

fn animate(scene: &str, output: &std::path::Path) -> Value {
    let printed = kelir_ok(&[
        "animate",
        scene,
        "--technique",
        "pa",
        "--backend",
        "cpu",
        "--size",
        SIZE,
        "--stats",
        "json",
        "-o",
        output.to_str().unwrap(),
    ]);
    serde_json::from_str(&printed).unwrap()
}

/// The place of greatest `measure` among those whose surroundings are even: 4:2:0 blurs colours at edges.
fn flat(picture: &image::RgbImage, measure: impl Fn([u32; 2]) -> u8) -> [u32; 2] {
    let even = |x: u32, y: u32| {
        let around = (y - 4..=y + 4).flat_map(|v| (x - 4..=x + 4).map(move |u| (u, v)));
        around.into_iter().all(|(u, v)| {
            let (a, b) = (picture.get_pixel(u, v).0, picture.get_pixel(x, y).0);
            (0..3).all(|c| a[c].abs_diff(b[c]) <= 6)
        })
    };
    let places = (4..picture.height() - 4).flat_map(|y| (4..picture.width() - 4).map(move |x| [x, y]));
    places.filter(|[x, y]| even(*x, *y)).max_by_key(|place| measure(*place)).unwrap()
}

#[test]
fn a_browser_plays_the_film_with_the_frames_colours() {
    let scene = "stimuli/scenes/arjuna-dance.toml";
    let folder = tempfile::tempdir().unwrap();
    let [frames, mp4, apng] = ["frames", "dance.mp4", "dance.apng"].map(|name| folder.path().join(name));
    for output in [&frames, &mp4, &apng] {
        animate(scene, output);
    }
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(frames.join("manifest.json")).unwrap()).unwrap();
    let names = manifest["frames"].as_array().unwrap();
    assert_eq!((names.len(), manifest["fps"].as_f64()), (60, Some(30.0)));

    let picture = |index: usize| image::open(frames.join(names[index].as_str().unwrap())).unwrap().to_rgb8();
    let (shown, other) = (picture(45), picture(30));
    let green = |picture: &image::RgbImage, [x, y]: [u32; 2]| picture.get_pixel(x, y).0[1];
    // In shadow, lit, and where half a second earlier the picture was another.
    let points = [
        flat(&shown, |at| 255 - green(&shown, at)),
        flat(&shown, |at| green(&shown, at)),
        flat(&shown, |at| green(&shown, at).abs_diff(green(&other, at))),
        [10, 10],
    ];
    let colours = |picture: &image::RgbImage| points.map(|[x, y]| picture.get_pixel(x, y).0);
    assert!(colours(&shown)[0][1] < 8, "the darkest place is in shadow");
    let furthest = |seen: &Value, expected: [[u8; 3]; 4]| {
        let seen = seen["colours"].as_array().unwrap().iter().zip(expected);
        seen.flat_map(|(colour, expected)| {
            (0..3).map(move |c| (colour[c].as_f64().unwrap() - f64::from(expected[c])).abs())
        })
        .fold(0.0, f64::max)
    };
    // The middle of frame 45.
    let seen = browser("film.mjs", &json!({"file": mp4, "at_s": 45.5 / 30.0, "points": points}));
    assert_eq!((seen["width"].as_u64(), seen["height"].as_u64()), (Some(320), Some(180)));
    assert!((seen["duration_s"].as_f64().unwrap() - 2.0).abs() < 0.01, "{seen}");
    assert!(furthest(&seen, colours(&shown)) <= 10.0, "{seen} against {:?}", colours(&shown));
    // Negative control: a film without its colours would be seen.
    let grey = colours(&shown).map(|[_, green, _]| [green; 3]);
    assert!(furthest(&seen, grey) > 12.0);
    assert!(furthest(&seen, colours(&other)) > 20.0, "the points tell frames apart");
    let seen = browser("film.mjs", &json!({"file": apng, "at_s": 0, "points": points}));
    assert_eq!(furthest(&seen, colours(&picture(0))), 0.0, "an APNG is exact");
}

#[test]
fn frames_that_show_nothing_new_are_not_drawn_again() {
    let folder = tempfile::tempdir().unwrap();
    let scene = std::fs::read_to_string(kelir_tests::root().join("stimuli/scenes/arjuna-near.toml")).unwrap();
    std::fs::create_dir_all(folder.path().join("scenes")).unwrap();
    let shipped = kelir_tests::root().join("stimuli/puppets");
    std::fs::create_dir_all(folder.path().join("puppets")).unwrap();
    for name in ["arjuna.toml", "arjuna.svg"] {
        std::fs::copy(shipped.join(name), folder.path().join("puppets").join(name)).unwrap();
    }
    let still = format!(
        "{scene}\n[timeline]\nfps = 10\nseconds = 1.0\nloop = true\n[[timeline.tracks]]\ntarget = \"puppets[0].rotate_deg\"\n\
         easing = \"step\"\nkeys = [ {{ t = 0.0, value = 0.0 }}, {{ t = 0.5, value = 5.0 }} ]\n"
    );
    let path = folder.path().join("scenes/still.toml");
    std::fs::write(&path, still).unwrap();
    let frames = folder.path().join("frames");
    let stats = animate(path.to_str().unwrap(), &frames);
    assert_eq!(stats["frames_repeated"], 8);
    assert_eq!(stats["frames"].as_array().unwrap().len(), 2);
    let files = std::fs::read_dir(&frames).unwrap().count();
    assert_eq!(files, 3, "two pictures and the manifest");
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(frames.join("manifest.json")).unwrap()).unwrap();
    assert_eq!(manifest["frames"].as_array().unwrap().len(), 10);
    // A film that kelir does not write is refused before anything is drawn.
    let gif = folder.path().join("x.gif");
    let out = kelir(&["animate", path.to_str().unwrap(), "--technique", "pa", "-o", gif.to_str().unwrap()]);
    assert_eq!(out.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&out.stderr).contains(".apng or .mp4"));
    assert!(!gif.exists());
}
