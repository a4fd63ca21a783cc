//! `kelir bench gpu` where there is none. What it compares is tested where it stands, with the techniques.

use std::process::Command;

use kelir_tests::{binary, root};

/// A machine without any adapter is told what to install, and nothing passes.
#[test]
fn a_machine_without_an_adapter_is_told() {
    let mut bench = Command::new(binary());
    // Drivers that are not there.
    bench
        .args(["bench", "gpu"])
        .env("VK_DRIVER_FILES", "/nowhere.json")
        .env("VK_ICD_FILENAMES", "/nowhere.json");
    let out = bench.current_dir(root()).output().unwrap();
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(1), "{said}");
    assert!(said.contains("no Vulkan adapter: install a driver") && out.stdout.is_empty(), "{said}");
}
