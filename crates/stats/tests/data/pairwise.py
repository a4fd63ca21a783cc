#!/usr/bin/env python3
"""Writes pairwise.json: oracles for kelir-stats' scaling. Needs mpmath, numpy, scipy. pairwise.R gives R's word on the same Bradley-Terry fits.

Maximum likelihood: the gradient of the plain log likelihood, written from the definition, put to zero by a root finder and Newton steps; the objective of
pwcmp's pw_scale with prior = 'none' (sigma 1.4826, mean-zero regularisation 0.01*mean(q)^2) made stationary on its own in 40-digit arithmetic (mpmath) and rescaled to exact JOD.
Jeffreys: likelihood + half the log determinant of the Fisher information, made stationary likewise.
Circular triads: all 2^(n(n-1)/2) tournaments.
"""
import itertools
import json
from collections import Counter
import mpmath as mp
import numpy as np
import scipy.optimize as so
from scipy.stats import norm

CASES = {
    "complete": [[0, 21, 25, 30], [9, 0, 18, 24], [5, 12, 0, 16], [2, 6, 14, 0]],
    # Six conditions, a chain with a few shortcuts, very different numbers.
    "incomplete": [[0, 7, 0, 0, 0, 12], [3, 0, 55, 0, 1, 0], [0, 45, 0, 8, 0, 0], [0, 0, 4, 0, 30, 0], [0, 2, 0, 10, 0, 5], [3, 0, 0, 0, 6, 0]],
}
SEPARATED = {
    # The first is never beaten; the last never wins.
    "unbeaten": [[0, 5, 6, 7], [0, 0, 4, 6], [0, 2, 0, 5], [0, 0, 0, 0]],
    # One answer a pair.
    "single": [[0, 1, 1], [0, 0, 1], [0, 0, 0]],
}
UNIT = {"thurstone": 1 / norm.ppf(0.75), "bradley-terry": 1 / np.log(3)}


def ml(d, model):
    d = np.array(d, float)
    n = len(d)

    def gradient(q):
        t = np.r_[0, q]
        x = t[:, None] - t
        if model == "thurstone":
            r = np.exp(norm.logpdf(x) - norm.logcdf(x))
        else:
            r = 1 / (1 + np.exp(x))
        g = (d * r).sum(1) - (d * r).sum(0)
        return g[1:]

    def value(t):
        x = t[:, None] - t
        return float((d * (norm.logcdf(x) if model == "thurstone" else -np.logaddexp(0, -x))).sum())

    q = so.root(gradient, np.zeros(n - 1), tol=1e-14).x
    for _ in range(5):  # polish: the solver stops near 1e-10
        jac = np.array([(gradient(q + 1e-6 * e) - gradient(q - 1e-6 * e)) / 2e-6 for e in np.eye(n - 1)])
        q = q - np.linalg.solve(jac.T, gradient(q))
    h = 1e-6
    info = -np.array([(gradient(q + h * e) - gradient(q - h * e)) / (2 * h) for e in np.eye(n - 1)])
    cov = np.zeros((n, n))
    cov[1:, 1:] = np.linalg.inv((info + info.T) / 2)
    c = np.eye(n) - 1 / n
    t = np.r_[0, q]
    return dict(jod=((t - t.mean()) * UNIT[model]).tolist(), log_likelihood=value(t),
                se=(np.sqrt(np.diag(c @ cov @ c)) * UNIT[model]).tolist())


def stationary(objective, start):
    """The zero of the gradient in 40 digits, by central differences of 1e-12 (so exact to about 1e-24)."""
    mp.mp.dps = 40
    h = mp.mpf(10) ** -12

    def gradient(*q):
        out = []
        for i in range(len(q)):
            up, down = list(q), list(q)
            up[i] += h
            down[i] -= h
            out.append((objective(*up) - objective(*down)) / (2 * h))
        return out

    return list(mp.findroot(gradient, tuple(map(float, start)), tol=1e-20))


def pwcmp_none(d, start):
    """pw_scale's own objective, over every ordered pair as it has it; the mean that its weak regularisation leaves is taken off."""
    n = len(d)
    sigma = mp.mpf("1.4826")

    def objective(*q):
        ll = mp.mpf(0)
        for i in range(n):
            for j in range(n):
                if d[i][j] + d[j][i]:
                    p = mp.ncdf((q[i] - q[j]) / sigma)
                    ll += d[i][j] * mp.log(p) + d[j][i] * mp.log(1 - p)
        return -ll + mp.mpf("0.01") * (sum(q) / n) ** 2

    q = stationary(objective, start)
    return [float((x - sum(q) / n) / sigma * mp.mpf(UNIT["thurstone"])) for x in q]


def jeffreys(d, model):
    n = len(d)
    pairs = [(i, j, d[i][j], d[j][i]) for i in range(n) for j in range(i + 1, n) if d[i][j] + d[j][i]]

    def cdf(x):
        return mp.ncdf(x) if model == "thurstone" else 1 / (1 + mp.e ** -x)

    def weight(x):
        p = cdf(x)
        return mp.npdf(x) ** 2 / (p * cdf(-x)) if model == "thurstone" else p * cdf(-x)

    def objective(*q):
        t = (mp.mpf(0),) + q
        ll, info = mp.mpf(0), mp.zeros(n - 1)
        for i, j, k, m in pairs:
            x = t[i] - t[j]
            ll += k * mp.log(cdf(x)) + m * mp.log(cdf(-x))
            w = (k + m) * weight(x)
            for a, sa in ((i - 1, 1), (j - 1, -1)):
                for b, sb in ((i - 1, 1), (j - 1, -1)):
                    if a >= 0 and b >= 0:
                        info[a, b] += sa * sb * w
        return ll + mp.log(mp.det(info)) / 2

    start = so.minimize(lambda q: -float(objective(*map(mp.mpf, q))), np.zeros(n - 1), method="Nelder-Mead", options=dict(xatol=1e-8, fatol=1e-12, maxiter=9999)).x
    q = stationary(objective, start)
    t = [mp.mpf(0)] + list(q)
    mean = sum(t) / n
    return [float((x - mean) * mp.mpf(UNIT[model])) for x in t]


def triads():
    out = {}
    for n in (3, 4, 5, 6):
        pairs = list(itertools.combinations(range(n), 2))
        found = Counter()
        for bits in itertools.product((0, 1), repeat=len(pairs)):
            score = [0] * n
            for (i, j), b in zip(pairs, bits):
                score[i if b else j] += 1
            found[n * (n - 1) * (n - 2) // 6 - sum(s * (s - 1) // 2 for s in score)] += 1
        total = sum(found.values())
        out[str(n)] = [sum(found[k] for k in found if k <= d) / total for d in range(max(found) + 1)]
    return out


def main():
    out = dict(ml={}, jeffreys={}, triads=triads())
    for name, d in CASES.items():
        out["ml"][name] = dict(wins=d, **{m: ml(d, m) for m in UNIT}, pwcmp=pwcmp_none(d, ml(d, "thurstone")["jod"]))
    for name, d in {**SEPARATED, "complete": CASES["complete"]}.items():
        out["jeffreys"][name] = dict(wins=d, **{m: jeffreys(d, m) for m in UNIT})
    with open("pairwise.json", "w") as f:
        json.dump(out, f, indent=1)
        f.write("\n")


main()
