//! The binary's manners: what a wrong input gets, and the numbers it prints.

use std::path::Path;

use kelir_fixtures as fixtures;
use kelir_tests::{kelir, kelir_ok, root};

/// Runs a command that must refuse its input: exit code 2, every phrase in the message, nothing on standard output.
fn refused(args: &[&str], phrases: &[&str]) {
    let out = kelir(args);
    let message = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(2), "{args:?}: {message}");
    assert!(out.stdout.is_empty(), "{args:?} printed {}", String::from_utf8_lossy(&out.stdout));
    for phrase in phrases {
        assert!(message.contains(phrase), "{args:?} does not say {phrase:?}:\n{message}");
    }
    assert!(!message.contains("panicked"), "{message}");
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

/// A small scene with a PNG puppet: an opaque square in a clear frame.
fn scene(folder: &Path, edit: impl Fn(&str) -> String) -> String {
    let mut dot = image::RgbaImage::new(8, 8);
    for (x, y, pixel) in dot.enumerate_pixels_mut() {
        pixel.0 = if (2..6).contains(&x) && (2..6).contains(&y) { [0, 0, 0, 255] } else { [0; 4] };
    }
    dot.save(folder.join("dot.png")).unwrap();
    write(folder, "scene.toml", &edit(&fixtures::SCENE.replace("../puppets/square.svg", "dot.png")))
}

/// A knob that the technique does not have was taken and ignored.
#[test]
fn knobs_are_those_of_the_technique() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.png");
    let draw = |technique: &'static str, knobs: &[&'static str]| {
        let mut args =
            vec!["render", "kayon", "--technique", technique, "--size", "64x36", "--backend", "cpu", "-o"];
        args.push(out.to_str().unwrap());
        args.extend(knobs);
        args.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let no = |technique, knobs: &[&'static str], phrases: &[&str]| {
        let args = draw(technique, knobs);
        refused(&args.iter().map(String::as_str).collect::<Vec<_>>(), phrases);
        assert!(!out.exists());
    };
    no(
        "pa",
        &["--spp", "999999999", "--lights", "7"],
        &["lights = 7: is a knob of points, not of pa", "spp = 999999999: is a knob of mc"],
    );
    no("mc", &["--spp", "0"], &["spp = 0: must be a whole number from 1 to 1048576"]);
    no("mc", &["--spp", "many"], &["spp = \"many\": must be a whole number"]);
    no("points", &["--lights", "7"], &["lights = 7: must be a square number"]);
    no("pcss", &["--bias", "-0.1"], &["bias_m = -0.1: must be a number from 0"]);
    no("pa", &["--weights", "even"], &["weights = \"even\": must be one of area and irradiance"]);
    no("pa", &["--knob", "spilt=2"], &["spilt = 2: pa has no such knob (did you mean split?)"]);
    no("pa", &["--knob", "split"], &["--knob split: write NAME=VALUE"]);
    no("pa", &["--split", "2", "--knob", "split=3"], &["split is turned twice"]);
    refused(
        &["technique", "pcs"],
        &["must be one of pa, mc, points, pcss, oracle and raytrace (did you mean pcss?)"],
    );
    // The same by either way, and other than when nothing is turned.
    let picture = |knobs: &[&'static str]| {
        let args = draw("mc", knobs);
        kelir_ok(&args.iter().map(String::as_str).collect::<Vec<_>>());
        let bytes = std::fs::read(&out).unwrap();
        std::fs::remove_file(&out).unwrap();
        bytes
    };
    let turned = picture(&["--spp", "16", "--seed", "2"]);
    assert!(turned == picture(&["--knob", "spp=16", "--knob", "seed=2"]));
    assert!(turned != picture(&["--spp", "16"]));
    // What is listed is what may be turned.
    let table = kelir_ok(&["technique", "mc"]);
    assert!(
        table.contains("spp") && table.contains("64") && table.contains("a whole number from 1 to 1048576"),
        "{table}"
    );
    let document: serde_json::Value = serde_json::from_str(&kelir_ok(&["technique", "--json"])).unwrap();
    let names: Vec<&str> =
        document.as_array().unwrap().iter().map(|t| t["technique"].as_str().unwrap()).collect();
    assert_eq!(names, ["pa", "mc", "points", "pcss", "oracle", "raytrace"]);
}

#[test]
fn ttest_prints_the_papers_numbers() {
    let first = kelir_ok(&["stats", "ttest", "--counts", "0:12,1:14,2:6", "--mu", "1"]);
    for number in ["0.8125", "0.7378", "-1.4376"] {
        assert!(first.contains(number), "{first}");
    }
    let second = kelir_ok(&["stats", "ttest", "--counts", "0:3,1:10,2:19", "--mu", "1"]);
    assert!(second.contains("4.2088"), "{second}");
    let json = kelir_ok(&["stats", "ttest", "--counts", "0:26,1:7", "--mu", "0.5", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    // t = (7/33 − 1/2)/(s/√33), worked out by hand: s² = 7·26/(33·32).
    let s = (7.0_f64 * 26.0 / (33.0 * 32.0)).sqrt();
    let t = (7.0 / 33.0 - 0.5) / (s / 33.0_f64.sqrt());
    assert!((json["t"].as_f64().unwrap() - t).abs() < 1e-12, "{json}");
}

#[test]
fn the_paper_is_computed_again() {
    // R 4.2.2: t.test on the reconstructed counts.
    let text = kelir_ok(&["paper", "taylor-cameron"]);
    for number in [
        "t = -1.437591",
        "p = 1.60569e-1",
        "t = 4.208834",
        "p = 2.03782e-4",
        "t = -3.983482",
        "p = 3.66864e-4",
    ] {
        assert!(text.contains(number), "{number} is not in\n{text}");
    }
    assert!(text.contains("no whole number of 25 to 40 participants gives it"), "{text}");
}

#[test]
fn wrong_numbers_are_refused() {
    refused(&["stats", "ttest", "--counts", "0:1", "--mu", "1"], &["counts"]);
    refused(&["stats", "ttest", "--counts", "0:12,x", "--mu", "1"], &["\"x\"", "VALUE:HOW-OFTEN"]);
    refused(&["stats", "ttest", "--counts", "0:12,1:3", "--mu", "nan"], &["mu"]);
    refused(&["stats", "shadow-puppets", "--data", "/nonexistent/kelir"], &["/nonexistent/kelir"]);
}

#[test]
fn a_wrong_scene_names_every_problem_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.png");
    let path = scene(folder.path(), |good| {
        good.replace("-0.2]", "0.3]")
            .replace("radiance = 40.0", "radiance = nan\nbrightness = 3")
            .replace("width_m = 1.6", "width_m = 0")
    });
    let phrases = [
        "scene.toml",
        "puppets[0].position_m[2] = 0.3",
        "screen.width_m",
        "lamp.emitters[0].radiance",
        "brightness",
    ];
    refused(&["render", &path, "--technique", "pa", "-o", out.to_str().unwrap()], &phrases);
    refused(&["scene", "check", &path], &phrases);
    assert!(!out.exists());
    let left: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "nothing is left behind: {left:?}");
}

#[test]
fn what_a_technique_cannot_draw_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.png");
    let good = scene(folder.path(), str::to_owned);
    refused(
        &["render", &good, "--technique", "pa", "--size", "100x100", "-o", out.to_str().unwrap()],
        &["size = 100x100", "56 of height"],
    );
    refused(
        &["render", &good, "--technique", "pa", "--size", "wide", "-o", out.to_str().unwrap()],
        &["WIDTHxHEIGHT"],
    );
    refused(
        &["render", &good, "--technique", "pa", "-o", folder.path().join("out.tiff").to_str().unwrap()],
        &["out.tiff", ".png", ".exr"],
    );
    refused(
        &["animate", &good, "--technique", "pa", "-o", folder.path().join("frames").to_str().unwrap()],
        &["timeline"],
    );
    assert!(!out.exists());
}

#[test]
fn hostile_images_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), str::to_owned);
    std::fs::write(folder.path().join("dot.png"), b"\x89PNG\r\n\x1a\nnot really").unwrap();
    refused(&["scene", "check", &path], &["puppets[0].image", "dot.png"]);
    // A header that promises 60000 × 60000 pixels and holds nothing.
    let mut bomb = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
    bomb.extend([0, 0, 0xea, 0x60, 0, 0, 0xea, 0x60, 8, 6, 0, 0, 0, 0, 0, 0, 0]);
    std::fs::write(folder.path().join("dot.png"), bomb).unwrap();
    refused(&["scene", "check", &path], &["puppets[0].image", "dot.png"]);
    let missing = scene(folder.path(), |good| good.replace("dot.png", "../../etc/passwd"));
    refused(&["scene", "check", &missing], &["puppets[0].image"]);
}

#[test]
fn a_wrong_study_names_every_problem() {
    let folder = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(root().join("stimuli/studies/shadow-puppets.toml")).unwrap();
    let wrong = good.replace("sizes = [[592, 333]", "sizes = [[592, 0]").replacen(
        "kind = \"still\"",
        "kind = \"painting\"",
        1,
    );
    assert_ne!(good, wrong, "the study has what the test breaks");
    let path = write(folder.path(), "study.toml", &wrong);
    refused(&["study", "check", &path], &["study.toml", "size", "painting"]);
    kelir_ok(&["study", "check", "stimuli/studies/shadow-puppets.toml"]);
}

#[test]
fn power_is_simulated_from_a_design_file_and_a_wrong_one_names_every_problem() {
    let folder = tempfile::tempdir().unwrap();
    let good = std::fs::read_to_string(root().join("stimuli/studies/designs/shadow-puppets.toml")).unwrap();
    let study = root().join("stimuli/studies/shadow-puppets.toml");
    std::fs::copy(study, folder.path().join("shadow-puppets.toml")).unwrap();
    let small = good
        .replace("../shadow-puppets.toml", "shadow-puppets.toml")
        .replace("[16, 32, 64, 128]", "[8, 12]")
        .replace("simulations = 400", "simulations = 20");
    let design = write(folder.path(), "design.toml", &small);
    let json = folder.path().join("power.json");
    let printed = kelir_ok(&["power", "--design", &design, "--json", json.to_str().unwrap()]);
    for phrase in [
        "20 simulated studies",
        "n = 12",
        "should not exceed",
        "ignoring who made them",
        "Fewest participants",
    ] {
        assert!(printed.contains(phrase), "no {phrase:?} in:\n{printed}");
    }
    let found: serde_json::Value = serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
    assert_eq!(found["sizes"][1]["participants"], 12);
    assert_eq!(found["sizes"][1]["tests"][0]["rate"]["runs"], 20);
    assert!(!printed.contains("rimary endpoint"), "{printed}");

    let file = folder.path().join("shadow-puppets.toml");
    let study = std::fs::read_to_string(&file).unwrap();
    let named = "primary = { test = \"t-test\", block = \"photographs\", participants = 32 }\n";
    std::fs::write(&file, format!("{named}{study}")).unwrap();
    let printed = kelir_ok(&["power", "--design", &design]);
    let told =
        "Primary endpoint: two-tailed one-sample t-test of block photographs, at α = 0.05, uncorrected";
    let line = printed.lines().find(|line| line.starts_with(told)).unwrap_or_else(|| panic!("{printed}"));
    assert!(line.contains("no Holm family") && line.contains("32 judged participants"), "{line}");
    let rows = printed.matches("primary endpoint: two-tailed one-sample t-test").count();
    assert_eq!(rows, 2, "its power, and the fewest participants: {printed}");

    let wrong = small
        .replace("simulations = 20", "simulations = 0")
        .replace("icc = 0.17", "icc = 1.7")
        .replace("[8, 12]", "[]");
    let wrong = write(folder.path(), "wrong.toml", &wrong);
    let unwritten = folder.path().join("none.json");
    refused(
        &["power", "--design", &wrong, "--json", unwritten.to_str().unwrap()],
        &["wrong.toml", "simulations = 0", "truth[1].icc = 1.7", "participants = []"],
    );
    assert!(!unwritten.exists());
    refused(
        &["power", "--design", &write(folder.path(), "lost.toml", "study = \"nowhere.toml\"")],
        &["nowhere.toml"],
    );
    refused(&["power", "--design", "no-such-file.toml"], &["no-such-file.toml"]);
}

#[test]
fn the_shipped_scenes_are_good() {
    let mut scenes: Vec<_> = std::fs::read_dir(root().join("stimuli/scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    scenes.sort();
    assert!(scenes.len() >= 7, "two scenes of each of three puppets, and the benchmark");
    let args: Vec<&str> =
        ["scene", "check"].into_iter().chain(scenes.iter().map(|path| path.to_str().unwrap())).collect();
    kelir_ok(&args);
}

#[test]
fn compose_file_is_valid_where_a_client_can_tell() {
    // Docker's compose client validates without an engine; machines without it have nothing to ask.
    for client in [&["docker", "compose"][..], &["docker-compose"]] {
        let known = std::process::Command::new(client[0]).args(&client[1..]).arg("version").output();
        if known.is_ok_and(|out| out.status.success()) {
            let out = std::process::Command::new(client[0])
                .args(&client[1..])
                .args(["config", "-q"])
                .current_dir(root())
                .output()
                .unwrap();
            assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
            return;
        }
    }
    eprintln!("no compose client here: docker-compose.yml is not validated");
}

/// Files of a folder by name.
fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Starts `kelir ARGS`, sends it `signal` after `wait`, and answers how it ended.
fn interrupted(args: &[&str], signal: &str, wait: std::time::Duration) -> std::process::ExitStatus {
    let mut child = std::process::Command::new(kelir_tests::binary())
        .args(args)
        .stdin(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(wait);
    let kill = std::process::Command::new("kill").args([signal, &child.id().to_string()]).output().unwrap();
    drop(kill); // it may be too late
    child.wait().unwrap()
}

#[test]
fn an_interrupted_render_leaves_no_half_written_file() {
    use std::time::Duration;
    let folder = tempfile::tempdir().unwrap();
    let good = scene(folder.path(), str::to_owned);
    let inputs = names(folder.path());
    let out = folder.path().join("out.exr");
    let (out, half) = (out.to_str().unwrap(), Duration::from_millis(500));
    // Hours of samples: it is interrupted while it draws.
    let long = [
        "render",
        &good,
        "--technique",
        "mc",
        "--spp",
        "1000000",
        "--no-skip",
        "--backend",
        "cpu",
        "-o",
        out,
    ];
    for signal in ["-INT", "-TERM", "-KILL"] {
        let status = interrupted(&long, signal, half);
        assert!(!status.success(), "{signal}: {status}");
        assert_eq!(names(folder.path()), inputs, "after {signal}");
    }
    // Short ones, interrupted anywhere: the file is whole or absent, and a part is called so.
    let png = folder.path().join("out.png");
    let short = ["render", &good, "--technique", "pa", "--backend", "cpu", "-o", png.to_str().unwrap()];
    let (mut whole, mut absent) = (0, 0);
    for step in 0..12 {
        interrupted(&short, "-KILL", Duration::from_millis(25 * step));
        match png.is_file() {
            true => {
                image::open(&png).unwrap();
                std::fs::remove_file(&png).unwrap();
                whole += 1;
            }
            false => absent += 1,
        }
        let known = |name: &String| {
            inputs.contains(name) || (name.starts_with("out.png.") && name.ends_with(".part"))
        };
        assert_eq!(names(folder.path()).iter().find(|name| !known(name)), None);
    }
    assert!(absent > 0, "{whole} of 12 renders were done before they were interrupted");
}

/// Error against time on a tiny image: tables, JSON and figure; what is asked wrongly is refused and writes nothing.
#[test]
fn accuracy_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), str::to_owned);
    let [json, plot] = ["a.json", "a.svg"].map(|name| folder.path().join(name));
    let files = ["--json", json.to_str().unwrap(), "--plot", plot.to_str().unwrap()];
    let small = ["bench", "accuracy", &scene, "--size", "64x36", "--runs", "1", "--crops", "2"];
    refused(&[&small[..], &files, &["--only", "nothing"]].concat(), &["only", "nothing"]);
    refused(&[&small[..], &files, &["--reference-seed", "1"]].concat(), &["reference_seed = 1"]);
    refused(&[&small[..], &files, &["--reference-spp", "2048"]].concat(), &["reference_spp = 2048"]);
    assert!(!json.exists() && !plot.exists());

    let text = kelir_ok(&[&small[..], &files, &["--reference-spp", "4096"]].concat());
    for phrase in [
        "in penumbra",
        "PA shadow map",
        "spp 2048",
        "lights 256",
        "samples 1024",
        "numerical RMSE",
        "instruction set",
    ] {
        assert!(text.contains(phrase), "no {phrase:?} in\n{text}");
    }
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(json).unwrap()).unwrap();
    assert_eq!(json["size"], serde_json::json!([64, 36]));
    let results = json["results"].as_array().unwrap();
    assert!(results.len() > 25 && results.iter().all(|r| r["measured"]["penumbra"]["rmse"].is_f64()));
    let plot = std::fs::read_to_string(plot).unwrap();
    for phrase in ["<svg", "PCSS", "points", "standard error of the reference"] {
        assert!(plot.contains(phrase), "no {phrase:?} in the figure");
    }
}
