"""Expected values of the distributions, by mpmath: python3 make_distributions.py > distributions.tsv

Each line: function, arguments (f64, shortest decimal form), value (17 digits). The formulas are not those of the
crate: incomplete beta and gamma functions are summed as series of positive terms (DLMF 8.17.8, 8.7.1) or taken as 1
minus those at enough digits, noncentral t is the Poisson mixture of incomplete beta functions (Johnson, Kotz &
Balakrishnan 1995, 31.12), binomial tails are sums of the mass function. mpmath 1.3.0 (with gmpy2:
minutes on one core; `make_distributions.py beta` makes one part of it).
"""
import sys

from mpmath import mp, mpf, log, exp, sqrt, pi, loggamma, erfc, findroot, nstr, floor

DIGITS = 50
mp.dps = DIGITS
SMALLEST, LARGEST = mpf(10) ** -300, 1 - mpf(10) ** -17


def emit(name, args, value):
    print("\t".join([name] + [repr(float(a)) for a in args] + [nstr(value, 17, min_fixed=0, max_fixed=0)]))


def beta_series(a, b, x, y):
    """I_x(a, b) = x^a y^b / (a B(a, b)) Σ (a + b)_n / (a + 1)_n x^n, all terms positive."""
    a, b = mpf(a), mpf(b)
    term = exp(a * log(x) + b * log(y) + loggamma(a + b) - loggamma(a + 1) - loggamma(b))
    total, n, enough = term, 0, mpf(10) ** (-mp.dps - 3)
    while True:
        term *= (a + b + n) / (a + 1 + n) * x
        total += term
        n += 1
        if n % 16 == 0 and term < total * enough and (a + b + n) * x < (a + 1 + n):
            return total


def beta_tails(a, b, x, y=None):
    """(lower, upper), each to about 40 digits: the series in the smaller of x and y, and what it leaves."""
    before = mp.dps
    for digits in (DIGITS + 15, 400, 3000):
        mp.dps = digits
        exact_x = mpf(x)
        exact_y = 1 - exact_x if y is None else mpf(y)
        if exact_x > exact_y:
            upper = beta_series(b, a, exact_y, exact_x)
            lower = 1 - upper
        else:
            lower = beta_series(a, b, exact_x, exact_y)
            upper = 1 - lower
        # What was summed is exact to all digits; what is left of 1 has lost some.
        left = lower if exact_x > exact_y else upper
        if left > mpf(10) ** (DIGITS - digits):
            break
    mp.dps = before
    return +lower, +upper


def beta_tails_at_odds(a, b, u, v):
    """At x = u / (u + v), which is formed at 3010 digits."""
    with mp.workdps(3010):
        x, y = mpf(u) / (mpf(u) + mpf(v)), mpf(v) / (mpf(u) + mpf(v))
    return beta_tails(a, b, x, y)


def t_sf(df, t):
    df, t = mpf(df), mpf(t)
    if t == 0:
        return mpf(1) / 2
    return beta_tails_at_odds(df / 2, mpf(1) / 2, df, t * t)[0] / 2


def gamma_tails(a, x):
    a, x = mpf(a), mpf(x)
    before = mp.dps
    for digits in (DIGITS + 10, 400):
        mp.dps = digits
        term = exp(a * log(x) - x - loggamma(a + 1))
        total, n = term, 1
        while True:
            term *= x / (a + n)
            total += term
            n += 1
            if term < total * mpf(10) ** -(digits + 3) and x < a + n:
                break
        upper = 1 - total
        if upper > mpf(10) ** -9:
            break
    mp.dps = before
    return +total, +upper


def noncentral_t_tails(df, delta, t, digits=420):
    """(cdf, sf) for t > 0, by the Poisson mixture."""
    before = mp.dps
    mp.dps = digits
    df, delta, t = mpf(df), mpf(delta), mpf(t)
    b = df / 2
    x, y = t * t / (t * t + df), df / (t * t + df)
    l = delta * delta / 2
    p = exp(-l)
    q = delta * exp(-l) / (sqrt(mpf(2)) * mp.gamma(mpf(3) / 2))
    total = mpf(0)

    def start(a):
        value = mp.betainc(a, b, 0, x, regularized=True)
        step = exp(a * log(x) + b * log(y) + loggamma(a + b) - loggamma(a + 1) - loggamma(b))
        return value, step

    half, half_step = start(mpf(1) / 2)
    one, one_step = start(mpf(1))
    j = 0
    while True:
        term = p * half + q * one
        total += term
        if j > l and p + abs(q) < mpf(10) ** (20 - digits):
            break
        # I_x(a + 1, b) = I_x(a, b) − x^a y^b / (a B(a, b))
        half -= half_step
        half_step *= x * (mpf(1) / 2 + j + b) / (mpf(1) / 2 + j + 1)
        one -= one_step
        one_step *= x * (1 + j + b) / (2 + j)
        j += 1
        p *= l / j
        q *= l / (j + mpf(1) / 2)
    cdf = erfc(delta / sqrt(mpf(2))) / 2 + total / 2
    sf = 1 - cdf
    mp.dps = before
    return +cdf, +sf


def bisect_quantile(f, target, low, high):
    """The root of the monotone f, in logarithms: bisection, then regula falsi (Illinois) to 40 digits."""
    g = lambda v: log(f(exp(v))) - log(target)
    low, high = log(mpf(low)), log(mpf(high))
    at_low, at_high = g(low), g(high)
    assert at_low * at_high < 0
    for k in range(200):
        if k < 16:
            middle = (low + high) / 2
        else:
            middle = (low * at_high - high * at_low) / (at_high - at_low)
        at = g(middle)
        if abs(at) < mpf(10) ** -36 or abs(high - low) < mpf(10) ** -40:
            return exp(middle)
        if at * at_high < 0:
            low, at_low = high, at_high
        elif k >= 16:
            at_low /= 2
        high, at_high = middle, at
    raise ValueError("no convergence")


def normal():
    cdf = lambda x: erfc(-mpf(x) / sqrt(mpf(2))) / 2
    for x in [-38, -37, -30.5, -20, -10, -8.3, -6, -4, -3.3, -2.5, -1.96, -1.5, -1, -0.9, -0.76, -0.74, -0.5, -0.3, -0.1, -1e-3,
              -1e-10, 1e-10, 1e-3, 0.1, 0.5, 0.74, 0.76, 1, 1.5, 2, 3, 5, 8]:
        x = float(x)
        emit("normal_cdf", [x], cdf(x))
        emit("normal_ln_cdf", [x], log(cdf(x)))
    for x in [-1e3, -1e6, -1e10]:
        z = -mpf(x) / sqrt(mpf(2))
        emit("normal_ln_cdf", [x], log(erfc(z) / 2) if x > -1e5 else -z * z - log(2 * z * sqrt(pi)) + log(1 - 1 / (2 * z * z) + 3 / (4 * z ** 4)))
    for p in [1e-300, 1e-200, 1e-100, 1e-50, 1e-20, 1e-10, 1e-5, 1e-3, .01, .025, .05, .1, .2, .24, .26, .3, .4, .49, .4999, .499999999999,
              .500001, .6, .75, .9, .975, .999]:
        q = min(mpf(p), 1 - mpf(p))
        x = findroot(lambda x: log(cdf(x) / q), -sqrt(-2 * log(q)) * mpf("0.9") if q < .2 else mpf(q - .5) * 2.5)
        emit("normal_quantile", [p], x if p < .5 else -x)


DF = [0.1, 0.5, 1, 2, 2.5, 3, 5, 10, 31, 32, 100, 999, 1000, 1e4, 1e5, 1e6]


def student_t():
    for df in DF:
        for t in [1e-10, 1e-5, 1e-3, .05, .3, .7, 1, 1.437590576856522, 1.7, 2, 2.5, 3, 4.2, 5, 7, 10, 15, 20, 25, 30, 36, 50, 80, 100, 1e3, 1e4, 1e6,
                  1e20, 1e50, 1e100, 1e200, 1e300]:
            value = t_sf(df, t)
            if value > SMALLEST:
                emit("t_sf", [df, t], value)
    for df, t in [(1, 50), (1, 1e100), (3, 1e200), (31, 1e10), (31, 1e100), (1000, 50), (1000, 1e3), (1e6, 50)]:
        emit("t_ln_sf", [df, t], log(t_sf(df, t)))
    for df in [0.5, 1, 2, 2.5, 5, 31, 100, 1000, 1e5, 1e6]:
        for q in [1e-300, 1e-200, 1e-100, 1e-30, 1e-10, 1e-5, 1e-3, .01, .025, .05, .1, .2, .24, .26, .3, .4, .45, .49, .4999, .49999999]:
            if df * 308 < -log(mpf(q)) / log(mpf(10)):
                continue
            emit("t_quantile_sf", [df, q], t_quantile(df, q))


def t_quantile(df, q):
    if q < .4:
        return bisect_quantile(lambda t: t_sf(df, t), mpf(q), 1e-3, mpf(10) ** 615)
    # Near the middle the share between 0 and t is what is small.
    def central(t):
        return beta_tails_at_odds(mpf(df) / 2, mpf(1) / 2, mpf(df), t * t)[1] / 2
    return bisect_quantile(central, mpf(1) / 2 - mpf(q), 1e-20, 10)


SHAPES = [(.01, .01), (.01, 3), (3, .01), (.5, .5), (.5, 16.5), (1, 1), (1, 30), (2, 3), (7, 27), (26.5, 7.5), (32, 32), (100, 3), (.5, 500), (500, .5),
          (500, 500), (900, 100), (1000, 1000), (1e4, 2.5e4), (1e5, 3), (1e5, 1e5), (1e6, 10), (1e6, 1e6), (5e5, .5)]


def beta():
    for a, b in SHAPES:
        mean, sd = a / (a + b), (a * b / (a + b) ** 2 / (a + b + 1)) ** .5
        points = {mean + k * sd for k in (-30, -20, -12, -6, -3, -1, -.1, 0, .1, 1, 2, 4, 8, 15, 25, 35)}
        points |= {1e-300, 1e-100, 1e-20, 1e-5, .001, .3, .5, .9, .999, 1 - 1e-10}
        for x in sorted(points):
            if not 0 < x < 1:
                continue
            lower, upper = beta_tails(a, b, x)
            for name, value in (("beta_cdf", lower), ("beta_sf", upper)):
                if SMALLEST < value < LARGEST:
                    emit(name, [a, b, x], value)
    for a, b, x in [(500, 500, .01), (1e6, 1e6, .1), (2, 3, 1e-300), (1000, 10, 1e-5)]:
        emit("beta_ln_cdf", [a, b, x], log(beta_tails(a, b, x)[0]))
    for a, b in [(.5, 16.5), (2, 3), (7, 27), (26.5, 7.5), (500, 500), (900, 100), (1000, 1), (1e4, 2.5e4), (1e6, 10), (1e6, 1e6)]:
        for p in [1e-300, 1e-100, 1e-10, 1e-3, .025, .3, .5, .8, .975, .9999]:
            if a == b == 1e6 and p > .5:
                continue  # as their mirror images, and minutes each
            if p > .5:
                q = 1 - mpf(p)
                h = lambda odds: beta_tails_at_odds(a, b, odds, 1)[1]
                odds = bisect_quantile(h, q, mpf(10) ** -30, mpf(10) ** 30)
            else:
                h = lambda odds: beta_tails_at_odds(a, b, odds, 1)[0]
                odds = bisect_quantile(h, mpf(p), mpf(10) ** -620, mpf(10) ** 30)
            value = odds / (1 + odds)
            if SMALLEST < value:
                emit("beta_quantile", [a, b, p], value)


def binomial():
    for n in [1, 2, 10, 33, 64, 100, 1000, 10 ** 5, 10 ** 6]:
        for p in [1e-5, .01, .3, .5, 7 / 33, .9]:
            sd = (n * p * (1 - p)) ** .5
            ks = {int(floor(n * p + z * sd)) for z in (-35, -20, -8, -3, -1, 0, 1, 3, 8, 20, 35)} | {0, n - 1, n}
            for k in sorted(k for k in ks if 0 <= k <= n):
                P, Q = mpf(p), 1 - mpf(p)
                mass = exp(loggamma(n + 1) - loggamma(k + 1) - loggamma(n - k + 1) + k * log(P) + (n - k) * log(Q))
                if mass > SMALLEST:
                    emit("binomial_pmf", [n, p, k], mass)
                lower, m, term = mpf(0), k, mass
                while m >= 0 and term > mass * mpf(10) ** -60 or m > n * p and m >= 0:
                    lower += term
                    term *= mpf(m) / (n - m + 1) * Q / P
                    m -= 1
                if k < n:
                    upper, m, term = mpf(0), k + 1, mass * mpf(n - k) / (k + 1) * P / Q
                    first = term
                    while m <= n and (term > first * mpf(10) ** -60 or m < n * p):
                        upper += term
                        term *= mpf(n - m) / (m + 1) * P / Q
                        m += 1
                    if SMALLEST < upper < LARGEST:
                        emit("binomial_sf", [n, p, k], upper)
                if SMALLEST < lower < LARGEST:
                    emit("binomial_cdf", [n, p, k], lower)


def chi_squared():
    for df in [.01, 1, 2, 3, 8, 31, 100, 1000, 1e4, 1e5]:
        sd = (2 * df) ** .5
        for x in sorted({df + z * sd for z in (-30, -15, -5, -2, -1, 0, 1, 2, 5, 15, 30)} | {1e-300, 1e-10, .01, 1, 10, 100, 1000, 1300}):
            if x <= 0 or x > 40 * df + 2000:
                continue
            lower, upper = gamma_tails(mpf(df) / 2, mpf(x) / 2)
            for name, value in (("chi_squared_cdf", lower), ("chi_squared_sf", upper)):
                if SMALLEST < value < LARGEST:
                    emit(name, [df, x], value)


def fisher_f():
    for d1, d2 in [(1, 1), (1, 31), (8, 180), (8, 18000), (3, 2.5), (1000, 1000), (1e5, 7)]:
        for f in [1e-5, .1, .5, 1, 1.3, 2, 5, 21, 100, 1e5, 1e50]:
            odds = mpf(d1) * f / d2
            lower, upper = beta_tails_at_odds(mpf(d1) / 2, mpf(d2) / 2, odds, 1)
            for name, value in (("f_cdf", lower), ("f_sf", upper)):
                if SMALLEST < value < LARGEST:
                    emit(name, [d1, d2, f], value)


def noncentral_t():
    for df in [.5, 1, 2, 5, 31, 100, 1000, 1e5]:
        for delta in [.1, 1.5, -1.5, 2.83, 5, 12, 30]:
            for t in [.01, .5, 1, 1.96, 2.04, 3, 6, 15, 40]:
                if df == 1e5 and (abs(t) > 6 or delta > 12):
                    continue
                cdf, sf = noncentral_t_tails(df, delta, t)
                for name, value in (("noncentral_t_cdf", cdf), ("noncentral_t_sf", sf)):
                    if SMALLEST < value < LARGEST:
                        emit(name, [df, delta, t], value)
                # The mirrored point: P(T ≤ −t; −δ) = P(T > t; δ).
                if t == 3 and SMALLEST < sf:
                    emit("noncentral_t_cdf", [df, -delta, -t], sf)
    for df, delta, t in [(.5, 50, 60), (1, 60, 30), (1, 60, 100), (3, 80, 60), (3, 200, 260)]:
        cdf, sf = noncentral_t_tails(df, delta, t)
        for name, value in (("noncentral_t_cdf", cdf), ("noncentral_t_sf", sf)):
            if SMALLEST < value < LARGEST:
                emit(name, [df, delta, t], value)


PARTS = (normal, student_t, beta, binomial, chi_squared, fisher_f, noncentral_t)
for part in PARTS:
    if len(sys.argv) < 2 or part.__name__ in sys.argv[1:]:
        part()
