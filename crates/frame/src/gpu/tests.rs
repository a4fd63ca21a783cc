#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;

/// A machine without an adapter gets told what to install; this one has at least the software adapter.
#[test]
fn adapters_are_listed_and_auto_never_takes_a_software_one() {
    assert!(!adapters().is_empty(), "{HOW_TO_INSTALL}");
    assert!(choose(Backend::Cpu).unwrap().is_none());
    assert!(choose(Backend::Auto).unwrap().is_none_or(|gpu| !gpu.is_software()));
    let gpu = choose(Backend::Gpu).unwrap().unwrap();
    assert!(adapters().contains(&gpu.adapter()));
}

/// A shader that does not compile is an error that names the adapter, and the device stays failed; no panic.
#[test]
fn a_failed_device_is_an_error() {
    let gpu = choose(Backend::Gpu).unwrap().unwrap();
    gpu.check().unwrap();
    gpu.module("broken", "this is not WGSL");
    let error = gpu.check().unwrap_err().to_string();
    assert!(error.contains(&gpu.adapter()), "{error}");
    assert!(gpu.check().is_err());
}

#[path = "../no_gpu.rs"]
#[allow(dead_code, unreachable_pub, reason = "only the choice is tried")]
mod absent;

/// A kelir without its GPU backend draws natively, and says what builds one where the GPU is asked for.
#[test]
fn a_build_without_a_gpu_says_so() {
    assert!(absent::choose(Backend::Auto).unwrap().is_none());
    assert!(absent::choose(Backend::Cpu).unwrap().is_none());
    let message = absent::choose(Backend::Gpu).err().unwrap().to_string();
    assert!(message.contains("cargo xtask release") && message.contains("serve --gpu"), "{message}");
}
