# Expected values of tests and intervals: Rscript make_inference.R > inference_r.tsv
# R 4.2.2; exactRankTests 0.8, BayesFactor 0.9.12 (Debian).
suppressMessages({library(exactRankTests); library(BayesFactor)})
out <- function(key, value) cat(key, "\t", sprintf("%.17g", value), "\n", sep = "")
samples <- list(mc = rep(0:2, c(12, 14, 6)), photo = rep(0:2, c(3, 10, 19)), video = rep(0:1, c(26, 7)),
                small = c(1.5, -0.25, 3))
mus <- list(mc = 1, photo = 1, video = 0.5, small = 0)
for (name in names(samples)) {
  test <- t.test(samples[[name]], mu = mus[[name]])
  out(paste0("t.", name), test$statistic)
  out(paste0("t_p.", name), test$p.value)
}
for (case in list(c(7, 33, 0.5), c(0, 10, 0.3), c(10, 10, 0.3), c(26, 64, 0.5), c(3, 20, 0.11), c(11, 20, 0.4), c(480, 1000, 0.5),
                  c(70, 1000, 0.1), c(4, 8, 0.5), c(1, 1, 0.9), c(500500, 1000000, 0.5), c(299, 1000000, 0.0003))) {
  key <- paste(case[1:2], collapse = "/")
  test <- binom.test(case[1], case[2], case[3])
  out(paste0("binom_p.", key, ".", case[3]), test$p.value)
  if (case[2] <= 1000) {
    out(paste0("clopper_low.", key), test$conf.int[1])
    out(paste0("clopper_high.", key), test$conf.int[2])
    out(paste0("jeffreys_low.", key), if (case[1] == 0) 0 else qbeta(0.025, case[1] + .5, case[2] - case[1] + .5))
    out(paste0("jeffreys_high.", key), if (case[1] == case[2]) 1 else qbeta(0.025, case[1] + .5, case[2] - case[1] + .5, lower = FALSE))
    wilson <- suppressWarnings(prop.test(case[1], case[2], correct = FALSE))$conf.int
    out(paste0("wilson_low.", key), wilson[1])
    out(paste0("wilson_high.", key), wilson[2])
  }
}
out("sign_p.mc", binom.test(6, 18)$p.value)
out("sign_p.photo", binom.test(19, 22)$p.value)
ranks <- list(mc = samples$mc - 1, photo = samples$photo - 1, mixed = c(1.1, -0.3, 2.5, 2.5, -1.1, 0, 4, 0.3, -0.3, 7))
for (name in names(ranks)) {
  test <- wilcox.exact(ranks[[name]], exact = TRUE)
  out(paste0("wilcoxon_v.", name), test$statistic)
  out(paste0("wilcoxon_p.", name), test$p.value)
}
many <- ((0:509) * 37) %% 101 - 47
out("wilcoxon_normal_p", suppressWarnings(wilcox.test(many, exact = FALSE, correct = TRUE)$p.value))
p <- c(0.160569, 2.03782e-4, 3.66864e-4, 0.04, 0.04, 0.9, 1, 0)
for (method in c("holm", "hochberg", "BH"))
  for (i in seq_along(p)) out(paste0(method, ".", i - 1), p.adjust(p, method)[i])
for (case in list(c(-1.4375905768565216, 32), c(4.20883424647321, 32), c(0, 20), c(12, 50))) {
  bf <- ttest.tstat(case[1], case[2], rscale = sqrt(2) / 2, simple = FALSE)
  out(paste0("ln_bf10.", case[1], "/", case[2]), bf$bf)
}
for (case in list(c(32, 0.5), c(32, 0.2), c(10, 1), c(3, 0.7)))
  out(paste0("power_t.", case[1], ".", case[2]), power.t.test(case[1], case[2], type = "one.sample", strict = TRUE)$power)
mc <- samples$mc
for (delta in list(c("points", 0.5), c("sd", 0.5 * sd(mc)))) {
  half <- as.numeric(delta[2]); if (delta[1] == "sd") half <- 0.5 * sd(mc)
  out(paste0("tost_p.", delta[1]), max(t.test(mc, mu = 1 - half, alternative = "greater")$p.value,
                                       t.test(mc, mu = 1 + half, alternative = "less")$p.value))
}
interval <- t.test(mc, mu = 1, conf.level = 0.9)$conf.int - 1
out("tost_low", interval[1]); out("tost_high", interval[2])
for (case in list(c(48, 64), c(20, 64), c(33, 34)))
  out(paste0("dprime.", case[1], "/", case[2]), sqrt(2) * qnorm(case[1] / case[2]))
