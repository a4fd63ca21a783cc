#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

use super::*;

fn close(a: Option<f64>, b: f64, rel: f64) {
    let a = a.unwrap();
    assert!((a - b).abs() <= rel * b.abs(), "{a} is not {b}");
}

#[test]
fn the_papers_counts_give_the_issues_numbers() {
    let test = TTest::of_counts(&[(0, 12), (1, 14), (2, 6)].into(), 1.0);
    assert_eq!(test.n, 32);
    close(test.mean, 0.8125, 1e-15);
    close(test.sd, 0.737_804, 1e-6);
    close(test.t, -1.437_591, 1e-6);
    close(test.p, 0.160_568_633_894_124_73, 1e-12); // R 4.2.2, as the t
    let test = TTest::of_counts(&[(0, 3), (1, 10), (2, 19)].into(), 1.0);
    close(test.t, 4.208_834, 1e-6);
    close(test.p, 2.037_821_916_722_820_6e-4, 1e-12);
    let test = TTest::of_counts(&[(0, 26), (1, 7)].into(), 0.5);
    close(test.t, -3.983_482, 1e-6);
    close(test.p, 3.668_638_983_360_312e-4, 1e-12);
}

#[test]
fn what_is_not_defined_is_null_with_a_note() {
    for counts in [vec![], vec![(1, 1)], vec![(2, 5)], vec![(0, 0), (1, 0)]] {
        let test = TTest::of_counts(&counts.into_iter().collect(), 1.0);
        assert!(test.t.is_none() && test.p.is_none() && test.note.is_some(), "{test:?}");
    }
}
