//! As many mutated scenes, puppets and images as a minute allows in CI, and two seconds elsewhere.
//!
//! `CI` asks for the minute with a seed of the day; `KELIR_FUZZ_SECONDS` and `KELIR_FUZZ_SEED` set them. A failure names the seed
//! that finds it again.

use std::io::Cursor;
use std::time::{Duration, Instant, SystemTime};

use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

use crate::fuzz::{FULL, full_files, mutate, mutation, read};

/// Inputs a seed.
const CASES: u32 = 32;

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

fn jpeg() -> Vec<u8> {
    let image = image::RgbImage::from_fn(16, 12, |x, y| image::Rgb([9 * x as u8, 20 * y as u8, 77]));
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Jpeg).unwrap();
    bytes.into_inner()
}

/// What is mutated: a file of the scene, under a name of the scene's files; None is the scene itself.
fn targets() -> Vec<(&'static str, Option<&'static str>, Vec<u8>)> {
    let files = full_files();
    let file = |what, name: &'static str| (what, Some(name), files[name].clone());
    vec![
        ("scene", None, FULL.as_bytes().to_vec()),
        file("SVG", "puppets/figure.svg"),
        file("manifest", "puppets/figure.toml"),
        file("PNG", "puppets/p.png"),
        ("JPEG", Some("puppets/p.png"), jpeg()),
    ]
}

/// Reads the scene with `bytes` in the place of one file.
fn read_with(name: Option<&str>, bytes: Vec<u8>) -> Result<bool, TestCaseError> {
    let mut files = full_files();
    match name {
        None => read(&String::from_utf8_lossy(&bytes), &files),
        Some(name) => {
            files.insert(name.to_owned(), bytes);
            read(FULL, &files)
        }
    }
}

/// Goes from seed to seed until the time is over; tells how many inputs were tried.
fn fuzz(what: &str, name: Option<&str>, bytes: &[u8], seed: u64, end: Instant) -> u64 {
    let mut tried = 0;
    for seed in seed.. {
        let config = Config {
            cases: CASES,
            rng_seed: RngSeed::Fixed(seed),
            failure_persistence: None,
            ..Config::default()
        };
        let mutations = prop::collection::vec(mutation(), 1..12);
        let found = TestRunner::new(config)
            .run(&mutations, |mutations| read_with(name, mutate(bytes, &mutations)).map(drop));
        if let Err(error) = found {
            panic!("a mutated {what}: {error}\nfind it again with KELIR_FUZZ_SEED={seed}");
        }
        tried += u64::from(CASES);
        if Instant::now() >= end {
            break;
        }
    }
    tried
}

#[test]
fn whatever_a_minute_finds() {
    let ci = std::env::var_os("CI").is_some();
    let days = || SystemTime::UNIX_EPOCH.elapsed().map_or(0, |t| t.as_secs() / 86400);
    let seed = number("KELIR_FUZZ_SEED").unwrap_or_else(|| if ci { days() << 32 } else { 0 });
    let seconds = number("KELIR_FUZZ_SECONDS").unwrap_or(if ci { 60 } else { 2 });
    // The unmutated files are good, so that mutations reach beyond the first check.
    for (what, name, bytes) in targets() {
        assert!(read_with(name, bytes).unwrap(), "{what}");
    }
    let end = Instant::now() + Duration::from_secs(seconds);
    std::thread::scope(|scope| {
        let runs: Vec<_> = targets()
            .into_iter()
            .map(|(what, name, bytes)| (what, scope.spawn(move || fuzz(what, name, &bytes, seed, end))))
            .collect();
        for (what, run) in runs {
            let tried = run.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            println!("{tried} mutated inputs of kind {what} from seed {seed} on");
            assert!(tried > 0);
        }
    });
}
