//! The stimuli folder is embedded: a file that is new there is not among the sources cargo knows.
#![allow(clippy::print_stdout, reason = "cargo's protocol with build scripts")]

fn main() {
    println!("cargo::rerun-if-changed=../../stimuli");
}
