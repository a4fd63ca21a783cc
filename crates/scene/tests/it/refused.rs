//! What invalid scenes are refused for.

use crate::support::{SCENE, files, parse};

fn messages(scene: &str) -> Vec<String> {
    let errors = parse(scene, &files()).expect_err("must be refused");
    errors.to_string().lines().map(str::to_owned).collect()
}

#[test]
fn a_puppet_on_the_audience_side_is_refused_in_the_issues_words() {
    let scene = SCENE.replace("[0.0, 0.0, -0.2]", "[0.0, 0.0, 0.3]");
    assert_eq!(
        messages(&scene),
        [
            "scenes/test.toml: puppets[0].position_m[2] = 0.3: a puppet hangs backstage, between lamp (−1.5) and screen (0)"
        ]
    );
}

#[test]
fn every_problem_is_reported() {
    let scene = SCENE
        .replace("width_m = 1.6", "widht_m = 1.6")
        .replace("albedo = 0.8", "albedo = [0.8, nan, 2]")
        .replace("size_m = [0.02, 0.02]", "size_m = [0, 0.02]")
        .replace("radiance = 2000.0", "radiance = -1")
        .replace("name = \"outer\"", "name = 3")
        .replace("[0.0, 0.0, -0.2]", "[0.0, 0.0]")
        .replace("model = \"none\"", "model = \"papr\"")
        .replace("texels = 128", "pose = { leef = 3.0 }\nrotate_deg = inf")
        .replace("white = \"auto\"", "white = 0");
    let found = messages(&scene);
    let expected = [
        "screen.width_m: is missing",
        "screen.albedo[1] = nan: a number must be finite",
        "screen.albedo[2] = 2: an albedo is between 0 and 1",
        "screen.widht_m = 1.6: is not a known key (did you mean width_m?)",
        "lamp.emitters[0].size_m[0] = 0: a length is",
        "lamp.emitters[0].radiance = -1: a radiance is",
        "lamp.emitters[1].name = 3: a string is wanted here",
        "ambient.model = \"papr\": must be one of none, paper and dome (did you mean paper?)",
        "exposure.white = 0: white is",
        "puppets[0].position_m = [0.0, 0.0]: must have 3 numbers, not 2",
        "puppets[0].rotate_deg = inf: a number must be finite",
        "puppets[0].pose.leef = 3.0: no such part (did you mean leaf?); parts are body, bar and leaf",
    ];
    for wanted in expected {
        assert!(found.iter().any(|m| m.contains(wanted)), "{wanted:?} in {found:#?}");
    }
    assert_eq!(found.len(), expected.len(), "{found:#?}");
}
