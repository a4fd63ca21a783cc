"""Expected values where R has none to 1e-12: python3 make_inference.py > inference_py.tsv (mpmath, exact fractions)."""
import io
import contextlib
from fractions import Fraction
from itertools import product
from math import comb

with contextlib.redirect_stdout(io.StringIO()):
    import sys
    sys.argv = [sys.argv[0], "nothing"]
    from make_distributions import noncentral_t_tails, t_quantile, bisect_quantile
from mpmath import mp, mpf, exp, findroot, gamma, log, nstr, pi, quad, sqrt, inf

mp.dps = 40
out = lambda key, value: print(key, nstr(value, 17, min_fixed=0, max_fixed=0), sep="\t")
exact = lambda q: mpf(q.numerator) / mpf(q.denominator)


def t_of(counts, mu):
    n = sum(c for _, c in counts)
    mean = Fraction(sum(v * c for v, c in counts), n)
    variance = sum(c * (v - mean) ** 2 for v, c in counts) / (n - 1)
    return n, exact(mean - Fraction(mu)) / sqrt(exact(variance) / n)


SAMPLES = {"mc": ([(0, 12), (1, 14), (2, 6)], 1), "photo": ([(0, 3), (1, 10), (2, 19)], 1), "video": ([(0, 26), (1, 7)], 0.5)}
for name, (counts, mu) in SAMPLES.items():
    n, t = t_of(counts, mu)
    df = mpf(n - 1)
    j = gamma(df / 2) / (sqrt(df / 2) * gamma((df - 1) / 2))
    out(f"d.{name}", t / sqrt(n))
    out(f"g.{name}", j * t / sqrt(n))
    for end, q in (("low", mpf("0.025")), ("high", mpf("0.975"))):
        # P(T > t; δ) = q; for t < 0 mirrored: P(T < −t; −δ).
        f = (lambda d: noncentral_t_tails(df, d, t, 80)[1]) if t > 0 else (lambda d: noncentral_t_tails(df, -d, -t, 80)[0])
        low = findroot(lambda d: f(d) - q, (t - 4, t + 4), solver="illinois", tol=mpf(10) ** -50, maxsteps=60)
        out(f"d_{end}.{name}", low / sqrt(n))
        out(f"g_{end}.{name}", j * low / sqrt(n))
    r = sqrt(mpf(1) / 2)
    like = lambda g: (1 + n * g) ** mpf(-0.5) * (1 + t * t / ((1 + n * g) * df)) ** (-(df + 1) / 2)
    prior = lambda g: r / sqrt(2 * pi) * g ** mpf(-1.5) * exp(-r * r / (2 * g))
    bf10 = quad(lambda v: like(exp(v)) * prior(exp(v)) * exp(v), list(range(-12, 81, 4))) / (1 + t * t / df) ** (-(df + 1) / 2)
    out(f"ln_bf10.{name}", log(bf10))

for n, d in [(32, 0.5), (32, 0.2), (10, 1.0), (3, 0.7), (32, -0.248), (200, 0.05)]:
    critical = t_quantile(n - 1, 0.025)
    delta = mpf(d) * sqrt(mpf(n))
    above = noncentral_t_tails(n - 1, delta, critical, 80)[1]
    below = noncentral_t_tails(n - 1, -delta, critical, 80)[1]
    out(f"power_t.{n}.{d}", above + below)

# Signed ranks by counting all signs.
def signed_rank_p(values):
    d = sorted((Fraction(v) for v in values if v != 0), key=abs)
    rank = [Fraction(sum(abs(e) < abs(x) for e in d) + sum(abs(e) <= abs(x) for e in d) + 1, 2) for x in d]
    v = sum(r for r, x in zip(rank, d) if x > 0)
    total = sum(rank)
    hits = [sum(r for r, s in zip(rank, signs) if s) <= min(v, total - v) for signs in product((0, 1), repeat=len(d))]
    return min(Fraction(1), 2 * Fraction(sum(hits), 2 ** len(d)))

out("wilcoxon_all_signs.tied", exact(signed_rank_p(["1.1", "-0.3", "2.5", "2.5", "-1.1", "4", "0.3", "-0.3", "7"])))
out("wilcoxon_all_signs.plain", exact(signed_rank_p(["1", "-2", "3", "4", "5", "-6", "7", "8", "9", "10", "-11"])))

# Power of the exact binomial test, all of it in fractions.
def binomial_power(n, p0, p1, alpha):
    mass = lambda p: [comb(n, k) * p ** k * (1 - p) ** (n - k) for k in range(n + 1)]
    null, truth = mass(Fraction(p0)), mass(Fraction(p1))
    tolerance = 1 + Fraction(1, 10 ** 7)
    reject = [k for k in range(n + 1) if sum(m for m in null if m <= null[k] * tolerance) <= Fraction(alpha)]
    return sum(null[k] for k in reject), sum(truth[k] for k in reject)

for n, p0, p1 in [(32, 0.5, 0.7), (33, 0.5, 7 / 33), (50, 0.3, 0.4), (12, 0.9, 0.5)]:
    size, power = binomial_power(n, p0, p1, 0.05)
    out(f"binomial_size.{n}.{p0}", exact(size))
    out(f"binomial_power.{n}.{p0}", exact(power))

# Fleiss (1971), as printed by Wikipedia: 10 items, 14 raters, 5 categories; and a table of two categories.
TABLES = {"wikipedia": [[0, 0, 0, 0, 14], [0, 2, 6, 4, 2], [0, 0, 3, 5, 6], [0, 3, 9, 2, 0], [2, 2, 8, 1, 1], [7, 7, 0, 0, 0],
                        [3, 2, 6, 3, 0], [2, 5, 3, 2, 2], [6, 5, 2, 1, 0], [0, 2, 2, 3, 7]],
          "binary": [[3, 0], [2, 1], [0, 3], [3, 0], [1, 2]]}
for name, table in TABLES.items():
    items, raters = len(table), sum(table[0])
    share = [Fraction(sum(row[j] for row in table), items * raters) for j in range(len(table[0]))]
    agreement = Fraction(sum(c * (c - 1) for row in table for c in row), items * raters * (raters - 1))
    chance = sum(p * p for p in share)
    out(f"fleiss.{name}", exact((agreement - chance) / (1 - chance)))
    pq = [p * (1 - p) for p in share]
    variance = Fraction(2, items * raters * (raters - 1)) * (sum(pq) ** 2 - sum(x * (1 - 2 * p) for x, p in zip(pq, share))) / sum(pq) ** 2
    out(f"fleiss_se.{name}", sqrt(exact(variance)))
