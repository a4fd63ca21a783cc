#!/usr/bin/env Rscript
# Writes pairwise_r.json: Bradley-Terry (logit) and Thurstone Case V (probit) by R's glm at epsilon = 1e-14, the maximum BradleyTerry2 finds too.
cases <- list(
  complete = rbind(c(0, 21, 25, 30), c(9, 0, 18, 24), c(5, 12, 0, 16), c(2, 6, 14, 0)),
  incomplete = rbind(c(0, 7, 0, 0, 0, 12), c(3, 0, 55, 0, 1, 0), c(0, 45, 0, 8, 0, 0), c(0, 0, 4, 0, 30, 0), c(0, 2, 0, 10, 0, 5), c(3, 0, 0, 0, 6, 0)))
lines <- c()
for (name in names(cases)) for (link in c("logit", "probit")) {
  d <- cases[[name]]; n <- nrow(d); x <- NULL; k <- c(); m <- c()
  for (i in 1:(n - 1)) for (j in (i + 1):n) if (d[i, j] + d[j, i] > 0) {
    r <- rep(0, n); r[i] <- 1; r[j] <- -1; x <- rbind(x, r); k <- c(k, d[i, j]); m <- c(m, d[j, i])
  }
  f <- glm(cbind(k, m) ~ 0 + x[, -1], family = binomial(link), epsilon = 1e-14, control = list(epsilon = 1e-14, maxit = 100))
  t <- c(0, unname(coef(f))); jod <- (t - mean(t)) / (if (link == "logit") log(3) else qnorm(.75))
  lines <- c(lines, sprintf('  {"case": "%s", "link": "%s", "deviance": %.17g, "df": %d, "jod": [%s]}', name, link, deviance(f), df.residual(f), paste(sprintf("%.17g", jod), collapse = ", ")))
}
writeLines(c("[", paste(lines, collapse = ",\n"), "]"), "pairwise_r.json")
