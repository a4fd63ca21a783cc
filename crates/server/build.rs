//! Builds the web pages (`web/`) into `OUT_DIR/web`, from where the server embeds them.
//!
//! It needs Node and npm, and says so when they are missing: a server without its pages would only look like one.
//! `KELIR_WEB_DIST=DIR` names a bundle that was built elsewhere (`node web/build.mjs DIR`) and is embedded as it is.
//! Nothing is written outside `web/node_modules` and `OUT_DIR`.
#![allow(clippy::print_stdout, reason = "cargo's protocol with build scripts")]

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// What the pages are made of, seen from `web/`. `node_modules` is not watched: the lock file says what is in it.
const SOURCES: [&str; 8] = [
    "browsers.json",
    "build.mjs",
    "console",
    "package-lock.json",
    "package.json",
    "participant",
    "shared",
    "../crates/report/src/shared.css",
];

/// The two shells that every bundle has.
const SHELLS: [&str; 2] = ["participant.html", "console.html"];

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            for line in problem.lines() {
                println!("cargo::error={line}");
            }
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    let out = PathBuf::from(env("OUT_DIR")?).join("web");
    let web = Path::new(&env("CARGO_MANIFEST_DIR")?).ancestors().nth(2).unwrap_or(Path::new("/")).join("web");

    println!("cargo::rerun-if-env-changed=KELIR_WEB_DIST");
    if let Some(dist) = std::env::var_os("KELIR_WEB_DIST").map(PathBuf::from) {
        println!("cargo::rerun-if-changed={}", dist.display());
        return copy_bundle(&dist, &out);
    }
    for source in SOURCES {
        println!("cargo::rerun-if-changed={}", web.join(source).display());
    }
    install_packages(&web)?;
    call("node", &[&web.join("build.mjs"), &out], &web, "building the web pages")
}

/// `npm ci` when `web/node_modules` is not what the lock file says. Linters and browsers' drivers come only to who has them already.
fn install_packages(web: &Path) -> Result<(), String> {
    let lock = web.join("package-lock.json");
    let failed = |error: io::Error| format!("{}: {error}", lock.display());
    // Two builds of one checkout (an editor's and a terminal's) must not install into one folder at once.
    let guard = fs::File::open(&lock).map_err(failed)?;
    guard.lock().map_err(failed)?;
    let wanted = fs::read(&lock).map_err(failed)?;
    let stamp = web.join("node_modules/.kelir-installed");
    if fs::read(&stamp).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    let npm = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let mut arguments = vec!["ci", "--ignore-scripts", "--no-audit", "--no-fund"];
    if !web.join("node_modules/@biomejs").exists() {
        arguments.push("--omit=dev");
    }
    call(npm, &arguments, web, "installing the web pages' packages")?;
    fs::write(&stamp, wanted).map_err(|error| format!("{}: {error}", stamp.display()))
}

/// Runs a program in `web/`; its output is part of the message when it fails.
fn call(program: &str, arguments: &[impl AsRef<Path>], web: &Path, what: &str) -> Result<(), String> {
    let output = Command::new(program)
        .args(arguments.iter().map(|argument| argument.as_ref().as_os_str()))
        .current_dir(web)
        .output()
        .map_err(|error| {
            format!(
                "{what} needs `{program}`, which could not be started: {error}.\n\
                 Install Node 20 or newer with npm (https://nodejs.org, or your distribution's nodejs and npm packages),\n\
                 or set KELIR_WEB_DIST to a bundle built elsewhere with `node web/build.mjs DIR`."
            )
        })?;
    if output.status.success() {
        return Ok(());
    }
    Err(format!(
        "{what} failed ({}, in {}):\n{}{}",
        output.status,
        web.display(),
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    ))
}

/// Embeds a bundle that was built elsewhere.
fn copy_bundle(dist: &Path, out: &Path) -> Result<(), String> {
    for shell in SHELLS {
        if !dist.join(shell).is_file() {
            return Err(format!(
                "KELIR_WEB_DIST = {}: has no {shell}; build one with `node web/build.mjs DIR`",
                dist.display()
            ));
        }
    }
    let _ = fs::remove_dir_all(out);
    copy_tree(dist, out).map_err(|error| format!("KELIR_WEB_DIST = {}: {error}", dist.display()))
}

fn copy_tree(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_tree(&entry.path(), &target)?;
        } else {
            fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}

fn env(name: &str) -> Result<String, String> {
    std::env::var(name).map_err(|error| format!("{name}: {error}"))
}
