#!/usr/bin/env python3
"""E0 of emitters of unit radiance, with mpmath at 50 digits: prints irradiance.csv.

Rectangles by integrating the solid-angle integrand numerically (Gauss-Legendre, 50 digits) and by the closed form at 90 digits, which must
agree to 30 digits where the integral is smooth; disks by the closed form at 90 digits and by integrating rings.
Columns: kind, a, b (half-sides or radius), lamp x, y, z, screen x, y, value.
"""
import mpmath as mp

mp.mp.dps = 90


def corner(x, y, h):
    rx, ry = mp.sqrt(x * x + h * h), mp.sqrt(y * y + h * h)
    return (x / rx * mp.atan(y / rx) + y / ry * mp.atan(x / ry)) / 2


def rectangle(a, b, lamp, p):
    h = abs(lamp[2])
    x, y = lamp[0] - p[0], lamp[1] - p[1]
    return corner(x + a, y + b, h) - corner(x - a, y + b, h) - corner(x + a, y - b, h) + corner(x - a, y - b, h)


def rectangle_integral(a, b, lamp, p):
    h = abs(lamp[2])
    x, y = lamp[0] - p[0], lamp[1] - p[1]
    with mp.workdps(50):
        f = lambda u, v: h * h / ((x + u) ** 2 + (y + v) ** 2 + h * h) ** 2
        return mp.quad(f, [-a, a], [-b, b], maxdegree=6)


def disk(r, lamp, p):
    h2 = lamp[2] ** 2
    x2 = (lamp[0] - p[0]) ** 2 + (lamp[1] - p[1]) ** 2
    s = x2 + h2
    return mp.pi / 2 * (1 - (s - r * r) / mp.sqrt((s + r * r) ** 2 - 4 * r * r * x2))


def disk_integral(r, lamp, p):
    h = abs(lamp[2])
    x = mp.sqrt((lamp[0] - p[0]) ** 2 + (lamp[1] - p[1]) ** 2)
    with mp.workdps(50):
        # The ring of radius q: the integral over its angle of h^2 / (A - B cos t)^2 is 2 pi A h^2 / (A^2 - B^2)^(3/2).
        def ring(q):
            A, B = x * x + q * q + h * h, 2 * x * q
            return 2 * mp.pi * q * h * h * A / (A * A - B * B) ** mp.mpf(1.5)
        return mp.quad(ring, [0, r / 4, r / 2, r])


cases = []
for a, b in [(5e-7, 5e-7), (5e-6, 5e-6), (1e-3, 1e-3), (0.01, 0.01), (0.05, 0.05), (0.5, 0.5), (0.5, 5e-7), (0.01, 0.3)]:
    for lamp in [(0.0, 0.0, -1.5), (0.3, -0.2, -0.8), (4.0, 1.0, -0.5), (0.1, 0.2, -0.05), (100.0, -50.0, -1.5)]:
        for p in [(0.0, 0.0), (0.75, -0.4), (-0.8, 0.45)]:
            cases.append((a, b, lamp, p))

for i, (a, b, lamp, p) in enumerate(cases):
    m = [mp.mpf(v) for v in (a, b)]
    l, q = [mp.mpf(v) for v in lamp], [mp.mpf(v) for v in p]
    value = rectangle(*m, l, q)
    if max(a, b) < 0.06 and lamp[2] < -0.4 and i % 3 == 0:
        other = rectangle_integral(*m, l, q)
        assert abs(other / value - 1) < mp.mpf(10) ** -30, (a, b, lamp, p, mp.nstr(other / value - 1, 5))
    print("rectangle", *map(repr, (a, b, *lamp, *p)), mp.nstr(value, 25), sep=",")

for r in [5e-7, 1e-3, 0.01, 0.05, 0.5]:
    for lamp in [(0.0, 0.0, -1.5), (0.3, -0.2, -0.8), (4.0, 1.0, -0.5), (0.1, 0.2, -0.05), (100.0, -50.0, -1.5)]:
        for p in [(0.0, 0.0), (0.75, -0.4)]:
            l, q = [mp.mpf(v) for v in lamp], [mp.mpf(v) for v in p]
            value = disk(mp.mpf(r), l, q)
            if lamp[2] < -0.4:
                other = disk_integral(mp.mpf(r), l, q)
                assert abs(other / value - 1) < mp.mpf(10) ** -25, (r, lamp, p, mp.nstr(other / value - 1, 5))
            print("disk", *map(repr, (r, r, *lamp, *p)), mp.nstr(value, 25), sep=",")
