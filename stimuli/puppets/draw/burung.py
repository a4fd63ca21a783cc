"""Burung, a bird in flight, as if scanned: a PNG with alpha, thick and thin places of the hide, no parts.

Run `python burung.py` (numpy, scipy, shapely, pillow, and librsvg's `rsvg-convert`) to write ../burung.png.
"""

import io
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter

from leather import Leather, dot, petal, plain, ribbon, sickle, through, ukel, write

SIZE = (1000, 1500)
ROWS = 640


def along(points):
    return through(points, closed=False)


def feather(root, turn, length, width, bend, start=0):
    """A quill with a slit on either side of its shaft."""
    tip = (length, bend)
    mid = (length * 0.55, bend * 0.2)
    at = lambda c: c.at(*root, turn)
    f = Leather(at(ribbon([(start, 0), mid, tip], [width * 0.5, width, width * 0.9, width * 0.35], n=9)), web=4)
    shaft = at(along([(start, 0), mid, tip]))
    for side in (-1, 1):
        f.row(shaft, 25, petal(0.28), 10.5, 24 * side, side * width * 0.22, (length - start) * 0.3, 8, least=0.5)
    return f


def draw():
    pieces = []
    for i in range(6):                                                            # far wing
        pieces.append(feather((452, 330), -84 - 10.5 * i, 290 - 14 * abs(i - 2), 40, 22))
    for i in range(6):                                                            # tail
        pieces.append(feather((640, 420), 26 - 13 * i, 330 - 18 * abs(i - 2), 46, -34))
    for i in range(8):                                                            # near wing
        pieces.append(feather((560, 318), -17 - 10.5 * i, 300 - 12 * abs(i - 4), 46, 26, 74))
    body = Leather(through([(318, 330), (330, 312), (356, 304), (420, 292), (520, 306), (620, 360), (690, 420), (650, 462), (560, 486), (450, 470), (376, 424), (334, 384), (318, 356)]), web=5)
    wing = Leather(through([(404, 340), (446, 292), (530, 240), (600, 232), (650, 280), (640, 330), (560, 386), (450, 392)]), web=5)
    head = Leather(through([(232, 330), (246, 296), (282, 276), (322, 284), (344, 318), (330, 366), (286, 374), (248, 358)]), web=4)
    body.clear_of(wing, head)
    head.clear_of(body)
    body.lattice(body.within(through([(330, 320), (420, 310), (420, 400), (560, 430), (680, 420), (640, 470), (460, 476), (340, 380)])), (27, 20), sickle(0.55), 9, 20)
    wing.fit(ukel(1.6), 476, 338, 160, 38)
    wing.clear_of(*(p for p in pieces if isinstance(p, Leather)))
    wing.lattice(wing.within(through([(520, 246), (600, 230), (656, 280), (640, 340), (520, 390)])), (30, 21), sickle(0.55), 10, -40)
    beak = plain(through([(262, 312, 0), (214, 318), (160, 352, 0), (206, 350), (262, 348, 0)]))
    head.fit(petal(0.5), 280, 320, 12, 17)
    head.row(along([(300, 296), (318, 324), (308, 356)]), 15, dot(), 4)
    crest = [feather((300, 290), -128 + 22 * i, 92 - 10 * abs(i - 1), 22, 12) for i in range(3)]
    legs = [plain(ribbon([(520, 470), (560, 520), (620, 540), (650, 528)], [20, 13, 9, 2], n=9)), plain(ribbon([(560, 524), (610, 560), (640, 560)], [8, 7, 0], n=7))]
    rod = plain(ribbon([(484, 440), (486, 800), (483, 1150), (486, 1498)], [7, 8, 9, 10, 11, 13], n=13, tip=False))
    pieces += [*legs, body, wing, *crest, head, beak, rod]
    with tempfile.TemporaryDirectory() as folder:
        svg = Path(folder) / "burung.svg"
        write(svg, SIZE, [("body", pieces)], "Burung")
        png = subprocess.run(["rsvg-convert", "-h", str(ROWS), svg], capture_output=True, check=True).stdout
    alpha = np.asarray(Image.open(io.BytesIO(png)).convert("RGBA"))[..., 3] / 255
    # Hide is uneven: cloudy, thinner at its edges, with a few veins; a scanner sees that as colour and as alpha.
    noise = np.random.default_rng(7)
    cloud = sum(gaussian_filter(noise.standard_normal(alpha.shape), s) * s for s in (3, 9, 27)) / 3
    thick = np.clip(gaussian_filter(alpha, 3) * 1.25, 0, 1) * np.clip(0.93 + 0.12 * cloud, 0.7, 1)
    shade = np.stack([96 + 30 * cloud - 40 * thick, 52 + 20 * cloud - 26 * thick, 26 + 10 * cloud - 14 * thick], axis=-1)
    rgb = np.where(alpha[..., None] > 0, np.clip(shade, 0, 255), 0)
    out = np.concatenate([rgb, (255 * alpha * (0.75 + 0.25 * thick))[..., None]], axis=-1)
    out = np.round(out / 4) * 4                                                    # fewer levels, a smaller file
    out[..., 3] = np.where(alpha > 0.995, np.maximum(out[..., 3], 4), out[..., 3])
    Image.fromarray(np.clip(out, 0, 255).astype("uint8"), "RGBA").save(Path(__file__).parent.parent / "burung.png", optimize=True)


if __name__ == "__main__":
    draw()
