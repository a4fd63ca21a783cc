//! Probability distributions, with both tails, their logarithms and their quantiles.
