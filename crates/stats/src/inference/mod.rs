//! Tests, intervals and effect sizes.

mod t_test;

pub use t_test::{TTest, t_test_from_counts, t_test_one_sample, t_test_paired};
