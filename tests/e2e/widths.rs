//! `KELIR_SIMD`: every instruction set of this machine draws the same bytes, says which it was, and a wrong word is refused.

use std::path::Path;
use std::process::{Command, Output};

use kelir_fixtures as fixtures;
use kelir_tests::{binary, root};
use serde_json::Value;

/// Every word, and whether this machine has what it names.
fn words() -> [(&'static str, bool); 3] {
    #[cfg(target_arch = "x86_64")]
    {
        let wide = std::arch::is_x86_feature_detected!("avx512vbmi");
        [("baseline", true), ("avx2", std::arch::is_x86_feature_detected!("avx2")), ("avx512", wide)]
    }
    #[cfg(not(target_arch = "x86_64"))]
    [("baseline", true), ("avx2", false), ("avx512", false)]
}

fn kelir(word: &str, args: &[&str]) -> Output {
    Command::new(binary()).args(args).env("KELIR_SIMD", word).current_dir(root()).output().unwrap()
}

/// The picture that a technique draws of a scene with this word, and what drew it.
fn drawn(word: &str, scene: &str, technique: &[&str], name: &str, folder: &Path) -> (Vec<u8>, String) {
    let out = folder.join(name);
    let file = out.to_str().unwrap();
    let what = ["render", scene, "--size", "160x90", "--backend", "cpu", "--json", "-o", file, "--technique"];
    let done = kelir(word, &[&what[..], technique].concat());
    assert!(done.status.success(), "{word}: {}", String::from_utf8_lossy(&done.stderr));
    let told: Value = serde_json::from_slice(&done.stdout).unwrap();
    (std::fs::read(out).unwrap(), told["adapter"].as_str().unwrap().to_owned())
}

/// Of every technique that has loops of its own for each instruction set, codes and floats; a puppet that is tilted, and a dome.
#[test]
fn every_instruction_set_of_this_machine_draws_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let scene = fixtures::SCENE.replace("../puppets/", "");
    let dome = scene.replace("model = \"none\"", "model = \"dome\"\nradiance = 3.0");
    let tilted = format!("{scene}tilt_deg = [25.0, -40.0]\n");
    let files = [("square.svg", fixtures::SQUARE), ("dome.toml", &dome), ("tilted.toml", &tilted)];
    fixtures::write(folder.path(), &files);
    let [dome, tilted] =
        ["dome.toml", "tilted.toml"].map(|file| folder.path().join(file).display().to_string());
    for (scene, technique, name) in [
        ("benchmark", &["pa"][..], "a.png"),
        ("benchmark", &["pa", "--split", "2"], "a.exr"),
        ("kayon", &["mc", "--spp", "16"], "a.exr"),
        ("kayon", &["points"], "a.png"),
        ("kayon", &["pcss"], "a.png"),
        (&dome, &["pa"], "a.exr"),
        (&tilted, &["pa"], "a.exr"),
    ] {
        let (best, adapter) = drawn("", scene, technique, name, folder.path());
        assert!(!adapter.contains("forced"), "{adapter}");
        for (word, _) in words().into_iter().filter(|(_, here)| *here) {
            let (bytes, adapter) = drawn(word, scene, technique, name, folder.path());
            assert!(bytes == best, "{scene}, {technique:?}: {word} draws something else");
            assert!(adapter.ends_with(&format!("{word} (forced by KELIR_SIMD)")), "{word}: {adapter}");
        }
    }
    // The negative control: another seed is seen.
    let mc =
        |seed| drawn("baseline", "kayon", &["mc", "--spp", "16", "--seed", seed], "b.exr", folder.path()).0;
    assert!(mc("1") != mc("2"));
}

/// Whatever is asked, a word that names nothing here ends the program before it does anything.
#[test]
fn a_wrong_word_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.png");
    let absent =
        words().into_iter().filter(|(_, here)| !here).map(|(word, _)| (word, "this machine has baseline"));
    for (word, rule) in
        absent.chain([("AVX2", "must be one of baseline"), ("plain", "must be one of baseline")])
    {
        for args in
            [&["render", "kayon", "--technique", "pa", "-o", file.to_str().unwrap()][..], &["scene", "list"]]
        {
            let out = kelir(word, args);
            let said = String::from_utf8_lossy(&out.stderr).into_owned();
            assert_eq!(out.status.code(), Some(2), "{word}: {said}");
            assert!(
                said.contains("KELIR_SIMD = ") && said.contains(rule) && !said.contains("panicked"),
                "{said}"
            );
            assert!(out.stdout.is_empty() && !file.exists());
        }
    }
}
