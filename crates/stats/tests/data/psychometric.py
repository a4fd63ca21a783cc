#!/usr/bin/env python3
"""Writes psychometric.json: oracles for kelir-stats' psychometric functions. Needs mpmath, numpy, scipy, psignifit == 4.3.

From psignifit itself: posterior means and intervals (its MAP is a simplex search's, good to 1e-4, and is kept only to that). From the definitions,
in 30-digit arithmetic: the maximum of likelihood and of posterior as zeros of the gradient, and profile-likelihood ends as zeros of
(gradient in the others, likelihood - maximum + chi-squared/2). A parameter on its lower bound 0 is held there, and the gradient's sign checked.
"""
import json
import mpmath as mp
import numpy as np
import scipy.optimize as so
import psignifit
from scipy.special import betaln, expit
from scipy.stats import norm

mp.mp.dps = 30
CASES = {
    # psignifit's name, choices, levels, correct, trials
    "triangles": ("norm", 2, [-2.48, -2.7, -3.0, -3.2, -3.5, -3.8], [96, 95, 84, 72, 58, 50], [100] * 6),
    "logistic": ("logistic", 2, [-2.48, -2.7, -3.0, -3.2, -3.5, -3.8], [96, 95, 84, 72, 58, 50], [100] * 6),
    "weibull": ("weibull", 3, [-1.2, -0.9, -0.65, -0.4, -0.2, 0.1, 0.3], [14, 15, 22, 27, 33, 38, 39], [40] * 7),
    "overdispersed": ("norm", 2, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], [28, 12, 29, 19, 37, 22, 36, 30, 40, 31], [40] * 10),
}
SHAPE = {"norm": (lambda z: mp.ncdf(z), mp.mpf(0), 2 * mp.sqrt(2) * mp.erfinv(mp.mpf("0.9"))),
         "logistic": (lambda z: 1 / (1 + mp.e ** -z), mp.mpf(0), 2 * mp.log(19)),
         "weibull": (lambda z: 1 - mp.e ** (-mp.e ** z), mp.log(mp.log(2)), mp.log(-mp.log(mp.mpf("0.05"))) - mp.log(-mp.log(mp.mpf("0.95"))))}


def objective(case, posterior):
    kind, choices, xs, ks, ns = CASES[case]
    F, centre, rise = SHAPE[kind]
    gamma = mp.mpf(1) / choices
    xs = [mp.mpf(x) for x in xs]
    low, high = min(xs), max(xs)
    spread = high - low
    step = min(b - a for a, b in zip(sorted(xs), sorted(xs)[1:]))

    def threshold_prior(t):
        out = low - t if t < low else t - high if t > high else None
        return mp.mpf(1) if out is None else (1 + mp.cos(2 * mp.pi * out / spread)) / 2

    def width_prior(w):
        if w >= spread:
            return (1 + mp.cos(mp.pi / 2 * (w - spread) / spread)) / 2
        return (1 - mp.cos(mp.pi * (w - step) / step)) / 2 if w <= 2 * step else mp.mpf(1)

    def f(t, w, lam, eta):
        v = 9 * mp.log(1 - lam) + 9 * mp.log(1 - eta)
        if posterior:
            v += mp.log(threshold_prior(t)) + mp.log(width_prior(w))
        for x, k, n in zip(xs, ks, ns):
            p = gamma + (1 - lam - gamma) * F(centre + rise * (x - t) / w)
            if eta == 0:
                v += k * mp.log(p) + (n - k) * mp.log(1 - p)
            else:
                nu = 1 / eta ** 2 - 1
                v += (mp.loggamma(k + nu * p) - mp.loggamma(nu * p) + mp.loggamma(n - k + nu * (1 - p)) - mp.loggamma(nu * (1 - p))
                      + mp.loggamma(nu) - mp.loggamma(n + nu))
        return v

    return f


def in_floats(case, posterior):
    """The same in double precision, only to start from."""
    kind, choices, xs, ks, ns = CASES[case]
    F = {"norm": norm.cdf, "logistic": expit, "weibull": lambda z: -np.expm1(-np.exp(z))}[kind]
    centre, rise = float(SHAPE[kind][1]), float(SHAPE[kind][2])
    x, k, n = (np.array(a, float) for a in (xs, ks, ns))
    low, spread, step = x.min(), np.ptp(x), np.diff(np.sort(x)).min()

    def f(t, w, lam, eta):
        p = 1 / choices + (1 - lam - 1 / choices) * F(centre + rise * (x - t) / w)
        v = 9 * np.log(1 - lam) + 9 * np.log(1 - eta)
        if posterior:
            out = max(low - t, t - low - spread, 0)
            v += np.log((1 + np.cos(2 * np.pi * out / spread)) / 2)
            v += np.log((1 + np.cos(np.pi / 2 * (w - spread) / spread)) / 2) if w >= spread else np.log((1 - np.cos(np.pi * (w - step) / step)) / 2) if w <= 2 * step else 0
        if eta == 0:
            return v + (k * np.log(p) + (n - k) * np.log(1 - p)).sum()
        nu = 1 / eta**2 - 1
        return v + (betaln(k + nu * p, n - k + nu * (1 - p)) - betaln(nu * p, nu * (1 - p))).sum()

    return f


def gradient(f, at):
    h = mp.mpf(10) ** -10
    out = []
    for i in range(len(at)):
        up, down = list(at), list(at)
        up[i] += h
        down[i] -= h
        out.append((f(*up) - f(*down)) / (2 * h))
    return out


def maximum(f, rough, start, eta_free):
    """Free lambda and eta first; those that go to 0 are held there."""
    held = {} if eta_free else {3: mp.mpf(0)}
    while True:
        free = [i for i in range(4) if i not in held]

        def g(*x):
            full = [held.get(i) for i in range(4)]
            for i, v in zip(free, x):
                full[i] = v
            return f(*full)

        def cost(x):
            if any(v <= 0 for i, v in zip(free, x) if i > 0):
                return 1e10
            full = [float(held.get(i, 0)) for i in range(4)]
            for i, v in zip(free, x):
                full[i] = v
            return -rough(*full)

        x = so.minimize(cost, [start[i] for i in free], method="Nelder-Mead", options=dict(xatol=1e-9, fatol=1e-12, maxiter=20000)).x
        low = [i for i, v in zip(free, x) if i >= 2 and v < 1e-5]
        if low:
            held.update({i: mp.mpf(0) for i in low})
            continue
        x = mp.findroot(lambda *x: gradient(g, x), tuple(map(mp.mpf, x)), tol=1e-16)
        at = [held.get(i) for i in range(4)]
        for i, v in zip(free, x):
            at[i] = v
        return at, free


def profile(f, at, free, parameter, sign, drop):
    top = f(*at)
    others = [i for i in free if i != parameter]

    def system(*x):
        full = list(at)
        for i, v in zip([parameter] + others, x):
            full[i] = v

        def g(*rest):
            inner = list(full)
            for i, v in zip(others, rest):
                inner[i] = v
            return f(*inner)

        return [f(*full) - top + drop] + gradient(g, [full[i] for i in others])

    # A first guess by walking outwards.
    x = [at[i] for i in [parameter] + others]
    reach = mp.mpf("0.02")

    def rest_at(v, start):
        def g(*rest):
            full = list(at)
            full[parameter] = v
            for i, r in zip(others, rest):
                full[i] = r
            return f(*full)

        return list(mp.findroot(lambda *r: gradient(g, r), tuple(start), tol=1e-15)), g

    v, rest = x[0], x[1:]
    while True:
        v += sign * reach
        rest, g = rest_at(v, rest)
        if g(*rest) < top - drop:
            break
    found = mp.findroot(system, tuple([v] + list(rest)), tol=1e-16)
    if 2 in others and found[1 + others.index(2)] < 0:  # no negative lapses: once more, held at 0
        at = [at[0], at[1], mp.mpf(0), at[3]]
        guess = [v for i, v in zip([parameter] + others, found) if i != 2]
        others = [i for i in others if i != 2]
        found = mp.findroot(system, tuple(guess), tol=1e-16)
    return float(found[0])


def main():
    out = {}
    for case, (kind, choices, xs, ks, ns) in CASES.items():
        data = np.c_[xs, ks, ns].astype(float)
        r = psignifit.psignifit(data, sigmoid=kind, experiment_type=f"{choices}AFC", verbose=False)
        names = ("threshold", "width", "lambda", "eta")
        ps = dict(map=[r.parameter_estimate_MAP[n] for n in names], mean=[float(r.parameter_estimate_mean[n]) for n in names],
                  interval95=[r.confidence_intervals[n]["0.95"] for n in names], interval68=[r.confidence_intervals[n]["0.68"] for n in names])
        start = [max(v, 0.02) if i > 0 else v for i, v in enumerate(ps["map"])]
        entry = dict(sigmoid={"norm": "gaussian"}.get(kind, kind), guess=1 / choices, x=xs, correct=ks, trials=ns, psignifit=ps)
        for name, posterior, eta_free in (("map", True, True), ("ml", False, False), ("ml_eta", False, True)):
            if name == "ml" and case == "overdispersed":
                continue  # without eta its best curve is a step, and the place of the step within two levels is any
            f = objective(case, posterior)
            at, free = maximum(f, in_floats(case, posterior), start, eta_free)
            entry[name] = list(map(float, at))
            # No priors: the log likelihood of the single answers.
            entry[name + "_value"] = float(f(*at))
            if name == "ml" and case in ("triangles", "logistic"):  # where no bound is met on the way
                drop = mp.mpf("3.841458820694124") / 2
                entry["profile95"] = {p: [profile(f, at, free, i, s, drop) for s in (-1, 1)] for i, p in enumerate(("threshold", "width"))}
        out[case] = entry
        print(case, flush=True) or print( entry["map"], entry["ml_eta"])
    with open("psychometric.json", "w") as f:
        json.dump(out, f, indent=1)
        f.write("\n")


if __name__ == "__main__":
    main()
