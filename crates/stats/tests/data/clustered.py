#!/usr/bin/env python3
"""Writes clustered.json: oracles for kelir-stats' clustered choices. Needs mpmath, numpy, scipy, statsmodels.

Intraclass correlations from their definitions on exact fractions; cluster-robust logit from statsmodels (CR1s) and by explicit sums (CR0, CR1);
the random-intercept logit on a fine fixed grid whose log likelihood mpmath's Gauss-Legendre quadrature must confirm to 1e-12, its stationary
point by a root finder, its standard errors by a differentiated exact gradient.
"""
import json
from fractions import Fraction as F
import mpmath as mp
import numpy as np
import scipy.optimize as so
import statsmodels.api as sm


def counts_to_clusters(counts):
    return [(k, len(counts) - 1) for k, n in enumerate(counts) for _ in range(n)]


def icc(clusters):
    m, n_all = len(clusters), sum(n for _, n in clusters)
    p = F(sum(k for k, _ in clusters), n_all)
    within = sum(F(k * (n - k), n) for k, n in clusters)
    fleiss = 1 - within / ((n_all - m) * p * (1 - p))
    msb = sum(n * (F(k, n) - p) ** 2 for k, n in clusters) / (m - 1)
    msw = within / (n_all - m)
    n0 = (n_all - F(sum(n * n for _, n in clusters), n_all)) / (m - 1)
    anova = (msb - msw) / (msb + (n0 - 1) * msw)
    return dict(fleiss_cuzick=float(fleiss), anova=float(anova))


def beta_binomial(clusters):
    from scipy.special import betaln, psi

    def nll(t):
        a, b = np.exp(t)
        return -sum(betaln(a + k, b + n - k) - betaln(a, b) for k, n in clusters)

    def slope(t):
        a, b = np.exp(t)
        return [a * sum(psi(a + k) - psi(a) - psi(a + b + n) + psi(a + b) for k, n in clusters),
                b * sum(psi(b + n - k) - psi(b) - psi(a + b + n) + psi(a + b) for k, n in clusters)]

    a, b = np.exp(so.root(slope, so.minimize(nll, [0.1, 0.1], method="BFGS").x, tol=1e-14).x)
    return dict(proportion=float(a / (a + b)), icc=float(1 / (1 + a + b)))


def mixed(rows):
    """rows: (participant, successes, trials, x...)"""
    z = np.arange(-14, 14.0001, 0.005)
    w = np.exp(-z * z / 2) / np.sqrt(2 * np.pi) * 0.005
    ids = sorted({r[0] for r in rows})
    x = [np.array([r[3] for r in rows if r[0] == i], float) for i in ids]
    k = [np.array([r[1] for r in rows if r[0] == i], float) for i in ids]
    n = [np.array([r[2] for r in rows if r[0] == i], float) for i in ids]
    p = x[0].shape[1]

    def parts(theta):
        b, s = theta[:p], theta[p]
        value, grad = 0.0, np.zeros(p + 1)
        for xi, ki, ni in zip(x, k, n):
            eta = (xi @ b)[:, None] + s * z
            ll = (ki[:, None] * eta - ni[:, None] * np.logaddexp(0, eta)).sum(0)
            f = w * np.exp(ll)
            total = f.sum()
            res = ki[:, None] - ni[:, None] / (1 + np.exp(-eta))
            value += np.log(total)
            grad[:p] += (xi.T @ res @ f) / total
            grad[p] += ((res * z).sum(0) @ f) / total
        return value, grad

    start = so.minimize(lambda t: -parts(t)[0], np.r_[np.zeros(p), 1.0], jac=lambda t: -parts(t)[1], method="BFGS").x
    at = so.root(lambda t: parts(t)[1], start, tol=1e-14).x
    h = 1e-5
    hess = np.array([(parts(at + h * e)[1] - parts(at - h * e)[1]) / (2 * h) for e in np.eye(p + 1)])
    exact = mp.mpf(0)
    for xi, ki, ni in zip(x, k, n):
        eta = [mp.mpf(float(e)) for e in xi @ at[:p]]

        def f(z):
            return mp.npdf(z) * mp.fprod(mp.e ** (kk * (e + at[p] * z)) / (1 + mp.e ** (e + at[p] * z)) ** nn for e, kk, nn in zip(eta, ki, ni))

        exact += mp.log(mp.quad(f, list(range(-14, 15, 2))))
    assert abs(float(exact) - parts(at)[0]) < 1e-12 * abs(float(exact)), (exact, parts(at)[0])
    se = np.sqrt(np.diag(np.linalg.inv(-(hess + hess.T) / 2)))
    return dict(beta=at[:p].tolist(), sigma=float(at[p]), se=se.tolist(), log_likelihood=float(parts(at)[0]))


def robust(rows):
    g, y, xs = [], [], []
    for i, k, n, x in rows:
        for j in range(n):
            g.append(i), y.append(1.0 if j < k else 0.0), xs.append(x)
    g, y, xs = np.array(g), np.array(y), np.array(xs, float)
    model = sm.Logit(y, xs)
    fit = model.fit(disp=0, tol=1e-14, method="newton", maxiter=100)
    hc = model.fit(disp=0, tol=1e-14, method="newton", maxiter=100, cov_type="cluster", cov_kwds=dict(groups=g))
    mu = 1 / (1 + np.exp(-xs @ fit.params))
    bread = np.linalg.inv((xs.T * (mu * (1 - mu))) @ xs)
    meat = sum(np.outer(s, s) for s in (((y - mu)[g == i, None] * xs[g == i]).sum(0) for i in np.unique(g)))
    cr0 = bread @ meat @ bread
    count = len(np.unique(g))
    return dict(beta=fit.params.tolist(), naive=np.sqrt(np.diag(bread)).tolist(), cr0=np.sqrt(np.diag(cr0)).tolist(),
                cr1=np.sqrt(np.diag(cr0) * count / (count - 1)).tolist(), cr1s=hc.bse.tolist(), log_likelihood=float(fit.llf))


def design(seed=4):
    """24 participants, 3 conditions x 5 trials, an effect of 0.8 and scatter 1.2; participant 3 left early."""
    rng = np.random.default_rng(seed)
    rows = []
    for i in range(24):
        u = rng.normal() * 1.2
        for c in (-1.0, 0.0, 1.0):
            if i == 3 and c == 1.0:
                continue
            n = 5
            rows.append((i, int(rng.binomial(n, 1 / (1 + np.exp(-(0.3 + 0.8 * c + u))))), n, [1.0, c]))
    return rows


def main():
    out = {}
    for name, counts in (("paper_a", (12, 14, 6)), ("paper_b", (3, 10, 19)), ("four", (6, 3, 4, 5, 9))):
        clusters = counts_to_clusters(counts)
        rows = [(i, k, n, [1.0]) for i, (k, n) in enumerate(clusters)]
        out[name] = dict(counts=counts, icc=icc(clusters), beta_binomial=beta_binomial(clusters), mixed=mixed(rows), robust=robust(rows))
    uneven = [(0, 3), (2, 2), (1, 1), (4, 7), (5, 6), (1, 4), (0, 2), (3, 3)]
    out["uneven"] = dict(clusters=uneven, icc=icc(uneven), beta_binomial=beta_binomial(uneven))
    rows = design()
    out["design"] = dict(rows=[dict(participant=i, successes=k, trials=n, x=x) for i, k, n, x in rows], mixed=mixed(rows), robust=robust(rows))
    with open("clustered.json", "w") as f:
        json.dump(out, f, indent=1)
        f.write("\n")


main()
