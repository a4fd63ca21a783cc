//! What `kelir study check` calls good can be served, and what serving would refuse it names: field, value, rule.

use std::path::Path;

use kelir_tests::{Server, edit, kelir, kelir_ok, small_data};
use serde_json::Value;

/// What a check says of a study that is wrong; exit code 2.
fn wrong(data: &Path, study: &str) -> String {
    let out = kelir(&["study", "check", data.join(format!("studies/{study}.toml")).to_str().unwrap()]);
    let said = String::from_utf8(out.stderr).unwrap();
    assert_eq!(out.status.code(), Some(2), "{said}");
    assert!(out.stdout.is_empty() && !said.contains("panicked"), "{said}");
    said
}

/// The small study with photographs in place of one condition.
fn with_photographs(data: &Path) {
    edit(
        data,
        "studies/small.toml",
        "technique = \"mc\"\nspp = 16",
        "files = { a = \"a.png\", b = \"b.jpg\", x = \"x.png\" }",
    );
    let text = std::fs::read_to_string(data.join("studies/small.toml")).unwrap();
    let stills = text.split("[[blocks]]\nid = \"loop\"").next().unwrap();
    std::fs::write(data.join("studies/small.toml"), stills).unwrap();
    let picture = image::RgbImage::from_fn(64, 36, |x, y| image::Rgb([x as u8, y as u8, 100]));
    for name in ["a.png", "b.jpg", "x.png"] {
        picture.save(data.join("studies").join(name)).unwrap();
    }
}

#[test]
fn pictures_that_could_not_be_shown_are_named_with_what_is_wrong() {
    let data = small_data();
    with_photographs(data.path());
    let studies = data.path().join("studies");
    let file = studies.join("small.toml");
    kelir_ok(&["study", "check", file.to_str().unwrap()]);
    let (png, jpeg) =
        (std::fs::read(studies.join("a.png")).unwrap(), std::fs::read(studies.join("b.jpg")).unwrap());

    image::RgbImage::new(64, 40).save(studies.join("a.png")).unwrap();
    std::fs::write(studies.join("b.jpg"), &jpeg[..jpeg.len() - 40]).unwrap();
    std::fs::write(studies.join("x.png"), &jpeg).unwrap();
    let said = wrong(data.path(), "small");
    for phrase in [
        "conditions.mc.files.a = \"a.png\": has 64 × 40 pixels; the study's size is 64 × 36",
        "conditions.mc.files.b = \"b.jpg\": ",
        "conditions.mc.files.x = \"x.png\": is a JPEG by its content; its name ends in .png",
    ] {
        assert!(said.contains(phrase), "no {phrase:?} in\n{said}");
    }
    // A small file may hold a picture that is larger than memory.
    let mut bomb = png.clone();
    bomb[16..24].copy_from_slice(&[60_000u32.to_be_bytes(), 60_000u32.to_be_bytes()].concat());
    std::fs::write(studies.join("a.png"), bomb).unwrap();
    let said = wrong(data.path(), "small");
    assert!(said.contains("has 60000 × 60000 pixels; the study's size is 64 × 36"), "{said}");
    // A head that is right, and nothing behind it.
    std::fs::write(studies.join("a.png"), &png[..png.len() / 2]).unwrap();
    std::fs::write(studies.join("b.jpg"), b"GIF89a").unwrap();
    std::fs::remove_file(studies.join("x.png")).unwrap();
    let said = wrong(data.path(), "small");
    for field in ["conditions.mc.files.a", "conditions.mc.files.b", "conditions.mc.files.x"] {
        assert!(said.contains(field), "no {field} in\n{said}");
    }
}

#[test]
fn a_redirect_holds_the_code_and_nothing_that_is_never_filled_in() {
    let data = small_data();
    let good = "https://example.org/?cc=[CODE]&who=[PROLIFIC_PID]";
    edit(data.path(), "studies/small.toml", "seed = 3", "edition = 2\nseed = 3");
    for (address, phrases) in [
        ("https://example.org/done", &["[CODE]"][..]),
        ("https://example.org/?who=[PROLIFIC_PID]", &["[CODE]"]),
        ("https://example.org/?cc=[CODE]&who=[PROLIFIC_ID]", &["[PROLIFIC_ID]", "[PROLIFIC_PID]"]),
        ("https://example.org/?cc=[CODE", &["stands alone"]),
        ("https://example.org/?cc=CODE]", &["stands alone", "]"]),
        ("https://[CODE]/", &["host"]),
        ("https:///?cc=[CODE]", &["host"]),
        ("https://example.org:99999/?cc=[CODE]", &["host"]),
        ("https://example.org:8o/?cc=[CODE]", &["host"]),
        ("https://192.0.2.999/?cc=[CODE]", &["host"]),
    ] {
        edit(data.path(), "studies/small.toml", good, address);
        let said = wrong(data.path(), "small");
        assert!(said.contains("completion.redirect") && said.contains(address), "{said}");
        phrases.iter().for_each(|phrase| assert!(said.contains(phrase), "no {phrase:?} in\n{said}"));
        edit(data.path(), "studies/small.toml", address, good);
    }
    let checked = || kelir_ok(&["study", "check", data.path().join("studies/small.toml").to_str().unwrap()]);
    // SONA credits by its own survey code, which its links call `survey_code` or `id`.
    for name in ["survey_code", "id"] {
        let sona = format!("https://x.sona-systems.com/webstudy_credit.aspx?survey_code=[{name}]");
        edit(data.path(), "studies/small.toml", good, &sona);
        assert!(checked().contains(": good ("));
        edit(data.path(), "studies/small.toml", &sona, good);
    }
    // What the study lists is filled in, and a code may stand in the address itself.
    edit(data.path(), "studies/small.toml", good, "https://example.org/?cc=C1&room=[room]\"\ncode = \"C1");
    edit(data.path(), "studies/small.toml", "[texts]", "[session]\nparams = [\"room\"]\n[texts]");
    assert!(checked().contains(": good ("));
    assert!(checked().contains("a participant downloads at 64 × 36: about 0."));
}

#[test]
fn a_study_of_the_first_edition_runs_on_with_the_redirect_it_has_and_is_warned_of() {
    let data = small_data();
    let good = "https://example.org/?cc=[CODE]&who=[PROLIFIC_PID]";
    let file = data.path().join("studies/small.toml");
    let check = |more: &[&str]| kelir_ok(&[&["study", "check", file.to_str().unwrap()], more].concat());
    for (address, phrase) in [
        ("https://example.org/done", "must hold [CODE]"),
        ("https://example.org/?cc=[CODE]&who=[who]", "[who] is filled in only where"),
        ("https://example.org/?cc=[CODE", "stands alone"),
    ] {
        edit(data.path(), "studies/small.toml", good, address);
        let said = check(&[]);
        assert!(!said.contains(": good ("), "{said}");
        for phrase in ["warning: ", "completion.redirect", address, phrase] {
            assert!(said.contains(phrase), "no {phrase:?} in\n{said}");
        }
        let told: Value = serde_json::from_str(&check(&["--json"])).unwrap();
        assert_eq!(told[0]["warnings"][0]["field"], "completion.redirect", "{told}");
        edit(data.path(), "studies/small.toml", address, good);
    }
    edit(data.path(), "studies/small.toml", good, "https://example.org/?who=[who]");
    let server = Server::start_small(data.path());
    let studies = server.research(&server.sign_in(), "/api/v1/studies");
    let small = studies["items"].as_array().unwrap().iter().find(|study| study["id"] == "small").unwrap();
    assert_eq!(small["status"], "ready");
    assert_eq!(small["warnings"].as_array().unwrap().len(), 2, "{small}");
}

#[test]
fn what_cannot_be_drawn_is_found_by_drawing_it_small() {
    let data = small_data();
    // Good by each file alone: the size is not the screen's, a dome is nothing for shadow maps, a film tilts later.
    edit(data.path(), "studies/small.toml", "size = [64, 36]", "size = [64, 64]");
    assert!(wrong(data.path(), "small").contains("size = \"64x64\": what is shown is"));
    edit(data.path(), "studies/small.toml", "size = [64, 64]", "size = [64, 36]");
    edit(data.path(), "studies/small.toml", "technique = \"mc\"\nspp = 16", "technique = \"pcss\"");
    edit(data.path(), "scenes/near.toml", "model = \"none\"", "model = \"dome\"\nradiance = 1.0");
    let said = wrong(data.path(), "small");
    assert!(
        said.contains("blocks[0].pairs[0] = \"a\": cannot be drawn under condition mc")
            && said.contains("dome"),
        "{said}"
    );
}

#[test]
fn every_problem_stands_in_one_list_and_as_json() {
    let data = small_data();
    edit(data.path(), "studies/small.toml", "seed = 3", "edition = 2\nseed = -3");
    edit(data.path(), "studies/small.toml", "spp = 16", "spp = 0");
    edit(data.path(), "studies/small.toml", "&who=[PROLIFIC_PID]", "&who=[nobody]");
    edit(data.path(), "scenes/far.toml", "height_m = 0.9", "height_m = -0.9");
    let file = data.path().join("studies/small.toml");
    let out = kelir(&["study", "check", "--json", file.to_str().unwrap()]);
    assert_eq!(out.status.code(), Some(2));
    let told: Value = serde_json::from_slice(&out.stdout).unwrap();
    let problems = told[0]["problems"].as_array().unwrap();
    let fields: Vec<&str> = problems.iter().map(|p| p["field"].as_str().unwrap()).collect();
    for field in ["seed", "conditions.mc", "completion.redirect", "screen.height_m"] {
        assert!(fields.contains(&field), "no {field} in {fields:?}");
    }
    assert_eq!(problems[0]["value"], "-3", "{told}");
}

#[test]
fn a_new_study_is_good_and_is_served_and_nothing_is_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path().join("mine");
    let said = kelir_ok(&["new", dir.to_str().unwrap()]);
    assert!(said.contains("kelir study check") && said.contains("kelir serve --data"), "{said}");
    let study = dir.join("studies/my-study.toml");
    kelir_ok(&["study", "check", study.to_str().unwrap()]);
    kelir_ok(&[
        "scene",
        "check",
        dir.join("scenes/hare-near.toml").to_str().unwrap(),
        dir.join("scenes/hare-far.toml").to_str().unwrap(),
    ]);

    let before = std::fs::read(&study).unwrap();
    let out = kelir(&["new", dir.to_str().unwrap()]);
    assert_eq!(out.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&out.stderr).contains("is not empty"));
    assert_eq!(std::fs::read(&study).unwrap(), before);
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(left, ["mine"], "nothing half-written lies beside it");
    // An empty folder is taken.
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    kelir_ok(&["new", folder.path().join("empty").to_str().unwrap()]);
    // What is said to be typed can be typed.
    let odd = folder.path().join("it's mine");
    let said = kelir_ok(&["new", odd.to_str().unwrap()]);
    let quoted = format!("--data '{}'", odd.to_str().unwrap().replace('\'', "'\\''"));
    assert!(said.contains(&quoted), "no {quoted} in\n{said}");

    // The study that ships would take a minute to draw: a small one of the same name hides it.
    let small = small_data();
    for part in [
        "studies/shadow-puppets.toml",
        "scenes/near.toml",
        "scenes/far.toml",
        "scenes/dance.toml",
        "puppets/square.svg",
    ] {
        std::fs::copy(small.path().join(part), dir.join(part)).unwrap();
    }
    let server = Server::start_with(&dir, "my-study");
    let (status, told) = server.call("GET", "/api/v1/studies/my-study", None, &Value::Null);
    assert_eq!((status, &told["title"]), (200, &Value::from("Shadows of a hare")));
}

#[test]
fn what_ships_is_known_by_name_anywhere() {
    let empty = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| {
        let out = std::process::Command::new(kelir_tests::binary())
            .args(args)
            .current_dir(empty.path())
            .output()
            .unwrap();
        (
            out.status.code(),
            String::from_utf8_lossy(&out.stdout).into_owned(),
            String::from_utf8_lossy(&out.stderr).into_owned(),
        )
    };
    let good = |args: &[&str]| {
        let (code, out, err) = run(args);
        assert_eq!(code, Some(0), "{args:?}: {err}");
        out
    };
    let list: Value = serde_json::from_str(&good(&["scene", "list", "--json"])).unwrap();
    let names: Vec<&str> =
        list.as_array().unwrap().iter().map(|scene| scene["name"].as_str().unwrap()).collect();
    let shipped: Vec<String> = std::fs::read_dir(kelir_tests::root().join("stimuli/scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(names.len(), shipped.len());
    assert!(shipped.iter().all(|name| names.contains(&name.as_str())), "{names:?}");
    let near = list.as_array().unwrap().iter().find(|scene| scene["name"] == "arjuna-near").unwrap();
    assert!(near["shows"].as_str().unwrap().starts_with("Arjuna a hand's breadth"), "{near}");
    assert_eq!(
        (&near["screen_m"], &near["emitters"]),
        (&serde_json::json!([1.6, 0.9]), &serde_json::json!(["inner", "outer"]))
    );
    assert!(good(&["scene", "list"]).contains("arjuna-dance"));

    let small = ["--size", "64x36", "--backend", "cpu", "--technique", "pa"];
    good(&[&["render", "arjuna-near", "-o", "named.png"][..], &small].concat());
    let file = kelir_tests::root().join("stimuli/scenes/arjuna-near.toml");
    good(&[&["render", file.to_str().unwrap(), "-o", "file.png"][..], &small].concat());
    let read = |name: &str| std::fs::read(empty.path().join(name)).unwrap();
    assert_eq!(read("named.png"), read("file.png"), "a name and its file are one scene");
    let told = good(&[&["animate", "arjuna-dance", "--json", "-o", "film.apng"][..], &small].concat());
    assert!(serde_json::from_str::<Value>(&told).unwrap()["frames"].is_array());
    good(&["scene", "check", "putri-near", "benchmark"]);

    let (code, _, said) = run(&["render", "arjuna-neer", "-o", "x.png", "--technique", "pa"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("did you mean arjuna-near") && said.contains(".toml"), "{said}");
    assert!(!empty.path().join("x.png").exists());
    let (code, _, said) = run(&["render", "./arjuna-near", "-o", "x.png", "--technique", "pa"]);
    assert_eq!(code, Some(2), "a path is a file: {said}");
}

#[test]
fn one_json_on_every_command_that_prints_results_and_old_spellings_still_work() {
    let parsed = |args: &[&str]| {
        serde_json::from_str::<Value>(&kelir_ok(args)).unwrap_or_else(|e| panic!("{args:?}: {e}"))
    };
    let counts = ["stats", "ttest", "--counts", "0:26,1:7", "--mu", "0.5"];
    let t = parsed(&[&counts[..], &["--json"]].concat());
    assert_eq!(t, parsed(&[&counts[..], &["--format", "json"]].concat()));
    parsed(&["paper", "taylor-cameron", "--json"]);
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("x.exr");
    let draw = [
        "render",
        "kayon",
        "--technique",
        "mc",
        "--spp",
        "16",
        "--size",
        "64x36",
        "--backend",
        "cpu",
        "-o",
        picture.to_str().unwrap(),
    ];
    let keys = |value: Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
    assert_eq!(
        keys(parsed(&[&draw[..], &["--json"]].concat())),
        keys(parsed(&[&draw[..], &["--stats", "json"]].concat()))
    );
    let data = small_data();
    let server = Server::start_small(data.path());
    let at = ["--data", data.path().to_str().unwrap()];
    for command in [&["stats", "small"][..], &["study", "versions", "small"], &["chain", "check", "small"]] {
        let with = |more: &[&str]| parsed(&[command, &at, more].concat());
        assert_eq!(with(&["--json"]), with(&["--format", "json"]), "{command:?}");
    }
    parsed(&[&["study", "link", "small", "--json"][..], &at].concat());
    drop(server);
    parsed(&["scene", "check", "kayon", "--json"]);
}

/// The README's commands of the binary alone, run one after the other in an empty folder.
#[test]
fn the_readmes_commands_are_true_from_an_empty_folder() {
    let readme = std::fs::read_to_string(kelir_tests::root().join("README.md")).unwrap();
    let block = readme.split("## The binary alone").nth(1).unwrap().split("```").nth(1).unwrap();
    let lines = block.lines().filter(|line| line.starts_with("kelir "));
    let commands: Vec<Vec<&str>> =
        lines.map(|line| line.split('#').next().unwrap().split_whitespace().skip(1).collect()).collect();
    assert!(commands.len() > 20, "{}", commands.len());
    let empty = tempfile::tempdir().unwrap();
    // These run for ever, or for minutes; names of what they draw are tried by others.
    let long = ["serve", "bench", "power", "animate"];
    // These work; those of a study that nobody has taken say so, and what they say is not about their arguments.
    let works = [
        "new",
        "study check mine/studies/my-study.toml",
        "scene list",
        "render",
        "study link",
        "stats ttest",
        "paper",
    ];
    let mut worked = 0;
    for command in commands.iter().filter(|command| !long.contains(&command[0])) {
        let small: &[&str] =
            if command[0] == "render" && !command.contains(&"--size") { &["--size", "64x36"] } else { &[] };
        let out = std::process::Command::new(kelir_tests::binary())
            .args(command)
            .args(small)
            .current_dir(empty.path())
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&out.stderr);
        assert!(!said.contains("Usage:") && !said.contains("try '--help'"), "{command:?}: {said}");
        if works.iter().any(|name| command.join(" ").starts_with(name)) {
            assert!(out.status.success(), "{command:?}: {said}");
            worked += 1;
        }
    }
    assert!(worked >= works.len(), "{worked}");
}
