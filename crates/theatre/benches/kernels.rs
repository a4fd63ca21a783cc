//! The inner loops alone, on one thread but for the table: `cargo bench -p kelir-theatre`.

use divan::Bencher;
use divan::counter::ItemsCount;
use kelir_theatre::kernels::{self, Kernel};

fn main() {
    eprintln!("Instruction set {}.", kelir_frame::Isa::provenance());
    divan::main();
}

fn time(bencher: Bencher, mut kernel: Kernel) {
    bencher.counter(ItemsCount::new(kernel.items)).bench_local(|| kernel.run());
}

/// Texels a second into a u32 table, all threads.
#[divan::bench(args = [256, 1024, 4096])]
fn table_u8(bencher: Bencher, side: usize) {
    time(bencher, kernels::table(side, 8));
}

/// Texels a second of 16 bits into a u64 table, all threads.
#[divan::bench(args = [256, 1024, 4096])]
fn table_u16(bencher: Bencher, side: usize) {
    time(bencher, kernels::table(side, 16));
}

/// Texels a second copied u8 to u32 on all threads: what building a table can't beat.
#[divan::bench(args = [256, 1024, 4096])]
fn widening_copy(bencher: Bencher, side: usize) {
    time(bencher, kernels::copy(side));
}

/// Pixels a second: table rows combined for one image row, and its boxes looked up.
#[divan::bench(args = [1e-3, 0.02, 0.1])]
fn row_look_up(bencher: Bencher, emitter_m: f64) {
    time(bencher, kernels::row(emitter_m));
}

/// Values a second from linear light to sRGB codes.
#[divan::bench]
fn srgb(bencher: Bencher) {
    time(bencher, kernels::srgb());
}

/// Samples a second through one plane.
#[divan::bench(args = [16, 64, 256])]
fn mc_samples(bencher: Bencher, spp: u32) {
    time(bencher, kernels::samples(spp));
}
