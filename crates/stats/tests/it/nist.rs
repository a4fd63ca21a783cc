#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that fails here says where, and prints what it measured"
)]

use kelir_stats::numerics;

/// Every statistic is that of exact arithmetic on the f64 inputs, to rounding, and so reaches NIST's digits up to the
/// ceiling that parsing the decimals sets. Printed by `cargo test -p kelir-stats --test it nist -- --nocapture`.
#[test]
fn nist_sets_reach_their_ceiling() {
    let rows = numerics::nist().unwrap();
    assert_eq!(rows.len(), 36);
    for row in &rows {
        println!(
            "{:9} {:16} digits {:5.1}, ceiling {:5.1}",
            row.set,
            row.statistic,
            row.digits(),
            row.ceiling()
        );
        let error = ((row.computed - row.exact) / row.exact).abs();
        assert!(error < 4e-16, "{row:?}: {error:e}");
        assert!(row.digits() > row.ceiling() - 0.3, "{row:?}");
    }
}

/// Control: the textbook one-pass formula must not pass for exact.
#[test]
fn a_naive_variance_would_be_found_out() {
    let row =
        numerics::nist().unwrap().into_iter().find(|r| r.set == "NumAcc4" && r.statistic == "sd").unwrap();
    let values: Vec<f64> =
        std::iter::once(10000000.2).chain((0..500).flat_map(|_| [10000000.1, 10000000.3])).collect();
    let n = values.len() as f64;
    let (sum, squares) = values.iter().fold((0.0, 0.0), |(s, q), x| (s + x, q + x * x));
    let naive = ((squares - sum * sum / n) / (n - 1.0)).sqrt();
    let error = ((naive - row.exact) / row.exact).abs();
    assert!(error.is_nan() || error > 1e-3, "{naive}");
}
