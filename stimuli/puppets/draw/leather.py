"""A small kit for cutting shadow puppets: Bézier outlines, and holes that never meet each other or the edge.

Units are SVG user units, y down. Points are (x, y), or (x, y, 0) for a corner. Angles are in degrees, clockwise as seen
(SVG's own sense). Shapely and numpy only decide where a hole fits; what is written are Bézier curves.
"""

import math

import numpy as np
import shapely
from scipy.ndimage import distance_transform_edt
from shapely.geometry import LineString, Polygon
from shapely.prepared import prep


class Curve:
    """A chain of cubic Béziers, each (p0, c1, c2, p3) in complex numbers."""

    def __init__(self, segments, closed=True):
        self.segments, self.closed = segments, closed

    def __add__(self, other):
        """This open curve, then the other one."""
        return Curve(self.segments + other.segments, self.closed)

    def map(self, f):
        return Curve([tuple(f(p) for p in s) for s in self.segments], self.closed)

    def at(self, x, y, turn=0.0, scale=1.0, flip=False):
        """Mirrored in x if `flip`, scaled, turned, and then carried to (x, y)."""
        k = scale * complex(math.cos(math.radians(turn)), math.sin(math.radians(turn)))
        return self.map(lambda p: complex(x, y) + k * (complex(-p.real, p.imag) if flip else p))

    def points(self, n=6):
        """n points a segment."""
        out = []
        for p, a, b, q in self.segments:
            for i in range(n):
                t = i / n
                u = 1 - t
                out.append(u * u * u * p + 3 * u * u * t * a + 3 * u * t * t * b + t * t * t * q)
        if not self.closed:
            out.append(self.segments[-1][3])
        return out

    def polygon(self, n=6):
        return Polygon([(p.real, p.imag) for p in self.points(n)])

    def walk(self, step, start=0.0, end=0.0):
        """(point, direction in degrees, share of the length) at equal steps, keeping clear of both ends."""
        pts = self.points(24)
        if self.closed:
            pts.append(pts[0])
        s = np.concatenate([[0], np.cumsum(np.abs(np.diff(pts)))])
        free = s[-1] - start - end
        n = max(1, round(free / step))
        ends = 0 if self.closed else 1
        for i in range(n + ends):
            d = start + free * i / n
            p, a, b = (_interp(s, pts, d + e) for e in (0, -0.5, 0.5))
            yield p, math.degrees(math.atan2((b - a).imag, (b - a).real)), d / s[-1]

    def d(self):
        """SVG path data, relative, to a tenth of a unit."""
        at = lambda z: (round(z.real * 10), round(z.imag * 10))
        x, y = at(self.segments[0][0])
        out, last = f"M{_num(x)} {_num(y)}", ""
        for s in self.segments:
            rel = []
            for p in s[1:]:
                px, py = at(p)
                rel += [_num(px - x), _num(py - y)]
            x, y = at(s[3])
            text = rel[0] + "".join(r if r[0] == "-" else " " + r for r in rel[1:])
            out += ("c" if last != "c" else ("" if text[0] == "-" else " ")) + text
            last = "c"
        return out + ("z" if self.closed else "")


def _num(tenths):
    if tenths % 10 == 0:
        return str(tenths // 10)
    text = f"{tenths / 10:.1f}"
    return text.replace("0.", ".", 1) if abs(tenths) < 10 else text


def _interp(s, pts, d):
    d = min(max(d, 0.0), s[-1])
    i = min(max(int(np.searchsorted(s, d)) - 1, 0), len(pts) - 2)
    t = (d - s[i]) / max(s[i + 1] - s[i], 1e-9)
    return pts[i] + t * (pts[i + 1] - pts[i])


def through(points, closed=True):
    """The smooth curve through points; it breaks at corners (x, y, 0)."""
    z = [complex(p[0], p[1]) for p in points]
    corner = [len(p) == 3 for p in points]
    n = len(z)
    if not closed:
        corner[0] = corner[-1] = True

    def tangent(i):
        a, b = z[i] - z[i - 1], z[(i + 1) % n] - z[i]
        if abs(a) < 1e-9 or abs(b) < 1e-9:
            return 0
        # weighted by the other side's length: a circle's points give the circle's tangent
        t = a / abs(a) * abs(b) + b / abs(b) * abs(a)
        return t / max(abs(t), 1e-9)

    segs = []
    for i in range(n if closed else n - 1):
        j = (i + 1) % n
        h = abs(z[j] - z[i]) * 0.36
        c1 = None if corner[i] else z[i] + h * tangent(i)
        c2 = None if corner[j] else z[j] - h * tangent(j)
        if c1 is None and c2 is None:
            c1, c2 = z[i] + (z[j] - z[i]) / 3, z[j] - (z[j] - z[i]) / 3
        elif c1 is None:
            c1 = z[i] + (c2 - z[i]) * 0.5
        elif c2 is None:
            c2 = z[j] + (c1 - z[j]) * 0.5
        segs.append((z[i], c1, c2, z[j]))
    return Curve(segs, closed)


def ribbon(points, widths, n=None, tip=True, tail=True):
    """A brush stroke along the curve through `points`; `widths` (full) are spread evenly over its length.
    An end of zero width is a point; otherwise `tip` (the last) and `tail` (the first) say whether it is round."""
    line = through(points, closed=False)
    n = n or max(3, 2 * len(points) - 1)
    left, right = [], []
    stations = []
    pts = line.points(24)
    s = np.concatenate([[0], np.cumsum(np.abs(np.diff(pts)))])
    for i in range(n):
        d = s[-1] * i / (n - 1)
        p, a, b = (_interp(s, pts, d + e) for e in (0, -0.5, 0.5))
        u = (b - a) / max(abs(b - a), 1e-9)
        w = float(np.interp(i / (n - 1), np.linspace(0, 1, len(widths)), widths)) / 2
        left.append(p - 1j * u * w)
        right.append(p + 1j * u * w)
        stations.append((p, u, w))
    first, last = stations[0], stations[-1]
    xy = lambda z: (z.real, z.imag)
    out = [xy(p) for p in left[1:-1]]
    for (p, u, w), sign, is_round, ends in ((last, 1, tip, (left[-1], right[-1])), (first, -1, tail, (right[0], left[0]))):
        if w < 0.3:
            out.append((*xy(p), 0))
        elif is_round:
            out += [xy(ends[0]), xy(p + sign * u * w), xy(ends[1])]
        else:
            out += [(*xy(ends[0]), 0), (*xy(ends[1]), 0)]
        if sign == 1:
            out += [xy(p) for p in right[-2:0:-1]]
    return through(out)


# Motifs: holes in the unit circle, pointing to +x.

def dot():
    return through([(1, 0), (0, 1), (-1, 0), (0, -1)])


def drop(fat=0.55):
    """A tear whose point is at +x."""
    return through([(1, 0, 0), (0.05, fat * 0.8), (-0.6, fat), (-1, 0), (-0.6, -fat), (0.05, -fat * 0.8)])


def petal(fat=0.42):
    """Pointed at both ends."""
    return through([(1, 0, 0), (0, fat), (-1, 0, 0), (0, -fat)])


def lozenge(fat=0.6):
    return through([(1, 0, 0), (0, fat, 0), (-1, 0, 0), (0, -fat, 0)])


def sickle(fat=0.5):
    """A crescent that bulges to +x: the wayang carvers' mas-masan."""
    return through([(-0.35, -1, 0), (0.25, -0.6), (0.5, 0), (0.25, 0.6), (-0.35, 1, 0), (0.5 - 0.95 * fat, 0.45), (0.5 - fat, 0),
                    (0.5 - 0.95 * fat, -0.45)])


def comma():
    """A fat tear that curls round: the half-turn ukel."""
    return ribbon([_polar(0.86, a) for a in (-150, -95, -40, 20)] + [_polar(0.7, 75), _polar(0.42, 135), _polar(0.28, 200)],
                  [0.0, 0.2, 0.34, 0.44, 0.5, 0.5], n=9)


def ukel(turns=1.35):
    """The spiral tendril."""
    n = 9
    line = [_polar(0.9 - 0.66 * (i / (n - 1)) ** 0.9, -160 + 360 * turns * i / (n - 1)) for i in range(n)]
    return ribbon(line, [0.0, 0.17, 0.25, 0.27, 0.27, 0.3, 0.36], n=11)


def _polar(r, deg):
    return (r * math.cos(math.radians(deg)), r * math.sin(math.radians(deg)))


class Leather:
    """One piece of leather: an outline, and holes cut through it at least `web` apart and `web` from the edge."""

    def __init__(self, outline, web=6.0, fill=None, opacity=None, rim=None):
        self.outline, self.web, self.fill, self.opacity, self.rim = outline, web, fill, opacity, rim
        self.area = outline.polygon(12).buffer(0)
        self.free = self.area.buffer(-web)
        self.holes, self.polygons = [], []

    def keep(self, *shapes, margin=0.0):
        """No holes where these curves (closed) or lines (open) run."""
        for s in shapes:
            if isinstance(s, Curve):
                s = s.polygon(10) if s.closed else LineString([(p.real, p.imag) for p in s.points(10)])
            self.free = self.free.difference(s.buffer(margin) if margin else s)
        return self

    def clear_of(self, *others, margin=1.0):
        """No holes where other pieces lie above or below."""
        for o in others:
            self.free = self.free.difference((o.area if isinstance(o, Leather) else o.polygon(10).buffer(0)).buffer(margin))
        return self

    def within(self, shape, margin=0.0):
        """The free area inside a closed curve, for `pack` and `lattice`."""
        return self.free.intersection(shape.polygon(10).buffer(-margin) if isinstance(shape, Curve) else shape)

    def cut(self, hole, inside=None):
        """Cuts the hole if it fits; says whether it did."""
        poly = hole.polygon(5).buffer(0)
        area = prep(inside) if inside is not None else self._prepared()
        if not area.contains(poly):
            return False
        near = poly.buffer(self.web)
        x0, y0, x1, y1 = near.bounds
        for q in self.polygons:
            a0, b0, a1, b1 = q.bounds
            if a0 < x1 and a1 > x0 and b0 < y1 and b1 > y0 and q.intersects(near):
                return False
        self.holes.append(hole)
        self.polygons.append(poly)
        return True

    def _prepared(self):
        if getattr(self, "_prep_of", None) is not self.free:
            self._prep_of, self._prep = self.free, prep(self.free)
        return self._prep

    def fit(self, motif, x, y, turn, scale, flip=False, least=0.55, inside=None):
        """Cuts the motif, shrunk down to `least` of its scale if it must be."""
        for k in (1.0, 0.85, 0.7, 0.55, 0.4):
            if k >= least and self.cut(motif.at(x, y, turn, scale * k, flip), inside):
                return True
        return False

    def row(self, line, step, motif, scale, turn=0.0, offset=0.0, start=0.0, end=0.0, flip=False, least=0.7, taper=None):
        """A row of motifs along a line; `offset` is to its right hand; `taper(share)` scales them."""
        for p, a, s in line.walk(step, start, end):
            q = p + offset * 1j * complex(math.cos(math.radians(a)), math.sin(math.radians(a)))
            self.fit(motif, q.real, q.imag, a + turn, scale * (taper(s) if taper else 1), flip, least)
        return self

    def lattice(self, area, pitch, motif, scale, turn=0.0, axis=0.0, stagger=True, least=0.8):
        """Motifs on a lattice of pitch (dx, dy), turned by `axis`; every second row is shifted by half a pitch if `stagger`."""
        dx, dy = pitch
        x0, y0, x1, y1 = area.bounds
        reach = int(math.hypot(x1 - x0, y1 - y0) / min(dx, dy)) + 2
        k = complex(math.cos(math.radians(axis)), math.sin(math.radians(axis)))
        c = complex((x0 + x1) / 2, (y0 + y1) / 2)
        for j in range(-reach, reach + 1):
            for i in range(-reach, reach + 1):
                p = c + k * complex((i + (0.5 if stagger and j % 2 else 0)) * dx, j * dy)
                if x0 <= p.real <= x1 and y0 <= p.imag <= y1:
                    self.fit(motif, p.real, p.imag, axis + turn, scale, False, least, area)
        return self

    def pack(self, area, largest, least, turn, gap=None, cell=2.0, spiral=30.0, hand=lambda x, y: False, small=9.0):
        """Fills an area with tendrils, the largest first: `turn(x, y)` is where each points to, `hand` which way it curls."""
        gap = self.web if gap is None else gap
        x0, y0, x1, y1 = area.bounds
        xs, ys = np.arange(x0, x1, cell), np.arange(y0, y1, cell)
        gx, gy = np.meshgrid(xs, ys)
        inside = np.pad(shapely.contains_xy(area, gx, gy), 1)
        room = distance_transform_edt(inside)[1:-1, 1:-1] * cell
        for q in self.polygons:
            if q.intersects(area):
                _push(room, gx, gy, q.buffer(gap))
        while room.size:
            i = int(np.argmax(np.minimum(room, largest + 1e-3 * (gy - y0) / (y1 - y0 + 1))))
            r = min(room.flat[i], largest)
            if r < least:
                break
            x, y = gx.flat[i], gy.flat[i]
            motif = ukel() if r > spiral else comma() if r > small else dot()
            for k in (1.0, 0.88, 0.75):               # the field is sampled, so it may promise a little too much
                if self.cut(motif.at(x, y, turn(x, y), k * r if r > small else 0.85 * k * r, hand(x, y))):
                    break
            else:
                r = least - gap
            room = np.minimum(room, np.hypot(gx - x, gy - y) - r - gap)
        return self

    def svg(self):
        d = self.outline.d()
        rim = f'\n<path fill="none"{_paint(None, None, self.rim)} d="{d}"/>' if self.rim else ""
        return f'<path{_paint(self.fill, self.opacity)} d="{d}{"".join(h.d() for h in self.holes)}"/>{rim}'


def _push(room, gx, gy, poly):
    """Takes a polygon's surroundings out of the room field (by its boundary; coarse but safe)."""
    x0, y0, x1, y1 = poly.bounds
    reach = 60
    near = (gx > x0 - reach) & (gx < x1 + reach) & (gy > y0 - reach) & (gy < y1 + reach)
    if near.any():
        room[near] = np.minimum(room[near], shapely.distance(poly, shapely.points(gx[near], gy[near])))


def _paint(fill=None, opacity=None, rim=None):
    """Attributes; `rim` is the width of a line in the part's own dark colour round the outline."""
    return ((f' fill="{fill}"' if fill else "") + (f' fill-opacity="{opacity}"' if opacity is not None else "")
            + (f' stroke="currentColor" stroke-width="{rim}" stroke-linejoin="round"' if rim else ""))


def plain(curve, fill=None, opacity=None, rim=None):
    """A piece without holes."""
    return f'<path{_paint(fill, opacity, rim)} d="{curve.d()}"/>'


def line(curve, width, stroke=None):
    """A drawn line."""
    paint = f' stroke="{stroke}"' if stroke else ' stroke="currentColor"'
    return f'<path fill="none"{paint} stroke-width="{width}" stroke-linecap="round" stroke-linejoin="round" d="{curve.d()}"/>'


def write(path, size, parts, title, fill="#1a120c"):
    """`parts`: a list of (id, [svg strings or Leather]). Every drawn element is inside a part."""
    w, h = size
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {w} {h}" width="{w}" height="{h}">',
           f"<title>{title}</title>"]
    for name, pieces in parts:
        body = "\n".join(p.svg() if isinstance(p, Leather) else p for p in pieces)
        out.append(f'<g id="{name}" fill="{fill}" color="{fill}" fill-rule="evenodd">\n{body}\n</g>')
    out.append("</svg>\n")
    text = "\n".join(out)
    path.write_text(text)
    return len(text)
