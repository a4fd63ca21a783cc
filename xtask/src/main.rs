//! Project tasks: `cargo xtask serve | test | release | bench | gpu-check | soak | pictures`. Typed, no makefile beside it.
//!
//! It depends on nothing that takes long to build: a fresh machine meets it first.

mod gpu_check;
mod install;
mod run;

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::{Parser, Subcommand};

use install::{Need, ensure};
use run::{cargo, npm, step};

/// Project tasks.
#[derive(Parser)]
#[command(name = "cargo xtask")]
struct Cli {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Install what is missing, build, make the built-in study's stimuli and serve it on 127.0.0.1:8080.
    Serve {
        /// Where answers, stimuli and the researcher's password live.
        #[arg(long, default_value = "data")]
        data: PathBuf,
        /// Address to listen on.
        #[arg(long, default_value = "127.0.0.1:8080")]
        listen: String,
        /// Build the GPU backend too, for `render` and `animate` with the same binary; a machine with a real GPU gets it unasked.
        #[arg(long)]
        gpu: bool,
    },
    /// Install what the tests need and run everything: format, lints, unit, integration and end-to-end tests, the pages in Chromium.
    Test,
    /// Build all of kelir at its fastest, target/release/kelir: about twice the work of the first `serve`.
    Release,
    /// Measure speed and exactness with the release binary, on an otherwise idle machine: about a quarter of an hour.
    Bench,
    /// Put a folder together, target/gpu-check, that tries the GPU backend on a machine with a GPU and needs no compiler there.
    GpuCheck {
        /// A kelir with its GPU backend that is built already, in place of a release built now.
        #[arg(long)]
        kelir: Option<PathBuf>,
    },
    /// Attack the release binary (kills, disorder, floods, hostile bytes, a full disk) and its intervals (coverage). Some ten minutes; `--seed`, `--rounds`, `--seconds` and others
    /// are the attacks' own, as are their names (`cargo xtask soak --rounds 5 kill`).
    Soak {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        options: Vec<String>,
    },
    /// Make the README's pictures anew; the trial's and the report's come from the screenshots of the last `test`.
    Pictures,
}

fn main() -> Result<()> {
    let root = run::root();
    std::env::set_current_dir(&root)?;
    match Cli::parse().task {
        Task::Serve { data, listen, gpu } => serve(&data, &listen, gpu),
        Task::Test => test(),
        Task::Release => {
            ensure(&[Need::Node, Need::Cxx])?;
            eprintln!("── {}", release()?.display());
            Ok(())
        }
        Task::Bench => bench(),
        Task::GpuCheck { kelir } => {
            ensure(&[Need::Node, Need::Cxx])?;
            gpu_check::make(&kelir.map_or_else(release, Ok)?)
        }
        Task::Soak { options } => soak(&options),
        Task::Pictures => pictures(),
    }
}

/// Builds what serving needs and becomes the server; a second start builds and renders nothing again.
fn serve(data: &std::path::Path, listen: &str, gpu: bool) -> Result<()> {
    let gpu = gpu || install::has_gpu();
    ensure(if gpu { &[Need::Node, Need::Cxx, Need::Vulkan] } else { &[Need::Node, Need::Cxx] })?;
    let mut build = cargo(&["build", "--profile", "start", "--package", "kelir", "--no-default-features"]);
    if gpu {
        build.args(["--features", "gpu"]);
    }
    step("build", build)?;
    let binary = run::target_dir().join("start/kelir");
    let mut server = std::process::Command::new(&binary);
    server.arg("serve").arg("--data").arg(data).args(["--listen", listen]);
    let status = server.status()?;
    if !status.success() {
        bail!("{} ended with {status}", binary.display());
    }
    Ok(())
}

/// Builds the release binary and answers where it is.
fn release() -> Result<PathBuf> {
    step(
        "build",
        cargo(&["build", "--release", "--workspace", "--exclude", "xtask", "--exclude", "kelir-tests"]),
    )?;
    Ok(run::target_dir().join("release/kelir"))
}

/// Every benchmark, one after the other, so that none slows another down.
fn bench() -> Result<()> {
    ensure(&[Need::Node, Need::Cxx, Need::Vulkan])?;
    let kelir = release()?;
    const SCENE: &str = "stimuli/scenes/benchmark.toml";
    let runs: [(&str, &[&str]); 7] = [
        ("frames, native", &["frames", SCENE, "--technique", "pa", "--backend", "cpu", "--frames", "300"]),
        ("frames, wgpu", &["frames", SCENE, "--technique", "pa", "--backend", "gpu", "--frames", "60"]),
        (
            "scaling",
            &["frames", SCENE, "--technique", "pa", "--backend", "cpu", "--frames", "60", "--scaling"],
        ),
        ("error against time", &["accuracy", SCENE]),
        ("exactness of the images", &["numerics"]),
        ("exactness of the statistics", &["numerics", "--stats"]),
        ("a million answers", &["rows"]),
    ];
    for (name, args) in runs {
        let mut command = std::process::Command::new(&kelir);
        command.arg("bench").args(args);
        step(name, command)?;
    }
    step("kernels", cargo(&["bench", "--package", "kelir-theatre"]))
}

/// The attacks of `tests/soak` on the release binary.
fn soak(options: &[String]) -> Result<()> {
    ensure(&[Need::Node, Need::Cxx, Need::Sqlite])?;
    let kelir = release()?;
    let mut attacks = cargo(&["run", "--quiet", "--package", "kelir-tests", "--bin", "soak", "--"]);
    attacks.args(options).env("KELIR_BIN", kelir);
    step("attacks", attacks)
}

/// The README's pictures, from the product itself.
fn pictures() -> Result<()> {
    ensure(&[Need::Node, Need::Cxx])?;
    let folder = run::root().join("docs/pictures");
    std::fs::create_dir_all(&folder)?;
    let kelir = release()?;
    let mut accuracy = std::process::Command::new(&kelir);
    accuracy.args(["bench", "accuracy", "stimuli/scenes/benchmark.toml", "--plot"]);
    accuracy.arg(folder.join("accuracy.svg"));
    step("accuracy.svg", accuracy)?;
    let mut scene = std::process::Command::new(kelir);
    scene.args([
        "render",
        "stimuli/scenes/pertemuan.toml",
        "--technique",
        "pa",
        "--backend",
        "cpu",
        "--size",
        "960x540",
        "-o",
    ]);
    scene.arg(folder.join("scene.png"));
    step("scene.png", scene)?;
    for (shot, picture) in
        [("participant-trial-2-1280x800.png", "trial.png"), ("report-top.png", "report.png")]
    {
        let shot = run::root().join("tests/screenshots").join(shot);
        std::fs::copy(&shot, folder.join(picture))
            .with_context(|| format!("{}: run `cargo xtask test` first", shot.display()))?;
    }
    Ok(())
}

/// Everything the gate holds.
fn test() -> Result<()> {
    ensure(&[Need::Node, Need::Cxx, Need::Vulkan, Need::Chromium, Need::Sqlite, Need::Bunny])?;
    step("format", cargo(&["fmt", "--all", "--check"]))?;
    step("web packages", npm("web", &["ci", "--ignore-scripts"]))?;
    step("web lint", npm("web", &["run", "lint"]))?;
    step("web types", npm("web", &["run", "check"]))?;
    step("web units", npm("web", &["test"]))?;
    step("browser driver", npm("tests", &["ci", "--ignore-scripts"]))?;
    step("lints", cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    step(
        "lints of what `serve` builds",
        cargo(&["clippy", "--workspace", "--no-default-features", "--", "-D", "warnings"]),
    )?;
    let mut docs = cargo(&["doc", "--workspace", "--no-deps", "--document-private-items", "--quiet"]);
    docs.env("RUSTDOCFLAGS", "-D warnings");
    step("documentation", docs)?;
    // The end-to-end tests run the real binary, so it is built first.
    step("build", cargo(&["build", "--workspace"]))?;
    run::tests("tests", cargo(&["test", "--workspace"]))?;
    eprintln!("── all tests passed");
    Ok(())
}
