#!/usr/bin/env Rscript
# A second opinion on clustered.json: prints what sandwich and lme4 say of the same data (not read by the tests; lme4's optimiser stops at ~1e-5).
suppressPackageStartupMessages({library(lme4); library(sandwich)})
for (counts in list(c(12, 14, 6), c(3, 10, 19), c(6, 3, 4, 5, 9))) {
  k <- rep(seq_along(counts) - 1, counts); n <- length(counts) - 1; id <- seq_along(k)
  m <- glmer(cbind(k, n - k) ~ 1 + (1 | id), family = binomial, nAGQ = 50)
  y <- unlist(lapply(k, function(k) rep(c(1, 0), c(k, n - k)))); g <- rep(id, each = n)
  f <- glm(y ~ 1, family = binomial, epsilon = 1e-14)
  cat(sprintf("beta %.10f sigma %.10f | logit %.12f CR0 %.12f CR1s %.12f\n", fixef(m), attr(VarCorr(m)$id, "stddev"), coef(f),
    sqrt(vcovCL(f, g, type = "HC0", cadjust = FALSE)), sqrt(vcovCL(f, g, type = "HC1"))))
}
